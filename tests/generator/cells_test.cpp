// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of mesh cells: classes, certificates, and the emitted tables against contours that are built one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/determinant.hpp"
#include "base/error.hpp"
#include "cells/cell_contours.hpp"
#include "cells/cell_embedding.hpp"
#include "cells/cell_tables.hpp"
#include "cells/face_fillings.hpp"
#include "cells/region_tables.hpp"
#include "cells/shape_tables.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::gen {
namespace {

using tables::CellShape;
using tables::CellTable;

/// A simplex of a list by the masks of its vertices: an edge point is the mask of its edge.
using Named = std::vector<std::uint64_t>;

/// Maps local vertices and masks of a list to the vertices and masks of a signature.
struct TableElement {
  const CellTable& table;
  const std::uint8_t* permutation;  ///< or null
  bool reverses;

  TableElement(const CellTable& of, std::uint32_t signature)
      : table(of),
        permutation(of.element_of == nullptr ? nullptr
                                             : of.permutations + of.element_of[signature] * of.permutation_stride),
        reverses(of.element_of != nullptr && of.reverses[of.element_of[signature]] != 0) {}

  [[nodiscard]] std::uint64_t mask(std::uint64_t of) const {
    if (permutation == nullptr) return of;
    std::uint64_t result = 0;
    for (std::uint32_t v = 0; v < table.corner_count; ++v) result |= (of >> v & 1u) << permutation[v];
    for (std::uint32_t e = 0; e < table.edge_count; ++e)
      result |= (of >> (table.corner_count + e) & 1u) << (table.corner_count + permutation[table.corner_count + e]);
    return result;
  }
};

/// The simplices of a signature in a table, oriented.
std::vector<Named> simplices_of(const CellTable& table, std::uint32_t signature) {
  const TableElement element(table, signature);
  const tables::CellList& list = table.lists[table.list_of[signature]];
  std::vector<Named> result;
  for (std::uint32_t i = 0; i < list.simplex_count; ++i) {
    Named simplex;
    for (std::uint32_t k = 0; k < table.dim; ++k) {
      const std::uint8_t v = table.simplices[(list.first_simplex + i) * table.dim + k];
      simplex.push_back(element.mask(v < table.edge_count ? std::uint64_t{1} << (table.corner_count + v)
                                                          : table.masks[list.first_mask + v - table.edge_count]));
    }
    if (element.reverses) std::swap(simplex[table.dim - 1], simplex[table.dim - 2]);
    result.push_back(simplex);
  }
  return result;
}

std::vector<Named> simplices_of(const Cell& cell, const CellContour& contour) {
  std::vector<Named> result;
  for (const LocalSimplex& s : contour.simplices) {
    Named simplex;
    for (int k = 0; k < cell.tile.dim; ++k)
      simplex.push_back(s[k] < cell.tile.edge_count() ? std::uint64_t{1} << (cell.tile.corner_count() + s[k])
                                                      : contour.masks[s[k] - cell.tile.edge_count()]);
    result.push_back(simplex);
  }
  return result;
}

/// The oriented boundary: faces by sorted vertices, with their sums of signs.
std::map<Named, int> boundary_of(const std::vector<Named>& simplices) {
  std::map<Named, int> sum;
  for (const Named& simplex : simplices)
    for (std::size_t drop = 0; drop < simplex.size(); ++drop) {
      Named face;
      for (std::size_t i = 0; i < simplex.size(); ++i)
        if (i != drop) face.push_back(simplex[i]);
      int sign = drop % 2 == 0 ? 1 : -1;
      for (std::size_t i = 0; i < face.size(); ++i)
        for (std::size_t j = i + 1; j < face.size(); ++j)
          if (face[j] < face[i]) sign = -sign;
      std::sort(face.begin(), face.end());
      sum[face] += sign;
    }
  std::erase_if(sum, [](const auto& entry) { return entry.second == 0; });
  return sum;
}

TEST(Cells, HaveTheClassesAndFiguresOfTheirShapes) {
  struct Expected {
    const char* name;
    std::uint64_t corners, edges, order, classes, others;
  };
  // orders of the symmetry groups and signatures with tori are known from their geometry
  const Expected expected[tables::kCellShapes] = {{"triangle", 3, 3, 6, 4, 0},
                                                  {"quadrilateral", 4, 4, 8, 6, 0},
                                                  {"tetrahedron", 4, 6, 24, 5, 0},
                                                  {"wedge", 6, 9, 12, 13, 0},
                                                  {"pyramid", 5, 8, 8, 12, 0},
                                                  {"hexahedron", 8, 12, 48, 22, 0},
                                                  {"simplex4", 5, 10, 120, 6, 0},
                                                  {"tetrahedron_prism", 8, 16, 48, 22, 0},
                                                  {"wedge_prism", 12, 24, 48, 158, 48},
                                                  {"pyramid_prism", 10, 21, 16, 123, 12},
                                                  {"hexahedron_prism", 16, 32, 384, 402, 1860},
                                                  {"octahedron", 6, 12, 48, 10, 0},
                                                  {"octahedron_prism", 12, 30, 96, 126, 150},
                                                  {"cell16", 8, 24, 384, 15, 6}};
  const std::vector<Cell> cells = mesh_cells();
  ASSERT_EQ(std::size_t{tables::kCellShapes}, cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CellTables table = make_cell_tables(cells[i], Triangulation::barycentric);
    EXPECT_EQ(expected[i].name, table.name);
    EXPECT_EQ(expected[i].corners, cells[i].tile.corner_count()) << table.name;
    EXPECT_EQ(expected[i].edges, cells[i].tile.edge_count()) << table.name;
    EXPECT_EQ(expected[i].order, table.group_order) << table.name;
    EXPECT_EQ(expected[i].classes, table.classes) << table.name;
    EXPECT_EQ(expected[i].others, table.others) << table.name;
  }
}

TEST(Cells, ACopyWithAVertexOffItsRayIsNotProved) {
  const std::vector<Cell> cells = mesh_cells();
  const Cell& cell = cells[static_cast<std::size_t>(CellShape::wedge_prism)];
  const CellEmbedding embedding(cell);
  CellContours contours(cell, Triangulation::barycentric);
  static_cast<void>(contours.build(750));
  CellContour contour = contours.local();
  EXPECT_TRUE(embedding.unproved_pairs(contour).empty());
  // the copy of a barycentre, moved towards the face's high corners
  const std::size_t first_side = contour.masks.size() - contour.added_count[2];
  const auto side = std::find_if(contour.masks.begin() + static_cast<std::ptrdiff_t>(first_side), contour.masks.end(),
                                 [&](std::uint64_t mask) { return (mask & cell.tile.full()) == 0; });
  ASSERT_NE(side, contour.masks.end());
  std::uint64_t ends = 0;
  for (std::uint32_t e = 0; e < cell.tile.edge_count(); ++e)
    if ((*side >> (cell.tile.corner_count() + e) & 1u) != 0)
      ends |= Signature{1} << cell.tile.edges[e][0] | Signature{1} << cell.tile.edges[e][1];
  *side |= ends & 750;
  EXPECT_FALSE(embedding.unproved_pairs(contour).empty());
}

TEST(Cells, EmittedTablesHaveTheContourOfEverySignature) {
  const std::vector<Cell> cells = mesh_cells();
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
      const Cell& cell = cells[i];
      const CellTable& table = tables::cell_table(static_cast<CellShape>(i), t);
      ASSERT_EQ(cell.tile.corner_count(), table.corner_count);
      CellContours contours(cell, cell.tile.dim == 4 ? Triangulation::barycentric : t);
      const Signature step = cell.tile.corner_count() > 12 ? 29 : 1;  // 29: prime to the numbers of signatures
      for (Signature s = 0; s <= cell.tile.full(); s += step) {
        contours.build(s);
        const auto built = simplices_of(cell, contours.local());
        const auto emitted = simplices_of(table, static_cast<std::uint32_t>(s));
        ASSERT_EQ(built.size(), emitted.size()) << cell.name << " " << s;
        // side fillings may choose other diagonals inside; the boundary is that of the faces
        ASSERT_EQ(boundary_of(built), boundary_of(emitted)) << cell.name << " " << s;
      }
    }
}

