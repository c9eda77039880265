// SPDX-License-Identifier: BSD-3-Clause
//
// The compiled tables, decoded by the contract and compared with the builder; and the manifest, which is reviewed in
// their place.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

#include "decode.hpp"
#include "tables/emit.hpp"
#include "tables/table_set.hpp"
#include "tegl/generated/tables.hpp"

namespace tegl::gen {
namespace {

/// Sorted oriented simplices, with own vertices named by their meaning, not by number.
std::vector<std::vector<std::uint64_t>> canonical(std::uint32_t n, std::uint32_t own_base, const Decoded& d) {
  std::map<std::uint8_t, std::uint64_t> name;
  for (const LocalSimplex& s : d.simplices)
    if (s[0] >= own_base && s[0] < own_base + d.cones)
      for (std::uint32_t i = 1; i < n; ++i) {
        auto& own = name.emplace(s[0], ~std::uint64_t{0}).first->second;
        own = std::min(own, (std::uint64_t{1} << 60) + s[i]);
      }
  std::vector<std::vector<std::uint64_t>> result;
  for (const LocalSimplex& s : d.simplices) {
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
  for (const LocalFacet& f : contour.facets)
    d.simplices.insert(d.simplices.end(), f.simplices.begin(), f.simplices.end());
  return d;
}

constexpr std::array kTriangulations{Triangulation::barycentric, Triangulation::compact};
constexpr std::array kAlternatives{Alternative::low, Alternative::high};

/// The first signature whose decoded contour differs from the builder's, or -1.
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

class CompiledTableTest : public testing::TestWithParam<std::tuple<int, Triangulation>> {};

TEST_P(CompiledTableTest, HoldsTheBuildersContourOfEverySignature) {
  const auto [dim, t] = GetParam();
  const tables::TileTable& table = tables::tile_table(dim, t);
  EXPECT_EQ(tables::kContractVersion, table.version);
  EXPECT_EQ(static_cast<std::uint32_t>(dim), table.dim);
  EXPECT_EQ(-1, first_difference(table, t));
}

INSTANTIATE_TEST_SUITE_P(All, CompiledTableTest,
                         testing::Combine(testing::Values(2, 3, 4), testing::ValuesIn(kTriangulations)));

/// An owning copy of a compiled table, for computing digests and injecting faults.
TileTables owning(const tables::TileTable& t, Triangulation triangulation) {
  const std::size_t signatures = std::size_t{1} << (1u << t.dim);
  TileTables table;
  table.dim = static_cast<int>(t.dim);
  table.triangulation = triangulation;
  table.layout = t.element_of == nullptr ? Layout::flat : Layout::by_class;
  table.permutation_stride = t.permutation_stride;
  table.max_simplices = t.max_simplices;
  table.max_tile_vertices = t.max_tile_vertices;
  table.list_of.assign(t.list_of, t.list_of + signatures);
  if (t.element_of != nullptr) {
    table.element_of.assign(t.element_of, t.element_of + signatures);
    table.slot_swaps.assign(t.slot_swaps, t.slot_swaps + signatures);
    table.permutations.assign(t.permutations, t.permutations + std::size_t{t.element_count} * t.permutation_stride);
    table.reverses.assign(t.reverses, t.reverses + t.element_count);
  }
  table.lists.assign(t.lists, t.lists + t.list_count);
  table.simplices.assign(t.simplices, t.simplices + std::size_t{t.simplex_count} * t.dim);
  std::uint32_t masks = 0;
  for (const tables::List& list : table.lists)
    if (list.side_vertices != 0) masks = std::max(masks, list.first_side + list.side_vertices);
  if (masks != 0) table.side_masks.assign(t.side_masks, t.side_masks + masks);
  return table;
}

RegionTables owning(const tables::RegionTable& t) {
  RegionTables table;
  table.dim = static_cast<int>(t.dim);
  table.lists.assign(t.lists, t.lists + (std::size_t{1} << (1u << t.dim)));
  std::size_t simplices = 0, masks = 0;
  for (const tables::RegionList& list : table.lists) {
    simplices = std::max<std::size_t>(simplices, list.first_simplex + list.simplex_count);
    if (list.own_vertices != 0) masks = std::max<std::size_t>(masks, list.first_mask + list.own_vertices);
  }
  table.simplices.assign(t.simplices, t.simplices + simplices * (t.dim + 1));
  if (masks != 0) table.masks.assign(t.masks, t.masks + masks);
  return table;
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A table's digest in the reviewed manifest.
std::string reviewed_digest(const std::string& name) {
  const std::string manifest = text_of(TEGL_SOURCE_DIR "/generated/MANIFEST.json");
  const std::size_t at = manifest.find("fnv1a", manifest.find('"' + name + '"'));
  return manifest.substr(manifest.find(": ", at) + 3, 16);
}

std::string hexadecimal(std::uint64_t number) {
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << number;
  return text.str();
}

/// The digest of every compiled table equals the reviewed one, so a changed entry is detected even if it changes no
/// contour. The previous test shows that the contours equal the builder's.
TEST(Tables, CompiledOnesAreThoseOfTheManifest) {
  if (std::string(TEGL_TABLE_LAYOUT) != "auto") GTEST_SKIP() << "built with tables of another layout";
  for (const int dim : {2, 3, 4})
    for (const Triangulation t : kTriangulations) {
      const std::string name =
          "kTile" + std::to_string(dim) + (t == Triangulation::barycentric ? "Barycentric" : "Compact");
      const auto table = owning(tables::tile_table(dim, t), t);
      EXPECT_EQ(hexadecimal(digest(table)), reviewed_digest(name)) << name;
      for (const Alternative alternative : kAlternatives) {
        const std::string region = "kRegion" + std::to_string(dim - 1) +
                                   (t == Triangulation::barycentric ? "Barycentric" : "Compact") +
                                   (alternative == Alternative::low ? "Low" : "High");
        EXPECT_EQ(hexadecimal(digest(owning(tables::region_table(dim - 1, t, alternative)))), reviewed_digest(region))
            << region;
      }
    }
}

/// Changes every `step`-th entry in turn and expects another digest each time.
template <class Table, class Entries, class Change>
void expect_noticed(Table& table, Entries& entries, const char* what, const Change& change) {
  const std::uint64_t good = digest(table);
  const std::size_t step = std::max<std::size_t>(1, entries.size() / 12);
  for (std::size_t at = 0; at < entries.size(); at += step) {
    const auto before = entries[at];
    change(entries[at]);
    EXPECT_NE(digest(table), good) << what << ", entry " << at;
    entries[at] = before;
  }
  EXPECT_EQ(digest(table), good);
}

TEST(Tables, OneFlippedEntryIsNoticed) {
  const auto flip = [](auto& entry) { entry ^= 1; };
  for (const int dim : {2, 3, 4})
    for (const Triangulation t : kTriangulations) {
      TileTables table = owning(tables::tile_table(dim, t), t);
      expect_noticed(table, table.list_of, "list_of", flip);
      expect_noticed(table, table.element_of, "element_of", flip);
      expect_noticed(table, table.slot_swaps, "slot_swaps", flip);
      expect_noticed(table, table.permutations, "permutations", flip);
      expect_noticed(table, table.reverses, "reverses", flip);
      expect_noticed(table, table.simplices, "simplices", flip);
      expect_noticed(table, table.side_masks, "side_masks", flip);
      expect_noticed(table, table.lists, "first_simplex", [](tables::List& list) { ++list.first_simplex; });
      expect_noticed(table, table.lists, "simplex_count", [](tables::List& list) { ++list.simplex_count; });
      expect_noticed(table, table.lists, "cone_vertices", [](tables::List& list) { ++list.cone_vertices; });
      expect_noticed(table, table.lists, "side_vertices", [](tables::List& list) { ++list.side_vertices; });
      expect_noticed(table, table.lists, "first_side", [](tables::List& list) { ++list.first_side; });
      for (const Alternative alternative : kAlternatives) {
        RegionTables region = owning(tables::region_table(dim - 1, t, alternative));
        expect_noticed(region, region.simplices, "region simplices", flip);
        expect_noticed(region, region.masks, "masks", flip);
        expect_noticed(region, region.lists, "first", [](tables::RegionList& list) { ++list.first_simplex; });
        expect_noticed(region, region.lists, "count", [](tables::RegionList& list) { ++list.simplex_count; });
        expect_noticed(region, region.lists, "own", [](tables::RegionList& list) { ++list.own_vertices; });
        expect_noticed(region, region.lists, "mask", [](tables::RegionList& list) { ++list.first_mask; });
      }
    }
}

/// The decoding test detects the effect of a changed entry on contours.
TEST(Tables, AFlippedSimplexIsADifferentContour) {
  const tables::TileTable& good = tables::tile_table(3, Triangulation::compact);
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
    const TileTables by_class = make_tile_tables(builder, contours, Layout::by_class, tile_classes(builder.tile()));
    EXPECT_LT(by_class.lists.size(), contours.size());
    EXPECT_EQ(-1, first_difference(by_class.view(), Triangulation::barycentric)) << n;
  }
}

TEST(Tables, ACompactTriangulationIsRefusedByClassBecauseItDoesNotMoveWithTheSymmetries) {
  const CubeLattice lattice(3);
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
  std::vector<TileContour> contours;
  for (Signature s = 0; s <= builder.tile().full(); ++s) contours.push_back(builder.build(s));
  EXPECT_ANY_THROW(make_tile_tables(builder, contours, Layout::by_class, tile_classes(builder.tile())));
}

TEST(Manifest, IsWhatTheBuildGenerated) {
  if (std::string(TEGL_TABLE_LAYOUT) != "auto") GTEST_SKIP() << "built with tables of another layout";
  std::string joined;
  for (const char* const name :
       {"manifest2", "manifest3", "manifest4", "builder2_manifest", "builder3_manifest", "builder4_manifest",
        "builder5_manifest", "builder2_edges_manifest", "builder3_edges_manifest", "builder3_barycentric_manifest",
        "builder3_barycentric_edges_manifest", "builder4_edges_manifest", "builder5_edges_manifest", "cells_manifest"})
    joined +=
        fmt::format("{}{}", joined.empty() ? "[\n" : ",\n", text_of(fmt::format("{}/{}.json", TEGL_TABLE_DIR, name)));
  joined += "]\n";
  EXPECT_EQ(text_of(TEGL_SOURCE_DIR "/generated/MANIFEST.json"), joined)
      << "the tables have changed; where that was meant: ninja update_manifest, and say why in the commit";
}

TEST(Emission, IsTheSameTextEveryTime) {
  if (std::string(TEGL_TABLE_LAYOUT) != "auto") GTEST_SKIP() << "built with tables of another layout";
  TableRequest request;
  request.dim = 3;
  request.command = "gen --dim 3";
  const auto first = emit_cpp(make_table_set(request)), second = emit_cpp(make_table_set(request));
  ASSERT_EQ(5u, first.size()) << "two triangulations, regions, all resolutions, variants";
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].name, second[i].name);
    EXPECT_EQ(first[i].text, second[i].text);
    EXPECT_EQ(text_of(std::string(TEGL_TABLE_DIR) + "/" + first[i].name), first[i].text);
  }
}

}  // namespace
}  // namespace tegl::gen
