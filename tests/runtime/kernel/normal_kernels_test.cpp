// SPDX-License-Identifier: BSD-3-Clause
//
// Normals by kernels of the caller, by one-sided differences and by context: against each other, on linear fields, and
// on phantoms of two materials whose normals are known.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include "fields.hpp"
#include "tegl/eigen.hpp"
#include "tegl/error.hpp"
#include "tegl/extract.hpp"
#include "tegl/normals.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

using ::testing::HasSubstr;

template <int N>
std::size_t kernel_size() {
  std::size_t size = 1;
  for (int a = 0; a < N; ++a) size *= 3;
  return size;
}

/// The kernel for the derivative along axis 0 with `weight(d)` on lines that are displaced along d axes, forward and
/// backward.
template <int N, class Weight>
GradientKernel kernel_of(const Weight& weight) {
  GradientKernel kernel;
  for (std::size_t i = 0; i < kernel_size<N>(); ++i) {
    int away = 0;
    std::size_t rest = i / 3;
    for (int a = 1; a < N; ++a, rest /= 3) away += rest % 3 == 1 ? 0 : 1;
    kernel.weights.push_back(weight(away) * (static_cast<double>(i % 3) - 1.0));
  }
  return kernel;
}

ExtractOptions options_of(Normals kind, GradientKernel kernel = {}) {
  ExtractOptions options;
  options.normals = kind;
  options.kernel = std::move(kernel);
  return options;
}

template <int N>
double largest_difference(const Contour<N, double>& a, const Contour<N, double>& b) {
  double largest = a.normals.size() == b.normals.size() && !a.normals.empty() ? 0.0 : 1e300;
  for (std::size_t v = 0; v < a.normals.size(); ++v)
    for (int i = 0; i < N; ++i) largest = std::max(largest, std::abs(a.normals[v][i] - b.normals[v][i]));
  return largest;
}

template <int N>
void expect_kernels_as_named_kinds(const std::array<std::size_t, N>& sizes) {
  const auto image = noise<float, N>(sizes, 3);
  const auto normals_by = [&](Normals kind, GradientKernel kernel = {}) {
    return extract<double>(image.view(), 0.5, options_of(kind, std::move(kernel)));
  };
  const auto sobel = kernel_of<N>([](int away) { return 7.0 / (1 + away); });
  EXPECT_LT(largest_difference(normals_by(Normals::kernel, sobel), normals_by(Normals::sobel)), 1e-9);
  const auto prewitt = kernel_of<N>([](int) { return 1.0; });
  EXPECT_LT(largest_difference(normals_by(Normals::kernel, prewitt), normals_by(Normals::prewitt)), 1e-9);
  EXPECT_GT(largest_difference(normals_by(Normals::kernel, prewitt), normals_by(Normals::sobel)), 1e-3);
  const auto differences = kernel_of<N>([](int away) { return away == 0 ? 0.5 : 0.0; });
  EXPECT_LT(largest_difference(normals_by(Normals::kernel, differences), normals_by(Normals::differences)), 1e-9);
  GradientKernel forward = kernel_of<N>([](int) { return 0.0; });
  const std::size_t middle = kernel_size<N>() / 2;
  forward.weights[middle] = -1.0, forward.weights[middle + 1] = 1.0;
  EXPECT_LT(largest_difference(normals_by(Normals::kernel, forward), normals_by(Normals::forward)), 1e-9);
  GradientKernel backward = kernel_of<N>([](int) { return 0.0; });
  backward.weights[middle] = 1.0, backward.weights[middle - 1] = -1.0;
  EXPECT_LT(largest_difference(normals_by(Normals::kernel, backward), normals_by(Normals::backward)), 1e-9);
  EXPECT_GT(largest_difference(normals_by(Normals::forward), normals_by(Normals::backward)), 1e-3);
}

TEST(GradientKernels, GiveTheNormalsOfTheNamedKinds) {
  expect_kernels_as_named_kinds<2>({12, 9});
  expect_kernels_as_named_kinds<3>({7, 6, 5});
  expect_kernels_as_named_kinds<4>({4, 5, 4, 3});
  expect_kernels_as_named_kinds<5>({3, 3, 3, 3, 3});
}

