// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of contours by hyperplanes: a 4D contour at a time t, or in any other hyperplane.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "tegl/extract.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Cuts an N-dimensional contour (N = 3, 4, 5) by a hyperplane. `slice(contour, Hyperplane<4>::across(3, t))` is the
/// surface at time t.
///
/// The result has one dimension less, in the coordinates of `frame_of(hyperplane)`: segments for N = 3, triangles for
/// N = 4, tetrahedra for N = 5. Across an axis these are the other axes: across x, a 4D contour gives a surface in y, z
/// and t. "Above" is the side of the hyperplane's normal. The cut faces the same side, low or high, as the contour, in
/// the frame's coordinates, also if the frame is left-handed. Direction, and names and units of axes that are axes of
/// the frame, are kept; other names and units are empty. Normals, if the contour has any, are interpolated like the
/// vertices, lose their component along the hyperplane's normal, and get length 1, or 0 if nothing remains. Vertex
/// attributes are interpolated like the vertices. A simplex of the cut gets the attributes of the simplex that it lies
/// in.
///
/// Vertices of the cut lie on edges between a vertex below and a vertex above the hyperplane; they are interpolated in
/// double, from the lower one. A vertex lies on the hyperplane if <normal, x> equals the offset as computed in double;
/// if the normal is a multiple of an axis, if the coordinate equals the quotient in Real. A vertex on the hyperplane
/// counts as above; if the contour does not reach it from below, it counts as below. It is itself the vertex of every
/// cut edge that ends in it; simplices that collapse are dropped. So the cut is the limit from below, and around
/// vertices that the contour does not reach from below the limit from above. Parts of the contour's boundary in the
/// hyperplane, with the contour only on their upper side, belong to cuts across an axis, unless they may also lie in a
/// side of the image along another axis. They never belong to oblique cuts.
///
/// The cut of a closed manifold is a closed manifold with the same orientation. The cut of a manifold is a manifold. If
/// merging vertices would pinch the cut, they stay separate at the same position.
///
/// Across the last axis, at a sample's coordinate t = k, the cut is the contour of layer k of the image, bit by bit:
/// the same vertices and the same oriented simplices, compared by the bits of their coordinates. Numbers, and the
/// vertex that a simplex begins with, may differ. This holds for contours that `extract` makes with any options, also
/// at the first and the last layer, and from N = 4 on also if samples equal the isovalue. (Not for N = 3: parts of the
/// surface may lie flat in the layer, and the cut is the limit from below. A positive ExtractOptions::epsilon keeps
/// them out of the layer.) Conditions: the normal points in the axis's positive direction, Real has numbers between the
/// coordinates of the layers, and a user's estimator returns the same for a face of the image and for this face of the
/// layer. If samples are missing, the contour has only the part of the layer that belongs to tiles, and it may be
/// triangulated differently. For N = 5, it holds for compact contours without `close` whose ambiguities are resolved
/// from the data; others have the layer's topology, but other simplices, as 5D cells fill their 4D faces in their own
/// way.
///
/// Across other axes, at a sample's coordinate, the cut is the contour of that layer if no sample equals the
/// isovalue. If samples do, this holds only for the last axis, where `extract` keeps vertices between layers out of the
/// layers. On other axes such vertices lie in the layer, at the same positions as vertices of the layer itself, and the
/// contour does not distinguish them: the limit may differ from the layer's contour by parts that are flat in the layer
/// or lie along samples of the isovalue. `slice_image` reads the image and gives the layer's contour.
///
/// A wrapped contour (tegl/periodic.hpp) is cut by hyperplanes along all of its periods, and the cut is wrapped, too.
/// Hyperplanes across periods cut the contour's endless repetition, if this repeats itself along them: independent sums
/// of multiples of the periods, one less than there are periods, are along the hyperplane (`cuts_wrapped`,
/// `cut_period`). So every place on a periodic axis has a cut, also on the axes of an oblique unit cell if whole
/// numbers of cells fit together along them, and so has every lattice plane of a contour with N periods. The cut is
/// complete and joined at the seam, also if the seam is not plane, and has these sums as its periods. It is made in the
/// period of offsets that begins at the seam, and moved from there (`CutPeriod`): far places have the same cuts. Other
/// hyperplanes across a period are refused.
///
/// Quadrilaterals are split by the shorter diagonal; prisms (N = 5) into three tetrahedra, in the order of the
/// contour's vertex numbers. The order of the result depends only on the order of the contour.
/// Errors: InvalidArgument (normal 0 or not finite, offset or a coordinate not finite, a vertex number out of range,
/// attributes or normals of another number, a wrapped contour unless `cuts_wrapped`; across a period, coordinates more
/// than 2^29 periods from its start, also offsets unless CutPeriod::is_straight, and simplices of half a period of the
/// cut or more if this is a sum of several periods), Cancelled. If the hyperplane is beyond the contour, the cut is
/// empty. O(#S + #V) time, plus
/// O(c log c) for a cut of c simplices; #V bytes plus O(c) memory, and 8 #V bytes for each period that is crossed. The
/// result does not depend on the number of threads. Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] Contour<N - 1, Real> slice(const Contour<N, Real>& contour, const Hyperplane<N>& hyperplane,
                                         const WorkOptions& work = {});

/// Cuts a contour by several hyperplanes, in any order. Each cut equals `slice` by its hyperplane bit by bit.
/// Hyperplanes with equal normals are cut in one pass over the contour; as many cuts are made at a time as there are
/// threads. Errors: as `slice`; Cancelled. O(#S log k + #V) for k hyperplanes of one normal, plus the cost of the
/// cuts; 8 #V bytes plus the memory of all cuts.
template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] std::vector<Contour<N - 1, Real>> slice_stack(
    const Contour<N, Real>& contour, std::type_identity_t<std::span<const Hyperplane<N>>> hyperplanes,
    const WorkOptions& work = {});
