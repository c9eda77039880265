// SPDX-License-Identifier: BSD-3-Clause
//
// Options of contours of complexes: caps at the border, rules that read the data, and normals; each also against the
// image whose cells the complex has.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "compare.hpp"
#include "complex/complex_cases.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "meshes.hpp"
#include "tegl/complex.hpp"
#include "tegl/intersections.hpp"
#include "tegl/lattice.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr Ambiguity kRules[] = {Ambiguity::low,    Ambiguity::high,    Ambiguity::mean,
                                Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider};

/// Noise in [0, 1), also on the border.
template <int N>
std::vector<double> open_noise(const MeshData<N>& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> values(mesh.points.size());
  for (double& value : values) value = static_cast<double>(random() >> 11) * 0x1p-53;
  return values;
}

/// Meshes of every type and of mixed types.
std::vector<MeshData<3>> all_meshes(std::size_t samples, double jitter) {
  const MeshData<3> points = grid_points<3>({samples, samples, samples}, jitter);
  return {cube_mesh(points, true), kuhn_mesh(points),    five_tetrahedra_mesh(points),
          wedge_mesh(points),      pyramid_mesh(points), mixed_mesh(points, 5)};
}

template <int N>
Complex<N> complex_of(const MeshData<N>& mesh, const std::vector<double>& values) {
  Complex<N> complex = mesh.complex();
  complex.set_values(values);
  return complex;
}

template <int N>
void expect_options_of_grid(const std::array<std::size_t, N>& sizes) {
  const MeshData<N> mesh = cube_mesh(grid_points<N>(sizes), true);
  const std::vector<double> values = open_noise(mesh, 5);
  const Complex<N> complex = complex_of(mesh, values);
  const OwnedImage<double, N> image = image_of(mesh, values);
  for (const Ambiguity rule : kRules)
    for (const bool close : {false, true}) {
      SCOPED_TRACE(testing::Message() << "rule " << static_cast<int>(rule) << (close ? " closed" : ""));
      ExtractOptions options;
      options.ambiguity = rule;
      options.close = close;
      EXPECT_TRUE(same_surface(extract(image.view(), 0.5, options), extract(complex, 0.5, options)));
      options.triangulation = Triangulation::barycentric;
      EXPECT_EQ(count(image.view(), 0.5, options), count(complex, 0.5, options));
    }
}

TEST(ComplexOptions, AGridsOwnCellsHaveTheGridsContourWithEveryRuleOpenAndClosed) {
  expect_options_of_grid<2>({33, 17});
  expect_options_of_grid<3>({17, 9, 9});  // steps and places in cubes are exact
}

TEST(ComplexOptions, NoiseHasAClosedOrientedManifoldWithRulesThatReadTheData) {
  for (const MeshData<3>& mesh : all_meshes(14, 0.15)) {
    const Complex<3> complex = complex_of(mesh, closed_noise(mesh, 11));
    for (const Ambiguity rule : kRules)
      for (const Triangulation t : {Triangulation::compact, Triangulation::barycentric}) {
        ExtractOptions options;
        options.ambiguity = rule;
        options.triangulation = t;
        const auto contour = extract(complex, 0.5, options);
        expect_closed_manifold(contour);
        EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, options));
      }
  }
}

TEST(ComplexOptions, ContoursByRulesThatReadTheDataDoNotIntersectThemselvesInCellsWithFlatFaces) {
  const MeshData<3> points = grid_points<3>({9, 9, 9});
  for (const MeshData<3>& mesh : {cube_mesh(points, true), wedge_mesh(points), pyramid_mesh(points)}) {
    const Complex<3> complex = complex_of(mesh, closed_noise(mesh, 17));
    for (const Ambiguity rule : {Ambiguity::mean, Ambiguity::saddle})
      for (const Triangulation t : {Triangulation::compact, Triangulation::barycentric}) {
        ExtractOptions options;
        options.ambiguity = rule;
        options.triangulation = t;
        const auto contour = extract<double>(complex, 0.5, options);
        EXPECT_GT(contour.simplices.size(), 500u);
        EXPECT_EQ(0u, find_intersections(contour).pair_count);
      }
  }
}

