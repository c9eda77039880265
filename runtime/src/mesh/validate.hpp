// SPDX-License-Identifier: BSD-3-Clause
//
// Validation of contours. Contours also come from files and callers, so every vertex number is checked before it is
// used as an index. The checks are compiled once for all dimensions, in validate.cpp.
#pragma once

#include <cstddef>
#include <span>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Throws InvalidArgument unless all vertex numbers in `rows`, `corners` per simplex, are below `vertices`. O(#S).
void require_vertex_numbers(std::span<const Index> rows, std::size_t corners, std::size_t vertices);
/// Whether all vertex numbers are below the number of vertices.
bool are_below(std::span<const Index> rows, std::size_t vertices) noexcept;

/// Whether all numbers are finite.
bool are_finite(std::span<const float> numbers) noexcept;
bool are_finite(std::span<const double> numbers) noexcept;

/// Throws InvalidArgument unless all coordinates, `width` per vertex, are finite. O(#V).
void require_finite_numbers(std::span<const float> coordinates, std::size_t width);
void require_finite_numbers(std::span<const double> coordinates, std::size_t width);

/// Throws InvalidArgument unless attributes and normals match the number of vertices or simplices.
void require_attribute_sizes(const std::vector<Attribute>& of_vertices, const std::vector<Attribute>& of_simplices,
                             const ContourSize& size, std::size_t normals);

/// Rows of an array of points or simplices, one after the other.
template <class T, std::size_t N>
std::span<const T> flat_rows(std::span<const std::array<T, N>> rows) noexcept {
  return {rows.empty() ? nullptr : rows.front().data(), rows.size() * N};
}

/// Throws InvalidArgument unless all vertex numbers are below the number of vertices. O(#S).
template <int N, class Real>
void require_vertices(const Contour<N, Real>& contour) {
  require_vertex_numbers(flat_rows(std::span<const std::array<Index, N>>(contour.simplices)), N,
                         contour.vertices.size());
}

/// Throws InvalidArgument unless all coordinates are finite. O(#V).
template <int N, class Real>
void require_finite(const Contour<N, Real>& contour) {
  require_finite_numbers(flat_rows(std::span<const std::array<Real, N>>(contour.vertices)), N);
}

/// Throws InvalidArgument unless attributes and normals match the number of vertices or simplices.
template <int N, class Real>
void require_attributes(const Contour<N, Real>& contour) {
  require_attribute_sizes(contour.vertex_attributes, contour.simplex_attributes,
                          {contour.vertices.size(), contour.simplices.size()}, contour.normals.size());
}

/// All of the checks above.
template <int N, class Real>
void require_sound(const Contour<N, Real>& contour) {
  require_vertices(contour);
  require_finite(contour);
  require_attributes(contour);
}

}  // namespace tegl::detail
