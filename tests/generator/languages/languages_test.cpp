// SPDX-License-Identifier: BSD-3-Clause
//
// Tables in languages other than C++: the emitted text is compiled (or parsed), run, and compared with the runtime's
// tables for every signature.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../decode.hpp"
#include "base/lattice.hpp"
#include "lookups.hpp"
#include "tables/emit.hpp"
#include "tables/table_set.hpp"
#include "tegl/generated/tables.hpp"
#include "tile/extract_tables.hpp"

namespace tegl {
namespace {

using gen::Decoded;
using test::Lookups;

constexpr std::array kTriangulations{Triangulation::barycentric, Triangulation::compact};

std::string table_text(const std::string& name) {
  std::ifstream in(std::string(TEGL_TABLE_DIR) + "/" + name, std::ios::binary);
  EXPECT_TRUE(in) << name;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The contents of the file for a shader's storage buffer.
std::vector<std::uint32_t> words_of(Triangulation triangulation) {
  const std::string bytes = table_text(std::string("tile4_") + gen::triangulation_name(triangulation) + ".u32");
  std::vector<std::uint32_t> words(bytes.size() / 4, 0);
  for (std::size_t i = 0; i < 4 * words.size(); ++i)
    words[i / 4] |= std::uint32_t{static_cast<std::uint8_t>(bytes[i])} << (8 * (i % 4));
  EXPECT_EQ(bytes.size(), 4 * words.size());
  return words;
}

/// A signature's contour from the emitted functions.
Decoded look_up(const Lookups& table, int dim, std::uint32_t signature) {
  Decoded result;
  result.cones = table.cone_vertices(signature);
  for (std::uint32_t i = 0; i < table.simplex_count(signature); ++i) {
    gen::LocalSimplex simplex{};
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(dim); ++j)
      simplex[j] = static_cast<std::uint8_t>(table.vertex(signature, i, j));
    result.simplices.push_back(simplex);
  }
  const std::uint32_t sides = table.side_vertices == nullptr ? 0 : table.side_vertices(signature);
  for (std::uint32_t k = 0; k < sides; ++k)
    result.masks.push_back(table.side_mask(signature, k, 0) | std::uint64_t{table.side_mask(signature, k, 1)} << 32);
  return result;
}

/// The first signature where the emitted functions and the compiled C++ table differ, or -1.
long first_difference(const Lookups& emitted, const tables::TileTable& table) {
  const int dim = static_cast<int>(table.dim);
  for (std::uint32_t s = 0; s < 1u << (1u << dim); ++s)
    if (look_up(emitted, dim, s) != gen::decode(table, s)) return s;
  return -1;
}

class PackedTable : public testing::TestWithParam<std::tuple<std::string, int, Triangulation>> {
 protected:
  Lookups lookups() {
    const auto& [language, dim, triangulation] = GetParam();
    if (dim == 4) words_ = words_of(triangulation);
    if (language == "cuda") return test::cuda_lookups(dim, triangulation);
    return language == "glsl" ? test::glsl_lookups(dim, triangulation, words_.data())
                              : test::wgsl_lookups(dim, triangulation, words_.data());
  }
  [[nodiscard]] int dim() const { return std::get<1>(GetParam()); }
  [[nodiscard]] const tables::TileTable& compiled() const { return tables::tile_table(dim(), std::get<2>(GetParam())); }

