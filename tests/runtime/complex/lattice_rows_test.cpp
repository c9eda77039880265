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
#include "complex/cell_groups.hpp"
#include "errors.hpp"
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
template <class Real, Value T, int N>
Extraction<N, Real> extract_stored(const Image<T, N>& image, Lattice lattice, double isovalue,
                                   const ExtractOptions& options) {
  const detail::StoredLattice<T, N> stored(image, lattice, isovalue, options, {});
  return detail::extract_in<Real>(stored.complex(), isovalue, options, stored.surroundings());
}

/// Vertices with their normals, sorted.
template <int N, class Real>
std::vector<std::array<std::array<Real, N>, 2>> with_normals(const Contour<N, Real>& contour) {
  std::vector<std::array<std::array<Real, N>, 2>> result;
  for (std::size_t v = 0; v < contour.normals.size(); ++v) result.push_back({contour.vertices[v], contour.normals[v]});
  std::sort(result.begin(), result.end());
  return result;
}

template <class Real, Value T, int N>
void expect_as_stored(const Image<T, N>& image, Lattice lattice, double isovalue, ExtractOptions options) {
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
  if (seed % 7 == 3 && lattice == Lattice::d4) grid.linear[0][3] = grid.linear[3][1] = 0.2;
  if (seed % 7 == 3 && lattice == Lattice::fcc_in_time) {  // layers at uneven distances
    std::vector<double> uneven;
    for (std::size_t k = 0; k < sizes[2]; ++k)
      uneven.push_back(0.7 * static_cast<double>(k) + (k % 3 == 1 ? 0.2 : 0.0));
    grid.axes[2] = Axis::rectilinear(uneven);
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

/// Cells with 256 signatures from `first` on, 3 samples apart along the first two axes; all other samples are low or
/// high. `corners`: relative to a sample in a layer of this parity.
OwnedImage<float, 4> image_of_signatures(Lattice lattice, const std::vector<detail::LatticePlace>& corners, int parity,
                                         unsigned first, bool around) {
  OwnedImage<float, 4> image;
  const bool is_in_time = lattice == Lattice::fcc_in_time;
  image.grid = is_in_time ? Grid<4>::unit({49, 49, 6, 3}) : Grid<4>::unit({49, 49, 3, 6});
  image.values.assign(std::size_t{49} * 49 * 18, around ? 1.0F : 0.0F);
  std::array<std::size_t, 4> at = {1, 1, 1, 1};
  at[is_in_time ? 2 : 3] = 2 + static_cast<std::size_t>(parity);
  for (unsigned i = 0; i < 256; ++i) {
    at[0] = 1 + std::size_t{3} * (i % 16);
    at[1] = 1 + std::size_t{3} * (i / 16);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      std::array<std::size_t, 4> corner = at;
      for (std::size_t a = 0; a < 4; ++a) corner[a] += static_cast<std::size_t>(corners[c][a]);
      const float height = 0.1F + 0.03F * static_cast<float>(c);
      image.values[detail::number_of<4>(image.grid, corner)] =
          ((first + i) >> c & 1u) != 0 ? 0.5F + height : 0.5F - height;
    }
  }
  return image;
}

void expect_each_signature(Lattice lattice, const std::vector<detail::LatticePlace>& corners, int parity) {
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high})
    for (unsigned first = 0; first < 1u << corners.size(); first += 256) {
      SCOPED_TRACE(testing::Message() << name_of(lattice) << ", parity " << parity << ", signatures from " << first);
      ExtractOptions options;
      options.triangulation = Triangulation::compact;
      options.ambiguity = ambiguity;
      const bool around = (first / 256 + static_cast<unsigned>(parity)) % 2 == 1;
      const auto image = image_of_signatures(lattice, corners, parity, first, around);
      const auto contour = extract_lattice<double>(image.view(), lattice, 0.5, options);
      EXPECT_TRUE(same_surface(contour, extract_stored<double>(image.view(), lattice, 0.5, options).contour));
      EXPECT_TRUE(is_oriented_manifold(check(contour)));
    }
}

TEST(LatticeRows, GiveEachContourOfA16Cell) {
  for (const detail::PatternCell& cell : detail::pattern_of_lattice(Lattice::d4))
    expect_each_signature(Lattice::d4, cell.corners, cell.parity);
}

