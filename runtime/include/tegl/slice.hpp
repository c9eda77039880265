// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of a contour by a hyperplane "last coordinate = constant": what a 4D contour looks like at time t.
#pragma once

#include "tegl/extract.hpp"

namespace tegl {

/// The cut of an N-dimensional contour by x_{N-1} = at: a contour in one dimension less, with the last
/// coordinate left out. N = 4: triangles at time `at`; N = 3: segments.
/// (Details: see the definition; theory: a vertex exactly on the hyperplane counts as above it.)
template <int N, class Real>
Contour<N - 1, Real> slice(const Contour<N, Real>& contour, double at);

/// The same cut straight from the image: reads just the slab of tiles that the hyperplane passes.
/// Equals slice(extract(image, ...), at) up to the numbering.
/// Errors: those of `extract`; InvalidArgument when `at` lies outside of the last axis.
template <class Real = float, Value T, int N>
Contour<N - 1, Real> slice_image(const Image<T, N>& image, double isovalue, double at,
                                 const ExtractOptions& options = {}, ExtractStats* stats = nullptr);

}  // namespace tegl
