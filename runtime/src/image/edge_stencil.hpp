// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the values around edges: around edges of one row by whole registers, otherwise four at a time. Compiled for
// several instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "image/gradient.hpp"

namespace tegl::detail {

/// Number of lanes of the longest registers for the smallest arithmetic type (float).
inline constexpr std::size_t kMostLanes = 16;

/// Edges in a row whose samples are adjacent in memory. T: type of the values; Calc: type of the arithmetic.
template <class T, class Calc>
struct EdgesInRow {
  const T* const* from;        ///< by place: value for an edge that starts at the first sample of the first row
  std::size_t places;          ///< a multiple of 4
  std::size_t begin, end;      ///< values exist for samples in [begin, end), at least kMostLanes
  const std::ptrdiff_t* rows;  ///< by edge: its row, added to all of `from`
  const std::uint32_t* at;     ///< by edge: its first sample; results for edges outside are undefined
  std::size_t count;           ///< from kEdgesAtOnce / 2 to kEdgesAtOnce
  Calc* out;                   ///< places x kEdgesAtOnce
};

/// Average number of edges per register from which registers are worthwhile. With fewer, reading edge by edge is
/// faster.
inline constexpr std::size_t kEdgesPerRegister = 2;

/// Whether there may be enough edges, judged by the longest registers of any instruction set.
template <class Calc>
constexpr bool may_be_dense(std::size_t samples, std::size_t edges) noexcept {
  return kEdgesPerRegister * samples < kMostLanes * sizeof(float) / sizeof(Calc) * edges;
}

/// Writes the values by place. Returns false if there are too few edges for the processor's registers, or if the edges
/// are not in one row in ascending order; the output is then undefined. Exact, so all instruction sets give identical
/// bytes. O(registers that hold the samples from the first edge to the last).
template <class T, class Calc>
bool pick_values(const EdgesInRow<T, Calc>& row) noexcept;

/// Edges in rows whose samples are adjacent in memory, as in EdgesInRow. Edge i starts at from[place][rows[i] + at[i]].
template <class T, class Calc>
struct EdgesAnywhere {
  const T* const* from;  ///< by place
  std::size_t places;
  unsigned axis;  ///< the edges' own
  std::size_t row_size;
  const std::ptrdiff_t* rows;
  const std::uint32_t* at;
  std::size_t count;  ///< at most kEdgesAtOnce
  Calc* out;          ///< places x kEdgesAtOnce
};

/// Writes the values of most edges by place. Returns the others as bits, whose output is undefined: those near the ends
/// of their row, or all of them. Exact, so all instruction sets give identical bytes.
template <class T, class Calc>
std::uint64_t gather_values(const EdgesAnywhere<T, Calc>& edges) noexcept;

/// Converts adjacent values. Exact, or to the nearest float.
template <class T, class Calc>
void convert_values(const T* from, std::size_t count, Calc* out) noexcept;

}  // namespace tegl::detail
