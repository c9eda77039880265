// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction of the facet hierarchy, independent of the value type of the image.
#pragma once

#include "image/sample_source.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl::detail {

/// Bit a of `seam_axes`: the last layer across axis a repeats the first one; its facets are merged.
template <int N, class Real>
FacetHierarchy<N, Real> extract_facets(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                                       unsigned seam_axes = 0);

}  // namespace tegl::detail
