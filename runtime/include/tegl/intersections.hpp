// SPDX-License-Identifier: BSD-3-Clause
//
// Self-intersections of contours: all pairs of simplices with a common point outside of their common face, by
// exact arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// A regular grid of tiles, to count those that contain intersections.
template <int N>
requires DimensionBetween<N, 2, 4>
struct IntersectionTiles {
  std::array<double, N> size = detail::all_one<N>();  ///< extent of a tile along each axis, positive
  std::array<double, N> origin{};                     ///< a corner of one of the tiles
};

/// Options of `find_intersections`.
template <int N>
requires DimensionBetween<N, 2, 4>
struct IntersectionOptions {
  /// Maximum number of pairs in Intersections::pairs. All pairs are found and counted anyway; only the listed ones take
  /// memory.
  std::size_t most_listed = std::numeric_limits<std::size_t>::max();
  bool deepest_first = false;  ///< lists pairs by descending depth, pairs of equal depth by numbers; else by numbers
  /// If given, tiles are counted. For an image without a world map: its grid's spacing and the position of its first
  /// sample.
  std::optional<IntersectionTiles<N>> tiles = {};
  WorkOptions work = {};  ///< threads and progress
};

/// Two simplices that intersect.
template <int N>
requires DimensionBetween<N, 2, 4>
struct IntersectingPair {
  Index first = 0;                ///< number of a simplex
  Index second = 0;               ///< number of the other, greater than `first`
  std::array<double, N> place{};  ///< a common point outside of their common face, rounded
  /// The smallest distance by which one of the simplices has to be moved, in any direction, until a hyperplane
  /// separates them or contains both. 0 if they touch, or lie in one hyperplane. Rounded: a depth below about 1e-13 of
  /// the simplices' size may be 0. Always finite.
  double depth = 0.0;
};

/// The result of `find_intersections`.
template <int N>
requires DimensionBetween<N, 2, 4>
struct Intersections {
  std::uint64_t simplices = 0;               ///< number of all simplices
  std::uint64_t flat = 0;                    ///< simplices of measure zero, exactly; not tested, in no pair
  std::uint64_t pair_count = 0;              ///< number of intersecting pairs
  std::uint64_t intersecting = 0;            ///< number of simplices in at least one pair
  std::vector<IntersectingPair<N>> pairs{};  ///< the first `most_listed`, by `first`, then `second`, or deepest first
  double depth = 0.0;                        ///< the maximum depth of all pairs
  std::uint64_t tiles = 0;                   ///< tiles that contain the centroid of a simplex; 0 if not requested
  std::uint64_t tiles_hit = 0;               ///< tiles that contain the centroid of a simplex in a pair

  /// Whether no two simplices intersect and none is flat: flat simplices are not tested, so they may hide
  /// intersections.
  [[nodiscard]] bool is_embedded() const noexcept { return pair_count == 0 && flat == 0; }
};

/// Finds the pairs of simplices that intersect: segments in 2D, triangles in 3D, tetrahedra in 4D. Two simplices
/// intersect if they have a common point outside of their common face, which is the convex hull of the vertices whose
/// numbers both have. (Without common vertices any common point counts.) In particular these pairs count:
/// - simplices that touch in one point, for example at two vertices of equal position but different number;
/// - simplices that overlap within one hyperplane, also beside a common facet;
/// - two simplices with the same N vertices.
///
/// Flat simplices have no interior: their vertices lie in an (N-2)-dimensional plane, or one is repeated. They are
/// counted in `flat` and are not tested for intersections, although they may pass through others.
///
/// The result is exact for the coordinates as stored, float or double: signs of determinants that rounding errors could
/// change are computed with integers. For triangles the pairs equal those of CGAL's
/// `Polygon_mesh_processing::self_intersections`, whose pairs of a triangle with itself are flat triangles.
///
/// Method. Stars of vertices that project injectively along some direction have no intersecting pair. The other
/// candidates are pairs whose bounding boxes meet. They are disjoint if a hyperplane through their common vertices
/// separates the others, which is tested with bounds of all rounding errors; the rest is decided by linear programming
/// in integers.
///
/// Errors: InvalidArgument (a vertex number out of range, a coordinate that is not finite, tiles whose size is not
/// positive), Cancelled. Time: O(S log S + candidates). Memory: about 150 bytes per simplex. The result is the same for
/// any number of threads. Thread-safe. N = 2, 3, 4; Real: float or double.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Intersections<N> find_intersections(const Contour<N, Real>& contour,
                                                  const IntersectionOptions<N>& options = {});

}  // namespace tegl
