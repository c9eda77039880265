// SPDX-License-Identifier: BSD-3-Clause
//
// Contours in memory of the caller: whether they fit, and copies.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>

#include "tegl/error.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Throws InvalidArgument unless `needed` items fit. `items`: their name, such as "vertices".
inline void check_room(std::uint64_t room, std::uint64_t needed, const char* items) {
  if (needed > room)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("room for {} {}; the contour has {} or more (tegl::count returns the number)", room, items,
                            needed));
}

/// Throws InvalidArgument unless a contour of this size fits.
template <int N, class Real, class I>
void check_room(const ContourRoom<N, Real, I>& room, const ContourSize& needed, bool with_normals) {
  check_room(room.vertices.size(), needed.vertices, "vertices");
  if (with_normals) check_room(room.normals.size(), needed.vertices, "normals");
  check_room(room.simplices.size(), needed.simplices, "simplices");
}

/// Copies a contour to memory of the caller, which it fits into.
template <class Real, class I, int N>
void copy_contour(const Contour<N, Real>& contour, const ContourRoom<N, Real, I>& room) {
  std::copy(contour.vertices.begin(), contour.vertices.end(), room.vertices.begin());
  std::copy(contour.normals.begin(), contour.normals.end(), room.normals.begin());
  std::transform(contour.simplices.begin(), contour.simplices.end(), room.simplices.begin(), [](const auto& simplex) {
    std::array<I, N> wide;
    std::copy(simplex.begin(), simplex.end(), wide.begin());
    return wide;
  });
}

}  // namespace tegl::detail
