// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction by an index gives the contour of extraction without an index, byte by byte. Extraction by chosen tiles
// gives its part in these tiles.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "active.hpp"
#include "ambiguity/variants.hpp"
#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::test {
namespace {

using ::testing::HasSubstr;

template <class T>
bool same_bytes(const Buffer<T>& a, const Buffer<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

template <int N, class Real>
::testing::AssertionResult same_bytes(const Contour<N, Real>& a, const Contour<N, Real>& b) {
  if (same_bytes(a.vertices, b.vertices) && same_bytes(a.simplices, b.simplices) && same_bytes(a.normals, b.normals))
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << a.vertices.size() << " vertices and " << a.simplices.size()
                                       << " simplices against " << b.vertices.size() << " and " << b.simplices.size();
}

/// Tests all methods at some isovalues with all relevant options.
template <class Real, Value T, int N>
void expect_same(const OwnedImage<T, N>& image, const std::vector<double>& isovalues) {
  for (const ActiveMethod method : active_methods()) {
    const auto index = build_active_tiles(image.view(), method);
    for (const double isovalue : isovalues)
      for (ExtractOptions options : variants())
        for (const bool close : {false, true}) {
          options.close = close;
          options.normals = !close ? Normals::differences : Normals::none;
          options.work.threads = close ? 1 : 3;
          SCOPED_TRACE(std::string(active_method_name(method)) + ", " + describe(options) + ", at " +
                       std::to_string(isovalue));
          const auto expected = extract_with_stats<Real>(image.view(), isovalue, options);
          const auto found = extract_with_stats<Real>(image.view(), isovalue, *index, options);
          ASSERT_TRUE(same_bytes(found.contour, expected.contour));
          EXPECT_EQ(found.stats.active_tiles, expected.stats.active_tiles);
          EXPECT_EQ(found.stats.tiles, expected.stats.tiles);
        }
  }
}

template <class T>
class ExtractActiveOf : public ::testing::Test {};
using ValueTypes =
    ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(ExtractActiveOf, ValueTypes);

/// A few small distant balls, so that most rows have no active tile.
template <Value T, int N>
OwnedImage<T, N> sparse_image(const Grid<N>& grid) {
  Metaballs<N> field;
  field.width = 0.12;
  for (const double at : {-0.8, 0.1, 0.7}) {
    auto& centre = field.centres.emplace_back();
    for (int a = 0; a < N; ++a) centre[a] = a % 2 == 0 ? at : -0.9 * at;
  }
  return sample_field<T>(grid, field, 100.0);
}

TYPED_TEST(ExtractActiveOf, NoiseIsTheSame) {
  expect_same<float>(noise<TypeParam, 2>({70, 23}, 1), {noise_isovalue<TypeParam>()});
  expect_same<double>(noise<TypeParam, 3>({11, 6, 7}, 2), {noise_isovalue<TypeParam>()});
  expect_same<float>(noise<TypeParam, 4>({5, 4, 3, 4}, 3), {noise_isovalue<TypeParam>()});
}
TYPED_TEST(ExtractActiveOf, ImagesWithFewActiveRowsAreTheSame) {
  // Rows of several chunks, and several rows per chunk.
  expect_same<double>(sparse_image<TypeParam>(centred_grid<2>(130, 1.0)), {20.0, 60.0, 97.0});
  expect_same<float>(sparse_image<TypeParam>(centred_grid<3>(41, 1.0)), {1.0, 60.0, 90.0, 127.0});
  expect_same<double>(sparse_image<TypeParam>(centred_grid<4>(14, 1.0)), {2.0, 50.0});
}

TEST(ExtractActive, OfAllRareValuesIsTheSame) {
  OwnedImage<std::uint8_t, 3> image{Grid<3>::unit({30, 80, 9}), std::vector<std::uint8_t>(21600, 7)};
  for (const std::size_t at : {0u, 29u, 2399u, 5000u, 12345u, 21599u}) image.values[at] = 200;
  expect_same<float>(image, {7.0, 7.5, 200.0, 201.0, -3.0});
  for (auto& value : image.values) value = static_cast<std::uint8_t>(207 - value);
  expect_same<float>(image, {7.5, 199.5});
}

TEST(ExtractActive, NextToMissingValuesIsTheSame) {
  expect_same<float>(noise_with_missing<float, 2>(Grid<2>::unit({67, 40}), 4, 0.2), {0.5});
  expect_same<double>(noise_with_missing<double, 3>(Grid<3>::unit({17, 9, 8}), 5, 0.15), {0.5, 0.97});
  expect_same<float>(noise_with_missing<float, 4>(Grid<4>::unit({6, 5, 4, 4}), 6, 0.1), {0.5});
  auto sparse = sparse_image<float>(centred_grid<3>(36, 1.0));
  for (std::size_t i = 0; i < sparse.values.size(); ++i)
    if (i % 36 < 18) sparse.values[i] = std::nanf("");
  expect_same<float>(sparse, {30.0});
}

TEST(ExtractActive, OfAnyStridesIsTheSame) {
  const auto image = sparse_image<float>(centred_grid<3>(30, 1.0));
  const Image<float, 3> turned(image.values.data(), image.grid, {900, 30, 1});
  for (const ActiveMethod method : active_methods()) {
    const auto index = build_active_tiles(turned, method);
    EXPECT_TRUE(same_bytes(extract<float>(turned, 40.0, *index), extract<float>(turned, 40.0)));
  }
}

TEST(ExtractActive, OfAnAxisOfOneSampleIsEmpty) {
  const auto image = noise<float, 3>({9, 1, 7}, 7);
  const auto index = build_active_tiles(image.view(), ActiveMethod::interval_tree);
  EXPECT_TRUE(extract<float>(image.view(), 0.5, *index).vertices.empty());
}

TEST(ExtractActive, RefusesAnIndexOfAnotherImage) {
  const auto image = noise<float, 3>({9, 8, 7}, 8);
  const auto other = noise<float, 3>({9, 7, 8}, 8);
  const auto wide = noise<double, 3>({9, 8, 7}, 8);
  const auto message_of = [&](const ActiveTiles<3>& index) -> std::string {
    try {
      extract<float>(image.view(), 0.5, index);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message_of(*build_active_tiles(other.view(), ActiveMethod::min_max_tree)),
              HasSubstr("9 x 7 x 8 float; expected one of 9 x 8 x 7 float"));
  EXPECT_THAT(message_of(*build_active_tiles(wide.view(), ActiveMethod::span_space)),
              HasSubstr("9 x 8 x 7 double; expected one of 9 x 8 x 7 float"));
}

TEST(ExtractActive, RefusesWhatExtractRefuses) {
  const auto image = noise<float, 3>({9, 8, 7}, 9);
  const auto index = build_active_tiles(image.view(), ActiveMethod::interval_tree);
  EXPECT_THROW(extract<float>(image.view(), std::nan(""), *index), Error);
  ExtractOptions options;
  options.epsilon = 0.7;
  EXPECT_THROW(extract<float>(image.view(), 0.5, *index, options), Error);
  options = {};
  options.work.progress = [](double) { return false; };
  EXPECT_THROW(extract<float>(image.view(), 0.5, *index, options), Error);
  options = {};
  options.close = true;
  EXPECT_THROW(extract<float>(image.view(), 0.5, *choose_tiles(image.view(), {1, 2}), options), Error);
}

// ---- chosen tiles ----

/// Active tiles grouped by shared corners; each set is ascending.
template <int N>
std::vector<std::vector<TileNumber>> connected_tiles(const TileGrid<N>& grid, const std::vector<TileNumber>& tiles) {
  std::vector<bool> todo(grid.count(), false);
  for (const TileNumber tile : tiles) todo[tile] = true;
  std::vector<std::vector<TileNumber>> parts;
  for (const TileNumber seed : tiles) {
    if (!todo[seed]) continue;
    auto& part = parts.emplace_back(1, seed);
    todo[seed] = false;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const auto here = grid.index(part[i]);
      for (unsigned step = 0; step < 5'000; ++step) {  // 3^N neighbours
        unsigned rest = step;
        auto next = here;
        bool inside = true;
        for (int a = 0; a < N; ++a, rest /= 3) {
          next[a] += rest % 3;
          inside = inside && next[a] > 0 && next[a] <= grid.size(a);
          --next[a];
        }
        if (rest != 0) break;
        if (!inside || !todo[grid.number(next)]) continue;
        todo[grid.number(next)] = false;
        part.push_back(grid.number(next));
      }
    }
    std::sort(part.begin(), part.end());
  }
  return parts;
}

/// Corner coordinates by simplex.
template <int N, class Real>
std::vector<std::array<std::array<Real, N>, N>> corners(const Contour<N, Real>& contour) {
  std::vector<std::array<std::array<Real, N>, N>> result(contour.simplices.size());
  for (std::size_t s = 0; s < result.size(); ++s)
    for (int j = 0; j < N; ++j) result[s][j] = contour.vertices[contour.simplices[s][j]];
  return result;
}

template <int N, class Items>
bool is_within_in_order(const Items& part, const Items& whole) {
  auto at = whole.begin();
  for (const auto& item : part) {
    at = std::find(at, whole.end(), item);
    if (at == whole.end()) return false;
    ++at;
  }
  return true;
}

/// Each connected set of tiles gives its part of the contour, in the order of the whole; together they give the whole.
template <Value T, int N>
void expect_parts(const OwnedImage<T, N>& image, double isovalue, std::size_t least_parts) {
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE(describe(options));
    const auto whole = extract<double>(image.view(), isovalue, options);
    const auto whole_corners = corners(whole);
    const TileGrid<N> grid(image.grid.sizes());
    const auto parts = connected_tiles(grid, PlainRanges<N>(image.view()).active(isovalue));
    EXPECT_GE(parts.size(), least_parts);
    std::size_t vertices = 0, simplices = 0;
    for (const auto& tiles : parts) {
      const auto chosen = choose_tiles(image.view(), tiles);
      const auto [part, stats] = extract_with_stats<double>(image.view(), isovalue, *chosen, options);
      EXPECT_EQ(stats.active_tiles, tiles.size());
      expect_oriented_manifold(part);
      EXPECT_TRUE(is_within_in_order<N>(part.vertices, whole.vertices));
      EXPECT_TRUE(is_within_in_order<N>(corners(part), whole_corners));
      vertices += part.vertices.size();
      simplices += part.simplices.size();
    }
    EXPECT_EQ(vertices, whole.vertices.size());
    EXPECT_EQ(simplices, whole.simplices.size());
  }
}

TEST(ExtractChosenTiles, OfAPartGivesItsShareOfTheContour) {
  expect_parts(noise<float, 2>({40, 21}, 10), 0.93, 20);
  expect_parts(sparse_image<float>(centred_grid<3>(33, 1.0)), 50.0, 3);
  expect_parts(noise<std::uint8_t, 3>({14, 9, 8}, 11), 250.0, 4);
  expect_parts(sparse_image<double>(centred_grid<4>(13, 1.0)), 40.0, 3);
}

/// The chosen tiles may include tiles with missing corners.
template <int N>
void expect_whole_of_all_tiles(const OwnedImage<float, N>& image, double isovalue) {
  std::vector<TileNumber> all(TileGrid<N>(image.grid.sizes()).count());
  std::iota(all.begin(), all.end(), TileNumber{0});
  const auto chosen = choose_tiles(image.view(), all);
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE(describe(options));
    const auto whole = extract<float>(image.view(), isovalue, options);
    ASSERT_FALSE(whole.simplices.empty());
    EXPECT_TRUE(same_bytes(extract<float>(image.view(), isovalue, *chosen, options), whole));
  }
}

TEST(ExtractChosenTiles, WithMissingCornersHaveNoContour) {
  expect_whole_of_all_tiles(noise_with_missing<float, 2>(Grid<2>::unit({40, 21}), 13, 0.1), 0.5);
  expect_whole_of_all_tiles(noise_with_missing<float, 3>(Grid<3>::unit({14, 9, 8}), 14, 0.05), 0.5);
  expect_whole_of_all_tiles(noise_with_missing<float, 4>(Grid<4>::unit({8, 6, 5, 6}), 15, 0.02), 0.5);
}

TEST(ExtractChosenTiles, OfASingleTileIsAManifoldWithBorder) {
  const auto image = noise<float, 3>({9, 8, 7}, 12);
  const auto tiles = PlainRanges<3>(image.view()).active(0.5);
  for (std::size_t i = 0; i < tiles.size(); i += 17) {
    const auto contour = extract<float>(image.view(), 0.5, *choose_tiles(image.view(), {tiles[i]}));
    EXPECT_GT(expect_oriented_manifold(contour).boundary_simplices, 0u);
  }
}

}  // namespace
}  // namespace tegl::test
