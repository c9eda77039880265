// SPDX-License-Identifier: BSD-3-Clause
//
// Values around the edges of one row, taken out of whole registers; compiled for several instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "image/gradient.hpp"

namespace tegl::detail {

/// Samples of the longest registers, with the smallest type of the arithmetic (float).
inline constexpr std::size_t kMostLanes = 16;

/// Edges of one row, whose samples lie next to each other. T: the values' type, Calc: the one they become.
template <class T, class Calc>
struct EdgesInRow {
  const T* const* from;     ///< by place: the value of an edge that starts at the row's sample `begin`
  std::size_t places;       ///< a multiple of 4
  std::size_t begin, end;   ///< values are there from begin on and before end, kMostLanes at the least
  const std::uint32_t* at;  ///< by edge: the sample that it starts at, ascending; values of those outside mean nothing
  std::size_t count;        ///< from 2 to kEdgesAtOnce
  Calc* out;                ///< places x kEdgesAtOnce
};

/// As many edges as a register has to hold on the average: with fewer, it takes less time to look at them one by one.
inline constexpr std::size_t kEdgesPerRegister = 2;

/// Whether edges may be many enough, by the longest registers that there are.
template <class Calc>
constexpr bool may_be_dense(std::size_t samples, std::size_t edges) noexcept {
  return kEdgesPerRegister * samples < kMostLanes * sizeof(float) / sizeof(Calc) * edges;
}

/// Writes the values by place. False: edges are too few for the processor's registers, and what is written means
/// nothing. Exact, so the bytes are the same in all instruction sets. O(registers that hold the samples from the first
/// edge to the last).
template <class T, class Calc>
bool pick_values(const EdgesInRow<T, Calc>& row) noexcept;

}  // namespace tegl::detail