  std::vector<std::uint32_t> words_;
};

TEST_P(PackedTable, GivesTheContourOfEverySignatureThatTheRuntimeReads) {
  EXPECT_EQ(-1, first_difference(lookups(), compiled()));
}

TEST_P(PackedTable, NamesTheEdgesAndNumbersOfItsTile) {
  const Lookups table = lookups();
  const gen::CubeLattice lattice(dim());
  const auto& edges = lattice.tile(dim()).edges;
  ASSERT_EQ(edges.size(), table.edges);
  for (std::uint32_t e = 0; e < edges.size(); ++e)
    for (const std::uint32_t end : {0u, 1u}) {
      EXPECT_EQ(edges[e][end], table.edge_corner(e, end)) << e;
    }
  EXPECT_EQ(1u << dim(), table.corners);
  EXPECT_EQ(tables::first_tile_vertex(static_cast<std::uint32_t>(dim())), table.first_tile_vertex);
  EXPECT_EQ(compiled().max_simplices, table.max_simplices);
  EXPECT_EQ(compiled().max_tile_vertices, table.max_tile_vertices);
  if (dim() == 4) {
    EXPECT_EQ(words_.size(), table.words);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PackedTable,
                         testing::Combine(testing::Values(std::string("glsl"), std::string("wgsl"),
                                                          std::string("cuda")),
                                          testing::Values(2, 3, 4), testing::ValuesIn(kTriangulations)));

TEST(PackedWords, OneFlippedWordIsNoticed) {
  for (const Triangulation triangulation : kTriangulations) {
    std::vector<std::uint32_t> words = words_of(triangulation);
    const std::uint32_t lists = words.at(4), simplices = words.at(5);
    std::vector<std::size_t> places{words.at(12) + 3 * (lists / 2), words.at(12) + 3 * (lists / 3) + 1};
    if (words.at(6) != 0) places.push_back(words.at(11) + 12345);  // a signature's list, element and swaps
    for (std::uint32_t k = 0; k < 5; ++k) places.push_back(words.at(13) + simplices / 5 * k);
    for (const std::size_t at : places) {
      words.at(at) ^= 1u;
      EXPECT_NE(-1, first_difference(test::glsl_lookups(4, triangulation, words.data()),
                                     tables::tile_table(4, triangulation)))
          << "word " << at;
      words.at(at) ^= 1u;
    }
  }
}

TEST(PackedWords, BeginWithWhatTheyAre) {
  const auto words = words_of(Triangulation::barycentric);
  ASSERT_GT(words.size(), 18u);
  EXPECT_EQ(0x4c474554u, words[0]);
  EXPECT_EQ(tables::kContractVersion, words[1]);
  EXPECT_EQ(4u, words[2]);
  EXPECT_EQ(0u, words[3]);
  EXPECT_EQ(1u, words_of(Triangulation::compact)[3]);
}

/// Expects the runtime's table reader and the tests' reader to agree.
template <int N>
void expect_same_reading(const tables::TileTable& table) {
  for (std::uint32_t s = 0; s < 1u << (1u << N); ++s) {
    const detail::SimplexList<N> list(table, s);
    const Decoded decoded = gen::decode(table, s);
    ASSERT_EQ(decoded.simplices.size(), list.size()) << s;
    for (unsigned q = 0; q < list.size(); ++q)
      for (unsigned j = 0; j < N; ++j) {
        const unsigned from = list.reversed() && j + 2 >= N ? 2 * N - 3 - j : j;
        ASSERT_EQ(decoded.simplices[q][j], list.mapped(list.stored(q, from))) << s;
      }
  }
}

TEST(RuntimeReader, FindsWhatTheContractSays) {
  for (const Triangulation triangulation : kTriangulations) {
    expect_same_reading<2>(tables::tile_table(2, triangulation));
    expect_same_reading<3>(tables::tile_table(3, triangulation));
    expect_same_reading<4>(tables::tile_table(4, triangulation));
  }
}

/// The contract's structs, read back from a JSON file.
struct FromJson {
  explicit FromJson(const nlohmann::json& file)
      : list_of(file.at("list_of")),
        element_of(file.at("element_of")),
        slot_swaps(file.at("slot_swaps")),
        permutations(file.at("permutations")),
        reverses(file.at("reverses")),
        simplices(file.at("simplices")),
        side_masks(file.at("side_masks")) {
    for (const auto& row : file.at("lists").at("rows"))
      lists.push_back({row.at(0), row.at(1), row.at(2), row.at(3), row.at(4)});
    const auto or_null = [](const auto& v) { return v.empty() ? nullptr : v.data(); };
    table = {file.at("contract_version"),
             file.at("dim"),
             static_cast<std::uint32_t>(lists.size()),
             static_cast<std::uint32_t>(simplices.size() / file.at("dim").get<std::size_t>()),
             static_cast<std::uint32_t>(reverses.size()),
             file.at("permutation_stride"),
             file.at("max_simplices"),
             file.at("max_tile_vertices"),
             list_of.data(),
             or_null(element_of),
             or_null(slot_swaps),
             or_null(permutations),
             or_null(reverses),
             lists.data(),
             simplices.data(),
             side_masks.data()};
  }
  FromJson(const FromJson&) = delete;
  FromJson& operator=(const FromJson&) = delete;

  std::vector<std::uint16_t> list_of, element_of;
  std::vector<std::uint8_t> slot_swaps, permutations, reverses;
  std::vector<tables::List> lists;
  std::vector<std::uint8_t> simplices;
  std::vector<std::uint64_t> side_masks;
  tables::TileTable table{};
};

TEST(JsonTables, HoldTheContourOfEverySignature) {
  for (const int dim : {2, 3, 4})
    for (const Triangulation t : kTriangulations) {
      const std::string name = gen::triangulation_name(t);
      const auto file = nlohmann::json::parse(table_text("tile" + std::to_string(dim) + "_" + name + ".json"));
      EXPECT_EQ(file.at("kind"), "tile");
      EXPECT_EQ(file.at("triangulation"), name);
      const FromJson read(file);
      EXPECT_EQ(tables::kContractVersion, read.table.version);
      EXPECT_EQ(tables::tile_table(dim, t).max_simplices, read.table.max_simplices);
      long different = -1;
      for (std::uint32_t s = 0; different < 0 && s < 1u << (1u << dim); ++s)
        if (gen::decode(read.table, s) != gen::decode(tables::tile_table(dim, t), s)) different = s;
      EXPECT_EQ(-1, different) << dim << " " << name;
    }
}

TEST(JsonTables, HoldTheRegions) {
  for (const int k : {1, 2, 3})
    for (const Triangulation t : kTriangulations)
      for (const tile::Alternative a : {tile::Alternative::low, tile::Alternative::high}) {
        const std::string name =
            "region" + std::to_string(k) + "_" + gen::triangulation_name(t) + "_" + gen::alternative_name(a) + ".json";
        const auto file = nlohmann::json::parse(table_text(name));
        const tables::RegionTable& table = tables::region_table(k, t, a);
        const std::size_t count = std::size_t{1} << (1u << k);
        ASSERT_EQ(count, file.at("lists").at("rows").size()) << name;
        EXPECT_EQ(table.max_own_vertices, file.at("max_own_vertices"));
        const std::vector<std::uint8_t> simplices = file.at("simplices");
        const std::vector<std::uint32_t> masks = file.at("masks");
        EXPECT_TRUE(std::equal(simplices.begin(), simplices.end(), table.simplices)) << name;
        EXPECT_TRUE(std::equal(masks.begin(), masks.end(), table.masks)) << name;
        std::size_t simplices_in_lists = 0;
        for (std::size_t s = 0; s < count; ++s) {
          const auto& row = file.at("lists").at("rows").at(s);
          const tables::RegionList& list = table.lists[s];
          EXPECT_EQ(row, (nlohmann::json{list.first_simplex, list.simplex_count, list.own_vertices, list.first_mask}));
          simplices_in_lists += list.simplex_count;
        }
        EXPECT_EQ(simplices.size(), simplices_in_lists * (static_cast<std::size_t>(k) + 1)) << name;
      }
}

TEST(Emission, IsTheSameTextEveryTimeInEveryLanguage) {
  if (std::string(TEGL_TABLE_LAYOUT) != "auto") GTEST_SKIP() << "built with tables of another layout";
  gen::TableRequest request;
  request.dim = 3;
  request.command = "gen --dim 3";
  const gen::TableSet set = make_table_set(request);
  for (const gen::Language language : gen::kLanguages) {
    const auto files = emit(set, language);
    EXPECT_FALSE(files.empty());
    for (const gen::EmittedFile& file : files) EXPECT_EQ(table_text(file.name), file.text) << file.name;
  }
}

/// One list of an entry as numbers: triangle vertices, then masks of own vertices.
std::vector<std::uint32_t> resolved_list(const tables::ResolvedList& list) {
  const tables::ResolvedTable& table = tables::kTile3Resolved;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < list.triangle_count * 3u; ++i)
    numbers.push_back(table.triangles[3u * list.first_triangle + i]);
  for (std::uint32_t i = 0; i < list.own_vertices; ++i) numbers.push_back(table.masks[list.first_mask + i]);
  return numbers;
}

const tables::ResolvedList& list_of(const tables::ResolvedEntry& entry, std::uint32_t centre) {
  return centre == 0 ? entry.separate : centre == 1 ? entry.low : entry.high;
}

TEST(ResolvedTable, EveryLanguageSaysWhatTheCompiledTableSays) {
  const tables::ResolvedTable& table = tables::kTile3Resolved;
  for (const test::ResolvedLookups& emitted :
       {test::glsl_resolved_lookups(), test::wgsl_resolved_lookups(), test::cuda_resolved_lookups()})
    for (std::uint32_t s = 0; s < 256; ++s) {
      const std::uint32_t ambiguous = table.ambiguous_squares[s];
      ASSERT_EQ(emitted.ambiguous_squares(s), ambiguous);
      std::uint32_t high = 0, number = table.first_entry[s];
      do {
        const std::uint32_t entry = emitted.entry(s, high);
        ASSERT_EQ(entry, number++);
        for (std::uint32_t centre = 0; centre < 3; ++centre) {
          std::vector<std::uint32_t> numbers;
          for (std::uint32_t t = 0; t < emitted.triangle_count(entry, centre); ++t)
            for (std::uint32_t c = 0; c < 3; ++c) numbers.push_back(emitted.vertex(entry, centre, t, c));
          for (std::uint32_t k = 0; k < emitted.own_vertices(entry, centre); ++k)
            numbers.push_back(emitted.own_mask(entry, centre, k));
          ASSERT_EQ(numbers, resolved_list(list_of(table.entries[entry], centre))) << s << " " << high;
        }
        high = (high - ambiguous) & ambiguous;
      } while (high != 0);
    }
}

TEST(ResolvedTable, JsonHoldsTheCompiledTable) {
  const tables::ResolvedTable& table = tables::kTile3Resolved;
  const auto json = nlohmann::json::parse(table_text("tile3_resolved.json"));
  const auto& rows = json.at("entries").at("rows");
  ASSERT_EQ(rows.size(), table.entry_count);
  ASSERT_EQ(json.at("squares").size(), 6u);
  for (std::uint32_t s = 0; s < 256; ++s) {
    ASSERT_EQ(json.at("first_entry").at(s), table.first_entry[s]);
    ASSERT_EQ(json.at("ambiguous_squares").at(s), table.ambiguous_squares[s]);
  }
  for (std::uint32_t e = 0; e < table.entry_count; ++e) {
    ASSERT_EQ(rows.at(e).at(0), table.entries[e].components);
    for (std::uint32_t centre = 0; centre < 3; ++centre) {
      std::vector<std::uint32_t> row;
      for (std::size_t i = 0; i < 4; ++i) row.push_back(rows.at(e).at(1 + 4 * centre + i));
      std::vector<std::uint32_t> numbers;
      for (std::uint32_t i = 0; i < 3 * row[1]; ++i) numbers.push_back(json.at("triangles").at(3 * row[0] + i));
      for (std::uint32_t i = 0; i < row[2]; ++i) numbers.push_back(json.at("masks").at(row[3] + i));
      ASSERT_EQ(numbers, resolved_list(list_of(table.entries[e], centre))) << "entry " << e;
    }
  }
}

}  // namespace
}  // namespace tegl
