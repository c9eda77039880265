// SPDX-License-Identifier: BSD-3-Clause
//
// Elements of contours: their sizes add up to the surface's, their normals to zero (Gauss); normals face the contour's
// direction and transform as covectors under affine maps; attributes are exact for linear fields; elements by cell meet
// the requirements of Cornelius' paper.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "ambiguity/variants.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/eigen.hpp"
#include "tegl/elements.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

template <int N>
double dot(const std::array<double, N>& a, const std::array<double, N>& b) {
  double sum = 0;
  for (int i = 0; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

template <int N>
Grid<N> shifted_grid(std::size_t samples, double half_width) {
  Grid<N> grid = centred_grid<N>(samples, half_width);
  for (int a = 0; a < N; ++a)
    grid.axes[a] =
        Axis::uniform(samples, grid.axes[a].origin() + grid.axes[a].step() * 0.17 * (a + 1), grid.axes[a].step());
  return grid;
}

/// The area by elements, its order, and Gauss's theorem for 1 (closed) and x (content).
template <int N>
void expect_elements_of_a_ball(std::size_t samples) {
  const Ball<N> ball;
  double errors[2];
  for (double& error : errors) {
    const Grid<N> grid = shifted_grid<N>(samples, 1.3);
    const auto image = sample_field<double, N>(grid, ball);
    const auto contour = extract<double>(image.view(), 0.0);
    expect_closed_manifold(contour);
    const Elements<N> all = elements(contour);
    ASSERT_EQ(all.centroids.size(), contour.simplices.size());
    const ElementSum<N> sum = sum_of(all);
    error = sum.measure / ball.surface() - 1.0;
    EXPECT_NEAR(sum.measure, test::measure(contour),
                1e-9 * sum.measure);  // its roots of determinants have half the digits
    EXPECT_LT(sum.closure_error(), 1e-13);
    double flux = 0;
    for (std::size_t e = 0; e < all.centroids.size(); ++e) flux += dot<N>(all.centroids[e], all.normals[e]);
    EXPECT_NEAR(flux / N, enclosed_content(contour), 1e-12 * ball.content());
    // By cell the totals are equal, and the norm of each normal is at most the element's measure.
    const Elements<N> cells = elements_by_cell(contour, grid);
    const ElementSum<N> cell_sum = sum_of(cells);
    EXPECT_LE(cells.centroids.size(), all.centroids.size());
    EXPECT_LT(cell_sum.closure_error(), 1e-13);
    EXPECT_NEAR(cell_sum.measure, sum.measure, 1e-12 * sum.measure);
    std::uint64_t simplices = 0;
    for (std::size_t e = 0; e < cells.centroids.size(); ++e) {
      simplices += cells.counts[e];
      const double size = std::sqrt(dot<N>(cells.normals[e], cells.normals[e]));
      ASSERT_LE(size, cells.measures[e] * (1 + 1e-12));
      ASSERT_GE(size, cells.measures[e] * 0.9) << "a smooth surface is nearly flat within a tile";
    }
    EXPECT_EQ(simplices, contour.simplices.size());
    samples = 2 * samples - 1;
  }
  EXPECT_GT(convergence_order(errors[0], errors[1]), 1.6) << errors[0] << ' ' << errors[1];
}

TEST(Elements, SizesOfASphereAddUpToItsAreaAtSecondOrder) {
  expect_elements_of_a_ball<2>(21);
  expect_elements_of_a_ball<3>(15);
  expect_elements_of_a_ball<4>(9);
}

template <int N>
void expect_direction(std::size_t samples) {
  const auto image = sample_field<double, N>(centred_grid<N>(samples, 1.3), Ball<N>{});  // high inside
  for (const auto direction : {GradientDirection::descent, GradientDirection::ascent}) {
    ExtractOptions options;
    options.direction = direction;
    const auto contour = extract<double>(image.view(), 0.0, options);
    const Elements<N> all = elements(contour);
    EXPECT_EQ(all.direction, direction);
    for (std::size_t e = 0; e < all.centroids.size(); ++e) {
      const double outwards = dot<N>(all.centroids[e], all.normals[e]);
      ASSERT_TRUE(direction == GradientDirection::descent ? outwards > -1e-12 : outwards < 1e-12);
    }
  }
}

TEST(Elements, FaceLowOrHighAsTheContourDoes) {
  expect_direction<2>(20);
  expect_direction<3>(12);
  expect_direction<4>(7);
}

/// The integral of dσ over any closed surface is 0.
template <Value T, int N>
void expect_noise_to_close(std::size_t samples) {
  for (std::uint64_t seed = 1; seed < 4; ++seed)
    for (ExtractOptions options : variants()) {
      options.close = true;
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << describe(options));
      const auto image = noise<T, N>(samples, seed);
      const auto contour = extract<double>(image.view(), noise_isovalue<T>(), options);
      expect_closed_manifold(contour);
      const ElementSum<N> simplices = sum_of(elements(contour));
      const ElementSum<N> cells = sum_of(elements_by_cell(contour, image.grid));
      EXPECT_LT(simplices.closure_error(), 2e-15);
      EXPECT_LT(cells.closure_error(), 2e-15);
      EXPECT_NEAR(cells.measure, simplices.measure, 1e-12 * simplices.measure);
    }
}

TEST(Elements, OfClosedNoiseAddUpToZero) {
  expect_noise_to_close<float, 2>(40);
  expect_noise_to_close<std::uint8_t, 3>(12);
  expect_noise_to_close<float, 4>(6);
}

TEST(Elements, OfAnOpenContourAddUpToWhatClosesIt) {
  // A plane across the unit cube: its vector area is independent of its triangles.
  Grid<3> grid = Grid<3>::unit({6, 6, 6});
  const auto image = sample_field<double, 3>(grid, [](const Point<3>& x) { return x[2]; });
  const ElementSum<3> sum = sum_of(elements(extract<double>(image.view(), 2.5)));
  EXPECT_NEAR(sum.normal[0], 0.0, 1e-13);
  EXPECT_NEAR(sum.normal[1], 0.0, 1e-13);
  EXPECT_NEAR(sum.normal[2], -25.0, 1e-12);  // low is below
  EXPECT_DOUBLE_EQ(sum.closure_error(), 1.0);
}

/// Normals are covectors times the volume factor: they transform by the cofactor matrix.
template <int N>
void expect_equivariance(std::size_t samples) {
  auto image = noise<double, N>(samples, 11);
  const auto plain = elements(extract<double>(image.view(), 0.5));
  Eigen::Matrix<double, N, N> linear;
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) linear(a, b) = a == b ? 1.5 - 0.3 * a : 0.2 * (a - 2 * b) + 0.1;
  ASSERT_GT(linear.determinant(), 0.0);
  image.grid.linear = to_matrix(linear);
  image.grid.offset.fill(3.0);
  const auto mapped = elements(extract<double>(image.view(), 0.5));
  ASSERT_EQ(mapped.normals.size(), plain.normals.size());
  const Eigen::Matrix<double, N, N> cofactors = linear.determinant() * linear.inverse().transpose();
  for (std::size_t e = 0; e < plain.normals.size(); ++e) {
    const Eigen::Matrix<double, N, 1> expected = cofactors * as_eigen(plain.normals[e]);
    ASSERT_LT((as_eigen(mapped.normals[e]) - expected).norm(), 1e-12) << "element " << e;
    const Eigen::Matrix<double, N, 1> centroid = linear * as_eigen(plain.centroids[e]) + as_eigen(image.grid.offset);
    ASSERT_LT((as_eigen(mapped.centroids[e]) - centroid).norm(), 1e-12);
  }
  // Tiles are found through the world map.
  auto unmapped = noise<double, N>(samples, 11);
  const auto cells = elements_by_cell(extract<double>(image.view(), 0.5), image.grid);
  const auto plain_cells = elements_by_cell(extract<double>(unmapped.view(), 0.5), unmapped.grid);
  ASSERT_EQ(cells.counts.size(), plain_cells.counts.size());
  EXPECT_TRUE(std::equal(cells.counts.begin(), cells.counts.end(), plain_cells.counts.begin()));
}

