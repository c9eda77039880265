// SPDX-License-Identifier: BSD-3-Clause
//
// A picked component equals one of the whole contour's components byte by byte, and is the one that the rule defines.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "active.hpp"
#include "estimators.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/components.hpp"
#include "tegl/pick.hpp"

namespace tegl::test {
namespace {

template <int N, class Real>
bool same(const Contour<N, Real>& a, const Contour<N, Real>& b) {
  return a.vertices == b.vertices && a.simplices == b.simplices && a.normals == b.normals &&
         a.axis_names == b.axis_names && a.axis_units == b.axis_units && a.direction == b.direction;
}

/// The nearest active tile, by exhaustive search.
template <int N>
TileNumber nearest_by_trial(const TileGrid<N>& grid, const std::vector<TileNumber>& active, const Point<N>& at) {
  TileNumber nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const TileNumber tile : active) {
    double square = 0;
    for (int a = 0; a < N; ++a) {
      const auto low = static_cast<double>(grid.index(tile)[a]);
      const double off = std::max({0.0, low - at[a], at[a] - low - 1.0});
      square += off * off;
    }
    if (square < least) {
      least = square;
      nearest = tile;
    }
  }
  return nearest;
}

template <int N>
double squared_distance(const Contour<N, double>& contour, const std::array<double, N>& at) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& vertex : contour.vertices) {
    double square = 0;
    for (int a = 0; a < N; ++a) square += (vertex[a] - at[a]) * (vertex[a] - at[a]);
    least = std::min(least, square);
  }
  return least;
}

/// The tiles of a contour's simplices, except simplices in a face of tiles.
template <int N>
std::vector<TileNumber> tiles_of(const Contour<N, double>& contour, const TileGrid<N>& grid) {
  std::vector<TileNumber> tiles;
  for (const auto& simplex : contour.simplices) {
    std::array<double, N> middle{};
    for (const Index v : simplex)
      for (int a = 0; a < N; ++a) middle[a] += contour.vertices[v][a] / N;
    std::array<std::size_t, N> index;
    for (int a = 0; a < N; ++a) index[a] = std::min(static_cast<std::size_t>(middle[a]), grid.size(a) - 1);
    tiles.push_back(grid.number(index));
  }
  return tiles;
}

/// For grids of step 1 with origin 0.
template <Value T, int N>
void expect_picks(const OwnedImage<T, N>& image, double isovalue, ExtractOptions options, int picks) {
  const auto whole = extract<double>(image.view(), isovalue, options);
  const auto labels = label_components(whole);
  const auto parts = split_components(whole, labels);
  const TileGrid<N> grid(image.view().grid().sizes());
  const auto active = PlainRanges<N>(image.view()).active(isovalue);
  ExtractOptions apart = options;
  apart.epsilon = 0.3;  // so that no simplex lies in a tile's face
  std::vector<std::vector<TileNumber>> tiles;
  for (const auto& part : split_components(extract<double>(image.view(), isovalue, apart), labels))
    tiles.push_back(tiles_of<N>(part, grid));
  std::mt19937_64 random(5);
  for (int i = 0; i < picks; ++i) {
    Point<N> at;
    for (int a = 0; a < N; ++a)
      at[a] = static_cast<double>(random() >> 11) * 0x1p-53 * static_cast<double>(grid.size(a));
    options.work.threads = 1 + static_cast<unsigned>(i % 4);
    const auto [picked, report] = extract_component<double>(image.view(), isovalue, at, options);
    ASSERT_EQ(report.found, !active.empty());
    if (active.empty()) continue;
    EXPECT_EQ(report.tile, nearest_by_trial<N>(grid, active, at));
    EXPECT_EQ(grid.number(report.at), report.tile);
    std::size_t which = parts.size();
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (same(parts[k], picked)) which = k;
    ASSERT_LT(which, parts.size()) << "pick " << i << ": not a component of the whole";
    ASSERT_GE(report.components, 1u);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (std::find(tiles[k].begin(), tiles[k].end(), report.tile) == tiles[k].end()) continue;
      ASSERT_LE(squared_distance<N>(picked, at), squared_distance<N>(parts[k], at))
          << "pick " << i << ", component " << k;
    }
    expect_oriented_manifold(picked);
  }
}

TEST(Pick, OfNoiseIsAComponentOfTheWhole) {
  expect_picks(noise<float, 2>({30, 25}, 1), 0.5, {}, 40);
  expect_picks(noise<std::uint8_t, 2>({30, 25}, 1), 200.0, {}, 40);
  expect_picks(noise<double, 3>({12, 11, 10}, 2), 0.9, {}, 40);
  expect_picks(coarse_noise<std::uint8_t, 3>(Grid<3>::unit({12, 11, 10}), 3, 5), 4.0, {}, 40);
  expect_picks(noise<float, 4>({7, 6, 5, 6}, 4), 0.95, {}, 12);
}

