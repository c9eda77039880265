// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of 4D lattices by rows of bits are those of the stored cells: the same vertices, normals and simplices, with
// other numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "compare.hpp"
#include "invariants.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_grid.hpp"
#include "lattice/lattice_rows.hpp"
#include "lattice/stored_lattice.hpp"
#include "lattice_image.hpp"
#include "tegl/check.hpp"

namespace tegl::test {
namespace {

constexpr Lattice kLattices[] = {Lattice::d4, Lattice::fcc_in_time};

/// The contour of the stored cells.
template <class Real, Value T>
Extraction<4, Real> extract_stored(const Image<T, 4>& image, Lattice lattice, double isovalue,
                                   const ExtractOptions& options) {
  const detail::StoredLattice<T, 4> stored(image, lattice, isovalue, options, {});
  return detail::extract_in<Real>(stored.complex(), isovalue, options, stored.surroundings());
}

/// Vertices with their normals, sorted.
template <class Real>
std::vector<std::array<std::array<Real, 4>, 2>> with_normals(const Contour<4, Real>& contour) {
  std::vector<std::array<std::array<Real, 4>, 2>> result;
  for (std::size_t v = 0; v < contour.normals.size(); ++v) result.push_back({contour.vertices[v], contour.normals[v]});
  std::sort(result.begin(), result.end());
  return result;
}

template <class Real, Value T>
void expect_as_stored(const Image<T, 4>& image, Lattice lattice, double isovalue, ExtractOptions options) {
  ASSERT_TRUE(detail::has_rows(lattice, options));
  options.work.threads = 1;
  const auto expected = extract_stored<Real>(image, lattice, isovalue, options);
  const auto found = extract_lattice_with_stats<Real>(image, lattice, isovalue, options);
  EXPECT_TRUE(same_surface(found.contour, expected.contour));
  EXPECT_EQ(with_normals(found.contour), with_normals(expected.contour));
  EXPECT_EQ(found.stats.tiles, expected.stats.tiles);
  EXPECT_EQ(found.stats.active_tiles, expected.stats.active_tiles);
  options.work.threads = 3;
  const auto by_three = extract_lattice<Real>(image, lattice, isovalue, options);
  EXPECT_EQ(by_three.vertices, found.contour.vertices);
  EXPECT_EQ(by_three.normals, found.contour.normals);
  EXPECT_EQ(by_three.simplices, found.contour.simplices);
}

/// All options that decide which simplices there are, with normals or without.
std::vector<ExtractOptions> options_by_rows() {
  std::vector<ExtractOptions> all;
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high})
    for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
      ExtractOptions& options = all.emplace_back();
      options.triangulation = Triangulation::compact;
      options.ambiguity = ambiguity;
      options.direction = direction;
      options.normals = all.size() % 2 == 0 ? Normals::none : Normals::differences;
      options.epsilon = all.size() % 2 == 0 ? 0.05 : 0.0;
    }
  return all;
}

/// Noise on a grid whose axes may descend, be uneven where the lattice allows it, and have a map into the world.
OwnedImage<double, 4> noise_on(Lattice lattice, const std::array<std::size_t, 4>& sizes, unsigned seed) {
  Grid<4> grid = Grid<4>::unit(sizes);
  for (int a = 0; a < 4; ++a)
    if ((seed >> a & 1u) != 0) grid.axes[a] = Axis::uniform(sizes[a], 1.0, a % 2 == 0 ? 0.7 : -0.3);
  if (seed % 3 == 0) {
    std::vector<double> uneven;
    for (std::size_t k = 0; k < sizes[3]; ++k) uneven.push_back(static_cast<double>(k) + (k % 2 == 1 ? 0.3 : 0.0));
    if (seed % 2 == 1) std::reverse(uneven.begin(), uneven.end());
    grid.axes[3] = Axis::rectilinear(uneven);
  }
  if (seed % 4 == 1) {
    grid.linear[0][1] = 0.3;
    grid.linear[3][3] = seed % 8 == 1 ? -2.0 : 2.0;
    grid.offset[2] = 5.0;
  }
  auto image = sampled_on_lattice<4>(lattice, std::move(grid), noise_everywhere<4>(seed));
  if (seed % 5 == 4)  // samples at the isovalue
    for (double& value : image.values) value = 0.25 * static_cast<double>(static_cast<int>(4.0 * value));
  return image;
}

TEST(LatticeRows, GiveTheContourOfStoredCells) {
  for (const Lattice lattice : kLattices) {
    unsigned seed = 0;
    for (const std::array<std::size_t, 4>& sizes : std::vector<std::array<std::size_t, 4>>{{2, 2, 2, 3},
                                                                                           {2, 3, 4, 3},
                                                                                           {3, 2, 3, 4},
                                                                                           {1, 3, 4, 4},
                                                                                           {5, 6, 7, 6},
                                                                                           {6, 5, 6, 7},
                                                                                           {64, 3, 4, 3},
                                                                                           {65, 4, 3, 4},
                                                                                           {130, 3, 3, 3},
                                                                                           {4, 67, 3, 3}}) {
      SCOPED_TRACE(testing::Message() << name_of(lattice) << ", seed " << seed << ", " << sizes[0] << " samples");
      const auto image = noise_on(lattice, sizes, seed++);
      for (const ExtractOptions& options : options_by_rows()) {
        expect_as_stored<double>(image.view(), lattice, 0.5, options);
        expect_as_stored<float>(image.view(), lattice, 0.5, options);
      }
    }
  }
}

