// SPDX-License-Identifier: BSD-3-Clause
//
// Separates parts of a complex that only touch each other at vertices of a seam. If simplices are moved from one end of
// a period to the other, those that stay around a vertex may touch without a common face: on lattices, where the seam
// is not a plane, and beside missing values. Vertices get copies until each has a ball or half a ball around it.
// Simplices keep their numbers.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Gives copies of vertices to some of the simplices around them, so that the links of `candidates` and of all copies
/// are spheres or balls. The new vertices have the numbers from `vertex_count` on. Other links are changed only if they
/// stay spheres or balls. Returns for each new vertex the one below `vertex_count` that it copies. O(S) time for each
/// round of copies. The result depends on the arguments only.
template <int N>
std::vector<Index> separate_touching_parts(std::span<std::array<Index, N>> simplices, std::size_t vertex_count,
                                           std::vector<Index> candidates);

}  // namespace tegl::detail
