// SPDX-License-Identifier: BSD-3-Clause
//
// What images say at the points of a contour: a second field over the surface, such as the salinity where the water is
// 20 degrees warm.
#pragma once

#include <string>

#include "tegl/contour.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// The values of an image at the vertices of a contour, interpolated multilinearly between the samples: an attribute of
/// width 1 for Contour::vertex_attributes, #V values. The image need not be the one that the contour is of: any grid
/// with the same world coordinates will do (another resolution, part, rectilinear or with another world map). N = 2, 3,
/// 4, 5.
///
/// Exact for fields that are linear along every axis of the grid. NaN where the image says nothing: outside of its
/// samples, and where a sample is missing that counts there; a missing sample that the vertex has nothing to do with,
/// such as the far corners of a cell for a vertex on an edge, spoils nothing. Points up to a thousandth of a step
/// outside are on the border, and missing samples of up to a thousandth of the weight are left out: vertices of single
/// precision lie no closer to their edge. An axis with one sample has values there alone.
///
/// Errors: Cancelled. O(#V 2^N) time (plus a search along rectilinear axes), #V doubles of memory. Thread-safe.
template <Value T, int N, class Real>
Attribute sample(const Image<T, N>& image, const Contour<N, Real>& contour, std::string name, std::string unit = {},
                 const WorkOptions& options = {});

}  // namespace tegl