TEST(Pick, WithAnyOptionsIsAComponentOfTheWhole) {
  ExtractOptions options;
  options.ambiguity = Ambiguity::high;
  options.normals = Normals::differences;
  options.direction = GradientDirection::ascent;
  expect_picks(noise<float, 3>({12, 11, 10}, 5), 0.1, options, 20);
  options.triangulation = Triangulation::barycentric;
  options.epsilon = 0.01;
  expect_picks(noise<float, 3>({12, 11, 10}, 6), 0.9, options, 20);
  options.close = true;
  expect_picks(noise<float, 3>({12, 11, 10}, 7), 0.9, options, 20);
  expect_picks(noise<float, 2>({20, 19}, 8), 0.8, options, 20);
}

TEST(Pick, ResolvedFromTheDataIsAComponentOfTheWhole) {
  for (const NamedOptions& way : all_estimators()) {
    SCOPED_TRACE(way.name);
    expect_picks(noise<float, 2>({30, 25}, 21), 0.6, way.options, 15);
    expect_picks(noise<std::uint8_t, 3>({12, 11, 10}, 22), 30.0, way.options, 15);
    expect_picks(noise_with_missing<float, 3>(Grid<3>::unit({12, 11, 10}), 23, 0.02), 0.9, way.options, 10);
    expect_picks(noise<float, 4>({7, 6, 5, 6}, 24), 0.95, way.options, 4);
    ExtractOptions options = way.options;
    options.close = true;
    expect_picks(noise<float, 3>({12, 11, 10}, 25), 0.9, options, 5);
    options.triangulation = Triangulation::barycentric;
    expect_picks(noise<float, 4>({5, 4, 4, 5}, 26), 0.95, options, 3);
  }
}

TEST(Pick, NextToMissingValuesIsAComponentOfTheWhole) {
  expect_picks(noise_with_missing<float, 2>(Grid<2>::unit({30, 25}), 9, 0.05), 0.8, {}, 30);
  expect_picks(noise_with_missing<float, 3>(Grid<3>::unit({12, 11, 10}), 10, 0.02), 0.92, {}, 30);
}

/// Vertices at edges that tiles of several components share, separated by missing values. In the whole contour they are
/// duplicated, and come first or last.
TEST(Pick, AcrossMissingValuesFromOthersHasTheOrderOfTheWhole) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    expect_picks(noise_with_missing<float, 2>(Grid<2>::unit({40, 35}), seed, 0.2), 0.7, {}, 20);
    expect_picks(noise_with_missing<float, 3>(Grid<3>::unit({12, 11, 10}), seed, 0.06), 0.85, {}, 20);
    expect_picks(noise_with_missing<double, 3>(Grid<3>::unit({14, 11, 10}), seed, 0.12), 0.6, {}, 20);
    expect_picks(noise_with_missing<float, 4>(Grid<4>::unit({7, 6, 5, 6}), seed, 0.05), 0.9, {}, 8);
    expect_picks(noise_with_missing<float, 4>(Grid<4>::unit({7, 7, 6, 6}), seed, 0.1), 0.8, {}, 8);
  }
}

/// Values 0, 1 and missing: at isovalues 0 and 1 the vertices are samples, and simplices may be degenerate or lie in
/// faces of tiles.
template <int N>
void expect_picks_of_ties(const std::array<std::size_t, N>& sizes, std::uint64_t seed, double missing, bool close) {
  auto image = noise_with_missing<float, N>(Grid<N>::unit(sizes), seed, missing);
  for (float& value : image.values)
    if (value == value) value = value < 0.5f ? 0.0f : 1.0f;
  ExtractOptions options;
  options.close = close;
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high, Ambiguity::saddle}) {
    options.ambiguity = ambiguity;
    for (const double isovalue : {1.0, 0.5, 0x1p-1074}) expect_picks<float, N>(image, isovalue, options, 4);
  }
}

TEST(Pick, WhereSamplesEqualTheIsovalueIsAComponentOfTheWhole) {
  for (std::uint64_t seed = 0; seed < 8; ++seed)
    for (const bool close : {false, true}) {
      SCOPED_TRACE(testing::Message() << seed << (close ? ", closed" : ""));
      expect_picks_of_ties<2>({9, 8}, seed, 0.15, close);
      expect_picks_of_ties<3>({4, 5, 4}, seed, 0.15, close);
      expect_picks_of_ties<3>({5, 4, 5}, seed, 0.0, close);
      expect_picks_of_ties<4>({3, 4, 3, 3}, seed, 0.12, close);
    }
}

TEST(Pick, In5dIsAComponentOfTheWhole) { expect_picks(noise<float, 5>({5, 4, 3, 4, 3}, 11), 0.995, {}, 3); }

