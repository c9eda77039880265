// SPDX-License-Identifier: BSD-3-Clause
//
// The complete table of the cube as compiled: every entry is certified again, and its surfaces are compared with those
// of the builder of single tiles.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "base/lattice.hpp"
#include "cubes/resolved_cube.hpp"
#include "filling/resolutions.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/certificate.hpp"

namespace tegl::gen {
namespace {

using tables::kTile3Resolved;
using tile::Choice;

std::vector<std::array<std::uint8_t, 3>> triangles_of(const tables::ResolvedList& list) {
  std::vector<std::array<std::uint8_t, 3>> result(list.triangle_count);
  for (std::size_t t = 0; t < result.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) result[t][i] = kTile3Resolved.triangles[3 * (list.first_triangle + t) + i];
  return result;
}

/// The number of connected surfaces and the sum of their Euler characteristics.
std::pair<int, int> topology(const std::vector<std::array<std::uint8_t, 3>>& triangles) {
  std::set<std::pair<int, int>> edges;
  std::map<int, int> part;
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      edges.insert(std::minmax<int>(t[i], t[(i + 1) % 3]));
      part[t[i]] = t[i];
    }
  for (bool moved = true; moved;) {
    moved = false;
    for (const auto& [a, b] : edges)
      if (part[a] != part[b]) part[a] = part[b] = std::min(part[a], part[b]), moved = true;
  }
  std::set<int> parts;
  for (const auto& [v, p] : part) parts.insert(p);
  return {static_cast<int>(parts.size()),
          static_cast<int>(part.size()) - static_cast<int>(edges.size()) + static_cast<int>(triangles.size())};
}

/// Calls `visit` for every entry with signature, set of high squares, and entry.
template <class Visit>
void for_each_entry(const Visit& visit) {
  for (std::uint32_t s = 0; s < 256; ++s) {
    const unsigned ambiguous = kTile3Resolved.ambiguous_squares[s];
    unsigned high = 0;
    std::uint32_t number = kTile3Resolved.first_entry[s];
    do {
      visit(s, high, kTile3Resolved.entries[number++]);
      high = (high - ambiguous) & ambiguous;
    } while (high != 0);
  }
}

TEST(ResolvedCube, Has656EntriesEachReachedOnce) {
  std::uint32_t entries = 0;
  for_each_entry([&](std::uint32_t, unsigned, const tables::ResolvedEntry& entry) {
    EXPECT_EQ(&entry, kTile3Resolved.entries + entries);
    ++entries;
  });
  EXPECT_EQ(entries, 656u);
  EXPECT_EQ(kTile3Resolved.entry_count, 656u);
}

TEST(ResolvedCube, EveryEntryIsCertifiedAndIsTheSurfaceThatTheBuilderFinds) {
  const tile::FaceLattice lattice = tile::FaceLattice::cube(3);
  const CubeLattice tiles(3);
  tile::FacetBuilder builder(lattice);
  tile::Certifier certifier;
  std::map<tile::Signature, std::uint32_t> face_of;
  for (std::uint32_t f = 0; f < lattice.faces().size(); ++f) face_of[lattice.faces()[f].corners] = f;
  const Tile& cube = tiles.tile(3);
  int tunnels = 0;
  for_each_entry([&](std::uint32_t s, unsigned high, const tables::ResolvedEntry& entry) {
    std::vector<Choice> choices(lattice.faces().size(), Choice::separate);
    for (std::size_t q = 0; q < 6; ++q) {
      tile::Signature corners = 0;
      for (const std::uint8_t c : cube.faces[q].corner) corners |= tile::Signature{1} << c;
      choices[face_of.at(corners)] = ((high >> q) & 1u) != 0 ? Choice::high : Choice::low;
    }
    for (const Choice centre : {Choice::separate, Choice::low, Choice::high}) {
      choices.back() = centre;
      tile::TileFacets tile = builder.build(s, {choices, tile::Alternative::low});
      const tables::ResolvedList& list = centre == Choice::separate ? entry.separate
                                         : centre == Choice::low    ? entry.low
                                                                    : entry.high;
      const auto triangles = triangles_of(list);
      const auto [parts, euler] = topology(triangles);
      std::vector<std::array<std::uint8_t, 3>> built;
      std::map<tile::VertexId, std::uint8_t> number;
      for (const tile::Facet& facet : tile.facets)
        for (const tile::Simplex& t : facet.simplices) {
          auto& row = built.emplace_back();
          for (std::size_t i = 0; i < 3; ++i)
            row[i] = number.try_emplace(t[i], static_cast<std::uint8_t>(number.size())).first->second;
        }
      ASSERT_EQ((std::pair{parts, euler}), topology(built)) << s << " " << high;
      ASSERT_EQ(entry.components, tile.sigma_euler.size());
      tunnels += parts < entry.components ? 1 : 0;
      // Replaces the builder's triangles by the table's.
      std::map<std::uint8_t, tile::VertexId> id;
      for (tile::VertexId v = 0; v < tile.vertices.size(); ++v)
        for (std::uint8_t e = 0; e < cube.edge_count() && tile.vertices[v].kind == tile::VertexKind::edge; ++e)
          if (lattice.faces()[tile.vertices[v].face].corners ==
              (tile::Signature{1} << cube.edges[e][0] | tile::Signature{1} << cube.edges[e][1]))
            id[e] = v;
      for (std::uint8_t k = 0; k < list.own_vertices; ++k) {
        id[static_cast<std::uint8_t>(12 + k)] = static_cast<tile::VertexId>(tile.vertices.size());
        tile.vertices.push_back({tile::VertexKind::side, lattice.tile(), 100u + k, tile::kNoVertex, {}});
      }
      tile.facets.assign(1, {});
      for (const auto& t : triangles) {
        tile::Simplex simplex = tile::kNoSimplex;
        for (std::size_t i = 0; i < 3; ++i) simplex[i] = id.at(t[i]);
        tile.facets[0].simplices.push_back(simplex);
      }
      ASSERT_EQ(certifier.certify(lattice, tile), tile::Fault::none) << s << " " << high;
    }
  });
  // 308 entries with a star of two, three or four polygons are joined by one sign; 8 with a chain of three by both.
  EXPECT_EQ(tunnels, 308 + 2 * 8);
}

/// Triangles as a set, each from its smallest vertex on.
std::set<std::array<std::uint8_t, 3>> as_set(const std::uint8_t* vertices, std::size_t count, bool reversed) {
  std::set<std::array<std::uint8_t, 3>> result;
  for (std::size_t i = 0; i < count; ++i, vertices += 3) {
    std::array<std::uint8_t, 3> t = {vertices[0], vertices[reversed ? 2 : 1], vertices[reversed ? 1 : 2]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    result.insert(t);
  }
  return result;
}

TEST(ResolvedCube, TheComplementWithInvertedSquaresHasTheReversedTriangles) {
  // of lists without own vertices: those of single polygons
  const auto list_of = [&](std::uint32_t s, unsigned high) -> const tables::ResolvedList& {
    std::size_t entry = kTile3Resolved.first_entry[s];
    for (unsigned at = 0; at != high;
         at = (at - kTile3Resolved.ambiguous_squares[s]) & kTile3Resolved.ambiguous_squares[s])
      ++entry;
    return kTile3Resolved.entries[entry].separate;
  };
  std::size_t compared = 0, same = 0;
  for_each_entry([&](std::uint32_t s, unsigned high, const tables::ResolvedEntry& entry) {
    const tables::ResolvedList& list = entry.separate;
    const tables::ResolvedList& other = list_of(~s & 255u, kTile3Resolved.ambiguous_squares[s] & ~high);
    if (list.own_vertices != 0 || other.own_vertices != 0) return;
    ++compared;
    const auto triangles_of = [](const tables::ResolvedList& of, bool reversed) {
      return as_set(kTile3Resolved.triangles + 3 * std::size_t{of.first_triangle}, of.triangle_count, reversed);
    };
    same += triangles_of(list, false) == triangles_of(other, true) ? 1 : 0;
  });
  EXPECT_EQ(compared, 504u);
  EXPECT_EQ(same, compared);
}

TEST(ResolvedCube, OwnVerticesAreMeansOfEdgesOrCopiesOfCorners) {
  std::uint32_t copies = 0;
  for_each_entry([&](std::uint32_t s, unsigned, const tables::ResolvedEntry& entry) {
    for (const tables::ResolvedList& list : {entry.separate, entry.low, entry.high})
      for (std::uint32_t k = 0; k < list.own_vertices; ++k) {
        const std::uint32_t mask = kTile3Resolved.masks[list.first_mask + k];
        const std::uint32_t corners = mask & 0xffu, edges = mask >> 8;
        EXPECT_NE(mask, 0u);
        EXPECT_TRUE(corners == 0 || edges == 0);
        copies += corners != 0 ? 1 : 0;
        for (std::uint32_t e = 0; e < 12; ++e) {
          if (((edges >> e) & 1u) == 0) continue;
          const CubeLattice tiles(3);
          const auto& ends = tiles.tile(3).edges[e];
          EXPECT_NE((s >> ends[0]) & 1u, (s >> ends[1]) & 1u) << "a point on an edge that is not critical";
        }
      }
  });
  EXPECT_GT(copies, 0u);
}

TEST(ResolvedCube, TheCompiledTableIsTheOneThatWasReviewed) {
  std::ifstream in(TEGL_SOURCE_DIR "/generated/MANIFEST.json");
  const std::string manifest{std::istreambuf_iterator<char>(in), {}};
  const std::size_t at = manifest.find("fnv1a", manifest.find("kTile3Resolved"));
  ASSERT_NE(at, std::string::npos);
  ResolvedCube table;
  table.first_entry.assign(kTile3Resolved.first_entry, kTile3Resolved.first_entry + 256);
  table.ambiguous.assign(kTile3Resolved.ambiguous_squares, kTile3Resolved.ambiguous_squares + 256);
  table.entries.assign(kTile3Resolved.entries, kTile3Resolved.entries + kTile3Resolved.entry_count);
  std::size_t triangles = 0, masks = 0;
  for (const tables::ResolvedEntry& e : table.entries)
    for (const tables::ResolvedList& l : {e.separate, e.low, e.high}) {
      triangles = std::max<std::size_t>(triangles, l.first_triangle + l.triangle_count);
      masks = std::max<std::size_t>(masks, l.first_mask + l.own_vertices);
    }
  table.triangles.assign(kTile3Resolved.triangles, kTile3Resolved.triangles + 3 * triangles);
  table.masks.assign(kTile3Resolved.masks, kTile3Resolved.masks + masks);
  EXPECT_EQ(fmt::format("{:016x}", digest(table)), manifest.substr(at + 9, 16));
  // Changing one entry changes the digest.
  table.triangles[1000] ^= 1u;
  EXPECT_NE(fmt::format("{:016x}", digest(table)), manifest.substr(at + 9, 16));
}

}  // namespace
}  // namespace tegl::gen
