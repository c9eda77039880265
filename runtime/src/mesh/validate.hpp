// SPDX-License-Identifier: BSD-3-Clause
//
// Validation of contours. Contours also come from files and callers, so every vertex number is checked before it is
// used as an index.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

/// Throws InvalidArgument unless all vertex numbers are below the number of vertices. O(#S).
template <int N, class Real>
void require_vertices(const Contour<N, Real>& contour) {
  std::array<Index, N> highest{};  // by corner: independent maxima, which run in parallel
  for (const auto& simplex : contour.simplices)
    for (int j = 0; j < N; ++j) highest[j] = std::max(highest[j], simplex[j]);
  if (contour.simplices.empty() || *std::max_element(highest.begin(), highest.end()) < contour.vertices.size()) return;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (const Index v : contour.simplices[s])
      if (v >= contour.vertices.size())
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("simplex {} has vertex number {}; expected less than {}, the number of vertices", s, v,
                                contour.vertices.size()));
}

/// Throws InvalidArgument unless all coordinates are finite. O(#V).
template <int N, class Real>
void require_finite(const Contour<N, Real>& contour) {
  for (std::size_t v = 0; v < contour.vertices.size(); ++v)
    for (const Real x : contour.vertices[v])
      if (!std::isfinite(x))
        throw Error(ErrorCode::InvalidArgument, fmt::format("a coordinate of vertex {} is {}; expected a finite one", v,
                                                            std::isnan(x) ? std::abs(x) : x));  // drop the sign of NaN
}

/// Throws InvalidArgument unless attributes and normals match the number of vertices or simplices.
template <int N, class Real>
void require_attributes(const Contour<N, Real>& contour) {
  const auto require = [](const std::vector<Attribute>& attributes, std::size_t count, const char* what) {
    for (const Attribute& attribute : attributes)
      if (attribute.width < 1 || attribute.values.size() != count * static_cast<std::size_t>(attribute.width))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("attribute '{}' has {} values of width {}; expected {} {} times the width",
                                attribute.name, attribute.values.size(), attribute.width, count, what));
  };
  require(contour.vertex_attributes, contour.vertices.size(), "vertices");
  require(contour.simplex_attributes, contour.simplices.size(), "simplices");
  if (!contour.normals.empty() && contour.normals.size() != contour.vertices.size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} normals for {} vertices; expected one for each vertex, or none", contour.normals.size(),
                            contour.vertices.size()));
}

/// All of the checks above.
template <int N, class Real>
void require_sound(const Contour<N, Real>& contour) {
  require_vertices(contour);
  require_finite(contour);
  require_attributes(contour);
}

}  // namespace tegl::detail
