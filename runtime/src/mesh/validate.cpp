// SPDX-License-Identifier: BSD-3-Clause
//
// Validation of contours, for all dimensions.
#include "mesh/validate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tegl/error.hpp"

namespace tegl::detail {

void require_vertex_numbers(std::span<const Index> rows, std::size_t corners, std::size_t vertices) {
  std::array<Index, 4> highest{};  // independent maxima, which run in parallel
  std::size_t i = 0;
  for (; i + highest.size() <= rows.size(); i += highest.size())
    for (std::size_t j = 0; j < highest.size(); ++j) highest[j] = std::max(highest[j], rows[i + j]);
  for (; i < rows.size(); ++i) highest[0] = std::max(highest[0], rows[i]);
  if (rows.empty() || *std::max_element(highest.begin(), highest.end()) < vertices) return;
  for (std::size_t at = 0; at < rows.size(); ++at)
    if (rows[at] >= vertices)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("simplex {} has vertex number {}; expected less than {}, the number of vertices",
                              at / corners, rows[at], vertices));
}

namespace {

template <class Real>
void require_all_finite(std::span<const Real> coordinates, std::size_t width) {
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (const Real x = coordinates[i]; !std::isfinite(x))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("a coordinate of vertex {} is {}; expected a finite one", i / width,
                              std::isnan(x) ? std::abs(x) : x));  // drop the sign of NaN
}

void require_widths(const std::vector<Attribute>& attributes, std::size_t count, const char* what) {
  for (const Attribute& attribute : attributes)
    if (attribute.width < 1 || attribute.values.size() != count * static_cast<std::size_t>(attribute.width))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("attribute '{}' has {} values of width {}; expected {} {} times the width",
                              attribute.name, attribute.values.size(), attribute.width, count, what));
}

}  // namespace

void require_finite_numbers(std::span<const float> coordinates, std::size_t width) {
  require_all_finite(coordinates, width);
}
void require_finite_numbers(std::span<const double> coordinates, std::size_t width) {
  require_all_finite(coordinates, width);
}

void require_attribute_sizes(const std::vector<Attribute>& of_vertices, const std::vector<Attribute>& of_simplices,
                             const ContourSize& size, std::size_t normals) {
  require_widths(of_vertices, size.vertices, "vertices");
  require_widths(of_simplices, size.simplices, "simplices");
  if (normals != 0 && normals != size.vertices)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("{} normals for {} vertices; expected one for each vertex, or none", normals, size.vertices));
}

}  // namespace tegl::detail
