// SPDX-License-Identifier: BSD-3-Clause
//
// The tables that the build compiled, read back as the contract says and held against the builder that they came
// from; and the manifest that is reviewed in their stead.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>

#include "decode.hpp"
#include "tegl/gen/table_set.hpp"
#include "tegl/generated/tables.hpp"

namespace tegl::gen {
namespace {

/// Sorted oriented simplices; own vertices by what they are, not by number.
std::vector<std::vector<std::uint64_t>> canonical(std::uint32_t n, std::uint32_t own_base, const Decoded& d) {
  std::map<std::uint8_t, std::uint64_t> name;
  for (const Simplex& s : d.simplices)
    if (s[0] >= own_base && s[0] < own_base + d.cones)
      for (std::uint32_t i = 1; i < n; ++i) {
        auto& own = name.emplace(s[0], ~std::uint64_t{0}).first->second;
        own = std::min(own, (std::uint64_t{1} << 60) + s[i]);
      }
  std::vector<std::vector<std::uint64_t>> result;
  for (const Simplex& s : d.simplices) {
    std::vector<std::uint64_t> v;
    for (std::uint32_t i = 0; i < n; ++i)
      v.push_back(s[i] < own_base             ? s[i]
                  : s[i] < own_base + d.cones ? name.at(s[i])
                                              : (std::uint64_t{1} << 61) | d.masks[s[i] - own_base - d.cones]);
    std::uint64_t odd = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) odd ^= v[i] > v[j] ? 1 : 0;
    std::sort(v.begin(), v.end());
    v.push_back(odd);
    result.push_back(v);
  }
  std::sort(result.begin(), result.end());
  return result;
}

Decoded from_builder(const TileContour& contour) {
  Decoded d;
  d.cones = contour.cone_vertices;
  d.masks = contour.side_masks;
  for (const Facet& f : contour.facets) d.simplices.insert(d.simplices.end(), f.simplices.begin(), f.simplices.end());
  return d;
}

/// The first signature whose decoded contour is not the builder's, or -1.
long first_difference(const tables::TileTable& table, Triangulation triangulation) {
  const auto n = static_cast<int>(table.dim);
  const CubeLattice lattice(n);
  const ContourBuilder builder(lattice, n, Alternative::low, triangulation);
  for (Signature s = 0; s <= builder.tile().full(); ++s)
    if (canonical(table.dim, builder.own_base(), decode(table, s)) !=
        canonical(table.dim, builder.own_base(), from_builder(builder.build(s))))
      return s;
  return -1;
}

class CompiledTableTest : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(CompiledTableTest, HoldsTheBuildersContourOfEverySignature) {
  const auto [dim, t] = GetParam();
  const tables::TileTable& table = tables::tile_table(dim, t);
  EXPECT_EQ(tables::kContractVersion, table.version);
  EXPECT_EQ(static_cast<std::uint32_t>(dim), table.dim);
  EXPECT_EQ(-1, first_difference(table, t == 0 ? Triangulation::barycentric : Triangulation::compact));
}

INSTANTIATE_TEST_SUITE_P(All, CompiledTableTest, testing::Combine(testing::Values(2, 3, 4), testing::Values(0, 1)));

TEST(Tables, OneFlippedEntryIsNoticed) {
  const tables::TileTable& good = tables::tile_table(3, 1);
  std::vector<std::uint8_t> simplices(good.simplices, good.simplices + std::size_t{good.simplex_count} * 3);
  tables::TileTable bad = good;
  for (std::size_t at = 0; at < simplices.size(); at += 97) {
    simplices[at] ^= 1;
    bad.simplices = simplices.data();
    EXPECT_NE(-1, first_difference(bad, Triangulation::compact)) << "entry " << at;
    simplices[at] ^= 1;
  }
}

TEST(Tables, ByClassAndFlatHoldTheSame) {
  for (const int n : {2, 3}) {
    const CubeLattice lattice(n);
    const ContourBuilder builder(lattice, n, Alternative::low, Triangulation::barycentric);
    std::vector<TileContour> contours;
    for (Signature s = 0; s <= builder.tile().full(); ++s) contours.push_back(builder.build(s));
    const TileTables by_class = make_tile_tables(builder, contours, Layout::by_class);
    EXPECT_LT(by_class.lists.size(), contours.size());
    EXPECT_EQ(-1, first_difference(by_class.view(), Triangulation::barycentric)) << n;
  }
}

TEST(Tables, ACompactTriangulationIsRefusedByClassBecauseItDoesNotMoveWithTheSymmetries) {
  const CubeLattice lattice(3);
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
  std::vector<TileContour> contours;
  for (Signature s = 0; s <= builder.tile().full(); ++s) contours.push_back(builder.build(s));
  EXPECT_ANY_THROW(make_tile_tables(builder, contours, Layout::by_class));
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Manifest, IsWhatTheBuildGenerated) {
  if (std::string(TEGL_TABLE_LAYOUT) != "auto") GTEST_SKIP() << "built with tables of another layout";
  std::string joined = "[\n";
  for (const int dim : {2, 3, 4})
    joined +=
        text_of(std::string(TEGL_TABLE_DIR) + "/manifest" + std::to_string(dim) + ".json") + (dim < 4 ? ",\n" : "]\n");
  EXPECT_EQ(text_of(TEGL_SOURCE_DIR "/generated/MANIFEST.json"), joined)
      << "the tables have changed; where that was meant: ninja update_manifest, and say why in the commit";
}

TEST(Emission, IsTheSameTextEveryTime) {
  if (std::string(TEGL_TABLE_LAYOUT) != "auto") GTEST_SKIP() << "built with tables of another layout";
  TableRequest request;
  request.dim = 3;
  request.command = "gen --dim 3";
  const auto first = emit_cpp(make_table_set(request)), second = emit_cpp(make_table_set(request));
  ASSERT_EQ(3u, first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].name, second[i].name);
    EXPECT_EQ(first[i].text, second[i].text);
    EXPECT_EQ(text_of(std::string(TEGL_TABLE_DIR) + "/" + first[i].name), first[i].text);
  }
}

}  // namespace
}  // namespace tegl::gen