TEST(GradientKernels, MayMixSymmetricAndOneSidedLines) {
  // along axis 0: differences to both sides on the outer lines, forward ones on the middle line, of the same weight
  GradientKernel kernel{{-0.5, 0, 0.5, 0, -1, 1, -0.5, 0, 0.5, 0, -0.5, 0, 0, 0, 0, 0, 0.5, 0}};
  const auto image = sample_field<double, 2>(Grid<2>::unit({5, 5}), [](const Point<2>& x) {
    return x[1] == 2.0 ? 2.0 * x[0] + x[1] : x[0] + x[1];  // twice as steep on the middle line
  });
  const auto contour = extract<double>(image.view(), 5.5, options_of(Normals::kernel, kernel));
  std::size_t compared = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    if (contour.vertices[v][1] != 2.0) continue;
    ++compared;  // slopes of 1, 2 and 1 on lines of the same weight
    EXPECT_NEAR(contour.normals[v][0] / contour.normals[v][1], (1.0 + 2.0 + 1.0) / 3, 1e-12);
  }
  EXPECT_EQ(compared, 1u);
}

TEST(GradientKernels, AreTheSumOfTheirWeightsTimesTheValues) {
  // one kernel for each axis, all of them different
  std::mt19937_64 bits(12);
  GradientKernel kernel;
  for (int a = 0; a < 2; ++a) {
    std::vector<double> weights(9);
    for (std::size_t line = 0; line < 3; ++line) {
      const std::size_t step = a == 0 ? 1 : 3, middle = a == 0 ? 3 * line + 1 : 3 + line;
      const double back = unit_random(bits), ahead = unit_random(bits);
      weights[middle - step] = -back, weights[middle] = back - ahead, weights[middle + step] = ahead;
    }
    kernel.weights.insert(kernel.weights.end(), weights.begin(), weights.end());
  }
  const auto image = noise<double, 2>({9, 9}, 5);
  const auto contour = extract<double>(image.view(), 0.5, options_of(Normals::kernel, kernel));
  const auto gradient = [&](std::size_t x, std::size_t y) {
    std::array<double, 2> sum{}, size{};
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t i = 0; i < 9; ++i) {
        sum[a] += kernel.weights[9 * a + i] * image.values[9 * (y + i / 3 - 1) + x + i % 3 - 1];
        const auto along = static_cast<double>(a == 0 ? i % 3 : i / 3) - 1.0;
        size[a] += kernel.weights[9 * a + i] * along;
      }
    return std::array<double, 2>{sum[0] / size[0], sum[1] / size[1]};
  };
  std::size_t compared = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    const double px = contour.vertices[v][0], py = contour.vertices[v][1];
    const auto x = static_cast<std::size_t>(px), y = static_cast<std::size_t>(py);
    if (x < 1 || y < 1 || x > 6 || y > 6) continue;
    const bool along_x = py == std::floor(py);
    const double alpha = along_x ? px - std::floor(px) : py - std::floor(py);
    const auto here = gradient(x, y), there = gradient(x + (along_x ? 1 : 0), y + (along_x ? 0 : 1));
    std::array<double, 2> expected;
    for (std::size_t a = 0; a < 2; ++a) expected[a] = -((1 - alpha) * here[a] + alpha * there[a]);
    const double length = std::hypot(expected[0], expected[1]);
    for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(contour.normals[v][a], expected[a] / length, 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 20u);
}

