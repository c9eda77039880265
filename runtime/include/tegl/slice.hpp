// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of contours by hyperplanes: a 4D contour at a time t, or in any other hyperplane.
#pragma once

#include <span>
#include <vector>

#include "tegl/extract.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Cuts an N-dimensional contour (N = 3, 4) by x_{N-1} = at. The result has one dimension less, without the last
/// coordinate: triangles for N = 4, segments for N = 3. Names, units and direction are kept; the cut faces the same
/// side, low or high, as the contour. Normals, if the contour has any, are interpolated like the vertices, lose their
/// last component, and get length 1, or 0 if nothing remains. Vertex attributes are interpolated like the vertices. A
/// simplex of the cut gets the attributes of the simplex that it lies in.
///
/// Vertices of the cut lie on edges between a vertex below and a vertex above the hyperplane; they are interpolated in
/// double, from the lower one. `at` is rounded to Real first. A vertex exactly on the hyperplane counts as above; if
/// the contour does not reach it from below, it counts as below. It is itself the vertex of every cut edge that ends in
/// it; simplices that collapse are dropped. Parts of the contour's boundary in the hyperplane belong to the cut if the
/// contour is only on their upper side. Consequences:
/// - At a sample's coordinate t = k the cut is the contour of layer k of the image, bit by bit: the same vertices and
///   the same oriented simplices, compared by the bits of their coordinates. Numbers, and the vertex that a simplex
///   begins with, may differ. This holds for contours that `extract` makes with any options, also at the first and the
///   last layer, and for N = 4 also if samples equal the isovalue. (Not for N = 3 then: parts of the surface may lie
///   flat in the layer, and the cut is the limit from below. A positive ExtractOptions::epsilon keeps them out of the
///   layer.) Conditions: Real has numbers between the coordinates of the layers, and a user's estimator returns the
///   same for a face of the image and for this face of the layer. If samples are missing, the contour has only the part
///   of the layer that belongs to tiles, and it may be triangulated differently.
/// - The cut of a closed manifold is a closed manifold with the same orientation, for every t. If merging vertices
///   would pinch the cut, they stay separate at the same position.
///
/// Quadrilaterals are split by the shorter diagonal. The order of the result depends only on the order of the contour.
/// Errors: InvalidArgument (`at` or a coordinate is not finite, a vertex number out of range, attributes or normals of
/// another number). If `at` is beyond the contour, the cut is empty. O(#S + #V) time, plus O(c log c) for a cut of c
/// simplices; #V bytes plus O(c) memory. Thread-safe.
template <int N, class Real>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice(const Contour<N, Real>& contour, double at);

/// Cuts a contour by any hyperplane, in the coordinates of `frame_of(hyperplane)`: across x, a 4D contour gives a
/// surface in y, z and t. "Above" is the side of the hyperplane's normal. Across the last axis the result is that of
/// the function above.
///
/// The cut of a manifold is a manifold with the same orientation, and closed if the contour is closed. The cut is the
/// limit from below; around vertices that the contour does not reach from below, the limit from above. Boundary parts
/// that lie in the hyperplane, with the contour only on their upper side, belong to cuts across an axis, unless they
/// may also lie in a side of the image along another axis. They never belong to oblique cuts.
///
/// At a sample's coordinate on any axis, the cut is the contour of that layer if no sample equals the isovalue. If
/// samples do, this holds only for the last axis, where `extract` keeps vertices between layers out of the layers. On
/// other axes such vertices lie in the layer, at the same positions as vertices of the layer itself, and the contour
/// does not distinguish them: the limit may differ from the layer's contour by parts that are flat in the layer or lie
/// along samples of the isovalue. `slice_image_across` reads the image and gives the layer's contour.
///
/// A vertex lies on the hyperplane if <normal, x> equals the offset as computed in double; if the normal is a multiple
/// of an axis, if the coordinate equals the quotient in Real. Orientation: the cut faces the same side as the contour
/// in the frame's coordinates, also if the frame is left-handed. Names and units of axes are kept if a frame axis is an
/// axis of the contour, and empty otherwise. Errors: those of `frame_of` and of the function above. Cost: that of the
/// function above.
template <int N, class Real>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice(const Contour<N, Real>& contour,
                                                              const Hyperplane<N>& hyperplane);

/// Cuts a contour by parallel hyperplanes <normal, x> = offsets[i], in one pass over the contour. Each cut equals that
/// of `slice` bit by bit. Offsets may be in any order; as many cuts are made at a time as there are threads. Errors:
/// those of `slice`; Cancelled. O(#S log k + #V) for k offsets, plus the cost of the cuts; 8 #V bytes plus the memory
/// of all cuts.
template <int N, class Real>
requires DimensionBetween<N, 3, 4> std::vector<Contour<N - 1, Real>> slice_stack(
    const Contour<N, Real>& contour, const Eigen::Matrix<double, N, 1>& normal, std::span<const double> offsets,
    const WorkOptions& options = {});

/// Makes the cut directly from the image: reads only the slab of tiles that the hyperplane passes, or, at a sample's
/// coordinate, the two slabs that meet there. `at` is a world coordinate of the last axis. At a sample's coordinate the
/// result is the contour of that layer, bit by bit, also if samples equal the isovalue (N = 3, 4). Elsewhere it equals
/// slice(extract<Real>(image, isovalue, options), at) bit by bit, up to the numbering; if values are missing at some
/// times only, up to the triangulation of the same surface. `options.close` closes the cut at the borders of the other
/// axes, as in the cut of the closed contour.
///
/// An image with one sample along the last axis has no tiles, hence an empty cut, at its only valid `at`. Errors: those
/// of `extract`; InvalidArgument if `at` is not finite or outside of the last axis, or if the world map mixes the last
/// axis with others, so that "last world coordinate = at" is not a layer. Cost: that of extracting one or two slabs,
/// independent of the length of the last axis.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice_image(const Image<T, N>& image, double isovalue,
                                                                    double at, const ExtractOptions& options = {},
                                                                    ExtractStats* stats = nullptr);

/// As `slice_image`, but across any axis: the cut by x_axis = at, in the other coordinates. Contours only a slab of
/// layers of that axis (for normals, also the adjacent layers). All guarantees for the last axis hold, except that
/// normals agree up to rounding only. At a sample's coordinate the cut is the contour of that layer, also if samples
/// equal the isovalue, where cuts of the whole contour may differ from it.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice_image_across(const Image<T, N>& image, double isovalue,
                                                                           int axis, double at,
                                                                           const ExtractOptions& options = {},
                                                                           ExtractStats* stats = nullptr);

}  // namespace tegl