TEST(Elements, FollowAffineMapsByTheCofactors) {
  expect_equivariance<2>(30);
  expect_equivariance<3>(9);
  expect_equivariance<4>(6);
}

template <int N>
void expect_linear_attributes(std::size_t samples) {
  const auto image = noise<double, N>(samples, 2);
  auto contour = extract<double>(image.view(), 0.5);
  Attribute linear{"u", "m/s", 2, {}};
  for (const auto& vertex : contour.vertices)
    for (int i = 0; i < 2; ++i) {
      double value = 1.0 + i;
      for (int a = 0; a < N; ++a) value += (i == 0 ? a - 1.5 : 0.3 + a) * vertex[a];
      linear.values.push_back(value);
    }
  Attribute number{"number", "", 1, {}};
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) number.values.push_back(static_cast<double>(s));
  contour.vertex_attributes.push_back(linear);
  contour.simplex_attributes.push_back(number);
  const Elements<N> simplices = elements(contour);
  for (const Elements<N>& all : {simplices, elements_by_cell(contour, image.grid)}) {
    ASSERT_EQ(all.attributes.size(), 2u);
    EXPECT_EQ(all.attributes[0].unit, "m/s");
    ASSERT_EQ(all.attributes[0].values.size(), 2 * all.centroids.size());
    for (std::size_t e = 0; e < all.centroids.size(); ++e)
      for (int i = 0; i < 2; ++i) {
        double expected = 1.0 + i;
        for (int a = 0; a < N; ++a) expected += (i == 0 ? a - 1.5 : 0.3 + a) * all.centroids[e][a];
        ASSERT_NEAR(all.attributes[0].values[2 * e + static_cast<std::size_t>(i)], expected, 1e-12);
      }
  }
  EXPECT_EQ(simplices.attributes[1].values, number.values);
}

