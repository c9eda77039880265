// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the values around the edges of one row by whole registers. Compiled for several instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "image/gradient.hpp"

namespace tegl::detail {

/// Number of lanes of the longest registers for the smallest arithmetic type (float).
inline constexpr std::size_t kMostLanes = 16;

/// Edges of one row whose samples are adjacent in memory. T: type of the values; Calc: type of the arithmetic.
template <class T, class Calc>
struct EdgesInRow {
  const T* const* from;     ///< by place: value for an edge that starts at sample `begin`
  std::size_t places;       ///< a multiple of 4
  std::size_t begin, end;   ///< values exist in [begin, end), at least kMostLanes
  const std::uint32_t* at;  ///< by edge: its first sample, ascending; results for edges outside are undefined
  std::size_t count;        ///< from 2 to kEdgesAtOnce
  Calc* out;                ///< places x kEdgesAtOnce
};

/// Average number of edges per register from which registers are worthwhile. With fewer, reading edge by edge is
/// faster.
inline constexpr std::size_t kEdgesPerRegister = 2;

/// Whether there may be enough edges, judged by the longest registers of any instruction set.
template <class Calc>
constexpr bool may_be_dense(std::size_t samples, std::size_t edges) noexcept {
  return kEdgesPerRegister * samples < kMostLanes * sizeof(float) / sizeof(Calc) * edges;
}

/// Writes the values by place. Returns false if there are too few edges for the processor's registers; the output is
/// then undefined. Exact, so all instruction sets give identical bytes. O(registers that hold the samples from the
/// first edge to the last).
template <class T, class Calc>
bool pick_values(const EdgesInRow<T, Calc>& row) noexcept;

/// Converts adjacent values. Exact, or to the nearest float.
template <class T, class Calc>
void convert_values(const T* from, std::size_t count, Calc* out) noexcept;

}  // namespace tegl::detail
