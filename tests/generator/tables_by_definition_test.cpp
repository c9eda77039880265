// SPDX-License-Identifier: BSD-3-Clause
//
// Every entry of every emitted table against the oracle by definition (definition_oracle.hpp): tiles of two to four
// dimensions in both triangulations, the resolved cube in all its lists, and regions at the border.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <set>
#include <string>

#include "decode.hpp"
#include "definition_faults.hpp"
#include "tegl/generated/tables.hpp"

namespace tegl::gen {
namespace {

using test::boundary_of;
using test::BoundaryPart;
using test::Corners;
using test::corners_of_edge;
using test::fault_of_boundary;
using test::fault_of_separate;
using test::Parts;
using test::Piece;
using test::pieces_of;
using test::VertexSet;

const BoundaryPart::HasCentre kAllLow = [](unsigned, unsigned) { return false; };
const BoundaryPart::HasCentre kAllHigh = [](unsigned, unsigned) { return true; };

std::vector<VertexSet> simplices_of(const tables::TileTable& table, Corners s) {
  std::vector<VertexSet> result;
  for (const LocalSimplex& simplex : decode(table, s).simplices) {
    VertexSet set;
    set.fill(0xff);
    for (std::uint32_t j = 0; j < table.dim; ++j) set[j] = static_cast<std::uint8_t>(simplex[j]);
    result.push_back(set);
  }
  return result;
}

constexpr std::array kTableTriangulations{Triangulation::barycentric, Triangulation::compact};

TEST(TablesByDefinition, EveryEntryOfEveryTileTable) {
  for (const int n : {2, 3, 4}) {
    const Corners full = (Corners{1} << (1u << n)) - 1;
    for (Corners s = 1; s < full; ++s) {
      const Parts parts(n, s, kAllLow);
      for (const Triangulation triangulation : kTableTriangulations) {
        const auto simplices = simplices_of(tables::tile_table(n, triangulation), s);
        ASSERT_EQ(fault_of_separate(parts, simplices), "")
            << n << "D, signature " << s << ", " << triangulation_name(triangulation);
      }
    }
    for (const Corners s : {Corners{0}, full})
      for (const Triangulation triangulation : kTableTriangulations)
        EXPECT_TRUE(simplices_of(tables::tile_table(n, triangulation), s).empty());
  }
}

/// The base and the axes of square q = 2 a + side of the cube.
struct Square {
  unsigned base, axes;
};
Square square_of(unsigned q) { return {(q % 2) << (q / 2), 7u ^ 1u << (q / 2)}; }

std::vector<VertexSet> triangles_of(const tables::ResolvedList& list) {
  std::vector<VertexSet> result;
  for (unsigned t = 0; t < list.triangle_count; ++t) {
    const std::uint8_t* const v = tables::kTile3Resolved.triangles + 3 * (std::size_t{list.first_triangle} + t);
    result.push_back({v[0], v[1], v[2], 0xff});
  }
  return result;
}

/// The contour of a cube whose centre belongs to the other part: each component of `part` is cut off by a copy.
std::string fault_of_cut(const BoundaryPart& part, const Parts& parts, const std::vector<VertexSet>& triangles) {
  std::string fault = fault_of_boundary(parts, pieces_of(boundary_of(triangles, 3), 2));
  if (!fault.empty()) return fault;
  const std::vector<Piece> contour = pieces_of(triangles, 3);
  if (contour.size() != part.components()) return "another number of components than are cut off";
  for (const Piece& piece : contour) {
    auto [a, b] = corners_of_edge(3, piece.vertices[0]);
    if (((parts.high_corners >> a & 1u) != 0) != (&part == &parts.high)) std::swap(a, b);
    if (piece.euler != part.euler(part.of_corner(a))) return "a component unlike the one that it cuts off";
  }
  return "";
}

/// A cone vertex, whose mask has edges only, is the mean of all edge points of its component.
std::string fault_of_masks(const tables::ResolvedList& list) {
  const std::vector<Piece> contour = pieces_of(triangles_of(list), 3);
  for (unsigned j = 0; j < list.own_vertices; ++j) {
    const std::uint32_t mask = tables::kTile3Resolved.masks[list.first_mask + j];
    if ((mask & 255u) != 0) continue;
    std::uint32_t expected = 0;
    for (const Piece& piece : contour)
      if (std::binary_search(piece.vertices.begin(), piece.vertices.end(), static_cast<std::uint8_t>(12 + j)))
        for (const std::uint8_t v : piece.vertices)
          if (v < 12) expected |= std::uint32_t{1} << (8 + v);
    if (mask != expected) return "an own vertex that is not the mean of its component's points";
  }
  return "";
}

TEST(TablesByDefinition, EveryListOfTheResolvedCube) {
  const tables::ResolvedTable& table = tables::kTile3Resolved;
  unsigned entries = 0;
  for (Corners s = 0; s < 256; ++s) {
    const unsigned ambiguous = table.ambiguous_squares[s];
    for (unsigned r = 0; r < 1u << std::popcount(ambiguous); ++r, ++entries) {
      const auto is_high = [&](unsigned base, unsigned axes) {
        unsigned q = 0, bit = 0;
        for (; square_of(q).base != base || square_of(q).axes != axes; ++q) bit += ambiguous >> q & 1u;
        EXPECT_NE(ambiguous >> q & 1u, 0u) << "square " << q << " of " << s;
        return (r >> bit & 1u) != 0;
      };
      const Parts parts(3, s, is_high);
      const tables::ResolvedEntry& entry = table.entries[table.first_entry[s] + r];
      if (s == 0 || s == 255) {
        EXPECT_EQ(entry.separate.triangle_count, 0);
        continue;
      }
      ASSERT_EQ(fault_of_separate(parts, triangles_of(entry.separate)), "") << s << ", resolution " << r;
      EXPECT_EQ(entry.components, pieces_of(triangles_of(entry.separate), 3).size());
      for (const tables::ResolvedList* list : {&entry.separate, &entry.low, &entry.high})
        ASSERT_EQ(fault_of_masks(*list), "") << s << ", resolution " << r;
      ASSERT_EQ(fault_of_cut(parts.high, parts, triangles_of(entry.low)), "") << s << ", resolution " << r << ", low";
      ASSERT_EQ(fault_of_cut(parts.low, parts, triangles_of(entry.high)), "") << s << ", resolution " << r << ", high";
    }
  }
  EXPECT_EQ(entries, 656u);
}

TEST(TablesByDefinition, EveryRegionOfEveryBorderTable) {
  for (const int k : {1, 2, 3})
    for (const Triangulation triangulation : kTableTriangulations)
      for (const Alternative alternative : {Alternative::low, Alternative::high}) {
        const tables::RegionTable& table = tables::region_table(k, triangulation, alternative);
        const auto size = static_cast<unsigned>(k + 1);
        for (Corners s = 0; s < Corners{1} << (1u << k); ++s) {
          std::vector<VertexSet> simplices;
          for (unsigned i = 0; i < table.lists[s].simplex_count; ++i) {
            VertexSet set;
            set.fill(0xff);
            for (unsigned j = 0; j < size; ++j)
              set[j] = table.simplices[(std::size_t{table.lists[s].first_simplex} + i) * size + j];
            simplices.push_back(set);
          }
          std::set<Corners> expected, found;
          const BoundaryPart part(k, s, alternative == Alternative::low ? kAllLow : kAllHigh);
          expected.insert(part.regions_of_cube().begin(), part.regions_of_cube().end());
          for (const Piece& piece : pieces_of(simplices, size)) {
            EXPECT_EQ(piece.euler, 1) << k << "D, signature " << s;
            Corners corners = 0;
            for (const std::uint8_t v : piece.vertices)
              if (v < 1u << k) corners |= Corners{1} << v;
            found.insert(corners);
          }
          ASSERT_EQ(found, expected) << k << "D, signature " << s << ", " << triangulation_name(triangulation) << ", "
                                     << alternative_name(alternative);
        }
      }
}

/// The comparison notices what it is for.
TEST(TablesByDefinition, AWrongEntryIsFound) {
  const auto entry = [](int n, Corners s) { return simplices_of(tables::tile_table(n, Triangulation::compact), s); };
  const auto fault = [](int n, Corners s, const std::vector<VertexSet>& simplices) {
    return fault_of_separate(Parts(n, s, kAllLow), simplices);
  };
  ASSERT_EQ(fault(3, 0b1001, entry(3, 0b1001)), "");
  // The square's other connection.
  EXPECT_EQ(fault_of_separate(Parts(3, 0b1001, kAllHigh), entry(3, 0b1001)), "another number of separators");
  // Another signature with the same number of triangles.
  EXPECT_EQ(fault(3, 0b0011, entry(3, 0b0101)), "a point on an edge that is not critical");
  // A triangle is missing: the quadrilateral's curve is shorter.
  auto missing = entry(3, 0b1111);
  missing.pop_back();
  EXPECT_EQ(fault(3, 0b1111, missing), "critical edges without a point");
  // A tube in place of two discs: 0 and 7 are opposite corners.
  const auto low = triangles_of(tables::kTile3Resolved.entries[tables::kTile3Resolved.first_entry[129]].high);
  EXPECT_EQ(fault(3, 129, low), "another number of components");
  // A torus that is filled as a sphere would be.
  auto cone = std::vector<VertexSet>();
  for (VertexSet facet : boundary_of(entry(4, 1910), 4)) {
    facet[3] = 200;
    cone.push_back(facet);
  }
  EXPECT_EQ(fault(4, 1910, cone), "a component with another Euler characteristic");
}

}  // namespace
}  // namespace tegl::gen