TEST(Elements, HaveLinearAttributesExactlyAtTheirCentroids) {
  expect_linear_attributes<2>(20);
  expect_linear_attributes<3>(8);
  expect_linear_attributes<4>(5);
}

/// One tile with random corners, as in the example program of Cornelius: its elements are the components of the tile's
/// contour, and their normals add up to the flux through the high parts of the tile's faces.
template <int N>
void expect_pieces_of_single_tiles(int rounds) {
  std::map<std::size_t, int> pieces;
  for (int seed = 0; seed < rounds; ++seed) {
    const auto image = noise<double, N>(2, static_cast<std::uint64_t>(seed));
    const auto contour = extract<double>(image.view(), 0.5);
    const Elements<N> all = elements_by_cell(contour, image.grid);
    ASSERT_EQ(all.centroids.size(), check(contour).components) << "seed " << seed;
    ++pieces[all.centroids.size()];
    // Closed by caps, whose sum is minus that of the contour: it depends on the faces only.
    ExtractOptions closed;
    closed.close = true;
    const ElementSum<N> sum = sum_of(all), rest = sum_of(elements(extract<double>(image.view(), 0.5, closed)));
    for (int a = 0; a < N; ++a) {
      ASSERT_NEAR(rest.normal[a], 0.0, 1e-14);
      ASSERT_LE(std::abs(sum.normal[a]), 1.0 + 1e-12);
    }
    for (const auto& centroid : all.centroids)
      for (const double x : centroid) ASSERT_TRUE(x >= 0.0 && x <= 1.0);
  }
  EXPECT_GT(pieces[1], 0);
  EXPECT_GT(pieces[2], 0) << "no tile of two pieces among those tried";
}

TEST(Elements, ByCellAreThePiecesOfATilesContour) {
  expect_pieces_of_single_tiles<2>(300);
  expect_pieces_of_single_tiles<3>(300);
  expect_pieces_of_single_tiles<4>(300);
}

/// Single tiles against the whole image: elements, sums and centroids agree.
template <int N>
void expect_cells_to_be_those_of_single_tiles(const std::array<std::size_t, N>& sizes) {
  const auto image = noise<double, N>(sizes, 21);
  const Elements<N> whole = elements_by_cell(extract<double>(image.view(), 0.5), image.grid);
  std::size_t next = 0;
  Grid<N> tiles = image.grid;
  for (int a = 0; a < N; ++a) tiles.axes[a] = Axis::uniform(sizes[a] - 1);
  for_each_sample<N>(tiles, [&](std::size_t, const std::array<std::size_t, N>& index) {
    Image<double, N> tile = image.view();
    for (int a = 0; a < N; ++a) tile = tile.part(a, index[a], 2);
    const Elements<N> own = elements_by_cell(extract<double>(tile, 0.5), tile.grid());
    // The elements of a tile are ordered by their simplices, equally in both.
    for (std::size_t e = 0; e < own.centroids.size(); ++e, ++next) {
      ASSERT_LT(next, whole.centroids.size());
      ASSERT_EQ(whole.counts[next], own.counts[e]);
      for (int a = 0; a < N; ++a) {
        ASSERT_NEAR(whole.normals[next][a], own.normals[e][a], 1e-12);
        ASSERT_NEAR(whole.centroids[next][a], own.centroids[e][a], 1e-12);
      }
    }
  });
  EXPECT_EQ(next, whole.centroids.size());
}