/// Samples of a type, between 0 and 100.
template <Value T>
void expect_values_as_stored(Lattice lattice) {
  std::mt19937 random(2);
  std::vector<T> values(6 * 6 * 6 * 6);
  for (T& value : values) value = static_cast<T>(random() % 100);
  const Image<T, 4> image(values.data(), Grid<4>::unit({6, 6, 6, 6}));
  for (const ExtractOptions& options : options_by_rows()) expect_as_stored<float>(image, lattice, 49.5, options);
}

TEST(LatticeRows, GiveTheContourOfStoredCellsForAllTypesOfValues) {
  for (const Lattice lattice : kLattices) {
    SCOPED_TRACE(name_of(lattice));
    expect_values_as_stored<float>(lattice);
    expect_values_as_stored<double>(lattice);
    expect_values_as_stored<std::uint8_t>(lattice);
    expect_values_as_stored<std::int8_t>(lattice);
    expect_values_as_stored<std::int16_t>(lattice);
    expect_values_as_stored<std::uint16_t>(lattice);
    expect_values_as_stored<std::int32_t>(lattice);
  }
}

/// Each contour that a cell may have, with all others around it low or high.
TEST(LatticeRows, GiveEachContourOfA16Cell) {
  const Grid<4> grid = Grid<4>::unit({4, 4, 4, 6});
  ExtractOptions options;
  options.triangulation = Triangulation::compact;
  for (const detail::PatternCell& cell : detail::pattern_of_lattice(Lattice::d4))
    for (unsigned signature = 0; signature < 256; ++signature) {
      SCOPED_TRACE(testing::Message() << "parity " << cell.parity << ", signature " << signature);
      const bool around = (signature ^ static_cast<unsigned>(cell.parity)) % 2 == 1;
      options.ambiguity = around ? Ambiguity::high : Ambiguity::low;
      std::vector<float> values(4 * 4 * 4 * 6, around ? 1.0F : 0.0F);
      for (std::size_t c = 0; c < 8; ++c) {
        const detail::LatticePlace& to = cell.corners[c];
        const std::array<std::size_t, 4> at = {1 + static_cast<std::size_t>(to[0]), 1 + static_cast<std::size_t>(to[1]),
                                               1 + static_cast<std::size_t>(to[2]),
                                               2 + static_cast<std::size_t>(cell.parity + to[3])};
        const float height = 0.1F + 0.05F * static_cast<float>(c);
        values[detail::number_of<4>(grid, at)] = (signature >> c & 1u) != 0 ? 0.5F + height : 0.5F - height;
      }
      const Image<float, 4> image(values.data(), grid);
      const auto contour = extract_lattice<double>(image, Lattice::d4, 0.5, options);
      EXPECT_TRUE(same_surface(contour, extract_stored<double>(image, Lattice::d4, 0.5, options).contour));
      EXPECT_TRUE(is_oriented_manifold(check(contour)));
    }
}

TEST(LatticeRows, VerticesBetweenTimesStayOffBoth) {
  // float distinguishes few numbers between these times
  Grid<4> grid = Grid<4>::unit({6, 6, 6, 5});
  grid.axes[3] = Axis::uniform(5, 1e6, 0.25);
  const auto image = sampled_on_lattice<4>(Lattice::fcc_in_time, grid, noise_everywhere<4>(6));
  for (const ExtractOptions& options : options_by_rows())
    expect_as_stored<float>(image.view(), Lattice::fcc_in_time, 0.5, options);
}

TEST(LatticeRows, AreLowOrHighInLinesThatAreLeftOut) {
  // two small balls: at the border and in the inside, between lines that the contour does not reach
  Grid<4> grid = Grid<4>::unit({20, 14, 15, 16});
  for (const Lattice lattice : kLattices) {
    const auto image = sampled_on_lattice<4>(lattice, grid, [](const auto& x, const auto&, const auto&) {
      const auto distance = [&](const std::array<double, 4>& from) {
        double sum = 0.0;
        for (std::size_t a = 0; a < 4; ++a) sum += (x[a] - from[a]) * (x[a] - from[a]);
        return sum;
      };
      return std::min(distance({0.0, 13.0, 14.0, 2.0}), distance({9.0, 6.0, 7.0, 9.0}));
    });
    for (const ExtractOptions& options : options_by_rows()) {
      expect_as_stored<double>(image.view(), lattice, 2.3, options);
      expect_as_stored<double>(image.view(), lattice, 1e9, options);  // nowhere
    }
  }
}

TEST(LatticeRows, StoredCellsAreUsedBesideMissingValuesAndForBarycentricContours) {
  for (const Lattice lattice : kLattices) {
    SCOPED_TRACE(name_of(lattice));
    auto image = noise_on(lattice, {6, 5, 6, 6}, 2);
    ExtractOptions options;
    options.triangulation = Triangulation::barycentric;
    EXPECT_FALSE(detail::has_rows(lattice, options));
    EXPECT_EQ(extract_lattice<double>(image.view(), lattice, 0.5, options).simplices,
              extract_stored<double>(image.view(), lattice, 0.5, options).contour.simplices);
    options.triangulation = Triangulation::compact;
    const auto without = extract_stored<double>(image.view(), lattice, 0.5, options).contour;
    EXPECT_NE(extract_lattice<double>(image.view(), lattice, 0.5, options).simplices, without.simplices);
    image.values[image.values.size() / 2] = std::numeric_limits<double>::quiet_NaN();
    const auto expected = extract_stored<double>(image.view(), lattice, 0.5, options).contour;
    const auto found = extract_lattice<double>(image.view(), lattice, 0.5, options);
    EXPECT_EQ(found.vertices, expected.vertices);
    EXPECT_EQ(found.simplices, expected.simplices);
    EXPECT_LT(found.simplices.size(), without.simplices.size());
  }
}

}  // namespace
}  // namespace tegl::test
