// SPDX-License-Identifier: BSD-3-Clause
//
// Classes of signatures by enumeration: one representative per orbit, and for every signature its class and a group
// element that maps the representative to it.
//
// Based on: M. Liversage, thesis, 1994, algorithm 7.4.9.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "symmetry/orbits.hpp"
#include "symmetry/symmetry.hpp"

namespace tegl::gen {

/// Highest dimension whose signatures are enumerated (65 536 of them).
inline constexpr int kMaxEnumeratedDim = 4;

/// The orbits of the 2^(2^n) signatures. `group` is closed under composition and starts with the identity, as returned
/// by group(). O(classes |G| 2^n) time: a few milliseconds for n = 4. Errors: InvalidArgument unless 1 <= n <= 4;
/// Internal if `group` is not a group: an orbit meets another one, or its length does not divide the group's order.
[[nodiscard]] Transversal transversal(int n, std::span<const Element> group);

/// A class of signatures, represented by its smallest one.
struct Representative {
  std::uint32_t signature;     ///< the smallest of its orbit
  std::uint32_t orbit_length;  ///< number of signatures in the orbit
};

/// Calls `take` for the representatives of dimension n in ascending order, without inversion. They are computed from
/// the classes of dimension n - 1, not from all 2^(2^n) signatures: a signature is a pair (upper, lower) of opposite
/// (n-1)-faces. The smallest signature of an orbit has as its upper face the smallest representative of any of its 2n
/// faces, and then the smallest possible lower face. The number of symmetries that give the same pair determines the
/// orbit length. Returns the sum of the orbit lengths, which is 2^(2^n) if no class is missing or repeated. O(c |G| n)
/// time for c classes: seconds for n = 5; O(2^(2^(n-1))) memory. Errors: InvalidArgument unless 2 <= n <= 5.
std::uint64_t for_each_representative(int n, GroupKind kind, const std::function<void(const Representative&)>& take);

/// Counts the classes again by Burnside's lemma, which does not use the elements that produced `classes`, so it detects
/// a wrong group. Errors: CountMismatch if the two numbers differ.
void require_burnside_count(const Transversal& classes, int n, GroupKind kind, bool inversion);

}  // namespace tegl::gen
