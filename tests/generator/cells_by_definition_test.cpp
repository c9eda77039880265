// SPDX-License-Identifier: BSD-3-Clause
//
// Every entry of the emitted tables of mesh cells, and resolved contours of these cells, against the oracle by
// definition (definition_faults.hpp). The faces of a cell are found from the coordinates of its corners: no face
// lattice of the generator is used.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/determinant.hpp"
#include "base/tile_contour.hpp"
#include "cells/cell.hpp"
#include "definition_faults.hpp"
#include "filling/resolutions.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::gen {
namespace {

using tables::CellShape;
using tables::CellTable;
using test::BoundaryPart;
using test::Corners;
using test::Parts;
using test::PolytopeFace;
using test::VertexSet;

/// The corners in the hyperplane through `n` corners if all others are on one side of it, else none.
Corners supported(const CellTable& table, const std::vector<std::uint32_t>& through) {
  const std::uint32_t n = table.dim;
  std::array<std::array<double, 4>, 4> m{};
  const auto difference = [&](std::uint32_t v, std::uint32_t i) {
    return static_cast<double>(table.corners[v * n + i] - table.corners[through[0] * n + i]);
  };
  Corners in = 0, above = 0, below = 0;
  for (std::uint32_t v = 0; v < table.corner_count; ++v) {
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t r = 1; r < n; ++r) m[r - 1][i] = difference(through[r], i);
      m[n - 1][i] = difference(v, i);
    }
    const double side = determinant(m, static_cast<int>(n));
    (std::abs(side) < 0.5 ? in : side > 0 ? above : below) |= Corners{1} << v;
  }
  return (above == 0) == (below == 0) ? 0 : in;  // both empty: the corners span no hyperplane
}

/// All faces: intersections of those in supporting hyperplanes. The dimension is the length of a chain of faces.
std::vector<PolytopeFace> faces_of(const CellTable& table) {
  const Corners all = (Corners{1} << table.corner_count) - 1;
  std::set<Corners> facets, sets{all};
  for (Corners chosen = 1; chosen <= all; ++chosen) {
    if (static_cast<std::uint32_t>(std::popcount(chosen)) != table.dim) continue;
    std::vector<std::uint32_t> through;
    for (std::uint32_t v = 0; v < table.corner_count; ++v)
      if ((chosen >> v & 1u) != 0) through.push_back(v);
    if (const Corners facet = supported(table, through); facet != 0) facets.insert(facet);
  }
  for (std::vector<Corners> last{all}; !last.empty();) {
    std::vector<Corners> next;
    for (const Corners set : last)
      for (const Corners facet : facets)
        if ((set & facet) != 0 && sets.insert(set & facet).second) next.push_back(set & facet);
    last = std::move(next);
  }
  std::vector<Corners> sorted(sets.begin(), sets.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](Corners a, Corners b) { return std::popcount(a) < std::popcount(b); });
  std::vector<PolytopeFace> faces;
  for (const Corners corners : sorted) {
    int dim = 0;
    for (const PolytopeFace& face : faces)
      if ((face.corners & ~corners) == 0) dim = std::max(dim, face.dim + 1);
    faces.push_back({dim, corners});
  }
  std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.dim < b.dim; });
  for (PolytopeFace& face : faces)
    for (std::size_t other = 0; other < faces.size(); ++other) {
      if (faces[other].corners == face.corners || (faces[other].corners & ~face.corners) != 0) continue;
      face.below.push_back(other);
      if (faces[other].dim + 1 == face.dim) face.facets.push_back(other);
    }
  return faces;
}

std::vector<std::array<unsigned, 2>> edges_of(const CellTable& table) {
  std::vector<std::array<unsigned, 2>> edges;
  for (std::uint32_t e = 0; e < table.edge_count; ++e) edges.push_back({table.edges[2 * e], table.edges[2 * e + 1]});
  return edges;
}

/// The simplices of a signature in a table; added vertices keep the list's numbers.
std::vector<VertexSet> vertex_sets_of(const CellTable& table, Corners s) {
  const tables::CellList& list = table.lists[table.list_of[s]];
  const std::uint8_t* const edge_image =
      table.element_of == nullptr
          ? nullptr
          : table.permutations + table.corner_count + std::size_t{table.element_of[s]} * table.permutation_stride;
  std::vector<VertexSet> result;
  for (std::uint32_t i = 0; i < list.simplex_count; ++i) {
    VertexSet set;
    set.fill(0xff);
    for (std::uint32_t k = 0; k < table.dim; ++k) {
      const std::uint8_t v = table.simplices[(std::size_t{list.first_simplex} + i) * table.dim + k];
      set[k] = edge_image != nullptr && v < table.edge_count ? edge_image[v] : v;
    }
    result.push_back(set);
  }
  return result;
}

const BoundaryPart::HasCentreOf kAllLow = [](const PolytopeFace&) { return false; };

TEST(CellsByDefinition, FacesFromCoordinatesAreThoseOfTheLattice) {
  const std::vector<Cell> cells = mesh_cells();
  for (unsigned shape = 0; shape < tables::kCellShapes; ++shape) {
    std::set<std::pair<int, Corners>> expected, found;
    for (const auto& face : faces_of(tables::cell_table(static_cast<CellShape>(shape), Triangulation::barycentric)))
      expected.emplace(face.dim, face.corners);
    for (const tile::Face& face : cells[shape].lattice.faces())
      found.emplace(face.dim, static_cast<Corners>(face.corners));
    EXPECT_EQ(found, expected) << cells[shape].name;
  }
}