/// The content of the high part, and of the low part as the high part of the negative.
template <int N>
double content_of_both(Complex<N> complex, double isovalue, ExtractOptions options) {
  options.close = true;
  const auto high = extract<double>(complex, isovalue, options);
  expect_closed_manifold(high);
  EXPECT_EQ((ContourSize{high.vertices.size(), high.simplices.size()}), count(complex, isovalue, options));
  std::vector<double> negative = complex.values();
  for (double& value : negative) value = -value;
  complex.set_values(negative);
  if (options.ambiguity == Ambiguity::low)
    options.ambiguity = Ambiguity::high;
  else if (options.ambiguity == Ambiguity::high)
    options.ambiguity = Ambiguity::low;
  const auto low = extract<double>(complex, -isovalue, options);
  expect_closed_manifold(low);
  return measure(high).content.value() + measure(low).content.value();
}

TEST(ComplexOptions, ClosedPartsOfBothSidesFillTheMesh) {
  MeshData<2> mesh2 = kuhn_mesh(grid_points<2>({40, 40}, 0.2));
  for (const MeshData<2>& mesh : {mesh2, cube_mesh(grid_points<2>({40, 40}, 0.2), true)})
    for (const Ambiguity rule : {Ambiguity::low, Ambiguity::mean, Ambiguity::saddle}) {
      ExtractOptions options;
      options.ambiguity = rule;
      EXPECT_NEAR(4.0, content_of_both(complex_of(mesh, open_noise(mesh, 3)), 0.4, options), 1e-9);
    }
  // hexahedra with faces that are not flat: both sides have the same triangles in them
  for (const MeshData<3>& mesh : all_meshes(11, 0.15))
    for (const Triangulation t : {Triangulation::compact, Triangulation::barycentric})
      for (const Ambiguity rule : {Ambiguity::low, Ambiguity::high}) {
        ExtractOptions options;
        options.ambiguity = rule;
        options.triangulation = t;
        EXPECT_NEAR(8.0, content_of_both(complex_of(mesh, open_noise(mesh, 3)), 0.4, options), 1e-9);
      }
}

TEST(ComplexOptions, InFourDimensionsClosedPartsOfBothSidesFillTheMesh) {
  const auto points = grid_points<3>({5, 5, 5}, 0.15);
  const std::vector<double> times = {0.0, 0.5, 2.0};
  for (const MeshData<3>& mesh : {mixed_mesh(points, 7), wedge_mesh(points), pyramid_mesh(points), cube_mesh(points)}) {
    std::vector<double> values;
    for (std::uint64_t k = 0; k < times.size(); ++k)
      for (const double value : open_noise(mesh, 70 + k)) values.push_back(value);
    const Complex<4> swept = in_time(mesh.complex(), times, values);
    for (const Ambiguity rule : {Ambiguity::low, Ambiguity::high}) {
      ExtractOptions options;
      options.ambiguity = rule;
      EXPECT_NEAR(16.0, content_of_both(swept, 0.4, options), 1e-9);
    }
  }
  const MeshData<4> simplices = kuhn_mesh(grid_points<4>({4, 4, 4, 4}, 0.1));
  EXPECT_NEAR(16.0, content_of_both(complex_of(simplices, open_noise(simplices, 3)), 0.4, {}), 1e-9);
}

/// Expects that contours of noise, closed at the border, are manifolds that do not intersect themselves.
void expect_embedded_closed(Complex<4> complex, const std::string& name) {
  std::mt19937_64 random(7);
  std::vector<double> values(complex.points().size());
  for (double& value : values) value = static_cast<double>(random() >> 11) * 0x1p-53;
  complex.set_values(values);
  ExtractOptions options;
  options.close = true;
  for (options.triangulation = Triangulation::compact;; options.triangulation = Triangulation::barycentric) {
    const bool is_compact = options.triangulation == Triangulation::compact;
    for (const Ambiguity rule : kAllRules) {
      SCOPED_TRACE(testing::Message() << name << (is_compact ? " compact " : " barycentric ")
                                      << static_cast<int>(rule));
      options.ambiguity = rule;
      const auto contour = extract<double>(complex, 0.5, options);
      EXPECT_GT(contour.simplices.size(), 800u);
      expect_closed_manifold(contour);
      EXPECT_TRUE(find_intersections(contour).is_embedded());
    }
    if (!is_compact) return;
  }
}

