// SPDX-License-Identifier: BSD-3-Clause
//
// Derives the edges of a lattice, and their places in its cells, from the cells.
#include "lattice/lattice_pattern.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "base/progress.hpp"
#include "complex/built_cells.hpp"
#include "complex/cell_groups.hpp"
#include "image/bitplanes.hpp"
#include "lattice/lattice_grid.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::detail {

namespace {

using tables::CellShape;
using tables::CellTable;

/// Whether the number of a sample is less than that of another one with these indices: axis 0 is fastest.
bool is_before(const LatticePlace& a, const LatticePlace& b) {
  return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

std::size_t kind_of(const LatticePlace& to, std::vector<EdgeKind>& kinds) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const EdgeKind& kind) { return kind.to == to; });
  if (found != kinds.end()) return static_cast<std::size_t>(found - kinds.begin());
  kinds.push_back({to});
  return kinds.size() - 1;
}

/// The corners in the order of the table; of a prism, with those of the next time behind.
std::vector<LatticePlace> corners_of(const PatternCell& cell, bool is_in_time) {
  const CellKind& kind = *find_kind(cell.type);
  const std::size_t count = cell.corners.size();
  std::vector<LatticePlace> corners(count);
  for (std::size_t i = 0; i < count; ++i) corners[table_corner(kind, i)] = cell.corners[i];
  for (std::size_t i = 0; is_in_time && i < count; ++i) {
    corners.push_back(corners[i]);
    corners.back()[3] += 1;
  }
  return corners;
}

/// Whether a cell of a sample in a layer of this parity is oriented against its reference: by the places of its
/// corners, with the sample far from the border. `layers`: the axis of the layers.
template <int N>
bool is_inverted(const LatticeCell& cell, int parity, int layers, const Grid<N>& grid) {
  std::vector<std::array<double, N>> points;
  for (const LatticePlace& place : cell.corners) {
    const bool is_odd = ((parity + place[layers]) & 1) != 0;
    std::array<double, N> x;
    for (int a = 0; a < N; ++a) {
      const double step = grid.axes[a].is_descending() ? -1.0 : 1.0;
      x[a] = (static_cast<double>(place[a]) + (a < layers && is_odd ? 0.5 : 0.0)) * step;
    }
    std::array<double, N> world{};
    for (int row = 0; row < N; ++row)
      for (int a = 0; a < N; ++a) world[row] += grid.linear[row][a] * x[a];
    points.push_back(world);
  }
  std::vector<Index> corners(points.size());
  std::iota(corners.begin(), corners.end(), Index{0});
  const CellGroups one{{CellGroup{cell.shape, corners.size(), corners}}, 1};
  return (find_cell_signs<N>(one, points)[0][0] & 1u) != 0;
}

/// Adds the edges in a mask of corners and edges, ascending by the numbers of the samples at their ends.
void add_edges(const LatticeCell& cell, std::uint64_t mask, LatticeCell::OwnVertex& own) {
  for (mask >>= cell.corners.size(); mask != 0; mask &= mask - 1)
    own.edges[own.edge_count++] = static_cast<std::uint8_t>(std::countr_zero(mask));
  std::sort(own.edges.begin(), own.edges.begin() + own.edge_count, [&](std::uint8_t e, std::uint8_t f) {
    const auto &of_e = cell.ends[e], &of_f = cell.ends[f];
    return of_e[0] == of_f[0] ? is_before(of_e[1], of_f[1]) : is_before(of_e[0], of_f[0]);
  });
}

/// Whether a vertex is the mean of points at both times of a prism, or between them.
bool has_both_times(const LatticeCell& cell, const LatticeCell::OwnVertex& own) {
  std::array<bool, 2> has{};
  for (const std::uint8_t e : std::span(own.edges).first(own.edge_count))
    for (const LatticePlace& end : cell.ends[e]) has[static_cast<std::size_t>(end[3])] = true;
  for (std::uint32_t rest = own.corners; rest != 0; rest &= rest - 1)
    has[static_cast<std::size_t>(cell.corners[static_cast<std::size_t>(std::countr_zero(rest))][3])] = true;
  return has[0] && has[1];
}

