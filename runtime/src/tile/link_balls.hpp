// SPDX-License-Identifier: BSD-3-Clause
//
// Divides the link of a vertex into balls. Beside missing values in 5D, links may have several parts, may touch
// themselves in vertices and edges, and may have holes. If each ball gets its own copy of the vertex, all copies have
// balls as links.
#pragma once

#include <cstdint>
#include <vector>

#include "tegl/tile/complex.hpp"

namespace tegl::detail {

/// The number of its ball for each simplex of a link; 0 for all if the link is a sphere or a ball. Balls are numbered
/// in the order of their first simplices, and grow from these simplex by simplex, as far as the result is proved to
/// stay a ball. `link`: as for tile::shape_of; two simplices at most share a face of one dimension less. The result
/// depends on the argument only. O(s^2) time for s simplices at most.
[[nodiscard]] std::vector<std::uint32_t> balls_of_link(const tile::Simplices& link);

}  // namespace tegl::detail
