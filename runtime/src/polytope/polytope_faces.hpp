// SPDX-License-Identifier: BSD-3-Clause
//
// The faces of polygons, polyhedra and 4D polytopes, in memory that others keep.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tegl::detail {

/// Most corners of a polytope: the bits of a signature.
inline constexpr std::size_t kPolytopeCorners = 64;

struct PolytopeSolids;

/// The faces of a polytope as rings of its corners. Along each ring of a polyhedron, seen from outside, the corners are
/// counterclockwise if the cell is not inverted; a polygon has one ring. A prism over a polyhedron (4D) has the rings
/// of the polyhedron, its base; corner v of the base is corner v at the lower end and corner v + base_corners() at the
/// upper one. Another 4D polytope has no rings, but polyhedra as facets (solid_facets.hpp, which lists those of prisms,
/// too).
class PolytopeFaces {
 public:
  using Pair = std::array<std::uint8_t, 2>;

  constexpr PolytopeFaces() = default;
  /// `rings`: one face after the other, with the edge from each corner to the next in `ring_edges`; `ends`: the end of
  /// each face; `edges`: their ends; `faces_of`: the faces at each edge. The arrays must outlive this object. If
  /// `is_prism`, they belong to the polyhedron over which it is, with all edges of the prism in `edges`: the base's at
  /// the lower end, at the upper end, and between the ends by corner.
  constexpr PolytopeFaces(std::size_t corners, std::span<const std::uint8_t> rings,
                          std::span<const std::uint8_t> ring_edges, std::span<const std::uint16_t> ends,
                          std::span<const Pair> edges, std::span<const Pair> faces_of, bool is_prism = false)
      : corner_count_(corners),
        is_prism_(is_prism),
        rings_(rings),
        ring_edges_(ring_edges),
        ends_(ends),
        edges_(edges),
        faces_of_(faces_of) {}
  /// A 4D polytope with these edges and facets. `solids` and the array must outlive this object.
  constexpr PolytopeFaces(std::size_t corners, std::span<const Pair> edges, const PolytopeSolids& solids)
      : corner_count_(corners), edges_(edges), solids_(&solids) {}

  [[nodiscard]] constexpr int dim() const noexcept {
    return is_prism_ || solids_ != nullptr ? 4 : face_count() == 1 ? 2 : 3;
  }
  [[nodiscard]] constexpr std::size_t corner_count() const noexcept {
    return is_prism_ ? 2 * corner_count_ : corner_count_;
  }
  /// Number of corners, and of edges, of a polyhedron or of the base of a prism.
  [[nodiscard]] constexpr std::size_t base_corners() const noexcept { return corner_count_; }
  [[nodiscard]] constexpr std::size_t base_edges() const noexcept { return faces_of_.size(); }
  [[nodiscard]] constexpr std::size_t face_count() const noexcept { return ends_.size(); }
  /// Number of facets: edges of a polygon, faces of a polyhedron, polyhedra around a 4D polytope.
  [[nodiscard]] std::size_t facet_count() const noexcept;
  /// The facets of a 4D polytope that is no prism; otherwise null.
  [[nodiscard]] constexpr const PolytopeSolids* solids() const noexcept { return solids_; }
  /// All rings, and where each ends.
  [[nodiscard]] constexpr std::span<const std::uint8_t> rings() const noexcept { return rings_; }
  [[nodiscard]] constexpr std::span<const std::uint16_t> ends() const noexcept { return ends_; }
  [[nodiscard]] constexpr std::span<const std::uint8_t> ring(std::size_t face) const noexcept {
    return part(rings_, face);
  }
  /// The edges of a face: edge i is between corners i and i + 1 of its ring.
  [[nodiscard]] constexpr std::span<const std::uint8_t> ring_edges(std::size_t face) const noexcept {
    return part(ring_edges_, face);
  }
  /// The ends of the edges.
  [[nodiscard]] constexpr std::span<const Pair> edges() const noexcept { return edges_; }
  /// The two faces at an edge, of a polyhedron or of the base of a prism.
  [[nodiscard]] constexpr const Pair& faces_at(std::size_t edge) const noexcept { return faces_of_[edge]; }
  /// Whether two different edges are in a common face, of a polyhedron or of the base of a prism.
  [[nodiscard]] constexpr bool share_a_face(std::size_t edge, std::size_t other) const noexcept {
    const auto &a = faces_of_[edge], &b = faces_of_[other];
    return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
  }

 private:
  [[nodiscard]] constexpr std::span<const std::uint8_t> part(std::span<const std::uint8_t> of,
                                                             std::size_t face) const noexcept {
    const std::size_t begin = face == 0 ? 0 : ends_[face - 1];
    return of.subspan(begin, ends_[face] - begin);
  }

  std::size_t corner_count_ = 0;  ///< of the base
  bool is_prism_ = false;
  std::span<const std::uint8_t> rings_, ring_edges_;
  std::span<const std::uint16_t> ends_;
  std::span<const Pair> edges_, faces_of_;  ///< by edge
  const PolytopeSolids* solids_ = nullptr;
};

}  // namespace tegl::detail