/// Adds the contour of a signature, whose vertices are all on edges or inside.
void add_contour(LatticeCell& cell, const CellTable& table, unsigned signature, const CellContour& contour) {
  const tables::CellList& list = contour.list();
  LatticeCell::Contour& made = cell.contours[signature];
  made.first = static_cast<std::uint32_t>(cell.lists.size() - LatticeCell::kMargin);
  cell.first_own[signature] = static_cast<std::uint32_t>(cell.own.size());
  made.simplices = list.simplex_count;
  made.own = static_cast<std::uint16_t>(list.added());
  cell.lists.resize(made.first);
  for (unsigned i = 0; i < list.simplex_count; ++i) {
    for (unsigned k = 0; k < table.dim; ++k) cell.lists.push_back(static_cast<std::uint8_t>(contour.vertex(i, k)));
    if (contour.reverses() != cell.is_reversed) std::swap(cell.lists.end()[-1], cell.lists.end()[-2]);
  }
  cell.lists.resize(cell.lists.size() + LatticeCell::kMargin);
  const unsigned first_side = list.shared_vertices + list.cone_vertices;
  for (unsigned j = 0; j < list.added(); ++j) {
    LatticeCell::OwnVertex& own = cell.own.emplace_back();
    add_edges(cell, contour.mask(j), own);
    own.corners = static_cast<std::uint32_t>(contour.mask(j) & ((std::uint64_t{1} << table.corner_count) - 1));
    if (j >= first_side) own.part = j >= list.added() - list.collar_vertices ? 0.25 : 0.5;
    if (cell.is_swept) own.is_between = own.part != 0.0 || has_both_times(cell, own);
  }
}

/// A cell without edges and contours.
template <int N>
LatticeCell cell_of(const PatternCell& cell, Lattice lattice, const Grid<N>& grid, const ExtractOptions& options) {
  const bool is_in_time = lattice == Lattice::fcc_in_time;
  const CellShape shape = find_kind(cell.type)->shape;
  LatticeCell made{cell.at_ends, is_in_time ? prism_of(shape) : shape, is_in_time};
  made.corners = corners_of(cell, is_in_time);
  for (const LatticePlace& corner : made.corners) {
    made.shifts.push_back(static_cast<std::uint8_t>(static_cast<std::size_t>(corner[0]) % kWordBits));
    for (std::size_t a = 0; a < 4; ++a) {
      made.least[a] = std::min(made.least[a], corner[a]);
      made.most[a] = std::max(made.most[a], corner[a]);
    }
  }
  made.is_reversed =
      is_inverted<N>(made, cell.parity, layer_axis(lattice), grid) != (options.direction == GradientDirection::descent);
  const CellTable& table = tables::cell_table(made.shape, options.triangulation);
  for (unsigned signature = 0; signature < 1u << table.corner_count; ++signature)
    made.crossed.push_back(crossed_edges(table, signature));
  made.contours.resize(made.crossed.size());
  made.first_own.resize(made.crossed.size());
  made.lists.resize(LatticeCell::kMargin);
  return made;
}

}  // namespace

OccurringSignatures::OccurringSignatures(const LatticePatterns& patterns) {
  for (std::size_t parity = 0; parity < 2; ++parity)
    for (const LatticeCell& cell : patterns[parity].cells) of_[parity].emplace_back(cell.crossed.size());
}

