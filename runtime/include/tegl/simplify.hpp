// SPDX-License-Identifier: BSD-3-Clause
//
// The same contour with fewer simplices, and how far it is from what it was.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/grid.hpp"
#include "tegl/hyperplane.hpp"

namespace tegl {

/// What is removed, and in which order. All but `fast` contract edges, and never change what kind of manifold it is.
enum class SimplifyMethod {
  /// Edges, ordered by the sum of squared distances of the place that both ends move to from the hyperplanes of all
  /// simplices that were there; that place has the least such sum. The best contour for its size.
  quadric,
  /// Simplices, by curvature (Turk 1992) times the square of the longest edge: each is contracted to one point in its
  /// middle. The thesis (M. Liversage, 1994, 8.3.8 to 8.3.13) removes polygons, untriangulated, by curvature alone.
  facets,
  /// Vertices, ordered by their distance from the hyperplane of their neighbourhood: each is contracted into a
  /// neighbour, so that the remaining vertices are vertices of the original. The distance is that of W. Schroeder, J.
  /// Zarge and W. Lorensen, Decimation of triangle meshes, 1992, who (like the thesis, 8.3.14) remove the vertex and
  /// triangulate the gap anew.
  vertices,
  /// Triangles alone, by the library meshoptimizer, where tegl was built with it: several times as fast. May leave a
  /// manifold or may not: its result is checked.
  fast,
};

/// What may happen to the border of an open contour.
enum class SimplifyBorder {
  fixed,   ///< nothing: it keeps all its simplices
  within,  ///< its vertices may be removed, or move along it. Corners of the planes below are kept.
};

/// The 2 N hyperplanes that the border of an image lies in: what keeps caps (ExtractOptions::close) in it, also where
/// the grid has a world map.
template <int N>
requires DimensionBetween<N, 2, 4> std::vector<Hyperplane<N>> border_planes(const Grid<N>& grid);

/// At least one of `count`, `ratio` and `max_error` has to be given (or, for facets, `max_curvature`); with several,
/// the first that is reached ends it. (A count that can be reached within max_error is, with the error that it has
/// alone.)
template <int N>
requires DimensionBetween<N, 2, 4>
struct SimplifyOptions {
  SimplifyMethod method = SimplifyMethod::quadric;  ///< what is removed, in which order
  std::optional<std::uint64_t> count = {};          ///< as few simplices as this
  std::optional<double> ratio = {};                 ///< of the simplices that there are, in [0, 1]
  /// The largest distance between any point of one of the two contours and the other one. The result keeps it by its
  /// bound: where the bound is too large for a part of the contour, that part is simplified anew with more care. 0
  /// leaves the contour as it is. At least the error that the contour has from an earlier simplification.
  std::optional<double> max_error = {};
  /// facets: no facet of more curvature (1 / radius) than this is removed.
  double max_curvature = std::numeric_limits<double>::infinity();
  SimplifyBorder border = SimplifyBorder::fixed;  ///< what happens to an open contour's border
  /// Vertices that lie in one of these hyperplanes stay in it, and those in several stay in all. Up to 20. To these are
  /// added the sides of the contour's bounding box that whole simplices, or parts of the border, lie in.
  std::vector<Hyperplane<N>> planes = {};
  /// Distances and curvatures are those after coordinates were multiplied by these: what makes axes of different units
  /// comparable (a month and a degree).
  std::array<double, N> scale = all_one();
  /// Whether the result gets its error bounds: the vertex attribute "simplification_error". Is done anyway if
  /// max_error is given. With a count or ratio alone, the least largest error is searched for with which the count is
  /// reached, in mostly 5 to 35 rounds, 171 at most (but for `fast`); without bounds there is one round, with up to 40
  /// times the error.
  bool measure = true;
  /// fast: hand out what is no manifold, too.
  bool allow_nonmanifold = false;
  unsigned threads = 0;    ///< for the bounds; 0: all that the machine has. The result is the same, byte by byte.
  Progress progress = {};  ///< see Progress

