// SPDX-License-Identifier: BSD-3-Clause
//
// Search of the nearest of many items.
#pragma once

#include <cstddef>
#include <limits>

#include "base/progress.hpp"

namespace tegl::detail {

/// The item of the smallest square of a distance.
struct NearestItem {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::size_t item = kNone;
  double square = std::numeric_limits<double>::infinity();
};

/// Of 0 … count - 1 the item with the smallest square_of(item), the first of equals. Items whose square is infinite or
/// NaN do not count. Reports progress.
template <class SquareOf>
NearestItem nearest_item(std::size_t count, const Progress& progress, const SquareOf& square_of) {
  NearestItem nearest;
  in_parts(count, progress, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (const double square = square_of(i); square < nearest.square) nearest = {i, square};
  });
  return nearest;
}

}  // namespace tegl::detail
