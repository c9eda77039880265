// SPDX-License-Identifier: BSD-3-Clause
//
// The attribute of contours in memory whose normals are those of the context.
#pragma once

#include "tegl/normals.hpp"

namespace tegl::detail {

/// Adds the vertex attribute "normal_uncertainty" if `options` ask for normals by context. Not in 5D.
template <class Real, Value T, int N>
void add_uncertainty(const Image<T, N>& image, const ExtractOptions& options, Contour<N, Real>& contour) {
  if constexpr (N <= 4)
    if (options.normals == Normals::context) {
      const WorkOptions work{options.work.threads, {}};
      contour.vertex_attributes.push_back(
          Attribute{"normal_uncertainty", "", 1, normal_uncertainty<T, N, Real>(image, contour, work)});
    }
}

}  // namespace tegl::detail
