// SPDX-License-Identifier: BSD-3-Clause
//
// Validation of contours, for all dimensions.
#include "mesh/validate.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "tegl/error.hpp"

namespace tegl::detail {

bool are_below(std::span<const Index> rows, std::size_t vertices) noexcept {
  if (vertices > std::numeric_limits<Index>::max()) return true;
  if (vertices == 0) return rows.empty();
  // Without branches, so that compilers compare several numbers at once; by signs, since not all processors compare
  // unsigned numbers. If the last number is below 2^31, then a number is greater iff it has the upper bit or the
  // difference has.
  const auto last = static_cast<Index>(vertices - 1);
  constexpr Index kUpper = Index{1} << 31;
  Index beyond = 0;
  if (last < kUpper) {
    for (const Index v : rows) beyond |= v | (last - v);
    return (beyond & kUpper) == 0;
  }
  for (const Index v : rows) beyond |= static_cast<Index>(v > last);
  return beyond == 0;
}

void require_vertex_numbers(std::span<const Index> rows, std::size_t corners, std::size_t vertices) {
  if (are_below(rows, vertices)) return;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i] >= vertices)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("simplex {} has vertex number {}; expected less than {}, the number of vertices",
                              i / corners, rows[i], vertices));
}

namespace {

/// Without branches, so that compilers test several numbers at once: if all bits of the exponent are set, one more in
/// its last bit carries into the sign.
template <class Bits, class Real>
bool all_are_finite(std::span<const Real> numbers) noexcept {
  constexpr Bits kInfinite = std::bit_cast<Bits>(std::numeric_limits<Real>::infinity());
  constexpr Bits kLastBit = Bits{1} << (std::numeric_limits<Real>::digits - 1);
  Bits carried = 0;
  for (const Real x : numbers) carried |= (std::bit_cast<Bits>(x) & kInfinite) + kLastBit;
  return carried <= kInfinite;
}

template <class Real>
void require_all_finite(std::span<const Real> coordinates, std::size_t width) {
  if (are_finite(coordinates)) return;
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

bool are_finite(std::span<const float> numbers) noexcept { return all_are_finite<std::uint32_t>(numbers); }
bool are_finite(std::span<const double> numbers) noexcept { return all_are_finite<std::uint64_t>(numbers); }

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
