// SPDX-License-Identifier: BSD-3-Clause
//
// Orbits of signatures under permutations of corners (private to the generator).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tegl/gen/transversal.hpp"

namespace tegl::gen {

/// A group element as what it does to corners.
struct CornerMap {
  std::vector<std::uint32_t> corner;
  bool inverts;
};

/// The classes of the 2^corners signatures (corners <= 16) under a group of maps, the identity first. Errors: Internal
/// if the maps are no group: an orbit reaches another one, or its length does not divide the group's order.
Transversal orbits(std::size_t corners, std::span<const CornerMap> group);

}  // namespace tegl::gen
