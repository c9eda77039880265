// SPDX-License-Identifier: BSD-3-Clause
//
// Pyramids, prisms and double pyramids over polytopes.
#include "cells/cell.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

namespace tegl::gen {

namespace {

using Corner = std::array<double, 4>;

/// A polytope by its corners and the corner sets of its faces of codimension one.
struct Polytope {
  int dim = 0;
  std::vector<Corner> corners{Corner{}};
  std::vector<Signature> faces;

  [[nodiscard]] Signature all() const { return ~Signature{0} >> (64 - corners.size()); }
};

Polytope pyramid(const Polytope& base) {
  Polytope result{base.dim + 1, base.corners, {base.all()}};
  const Signature apex = Signature{1} << base.corners.size();
  for (const Signature face : base.faces) result.faces.push_back(face | apex);
  if (base.dim == 0) result.faces.push_back(apex);  // the boundary of a segment: two points
  Corner tip{};
  tip[static_cast<std::size_t>(base.dim)] = 1;
  result.corners.push_back(tip);
  return result;
}

Polytope prism(const Polytope& base) {
  const auto count = base.corners.size();
  Polytope result{base.dim + 1, base.corners, {base.all(), base.all() << count}};
  for (const Signature face : base.faces) result.faces.push_back(face | face << count);
  for (Corner corner : base.corners) {
    corner[static_cast<std::size_t>(base.dim)] = 1;
    result.corners.push_back(corner);
  }
  return result;
}

/// The base's centre must be at 1 along each of its axes.
Polytope double_pyramid(const Polytope& base) {
  const Signature lower = Signature{1} << base.corners.size();
  Polytope result{base.dim + 1, base.corners, {}};
  for (const Signature apex : {lower, lower << 1})
    for (const Signature face : base.faces) result.faces.push_back(face | apex);
  for (Corner& corner : result.corners) corner[static_cast<std::size_t>(base.dim)] = 1;
  Corner tip{};
  std::fill_n(tip.begin(), base.dim, 1.0);
  result.corners.push_back(tip);
  tip[static_cast<std::size_t>(base.dim)] = 2;
  result.corners.push_back(tip);
  return result;
}

/// With corner 0 at the origin.
Polytope at_origin(Polytope polytope) {
  const Corner first = polytope.corners.front();
  for (Corner& corner : polytope.corners)
    for (std::size_t i = 0; i < corner.size(); ++i) corner[i] -= first[i];
  return polytope;
}

Cell cell_of(std::string name, const Polytope& polytope) {
  Cell cell{std::move(name), {}, tile::FaceLattice(polytope.dim, polytope.faces)};
  cell.tile.kind = TileKind::other;
  cell.tile.dim = polytope.dim;
  cell.tile.corners = polytope.corners;
  for (const tile::Face& face : cell.lattice.faces()) {  // edges are in ascending order in the lattice
    if (face.dim != 1) continue;
    const auto a = std::countr_zero(face.corners), b = 63 - std::countl_zero(face.corners);
    cell.tile.edges.push_back({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b)});
    cell.tile.edge_names.push_back(std::to_string(a) + "-" + std::to_string(b));
  }
  for (const Signature face : polytope.faces) {
    SubTile sub{nullptr, {}, {}, 0};
    for (std::uint8_t v = 0; v < polytope.corners.size(); ++v)
      if ((face >> v & 1u) != 0) sub.corner.push_back(v);
    cell.tile.faces.push_back(std::move(sub));
  }
  return cell;
}

}  // namespace

std::vector<Cell> mesh_cells() {
  const Polytope segment = pyramid(Polytope{}), triangle = pyramid(segment), square = prism(segment);
  const Polytope tetrahedron = pyramid(triangle), wedge = prism(triangle), square_pyramid = pyramid(square),
                 hexahedron = prism(square);
  Polytope across = segment;  // of length 2, around 1
  across.corners[1][0] = 2;
  const Polytope octahedron = double_pyramid(double_pyramid(across)), cell16 = double_pyramid(octahedron);
  const std::pair<const char*, Polytope> shapes[tables::kCellShapes] = {
      {"triangle", triangle},
      {"quadrilateral", square},
      {"tetrahedron", tetrahedron},
      {"wedge", wedge},
      {"pyramid", square_pyramid},
      {"hexahedron", hexahedron},
      {"simplex4", pyramid(tetrahedron)},
      {"tetrahedron_prism", prism(tetrahedron)},
      {"wedge_prism", prism(wedge)},
      {"pyramid_prism", prism(square_pyramid)},
      {"hexahedron_prism", prism(hexahedron)},
      {"octahedron", at_origin(octahedron)},
      {"octahedron_prism", prism(at_origin(octahedron))},
      {"cell16", at_origin(cell16)}};
  std::vector<Cell> cells;
  for (const auto& [name, polytope] : shapes) cells.push_back(cell_of(name, polytope));
  return cells;
}

Cell mesh_cell(std::string_view name) {
  for (Cell& cell : mesh_cells())
    if (cell.name == name) return std::move(cell);
  throw std::invalid_argument("no mesh cell of this name: " + std::string(name));
}

bool is_cube(const Cell& cell) { return cell.tile.corner_count() == 1u << cell.tile.dim; }

}  // namespace tegl::gen
