// SPDX-License-Identifier: BSD-3-Clause
//
// The cells that the literature on marching cubes distinguishes, and degenerate ones (support/named_cells.hpp). For
// each cell on its own and inside a larger grid, in every orientation, the contour by Ambiguity::saddle has the
// interpolant's topology.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "estimators.hpp"
#include "grid_symmetries.hpp"
#include "named_cells.hpp"
#include "random_fields.hpp"
#include "same_topology.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

/// Vertices are kept off the samples, so that each lies on one edge.
ExtractOptions by_saddle() {
  ExtractOptions options = by_ambiguity(Ambiguity::saddle);
  options.epsilon = 0.05;
  options.work.threads = 1;
  return options;
}

template <int N, std::size_t kCorners>
SampledField<N> field_of(const NamedCell<kCorners>& cell, const GridSymmetry<N>& symmetry) {
  SampledField<N> field;
  field.sizes.fill(2);
  const OwnedImage<double, N> image{Grid<N>::unit(field.sizes), {cell.values.begin(), cell.values.end()}};
  for (const double value : moved(image, symmetry).values) field.values.push_back(std::llround(value));
  return field;
}

template <int N, std::size_t kCorners>
void expect_named(const NamedCell<kCorners>& cell) {
  for (const auto& symmetry : grid_symmetries<N>()) {
    const auto field = field_of<N>(cell, symmetry);
    const auto below = just_below(field);
    const auto interpolant = interpolant_topology(below);
    EXPECT_TRUE(interpolant.regular);
    EXPECT_EQ(interpolant.contour, (Topology{cell.components, cell.euler}));
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
      ExtractOptions options = by_saddle();
      options.triangulation = triangulation;
      const auto contour = extract<double>(view_of(image_of<std::int8_t>(field)), 0.0, options);
      ASSERT_TRUE(has_topology_of(contour, below, interpolant));
    }
  }
}

TEST(NamedCells, AloneHaveTheirTopologyInEveryPosition) {
  for (const auto& cell : kNamedSquares) {
    SCOPED_TRACE(cell.name);
    expect_named<2>(cell);
  }
  for (const auto& cell : kNamedCubes) {
    SCOPED_TRACE(cell.name);
    expect_named<3>(cell);
  }
}

/// Exchanging the signs exchanges the sides and preserves the contour of a cell without ties.
TEST(NamedCells, WithSignsExchangedHaveTheSameContour) {
  for (auto cell : kNamedCubes) {
    if (!cell.regular) continue;
    SCOPED_TRACE(cell.name);
    for (int& value : cell.values) value = -value;
    expect_named<3>(cell);
  }
}

/// Embeds a cell in the middle of 4^N samples that are otherwise low.
template <int N, std::size_t kCorners>
void expect_embedded(const NamedCell<kCorners>& cell, std::mt19937_64& bits, const GridSymmetry<N>& symmetry) {
  auto field = random_field<N>(bits, 4, 9, true);
  const auto corners = field_of<N>(cell, symmetry);
  std::size_t size = 1;
  std::array<std::size_t, N> strides{};
  for (int a = 0; a < N; ++a, size *= 6) strides[a] = size;
  for (std::size_t v = 0; v < kCorners; ++v) {
    std::size_t place = 0;
    for (int a = 0; a < N; ++a) place += (2 + (v >> a & 1u)) * strides[a];
    field.values[place] = corners.values[v];
  }
  const auto below = just_below(field);
  const auto interpolant = interpolant_topology(below);
  ASSERT_TRUE(interpolant.regular);
  const auto contour = extract<double>(view_of(image_of<std::int8_t>(field)), 0.0, by_saddle());
  ASSERT_TRUE(is_closed_oriented_manifold(check(contour)));
  ASSERT_TRUE(has_topology_of(contour, below, interpolant));
}

TEST(NamedCells, InALargerGridHaveItsTopologyInEveryPosition) {
  std::mt19937_64 bits(1);
  for (const auto& cell : kNamedSquares)
    for (const auto& symmetry : grid_symmetries<2>()) {
      SCOPED_TRACE(cell.name);
      expect_embedded<2>(cell, bits, symmetry);
    }
  for (const auto& cell : kNamedCubes)
    for (const auto& symmetry : grid_symmetries<3>()) {
      SCOPED_TRACE(cell.name);
      expect_embedded<3>(cell, bits, symmetry);
    }
}

}  // namespace
}  // namespace tegl::test
