// SPDX-License-Identifier: BSD-3-Clause
//
// Positions by rules: the sides of all samples, topology, self-intersections, planes and balls of binary samples.
#include "tegl/positions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/check.hpp"
#include "tegl/filter.hpp"
#include "tegl/intersections.hpp"
#include "tegl/measure.hpp"

namespace tegl::test {
namespace {

constexpr std::array kRules = {Positions::linear, Positions::filtered, Positions::custom, Positions::gravitation,
                               Positions::relaxed};

/// Options with a rule; `values` for `filtered`.
PositionOptions by(Positions rule, std::span<const float> values = {}) {
  PositionOptions options;
  options.rule = rule;
  options.filtered = values;
  if (rule == Positions::custom)
    options.custom = [](double first, double second, double isovalue) {
      const double share = (isovalue - first) / (second - first);
      return share * share * (3.0 - 2.0 * share);
    };
  return options;
}

/// Samples of a random type of field, low at the border: noise, a mask, or a mask with few high samples.
template <Value T, int N>
OwnedImage<T, N> random_image(std::size_t size, unsigned seed) {
  std::mt19937_64 random(seed);
  const double share = seed % 3 == 0 ? 0.5 : seed % 3 == 1 ? 0.2 : 0.7;
  const bool is_mask = seed % 2 == 0;
  std::array<std::size_t, N> sizes;
  sizes.fill(size);
  OwnedImage<T, N> image{Grid<N>::unit(sizes), std::vector<T>(sample_count(Grid<N>::unit(sizes)))};
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    const double u = static_cast<double>(random() >> 11) * 0x1p-53;
    bool border = false;
    for (const std::size_t x : index) border = border || x == 0 || x + 1 == size;
    const double value = u < share ? (is_mask ? 60 : 41 + 50 * u) : is_mask ? 0 : 39 * u;
    image.values[i] = static_cast<T>(border ? 0 : value);
  });
  return image;
}

/// Values of a second image that have nothing to do with the first one.
template <int N>
std::vector<float> other_values(const Grid<N>& grid, unsigned seed) {
  std::mt19937_64 random(seed + 1000);
  std::vector<float> values(sample_count(grid));
  for (float& value : values) value = static_cast<float>(static_cast<double>(random() >> 11) * 0x1p-53 * 120 - 20);
  return values;
}

/// Whether a point is inside of a closed contour: the number of simplices that a ray crosses is odd.
template <int N>
bool is_inside(const Contour<N, double>& contour, const std::array<double, N>& point) {
  constexpr std::array<double, 4> kRay = {0.6180339887, 0.7320508076, 0.4142135624, 0.2360679775};
  int crossings = 0;
  for (const auto& simplex : contour.simplices) {
    // point + s * ray = sum of l_j (v_j - v_0) + v_0
    std::array<std::array<double, N + 1>, N> m;
    for (int a = 0; a < N; ++a) {
      const auto& origin = contour.vertices[simplex[0]];
      for (int j = 1; j < N; ++j) m[a][j - 1] = contour.vertices[simplex[j]][a] - origin[a];
      m[a][N - 1] = -kRay[a];
      m[a][N] = point[a] - origin[a];
    }
    bool singular = false;
    for (int c = 0; c < N && !singular; ++c) {
      int pivot = c;
      for (int r = c + 1; r < N; ++r)
        if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
      singular = m[pivot][c] == 0;
      std::swap(m[c], m[pivot]);
      for (int r = 0; r < N && !singular; ++r) {
        if (r == c) continue;
        const double factor = m[r][c] / m[c][c];
        for (int k = c; k <= N; ++k) m[r][k] -= factor * m[c][k];
      }
    }
    if (singular) continue;
    double rest = 1.0;
    bool hit = m[N - 1][N] / m[N - 1][N - 1] > 0;
    for (int j = 0; j + 1 < N; ++j) {
      const double share = m[j][N] / m[j][j];
      rest -= share;
      hit = hit && share > 0;
    }
    if (hit && rest > 0) ++crossings;
  }
  return crossings % 2 == 1;
}