template <int N>
LatticePatterns make_patterns(Lattice lattice, const Grid<N>& grid, const ExtractOptions& options) {
  LatticePatterns patterns;
  const auto layers = static_cast<std::size_t>(layer_axis(lattice));
  for (const PatternCell& cell : pattern_of_lattice(lattice == Lattice::fcc_in_time ? Lattice::fcc : lattice)) {
    LatticeCell made = cell_of<N>(cell, lattice, grid, options);
    const CellTable& table = tables::cell_table(made.shape, options.triangulation);
    const auto of = static_cast<std::size_t>(cell.parity);
    for (std::uint32_t e = 0; e < table.edge_count; ++e) {
      LatticePlace from = made.corners[table.edges[2 * e]], to = made.corners[table.edges[2 * e + 1]];
      if (is_before(to, from)) std::swap(from, to);
      made.ends.push_back({from, to});
      const auto parity = static_cast<std::size_t>((cell.parity + from[layers]) & 1);
      for (std::size_t a = 0; a < 4; ++a) to[a] -= from[a];
      made.edges.push_back({from, kind_of(to, patterns[parity].edges)});
      patterns[parity].edges[made.edges.back().kind].uses.push_back({of, patterns[of].cells.size(), from});
    }
    for (unsigned signature = 0; N < 4 && signature < made.contours.size(); ++signature)
      add_contour(made, table, signature, CellContour(table, signature, options.ambiguity == Ambiguity::high));
    patterns[of].cells.push_back(std::move(made));
  }
  return patterns;
}

template LatticePatterns make_patterns<2>(Lattice, const Grid<2>&, const ExtractOptions&);
template LatticePatterns make_patterns<3>(Lattice, const Grid<3>&, const ExtractOptions&);
template LatticePatterns make_patterns<4>(Lattice, const Grid<4>&, const ExtractOptions&);

namespace {

/// A signature of a cell, and everything that its contour depends on.
struct KeyOfSignature {
  LatticeCell* cell;
  unsigned signature;
  CellKey key;
};

/// The keys of the signatures that occur in cells of one shape. Compact contours depend on the order of the samples at
/// the corners, which is the same for all samples.
std::vector<KeyOfSignature> keys_of(LatticePatterns& patterns, CellShape shape, const OccurringSignatures& signatures,
                                    const CompactCells& contours) {
  std::vector<KeyOfSignature> keys;
  for (std::size_t parity = 0; parity < 2; ++parity)
    for (std::size_t c = 0; c < patterns[parity].cells.size(); ++c) {
      LatticeCell& cell = patterns[parity].cells[c];
      if (cell.shape != shape) continue;
      std::vector<Index> ranks;
      for (const LatticePlace& corner : cell.corners)
        ranks.push_back(
            static_cast<Index>(std::count_if(cell.corners.begin(), cell.corners.end(),
                                             [&](const LatticePlace& other) { return is_before(other, corner); })));
      for (unsigned signature = 0; signature < cell.contours.size(); ++signature)
        if (signatures.of(parity, c)[signature].load(std::memory_order_relaxed))
          keys.push_back({&cell, signature, contours.key(signature, ranks.data(), {})});
    }
  return keys;
}

}  // namespace

void add_contours(LatticePatterns& patterns, const OccurringSignatures& signatures, Ambiguity ambiguity,
                  const WorkOptions& work) {
  std::map<CellShape, bool> shapes;  // and whether they are swept
  for (const LayerPattern& pattern : patterns)
    for (const LatticeCell& cell : pattern.cells) shapes[cell.shape] = cell.is_swept;
  double done = 0.0;
  const double each = 1.0 / static_cast<double>(shapes.size());
  for (const auto& [shape, is_swept] : shapes) {
    CompactCells contours(shape, ambiguity == Ambiguity::high, is_swept);
    const std::vector<KeyOfSignature> of_shape = keys_of(patterns, shape, signatures, contours);
    std::vector<CellKey> keys;
    for (const KeyOfSignature& of : of_shape) keys.push_back(of.key);
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    contours.build(std::move(keys), {work.threads, part_of(work.progress, done, done + each)});
    done += each;
    for (const KeyOfSignature& of : of_shape)
      add_contour(*of.cell, table_of(shape), of.signature, contours.contour(contours.variant(of.key)));
  }
}

}  // namespace tegl::detail
