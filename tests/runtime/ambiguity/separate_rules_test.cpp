// SPDX-License-Identifier: BSD-3-Clause
//
// Ambiguity::squares and decider: squares by the mean or the asymptotic decider, larger faces always separate. In 3D
// each tile is compared with the loops on its surface, which are traced in integers and share no code with the library;
// in every dimension, with the rules that decide squares in the same way, and with a caller's estimator.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "estimators.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "random_fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/saddle.hpp"
#include "tegl/stream.hpp"
#include "tile_pieces.hpp"

namespace tegl::test {
namespace {

constexpr std::array<Ambiguity, 2> kSeparating{Ambiguity::squares, Ambiguity::decider};
constexpr std::array<Triangulation, 2> kTriangulations{Triangulation::compact, Triangulation::barycentric};

ExtractOptions by(Ambiguity ambiguity, Triangulation triangulation = Triangulation::compact) {
  ExtractOptions options = by_ambiguity(ambiguity);
  options.triangulation = triangulation;
  return options;
}

/// The rule that decides squares in the same way and joins loops in cubes.
Ambiguity joining(Ambiguity ambiguity) { return ambiguity == Ambiguity::squares ? Ambiguity::mean : Ambiguity::saddle; }

template <int N, class Real>
bool are_same_bytes(const Contour<N, Real>& a, const Contour<N, Real>& b) {
  return std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end()) &&
         std::equal(a.simplices.begin(), a.simplices.end(), b.simplices.begin(), b.simplices.end());
}

/// Whether an ambiguous square joins its high corners. Values less the isovalue, in the order 00, 10, 01, 11.
bool joins_high(Ambiguity ambiguity, const std::array<std::int64_t, 4>& f) {
  if (ambiguity == Ambiguity::squares) return f[0] + f[1] + f[2] + f[3] >= 0;
  const Wide q = Wide{f[0]} * f[3] - Wide{f[1]} * f[2];
  return f[0] >= 0 ? q >= 0 : q <= 0;
}

/// A cube's values less the isovalue, none 0. Corner v has coordinate v >> a & 1 on axis a.
using Cube = std::array<std::int64_t, 8>;

/// An edge of a cube, by its ends.
struct Edge {
  unsigned low, high;
  auto operator<=>(const Edge&) const = default;
};

/// Joins the critical edges of a cube's square whose corner 00 is `base`, along the axes with bits a and b.
template <class Join>
void join_in_square(Ambiguity ambiguity, const Cube& f, unsigned base, unsigned a, unsigned b, const Join& join) {
  const std::array<unsigned, 4> v{base, base | a, base | b, base | a | b};
  const std::array<Edge, 4> around{{{v[0], v[1]}, {v[1], v[3]}, {v[2], v[3]}, {v[0], v[2]}}};
  std::vector<Edge> critical;
  for (const Edge& edge : around)
    if ((f[edge.low] >= 0) != (f[edge.high] >= 0)) critical.push_back(edge);
  if (critical.size() == 2) join(critical[0], critical[1]);
  if (critical.size() != 4) return;
  // Segments cut off the corners of one diagonal: the low ones if the high ones are joined.
  const bool cuts_first = (f[v[0]] >= 0) != joins_high(ambiguity, {f[v[0]], f[v[1]], f[v[2]], f[v[3]]});
  join(around[0], around[cuts_first ? 3 : 1]);
  join(around[2], around[cuts_first ? 1 : 3]);
}

/// The loops on a cube's surface, each as the set of its edges.
std::vector<std::vector<Edge>> loops(Ambiguity ambiguity, const Cube& f) {
  const auto number = [](const Edge& edge) { return std::size_t{8} * edge.low + edge.high; };
  Pieces pieces(64);
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned side = 0; side < 2; ++side)
      join_in_square(ambiguity, f, side << axis, 1u << (axis + 1) % 3, 1u << (axis + 2) % 3,
                     [&](const Edge& x, const Edge& y) { pieces.join(number(x), number(y)); });
  std::map<std::size_t, std::vector<Edge>> found;
  for (unsigned low = 0; low < 8; ++low)
    for (unsigned step = 1; step < 8; step *= 2)
      if ((low & step) == 0 && (f[low] >= 0) != (f[low | step] >= 0))
        found[pieces.find(number({low, low | step}))].push_back({low, low | step});
  std::vector<std::vector<Edge>> result;
  for (const auto& [root, edges] : found) result.push_back(edges);
  return result;
}

/// A random field without zeros.
SampledField<3> odd_field(std::mt19937_64& bits, const std::array<std::size_t, 3>& sizes, std::int64_t bound) {
  SampledField<3> field{sizes, {}};
  for (std::size_t i = 0; i < sizes[0] * sizes[1] * sizes[2]; ++i)
    field.values.push_back(
        2 * (static_cast<std::int64_t>(random_below(bits, 2 * static_cast<std::uint64_t>(bound))) - bound) + 1);
  return field;
}

