// SPDX-License-Identifier: BSD-3-Clause
//
// Is the link of a vertex of a 4-manifold a 3-sphere or a 3-ball?
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// A complex of tetrahedra at a time, with all of its faces. Keeps its memory from one to the next.
class LinkOfTetrahedra {
 public:
  using Piece = std::array<Index, 4>;

  /// Vertices of a tetrahedron differ. O(n log n).
  void load(std::span<const Piece> pieces);

  /// Edges both of whose ends are larger than `v`.
  [[nodiscard]] std::uint64_t edges_above(Index v) const;

  /// True only if it is shown. A sphere or ball that resists some tries to collapse is not (none is known to come from
  /// a contour). O(n) for each try, of which the first is nearly always enough.
  [[nodiscard]] bool is_sphere_or_ball();

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Triangle {
    std::array<std::uint32_t, 2> pieces{kNone, kNone};
    std::array<std::uint32_t, 3> edges{};
    std::uint32_t of = 0;  ///< how many pieces
  };

  void number_vertices(std::span<const Piece> pieces);
  void number_edges();
  void number_triangles();
  /// Every triangle in one or two pieces, all in one part, the links of edges and vertices connected.
  bool hangs_together();
  /// Given that: whether the links of vertices are spheres or discs, and the Euler characteristic is right.
  [[nodiscard]] bool has_right_counts() const;
  bool collapses(unsigned seed);

  std::vector<Index> vertices_;                          ///< ascending
  std::vector<std::array<std::uint32_t, 4>> corners_;    ///< by piece
  std::vector<std::array<std::uint32_t, 6>> edges_;      ///< by piece, of corners 01 02 03 12 13 23
  std::vector<std::array<std::uint32_t, 4>> triangles_;  ///< by piece, opposite of each corner
  std::vector<std::array<std::uint32_t, 2>> ends_;       ///< by edge
  std::vector<Triangle> faces_;
  std::vector<std::array<std::uint64_t, 2>> keys_;
  std::vector<std::uint32_t> parent_, free_, around_;
  std::vector<bool> gone_, open_;
};

}  // namespace tegl::detail