TEST(ComplexOptions, InFourDimensionsClosedContoursDoNotIntersectThemselves) {
  const auto points = grid_points<3>({4, 4, 4});
  const std::vector<double> times = {0.0, 0.5, 2.0};
  const std::vector<double> values(3 * points.points.size());
  expect_embedded_closed(in_time(kuhn_mesh(points).complex(), times, values), "tetrahedra");
  expect_embedded_closed(in_time(wedge_mesh(points).complex(), times, values), "wedges");
  expect_embedded_closed(in_time(cube_mesh(points).complex(), times, values), "hexahedra");
  for (const MeshData<3>& mesh : {pyramid_mesh(points), mixed_mesh(points, 5)})  // more points
    expect_embedded_closed(in_time(mesh.complex(), times, std::vector<double>(3 * mesh.points.size())), "mixed");
  const OwnedImage<double, 4> samples{Grid<4>::unit({4, 4, 4, 3}), Values<double>(std::vector<double>(192))};
  expect_embedded_closed(lattice_complex(samples.view(), Lattice::fcc_in_time), "octahedra");
}

TEST(ComplexOptions, ABallThatTheBorderCutsIsClosedThere) {
  for (const MeshData<3>& mesh : all_meshes(15, 0.1)) {
    const auto ball = [](const std::array<double, 3>& x) {
      return 0.81 - std::hypot(x[0] - 0.9, x[1] + 0.95, x[2] - 0.02);
    };
    Complex<3> complex = complex_of(mesh, values_of(mesh, ball));
    ExtractOptions options;
    options.close = true;
    const auto contour = extract<double>(complex, 0.0, options);
    EXPECT_EQ(2, expect_closed_manifold(contour).euler);
    options.close = false;
    EXPECT_GT(expect_oriented_manifold(extract(complex, 0.0, options)).boundary_simplices, 20u);
    options.close = true;
    complex.find_border();
    complex.find_edges();
    for (const unsigned threads : {1u, 3u}) {
      options.work.threads = threads;
      const auto again = extract<double>(complex, 0.0, options);
      EXPECT_TRUE(contour.vertices == again.vertices);
      EXPECT_TRUE(contour.simplices == again.simplices);
    }
  }
}

TEST(ComplexOptions, ClosedContoursAreManifoldsBesideMissingValues) {
  for (const MeshData<3>& mesh : all_meshes(9, 0.15)) {
    std::vector<double> values = open_noise(mesh, 8);
    std::mt19937_64 random(9);
    for (double& value : values)
      if (random() % 12 == 0) value = std::numeric_limits<double>::quiet_NaN();
    const Complex<3> complex = complex_of(mesh, values);
    ExtractOptions options;
    options.close = true;
    options.ambiguity = Ambiguity::mean;
    options.normals = Normals::differences;
    const auto contour = extract(complex, 0.5, options);
    EXPECT_GT(expect_oriented_manifold(contour).boundary_simplices, 100u);
    EXPECT_EQ(contour.vertices.size(), contour.normals.size());
    EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, options));
  }
}

TEST(ComplexOptions, MovingMeshesWithRulesThatReadTheDataAreCutAsTheirSteps) {
  const auto points = grid_points<2>({30, 30}, 0.2);
  const std::vector<double> times = {0.0, 1.0, 1.5};
  for (const MeshData<2>& mesh : {kuhn_mesh(points), cube_mesh(points, true)}) {
    std::vector<double> values;
    for (std::uint64_t k = 0; k < times.size(); ++k)
      for (const double value : closed_noise(mesh, 60 + k)) values.push_back(value);
    const Complex<3> swept = in_time(mesh.complex(), times, values);
    for (const Ambiguity rule : {Ambiguity::mean, Ambiguity::saddle}) {
      ExtractOptions options;
      options.triangulation = Triangulation::barycentric;
      options.ambiguity = rule;
      const auto contour = extract(swept, 0.5, options);
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(mesh.points.size());
      const Complex<2> step = complex_of(mesh, {first, first + static_cast<std::ptrdiff_t>(mesh.points.size())});
      EXPECT_TRUE(same_surface(slice(contour, Hyperplane<3>::across(2, 1.0)), extract(step, 0.5, options)));
      expect_closed_manifold(slice(contour, Hyperplane<3>::across(2, 0.3)));
    }
  }
}