TEST(LatticeRows, GiveEachContourOfAPrismOverAnOctahedron) {
  for (const detail::PatternCell& cell : detail::pattern_of_lattice(Lattice::fcc)) {
    if (cell.type != CellType::octahedron) continue;
    std::vector<detail::LatticePlace> corners = cell.corners;
    for (detail::LatticePlace corner : cell.corners) {
      ++corner[3];
      corners.push_back(corner);
    }
    expect_each_signature(Lattice::fcc_in_time, corners, cell.parity);
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

TEST(LatticeRows, GiveTheContourOfStoredCellsIn2DAnd3D) {
  const auto flat = sampled_on_lattice<2>(Lattice::triangular, Grid<2>::unit({70, 67}), noise_everywhere<2>(3));
  const auto fcc = sampled_on_lattice<3>(Lattice::fcc, Grid<3>::unit({12, 11, 12}), noise_everywhere<3>(4));
  const auto bcc = sampled_on_lattice<3>(Lattice::bcc, Grid<3>::unit({66, 7, 9}), noise_everywhere<3>(5));
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (ExtractOptions options : options_by_rows()) {
      options.triangulation = triangulation;
      expect_as_stored<double>(flat.view(), Lattice::triangular, 0.5, options);
      expect_as_stored<double>(fcc.view(), Lattice::fcc, 0.5, options);
      expect_as_stored<double>(bcc.view(), Lattice::bcc, 0.5, options);
    }
}

/// Vertices with rows of numbers, sorted.
std::vector<std::vector<double>> with_numbers(const std::vector<std::array<double, 4>>& vertices,
                                              const std::vector<std::array<double, 4>>& numbers) {
  std::vector<std::vector<double>> rows;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    std::vector<double>& row = rows.emplace_back(vertices[v].begin(), vertices[v].end());
    row.insert(row.end(), numbers[v].begin(), numbers[v].end());
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

TEST(LatticeRows, NumbersAreInterpolatedAsByStoredCells) {
  for (const Lattice lattice : kLattices) {
    SCOPED_TRACE(name_of(lattice));
    const auto image = noise_on(lattice, {9, 8, 9, 8}, 2);
    std::mt19937 random(5);
    std::vector<double> numbers;
    std::vector<std::array<double, 4>> places(image.values.size());
    for (auto& place : places)
      for (double& x : place) numbers.push_back(x = std::uniform_real_distribution<double>(-1.0, 1.0)(random));
    const ExtractOptions options = options_by_rows()[1];
    const auto complex = lattice_complex(image.view(), lattice);
    const auto stored = extract<double>(complex, 0.5, options);
    const auto expected = extract<double>(detail::ComplexAccess::at_places<4>(complex, places), 0.5, options);
    const auto contour = extract_lattice<double>(image.view(), lattice, 0.5, options);
    const Attribute attribute = interpolate_lattice(image.view(), lattice, 0.5, numbers, "numbers", "", options);
    ASSERT_EQ(attribute.values.size(), 4 * contour.vertices.size());
    std::vector<std::array<double, 4>> found(contour.vertices.size());
    for (std::size_t v = 0; v < found.size(); ++v)
      std::copy_n(attribute.values.begin() + 4 * static_cast<std::ptrdiff_t>(v), 4, found[v].begin());
    EXPECT_EQ(with_numbers({contour.vertices.begin(), contour.vertices.end()}, found),
              with_numbers({stored.vertices.begin(), stored.vertices.end()},
                           {expected.vertices.begin(), expected.vertices.end()}));
  }
}

/// The axis and the offset are near the limit of float, their sum is not: rows for contours in float and in double.
TEST(LatticeRows, NumbersHaveTheOrderOfVerticesNearTheLimitOfFloat) {
  for (const Lattice lattice : kLattices) {
    auto image = noise_on(lattice, {6, 5, 6, 6}, 2);
    image.grid.axes[0] = Axis::uniform(6, 3e38, 1e36);
    image.grid.offset[0] = -3e38;
    const ExtractOptions options = options_by_rows()[1];
    const auto contour = extract_lattice<float>(image.view(), lattice, 0.5, options);
    EXPECT_NE(contour.simplices, extract_stored<float>(image.view(), lattice, 0.5, options).contour.simplices);
    std::vector<double> numbers;
    for (const auto& point : detail::points_of(image.grid, detail::layer_axis(lattice)))
      numbers.insert(numbers.end(), point.begin() + 1, point.end());
    const Attribute attribute = interpolate_lattice(image.view(), lattice, 0.5, numbers, "numbers", "", options);
    ASSERT_EQ(attribute.values.size(), 3 * contour.vertices.size());
    for (std::size_t v = 0; v < contour.vertices.size(); ++v)
      for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(attribute.values[3 * v + a], contour.vertices[v][a + 1], 1e-5);
  }
}

TEST(LatticeRows, CanBeCancelledAtEachReport) {
  for (const Lattice lattice : kLattices) {
    const auto image = noise_on(lattice, {6, 6, 5, 6}, 2);
    ExtractOptions options = options_by_rows()[0];
    options.work.threads = 1;
    std::vector<double> reports;
    options.work.progress = [&](double fraction) {
      reports.push_back(fraction);
      return true;
    };
    (void)extract_lattice<double>(image.view(), lattice, 0.5, options);
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    EXPECT_EQ(reports.back(), 1.0);
    if (lattice == Lattice::fcc_in_time) {  // with so many contours of cells that some reports come between them
      EXPECT_GT(std::count_if(reports.begin(), reports.end(), [](double x) { return x > 0.3 && x < 0.35; }), 1);
    }
    for (std::size_t last = 0; last < reports.size(); ++last) {
      std::size_t seen = 0;
      options.work.progress = [&](double) { return seen++ < last; };
      expect_error(ErrorCode::Cancelled, "cancelled",
                   [&] { (void)extract_lattice<double>(image.view(), lattice, 0.5, options); });
    }
  }
}

}  // namespace
}  // namespace tegl::test