 private:
  static constexpr std::array<double, N> all_one() {
    std::array<double, N> result{};
    result.fill(1.0);
    return result;
  }
};

/// What a simplification ended at.
enum class SimplifyEnd {
  count,   ///< as few simplices as were asked for
  error,   ///< max_error (or max_curvature): what is left would go beyond it
  shape,   ///< more simplices than were asked for: what is left may not go, for topology, border, planes or shapes
  rounds,  ///< no round kept max_error: the result is the contour as it was
};

/// What a simplification did.
struct SimplifyStats {
  std::uint64_t simplices_before = 0;  ///< of the contour given
  std::uint64_t simplices_after = 0;   ///< of the result
  std::uint64_t vertices_before = 0;   ///< of the contour given
  std::uint64_t vertices_after = 0;    ///< of the result
  /// No point of the original is farther than this from the result, and none of the result from the original; in units
  /// of `scale`. None if not measured.
  std::optional<double> error_of_original = {};
  std::optional<double> error_of_result = {};  ///< likewise, from the result to the original
  SimplifyEnd end = SimplifyEnd::count;        ///< why it has as many simplices as it has
  unsigned rounds = 0;                         ///< how often it was simplified, to keep max_error or for a small error
  double simplify_seconds = 0;                 ///< time to remove simplices
  double measure_seconds = 0;                  ///< time to bound the error

  /// The larger of the two: a bound of the Hausdorff distance.
  [[nodiscard]] std::optional<double> error() const {
    if (!error_of_original || !error_of_result) return std::nullopt;
    return *error_of_original > *error_of_result ? *error_of_original : *error_of_result;
  }
};

/// Fewer simplices, the same topology: components, Euler characteristic, orientation and border are those of the
/// contour. An edge is contracted only if the link condition holds (Dey, Edelsbrunner, Guha, Nekhayev 1999), no normal
/// turns by 78 degrees or more, and no simplex becomes flat, or worse than the worst around it. Sheets that are nearer
/// to each other than the error may come to intersect. N = 2, 3, 4; Real: float or double.
///
/// Normals and vertex attributes are interpolated where vertices move; simplex attributes are those of the simplices
/// that are left. The attribute "simplification_error" of a vertex: every point of the original that was matched with a
/// simplex is within the largest one of that simplex's vertices, and every point of the simplex is so near to the
/// original. Its unit is that of the axes, or "scale 1,1,0.5" where distances were those after a scale. If the contour
/// has this attribute, from an earlier simplification, its largest value is added, by the axis that grew most from that
/// scale to this one; so the bound holds, and a smaller max_error is refused. (scale_axes leaves attributes: after it,
/// the earlier bound is another's.)
///
/// A result may have more simplices than was asked for: closed contours need a few, and what the conditions forbid
/// stays. It is the same for any number of threads.
///
/// Errors: InvalidArgument (options; an earlier error that is negative, not finite or above max_error, or whose unit is
/// a scale of other numbers than N above 0; a vertex number out of range, a coordinate that is not finite; `fast` for
/// other than triangles, without meshoptimizer, or where it leaves no triangle at all), UnsupportedData (no manifold: a
/// face in three simplices, a repeated vertex; for `fast` also a pinched vertex, faces of two orientations and
/// triangles with the same corners; or the result of `fast` is none), Cancelled.
///
/// Time: O(S log S), about 5 microseconds for each triangle and 10 for each tetrahedron (facets, vertices: two to three
/// times that); the error as long for triangles, 8 to 20 microseconds for each tetrahedron and 60 to 130 for each of
/// the result, in each of up to 12 rounds if there is a `max_error`, and of mostly 5 to 35 if there is a count (a third
/// of those without the error); with both, in as many as for each. If no round keeps max_error, the result is the
/// contour itself, and SimplifyStats::end says so. Memory: about 200 bytes for each simplex.
template <int N, class Real>
requires DimensionBetween<N, 2, 4> Contour<N, Real> simplify(const Contour<N, Real>& contour,
                                                             const SimplifyOptions<N>& options,
                                                             SimplifyStats* stats = nullptr);

/// A `scale` for a contour whose axes have different units: the mean extent of a simplex along an axis of another unit
/// than the first counts as that along the first axis; all others, and what has no extent, count as they are. N = 2, 3,
/// 4; Real: float or double. O(S).
template <int N, class Real>
requires DimensionBetween<N, 2, 4> std::array<double, N> automatic_scale(const Contour<N, Real>& contour);

/// Whether SimplifyMethod::fast is there.
bool has_fast_simplify() noexcept;

}  // namespace tegl