template <Value T, int N>
void expect_sides(const OwnedImage<T, N>& image, double isovalue, const Contour<N, double>& contour) {
  std::size_t wrong = 0;
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    std::array<double, N> point;
    for (int a = 0; a < N; ++a) point[a] = static_cast<double>(index[a]);
    if (is_inside<N>(contour, point) != (static_cast<double>(image.values[i]) >= isovalue)) ++wrong;
  });
  EXPECT_EQ(wrong, 0u);
}

template <class A, class B>
bool same_bytes(const A& a, const B& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

/// Each vertex of the contour's first ones that lies on an edge of the grid lies between a high and a low sample.
template <int N, Value T>
void expect_all_rules(std::size_t size, unsigned seed) {
  const auto image = random_image<T, N>(size, seed);
  const auto values = other_values<N>(image.grid, seed);
  constexpr double kLevel = 40;
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high, Ambiguity::saddle}) {
      ExtractOptions options;
      options.triangulation = triangulation;
      options.ambiguity = ambiguity;
      options.epsilon = 0.001;
      const auto linear = extract<double>(image.view(), kLevel, options);
      for (const Positions rule : kRules) {
        SCOPED_TRACE(::testing::Message()
                     << N << "D, seed " << seed << ", rule " << static_cast<int>(rule) << ", ambiguity "
                     << static_cast<int>(ambiguity) << ", triangulation " << static_cast<int>(triangulation));
        const auto contour = extract_placed<double>(image.view(), kLevel, by(rule, values), options);
        EXPECT_TRUE(same_bytes(contour.simplices, linear.simplices));
        EXPECT_EQ(contour.vertices.size(), linear.vertices.size());
        if (rule == Positions::linear) {
          EXPECT_TRUE(same_bytes(contour.vertices, linear.vertices));
        } else {
          EXPECT_FALSE(same_bytes(contour.vertices, linear.vertices));
        }
        expect_closed_manifold(contour);
        if (ambiguity == Ambiguity::low && N < 4) expect_sides(image, kLevel, contour);
        const Intersections<N> found = find_intersections(contour);
        EXPECT_EQ(found.flat, 0u);
        if (rule != Positions::gravitation) {
          EXPECT_EQ(found.pair_count, 0u);
        }
      }
    }
}

TEST(Positions, EverySampleStaysOnItsSideIn2d) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    expect_all_rules<2, float>(10, seed);
    expect_all_rules<2, std::uint8_t>(10, seed);
  }
}
TEST(Positions, EverySampleStaysOnItsSideIn3d) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    expect_all_rules<3, double>(6, seed);
    expect_all_rules<3, std::int16_t>(6, seed + 3);
  }
}
TEST(Positions, EverySampleStaysOnItsSideWhateverTheIntegers) {
  expect_all_rules<3, std::int8_t>(5, 0);
  expect_all_rules<3, std::uint16_t>(5, 1);
  expect_all_rules<3, std::int32_t>(5, 2);
}
TEST(Positions, EverySampleStaysOnItsSideIn4d) {
  expect_all_rules<4, float>(5, 0);
  expect_all_rules<4, std::uint8_t>(4, 1);
  const auto image = random_image<float, 4>(4, 3);
  const auto values = other_values<4>(image.grid, 3);
  for (const Positions rule : kRules)
    expect_sides(image, 40, extract_placed<double>(image.view(), 40, by(rule, values), {.epsilon = 0.001}));
}
TEST(Positions, SimplicesIn5dAreThoseOfTheImage) {
  const auto image = random_image<std::uint8_t, 5>(4, 4);
  const auto values = other_values<5>(image.grid, 1);
  const auto linear = extract<double>(image.view(), 40);
  for (const Positions rule : {Positions::filtered, Positions::custom, Positions::relaxed}) {
    const auto contour = extract_placed<double>(image.view(), 40, by(rule, values));
    EXPECT_TRUE(same_bytes(contour.simplices, linear.simplices));
    expect_closed_manifold(contour);
  }
}

