// SPDX-License-Identifier: BSD-3-Clause
//
// The attribute of contours in memory whose normals are those of the context.
#pragma once

#include <utility>

#include "kernel/extract_in_memory.hpp"
#include "tegl/normals.hpp"

namespace tegl::detail {

/// The contour that `extract(plan)` makes of `image`. If `options` ask for normals by context, except in 5D, adds the
/// vertex attribute "normal_uncertainty", which the fits of the normals give too.
template <int N, class Real, Value T, class Extract>
Extraction<N, Real> add_uncertainty(const Image<T, N>& image, const ExtractOptions& options, ExtractPlan plan,
                                    const Extract& extract) {
  if (N > 4 || options.normals != Normals::context) return extract(plan);
  VertexUncertainty uncertainty;
  plan.uncertainty = &uncertainty;
  Extraction<N, Real> result = extract(plan);
  if constexpr (N <= 4) {
    uncertainty.resize(result.contour.vertices.size());
    complete_uncertainty<T, N, Real>(image, result.contour, {options.work.threads, {}}, uncertainty.values());
    result.contour.vertex_attributes.push_back(Attribute{"normal_uncertainty", "", 1, std::move(uncertainty.values())});
  }
  return result;
}

/// As extract_in_memory from the samples of `image`, with the attribute that add_uncertainty adds.
template <int N, class Real, Value T>
Extraction<N, Real> extract_with_uncertainty(SampleSource<N>& source, const Grid<N>& grid, const Image<T, N>& image,
                                             const ExtractOptions& options, const ExtractPlan& plan = {}) {
  return add_uncertainty<N, Real>(image, options, plan, [&](const ExtractPlan& with) {
    return extract_in_memory<N, Real>(source, grid, options, with);
  });
}

}  // namespace tegl::detail
