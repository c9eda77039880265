// SPDX-License-Identifier: BSD-3-Clause
//
// The Delaunay cells of the triangular, the face-centred cubic, the body-centred cubic lattice and of D4, by layers.
// In a layer of parity p, the sample of an adjacent layer in the middle of the samples i and i + 1 of each shifted axis
// has the index i + p.
//
// Based on: J. H. Conway and N. J. A. Sloane, Sphere Packings, Lattices and Groups, chapter 4 (the cells of D4 are
// 16-cells, three for each sample; the cells of the face-centred cubic lattice D3 are octahedra and tetrahedra).
#include "complex/lattice_cells.hpp"

#include <initializer_list>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "tegl/error.hpp"

namespace tegl::detail {

namespace {

using Place = std::array<std::ptrdiff_t, 4>;

/// Collects cells; those with a corner outside of the array are left out.
class Collector {
 public:
  explicit Collector(const std::array<std::size_t, 4>& sizes) : sizes_(sizes) {}

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

  /// Calls work(place) for all samples, axis 0 fastest.
  template <class Work>
  void for_samples(const Work& work) const {
    for (Place at{}; at[3] < size(3); ++at[3])
      for (at[2] = 0; at[2] < size(2); ++at[2])
        for (at[1] = 0; at[1] < size(1); ++at[1])
          for (at[0] = 0; at[0] < size(0); ++at[0]) work(at);
  }

 private:
  [[nodiscard]] Index number(const Place& place) const {
    std::size_t result = 0;
    for (int a = 3; a >= 0; --a) result = result * sizes_[a] + static_cast<std::size_t>(place[a]);
    return static_cast<Index>(result);
  }

  std::array<std::size_t, 4> sizes_;
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

void add_triangles(Collector& cells) {
  cells.for_samples([&](const Place& at) {
    const Place next = moved(at, 0, 1);
    cells.add(CellType::triangle, {at, next, middle(at, 1, 1, 1u, 0)});
    cells.add(CellType::triangle, {at, next, middle(at, 1, -1, 1u, 0)});
  });
}

/// For each square of a layer, an octahedron with the samples above and below its middle, or a pyramid at the first and
/// last layer; for each edge of a layer, a tetrahedron with the edge of the next layer that crosses above its middle.
void add_face_centred(Collector& cells) {
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
void add_body_centred(Collector& cells) {
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
void add_d4(Collector& cells) {
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

}  // namespace

LatticeCells cells_of_lattice(Lattice lattice, const std::array<std::size_t, 4>& sizes) {
  Collector cells(sizes);
  switch (lattice) {
    case Lattice::triangular:
      add_triangles(cells);
      break;
    case Lattice::bcc:
      add_body_centred(cells);
      break;
    case Lattice::d4:
      add_d4(cells);
      break;
    default:
      add_face_centred(cells);
  }
  return cells.take();
}

}  // namespace tegl::detail
