// SPDX-License-Identifier: BSD-3-Clause
//
// Contours with flat parts, which cost no error: caps in the image border, planes. For a count, the error is then
// determined by the rest, and smaller than with a single round, which simplifies everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <variant>
#include <vector>

#include "fields.hpp"
#include "simplified.hpp"
#include "tegl/check.hpp"
#include "tegl/deviation.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

constexpr double kHardlyMore = 1.5;

template <int N>
Grid<N> unit_grid(std::size_t samples) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  return Grid<N>::unit(sizes);
}

/// A plane with a bump of one tile's width.
Contour<3, double> plane_with_a_bump() {
  const auto image = sample_field<float, 3>(unit_grid<3>(30), [](const Point<3>& x) {
    const double square = (x[0] - 15) * (x[0] - 15) + (x[1] - 15) * (x[1] - 15);
    return x[2] - 10.37 + 3 * std::exp(-square / 2);
  });
  return extract<double>(image.view(), 0.0);
}

/// Waves that end at the image border and are closed there.
template <int N>
Contour<N, double> waves_with_caps(std::size_t samples) {
  const auto image = sample_field<float, N>(unit_grid<N>(samples), [](const Point<N>& x) {
    double sum = 0.0;
    for (int a = 0; a < N; ++a) sum += std::sin(x[a] * (0.5 + 0.1 * a) + a);
    return sum;
  });
  ExtractOptions extraction;
  extraction.close = true;
  return extract<double>(image.view(), 0.3, extraction);
}

/// The warm water in the middle of July, closed.
Contour<3, double> warm_water() {
  const auto input = read_image(std::filesystem::path(TEGL_SOURCE_DIR) / "examples/data/ocean_temperature.nc");
  ExtractOptions extraction;
  extraction.close = true;
  Contour<3, double> result;
  std::visit(
      [&](const auto& owned) {
        auto part = owned.view();
        for (int a = 0; a < 2; ++a) part = part.part(a, part.size(a) / 3, part.size(a) / 10);
        result = slice_image<double>(part, 20.0, Hyperplane<4>::across(3, 7.3), extraction);
      },
      std::get<AnyImageN<4>>(input.image));
  return result;
}

template <int N>
SimplifyStats simplified(const Contour<N, double>& contour, const SimplifyOptions<N>& options) {
  const auto [result, stats] = simplify(contour, options);
  expect_same_topology(check(contour), check(result));
  EXPECT_EQ(stats.end, options.max_error ? SimplifyEnd::error : SimplifyEnd::count);
  EXPECT_LE(stats.rounds, 40u);
  return stats;
}

/// For each of these largest errors, ascending: the count left by it plus this share of the rest is reached with hardly
/// more error; a smaller count has a larger error.
template <int N>
void expect_hardly_more_error_by_count(const Contour<N, double>& contour, const std::vector<double>& errors,
                                       const SimplifyOptions<N>& with = {},
                                       const std::vector<double>& shares = {0.6, 0.0}) {
  for (const double most : errors) {
    SCOPED_TRACE(most);
    SimplifyOptions<N> options = with;
    options.max_error = most;
    const SimplifyStats by_error = simplified(contour, options);
    ASSERT_LT(by_error.simplices_after, contour.simplices.size());
    options.max_error.reset();
    double last = 0.0;
    for (const double more : shares) {
      const auto rest = static_cast<double>(contour.simplices.size() - by_error.simplices_after);
      options.count = by_error.simplices_after + static_cast<std::uint64_t>(more * rest);
      SCOPED_TRACE(*options.count);
      const SimplifyStats by_count = simplified(contour, options);
      EXPECT_LE(by_count.simplices_after, *options.count);
      EXPECT_LT(*by_count.error(), kHardlyMore * *by_error.error());
      EXPECT_LE(last, kHardlyMore * *by_count.error());
      last = *by_count.error();
    }
  }
}