TEST(Cells, EveryCrossedEdgeHasAPointAndNoOther) {
  for (unsigned shape = 0; shape < tables::kCellShapes; ++shape) {
    const CellTable& table = tables::cell_table(static_cast<CellShape>(shape), Triangulation::barycentric);
    for (std::uint32_t s = 0; s < 1u << table.corner_count; ++s) {
      std::uint64_t crossed = 0, used = 0;
      for (std::uint32_t e = 0; e < table.edge_count; ++e)
        if (((s >> table.edges[2 * e] ^ s >> table.edges[2 * e + 1]) & 1u) != 0)
          crossed |= std::uint64_t{1} << (table.corner_count + e);
      for (const Named& simplex : simplices_of(table, s))
        for (const std::uint64_t mask : simplex)
          if ((mask & (mask - 1)) == 0) used |= mask;  // added vertices have two or more points
      ASSERT_EQ(crossed, used & ~((std::uint64_t{1} << table.corner_count) - 1)) << shape << " " << s;
    }
  }
}

TEST(Cells, ASingleHighCornerIsOnThePositiveSide) {
  for (unsigned shape = 0; shape < tables::kCellShapes; ++shape)
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
      const CellTable& table = tables::cell_table(static_cast<CellShape>(shape), t);
      const std::uint32_t n = table.dim, full = (1u << table.corner_count) - 1;
      const auto place = [&](std::uint64_t mask, std::uint32_t i) {  // the mean of edges' midpoints
        double sum = 0, count = 0;
        for (std::uint32_t e = 0; e < table.edge_count; ++e) {
          if ((mask >> (table.corner_count + e) & 1u) == 0) continue;
          sum += (table.corners[table.edges[2 * e] * n + i] + table.corners[table.edges[2 * e + 1] * n + i]) / 2.0;
          ++count;
        }
        return sum / count;
      };
      for (std::uint32_t v = 0; v < table.corner_count; ++v)
        for (const bool high : {true, false})
          for (const Named& simplex : simplices_of(table, high ? 1u << v : full & ~(1u << v))) {
            std::array<std::array<double, 4>, 4> m{};
            for (std::uint32_t i = 0; i < n; ++i) {
              const double origin = place(simplex[0], i);
              for (std::uint32_t r = 1; r < n; ++r) m[r - 1][i] = place(simplex[r], i) - origin;
              m[n - 1][i] = table.corners[v * n + i] - origin;
            }
            ASSERT_EQ(high, determinant(m, static_cast<int>(n)) > 0) << shape << " " << v;
          }
    }
}

