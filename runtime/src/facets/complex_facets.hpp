// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of a complex of which more is known: periods, gradients at its points.
#pragma once

#include "complex/point_gradients.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl::detail {

/// As `extract_facets` of a complex with surroundings, of which gradients and periods are read. A periodic complex has
/// each of its cells once, so facets have one place each and need no merging.
template <class Real, int N>
[[nodiscard]] FacetHierarchy<N, Real> facets_in(const Complex<N>& complex, double isovalue,
                                                const ExtractOptions& options, const Surroundings<N>& around);

}  // namespace tegl::detail