void expect_refused(GradientKernel kernel, const std::string& text) {
  const auto image = noise<float, 3>(4, 1);
  try {
    (void)extract(image.view(), 0.5, options_of(Normals::kernel, std::move(kernel)));
    FAIL() << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(GradientKernels, ThatAreWrongAreRefusedWithTheReason) {
  expect_refused({}, "kernel of 0 weights; expected 27, or 27 for each of 3 axes");
  expect_refused({std::vector<double>(9, 1.0)}, "kernel of 9 weights");
  expect_refused({std::vector<double>(27, 0.0)}, "have weights that sum to 0");
  expect_refused({std::vector<double>(27, 1.0)}, "the weights 1, 1, 1 on a line along axis 0; expected 0 as their sum");
  GradientKernel infinite = kernel_of<3>([](int) { return 1.0; });
  infinite.weights[4] = std::numeric_limits<double>::quiet_NaN();
  expect_refused(infinite, "weight nan; expected finite ones");
}

/// An uneven, reversed, sheared grid.
template <int N>
Grid<N> sheared_grid() {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(static_cast<std::size_t>(5 + a), 1.0, 0.7);
  grid.axes[0] = Axis::rectilinear({1.0, 1.3, 1.7, 2.2, 2.9, 3.7});
  grid.axes[1] = Axis::uniform(6, 5.0, -0.6);
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) grid.linear[a][b] = a == b ? 1.0 + 0.2 * a : 0.1 * (a - 2 * b);
  return grid;
}

template <int N>
void expect_exact_slopes(double missing) {
  const Grid<N> grid = sheared_grid<N>();
  Eigen::Matrix<double, N, 1> slope;  // in axis coordinates
  for (int a = 0; a < N; ++a) slope[a] = a % 2 == 0 ? 0.7 + a : -1.1;
  const Eigen::Matrix<double, N, 1> expected = -(as_eigen(grid.linear).inverse().transpose() * slope).normalized();
  auto image = sample_field<double, N>(grid, [&](const Point<N>& x) {
    double sum = 0;
    for (int a = 0; a < N; ++a) sum += slope[a] * x[a];
    return sum;
  });
  const double isovalue = image.values[image.values.size() / 2] + 0.01;
  std::mt19937_64 bits(4);
  for (double& value : image.values)
    if (unit_random(bits) < missing) value = std::numeric_limits<double>::quiet_NaN();
  for (const Normals kind : {Normals::differences, Normals::sobel, Normals::prewitt, Normals::context, Normals::forward,
                             Normals::backward}) {
    // On a single line, both neighbours may be missing.
    if (missing > 0.0 && (kind == Normals::forward || kind == Normals::backward)) continue;
    const auto contour = extract<double>(image.view(), isovalue, options_of(kind));
    ASSERT_GT(contour.normals.size(), 5u);
    for (const auto& normal : contour.normals)
      for (int a = 0; a < N; ++a) EXPECT_NEAR(normal[a], expected[a], 1e-6) << static_cast<int>(kind);
  }
}

TEST(NormalsOfEveryKind, OfALinearFieldAreExactOnAnyGrid) {
  expect_exact_slopes<2>(0.0);
  expect_exact_slopes<3>(0.0);
  expect_exact_slopes<4>(0.0);
  expect_exact_slopes<3>(0.02);
}

/// A ball around the origin beside a half-space of another value; the contour is the part of the sphere inside of which
/// the samples are those of the ball.
struct TwoMaterials {
  double other = 20.0;  ///< the value in the half-space; NaN: the ball is everywhere
  double radius = 12.0;
  double noise = 0.0;

  [[nodiscard]] static double beside(const Point<3>& x) { return 0.3 * x[0] + 0.953 * x[1] - 2.1; }
  [[nodiscard]] static Grid<3> grid(double step) {
    Grid<3> grid;
    const auto samples = static_cast<std::size_t>(34 / step) + 1;
    for (std::size_t a = 0; a < 3; ++a)
      grid.axes[a] = Axis::uniform(samples, 0.13 * static_cast<double>(a + 1) - 17, step);
    return grid;
  }
  [[nodiscard]] OwnedImage<float, 3> image(double step) const {
    std::mt19937_64 bits(7);
    return sample_field<float, 3>(grid(step), [&](const Point<3>& x) {
      const double inside = radius - std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
      const double value = !std::isnan(other) && beside(x) > 0 ? other : inside;
      return value + noise * std::sqrt(12.0) * (unit_random(bits) - 0.5);
    });
  }
};

/// Whether both ends of a vertex's edge are on the ball's side of the jump.
bool has_edge_in_the_ball(const Point<3>& x, const Grid<3>& grid) {
  Point<3> low, high;
  for (int a = 0; a < 3; ++a) {
    const double index = (x[a] - grid.axes[a][0]) / grid.axes[a].step();
    const bool is_between = std::abs(index - std::round(index)) > 1e-4;
    low[a] = grid.axes[a][static_cast<std::size_t>(is_between ? std::floor(index) : std::round(index))];
    high[a] = grid.axes[a][static_cast<std::size_t>(is_between ? std::ceil(index) : std::round(index))];
  }
  return TwoMaterials::beside(low) <= 0 && TwoMaterials::beside(high) <= 0;
}

/// Root mean squares of the angles, in degrees, by distance from the jump in steps of the grid.
struct AngleErrors {
  double near = 0.0;  ///< up to one step
  double far = 0.0;   ///< from three steps on
};

AngleErrors angle_errors(const TwoMaterials& phantom, Normals kind, double step = 1.0) {
  const auto image = phantom.image(step);
  const auto contour = extract<float>(image.view(), 0.0, options_of(kind));
  AngleErrors sum;
  std::size_t near = 0, far = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    Point<3> x;
    for (int a = 0; a < 3; ++a) x[a] = static_cast<double>(contour.vertices[v][a]);
    const double radius = std::hypot(x[0], x[1], x[2]);
    if (std::abs(radius - phantom.radius) > 0.3 * step) continue;  // on the jump itself
    const double distance = std::isnan(phantom.other) ? 99.0 : -TwoMaterials::beside(x) / step;
    if (distance < 99.0 && !has_edge_in_the_ball(x, image.grid)) continue;
    double along = 0.0, length = 0.0;
    for (int a = 0; a < 3; ++a) {
      const auto n = static_cast<double>(contour.normals[v][a]);
      along += n * x[a] / radius;
      length += n * n;
    }
    const double angle = std::acos(std::clamp(along / std::max(std::sqrt(length), 1e-30), -1.0, 1.0)) * 180 / M_PI;
    if (distance < 1.0) sum.near += angle * angle, ++near;
    if (distance > 3.0) sum.far += angle * angle, ++far;
  }
  return {near > 0 ? std::sqrt(sum.near / static_cast<double>(near)) : 0.0,
          std::sqrt(sum.far / static_cast<double>(far))};
}