/// A chord drawn in a face by one cell could be drawn by its neighbour too; the certificate must refuse it.
TEST(Cells, CompactPolygonsHaveNoChordInAFace) {
  for (const CellShape shape : {CellShape::tetrahedron, CellShape::wedge, CellShape::pyramid, CellShape::hexahedron}) {
    const CellTable& table = tables::cell_table(shape, Triangulation::compact);
    const Cell cell = mesh_cells()[static_cast<std::size_t>(shape)];
    for (std::uint32_t s = 0; s < 1u << table.corner_count; ++s) {
      const auto simplices = simplices_of(table, s);
      std::map<Named, int> uses;
      for (const Named& triangle : simplices)
        for (std::size_t k = 0; k < 3; ++k) {
          Named side{triangle[k], triangle[(k + 1) % 3]};
          std::sort(side.begin(), side.end());
          ++uses[side];
        }
      for (const auto& [side, count] : uses) {
        Signature corners = 0;
        for (const std::uint64_t mask : side)
          for (std::uint32_t e = 0; e < table.edge_count; ++e)
            if (mask == std::uint64_t{1} << (table.corner_count + e))
              corners |= Signature{1} << table.edges[2 * e] | Signature{1} << table.edges[2 * e + 1];
        const bool in_face = std::any_of(cell.tile.faces.begin(), cell.tile.faces.end(),
                                         [&](const SubTile& face) { return (corners & ~face.corners()) == 0; });
        ASSERT_EQ(in_face ? 1 : 2, count) << cell.name << " " << s;
      }
    }
  }
}

TEST(Cells, CompactFourCellsAreRefused) {
  const std::vector<Cell> cells = mesh_cells();
  EXPECT_THROW(CellContours(cells[static_cast<std::size_t>(CellShape::simplex4)], Triangulation::compact),
               std::invalid_argument);
}

