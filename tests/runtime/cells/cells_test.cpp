// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images of cells: exact contents, faces, manifolds, the border, and shapes by positions.
#include "tegl/cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/measure.hpp"

namespace tegl::test {
namespace {

/// A grid with steps of different lengths, a descending axis and a world map that is no rotation.
template <int N>
Grid<N> cell_grid(std::size_t size) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a)
    grid.axes[a] = Axis::uniform(size + static_cast<std::size_t>(a), 3.0 - a, a == 1 ? -0.5 : 0.25 * (a + 2));
  grid.linear[0][1] = 0.25;
  grid.offset[N - 1] = 7.0;
  return grid;
}

template <int N>
double cell_content(const Grid<N>& grid) {
  double content = 1.0;
  for (int a = 0; a < N; ++a) content *= std::abs(grid.axes[a].step());
  return content;  // the world map has determinant 1
}

template <Value T, int N>
OwnedImage<T, N> random_cells(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  OwnedImage<T, N> image{cell_grid<N>(size), std::vector<T>(1)};
  image.values.resize(sample_count(image.grid));
  const unsigned share = seed % 3 + 1;
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = random() % 4 < share ? T(60) : T(3);
  return image;
}

template <Value T, int N, class Real>
void expect_cells(const OwnedImage<T, N>& image, Ambiguity ambiguity) {
  SCOPED_TRACE(::testing::Message() << N << "D, ambiguity " << static_cast<int>(ambiguity));
  std::uint64_t high = 0, faces = 0;
  const auto sizes = image.grid.sizes();
  const auto is_high = [&](std::array<std::size_t, N> index) {
    for (int a = 0; a < N; ++a)
      if (index[a] >= sizes[a]) return false;
    return static_cast<double>(image.view()(index)) >= 50.0;
  };
  for_each_sample<N>(image.grid, [&](std::size_t, const std::array<std::size_t, N>& index) {
    high += is_high(index) ? 1 : 0;
    for (int a = 0; a < N; ++a) {
      auto next = index;
      ++next[a];
      faces += is_high(index) != is_high(next) ? 1 : 0;
      faces += index[a] == 0 && is_high(index) ? 1 : 0;
    }
  });
  const auto contour = extract_cells<Real>(image.view(), 50.0, {}, {.ambiguity = ambiguity});
  const double content = static_cast<double>(high) * cell_content(image.grid);
  const double precision = std::is_same_v<Real, float> ? 1e-5 : 1e-12;
  EXPECT_NEAR(tegl::measure(contour).content.value_or(-1), content, precision * content);
  const MeshReport report = check(contour);
  EXPECT_TRUE(is_closed_oriented_manifold(report));
  // each face between cells is divided into 2^(N-1) (N-1)! simplices
  std::uint64_t parts = 1;
  for (std::uint64_t k = 1; k < N; ++k) parts *= 2 * k;
  if (N < 4 || report.degenerate_simplices == 0) {
    EXPECT_EQ(contour.simplices.size(), parts * faces);
  }
  if (N < 4) {
    EXPECT_EQ(report.degenerate_simplices, 0u);
  }
}

TEST(Cells, HaveExactContentsAndAreManifolds) {
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
    for (unsigned seed = 0; seed < 12; ++seed)
      expect_cells<std::uint8_t, 2, double>(random_cells<std::uint8_t, 2>(9, seed), ambiguity);
    for (unsigned seed = 0; seed < 6; ++seed)
      expect_cells<float, 3, double>(random_cells<float, 3>(5, seed), ambiguity);
    for (unsigned seed = 0; seed < 3; ++seed)
      expect_cells<std::int16_t, 4, float>(random_cells<std::int16_t, 4>(3, seed), ambiguity);
  }
}