/// The largest difference between normals of vertices at equal places, on edges.
template <int N>
double largest_difference(const Contour<N, double>& a, const Contour<N, double>& b) {
  std::vector<std::pair<std::array<double, N>, std::array<double, N>>> all[2];
  for (const auto* contour : {&a, &b}) {
    auto& list = all[contour == &a ? 0 : 1];
    EXPECT_EQ(contour->vertices.size(), contour->normals.size());
    for (std::size_t v = 0; v < contour->vertices.size(); ++v)
      list.emplace_back(contour->vertices[v], contour->normals[v]);
    std::sort(list.begin(), list.end());
  }
  double largest = 0.0;
  EXPECT_EQ(all[0].size(), all[1].size());
  for (std::size_t v = 0; v < std::min(all[0].size(), all[1].size()); ++v)
    for (int i = 0; i < N; ++i) largest = std::max(largest, std::abs(all[0][v].second[i] - all[1][v].second[i]));
  return largest;
}

template <int N>
void expect_normals_of_grid(const std::array<std::size_t, N>& sizes) {
  const MeshData<N> mesh = cube_mesh(grid_points<N>(sizes), true);
  std::vector<double> values = open_noise(mesh, 15);
  ExtractOptions options;
  options.normals = Normals::differences;
  options.close = true;
  for (const bool has_missing : {false, true}) {
    if (has_missing) values[values.size() / 2] = std::numeric_limits<double>::quiet_NaN();
    const OwnedImage<double, N> image = image_of(mesh, values);
    const auto of_image = extract<double>(image.view(), 0.5, options);
    EXPECT_LT(largest_difference<N>(of_image, extract<double>(complex_of(mesh, values), 0.5, options)), 1e-6);
  }
}

TEST(ComplexOptions, AGridsOwnCellsHaveTheGridsNormals) {
  expect_normals_of_grid<2>({17, 9});
  expect_normals_of_grid<3>({9, 9, 5});
}

TEST(ComplexOptions, NormalsOfLinearFunctionsAreExact) {
  for (const MeshData<3>& mesh : all_meshes(6, 0.2)) {
    Complex<3> complex = complex_of(mesh, values_of(mesh, [](const auto& x) { return 2 * x[0] - x[1] + 2 * x[2]; }));
    ExtractOptions options;
    options.normals = Normals::differences;
    options.close = true;
    options.triangulation = Triangulation::barycentric;
    for (const bool ascent : {false, true}) {
      options.direction = ascent ? GradientDirection::ascent : GradientDirection::descent;
      for (const bool known : {false, true}) {
        if (known) complex.find_edges();
        const auto contour = extract<double>(complex, 0.1, options);
        ASSERT_EQ(contour.vertices.size(), contour.normals.size());
        const double sign = ascent ? 1.0 : -1.0;
        for (const auto& normal : contour.normals) {
          EXPECT_NEAR(sign * 2 / 3, normal[0], 1e-9);
          EXPECT_NEAR(-sign / 3, normal[1], 1e-9);
        }
      }
    }
  }
}

TEST(ComplexOptions, NormalsOfASphereConverge) {
  std::array<double, 2> errors{};
  for (const std::size_t fine : {0u, 1u}) {
    const MeshData<3> mesh = mixed_mesh(
        grid_points<3>(fine == 0 ? std::array<std::size_t, 3>{12, 12, 12} : std::array<std::size_t, 3>{23, 23, 23}), 5);
    ExtractOptions options;
    options.normals = Normals::differences;
    const auto contour = extract<double>(
        complex_of(mesh, values_of(mesh, [](const auto& x) { return 0.7 - std::hypot(x[0], x[1], x[2]); })), 0.0,
        options);
    for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
      const auto& x = contour.vertices[v];
      const double length = std::hypot(x[0], x[1], x[2]);
      for (std::size_t i = 0; i < 3; ++i)
        errors[fine] = std::max(errors[fine], std::abs(contour.normals[v][i] - x[i] / length));
    }
  }
  EXPECT_LT(errors[0], 0.15);
  EXPECT_LT(errors[1], 0.6 * errors[0]);
}

