// SPDX-License-Identifier: BSD-3-Clause
//
// Counts classes of signatures without enumerating signatures or group elements: the lemma of Polya and Burnside,
// summed over the conjugacy classes of the cube's group.
//
// Based on: M. Liversage, thesis, 1994, section 6.5.8; conjugacy classes of B_n by pairs of partitions: Young, 1930.
#pragma once

#include <cstdint>
#include <vector>

#include "base/wide_uint.hpp"
#include "symmetry/symmetry.hpp"

namespace tegl::gen {

/// One conjugacy class of B_n, given by the lengths of its signed cycles of axes. A cycle is positive if its full turn
/// maps the axis to itself, negative if it reverses the axis.
struct CycleType {
  std::vector<int> positive;        ///< descending
  std::vector<int> negative;        ///< descending; together they sum to n
  std::uint64_t elements = 0;       ///< number of elements of B_n of this type
  std::uint64_t corner_cycles = 0;  ///< number of cycles on the 2^n corners
  int det = 1;                      ///< -1 if the elements reverse the orientation of space
  /// True if all cycles on the corners have even length, so that each can alternate between high and low.
  [[nodiscard]] bool corner_cycles_all_even() const noexcept { return !negative.empty(); }
};

/// All conjugacy classes of B_n; their `elements` sum to 2^n n!. Errors: InvalidArgument unless 1 <= n <= 8.
[[nodiscard]] std::vector<CycleType> cycle_types(int n);

/// The number of orbits of the 2^(2^n) signatures under the group.
/// Errors: InvalidArgument unless 1 <= n <= 8; Internal if Burnside's sum is not a multiple of the group's order.
[[nodiscard]] WideUint burnside_orbits(int n, GroupKind kind, bool inversion);

}  // namespace tegl::gen
