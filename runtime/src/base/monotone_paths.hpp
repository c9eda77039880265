// SPDX-License-Identifier: BSD-3-Clause
//
// The monotone paths of a product of two simplices, which divide it into simplices.
//
// Based on: H. Freudenthal, Simplizialzerlegungen von beschränkter Flachheit, 1942.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>

namespace tegl::detail {

/// A pair of vertices, one of each simplex.
using VertexPair = std::pair<std::uint8_t, std::uint8_t>;

/// Calls visit(pairs) for each monotone path: from the first vertices of both simplices to the last ones, one step at a
/// time. `first_count`: vertices of the first simplex, 1 to Pairs; the second one has Pairs + 1 - first_count. The
/// division of a face is the division of the face's own product, so products that have a common face divide it alike.
template <int Pairs, class Visit>
constexpr void for_each_monotone_path(int first_count, const Visit& visit) {
  for (unsigned steps = 0; steps < 1u << (Pairs - 1); ++steps) {  // bit i: step i is in the first simplex
    if (std::popcount(steps) != first_count - 1) continue;
    std::array<VertexPair, Pairs> path{};
    VertexPair at{};
    for (int i = 0; i + 1 < Pairs; ++i) {
      ((steps >> i) & 1u) != 0 ? ++at.first : ++at.second;
      path[i + 1] = at;
    }
    visit(path);
  }
}

}  // namespace tegl::detail