TEST(NormalsByContext, IgnoreTheOtherMaterial) {
  const TwoMaterials phantom;
  const AngleErrors by_context = angle_errors(phantom, Normals::context);
  EXPECT_LT(by_context.near, 4.0);
  EXPECT_GT(angle_errors(phantom, Normals::differences).near, 40.0);
  EXPECT_GT(angle_errors(phantom, Normals::sobel).near, 40.0);
  EXPECT_LT(by_context.far, 1.2 * angle_errors(phantom, Normals::differences).far);
}

TEST(NormalsByContext, DampNoiseAsSobelDoes) {
  TwoMaterials phantom{.noise = 0.1};
  const AngleErrors by_context = angle_errors(phantom, Normals::context);
  EXPECT_LT(by_context.near, 6.0);
  EXPECT_LT(by_context.far, 1.2 * angle_errors(phantom, Normals::sobel).far);
  EXPECT_LT(2.0 * by_context.far, angle_errors(phantom, Normals::differences).far);
}

TEST(NormalsByContext, HaveSecondOrderOnSmoothFields) {
  const TwoMaterials phantom{.other = std::numeric_limits<double>::quiet_NaN()};
  const double coarse = angle_errors(phantom, Normals::context, 2.0).far;
  const double fine = angle_errors(phantom, Normals::context, 1.0).far;
  EXPECT_LT(fine, 0.1);
  EXPECT_GT(coarse / fine, 3.2);
}

TEST(NormalsByContext, OfAStepAreThoseOfTheStep) {
  // Both sides are flat: the contour is the jump itself.
  const auto grid = TwoMaterials::grid(1.0);
  std::mt19937_64 bits(3);
  const auto image = sample_field<float, 3>(grid, [&](const Point<3>& x) {
    return std::tanh((12.0 - std::hypot(x[0], x[1], x[2])) / 0.7) + 0.1 * std::sqrt(12.0) * (unit_random(bits) - 0.5);
  });
  const auto contour = extract<float>(image.view(), 0.0, options_of(Normals::context));
  double sum = 0.0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    double along = 0.0, radius = 0.0;
    for (int a = 0; a < 3; ++a) {
      const auto x = static_cast<double>(contour.vertices[v][a]);
      along += x * static_cast<double>(contour.normals[v][a]);
      radius += x * x;
    }
    const double angle = std::acos(std::clamp(along / std::sqrt(radius), -1.0, 1.0)) * 180 / M_PI;
    sum += angle * angle;
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(contour.vertices.size())), 4.0);
}

