// SPDX-License-Identifier: BSD-3-Clause
//
// What a hyperplane cuts out of one simplex, before points have numbers and places.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// A point of a cut: (lower vertex << 32) | upper vertex of the edge that it lies on, or twice a vertex on the
/// hyperplane.
using PointKey = std::uint64_t;

constexpr PointKey edge_point(Index lower, Index upper) { return (PointKey{lower} << 32) | upper; }
constexpr PointKey vertex_point(Index v) { return edge_point(v, v); }
constexpr Index lower_end(PointKey key) { return static_cast<Index>(key >> 32); }
constexpr Index upper_end(PointKey key) { return static_cast<Index>(key & 0xffffffffu); }
constexpr bool is_vertex_point(PointKey key) { return lower_end(key) == upper_end(key); }

/// The cut of one simplex: two points (N = 3), or three or four in cyclic order (N = 4).
struct Piece {
  std::array<PointKey, 4> points;
  int count = 0;
  Index simplex = 0;  ///< the simplex
};

/// A point of a piece, as seen from the point.
struct Corner {
  PointKey key;
  std::size_t at;  ///< 4 times the piece, plus the point's place in it
};

/// All points of all pieces in the order of their keys, those of one point in the order of the pieces. `most`: no
/// vertex number is larger. O(c) for c pieces.
std::vector<Corner> corners_by_point(std::span<const Piece> pieces, Index most);

/// The points, ascending, around which the pieces are not one fan (of polygons) or one path (of segments), or from
/// which an edge goes out that more than two polygons share. `corners`: of these pieces. O(c) for c pieces if few meet
/// at each point.
std::vector<PointKey> pinched_points(std::span<const Piece> pieces, std::span<const Corner> corners);

}  // namespace tegl::detail
