// SPDX-License-Identifier: BSD-3-Clause
//
// The smoothing of relaxed positions: moves points towards the chords between their neighbours in the curves of a net.
// Compiled for several instruction sets; all give identical bytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tegl::detail {

/// The points of a net on edges along one axis.
struct ChordMoves {
  /// By curve, #points of the net x 2: bits of the links to the neighbours on both sides (ContourNet::Link).
  const std::uint32_t* links;
  std::size_t points;    ///< of the net, along all axes
  int curves;            ///< through each point
  const float* weights;  ///< by curve
  float factor;          ///< share of the way to the chord; away from it if negative
  float low, high;       ///< range of positions
};

/// Writes the new positions of the points from `from` to `end` (exclusive), computed from `places`, to `next`. Points
/// without two neighbours in any curve stay.
void move_to_chords(const ChordMoves& moves, const float* places, std::size_t from, std::size_t end,
                    float* next) noexcept;

}  // namespace tegl::detail