/// As `random_image`, with missing samples, any strides, an uneven and a descending axis, and caps.
TEST(Positions, DoNotDependOnThreadsOrStrides) {
  auto image = random_image<float, 3>(40, 2);
  std::mt19937_64 random(5);
  for (int i = 0; i < 60; ++i) image.values[random() % image.values.size()] = std::numeric_limits<float>::quiet_NaN();
  std::vector<double> uneven(40);
  for (std::size_t i = 0; i < 40; ++i) uneven[i] = static_cast<double>(i * i) / 40;
  image.grid.axes[1] = Axis::rectilinear(uneven);
  image.grid.axes[2] = Axis::uniform(40, 5.0, -0.5);
  const auto values = other_values<3>(image.grid, 2);
  // the same samples, axes in the opposite order in memory
  std::vector<float> turned(image.values.size());
  for_each_sample<3>(image.grid, [&](std::size_t i, const std::array<std::size_t, 3>& at) {
    turned[(at[0] * 40 + at[1]) * 40 + at[2]] = image.values[i];
  });
  const Image<float, 3> view(turned.data(), image.grid, {1600, 40, 1});
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::mean})
    for (const Positions rule : kRules) {
      ExtractOptions options{.ambiguity = ambiguity, .close = true, .normals = Normals::differences};
      options.work.threads = 1;
      const auto one = extract_placed(image.view(), 40, by(rule, values), options);
      expect_oriented_manifold(one);
      for (const unsigned threads : {2u, 3u, 8u}) {
        options.work.threads = threads;
        const auto several = extract_placed(image.view(), 40, by(rule, values), options);
        EXPECT_TRUE(same_bytes(several.vertices, one.vertices)) << static_cast<int>(rule);
        EXPECT_TRUE(same_bytes(several.normals, one.normals));
        EXPECT_TRUE(same_bytes(several.simplices, one.simplices));
      }
      const auto of_turned = extract_placed(view, 40, by(rule, values), options);
      EXPECT_TRUE(same_bytes(of_turned.vertices, one.vertices)) << static_cast<int>(rule);
      EXPECT_TRUE(same_bytes(of_turned.normals, one.normals));
    }
}

template <int N>
void expect_uncertainty() {
  const auto image = random_image<float, N>(8, 1);
  const auto values = other_values<N>(image.grid, 1);
  const ExtractOptions options{.normals = Normals::context};
  const auto linear = extract<double>(image.view(), 40, options);
  ASSERT_EQ(linear.vertex_attributes.size(), 1u);
  for (const Positions rule : kRules) {
    const auto contour = extract_placed<double>(image.view(), 40, by(rule, values), options);
    ASSERT_EQ(contour.vertex_attributes.size(), 1u) << static_cast<int>(rule);
    const Attribute& attribute = contour.vertex_attributes[0];
    EXPECT_EQ(attribute.name, "normal_uncertainty");
    ASSERT_EQ(attribute.values.size(), contour.vertices.size());
    for (const double value : attribute.values) EXPECT_TRUE(value >= 0 && value <= 1) << value;
    const bool is_same = same_bytes(attribute.values, linear.vertex_attributes[0].values);
    EXPECT_TRUE(is_same || rule != Positions::linear);
  }
}
TEST(Positions, NormalsByContextHaveTheirUncertainty) {
  expect_uncertainty<2>();
  expect_uncertainty<3>();
}