TEST(SimplifyFlat, PlaneWithABumpKeepsTheBump) {
  const auto contour = plane_with_a_bump();
  SimplifyOptions<3> options;
  options.max_error = 1e-5;
  const SimplifyStats by_error = simplified(contour, options);
  ASSERT_LT(by_error.simplices_after, 450u);
  options.max_error.reset();
  for (const std::uint64_t count : {1500, 1000, 500}) {
    SCOPED_TRACE(count);
    options.count = count;
    const SimplifyStats stats = simplified(contour, options);
    EXPECT_EQ(stats.simplices_after, count);
    EXPECT_LE(*stats.error(), *by_error.error());
    EXPECT_LE(stats.rounds, 10u);
  }
  expect_hardly_more_error_by_count(contour, {1e-5, 1e-3, 0.03});
}

/// With a count, an irrelevant largest error changes nothing, and a relevant one is respected.
TEST(SimplifyFlat, PlaneWithABumpKeepsTheBumpByTwoGoals) {
  const auto contour = plane_with_a_bump();
  SimplifyOptions<3> options;
  options.count = 1000;
  const auto by_count = simplify(contour, options);
  options.max_error = 0.1;
  const auto by_both = simplify(contour, options);
  EXPECT_EQ(by_both.contour.vertices, by_count.contour.vertices);
  EXPECT_EQ(by_both.stats.error(), by_count.stats.error());
  options.max_error = 1e-5;
  const SimplifyStats near = simplify(contour, options).stats;
  EXPECT_EQ(near.simplices_after, 1000u);
  EXPECT_LE(*near.error(), 1e-5);
}

TEST(SimplifyFlat, CapsGoFirstIn2D) { expect_hardly_more_error_by_count(waves_with_caps<2>(40), {1e-3, 0.02}); }
TEST(SimplifyFlat, CapsGoFirstIn3D) { expect_hardly_more_error_by_count(waves_with_caps<3>(12), {1e-3, 0.02}); }
TEST(SimplifyFlat, CapsGoFirstIn4D) { expect_hardly_more_error_by_count(waves_with_caps<4>(4), {0.02}, {}, {0.6}); }

/// Entirely flat contours have no error.
TEST(SimplifyFlat, PlanesHaveNoError) {
  const auto image = sample_field<float, 3>(unit_grid<3>(9), [](const Point<3>& x) { return x[2] - 3.5; });
  const auto contour = extract<double>(image.view(), 0.0);
  SimplifyOptions<3> options;
  for (const double ratio : {0.9, 0.5}) {
    options.ratio = ratio;
    const SimplifyStats stats = simplified(contour, options);
    EXPECT_LE(*stats.error(), 1e-12);
    EXPECT_LE(stats.rounds, 5u);
  }
}

/// A hyperplane through grid points, up to rounding, and the caps around it: a convex polytope with tetrahedra of no
/// content in its ridges. Neither halves nor prisms bound their distances, but their neighbours do.
TEST(SimplifyFlat, TetrahedraOfNoContentInFoldsHaveTheErrorOfTheirNeighbours) {
  const auto image = sample_field<double, 4>(
      Grid<4>::unit({6, 6, 2, 3}), [](const Point<4>& x) { return 0.1 * x[0] + 0.05 * x[1] - 0.42 + 0.07 * x[3]; });
  ExtractOptions extraction;
  extraction.close = true;
  const auto contour = extract<double>(image.view(), 0.0, extraction);
  ASSERT_GT(check(contour).degenerate_simplices, 0u);
  SimplifyOptions<4> options;
  options.ratio = 0.5;
  const SimplifyStats stats = simplified(contour, options);
  EXPECT_LE(*stats.error(), 1e-9);
  EXPECT_LE(stats.rounds, 12u);
}

TEST(SimplifyFlat, WarmWaterWithCapsIsNearerTheMoreIsLeft) {
  const auto contour = warm_water();
  ASSERT_GT(contour.simplices.size(), 2000u);
  SimplifyOptions<3> options;
  options.scale = automatic_scale(contour);
  expect_hardly_more_error_by_count(contour, {0.02, 0.05}, options);
  // More than half of the simplices are flat.
  options.max_error = 1e-4;
  ASSERT_LT(simplified(contour, options).simplices_after, contour.simplices.size() / 2);
  options.max_error.reset();
  for (const double ratio : {0.8, 0.5}) {
    options.ratio = ratio;
    EXPECT_LE(*simplified(contour, options).error(), 1e-4);
  }
}

}  // namespace
}  // namespace tegl::test