/// What the certificate says of the fillings of a shape's faces; "" if it accepts them.
std::string verdict(const CellTables& compact, const FaceFillings& fillings) {
  try {
    certify_face_fillings(compact, fillings);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FaceFillings, TheCertificateNamesEveryKindOfFault) {
  const CellTables wedge = make_cell_tables(mesh_cell("wedge"), Triangulation::compact);
  const FaceFillings fillings = make_face_fillings(wedge, false);
  EXPECT_EQ(verdict(wedge, fillings), "");
  unsigned s = 0;  // a signature with several fillings of two triangles
  while (fillings.cases[s].fillings < 2 || fillings.fillings[fillings.cases[s].first_filling].triangles != 2) ++s;
  const tables::FillingCase& of = fillings.cases[s];
  const tables::FaceFilling &first = fillings.fillings[of.first_filling], &second = (&first)[1];
  const auto expect_fault = [&](const FaceFillings& changed, const char* fault) {
    EXPECT_EQ(verdict(wedge, changed), "wedge, signature " + std::to_string(s) + ", low-connected: " + fault);
  };
  FaceFillings changed = fillings;
  std::copy_n(changed.triangles.begin() + first.first_triangle, 2, changed.triangles.begin() + second.first_triangle);
  expect_fault(changed, "two equal fillings");
  changed = fillings;
  changed.fillings[of.first_filling].triangles = 1;
  expect_fault(changed, "a filling with another number of triangles");
  changed = fillings;
  std::swap(changed.triangles[first.first_triangle][0], changed.triangles[first.first_triangle][1]);
  expect_fault(changed, "a filling with another boundary");
  changed = fillings;
  changed.cases[s].own = of.own == 0 ? 1 : 0;
  expect_fault(changed, "the number of its own contour");
  changed = fillings;
  changed.apexes[changed.polygons[of.first_polygon].first_apex].choice = of.fillings;
  expect_fault(changed, "choices without a filling");
}

TEST(FaceFillings, AChordInAFaceIsRefused) {
  const CellTables cube = make_cell_tables(mesh_cell("hexahedron"), Triangulation::compact);
  FaceFillings fillings = make_face_fillings(cube, false);
  EXPECT_EQ(verdict(cube, fillings), "");
  fillings.of_frames[3][5] = fillings.cases[3].fillings;
  EXPECT_EQ(verdict(cube, fillings), "hexahedron, signature 3, low-connected: a frame without a filling");
  // Low corners 0 and 3 are joined: a hexagon with four points in the square of corners 0 to 3.
  fillings = make_face_fillings(cube, false);
  const tables::FillingCase& of = fillings.cases[246];
  const tables::FaceFilling& filling = fillings.fillings[of.first_filling];
  ASSERT_EQ(filling.triangles, 4);
  std::map<std::uint8_t, std::uint8_t> next;  // along the polygon
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned k = 0; k < 3; ++k) {
      const auto& t = fillings.triangles[filling.first_triangle + i];
      const std::pair side(t[k], t[(k + 1) % 3]);
      bool is_inner = false;
      for (unsigned j = 0; j < 12; ++j) {
        const auto& other = fillings.triangles[filling.first_triangle + j / 3];
        is_inner = is_inner || std::pair(other[(j + 1) % 3], other[j % 3]) == side;
      }
      if (!is_inner) next.insert(side);
    }
  ASSERT_EQ(next.size(), 6U);
  bool is_refused = false;
  for (const auto& [start, unused] : next) {  // all fans
    FaceFillings fan = fillings;
    std::uint8_t at = next.at(start);
    for (unsigned i = 0; i < 4; ++i, at = next.at(at))
      fan.triangles[filling.first_triangle + i] = {start, at, next.at(at)};
    is_refused =
        is_refused || verdict(cube, fan) == "hexahedron, signature 246, low-connected: a side in a face of the shape";
  }
  EXPECT_TRUE(is_refused);
}

