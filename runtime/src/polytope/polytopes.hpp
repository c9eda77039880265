// SPDX-License-Identifier: BSD-3-Clause
//
// The polygons and polyhedra of a complex, by the faces around them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Most corners of a polygon or polyhedron: the bits of a signature.
inline constexpr std::size_t kPolytopeCorners = 64;

/// The faces of a polytope as rings of its corners. Along each ring of a polyhedron, seen from outside, the corners are
/// counterclockwise if the cell is not inverted; a polygon has one ring. A prism over a polyhedron (4D) has the rings
/// of the polyhedron, its base; corner v of the base is corner v at the lower end and corner v + base_corners() at the
/// upper one (PrismFacets has its facets).
class PolytopeShape {
 public:
  PolytopeShape() = default;
  /// `rings`: one face after the other; `ends`: the end of each face. The faces of a polyhedron must be checked.
  PolytopeShape(std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends);
  /// The prism over a polyhedron. Its edges: those of the base at the lower end, at the upper end, and between the ends
  /// by corner.
  [[nodiscard]] static PolytopeShape prism_over(PolytopeShape base);

  [[nodiscard]] int dim() const noexcept { return is_prism_ ? 4 : face_count() == 1 ? 2 : 3; }
  [[nodiscard]] std::size_t corner_count() const noexcept { return is_prism_ ? 2 * corner_count_ : corner_count_; }
  /// Number of corners, and of edges, of a polyhedron or of the base of a prism.
  [[nodiscard]] std::size_t base_corners() const noexcept { return corner_count_; }
  [[nodiscard]] std::size_t base_edges() const noexcept { return faces_of_.size(); }
  [[nodiscard]] std::size_t face_count() const noexcept { return ends_.size(); }
  /// Number of facets: edges of a polygon, faces of a polyhedron, polyhedra around a prism.
  [[nodiscard]] std::size_t facet_count() const noexcept {
    return is_prism_ ? face_count() + 2 : face_count() == 1 ? corner_count_ : face_count();
  }
  [[nodiscard]] std::span<const std::uint8_t> ring(std::size_t face) const noexcept { return part(rings_, face); }
  /// The edges of a face: edge i is between corners i and i + 1 of its ring.
  [[nodiscard]] std::span<const std::uint8_t> ring_edges(std::size_t face) const noexcept {
    return part(ring_edges_, face);
  }
  /// The ends of the edges.
  [[nodiscard]] const std::vector<std::array<std::uint8_t, 2>>& edges() const noexcept { return edges_; }
  /// The two faces at an edge, of a polyhedron or of the base of a prism.
  [[nodiscard]] const std::array<std::uint8_t, 2>& faces_at(std::size_t edge) const noexcept { return faces_of_[edge]; }
  /// Whether two different edges are in a common face, of a polyhedron or of the base of a prism.
  [[nodiscard]] bool share_a_face(std::size_t edge, std::size_t other) const noexcept {
    const auto &a = faces_of_[edge], &b = faces_of_[other];
    return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
  }

 private:
  [[nodiscard]] std::span<const std::uint8_t> part(const std::vector<std::uint8_t>& of, std::size_t face) const {
    const std::size_t begin = face == 0 ? 0 : ends_[face - 1];
    return {of.data() + begin, ends_[face] - begin};
  }

  std::size_t corner_count_ = 0;  ///< of the base
  bool is_prism_ = false;
  std::vector<std::uint8_t> rings_, ring_edges_;
  std::vector<std::uint16_t> ends_;
  std::vector<std::array<std::uint8_t, 2>> edges_, faces_of_;  ///< by edge
};

/// The rings of the faces of the prism over a polygon, and where each ends: seen from outside as the polygon, the base
/// is clockwise, the top counterclockwise. Corner v of the base is below corner `corners` + v.
[[nodiscard]] std::pair<std::vector<std::uint8_t>, std::vector<std::uint16_t>> prism_over_polygon(std::size_t corners);

