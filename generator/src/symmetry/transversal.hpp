// SPDX-License-Identifier: BSD-3-Clause
//
// The classes of signatures by enumeration: one representative per orbit of the group, and for every signature its
// class and a group element that leads there from the representative.
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

/// The orbits of the 2^(2^n) signatures. `group` is closed under composition with the identity first, as group()
/// returns it. O(classes |G| 2^n) time: a few milliseconds for n = 4.
/// Errors: InvalidArgument unless 1 <= n <= 4; Internal if `group` is no group: an orbit reaches another one, or its
/// length does not divide the group's order.
[[nodiscard]] Transversal transversal(int n, std::span<const Element> group);

/// A class of signatures by its smallest one.
struct Representative {
  std::uint32_t signature;     ///< the smallest of its orbit
  std::uint32_t orbit_length;  ///< how many signatures are in it
};

/// The representatives of dimension n in ascending order, handed to `take` one by one, from the classes of dimension
/// n - 1, without a look at all 2^(2^n) signatures: a signature is a pair of opposite (n-1)-faces, (upper, lower), and
/// the smallest one of its orbit has the smallest representative that any of its 2n faces has for its upper one, and
/// with that the smallest lower one. The orbit lengths follow from how many symmetries give the same pair. No
/// inversion. Returns the sum of the orbit lengths, which is 2^(2^n) if none is missing and none is there twice. O(c
/// |G| n) time, c the classes: seconds for n = 5; O(2^(2^(n-1))) memory. Errors: InvalidArgument unless 2 <= n <= 5.
std::uint64_t for_each_representative(int n, GroupKind kind, const std::function<void(const Representative&)>& take);

/// Counts the classes a second time, by Burnside's lemma, which knows nothing of the elements that made `classes`: a
/// group that is a wrong one shows here. Errors: CountMismatch if the two numbers differ.
void require_burnside_count(const Transversal& classes, int n, GroupKind kind, bool inversion);

}  // namespace tegl::gen
