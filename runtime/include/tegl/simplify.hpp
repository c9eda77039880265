// SPDX-License-Identifier: BSD-3-Clause
//
// Contours with fewer simplices, and guaranteed bounds of the error.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/grid.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Which elements are removed, and in which order. All methods except `fast` contract edges and preserve the manifold's
/// topology.
enum class SimplifyMethod {
  /// Edges, by quadric error: both ends move to the point with the smallest sum of squared distances from the
  /// hyperplanes of all simplices around them; edges are ordered by this sum. Gives the best contour for its size.
  quadric,
  /// Simplices, ordered by curvature (Turk 1992) times the square of the longest edge; each is contracted to a point in
  /// its middle. The thesis (M. Liversage, 1994, 8.3.8 to 8.3.13) removes polygons without triangulation, by curvature
  /// only.
  facets,
  /// Vertices, ordered by their distance from the hyperplane of their neighbourhood; each is contracted into a
  /// neighbour, so remaining vertices are vertices of the original. The distance is from W. Schroeder, J. Zarge and W.
  /// Lorensen, Decimation of triangle meshes, 1992, who (like the thesis, 8.3.14) remove the vertex and triangulate the
  /// gap anew.
  vertices,
  /// Triangles only, by the library meshoptimizer, if tegl was built with it: several times as fast. The result may be
  /// non-manifold, so it is checked.
  fast,
};

/// How the boundary of an open contour is treated.
enum class SimplifyBorder {
  fixed,   ///< keeps all boundary simplices
  within,  ///< boundary vertices may be removed or move along the boundary; corners of `planes` are kept
};

/// The 2 N hyperplanes of an image's border, for SimplifyOptions::planes: they keep caps (ExtractOptions::close) in the
/// border, also if the grid has a world map.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] std::vector<Hyperplane<N>> border_planes(const Grid<N>& grid);

/// Options of `simplify`. At least one of `count`, `ratio` and `max_error` is required (or, for facets,
/// `max_curvature`); simplification ends at the first one that is reached. A count that is reachable within max_error
/// is reached with the error that it has without max_error.
template <int N>
requires DimensionBetween<N, 2, 4>
struct SimplifyOptions {
  SimplifyMethod method = SimplifyMethod::quadric;  ///< elements removed, and their order
  std::optional<std::uint64_t> count = {};          ///< target number of simplices
  std::optional<double> ratio = {};                 ///< target number as a fraction of the input, in [0, 1]
  /// Maximum distance of any point of either contour from the other contour. Guaranteed by an error bound: a part of
  /// the contour whose bound is too large is simplified again with a smaller error. 0 leaves the contour unchanged.
  /// Must not be less than the error that the contour has from an earlier simplification.
  std::optional<double> max_error = {};
  /// Only for `facets`, InvalidArgument for other methods: maximum curvature (1 / radius) of removed facets.
  double max_curvature = std::numeric_limits<double>::infinity();
  SimplifyBorder border = SimplifyBorder::fixed;  ///< treatment of an open contour's boundary
  /// Vertices in one of these hyperplanes stay in it; vertices in several stay in all. At most 20. Sides of the
  /// contour's bounding box that contain whole simplices or parts of the boundary are added. `fast` ignores them.
  std::vector<Hyperplane<N>> planes = {};
  /// Coordinates are multiplied by these factors before distances and curvatures are computed, to make axes of
  /// different units comparable (a month and a degree).
  std::array<double, N> scale = detail::all_one<N>();
  /// Whether to compute error bounds, as vertex attribute "simplification_error". Always done if max_error is given.
  /// With count or ratio only, the smallest maximum error that reaches the count is searched for, usually in 5 to 35
  /// rounds, at most 171. Exceptions are `fast`, and `quadric` beyond 50 000 simplices: one round, in the order of the
  /// mean squared distance. Without bounds there is one round for all methods. One round has up to 40 times the error.
  bool measure = true;
  /// Only for `fast`, InvalidArgument for other methods: accept non-manifold results.
  bool allow_nonmanifold = false;
  /// Refuses every contraction whose simplices would intersect each other or others (tegl/intersections.hpp), by exact
  /// tests. A contour without intersecting pairs keeps this property. Simplices that intersect already are not
  /// contracted unless that ends their intersections. InvalidArgument for `fast`. Takes two to five times as long.
  bool keep_embedded = false;
  WorkOptions work = {};  ///< threads (for bounds and parts of `quadric`; if several, for moments one more), progress
};