/// The polygons (of a 2D complex), polyhedra (3D) or prisms over polyhedra (4D) of a complex, in the order of the
/// input.
class Polytopes {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return shape_of_.size(); }
  /// The dimension of the cells; 3 if there are none.
  [[nodiscard]] int dim() const noexcept { return shapes_.empty() ? 3 : shapes_[0].dim(); }
  [[nodiscard]] const PolytopeShape& shape(std::size_t cell) const noexcept { return shapes_[shape_of_[cell]]; }
  /// The points at the corners of a cell.
  [[nodiscard]] const Index* cell(std::size_t i) const noexcept { return corners_.data() + first_[i]; }
  [[nodiscard]] std::span<const Index> points_of(std::size_t i) const noexcept {
    return {cell(i), shape(i).corner_count()};
  }
  /// Number of different shapes.
  [[nodiscard]] std::size_t shape_count() const noexcept { return shapes_.size(); }

  /// Appends a polygon with its corners around it.
  void add_polygon(std::span<const Index> corners);
  /// Appends a polyhedron with the rings of its faces, checked, in the numbers of its corners.
  void add_polyhedron(std::span<const Index> corners, std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends);
  /// The prisms over the polygons or polyhedra in the intervals between layers of `points` points each.
  [[nodiscard]] Polytopes in_time(std::size_t points, std::size_t intervals) const;
  /// Of prisms over polyhedra: number of polyhedra. Prism c + k * base_count() is over polyhedron c in interval k.
  [[nodiscard]] std::size_t base_count() const noexcept { return is_entangled_.size(); }
  /// The polyhedra, ascending, that have corners in common with another one which are not all in one face: both cells
  /// may have the same diagonals between edges.
  [[nodiscard]] const std::vector<Index>& entangled() const noexcept { return entangled_; }
  [[nodiscard]] bool is_entangled(std::size_t prism) const noexcept { return is_entangled_[prism % base_count()]; }
  /// The polyhedron under a prism if it is entangled.
  [[nodiscard]] std::optional<Index> entangled_base(std::size_t prism) const noexcept {
    return is_entangled(prism) ? std::optional(static_cast<Index>(prism % base_count())) : std::nullopt;
  }
  /// Replaces each point p by number[p].
  void renumber(std::span<const Index> number);

  /// Number of parts of all cells, the units of parallel work.
  [[nodiscard]] std::size_t part_count() const noexcept { return (size() + kCellsOfPart - 1) / kCellsOfPart; }
  /// Calls visit(p, q) for the edges of the cells in a part.
  template <class Visit>
  void for_each_edge(std::size_t part, const Visit& visit) const {
    for (std::size_t c = kCellsOfPart * part; c < std::min(size(), kCellsOfPart * (part + 1)); ++c)
      for (const auto& [a, b] : shape(c).edges()) visit(cell(c)[a], cell(c)[b]);
  }

 private:
  static constexpr std::size_t kCellsOfPart = 4096;
  using Lattice = std::pair<std::vector<std::uint8_t>, std::vector<std::uint16_t>>;
  void add(std::span<const Index> corners, Lattice lattice);
  [[nodiscard]] Polytopes solids_in_time(std::size_t points, std::size_t intervals) const;
  [[nodiscard]] std::vector<Index> find_entangled() const;

  std::vector<PolytopeShape> shapes_;
  std::map<Lattice, std::uint32_t> numbers_;  ///< of the shapes
  std::vector<std::uint32_t> shape_of_;       ///< by cell
  std::vector<std::uint64_t> first_;          ///< by cell: its first corner in corners_
  std::vector<Index> corners_;
  std::vector<Index> entangled_;  ///< of prisms over polyhedra
  std::vector<bool> is_entangled_;
};

/// Whether each polytope is oriented against its rings: by the sign of its volume or area. Flat ones are as the others
/// if these all have one sign, otherwise not inverted. Bit c % 64 of word c / 64.
template <int N>
[[nodiscard]] std::vector<std::uint64_t> find_polytope_signs(const Polytopes& polytopes,
                                                             const std::vector<std::array<double, N>>& points);

}  // namespace tegl::detail