/// The same for a list: `slice_stack(contour, {Hyperplane<4>::across(3, 1.0), Hyperplane<4>::across(3, 2.0)})`.
template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] std::vector<Contour<N - 1, Real>> slice_stack(
    const Contour<N, Real>& contour, std::type_identity_t<std::initializer_list<Hyperplane<N>>> hyperplanes,
    const WorkOptions& work = {}) {
  return slice_stack(contour, std::span<const Hyperplane<N>>(hyperplanes.begin(), hyperplanes.size()), work);
}

/// Whether `slice` cuts a wrapped contour with these periods by the hyperplane; if not, unroll it first. It does if the
/// hyperplane crosses no period, or if
/// - the heights <normal, vector> of the periods are multiples of one height, by whole numbers: for N periods, if the
///   hyperplane is a lattice plane. At most 32 multiples of a period are added to others.
/// - no part of the normal is along an axis that is not periodic: axes of its parts are combinations of the periods.
///
/// Parts of vectors are compared by axis, so units of axes do not matter. Parts below a millionth of the longest part
/// of a period along the same axis are taken for rounding; if all periods have less than a millionth of their lengths
/// along an axis, all of these. So are parts of the normal of at most 16 units of rounding of double beside its largest
/// one, such as cos(π/2), and along axes of periods of 1e-7, if no height changes by a millionth. Throws
/// InvalidArgument if the normal is 0 or not finite. N = 3 to 5.
template <int N>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] bool cuts_wrapped(std::type_identity_t<std::span<const Period<N>>> periods,
                                const Hyperplane<N>& hyperplane);

/// The period of the offsets of parallel hyperplanes that cut a wrapped contour.
template <int N>
struct CutPeriod {
  /// From a hyperplane to the next one with the same cut, moved by this vector: a sum of multiples of the contour's
  /// periods, in world coordinates.
  Vector<N> vector = {};
  double length = 0.0;  ///< of the offsets, above 0: <normal, vector>
  /// The offset at which a period begins: at the seam, if this has the direction of the hyperplanes.
  double first = 0.0;
  /// Whether the hyperplanes are across an axis and the vector is along it, up to rounding. Then cuts whose offsets
  /// differ by multiples of the length are equal, and `slice` makes them at the place in [first, first + length).
  /// Otherwise it moves the cut at that place within the hyperplane, by multiples of the vector.
  bool is_straight = false;
};

/// How cuts of a wrapped contour repeat themselves. None if hyperplanes with this normal cross none of the periods, or
/// if they do not cut a wrapped contour (`cuts_wrapped`). Otherwise every offset has a cut. Throws InvalidArgument if
/// the normal is 0 or not finite. N = 3 to 5.
template <int N>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] std::optional<CutPeriod<N>> cut_period(std::type_identity_t<std::span<const Period<N>>> periods,
                                                     const std::type_identity_t<Vector<N>>& normal);

/// A place on a periodic axis, moved by multiples of the period into [first, first + period). Unchanged if it is not
/// finite or the period is not positive.
[[nodiscard]] double place_in_period(double place, double first, double period);

/// As `slice_image`, with counts and times of the extraction.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] Extraction<N - 1, Real> slice_image_with_stats(const Image<T, N>& image, double isovalue,
                                                             const std::type_identity_t<Hyperplane<N>>& hyperplane,
                                                             const ExtractOptions& options = {});

/// Cuts the contour of an image by a hyperplane in world coordinates, without the whole contour if the normal is a
/// multiple of an axis: then only the slab of tiles that the hyperplane passes is read, or, at a sample's coordinate,
/// the two slabs that meet there (for normals across another axis than the last, also the adjacent layers). Otherwise
/// the whole contour is cut.
///
/// Across an axis, the result at a sample's coordinate is the contour of that layer, bit by bit (normals across another
/// axis than the last: up to rounding), also if samples equal the isovalue, where cuts of the whole contour may differ
/// from it; for N = 5 with Ambiguity::custom, Normals::kernel and context with the exceptions of `slice`. Elsewhere it
/// equals slice(extract<Real>(image, isovalue, options), hyperplane) bit by bit (normals again up to rounding), up to
/// the numbering; if values are missing at some layers only, up to the triangulation of the same surface.
/// `options.close` closes the cut at the borders of the other axes, as in the cut of the closed contour.
///
/// An image with one sample along the axis has no tiles, hence an empty cut, at its only valid coordinate. Errors:
/// as `extract` and `slice`; across an axis also InvalidArgument if the hyperplane is outside of the image, or if
/// the world map mixes the axis with others, so that its layers are not across it. Cost: that of extracting one or two
/// slabs, independent of the length of the axis; for oblique hyperplanes, that of `extract` and `slice`.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] Contour<N - 1, Real> slice_image(const Image<T, N>& image, double isovalue,
                                               const std::type_identity_t<Hyperplane<N>>& hyperplane,
                                               const ExtractOptions& options = {}) {
  return slice_image_with_stats<Real>(image, isovalue, hyperplane, options).contour;
}

/// Layers of an image along an axis.
struct LayerRange {
  std::size_t first = 0;  ///< the first layer
  std::size_t end = 0;    ///< one past the last layer
};

/// The layers along `axis` that `slice_image<Real>` reads for the cut across it at the world coordinate `at`, so that
/// the samples of other layers need not be in memory. Errors: InvalidArgument if there is no such axis, if
/// `at` is outside of the image, or if the world map mixes the axis with others. O(n) time for an axis of n samples.
template <Coordinate Real = float, int N>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] LayerRange layers_of_cut(const Grid<N>& grid, int axis, double at, const ExtractOptions& options = {});

}  // namespace tegl
