// SPDX-License-Identifier: BSD-3-Clause
//
// The decisions of tegl/saddle.hpp as the extraction uses them: for values converted to double, and for cubes of which
// a part is decided already.
#pragma once

#include <array>
#include <cstdint>

#include "tegl/generated/tables.hpp"
#include "tegl/saddle.hpp"

namespace tegl::detail {

/// The public functions, with values as doubles; every value type converts exactly. `signature`: bit v is set if corner
/// v is high.
bool square_is_high(const std::array<double, 4>& values, double isovalue) noexcept;
CubeDecision decide_cube(const std::array<double, 8>& values, double isovalue, unsigned signature) noexcept;
/// The squares as decide_cube decides them; the centre is `separate`.
CubeDecision decide_squares(const std::array<double, 8>& values, double isovalue, unsigned signature) noexcept;
/// The test for a connection inside a cube, by entry of tables::kTile3Resolved (the signature with its squares
/// decided). Without a pair of edges the centre is `separate`.
using tables::CubeJoin;
inline const std::array<CubeJoin, 656>& cube_joins() noexcept { return tables::kCubeJoins; }
/// The centre choice of a cube with this entry.
tile::Choice decide_centre(const std::array<double, 8>& values, double isovalue, unsigned entry) noexcept;
/// Without the floating-point filter, for tests: all signs by exact arithmetic.
bool square_is_high_exactly(const std::array<double, 4>& values, double isovalue) noexcept;
CubeDecision decide_cube_exactly(const std::array<double, 8>& values, double isovalue) noexcept;

inline unsigned signature_of(const std::array<double, 8>& values, double isovalue) noexcept {
  unsigned signature = 0;
  for (unsigned v = 0; v < 8; ++v) signature |= static_cast<unsigned>(values[v] >= isovalue) << v;
  return signature;
}

}  // namespace tegl::detail