/// Interpolates linear functions of the points, which vertices then have as well: exactly those of their coordinates.
template <int N>
void expect_interpolated(const Complex<N>& complex, const ExtractOptions& options) {
  constexpr std::size_t kWidth = N + 1;
  const auto numbers_at = [](const auto& x) {
    std::array<double, kWidth> numbers{};
    for (std::size_t i = 0; i < kWidth; ++i)
      for (std::size_t a = 0; a < N; ++a) numbers[i] += x[a] * static_cast<double>((i + 2 * a) % 5);
    return numbers;
  };
  std::vector<double> numbers;
  for (const auto& point : complex.points())
    for (const double x : numbers_at(point)) numbers.push_back(x);
  const auto contour = extract<double>(complex, 0.4, options);
  const Attribute found = interpolate_points(complex, 0.4, numbers, "p", "Pa", options);
  EXPECT_EQ(found.unit, "Pa");
  ASSERT_EQ(found.values.size(), kWidth * contour.vertices.size());
  ASSERT_GT(contour.vertices.size(), 50u);
  for (std::size_t v = 0; v < contour.vertices.size(); ++v)
    for (std::size_t i = 0; i < kWidth; ++i)
      ASSERT_NEAR(found.values[v * kWidth + i], numbers_at(contour.vertices[v])[i], 1e-12);
}

TEST(ComplexOptions, NumbersAtPointsAreInterpolatedAsCoordinates) {
  for (const MeshData<3>& mesh : all_meshes(6, 0.2))
    for (const Ambiguity rule : kRules) {
      ExtractOptions options;
      options.ambiguity = rule;
      options.close = rule == Ambiguity::mean;
      options.epsilon = rule == Ambiguity::high ? 0.1 : 0.0;
      options.normals = Normals::differences;
      expect_interpolated(complex_of(mesh, open_noise(mesh, 4)), options);
    }
  const MeshData<2> flat = cube_mesh(grid_points<2>({12, 12}, 0.2));
  expect_interpolated(complex_of(flat, open_noise(flat, 5)), {});
  const MeshData<3> mesh = mixed_mesh(grid_points<3>({5, 5, 5}, 0.2), 7);
  std::vector<double> values = open_noise(mesh, 6);
  const std::vector<double> later = open_noise(mesh, 7);
  values.insert(values.end(), later.begin(), later.end());
  const Complex<4> moving = in_time<3>(mesh.complex(), std::array{0.5, 2.0}, values);
  expect_interpolated(moving, {});
}

TEST(ComplexOptions, MissingNumbersAtPointsAreMissingAtTheirVertices) {
  const MeshData<3> mesh = kuhn_mesh(grid_points<3>({7, 7, 7}, 0.2));
  const Complex<3> complex = complex_of(mesh, open_noise(mesh, 8));
  std::vector<double> numbers(mesh.points.size(), 1.0);
  numbers[171] = std::numeric_limits<double>::quiet_NaN();
  std::size_t missing = 0;
  for (const double x : interpolate_points(complex, 0.5, numbers, "p").values) {
    missing += std::isnan(x) ? 1 : 0;
    EXPECT_TRUE(std::isnan(x) || x == 1.0);
  }
  EXPECT_GT(missing, 0u);
  EXPECT_LT(missing, 15u);  // edges of one point
  numbers.pop_back();
  expect_error(ErrorCode::InvalidArgument, "342 numbers; expected one or several for each of the 343 points",
               [&] { (void)interpolate_points(complex, 0.5, numbers, "p"); });
}