/// Calls visit(index of the lowest sample, values) for the cubes of a field.
template <class Visit>
void for_each_cube(const SampledField<3>& field, const Visit& visit) {
  const auto& n = field.sizes;
  for (std::size_t z = 0; z + 1 < n[2]; ++z)
    for (std::size_t y = 0; y + 1 < n[1]; ++y)
      for (std::size_t x = 0; x + 1 < n[0]; ++x) {
        Cube f;
        for (unsigned v = 0; v < 8; ++v)
          f[v] = field.values[x + (v & 1u) + n[0] * (y + (v >> 1 & 1u) + n[1] * (z + (v >> 2)))];
        visit(std::array<std::int64_t, 3>{static_cast<std::int64_t>(x), static_cast<std::int64_t>(y),
                                          static_cast<std::int64_t>(z)},
              f);
      }
}

/// A disc for each loop.
std::vector<TilePiece<3>> expected_pieces(Ambiguity ambiguity, const SampledField<3>& field) {
  std::vector<TilePiece<3>> result;
  for_each_cube(field, [&](const std::array<std::int64_t, 3>& tile, const Cube& f) {
    for (const auto& loop : loops(ambiguity, f)) {
      TilePiece<3>& piece = result.emplace_back(TilePiece<3>{tile, {}, 1});
      for (const Edge& edge : loop) {
        std::array<double, 3> at;
        for (unsigned a = 0; a < 3; ++a) at[a] = static_cast<double>(tile[a]) + (edge.low >> a & 1u);
        const auto from = static_cast<double>(f[edge.low]), to = static_cast<double>(f[edge.high]);
        at[static_cast<std::size_t>(std::countr_zero(edge.high - edge.low))] += from / (from - to);
        piece.edges.push_back(in_small_units<3>(at));
      }
      std::sort(piece.edges.begin(), piece.edges.end());
    }
  });
  std::sort(result.begin(), result.end());
  return result;
}

/// Rows of two cubes are decided one by one, rows of 70 a word at a time.
constexpr std::array<std::array<std::size_t, 3>, 2> kSizes{{{3, 3, 3}, {71, 3, 3}}};

template <class T>
class SeparateRules : public ::testing::Test {};
using Types = ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(SeparateRules, Types);

/// The isovalue that is subtracted in fields; 0 in signed types.
template <Value T>
constexpr int kMiddle = std::is_unsigned_v<T> ? 100 : 0;

template <Value T>
OwnedImage<T, 3> raised(const SampledField<3>& field) {
  OwnedImage<T, 3> image{Grid<3>::unit(field.sizes), {}};
  for (const std::int64_t value : field.values) image.values.push_back(static_cast<T>(value + kMiddle<T>));
  return image;
}

TYPED_TEST(SeparateRules, HaveADiscForEachLoopOnACubesSurface) {
  std::mt19937_64 bits(1);
  // Of values +-1 and +-3 many means and saddles equal the isovalue.
  for (const std::int64_t bound : {1, 2, 45})
    for (const auto& sizes : kSizes)
      for (int i = 0; i < (sizes[0] == 3 ? 40 : 3); ++i) {
        const auto field = odd_field(bits, sizes, bound);
        const auto image = raised<TypeParam>(field);
        for (const Ambiguity ambiguity : kSeparating) {
          const auto expected = expected_pieces(ambiguity, field);
          for (const Triangulation triangulation : kTriangulations)
            ASSERT_EQ(tile_pieces(extract<double>(image.view(), kMiddle<TypeParam>, by(ambiguity, triangulation))),
                      expected)
                << (ambiguity == Ambiguity::squares ? "squares, " : "decider, ") << describe(field);
        }
      }
}

TYPED_TEST(SeparateRules, DifferOnlyInCubesThatTheInteriorTestJoins) {
  std::mt19937_64 bits(2);
  std::size_t joined = 0, apart = 0;
  for (const auto& sizes : kSizes)
    for (int i = 0; i < (sizes[0] == 3 ? 400 : 40); ++i) {
      const auto field = odd_field(bits, sizes, 45);
      const auto image = raised<TypeParam>(field);
      std::map<std::array<std::int64_t, 3>, std::vector<TilePiece<3>>> by_saddle, by_decider;
      for (const auto& piece : tile_pieces(extract<double>(image.view(), kMiddle<TypeParam>, by(Ambiguity::saddle))))
        by_saddle[piece.tile].push_back(piece);
      for (const auto& piece : tile_pieces(extract<double>(image.view(), kMiddle<TypeParam>, by(Ambiguity::decider))))
        by_decider[piece.tile].push_back(piece);
      for_each_cube(field, [&](const std::array<std::int64_t, 3>& tile, const Cube& f) {
        std::array<double, 8> values;
        std::copy(f.begin(), f.end(), values.begin());
        const bool is_joined = cube_choice<double>(std::span<const double, 8>(values), 0.0) != tile::Choice::separate;
        EXPECT_EQ(by_saddle[tile] != by_decider[tile], is_joined) << describe(field);
        // A tunnel joins two loops.
        EXPECT_EQ(by_decider[tile].size() - by_saddle[tile].size(), is_joined ? 1u : 0u);
        ++(is_joined ? joined : apart);
      });
    }
  EXPECT_GT(joined, 50u);
  EXPECT_GT(apart, 1000u);
}