TEST(Positions, FilteredByTheImageItselfAreLinear) {
  const auto image = random_image<float, 3>(9, 1);
  const auto linear = extract(image.view(), 40);
  const auto filtered = extract_placed(image.view(), 40, by(Positions::filtered, image.values));
  EXPECT_TRUE(same_bytes(filtered.vertices, linear.vertices));
  // missing values of the second image
  const std::vector<float> missing(image.values.size(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(same_bytes(extract_placed(image.view(), 40, by(Positions::filtered, missing)).vertices, linear.vertices));
}

/// Differences that are small beside the values, as float cannot hold them.
template <Value T>
void expect_linear_by_itself(double offset, double step) {
  OwnedImage<T, 3> image{Grid<3>::unit({20, 20, 20}), std::vector<T>(8000)};
  for_each_sample<3>(image.grid, [&](std::size_t i, const std::array<std::size_t, 3>& index) {
    double square = 0;
    for (const std::size_t x : index) square += (static_cast<double>(x) - 9.4) * (static_cast<double>(x) - 9.4);
    image.values[i] = static_cast<T>(offset + step * (7 - std::sqrt(square)));
  });
  const std::vector<double> doubles(image.values.begin(), image.values.end());
  PositionOptions options = by(Positions::filtered);
  options.filtered = doubles;
  EXPECT_TRUE(same_bytes(extract_placed<double>(image.view(), offset, options).vertices,
                         extract<double>(image.view(), offset).vertices));
}

TEST(Positions, FilteredByDoublesWithALargeOffsetAreLinear) {
  expect_linear_by_itself<double>(1e6, 1e-3);
  expect_linear_by_itself<std::int32_t>(1e8, 4);
}

/// A kernel with a middle of 0.2, for which the condition 1 - a0 < T <= a0 does not hold: without clamping, samples
/// would change sides.
TEST(Positions, FilteredByAKernelAgainstTheConditionChangeNoSample) {
  for (unsigned seed = 0; seed < 6; seed += 2) {
    auto image = random_image<std::uint8_t, 2>(14, seed);
    for (auto& value : image.values) value = value >= 40 ? 1 : 0;
    std::vector<float> blurred(image.values.size());
    std::size_t crossed = 0;
    for (std::size_t i = 0; i < blurred.size(); ++i) {
      float sum = 0.2f * image.values[i];
      for (const std::ptrdiff_t step : {-1, 1, -14, 14}) {
        const auto at = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
            static_cast<std::ptrdiff_t>(i) + step, 0, static_cast<std::ptrdiff_t>(blurred.size()) - 1));
        sum += 0.2f * image.values[at];
      }
      blurred[i] = sum;
      if ((sum >= 0.5f) != (image.values[i] >= 1)) ++crossed;
    }
    EXPECT_GT(crossed, 0u);
    const auto contour = extract_placed<double>(image.view(), 0.5, by(Positions::filtered, blurred), {.epsilon = 0.01});
    expect_sides(image, 0.5, contour);
    EXPECT_TRUE(same_bytes(contour.simplices, extract<double>(image.view(), 0.5).simplices));
  }
}

/// Filtered by random kernels, with weights of both signs, of 3 to 7 samples along each axis.
template <int N, Value T>
void expect_sides_for_random_kernels(std::size_t size, unsigned kernels) {
  std::mt19937_64 random(N);
  std::size_t crossed = 0;
  for (unsigned seed = 0; seed < kernels; ++seed) {
    const auto image = random_image<T, N>(size, seed);
    Convolution kernel;
    std::size_t weights = 1;
    for (int a = 0; a < N; ++a) {
      kernel.sizes.push_back(N < 4 ? 3 + 2 * (random() % 3) : 3);
      weights *= kernel.sizes.back();
    }
    for (std::size_t i = 0; i < weights; ++i)
      kernel.weights.push_back((static_cast<double>(random() >> 11) * 0x1p-53 - 0.3) / static_cast<double>(weights));
    const auto filtered = filter_image(image.view(), kernel);
    const std::vector<float> values(filtered.values.begin(), filtered.values.end());
    for (std::size_t i = 0; i < values.size(); ++i) crossed += (values[i] >= 40) != (image.values[i] >= 40) ? 1 : 0;
    const auto contour = extract_placed<double>(image.view(), 40, by(Positions::filtered, values), {.epsilon = 0.001});
    EXPECT_TRUE(same_bytes(contour.simplices, extract<double>(image.view(), 40).simplices)) << N << ' ' << seed;
    if constexpr (N < 5) expect_sides(image, 40, contour);
  }
  EXPECT_GT(crossed, 0u);  // samples would change their sides without clamping
}
TEST(Positions, FilteredByRandomKernelsEverySampleStaysOnItsSide) {
  expect_sides_for_random_kernels<2, std::uint8_t>(12, 6);
  expect_sides_for_random_kernels<2, float>(12, 6);
  expect_sides_for_random_kernels<3, std::int16_t>(6, 4);
  expect_sides_for_random_kernels<3, double>(6, 4);
  expect_sides_for_random_kernels<4, float>(4, 2);
  expect_sides_for_random_kernels<5, std::uint8_t>(4, 2);
}

