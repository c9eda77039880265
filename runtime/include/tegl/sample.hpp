// SPDX-License-Identifier: BSD-3-Clause
//
// Values of an image at the vertices of a contour: a second field on the surface, such as the salinity where the water
// is 20 degrees warm.
#pragma once

#include <string>

#include "tegl/contour.hpp"
#include "tegl/image.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Interpolates the values of an image at the vertices of a contour, multilinearly between samples. Returns an
/// attribute of width 1 for Contour::vertex_attributes, #V values. The image may differ from the contour's own: any
/// grid with the same world coordinates works (another resolution or extent, rectilinear, or with another world map). N
/// = 2, 3, 4, 5.
///
/// Exact for fields that are linear along every axis of the grid. NaN outside of the image's samples, and where a
/// missing sample has a weight in the interpolation; missing samples of weight 0, such as the far corners of a cell for
/// a vertex on an edge, have no effect. Tolerance for vertices of single precision: points up to a thousandth of a step
/// outside count as on the border, and missing samples of up to a thousandth of the weight are left out. An axis with
/// one sample has values only at its coordinate.
///
/// Errors: Cancelled. Time: O(#V 2^N), plus a search along rectilinear axes. Memory: #V doubles. Thread-safe.
template <Value T, int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Attribute sample(const Image<T, N>& image, const Contour<N, Real>& contour, std::string name,
                               std::string unit = {}, const WorkOptions& work = {});

}  // namespace tegl
