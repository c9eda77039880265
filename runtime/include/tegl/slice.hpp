// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of a contour by hyperplanes: what a 4D contour looks like at time t, or along any other hyperplane.
#pragma once

#include <span>
#include <vector>

#include "tegl/extract.hpp"
#include "tegl/hyperplane.hpp"

namespace tegl {

/// The cut of an N-dimensional contour (N = 3, 4) by x_{N-1} = at: a contour in one dimension less, with the last
/// coordinate left out. N = 4: triangles at time `at`; N = 3: segments. Names, units and direction are taken over; the
/// cut's orientation points to the same side, low or high, as the contour's. Normals of the contour's vertices, if it
/// has any, become those of the cut's: interpolated like the points, without their last component, of length 1, or 0
/// where nothing is left. Vertex attributes are interpolated like the points; simplex attributes are those of the
/// simplex that each of the cut's lies in.
///
/// Points. The cut's vertices lie on the edges between a vertex below and one above the hyperplane, interpolated in
/// double from the one below. `at` is rounded to Real first. A vertex exactly on the hyperplane counts as above, or as
/// below where the contour does not come up to it from below, and is itself the point of every cut edge that ends in
/// it; simplices that collapse thereby are dropped. Parts of the contour's boundary that lie in the hyperplane belong
/// to the cut where only their upper side has a contour. So
///  - at a sample's coordinate t = k the cut is the contour of layer k of the image, bit by bit: both have the same
///    vertices and the same oriented simplices, compared by the bits of their coordinates; numbers, and the vertex that
///    a simplex begins with, may differ. This holds for the contours that `extract` makes with any options: also at the
///    first and the last layer, and, N = 4, where samples equal the isovalue. (N = 3: not in this case. There pieces of
///    the surface may lie flat in the layer, and the cut is the limit from below; a positive ExtractOptions::epsilon at
///    the extraction keeps them out of it.) Conditions: Real has numbers between the coordinates of the layers; an
///    estimator of the caller's answers alike for a face of the image and for the same face of the layer. Where samples
///    are missing, the contour has no more of the layer than what belongs to a tile, and it may be divided otherwise.
///  - at any other t the cut of a closed manifold is a closed manifold, oriented alike. That holds for every t: where
///    drawing points together would pinch the cut, they are left apart at the same place.
///
/// Quadrilaterals are split by the shorter diagonal. The result's order depends on the contour's alone.
/// Errors: InvalidArgument (`at` or a coordinate not finite, a vertex number out of range, attributes or normals of
/// another number). An `at` beyond the contour gives an empty cut. O(#S + #V) time plus O(c log c) for a cut of c
/// simplices; #V bytes and O(c) of memory. Thread-safe.
template <int N, class Real>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice(const Contour<N, Real>& contour, double at);

/// The cut by any hyperplane, in the coordinates of `frame_of(hyperplane)`: along x of a 4D contour a surface in y, z
/// and t. "Above" is the side that the hyperplane's normal points to; along the last axis it is the cut above. Whatever
/// it meets, the cut of a manifold is a manifold, oriented alike, and closed if the contour is. It is the limit from
/// below, or from above around vertices that the contour does not come up to from below. Of the contour's boundary,
/// parts in the hyperplane whose upper side alone has a contour belong to cuts across an axis, unless they may lie in a
/// side of the image along another axis too, and never to oblique ones. So at a sample's coordinate on any axis the cut
/// is the contour of that layer, if no sample equals the isovalue. Where samples do, that is so on the last axis alone,
/// where `extract` keeps the points between layers out of these. On others such points lie in the layer as well, at the
/// same places as points of the layer itself, and nothing in a contour tells one from the other: there the limit may
/// have other pieces than the layer's contour, flat in it or along samples of the isovalue. `slice_image_across` has
/// the image to go by, and gives the layer's contour. Vertices lie on the hyperplane if <normal, x> equals the offset
/// as computed in double, and if the normal is a multiple of an axis, if the coordinate equals the quotient in Real.
/// Orientation: the cut's positive side in the frame's coordinates is that of the contour, also where the frame is
/// left-handed. Names and units of axes are kept where the frame's axis is one of the contour's, and empty elsewhere.
/// Errors: those of `frame_of`, and as above. Cost: as above.
template <int N, class Real>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice(const Contour<N, Real>& contour,
                                                              const Hyperplane<N>& hyperplane);

/// The cuts by parallel hyperplanes <normal, x> = offsets[i], all found in one pass over the contour: each the same,
/// bit by bit, as `slice` gives it. The offsets may come in any order; as many cuts are made at a time as
/// there are threads. Errors: those of `slice`; Cancelled. O(#S log k + #V) plus the cuts' own cost; 8 #V bytes,
/// and memory for all cuts.
template <int N, class Real>
requires DimensionBetween<N, 3, 4> std::vector<Contour<N - 1, Real>> slice_stack(
    const Contour<N, Real>& contour, const Eigen::Matrix<double, N, 1>& normal, std::span<const double> offsets,
    const WorkOptions& options = {});

/// The same cut straight from the image: reads just the slab of tiles that the hyperplane passes; at a sample's
/// coordinate, the two slabs that meet there. `at` is a world coordinate of the last axis.
/// At a sample's coordinate it is the contour of the layer, bit by bit, also where samples equal the isovalue (N = 3,
/// 4). Elsewhere it equals slice(extract<Real>(image, isovalue, options), at) up to the numbering, bit by bit; where
/// values are missing at some times and not at others, up to how the same surface is divided into triangles.
/// `options.close` closes the cut at the borders of the other axes, as the cut of the closed contour is.
///
/// An image with one sample along the last axis has no tiles, hence an empty cut, at the one `at` that lies inside.
/// Errors: those of `extract`; InvalidArgument when `at` is not finite or outside of the last axis, and when
/// the grid's world map mixes the last axis with others, so that "last world coordinate = at" is not a layer.
/// Cost: that of extracting one or two slabs, whatever the length of the last axis.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice_image(const Image<T, N>& image, double isovalue,
                                                                    double at, const ExtractOptions& options = {},
                                                                    ExtractStats* stats = nullptr);

/// The same across any axis: the cut by x_axis = at, in the other coordinates. Only a slab of layers of that axis is
/// contoured (for normals, the layers beside it too). All that is said of the last axis holds for this one, except that
/// normals are the same up to rounding: at a sample's coordinate the cut is the contour of that layer, also where
/// samples equal the isovalue and cuts of the whole contour may differ from it.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice_image_across(const Image<T, N>& image, double isovalue,
                                                                           int axis, double at,
                                                                           const ExtractOptions& options = {},
                                                                           ExtractStats* stats = nullptr);

}  // namespace tegl