TEST(Elements, ByCellAreThoseOfEachTileByItself) {
  expect_cells_to_be_those_of_single_tiles<2>({9, 8});
  expect_cells_to_be_those_of_single_tiles<3>({6, 5, 7});
  expect_cells_to_be_those_of_single_tiles<4>({4, 3, 5, 4});
}

TEST(Elements, CapsAreElementsOfTheirOwn) {
  const Grid<3> grid = Grid<3>::unit({5, 5, 5});
  const auto image = sample_field<double, 3>(grid, [](const Point<3>& x) { return x[2]; });
  ExtractOptions options;
  options.close = true;
  const Elements<3> all = elements_by_cell(extract<double>(image.view(), 3.5, options), grid);
  // 16 tiles across, 16 caps above them, and the strips of height 1/2 around: 4 x 4.
  ASSERT_EQ(all.centroids.size(), 48u);
  for (std::size_t e = 0; e < 48; ++e) {
    int directions = 0;
    for (int a = 0; a < 3; ++a) directions += std::abs(all.normals[e][a]) > 1e-12 ? 1 : 0;
    EXPECT_EQ(directions, 1) << "element " << e << " mixes a cap with the contour";
  }
}

TEST(Elements, AreTheSameForAnyNumberOfThreads) {
  const auto image = noise<float, 3>(24, 8);
  const auto contour = extract<float>(image.view(), 0.5);
  ASSERT_GT(contour.simplices.size(), 20000u);
  const auto equal = [](const Elements<3>& a, const Elements<3>& b) {
    return a.centroids == b.centroids && a.normals == b.normals && a.measures == b.measures && a.counts == b.counts;
  };
  EXPECT_TRUE(equal(elements(contour, {.threads = 1}), elements(contour, {.threads = 4})));
  EXPECT_TRUE(equal(elements_by_cell(contour, image.grid, {.threads = 1}),
                    elements_by_cell(contour, image.grid, {.threads = 4})));
}

TEST(Elements, OfAnEmptyContourAreNoneAndCloseUp) {
  const Elements<3> none = elements(Contour<3, float>());
  EXPECT_TRUE(none.centroids.empty());
  EXPECT_EQ(sum_of(none).closure_error(), 0.0);
  EXPECT_TRUE(elements_by_cell(Contour<3, float>(), Grid<3>::unit({2, 2, 2})).centroids.empty());
}

TEST(Elements, RefuseAttributesAndGridsThatDoNotFit) {
  const auto image = noise<float, 3>(6, 8);
  auto contour = extract<float>(image.view(), 0.5);
  expect_error(ErrorCode::InvalidArgument, "expected it in a tile of the grid", [&] {
    elements_by_cell(contour, Grid<3>::unit({3, 3, 3}));
  });
  expect_error(ErrorCode::Cancelled, "cancelled",
               [&] { elements(contour, {.progress = [](double) { return false; }}); });
  contour.vertex_attributes.push_back({"short", "", 1, {1.0}});
  expect_error(ErrorCode::InvalidArgument, "attribute 'short' has 1 values", [&] { elements(contour); });
}

TEST(Elements, OfHugeAndTinyCoordinatesHaveSizes) {
  for (const double scale : {1e-60, 1e60}) {
    Contour<4, double> contour;
    contour.vertices = {{0, 0, 0, 0}, {scale, 0, 0, 0}, {0, scale, 0, 0}, {0, 0, scale, 0}};
    contour.simplices = {{0, 1, 2, 3}};
    const Elements<4> all = elements(contour);
    EXPECT_NEAR(all.measures[0] / (scale * scale * scale / 6), 1.0, 1e-12);
    EXPECT_NEAR(all.normals[0][3] / (scale * scale * scale / 6), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace tegl::test