TEST(Positions, CustomGetsTheSamplesAndTheIsovalue) {
  const std::vector<float> values = {0, 3, 0, 3};
  const Image<float, 2> image(values.data(), Grid<2>::unit({2, 2}));
  PositionOptions options = by(Positions::custom);
  options.custom = [](double first, double second, double isovalue) {
    EXPECT_EQ(first, 0);
    EXPECT_EQ(second, 3);
    EXPECT_EQ(isovalue, 1.5);
    return 0.125;
  };
  const auto contour = extract_placed(image, 1.5, options);
  ASSERT_EQ(contour.vertices.size(), 2u);
  EXPECT_EQ(contour.vertices[0][0], 0.125f);
  EXPECT_EQ(contour.vertices[1][0], 0.125f);
}

TEST(Positions, FunctionsOfManyEdgesGiveWhatFunctionsOfOneGive) {
  const auto expect_same = []<int N>(const OwnedImage<float, N>& image, double isovalue) {
    const PositionOptions one = by(Positions::custom);
    std::vector<std::pair<double, double>> asked[2];
    for (const unsigned threads : {1u, 3u}) {
      auto& calls = asked[threads / 3];
      PositionOptions many = by(Positions::custom);
      many.custom = {};
      many.custom_of_many = [&](std::span<const double> first, std::span<const double> second, double level,
                                std::span<double> out) {
        for (std::size_t i = 0; i < out.size(); ++i) {
          calls.emplace_back(first[i], second[i]);
          out[i] = one.custom(first[i], second[i], level);
        }
      };
      ExtractOptions options;
      options.work.threads = threads;
      options.epsilon = 0.01;
      const auto expected = extract_placed<double>(image.view(), isovalue, one, options);
      const auto actual = extract_placed<double>(image.view(), isovalue, many, options);
      EXPECT_TRUE(same_bytes(actual.vertices, expected.vertices));
      EXPECT_TRUE(same_bytes(actual.simplices, expected.simplices));
    }
    EXPECT_EQ(asked[0], asked[1]);
    EXPECT_GT(asked[0].size(), 30u);
  };
  auto missing = random_image<float, 3>(50, 1);  // more than one block of edges
  for (std::size_t i = 5; i < missing.values.size(); i += 97)
    missing.values[i] = std::numeric_limits<float>::quiet_NaN();
  expect_same(random_image<float, 2>(12, 1), 40);
  expect_same(missing, 40);
  expect_same(random_image<float, 4>(5, 3), 40);
  expect_same(random_image<float, 5>(4, 3), 40);
}

TEST(Positions, ErrorsNameTheValue) {
  const auto image = random_image<float, 2>(8, 1);
  const auto extract_by = [&](const PositionOptions& options) { return extract_placed(image.view(), 40, options); };
  expect_error(ErrorCode::InvalidArgument, "0 values; expected one for each of the image's 64 samples",
               [&] { (void)extract_by(by(Positions::filtered)); });
  PositionOptions options = by(Positions::relaxed);
  options.margin = 0.5;
  expect_error(ErrorCode::InvalidArgument, "a margin of 0.5", [&] { (void)extract_by(options); });
  options.margin = 0.1;
  options.last_axis_weight = -1;
  expect_error(ErrorCode::InvalidArgument, "last axis of -1", [&] { (void)extract_by(options); });
  options = by(Positions::custom);
  options.custom = {};
  expect_error(ErrorCode::InvalidArgument, "without a function", [&] { (void)extract_by(options); });
  options.custom = [](double, double, double) { return std::numeric_limits<double>::quiet_NaN(); };
  expect_error(ErrorCode::InvalidArgument, "returned NaN", [&] { (void)extract_by(options); });
  options.custom = [](double, double, double) -> double { throw std::out_of_range("of the caller"); };
  EXPECT_THROW((void)extract_by(options), std::out_of_range);
  options.custom_of_many = [](auto, auto, double, std::span<double> out) { std::ranges::fill(out, 0.5); };
  expect_error(ErrorCode::InvalidArgument, "two functions", [&] { (void)extract_by(options); });
  options.custom = {};
  const auto clamped = [&](double position) {
    options.custom_of_many = [=](auto, auto, double, std::span<double> out) { std::ranges::fill(out, position); };
    return extract_by(options).vertices;
  };
  EXPECT_EQ(clamped(7), clamped(1));
  expect_error(ErrorCode::InvalidArgument, "returned NaN", [&] { (void)clamped(std::nan("")); });
  options.custom_of_many = [](auto, auto, double, std::span<double>) { throw std::out_of_range("of the caller"); };
  EXPECT_THROW((void)extract_by(options), std::out_of_range);
  expect_error(ErrorCode::UnsupportedData, "gravitation of a 5D image", [] {
    const auto five = random_image<float, 5>(3, 1);
    (void)extract_placed(five.view(), 40, by(Positions::gravitation));
  });
}

