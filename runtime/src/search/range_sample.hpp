// SPDX-License-Identifier: BSD-3-Clause
//
// A sample of the tiles that are not constant, for quantiles of the ends of their ranges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "search/padded_ranges.hpp"

namespace tegl::detail {

/// Ascending places of at most `most` tiles that are not constant: all, or one per run of equal length, at a
/// pseudorandom place in the run. (A fixed step would select a single column or the border of the image if it shares a
/// divisor with the row length.) Two passes over all tiles.
template <class Key>
std::vector<Place> sample_places(const RangeMap<Key>& map, std::size_t most) {
  const std::size_t room = map.least.size();
  std::size_t count = 0;
  for (std::size_t i = 0; i < room; ++i) count += map.least[i] != map.greatest[i] ? 1 : 0;
  const std::size_t step = count <= most ? 1 : (count + most - 1) / most;
  std::vector<Place> places;
  places.reserve(count / step + 1);
  std::size_t met = 0, next = 0;
  for (std::size_t i = 0; i < room; ++i) {
    if (map.constant(static_cast<Place>(i)) || met++ != next) continue;
    places.push_back(static_cast<Place>(i));
    const std::size_t run = places.size();
    next = run * step + static_cast<std::size_t>((run * 0x9e3779b97f4a7c15u >> 32) % step);
  }
  return places;
}

}  // namespace tegl::detail
