// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of the parts of an image's tesseract, for cells of meshes that take its contour.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "tegl/tile/corners.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// The number of the cube with these corners.
inline unsigned cube_with_corners(std::span<const std::uint8_t> corners) noexcept {
  unsigned all = 15, some = 0;
  for (const std::uint8_t v : corners) all &= v, some |= v;
  const auto axis = static_cast<unsigned>(std::countr_zero(15u ^ some ^ all));
  return 2 * axis + (all >> axis & 1u);
}

/// The corners of a square (kTesseractSquares), as bits.
inline unsigned corners_of_square(unsigned square) noexcept {
  const auto [base, axes] = kTesseractSquares[square];
  unsigned corners = 0;
  for (unsigned v = 0; v < 16; ++v)
    if ((v & ~unsigned{axes}) == base) corners |= 1u << v;
  return corners;
}

/// The mask of a vertex that is doubled (ResolvedTesseract::kIsDouble): from bit `first` on the number of the cube
/// whose own vertex it is, with the other bits as in ResolvedCubes::mask; 8: a vertex on an edge.
inline std::uint64_t doubled_mask(const ResolvedCubes& cubes, const ResolvedCubes::Lists& lists, unsigned vertex,
                                  unsigned first) noexcept {
  if (vertex < ResolvedCubes::kEdges) return std::uint64_t{8} << first | std::uint64_t{1} << (16 + vertex);
  const unsigned cube = (vertex - ResolvedCubes::kEdges) / ResolvedCubes::kMostOwn;
  const std::uint64_t mask = cubes.mask(lists[cube], (vertex - ResolvedCubes::kEdges) % ResolvedCubes::kMostOwn);
  return std::uint64_t{cube} << first | mask;
}

/// The edges, as bits, of the triangles that a vertex is coned to.
inline std::uint32_t edges_around(const ResolvedView& view, unsigned apex) noexcept {
  std::uint32_t edges = 0;
  for (std::uint32_t i = 0; i < view.simplex_count; ++i) {
    const std::uint8_t* const t = view.simplices + 4 * std::size_t{i};
    if (t[0] != apex) continue;
    for (unsigned k = 1; k < 4; ++k)
      if (t[k] < ResolvedCubes::kEdges) edges |= std::uint32_t{1} << t[k];
  }
  return edges;
}

}  // namespace tegl::detail