template <class I, class Real, int N>
void expect_same_in_memory_of_the_caller(const Complex<N>& complex, const ExtractOptions& options) {
  const auto contour = extract<Real>(complex, 0.5, options);
  const ContourSize size = count(complex, 0.5, options);
  EXPECT_EQ(size, (ContourSize{contour.vertices.size(), contour.simplices.size()}));
  EXPECT_GT(size.simplices, 100u);
  // the last of each is beyond the contour
  std::vector<std::array<Real, N>> vertices(size.vertices + 1), normals(size.vertices + 1);
  std::vector<std::array<I, N>> simplices(size.simplices + 1);
  vertices.back().fill(Real{5});
  normals.back().fill(Real{6});
  simplices.back().fill(I{7});
  const ContourRoom<N, Real, I> room{vertices, simplices, normals};
  const ExtractedSize written = extract_into(complex, 0.5, room, options);
  EXPECT_EQ(written.size, size);
  EXPECT_GT(written.stats.active_tiles, 0u);
  for (int j = 0; j < N; ++j) {
    EXPECT_EQ(vertices.back()[j], Real{5});
    EXPECT_EQ(normals.back()[j], Real{6});
    EXPECT_EQ(simplices.back()[j], I{7});
  }
  EXPECT_TRUE(std::equal(contour.vertices.begin(), contour.vertices.end(), vertices.begin()));
  EXPECT_TRUE(std::equal(contour.normals.begin(), contour.normals.end(), normals.begin()));
  if (contour.normals.empty()) {
    EXPECT_EQ(normals.front(), (std::array<Real, N>{}));
  }
  for (std::size_t s = 0; s < size.simplices; ++s)
    for (int j = 0; j < N; ++j) ASSERT_EQ(simplices[s][j], contour.simplices[s][j]) << "simplex " << s;

  const auto is_short = [&](const ContourRoom<N, Real, I>& less, std::size_t rows, const std::string& items) {
    expect_error(ErrorCode::InvalidArgument, "room for " + std::to_string(rows) + " " + items,
                 [&] { (void)extract_into(complex, 0.5, less, options); });
  };
  is_short({room.vertices.first(size.vertices - 1), simplices, normals}, size.vertices - 1, "vertices");
  is_short({vertices, room.simplices.first(size.simplices - 1), normals}, size.simplices - 1, "simplices");
  if (options.normals != Normals::none)
    is_short({vertices, simplices, room.normals.first(size.vertices - 1)}, size.vertices - 1, "normals");
}

template <int N>
void expect_same_in_memory_of_the_caller(Complex<N> complex, std::vector<double> values) {
  std::mt19937_64 random(8);
  for (const bool has_missing : {false, true}) {
    if (has_missing)
      for (double& value : values) value = random() % 15 == 0 ? std::numeric_limits<double>::quiet_NaN() : value;
    complex.set_values(values);
    for (ExtractOptions options : fixed_rules())
      for (const bool is_closed : {false, true}) {
        options.close = is_closed;
        options.normals = is_closed ? Normals::differences : Normals::none;
        expect_same_in_memory_of_the_caller<std::uint32_t, float>(complex, options);
        expect_same_in_memory_of_the_caller<std::uint64_t, double>(complex, options);
      }
    ExtractOptions mean;
    mean.ambiguity = Ambiguity::mean;
    mean.normals = Normals::differences;
    expect_same_in_memory_of_the_caller<std::uint64_t, float>(complex, mean);
    expect_same_in_memory_of_the_caller<std::uint32_t, double>(complex, mean);
  }
}

TEST(ComplexOptions, ContoursInMemoryOfTheCallerAreTheSameBytes) {
  const MeshData<2> plane = cube_mesh(grid_points<2>({20, 20}, 0.15), true);
  expect_same_in_memory_of_the_caller(plane.complex(), open_noise(plane, 3));
  const MeshData<3> mesh = mixed_mesh(grid_points<3>({8, 8, 8}, 0.15), 5);
  expect_same_in_memory_of_the_caller(mesh.complex(), open_noise(mesh, 4));
  const MeshData<3> small = mixed_mesh(grid_points<3>({5, 5, 5}, 0.15), 6);
  const std::vector<double> times = {0.0, 1.0, 1.5};
  std::vector<double> values;
  for (std::uint64_t k = 0; k < times.size(); ++k)
    for (const double value : open_noise(small, k)) values.push_back(value);
  expect_same_in_memory_of_the_caller(in_time(small.complex(), times, values), values);
}

TEST(ComplexOptions, OptionsWithoutMeaningOnAComplexAreErrors) {
  const MeshData<3> mesh = cube_mesh(grid_points<3>({3, 3, 3}));
  const Complex<3> complex = complex_of(mesh, open_noise(mesh, 1));
  const auto refuse = [](const auto& of, const std::string& part, auto change) {
    ExtractOptions options;
    change(options);
    expect_error(ErrorCode::InvalidArgument, part, [&] { (void)extract(of, 0.5, options); });
    expect_error(ErrorCode::InvalidArgument, part, [&] { (void)count(of, 0.5, options); });
  };
  refuse(complex, "custom estimator", [](ExtractOptions& o) {
    o.ambiguity = Ambiguity::custom;
    o.estimator.choose = [](const AmbiguousFace&) { return tile::Choice::low; };
  });
  refuse(complex, "sobel normals; expected gradient", [](ExtractOptions& o) { o.normals = Normals::sobel; });
}

}  // namespace
}  // namespace tegl
