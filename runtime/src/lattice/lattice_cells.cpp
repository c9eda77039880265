// SPDX-License-Identifier: BSD-3-Clause
//
// The Delaunay cells of the triangular, the face-centred cubic, the body-centred cubic lattice and of D4, by layers.
// In a layer of parity p, the sample of an adjacent layer in the middle of the samples i and i + 1 of each shifted axis
// has the index i + p.
//
// Based on: J. H. Conway and N. J. A. Sloane, Sphere Packings, Lattices and Groups, chapter 4 (the cells of D4 are
// 16-cells, three for each sample; the cells of the face-centred cubic lattice D3 are octahedra and tetrahedra).
#include "lattice/lattice_cells.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "complex/cell_groups.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

namespace {

using Place = LatticePlace;

/// Collects cells; those with a corner outside of the array are left out.
class Collector {
 public:
  Collector(const std::array<std::size_t, 4>& sizes, const std::array<std::size_t, 4>& margin, int layer_axis,
            const std::array<std::size_t, 2>& layers)
      : sizes_(sizes) {
    for (int a = 0; a < 4; ++a) {
      const bool is_layered = a == layer_axis;
      first_[a] = static_cast<std::ptrdiff_t>(std::max(margin[a], is_layered ? layers[0] : 0));
      end_[a] = static_cast<std::ptrdiff_t>(std::min(sizes[a] - margin[a], is_layered ? layers[1] : sizes[a]));
    }
  }

  [[nodiscard]] std::ptrdiff_t size(int axis) const { return static_cast<std::ptrdiff_t>(sizes_[axis]); }

  /// Returns whether the cell is in the array.
  bool add(CellType type, std::initializer_list<Place> corners) {
    for (const Place& place : corners)
      for (int a = 0; a < 4; ++a)
        if (place[a] < 0 || place[a] >= size(a)) return false;
    for (const Place& place : corners) cells_.corners.push_back(number(place));
    cells_.types.push_back(type);
    if (cells_.types.size() >= std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, "2^32 cells of a lattice or more; expected fewer");
    return true;
  }
  [[nodiscard]] LatticeCells take() { return std::move(cells_); }

  /// Calls work(place) for all samples that have cells, axis 0 fastest.
  template <class Work>
  void for_samples(const Work& work) const {
    Place at{};
    for (at[3] = first_[3]; at[3] < end_[3]; ++at[3])
      for (at[2] = first_[2]; at[2] < end_[2]; ++at[2])
        for (at[1] = first_[1]; at[1] < end_[1]; ++at[1])
          for (at[0] = first_[0]; at[0] < end_[0]; ++at[0]) work(at);
  }

 private:
  [[nodiscard]] Index number(const Place& place) const {
    std::size_t result = 0;
    for (int a = 3; a >= 0; --a) result = result * sizes_[a] + static_cast<std::size_t>(place[a]);
    return static_cast<Index>(result);
  }

