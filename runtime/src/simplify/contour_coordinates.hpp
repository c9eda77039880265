// SPDX-License-Identifier: BSD-3-Clause
//
// A contour with coordinates of another number type: simplification computes in double precision.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// The contour with coordinates of another type. The rest is copied, or moved from a temporary.
template <class To, int N, class Source>
Contour<N, To> with_coordinates(Source&& contour) {
  const auto converted = [](const auto& from) {
    Buffer<std::array<To, N>> to(from.size());
    for (std::size_t v = 0; v < from.size(); ++v)
      for (int a = 0; a < N; ++a) to[v][a] = static_cast<To>(from[v][a]);
    return to;
  };
  return {converted(contour.vertices),
          std::forward<Source>(contour).simplices,
          converted(contour.normals),
          std::forward<Source>(contour).axis_names,
          std::forward<Source>(contour).axis_units,
          contour.direction,
          std::forward<Source>(contour).vertex_attributes,
          std::forward<Source>(contour).simplex_attributes};
}

}  // namespace tegl::detail