/// Single-precision coordinates far from 0: vertices on the border are rounded to positions outside the grid, by more
/// than the tolerance elsewhere.
TEST(Pick, OfVerticesThatRoundingPutsOutsideOfTheGridIsTheNearest) {
  constexpr std::size_t kSize = 12;
  Grid<3> grid;
  for (Axis& axis : grid.axes) axis = Axis::uniform(kSize, 500000.02, 0.1);
  OwnedImage<float, 3> image{grid, std::vector<float>(kSize * kSize * kSize, 0.0f)};
  const auto at = [](std::size_t i, std::size_t j, std::size_t k) { return i + kSize * (j + kSize * k); };
  for (std::size_t i = 0; i < 27; ++i) image.values[at(3 + i % 3, 3 + i / 3 % 3, 3 + i / 9)] = 1.0f;
  image.values[at(11, 11, 11)] = 1.0f;
  ExtractOptions options;
  options.close = true;
  const auto expect_corner = [&](const auto& picked) {
    EXPECT_EQ(picked.vertices.size(), 4u);
    for (const auto& vertex : picked.vertices)
      for (const auto x : vertex) EXPECT_GT(x, 500001.0);
  };
  expect_corner(extract_component<double>(image.view(), 0.5, {500001.08, 500001.08, 500001.08}, options).contour);
  const auto picked = extract_component<float>(image.view(), 0.5, {500001.08, 500001.08, 500001.08}, options);
  expect_corner(picked.contour);
  EXPECT_EQ(picked.report.components, 1u);
}

TEST(Pick, OfTwoBallsIsTheNearer) {
  const Ball<3> small{{-2.0, 0.0, 0.0}, 0.8};
  const Ball<3> large{{1.5, 0.0, 0.0}, 1.5};
  const auto image =
      sample_field<float>(centred_grid<3>(60, 3.5), [&](const Point<3>& x) { return std::max(small(x), large(x)); });
  const auto [picked, report] = extract_component<double>(image.view(), 0.0, {-2.0, 0.1, 0.0});
  EXPECT_EQ(expect_closed_manifold(picked).components, 1u);
  for (const auto& vertex : picked.vertices) EXPECT_LT(vertex[0], -1.0);
  EXPECT_EQ(report.components, 1u);
  EXPECT_LT(report.tiles * 3, PlainRanges<3>(image.view()).active(0.0).size());
  const auto other = extract_component<float>(image.view(), 0.0, {3.5, 3.5, 3.5}).contour;
  EXPECT_EQ(expect_closed_manifold(other).components, 1u);
  for (const auto& vertex : other.vertices) EXPECT_GT(vertex[0], -0.5f);
}

TEST(Pick, SeesThePointInTheWorld) {
  const Ball<2> left{{-2.0, 0.0}, 0.8};
  const Ball<2> right{{2.0, 0.0}, 0.8};
  auto image =
      sample_field<double>(centred_grid<2>(60, 3.5), [&](const Point<2>& x) { return std::max(left(x), right(x)); });
  image.grid.linear = {{{0, -2}, {2, 0}}};
  image.grid.offset = {100, 0};
  const auto picked = extract_component<double>(image.view(), 0.0, {100.0, 4.2}).contour;
  ASSERT_FALSE(picked.vertices.empty());
  for (const auto& vertex : picked.vertices) EXPECT_GT(vertex[1], 0.0);
}

TEST(Pick, OutsideOfTheImageIsAnError) {
  const auto image = noise<float, 2>({9, 8}, 12);
  for (const Point<2>& at : {Point<2>{-1.0, 2.0}, Point<2>{2.0, 7.5}, Point<2>{std::nan(""), 1.0}}) {
    try {
      extract_component<double>(image.view(), 0.5, at);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find("(0, 0) to (8, 7)"), std::string::npos) << error.what();
    }
  }
}

TEST(Pick, ClosedWithoutActiveTilesIsTheNearestPieceOfTheBorder) {
  // High everywhere except a wall of missing values: the contour lies in the border, on both sides of the wall.
  OwnedImage<float, 3> image{Grid<3>::unit({9, 5, 5}), std::vector<float>(9 * 5 * 5, 1.0f)};
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (i % 9 == 5) image.values[i] = std::nanf("");
  ExtractOptions options;
  options.close = true;
  const auto whole = extract<double>(image.view(), 0.5, options);
  const auto parts = split_components(whole, label_components(whole));
  ASSERT_GE(parts.size(), 2u);
  const auto [left, report] = extract_component<double>(image.view(), 0.5, {0.0, 2.0, 2.0}, options);
  const auto right = extract_component<double>(image.view(), 0.5, {8.0, 2.0, 2.0}, options).contour;
  EXPECT_FALSE(report.found);
  EXPECT_EQ(report.components, parts.size());
  EXPECT_FALSE(same(left, right));
  for (const auto& picked : {left, right}) {
    expect_oriented_manifold(picked);  // open at missing values
    EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return same(part, picked); }));
  }
}

TEST(Pick, WithoutAContourIsEmpty) {
  const auto image = noise<float, 3>({9, 8, 7}, 13);
  const auto picked = extract_component<double>(image.view(), 2.0, {1.0, 1.0, 1.0});
  EXPECT_TRUE(picked.contour.simplices.empty());
  EXPECT_FALSE(picked.report.found);
}

}  // namespace
}  // namespace tegl::test
