// SPDX-License-Identifier: BSD-3-Clause
//
// The cut of one simplex by a hyperplane, before its points have numbers and coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Key of a point of a cut: (lower vertex << 32) | upper vertex of its edge; for a vertex on the hyperplane both are
/// that vertex.
using PointKey = std::uint64_t;

constexpr PointKey edge_point(Index lower, Index upper) { return (PointKey{lower} << 32) | upper; }
constexpr PointKey vertex_point(Index v) { return edge_point(v, v); }
constexpr Index lower_end(PointKey key) { return static_cast<Index>(key >> 32); }
constexpr Index upper_end(PointKey key) { return static_cast<Index>(key & 0xffffffffu); }
constexpr bool is_vertex_point(PointKey key) { return lower_end(key) == upper_end(key); }

/// Cut of one simplex: two points (N = 3), three or four in cyclic order (N = 4), or the four of a tetrahedron (N = 5),
/// of which a simplex may have several.
struct Piece {
  std::array<PointKey, 4> points;
  int count;
  Index simplex;  ///< the simplex that was cut
};

/// An incidence of a point and a piece.
struct Corner {
  PointKey key;
  std::size_t at;  ///< 4 * piece + position of the point in it
};

/// All incidences sorted by key, then by piece. Threads: 0 for all of the machine. O(c) for c pieces.
Buffer<Corner> corners_by_point(std::span<const Piece> pieces, unsigned threads);

/// The keys, ascending, of the points at which the pieces do not form one path (segments, `dim` 1) or one fan
/// (polygons, 2), or at which the link of the tetrahedra (3) is neither a sphere nor a disc; also those that have an
/// edge in more than two polygons, or a triangle in more than two tetrahedra. `corners`: of these pieces. O(c) for c
/// pieces if few meet at each point.
std::vector<PointKey> nonmanifold_points(std::span<const Piece> pieces, std::span<const Corner> corners, int dim);

}  // namespace tegl::detail
