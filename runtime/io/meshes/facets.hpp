// SPDX-License-Identifier: BSD-3-Clause
//
// Writing of facets to a pending file: for the program, which puts several files in place together.
#pragma once

#include "tegl/facet_hierarchy.hpp"
#include "tegl/io/write_options.hpp"

namespace tegl {

class PendingPath;

/// As write_facets of tegl/io/facets.hpp; the caller commits the file.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void write_facets(const FacetHierarchy<N, Real>& facets, const PendingPath& file, const WriteOptions& options);

}  // namespace tegl