  std::array<std::size_t, 4> sizes_;
  Place first_, end_;  ///< samples that have cells
  LatticeCells cells_;
};

/// The place `steps` further along an axis.
Place moved(Place place, int axis, std::ptrdiff_t steps) {
  place[axis] += steps;
  return place;
}

/// The sample of the layer `up` layers further in the middle of `place` and its next neighbours along all `axes`.
/// Along the other shifted axes it is half a step further, if `half` is 0, or back, if it is -1.
Place middle(Place place, int layer_axis, std::ptrdiff_t up, unsigned axes, std::ptrdiff_t half) {
  const std::ptrdiff_t parity = place[layer_axis] & 1;
  for (int a = 0; a < layer_axis; ++a) place[a] += parity + ((axes >> a & 1u) != 0 ? 0 : half);
  place[layer_axis] += up;
  return place;
}

template <class Cells>
void add_triangles(Cells& cells) {
  cells.for_samples([&](const Place& at) {
    const Place next = moved(at, 0, 1);
    cells.add(CellType::triangle, {at, next, middle(at, 1, 1, 1u, 0)});
    cells.add(CellType::triangle, {at, next, middle(at, 1, -1, 1u, 0)});
  });
}

/// For each square of a layer, an octahedron with the samples above and below its middle, or a pyramid at the first and
/// last layer; for each edge of a layer, a tetrahedron with the edge of the next layer that crosses above its middle.
template <class Cells>
void add_face_centred(Cells& cells) {
  cells.for_samples([&](const Place& at) {
    const Place x = moved(at, 0, 1), y = moved(at, 1, 1), both = moved(x, 1, 1);
    const Place above = middle(at, 2, 1, 3u, 0), below = middle(at, 2, -1, 3u, 0);
    if (!cells.add(CellType::octahedron, {at, both, x, y, below, above})) {
      cells.add(CellType::pyramid, {at, x, both, y, above});
      cells.add(CellType::pyramid, {at, x, both, y, below});
    }
    cells.add(CellType::tetrahedron, {at, x, middle(at, 2, 1, 1u, -1), middle(at, 2, 1, 1u, 0)});
    cells.add(CellType::tetrahedron, {at, y, middle(at, 2, 1, 2u, -1), middle(at, 2, 1, 2u, 0)});
  });
}

/// For each pair of neighbours in the odd layers, at a distance of one step or of two layers, the four tetrahedra with
/// an edge of the square of even layers between the two.
template <class Cells>
void add_body_centred(Cells& cells) {
  const auto add_ring = [&](const Place& from, const Place& to, const std::array<Place, 4>& ring) {
    for (std::size_t i = 0; i < 4; ++i) cells.add(CellType::tetrahedron, {from, to, ring[i], ring[(i + 1) % 4]});
  };
  cells.for_samples([&](const Place& at) {
    if (at[2] % 2 == 0) return;
    for (const unsigned axis : {0u, 1u})
      add_ring(at, moved(at, static_cast<int>(axis), 1),
               {middle(at, 2, -1, 1u << axis, -1), middle(at, 2, -1, 1u << axis, 0), middle(at, 2, 1, 1u << axis, 0),
                middle(at, 2, 1, 1u << axis, -1)});
    const Place corner = middle(at, 2, 1, 0u, -1);
    const Place x = moved(corner, 0, 1), y = moved(corner, 1, 1);
    add_ring(at, moved(at, 2, 2), {corner, x, moved(x, 1, 1), y});
  });
}

/// For each square of a layer, the 16-cell with the two samples of each adjacent layer beside its middle.
template <class Cells>
void add_d4(Cells& cells) {
  cells.for_samples([&](const Place& at) {
    for (int third = 0; third < 3; ++third) {
      const int a = third == 0 ? 1 : 0, b = third == 2 ? 1 : 2;
      const unsigned axes = 7u & ~(1u << third);
      const Place x = moved(at, a, 1), y = moved(at, b, 1);
      cells.add(CellType::cell16, {at, moved(x, b, 1), x, y, middle(at, 3, -1, axes, -1), middle(at, 3, 1, axes, 0),
                                   middle(at, 3, -1, axes, 0), middle(at, 3, 1, axes, -1)});
    }
  });
}

template <class Cells>
void add_cells(Lattice lattice, Cells& cells) {
  switch (lattice) {
    case Lattice::triangular:
      return add_triangles(cells);
    case Lattice::bcc:
      return add_body_centred(cells);
    case Lattice::d4:
      return add_d4(cells);
    default:
      add_face_centred(cells);
  }
}

/// Collects the cells of one sample in the inside, or of one at which there is no octahedron.
class PatternCollector {
 public:
  PatternCollector(Lattice lattice, int parity, bool at_ends, std::vector<PatternCell>& pattern)
      : layer_axis_(dimension(lattice) - 1), parity_(parity), at_ends_(at_ends), pattern_(pattern) {}

  bool add(CellType type, std::initializer_list<Place> corners) {
    if (at_ends_ && type == CellType::octahedron) return false;
    if (at_ends_ != (type == CellType::pyramid)) return true;
    PatternCell& cell = pattern_.emplace_back(PatternCell{type, parity_, at_ends_, {}});
    for (Place place : corners) {
      for (int a = 0; a < 4; ++a) place[a] -= at_[a];
      cell.corners.push_back(place);
    }
    return true;
  }
  template <class Work>
  void for_samples(const Work& work) {
    at_[layer_axis_] = parity_;
    work(at_);
  }

 private:
  int layer_axis_, parity_;
  bool at_ends_;
  Place at_{};
  std::vector<PatternCell>& pattern_;
};

}  // namespace

LatticeCells cells_of_lattice(Lattice lattice, const std::array<std::size_t, 4>& sizes,
                              const std::array<std::size_t, 4>& margin, const std::array<std::size_t, 2>& layers) {
  Collector cells(sizes, margin, dimension(lattice) - 1, layers);
  add_cells(lattice, cells);
  return cells.take();
}

std::vector<PatternCell> pattern_of_lattice(Lattice lattice) {
  std::vector<PatternCell> pattern;
  for (const bool at_ends : {false, true})
    for (int parity = 0; parity < 2; ++parity) {
      PatternCollector cells(lattice, parity, at_ends, pattern);
      add_cells(lattice, cells);
    }
  return pattern;
}

std::array<std::vector<LatticePlace>, 2> neighbours_of_lattice(Lattice lattice) {
  std::array<std::vector<LatticePlace>, 2> neighbours;
  const int layer_axis = dimension(lattice) - 1;
  const auto add = [&](int parity, const LatticePlace& from, const LatticePlace& to) {
    LatticePlace step;
    for (int a = 0; a < 4; ++a) step[a] = to[a] - from[a];
    auto& of = neighbours[static_cast<std::size_t>((parity + from[layer_axis]) & 1)];
    if (std::find(of.begin(), of.end(), step) == of.end()) of.push_back(step);
  };
  for (const PatternCell& cell : pattern_of_lattice(lattice)) {
    const CellKind& kind = *find_kind(cell.type);
    std::vector<LatticePlace> corners(cell.corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) corners[table_corner(kind, i)] = cell.corners[i];
    const tables::CellTable& table = table_of(kind.shape);
    for (std::uint32_t e = 0; e < table.edge_count; ++e) {
      const LatticePlace &from = corners[table.edges[2 * e]], &to = corners[table.edges[2 * e + 1]];
      add(cell.parity, from, to);
      add(cell.parity, to, from);
    }
  }
  for (auto& of : neighbours) std::sort(of.begin(), of.end());
  return neighbours;
}

}  // namespace tegl::detail