TEST(Positions, ReportProgressAndCanBeCancelled) {
  const auto image = random_image<std::uint8_t, 3>(30, 0);
  for (const Positions rule : {Positions::gravitation, Positions::relaxed}) {
    double last = 0;
    ExtractOptions options;
    options.work.progress = [&](double fraction) {
      EXPECT_GE(fraction, last);
      last = fraction;
      return true;
    };
    (void)extract_placed(image.view(), 40, by(rule), options);
    EXPECT_EQ(last, 1.0);
    for (const double end : {0.0, 0.3, 0.7, 0.9}) {
      options.work.progress = [&](double fraction) { return fraction < end; };
      expect_error(ErrorCode::Cancelled, "cancelled",
                   [&] { (void)extract_placed(image.view(), 40, by(rule), options); });
    }
  }
}

TEST(Positions, DegenerateImagesAreNoErrors) {
  for (const std::array<std::size_t, 3>& sizes :
       {std::array<std::size_t, 3>{5, 5, 5}, {1, 5, 5}, {5, 5, 1}, {2, 2, 2}, {65, 2, 3}}) {
    const std::size_t count = sizes[0] * sizes[1] * sizes[2];
    for (const Positions rule : kRules)
      for (const int kind : {0, 1, 2, 3}) {
        std::vector<float> values(count, kind == 0 ? 0.0f : 1.0f);
        if (kind == 2) values[count / 2] = 0;
        if (kind == 3) values.assign(count, std::numeric_limits<float>::quiet_NaN());
        const Image<float, 3> image(values.data(), Grid<3>::unit(sizes));
        const auto contour = extract_placed(image, 0.5, by(rule, values));
        EXPECT_EQ(contour.simplices.size(), extract(image, 0.5).simplices.size());
        for (const auto& vertex : contour.vertices)
          for (const float x : vertex) EXPECT_TRUE(std::isfinite(x));
      }
  }
}