TEST(ShapeTables, TheEmittedOnesAreThoseThatWereCertified) {
  const std::vector<ShapeTables> all = make_all_shape_tables();
  ASSERT_EQ(all.size(), tables::kCellShapes);
  for (unsigned s = 0; s < tables::kCellShapes; ++s) {
    const auto shape = static_cast<CellShape>(s);
    const tables::ShapeTable& table = tables::shape_table(shape);
    const CellTable& cell = tables::cell_table(shape, Triangulation::barycentric);
    const ShapeTables& of = all[s];
    ASSERT_EQ(table.facet_count, of.facets.size()) << of.name;
    for (std::size_t f = 0; f < of.facets.size(); ++f) {
      EXPECT_EQ(table.facets[f].shape, of.facets[f].shape) << of.name;
      EXPECT_EQ(table.facets[f].corner_count, of.facets[f].corner_count) << of.name;
      EXPECT_EQ(table.facets[f].corners, of.facets[f].corners) << of.name;
      EXPECT_EQ(table.facets[f].is_inverted, of.facets[f].is_inverted) << of.name;
    }
    const auto expect_same = [&](const auto* emitted, const auto& made, const auto& same) {
      ASSERT_EQ(emitted == nullptr, made.empty()) << of.name;
      for (std::size_t i = 0; i < made.size(); ++i) ASSERT_TRUE(same(emitted[i], made[i])) << of.name << " " << i;
    };
    const auto same_sides = [](const auto& a, const auto& b) { return a.above == b.above && a.below == b.below; };
    EXPECT_EQ(std::size_t{table.symmetry_count} * (cell.corner_count + cell.edge_count), of.symmetries.size());
    expect_same(table.symmetries, of.symmetries, std::equal_to<>());
    EXPECT_EQ(table.plane_count, of.planes.size());
    expect_same(table.planes, of.planes, same_sides);
  }
}

TEST(ShapeTables, HaveTheNumbersThatAreKnown) {
  // orders of the symmetry groups; hyperplanes through corners of the 4-cube (OEIS A007847)
  const auto table = [](CellShape shape) { return tables::shape_table(shape); };
  EXPECT_EQ(table(CellShape::tetrahedron).symmetry_count, 24);
  EXPECT_EQ(table(CellShape::wedge).symmetry_count, 12);
  EXPECT_EQ(table(CellShape::pyramid).symmetry_count, 8);
  EXPECT_EQ(table(CellShape::hexahedron).symmetry_count, 48);
  EXPECT_EQ(table(CellShape::octahedron).symmetry_count, 48);
  EXPECT_EQ(table(CellShape::simplex4).plane_count, 5);
  EXPECT_EQ(table(CellShape::hexahedron_prism).plane_count, 140);
}

