// SPDX-License-Identifier: BSD-3-Clause
//
// Orbits of signatures under permutations of corners: classes, representatives, and the group elements that map these
// to the other signatures.
//
// Based on: M. Liversage, thesis, 1994, algorithm 7.4.9.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tegl::gen {

/// The classes of all signatures under a group of symmetries.
struct Transversal {
  std::vector<std::uint32_t> representatives;  ///< per class: the smallest signature of the orbit; ascending
  std::vector<std::uint32_t> orbit_length;  ///< per class; its product with the stabiliser's order is the group's order
  std::vector<std::uint32_t> class_of;      ///< per signature: index into representatives
  std::vector<std::uint32_t> element_of;    ///< per signature s: smallest index of a g with s = g(representative)
};

/// A group element as a permutation of corners, with or without inversion.
struct CornerMap {
  std::vector<std::uint32_t> corner;
  bool inverts;
};

/// The classes of the 2^corners signatures (corners <= 16) under a group of maps; the identity must be the first.
/// Errors: Internal if the maps are not a group: an orbit meets another one, or its length does not divide the group's
/// order.
Transversal orbits(std::size_t corners, std::span<const CornerMap> group);

}  // namespace tegl::gen