template <Value T, int N>
void expect_as_joining_rule(const OwnedImage<T, N>& image, double isovalue) {
  for (const Ambiguity ambiguity : kSeparating)
    for (const Triangulation triangulation : kTriangulations)
      for (const bool close : {false, true}) {
        ExtractOptions options = by(ambiguity, triangulation);
        options.close = close;
        const auto found = extract<double>(image.view(), isovalue, options);
        options.ambiguity = joining(ambiguity);
        EXPECT_GT(found.simplices.size(), 0u);
        EXPECT_TRUE(are_same_bytes(found, extract<double>(image.view(), isovalue, options)));
      }
}

TYPED_TEST(SeparateRules, AreMeanAndSaddleIn2d) {
  expect_as_joining_rule(noise<TypeParam, 2>(std::size_t{70}, 3), noise_isovalue<TypeParam>());
  expect_as_joining_rule(coarse_noise<TypeParam, 2>(Grid<2>::unit({70, 70}), 4, 3), 1.0);
}

TEST(SeparateRulesOfSmoothImages, AreMeanAndSaddleIn3d) {
  const auto field = [](const Point<3>& x) {
    return std::sin(x[0]) * std::cos(x[1]) + std::sin(x[1]) * std::cos(x[2]) + std::sin(x[2]) * std::cos(x[0]);
  };
  expect_as_joining_rule(sample_field<float, 3>(centred_grid<3>(24, 4.0), field), 0.1);
}

/// The rule as a caller's estimator.
ExtractOptions as_callers(Ambiguity ambiguity) {
  return by_estimator(ambiguity == Ambiguity::squares
                          ? +[](const AmbiguousFace& face) {
                              if (face.dim() > 2) return tile::Choice::separate;
                              double sum = 0;
                              for (const double value : face.values()) sum += value;
                              return sum >= 4 * face.isovalue() ? tile::Choice::high : tile::Choice::low;
                            }
                          : +[](const AmbiguousFace& face) {
                              if (face.dim() > 2) return tile::Choice::separate;
                              return square_is_high<double>(face.values().first<4>(), face.isovalue())
                                         ? tile::Choice::high
                                         : tile::Choice::low;
                            });
}

template <Value T, int N>
void expect_as_callers(const std::array<std::size_t, N>& sizes) {
  const auto image = noise<T, N>(sizes, 5);
  for (const Ambiguity ambiguity : kSeparating)
    for (const Triangulation triangulation : kTriangulations)
      for (const bool close : {false, true}) {
        SCOPED_TRACE(std::string(ambiguity == Ambiguity::squares ? "squares" : "decider") +
                     (triangulation == Triangulation::compact ? ", compact" : ", barycentric") +
                     (close ? ", closed" : ""));
        ExtractOptions options = by(ambiguity, triangulation), callers = as_callers(ambiguity);
        options.close = callers.close = close;
        callers.triangulation = triangulation;
        const auto found = extract<double>(image.view(), noise_isovalue<T>(), options);
        if (close)
          expect_closed_manifold(found);
        else
          expect_oriented_manifold(found);
        EXPECT_TRUE(are_same_bytes(found, extract<double>(image.view(), noise_isovalue<T>(), callers)));
      }
}

TEST(SeparateRulesOfCallers, HaveTheSameBytesIn3d) {
  expect_as_callers<float, 3>({70, 6, 7});
  expect_as_callers<std::uint8_t, 3>({70, 6, 7});
  expect_as_callers<double, 3>({5, 6, 7});
}
TEST(SeparateRulesOfCallers, HaveTheSameBytesIn4d) {
  expect_as_callers<float, 4>({20, 4, 3, 4});
  expect_as_callers<std::int16_t, 4>({4, 4, 5, 4});
}
TEST(SeparateRulesOfCallers, HaveTheSameBytesIn5d) {
  expect_as_callers<float, 5>({3, 3, 3, 2, 2});
  expect_as_callers<std::uint8_t, 5>({2, 2, 3, 2, 3});
}

}  // namespace
}  // namespace tegl::test