TEST(NormalsByContext, TellTheirUncertainty) {
  const TwoMaterials phantom{.noise = 0.05};
  const auto image = phantom.image(1.0);
  const auto contour = extract<float>(image.view(), 0.0, options_of(Normals::context));
  ASSERT_EQ(contour.vertex_attributes.size(), 1u);
  EXPECT_EQ(contour.vertex_attributes[0].name, "normal_uncertainty");
  // Positions of vertices are rounded to float, so that a few that are near a sample are taken for it.
  const auto& values = contour.vertex_attributes[0].values;
  const auto again = normal_uncertainty(image.view(), contour);
  ASSERT_EQ(values.size(), again.size());
  std::size_t different = 0;
  for (std::size_t v = 0; v < values.size(); ++v) different += std::abs(values[v] - again[v]) < 1e-4 ? 0 : 1;
  EXPECT_LE(100 * different, values.size());
  const auto mean_of = [&](const TwoMaterials& with_noise) {
    const auto noisy = with_noise.image(1.0);
    const auto u = extract<float>(noisy.view(), 0.0, options_of(Normals::context)).vertex_attributes[0].values;
    double sum = 0.0;
    for (const double x : u) {
      EXPECT_GE(x, 0.0);
      EXPECT_LE(x, 1.0);
      sum += x;
    }
    return sum / static_cast<double>(u.size());
  };
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LT(2.0 * mean_of({.other = kNone, .noise = 0.02}), mean_of({.other = kNone, .noise = 0.2}));
  auto moved = contour;
  moved.vertices[0][0] = 100.0f;
  EXPECT_EQ(normal_uncertainty(image.view(), moved)[0], 1.0);
}

template <int N, class Real>
void expect_context_as_extracted(const Grid<N>& grid, double tolerance) {
  const auto image = noise<float, N>(grid, 5);
  const auto contour = extract<Real>(image.view(), 0.5, options_of(Normals::context));
  ExtractOptions many = options_of(Normals::context);
  many.work.threads = 3;
  const auto again = extract<Real>(image.view(), 0.5, many);
  EXPECT_EQ(again.normals, contour.normals);
  EXPECT_EQ(again.vertex_attributes[0].values, contour.vertex_attributes[0].values);
  const auto normals = gradient_normals(image.view(), contour, Normals::context);
  std::size_t different = 0;
  for (std::size_t v = 0; v < normals.size(); ++v)
    for (int a = 0; a < N; ++a)
      different +=
          std::abs(static_cast<double>(normals[v][a]) - static_cast<double>(contour.normals[v][a])) > tolerance;
  EXPECT_EQ(different, 0u) << "of " << normals.size();
}

TEST(NormalsByContext, AreTheSameFromTheContourAndFromTheExtraction) {
  expect_context_as_extracted<2, double>(Grid<2>::unit({20, 21}), 1e-7);
  expect_context_as_extracted<3, double>(sheared_grid<3>(), 1e-6);
  expect_context_as_extracted<3, float>(Grid<3>::unit({9, 8, 7}), 2e-2);
  expect_context_as_extracted<4, double>(Grid<4>::unit({5, 5, 4, 4}), 1e-7);
}

TEST(NormalsByContext, OfCutsFromTheImageAreThoseOfTheCut) {
  const auto image = noise<float, 4>({6, 5, 5, 4}, 8);
  const auto at = Hyperplane<4>::across(3, 1.4);
  const auto cut = slice(extract<float>(image.view(), 0.5, options_of(Normals::context)), at);
  const auto direct = slice_image(image.view(), 0.5, at, options_of(Normals::context));
  ASSERT_EQ(cut.normals.size(), direct.normals.size());
  ASSERT_EQ(direct.vertex_attributes.size(), 1u);
  double sum = 0, direct_sum = 0;
  for (std::size_t v = 0; v < cut.normals.size(); ++v) {
    sum += cut.vertex_attributes[0].values[v];
    direct_sum += direct.vertex_attributes[0].values[v];
  }
  EXPECT_NEAR(sum, direct_sum, 1e-6 * sum);
}

}  // namespace
}  // namespace tegl::test