TEST(CellsByDefinition, EveryEntryOfEveryCellTable) {
  for (unsigned shape = 0; shape < tables::kCellShapes; ++shape)
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
      const CellTable& table = tables::cell_table(static_cast<CellShape>(shape), t);
      if (table.dim == 4 && t == Triangulation::compact) continue;  // the same table
      const std::vector<PolytopeFace> faces = faces_of(table);
      const auto edges = edges_of(table);
      const Corners full = faces.back().corners;
      EXPECT_TRUE(vertex_sets_of(table, 0).empty() && vertex_sets_of(table, full).empty()) << shape;
      const Corners step = table.corner_count > 12 ? 29 : 1;  // the hexahedron over time is the table of the 4-cube
      for (Corners s = 1; s < full; s += step)
        ASSERT_EQ(fault_of_separate(Parts(faces, edges, s, kAllLow), vertex_sets_of(table, s)), "")
            << "shape " << shape << ", signature " << s << ", " << triangulation_name(t);
    }
}

/// The contour of a tile by edges and, from `edges` on, other vertices.
std::vector<VertexSet> vertex_sets_of(const Cell& cell, const tile::TileFacets& built) {
  std::map<tile::VertexId, std::uint8_t> number;
  std::vector<VertexSet> result;
  auto next = static_cast<std::uint8_t>(cell.tile.edge_count());
  for (const tile::Facet& facet : built.facets)
    for (const tile::Simplex& simplex : facet.simplices) {
      VertexSet set;
      set.fill(0xff);
      for (std::size_t k = 0; k < static_cast<std::size_t>(cell.tile.dim); ++k) {
        const auto [at, is_new] = number.emplace(simplex[k], next);
        const tile::Vertex& vertex = built.vertices[simplex[k]];
        if (is_new && vertex.kind == tile::VertexKind::edge) {
          const Signature ends = cell.lattice.faces()[vertex.face].corners;
          at->second = cell.tile.edge_between(static_cast<std::uint32_t>(std::countr_zero(ends)),
                                              63u - static_cast<std::uint32_t>(std::countl_zero(ends)));
        } else if (is_new) {
          ++next;
        }
        set[k] = at->second;
      }
      result.push_back(set);
    }
  return result;
}

/// Both alternatives; every pair of a signature and a resolution in 2D and 3D, in 4D those of every 13th signature.
TEST(CellsByDefinition, EveryResolutionOfAmbiguousFaces) {
  const std::vector<Cell> cells = mesh_cells();
  std::map<std::string, unsigned> pairs;
  for (unsigned shape = 0; shape < tables::kCellShapes; ++shape) {
    const Cell& cell = cells[shape];
    if (cell.tile.corner_count() > 12) continue;  // the 4-cube
    const CellTable& table = tables::cell_table(static_cast<CellShape>(shape), Triangulation::barycentric);
    const std::vector<PolytopeFace> faces = faces_of(table);
    const auto edges = edges_of(table);
    tile::FacetBuilder builder(cell.lattice);
    for (Signature s = 1; s<cell.tile.full(); s += cell.tile.corner_count()> 8 ? 13 : 1) {
      const std::vector<std::uint32_t> polygons = ambiguous_polygons(cell.lattice, s);
      for (std::uint32_t r = 0; r < 1u << polygons.size(); ++r) {
        std::vector<tile::Choice> choices(cell.lattice.faces().size(), tile::Choice::separate);
        std::set<Corners> high;
        for (std::size_t i = 0; i < polygons.size(); ++i) {
          choices[polygons[i]] = (r >> i & 1u) != 0 ? tile::Choice::high : tile::Choice::low;
          if ((r >> i & 1u) != 0) high.insert(static_cast<Corners>(cell.lattice.faces()[polygons[i]].corners));
        }
        const Parts parts(faces, edges, static_cast<Corners>(s),
                          [&](const PolytopeFace& polygon) { return high.count(polygon.corners) != 0; });
        ++pairs[cell.name];
        for (const tile::Alternative alternative : {tile::Alternative::low, tile::Alternative::high})
          ASSERT_EQ(fault_of_separate(parts, vertex_sets_of(cell, builder.build(s, {choices, alternative}))), "")
              << cell.name << ", signature " << s << ", resolution " << r;
      }
    }
  }
  EXPECT_EQ(pairs.at("wedge"), 92u);  // 94 less those of the signatures 0 and 63
  EXPECT_EQ(pairs.at("pyramid"), 34u);
  EXPECT_EQ(pairs.at("hexahedron"), 654u);
  EXPECT_EQ(pairs.at("tetrahedron_prism"), 592u);
}

/// The comparison notices what it is for.
TEST(CellsByDefinition, AWrongContourIsFound) {
  const CellTable& table = tables::cell_table(CellShape::wedge, Triangulation::compact);
  const std::vector<PolytopeFace> faces = faces_of(table);
  const Corners s = 0b010001;  // two ends of a diagonal of a quadrilateral
  const auto simplices = vertex_sets_of(table, s);
  const Parts low(faces, edges_of(table), s, kAllLow);
  ASSERT_EQ(fault_of_separate(low, simplices), "");
  const Parts high(faces, edges_of(table), s, [](const PolytopeFace&) { return true; });
  EXPECT_EQ(fault_of_separate(high, simplices), "another number of separators");
  EXPECT_NE(fault_of_separate(low, vertex_sets_of(table, 0b000011)), "");
}

}  // namespace
}  // namespace tegl::gen