/// Why a simplification ended.
enum class SimplifyEnd {
  count,   ///< the requested number of simplices is reached
  error,   ///< max_error (or max_curvature) would be exceeded
  shape,   ///< topology, boundary, planes, shape conditions or keep_embedded forbid all further removals
  rounds,  ///< no round kept max_error: the result is the original contour
};

/// Counts, errors and times of one simplification.
struct SimplifyStats {
  std::uint64_t simplices_before = 0;  ///< of the original
  std::uint64_t simplices_after = 0;   ///< of the result
  std::uint64_t vertices_before = 0;   ///< of the original
  std::uint64_t vertices_after = 0;    ///< of the result
  /// Upper bound of the distance of any point of the original from the result, in units of `scale`. Empty if not
  /// measured.
  std::optional<double> error_of_original = {};
  std::optional<double> error_of_result = {};  ///< the same from the result to the original
  SimplifyEnd end = SimplifyEnd::count;        ///< why it ended
  unsigned rounds = 0;          ///< number of simplifications, to keep max_error or to minimise the error
  double simplify_seconds = 0;  ///< time to remove simplices
  double measure_seconds = 0;   ///< time to bound the error

  /// The larger of the two errors: a bound of the Hausdorff distance.
  [[nodiscard]] std::optional<double> error() const {
    if (!error_of_original || !error_of_result) return std::nullopt;
    return *error_of_original > *error_of_result ? *error_of_original : *error_of_result;
  }
};

/// The result of `simplify`.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
struct Simplification {
  Contour<N, Real> contour = {};  ///< the contour with fewer simplices
  SimplifyStats stats = {};       ///< how it was reached, and its error
};

/// Reduces the number of simplices and preserves the topology: components, Euler characteristic, orientation and
/// boundary. An edge is contracted only if the link condition holds (Dey, Edelsbrunner, Guha, Nekhayev 1999), no normal
/// turns by 78 degrees or more, and no simplex becomes flat or worse than the worst one around the edge. Parts closer
/// to each other than the error may intersect afterwards, unless `keep_embedded` is set. N = 2, 3, 4; Real: float or
/// double.
///
/// Normals and vertex attributes are interpolated where vertices move; remaining simplices keep their attributes. The
/// vertex attribute "simplification_error" is a bound: a point of the original that was matched with a simplex is at
/// most as far from it as the largest value at the simplex's vertices, and so is every point of the simplex from the
/// original. Its unit is the unit of the axes, or "scale 1,1,0.5" for scaled distances. If the input has this attribute
/// from an earlier simplification, its largest value is added, multiplied by the largest ratio of the two scales over
/// the axes. So the bound stays valid, and a smaller max_error is refused. (scale_axes does not change attributes:
/// after it, an earlier bound is not valid.)
///
/// The result may have more simplices than requested: closed contours need a few, and the conditions may forbid
/// removals. It is the same for any number of threads.
///
/// Errors: InvalidArgument (options; an earlier error that is negative, not finite or above max_error, or whose unit is
/// not a scale of N positive numbers; a vertex number out of range, a coordinate that is not finite; `fast` for other
/// than triangles, without meshoptimizer, or if no triangle remains), UnsupportedData (not a manifold: a face in three
/// simplices, a repeated vertex; for `fast` also a pinched vertex, faces of two orientations and triangles with the
/// same corners; or the result of `fast` is not a manifold), Cancelled.
///
/// Time: O(S log S), about 2 microseconds per triangle and 3 per tetrahedron (facets, vertices: several times that).
/// Error bounds take as long for triangles; for tetrahedra about 2 microseconds each, plus about 15 for each one of the
/// result, and several times as long if errors are much smaller than edges. This is per round: up to 12 rounds with
/// `max_error`; with a count 1 (`fast`, large contours) or usually 5 to 35 (a third of those without bounds); with both
/// as many as for each. If no round keeps max_error, the result is the original contour and SimplifyStats::end reports
/// it. Memory: about 200 bytes per simplex.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Simplification<N, Real> simplify(const Contour<N, Real>& contour, const SimplifyOptions<N>& options);

/// A `scale` for a contour whose axes have different units: for an axis whose unit differs from the first axis's, the
/// mean extents of simplices along the two axes become equal. All other axes, and axes without extent, keep the factor
/// 1. N = 2, 3, 4; Real: float or double. O(S).
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] std::array<double, N> automatic_scale(const Contour<N, Real>& contour);

/// Whether SimplifyMethod::fast is available.
[[nodiscard]] bool has_fast_simplify() noexcept;

}  // namespace tegl