/// The message of the certificate about shapes of which one was changed; "" if it accepts them.
template <class Change>
std::string verdict_with(CellShape shape, const Change& change) {
  static const std::vector<ShapeTables> kAll = make_all_shape_tables();
  std::vector<ShapeTables> changed = kAll;
  change(changed[static_cast<std::size_t>(shape)]);
  try {
    certify_shape_tables(changed);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ShapeTables, TheCertificateNamesEveryKindOfFault) {
  const auto wedge = [](const auto& change) { return verdict_with(CellShape::wedge, change); };
  const auto prism = [](const auto& change) { return verdict_with(CellShape::tetrahedron_prism, change); };
  EXPECT_EQ(wedge([](ShapeTables&) {}), "");
  EXPECT_EQ(wedge([](ShapeTables& t) { std::swap(t.facets[0].corners[0], t.facets[0].corners[1]); }),
            "wedge: corners of a facet that do not ascend");
  EXPECT_EQ(wedge([](ShapeTables& t) { t.facets.pop_back(); }), "wedge: facets other than those of the lattice");
  EXPECT_EQ(wedge([](ShapeTables& t) { t.facets.push_back(t.facets[0]); }),
            "wedge: facets other than those of the lattice");
  EXPECT_EQ(wedge([](ShapeTables& t) { t.facets[3].shape = CellShape::quadrilateral; }),
            "wedge: a facet of another shape");
  EXPECT_EQ(prism([](ShapeTables& t) { t.facets[2].shape = CellShape::octahedron; }),
            "tetrahedron_prism: a facet of another shape");
  EXPECT_EQ(prism([](ShapeTables& t) { t.facets[2].is_inverted = !t.facets[2].is_inverted; }),
            "tetrahedron_prism: orientations of facets that do not cancel");
  EXPECT_EQ(prism([](ShapeTables& t) {
              for (tables::CellFacet& facet : t.facets) facet.is_inverted = !facet.is_inverted;
            }),
            "tetrahedron_prism: inverted orientations of all facets");
  const std::string symmetries = "wedge: symmetries other than all permutations that map facets to facets";
  EXPECT_EQ(wedge([](ShapeTables& t) { t.symmetries.resize(t.symmetries.size() - 15); }), symmetries);
  EXPECT_EQ(wedge([](ShapeTables& t) { std::swap(t.symmetries[20], t.symmetries[21]); }), symmetries);
  EXPECT_EQ(wedge([](ShapeTables& t) { std::swap(t.symmetries[25], t.symmetries[26]); }), symmetries);
  EXPECT_EQ(prism([](ShapeTables& t) { t.planes.pop_back(); }),
            "tetrahedron_prism: hyperplanes other than those through four corners");
  EXPECT_EQ(prism([](ShapeTables& t) { t.planes.back().below |= 1u << 15; }),
            "tetrahedron_prism: hyperplanes other than those through four corners");
  EXPECT_EQ(prism([](ShapeTables& t) { std::swap(t.planes[3], t.planes[4]); }),
            "tetrahedron_prism: hyperplanes that do not ascend");
  EXPECT_EQ(verdict_with(CellShape::triangle, [](ShapeTables& t) { t.planes.resize(1); }),
            "triangle: a table of 4D shapes");
  EXPECT_EQ(verdict_with(CellShape::triangle, [](ShapeTables& t) { std::swap(t.facets[0], t.facets[1]); }), "");
}

CapTables regions_of_wedges() {
  const CellTables wedge = make_cell_tables(mesh_cell("wedge"), Triangulation::compact);
  const std::array fillings = {make_face_fillings(wedge, false), make_face_fillings(wedge, true)};
  return make_region_tables(mesh_cell("wedge"), make_all_shape_tables()[static_cast<std::size_t>(CellShape::wedge)],
                            fillings);
}

void expect_emitted(const tables::RegionDivisionTable& table, const CapTables& of) {
  ASSERT_EQ(table.count, of.records.size());
  for (std::size_t i = 0; i < of.records.size(); ++i) {
    const tables::RegionRecord &a = table.records[i], &b = of.records[i];
    ASSERT_EQ(a.first_triangle, b.first_triangle);
    ASSERT_EQ(a.first_tetrahedron, b.first_tetrahedron);
    ASSERT_EQ(a.first_own, b.first_own);
    ASSERT_EQ(a.first_near, b.first_near);
    ASSERT_EQ(a.triangles, b.triangles);
    ASSERT_EQ(a.tetrahedra, b.tetrahedra);
    ASSERT_EQ(a.own, b.own);
    ASSERT_EQ(a.near, b.near);
  }
  for (std::size_t i = 0; i < of.triangles.size(); ++i)
    ASSERT_TRUE(std::equal(of.triangles[i].begin(), of.triangles[i].end(), table.triangles + 3 * i));
  for (std::size_t i = 0; i < of.tetrahedra.size(); ++i)
    ASSERT_TRUE(std::equal(of.tetrahedra[i].begin(), of.tetrahedra[i].end(), table.tetrahedra + 4 * i));
  ASSERT_EQ(table.own == nullptr, of.own.empty());
  ASSERT_TRUE(std::equal(of.own.begin(), of.own.end(), table.own));
  ASSERT_EQ(table.near == nullptr, of.near.empty());
  for (std::size_t i = 0; i < of.near.size(); ++i) {
    ASSERT_EQ(table.near[i].own, of.near[i].own);
    ASSERT_EQ(table.near[i].corner, of.near[i].corner);
    ASSERT_EQ(table.near[i].seen, of.near[i].seen);
    ASSERT_EQ(table.near[i].first_seen, of.near[i].first_seen);
  }
}

TEST(RegionTables, TheEmittedOnesAreThoseThatWereCertified) {
  struct Expected {
    const char* name;
    CellShape shape;
    std::uint64_t boundaries, unproved;
  };
  const Expected expected[] = {{"tetrahedron", CellShape::tetrahedron, 109, 0},
                               {"wedge", CellShape::wedge, 1'392, 0},
                               {"pyramid", CellShape::pyramid, 631, 0},
                               {"hexahedron", CellShape::hexahedron, 10'166, 0},
                               {"octahedron", CellShape::octahedron, 8'018, 1}};
  std::vector<CellTables> compact;
  for (const Expected& of : expected) compact.push_back(make_cell_tables(mesh_cell(of.name), Triangulation::compact));
  const std::vector<CapTables> all = make_all_region_tables(make_all_shape_tables(), make_all_face_fillings(compact));
  ASSERT_EQ(all.size(), std::size(expected));
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(expected[i].name);
    EXPECT_EQ(all[i].name, expected[i].name);
    EXPECT_EQ(all[i].boundaries, expected[i].boundaries);
    EXPECT_EQ(all[i].unproved.size(), expected[i].unproved);
    expect_emitted(*tables::region_division_table(expected[i].shape), all[i]);
  }
  EXPECT_EQ(tables::region_division_table(CellShape::triangle), nullptr);
}

template <class Array>
std::uint32_t size_of(const Array& array) {
  return static_cast<std::uint32_t>(array.size());
}

TEST(RegionTables, TheCertificateNamesEveryKindOfFault) {
  const Cell wedge = mesh_cell("wedge");
  const CapTables regions = regions_of_wedges();
  const auto first = [&](const auto& holds) {
    return static_cast<std::size_t>(std::find_if(regions.records.begin(), regions.records.end(), holds) -
                                    regions.records.begin());
  };
  const auto expect_fault = [&](std::size_t region, const char* fault, const auto& change) {
    CapTables changed = regions;
    change(changed, changed.records[region]);
    try {
      certify_region_tables(wedge, changed);
      ADD_FAILURE() << fault;
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), "wedge, region " + std::to_string(region) + ": " + fault);
    }
  };
  using Record = tables::RegionRecord;
  const std::size_t several = first([](const Record& r) { return r.tetrahedra > 2 && r.own == 0; });
  expect_fault(several, "triangles that do not ascend", [](CapTables& t, const Record& r) {
    std::swap(t.triangles[r.first_triangle], t.triangles[r.first_triangle + 1]);
  });
  expect_fault(several, "a boundary of no single region", [](CapTables&, Record& r) { --r.triangles; });
  expect_fault(several, "tetrahedra with another boundary", [](CapTables&, Record& r) { --r.tetrahedra; });
  expect_fault(several, "a tetrahedron that may be negative", [](CapTables& t, const Record& r) {
    std::swap(t.tetrahedra[r.first_tetrahedron][2], t.tetrahedra[r.first_tetrahedron][3]);
  });
  expect_fault(several, "a vertex that does not exist",
               [](CapTables& t, const Record& r) { t.tetrahedra[r.first_tetrahedron][0] = 28; });
  expect_fault(several + 1, "a boundary that does not follow the one before",
               [&](CapTables& t, Record&) { std::swap(t.records[several], t.records[several + 1]); });
  // the mean of one point of the boundary does not see the triangles around that point
  const std::size_t coned = first([](const Record& r) { return r.own == 1 && r.near == 0; });
  expect_fault(coned, "a tetrahedron that may be negative",
               [](CapTables& t, const Record& r) { t.own[r.first_own] = 1u << t.triangles[r.first_triangle][0]; });
  const std::size_t near = first([](const Record& r) { return r.near == 1; });
  ASSERT_LT(near, regions.records.size());
  expect_fault(near, "a tetrahedron that may be negative",
               [](CapTables& t, const Record& r) { t.near[r.first_near].seen = 0; });
  const auto expect_outside = [&](std::size_t region, const auto& change) {
    expect_fault(region, "a range outside of its array", change);
  };
  expect_outside(several, [](CapTables& t, Record& r) { r.first_triangle = size_of(t.triangles) - r.triangles + 1; });
  expect_outside(several, [](CapTables& t, Record& r) { r.first_tetrahedron = size_of(t.tetrahedra) + 1; });
  expect_outside(coned, [](CapTables& t, Record& r) { r.first_own = static_cast<std::uint16_t>(t.own.size()); });
  expect_outside(near, [](CapTables& t, Record& r) { r.first_near = static_cast<std::uint16_t>(t.near.size()); });
  expect_outside(near, [](CapTables& t, const Record& r) { t.near[r.first_near].first_seen = size_of(t.triangles); });
  for (const unsigned bit : {6u, 8u + 9u, 20u})  // a wedge has six corners and nine edges
    expect_fault(coned, "a mean of a point that does not exist",
                 [&](CapTables& t, const Record& r) { t.own[r.first_own] |= 1u << bit; });
  expect_fault(near, "a vertex near a corner that does not exist",
               [](CapTables& t, const Record& r) { t.near[r.first_near].corner = 6; });
}

}  // namespace
}  // namespace tegl::gen
