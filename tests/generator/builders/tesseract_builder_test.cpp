// SPDX-License-Identifier: BSD-3-Clause
//
// The emitted builders of the tesseract, as compiled.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "../../support/share.hpp"
#include "builder4_edges.hpp"
#include "filling/resolutions.hpp"
#include "tesseract_checks.hpp"

namespace tegl::test {
namespace {

/// A pair (signature, resolution of its squares).
std::vector<ResolvedKey> pairs_up_to_symmetry(const GeneralTesseract& general) {
  const auto& faces = general.lattice().faces();
  std::vector<std::uint32_t> bit(faces.size());
  for (unsigned q = 0; q < 24; ++q) {
    tile::Signature corners = 0;
    for (unsigned v = 0; v < 16; ++v)
      if ((v & ~unsigned{builders::kTesseractSquares[q].axes}) == builders::kTesseractSquares[q].base)
        corners |= tile::Signature{1} << v;
    bit[general.lattice().find(corners).value()] = 1u << q;
  }
  std::vector<ResolvedKey> keys;
  gen::for_each_resolution(
      gen::TileKind::cube, 4,
      [&](gen::Signature signature, const std::vector<std::uint32_t>& polygons, std::uint32_t high) {
        ResolvedKey& key = keys.emplace_back();
        key.signature = static_cast<std::uint16_t>(signature);
        for (std::size_t i = 0; i < polygons.size(); ++i)
          if ((high >> i & 1u) != 0) key.squares |= bit[polygons[i]];
      });
  return keys;
}

TEST(TesseractBuilder, EveryResolutionOfSquaresIsThatOfTheGeneralBuilderAndOfTheDefinition) {
  GeneralTesseract general;
  const std::vector<ResolvedKey> keys = pairs_up_to_symmetry(general);
  ASSERT_EQ(keys.size(), 134683u);
  const std::size_t step = keys.size() / cases_to_test(keys.size(), keys.size() / 48);
  builders::ResolvedTesseract compact, barycentric(Triangulation::barycentric);
  for (std::size_t i = 0; i < keys.size(); i += step)
    for (const Choice centre : {Choice::separate, Choice::low, Choice::high}) {
      ResolvedKey key = keys[i];
      key.tile = centre;
      const bool defined = centre != Choice::separate;
      ASSERT_EQ(fault_of_tesseract(compact, general, key, Triangulation::compact, defined), "");
      if (i / step % 4 == 0) {
        ASSERT_EQ(fault_of_tesseract(barycentric, general, key, Triangulation::barycentric, defined), "");
      }
    }
}

/// So nested copies are proved to be embedded for every resolution of squares: symmetries map roots to roots. Cubes are
/// resolved at random.
TEST(TesseractBuilder, EveryTesseractHasARootForNestedCopies) {
  const GeneralTesseract general;
  builders::ResolvedTesseract builder;
  std::mt19937 random(1);
  std::size_t without = 0;
  for (ResolvedKey key : pairs_up_to_symmetry(general)) {
    without += builder.has_root(key) ? 0 : 1;
    const auto bits = static_cast<unsigned>(random());
    key.low_cubes = static_cast<std::uint8_t>(bits);
    key.high_cubes = static_cast<std::uint8_t>(bits >> 8 & ~unsigned{key.low_cubes});
    without += builder.has_root(key) ? 0 : 1;
  }
  EXPECT_EQ(without, 0u);
}

TEST(TesseractBuilder, FillingsOnEdgesAreProvedToBeEmbedded) {
  const GeneralTesseract general;
  const gen::CubeLattice lattice(4);
  const gen::EmbeddingProof proof(lattice.tile(4));
  const std::vector<ResolvedKey> keys = pairs_up_to_symmetry(general);
  const std::size_t share = unless_sanitized(keys.size() / 4, keys.size() / 48);
  const std::size_t step = keys.size() / cases_to_test(keys.size(), share);
  builders::ResolvedTesseract builder;
  std::size_t proved = 0;
  for (std::size_t i = 0; i < keys.size(); i += step)
    for (const Choice centre : {Choice::separate, Choice::low, Choice::high}) {
      ResolvedKey key = keys[i];
      key.tile = centre;
      const builders::ResolvedView view = builder.find(key);
      if (!is_on_edges(view)) continue;
      ASSERT_EQ(fault_of_embedding(proof, key, view), "");
      ++proved;
    }
  std::printf("  %zu fillings have only vertices on edges\n", proved);
  EXPECT_GT(proved, keys.size() / step / 50);
}

TEST(TesseractBuilder, RandomChoicesOfCubesAreThoseOfTheGeneralBuilder) {
  builders::ResolvedTesseract compact, barycentric(Triangulation::barycentric);
  EXPECT_EQ(fault_of_tesseracts(compact, Triangulation::compact, 6000), "");
  EXPECT_EQ(fault_of_tesseracts(barycentric, Triangulation::barycentric, 2000), "");
}

/// Keys in which each cube and the tile have a centre, low or high.
TEST(TesseractBuilder, CentresOfCubesJoinTheFacetsOfTheDefinition) {
  builders::ResolvedTesseract builder;
  RandomKeys keys(8);
  int other_cubes = 0, other_centre = 0;
  for (int i = 0; i < 6000; ++i) {
    ResolvedKey key = keys();
    key.high_cubes = static_cast<std::uint8_t>(~unsigned{key.low_cubes});
    key.tile = i % 2 == 0 ? Choice::low : Choice::high;
    std::multiset<long> eulers;
    for (const auto& [edges, euler] : figures_of(builder.find(key))) eulers.insert(euler);
    ASSERT_EQ(eulers, GeneralTesseract::eulers_by_centres(key)) << text_of(key);
    // the definition does depend on these choices
    ResolvedKey other = key;
    std::swap(other.low_cubes, other.high_cubes);
    other_cubes += eulers != GeneralTesseract::eulers_by_centres(other) ? 1 : 0;
    other = key;
    other.tile = i % 2 == 0 ? Choice::high : Choice::low;
    other_centre += eulers != GeneralTesseract::eulers_by_centres(other) ? 1 : 0;
  }
  EXPECT_GT(other_cubes, 100);
  EXPECT_GT(other_centre, 100);
}

TEST(TesseractBuilder, TableAndEdgesGiveTheSameBytes) {
  builders::ResolvedTesseract by_table;
  builders::edges::ResolvedTesseract by_edges;
  RandomKeys keys(7);
  for (int i = 0; i < 40000; ++i) {
    const ResolvedKey key = keys();
    ASSERT_EQ(tesseract_numbers(by_table, key), tesseract_numbers(by_edges, key)) << text_of(key);
  }
}

TEST(TesseractBuilder, ThePlainMapOfTetrahedraIsTheSame) {
  std::vector<std::uint8_t> from(64), out(64), swapped(64);
  std::array<std::uint64_t, 4> to{};
  for (unsigned v = 0; v < 64; ++v) from[v] = static_cast<std::uint8_t>(v * 7 % 32);
  for (unsigned v = 0; v < 32; ++v) to[v / 8] |= std::uint64_t{100 + v} << (8 * (v % 8));
  builders::ResolvedTesseract::map_tetrahedra(from.data(), 16, to.data(), false, out.data());
  builders::ResolvedTesseract::map_tetrahedra(from.data(), 16, to.data(), true, swapped.data());
  for (unsigned v = 0; v < 64; ++v) {
    EXPECT_EQ(out[v], 100 + from[v]);
    EXPECT_EQ(swapped[v], out[v % 4 < 2 ? v : v ^ 1u]);
  }
}

}  // namespace
}  // namespace tegl::test
