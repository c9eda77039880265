// SPDX-License-Identifier: BSD-3-Clause
//
// Replaces local vertices in a tile's simplices by vertex numbers. Compiled for several instruction sets, the best of
// which is chosen at run time; all give identical bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "builder4.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Tetrahedra of a 4D tile. Local vertices are those of builders::ResolvedView.
struct LocalSimplices {
  const std::uint8_t* local;  ///< 4 local vertices each
  std::uint32_t count;
  const Index* of_edges;  ///< numbers of the 32 vertices on edges
  const Index* of_cubes;  ///< numbers of the 32 own vertices of the cubes; null: the simplices have none of these
  Index own;              ///< number of the tile's first own vertex
  bool flip;              ///< reverses the orientation by swapping the last two vertices
};

/// Writes the vertex numbers of all simplices to `out`.
void write_numbers(const LocalSimplices& simplices, std::array<Index, 4>* out) noexcept;

/// Maps the local vertices of tetrahedra by the 32 entries of `to`, the bytes of four words from the lowest on. `swap`:
/// exchanges the last two. Reads and writes up to kMoreSimplices tetrahedra past the end.
inline constexpr std::size_t kMoreSimplices = 15;
void map_simplices(const std::uint8_t* from, std::size_t count, const std::uint64_t* to, bool swap,
                   std::uint8_t* out) noexcept;

/// Appends cones (builders::ResolvedTesseract::AddCones).
std::uint32_t* add_cones(const builders::ResolvedCubes::Triangles* triangles, std::size_t count, unsigned apex,
                         std::uint32_t* out) noexcept;

/// map_simplices and add_cones as compiled for this processor, without the choice in each call, which takes as long as
/// the work for a region of few tetrahedra.
struct SimplexFunctions {
  builders::ResolvedTesseract::MapTetrahedra map;
  builders::ResolvedTesseract::AddCones cones;
};
[[nodiscard]] SimplexFunctions simplex_functions() noexcept;

}  // namespace tegl::detail