/// All contours of 2 x 2 x 2 cells, and of random tesseracts of 2 x 2 x 2 x 2 cells.
TEST(Cells, OfASingleCornerAreManifolds) {
  for (unsigned signature = 1; signature < 256; ++signature) {
    OwnedImage<std::uint8_t, 3> image{Grid<3>::unit({2, 2, 2}), std::vector<std::uint8_t>(8)};
    for (unsigned i = 0; i < 8; ++i) image.values[i] = signature >> i & 1u ? 60 : 0;
    const auto contour = extract_cells<double>(image.view(), 50.0);
    EXPECT_TRUE(is_closed_oriented_manifold(check(contour))) << signature;
    EXPECT_NEAR(tegl::measure(contour).content.value_or(-1), std::popcount(signature), 1e-12) << signature;
  }
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    const auto signature = static_cast<unsigned>(random() % 65535 + 1);
    OwnedImage<std::uint8_t, 4> image{Grid<4>::unit({2, 2, 2, 2}), std::vector<std::uint8_t>(16)};
    for (unsigned v = 0; v < 16; ++v) image.values[v] = signature >> v & 1u ? 60 : 0;
    const auto contour = extract_cells<double>(image.view(), 50.0);
    EXPECT_TRUE(is_closed_oriented_manifold(check(contour))) << signature;
    EXPECT_NEAR(tegl::measure(contour).content.value_or(-1), std::popcount(signature), 1e-9) << signature;
  }
}

TEST(Cells, EndAtTheirOuterFaces) {
  EXPECT_EQ(cell_faces(Axis::uniform(3, 1.0, 2.0)), (std::vector<double>{0.0, 2.0, 4.0, 6.0}));
  EXPECT_EQ(cell_faces(Axis::rectilinear({0.0, 1.0, 5.0})), (std::vector<double>{-0.5, 0.5, 3.0, 7.0}));
  EXPECT_EQ(cell_faces(Axis::rectilinear({4.0})), (std::vector<double>{3.5, 4.5}));
  OwnedImage<float, 2> image{Grid<2>::unit({2, 1}), std::vector<float>{1.0f, std::numeric_limits<float>::quiet_NaN()}};
  const auto contour = extract_cells<double>(image.view(), 1.0);  // a missing cell is low
  double low = 1e9, high = -1e9;
  for (const auto& vertex : contour.vertices)
    for (const double x : vertex) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  EXPECT_EQ(low, -0.5);
  EXPECT_EQ(high, 0.5);
  EXPECT_EQ(tegl::measure(contour).content.value_or(-1), 1.0);
}

TEST(Cells, GetTheShapeOfABallByPositions) {
  OwnedImage<std::uint8_t, 3> image{Grid<3>::unit({41, 41, 41}), std::vector<std::uint8_t>(41 * 41 * 41)};
  double cells = 0;
  for_each_sample<3>(image.grid, [&](std::size_t i, const std::array<std::size_t, 3>& index) {
    double square = 0;
    for (const std::size_t x : index) square += std::pow(static_cast<double>(x) - 20.0, 2);
    image.values[i] = square <= 400.0 ? 1 : 0;  // touches the border of the image
    cells += image.values[i];
  });
  const auto relaxed = extract_cells<double>(image.view(), 1.0, {.rule = Positions::relaxed});
  EXPECT_TRUE(is_closed_oriented_manifold(check(relaxed)));
  EXPECT_NEAR(tegl::measure(relaxed).content.value_or(-1), cells, 0.001 * cells);
  const auto moved = extract_cells<double>(image.view(), 1.0, {.rule = Positions::gravitation});
  EXPECT_TRUE(is_closed_oriented_manifold(check(moved)));
  EXPECT_NEAR(tegl::measure(moved).content.value_or(-1), cells, 0.02 * cells);
}

TEST(Cells, DoNotDependOnThreads) {
  const auto image = random_cells<float, 3>(12, 1);
  const auto one = extract_cells<float>(image.view(), 50.0, {}, {.work = {.threads = 1}});
  const auto three = extract_cells<float>(image.view(), 50.0, {}, {.work = {.threads = 3}});
  EXPECT_EQ(one.vertices, three.vertices);
  EXPECT_EQ(one.simplices, three.simplices);
}

TEST(Cells, RefuseOptionsOfSamples) {
  const auto image = random_cells<float, 2>(4, 1);
  const auto refused = [&](const std::string& part, const PositionOptions& positions, const ExtractOptions& options) {
    expect_error(ErrorCode::UnsupportedData, part,
                 [&] { (void)extract_cells(image.view(), 50.0, positions, options); });
  };
  refused("second image", {.rule = Positions::filtered}, {});
  refused("from the data", {}, {.ambiguity = Ambiguity::saddle});
  refused("normals", {}, {.normals = Normals::differences});
  expect_error(ErrorCode::InvalidIsovalue, "not finite", [&] { (void)extract_cells(image.view(), std::nan("")); });
}

}  // namespace
}  // namespace tegl::test