/// Root mean square distance of the vertices from the plane, inside of the image.
template <int N>
double plane_error(const std::array<double, N>& normal, double offset, std::size_t size, Positions rule) {
  std::array<std::size_t, N> sizes;
  sizes.fill(size);
  const double middle = static_cast<double>(size) / 2;
  const auto above = [&](const auto& x) {
    double sum = -offset;
    for (int a = 0; a < N; ++a) sum += normal[a] * (static_cast<double>(x[a]) - middle);
    return sum;
  };
  const auto image =
      sample_field<std::uint8_t, N>(Grid<N>::unit(sizes), [&](const Point<N>& x) { return above(x) >= 0 ? 1.0 : 0.0; });
  const auto contour = extract_placed<double>(image.view(), 0.5, by(rule));
  double sum = 0, count = 0;
  for (const auto& vertex : contour.vertices) {
    bool inner = true;
    for (const double x : vertex) inner = inner && std::abs(x - middle) < middle * 0.8;
    if (!inner) continue;
    sum += above(vertex) * above(vertex);
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(Relaxed, TiltedLinesAndPlanesOfBinarySamplesAreFlat) {
  for (int degrees = 1; degrees < 90; ++degrees) {
    if (degrees == 45) continue;
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_LT(plane_error<2>({std::sin(angle), std::cos(angle)}, 0.37, 240, Positions::relaxed), 0.05) << degrees;
  }
  EXPECT_NEAR(plane_error<2>({std::sin(0.2618), std::cos(0.2618)}, 0.37, 240, Positions::linear), 0.25, 0.01);
  for (const double angle : {0.1, 0.35, 0.5, 0.7, 1.2})
    for (const double turn : {0.2, 0.45, 0.9}) {
      const double s = std::sin(angle);
      EXPECT_LT(plane_error<3>({s * std::sin(turn), s * std::cos(turn), std::cos(angle)}, 0.2, 48, Positions::relaxed),
                0.08)
          << angle << ' ' << turn;
    }
}

TEST(Relaxed, PlanesWithASingleStepInOneDirectionAreFlat) {
  // each has curves of one step, or of runs that differ once; by the lines of their segments alone, 0.09 to 0.16
  EXPECT_LT(plane_error<3>({-0.9982, 0.0022, 0.0592}, 0.57, 96, Positions::relaxed), 0.02);
  EXPECT_LT(plane_error<3>({0.1523, 0.0074, 0.9883}, 0.477, 96, Positions::relaxed), 0.02);
  EXPECT_LT(plane_error<3>({0.9826, -0.0047, 0.1859}, 0.804, 96, Positions::relaxed), 0.02);
  EXPECT_LT(plane_error<3>({0.0070, -0.7085, 0.7057}, 0.21, 96, Positions::relaxed), 0.06);
}

TEST(Relaxed, BallsOfBinarySamplesKeepTheirVolume) {
  std::mt19937_64 random(7);
  double mean = 0;
  constexpr int kBalls = 12;
  for (int i = 0; i < kBalls; ++i) {
    Ball<3> ball{{}, 20};
    for (double& x : ball.centre) x = 24 + static_cast<double>(random() >> 11) * 0x1p-53;
    const auto image = sample_field<std::uint8_t, 3>(Grid<3>::unit({50, 50, 50}),
                                                     [&](const Point<3>& x) { return ball(x) >= 0 ? 1.0 : 0.0; });
    const auto contour = extract_placed<double>(image.view(), 0.5, by(Positions::relaxed));
    const double error = *measure(contour).content / ball.content() - 1.0;
    EXPECT_NEAR(error, 0.0, 0.0025) << i;
    mean += error / kBalls;
    if (i == 0) {
      EXPECT_TRUE(find_intersections(contour).is_embedded());
    }
  }
  EXPECT_NEAR(mean, 0.0, 0.001);
}

TEST(Relaxed, TheLastAxisMayHaveNoWeight) {
  // a bar in each layer, which jumps from layer to layer: every layer is smoothed by itself
  OwnedImage<std::uint8_t, 3> image{Grid<3>::unit({30, 30, 4}), std::vector<std::uint8_t>(30 * 30 * 4)};
  for_each_sample<3>(image.grid, [&](std::size_t i, const std::array<std::size_t, 3>& x) {
    image.values[i] = 10 * x[1] > 2 * x[0] + (x[2] % 2 == 0 ? 60 : 130) && x[1] < 24 ? 1 : 0;
  });
  PositionOptions options = by(Positions::relaxed);
  options.last_axis_weight = 0;
  const auto contour = extract_placed<double>(image.view(), 0.5, options);
  const Image<std::uint8_t, 2> layer(image.values.data() + 900, Grid<2>::unit({30, 30}));
  const auto alone = extract_placed<double>(layer, 0.5, by(Positions::relaxed));
  std::size_t found = 0;
  for (const auto& vertex : alone.vertices)
    for (const auto& other : contour.vertices)
      if (other[2] == 1 && other[0] == vertex[0] && other[1] == vertex[1]) ++found;
  EXPECT_EQ(found, alone.vertices.size());
}

TEST(Gravitation, StaysInTheDoublePyramidAndOnTheBorder) {
  const auto image = random_image<std::uint8_t, 3>(12, 2);
  const auto linear = extract<double>(image.view(), 40);
  const auto moved = extract_placed<double>(image.view(), 40, by(Positions::gravitation));
  ASSERT_EQ(moved.vertices.size(), linear.vertices.size());
  for (std::size_t v = 0; v < moved.vertices.size(); ++v)
    for (int a = 0; a < 3; ++a) {
      const double before = linear.vertices[v][a], after = moved.vertices[v][a];
      const bool along = before != std::round(before);
      EXPECT_LE(std::abs(after - before), along ? 0.0 : 1.0 / 3 + 1e-12);  // 40 of 60: a third of an edge from one end
      if (before == 0 || before == 11) {
        EXPECT_EQ(after, before);
      }
    }
}

/// Compares all vertices on edges of a mask (samples 0 and 1, or missing) with the formula.
void expect_gravitation(const OwnedImage<float, 3>& image) {
  const auto view = image.view();
  const auto linear = extract<double>(view, 0.5);
  const auto moved = extract_placed<double>(view, 0.5, by(Positions::gravitation));
  std::size_t off = 0;
  for (std::size_t v = 0; v < linear.vertices.size(); ++v) {
    auto expected = linear.vertices[v];
    std::array<std::size_t, 3> low{};
    int axis = -1, halves = 0;
    for (int a = 0; a < 3; ++a) {
      low[a] = static_cast<std::size_t>(expected[a]);
      if (expected[a] == std::floor(expected[a])) continue;
      axis = a;
      ++halves;
    }
    if (halves != 1) continue;  // inside a cell
    std::array<int, 3> pull{};
    int all = 0;
    for (int j = 0; j < 3; ++j) {
      if (j == axis || low[j] == 0 || low[j] + 1 == view.size(j)) continue;
      for (const std::size_t up : {0u, 1u}) {
        auto end = low;
        end[axis] += up;
        const auto alike = [&](std::size_t at) {
          auto beside = end;
          beside[j] = at;
          return std::isnan(view(beside)) || view(beside) == view(end) ? 1 : 0;
        };
        pull[j] += alike(low[j] + 1) - alike(low[j] - 1);
      }
      all += std::abs(pull[j]);
    }
    for (int j = 0; j < 3; ++j) expected[j] += pull[j] * (all > 1 ? 0.4995 / all : 0.25);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(moved.vertices[v][a], expected[a], 1e-12) << v;
    off += all > 0 ? 1 : 0;
  }
  EXPECT_GT(off, 100u);
}

TEST(Gravitation, IsItsFormulaAlsoBesideMissingSamples) {
  // rows of more than a word
  OwnedImage<float, 3> image{Grid<3>::unit({70, 7, 6}), std::vector<float>(70 * 7 * 6)};
  std::mt19937_64 random(5);
  for (float& value : image.values) value = static_cast<float>(random() % 2);
  expect_gravitation(image);
  for (float& value : image.values)
    if (random() % 20 == 0) value = std::numeric_limits<float>::quiet_NaN();
  expect_gravitation(image);
}

TEST(Gravitation, StepsOfTheAxesAndTheWorldMapScaleMoves) {
  OwnedImage<float, 3> image{Grid<3>::unit({9, 8, 7}), std::vector<float>(9 * 8 * 7)};
  std::mt19937_64 random(6);
  for (float& value : image.values) value = static_cast<float>(random() % 2);
  const auto unit = extract_placed<double>(image.view(), 0.5, by(Positions::gravitation));
  for (const bool mapped : {false, true}) {
    for (int a = 0; a < 3; ++a) {
      std::vector<double> positions;
      for (std::size_t i = 0; i < image.grid.axes[a].size(); ++i)
        positions.push_back(0.25 * static_cast<double>(i * i) + (a + 1) * static_cast<double>(i));
      image.grid.axes[a] = Axis::rectilinear(positions);
    }
    if (mapped) image.grid.linear = {{{2, 1, 0}, {0, 1, 0}, {-1, 0, 0.5}}};
    const auto moved = extract_placed<double>(image.view(), 0.5, by(Positions::gravitation));
    ASSERT_EQ(moved.vertices.size(), unit.vertices.size());
    for (std::size_t v = 0; v < unit.vertices.size(); ++v) {
      Point<3> place, expected{};
      for (int a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(unit.vertices[v][a]);
        const Axis& axis = image.grid.axes[a];
        const double rest = unit.vertices[v][a] - static_cast<double>(i);
        place[a] = axis[i] + (rest == 0 ? 0 : rest * (axis[i + 1] - axis[i]));
      }
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) expected[a] += image.grid.linear[a][b] * place[b];
      for (int a = 0; a < 3; ++a) EXPECT_NEAR(moved.vertices[v][a], expected[a], 1e-12) << v;
    }
  }
}

}  // namespace
}  // namespace tegl::test
