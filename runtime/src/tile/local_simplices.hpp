// SPDX-License-Identifier: BSD-3-Clause
//
// Simplices of a tile by numbers of vertices in place of the tile's own, compiled for several instruction sets of which
// the best is taken at run time. All of them give the same bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Tetrahedra of a tile of four dimensions.
struct LocalSimplices {
  const std::uint8_t* local;  ///< 4 local vertices each
  std::uint32_t count;
  const Index* ids;        ///< by local vertex
  std::uint32_t id_count;  ///< those there are; up to the next multiple of 64, at most 256, ids may be read
  bool flip;               ///< against their orientation: the last two vertices swapped
};

/// Writes them from `out` on.
void write_numbers(const LocalSimplices& simplices, std::array<Index, 4>* out) noexcept;

/// Tetrahedra by other local vertices: `to` has those of 32. `swap`: the last two swapped. Reads and writes up to
/// kMoreSimplices more.
inline constexpr std::size_t kMoreSimplices = 3;
void map_simplices(const std::uint8_t* from, std::size_t count, const std::uint8_t* to, bool swap,
                   std::uint8_t* out) noexcept;

}  // namespace tegl::detail
