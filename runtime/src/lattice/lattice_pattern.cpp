// SPDX-License-Identifier: BSD-3-Clause
//
// Derives the edges of a lattice, and their places in its cells, from the cells.
#include "lattice/lattice_pattern.hpp"

#include <algorithm>
#include <utility>

#include "complex/cell_groups.hpp"
#include "lattice/lattice_grid.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::detail {

namespace {

using Offset = std::array<std::ptrdiff_t, 3>;

/// Index differences (along the row, row, layer) of a place; 2D lattices have no rows in a layer.
Offset offset_of(const LatticePlace& place, int dim) {
  return dim == 2 ? Offset{place[0], 0, place[1]} : Offset{place[0], place[1], place[2]};
}
bool is_before(const Offset& a, const Offset& b) { return std::array{a[2], a[1], a[0]} < std::array{b[2], b[1], b[0]}; }

std::size_t kind_of(const Offset& to, std::vector<EdgeKind>& kinds) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const EdgeKind& kind) { return kind.to == to; });
  if (found != kinds.end()) return static_cast<std::size_t>(found - kinds.begin());
  kinds.push_back({to});
  return kinds.size() - 1;
}

/// Whether a cell is oriented against its reference: by the places of its corners, with the sample far from the border.
template <int N>
bool is_inverted(const PatternCell& cell, const CellKind& kind, const Grid<N>& grid) {
  std::vector<std::array<double, N>> points;
  for (LatticePlace place : cell.corners) {
    const bool is_odd = ((cell.parity + place[N - 1]) & 1) != 0;
    std::array<double, N> x;
    for (int a = 0; a < N; ++a) {
      const double step = grid.axes[a].is_descending() ? -1.0 : 1.0;
      x[a] = (static_cast<double>(place[a]) + (a < N - 1 && is_odd ? 0.5 : 0.0)) * step;
    }
    std::array<double, N> world{};
    for (int row = 0; row < N; ++row)
      for (int a = 0; a < N; ++a) world[row] += grid.linear[row][a] * x[a];
    points.push_back(world);
  }
  std::vector<Index> corners(points.size());
  for (std::size_t i = 0; i < corners.size(); ++i) corners[table_corner(kind, i)] = static_cast<Index>(i);
  const CellGroups one{{CellGroup{kind.shape, corners.size(), corners}}, 1};
  return (find_cell_signs<N>(one, points)[0][0] & 1u) != 0;
}

/// `against`: reverses the orientation of the table.
std::vector<LatticeCell::Contour> contours_of(const tables::CellTable& table, bool high_connected, bool against) {
  std::vector<LatticeCell::Contour> contours(std::size_t{1} << table.corner_count);
  for (unsigned signature = 0; signature < contours.size(); ++signature) {
    LatticeCell::Contour& made = contours[signature];
    const CellContour contour(table, signature, high_connected);
    made.crossed = crossed_edges(table, signature);
    made.simplices = contour.list().simplex_count;
    made.own = contour.list().added();
    for (unsigned i = 0; i < made.simplices; ++i) {
      for (unsigned k = 0; k < table.dim; ++k) made.vertices.push_back(static_cast<std::uint8_t>(contour.vertex(i, k)));
      if (contour.reverses() != against) std::swap(made.vertices.end()[-1], made.vertices.end()[-2]);
    }
    for (unsigned j = 0; j < made.own; ++j)
      made.centres.push_back(static_cast<std::uint32_t>(contour.mask(j) >> table.corner_count));
  }
  return contours;
}

void make_lists(LatticeCell& cell) {
  cell.has_lists = std::all_of(cell.contours.begin(), cell.contours.end(), [](const LatticeCell::Contour& contour) {
    return contour.own == 0 && contour.vertices.size() <= LatticeCell::kList;
  });
  for (const LatticeCell::Contour& contour : cell.contours) {
    if (!cell.has_lists) break;
    cell.sizes.push_back(static_cast<std::uint8_t>(contour.simplices));
    cell.lists.insert(cell.lists.end(), contour.vertices.begin(), contour.vertices.end());
    cell.lists.resize(cell.sizes.size() * LatticeCell::kList);
  }
}

}  // namespace

template <int N>
std::array<LayerPattern, 2> make_patterns(Lattice lattice, const Grid<N>& grid, const ExtractOptions& options) {
  std::array<LayerPattern, 2> patterns;
  for (const PatternCell& cell : pattern_of_lattice(lattice)) {
    const CellKind& kind = *find_kind(cell.type);
    const tables::CellTable& table = tables::cell_table(kind.shape, options.triangulation);
    LatticeCell made{cell.at_ends};
    const bool against = is_inverted<N>(cell, kind, grid) != (options.direction == GradientDirection::descent);
    made.contours = contours_of(table, options.ambiguity == Ambiguity::high, against);
    make_lists(made);
    made.corners.resize(cell.corners.size());
    for (std::size_t i = 0; i < cell.corners.size(); ++i)
      made.corners[table_corner(kind, i)] = offset_of(cell.corners[i], N);
    for (const Offset& corner : made.corners)
      for (std::size_t a = 0; a < 3; ++a) {
        made.least[a] = std::min(made.least[a], corner[a]);
        made.most[a] = std::max(made.most[a], corner[a]);
      }
    const auto of = static_cast<std::size_t>(cell.parity);
    for (std::uint32_t e = 0; e < table.edge_count; ++e) {
      Offset from = made.corners[table.edges[2 * e]], to = made.corners[table.edges[2 * e + 1]];
      if (is_before(to, from)) std::swap(from, to);
      const auto parity = static_cast<std::size_t>((cell.parity + from[2]) & 1);
      for (std::size_t a = 0; a < 3; ++a) to[a] -= from[a];
      made.edges.push_back({from, kind_of(to, patterns[parity].edges)});
      patterns[parity].edges[made.edges.back().kind].uses.push_back({of, patterns[of].cells.size(), from});
    }
    patterns[of].cells.push_back(std::move(made));
  }
  return patterns;
}

template std::array<LayerPattern, 2> make_patterns<2>(Lattice, const Grid<2>&, const ExtractOptions&);
template std::array<LayerPattern, 2> make_patterns<3>(Lattice, const Grid<3>&, const ExtractOptions&);

}  // namespace tegl::detail
