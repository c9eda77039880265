// SPDX-License-Identifier: BSD-3-Clause
//
// Faces of the 5-cube: from their numbers in the builder of 5-cubes to their numbers in the lattice.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "tegl/tile/corners.hpp"
#include "tegl/tile/cube_faces.hpp"

namespace tegl::detail {

/// Numbers of faces in the lattice, by their number in builders::FiveCube, which orders faces by their axes (as a bit
/// set), then by their lowest corner, and tesseracts by axis and side.
struct FiveCubeNumbers {
  /// The corners and edges of a face, as numbered by the builder.
  struct Frame {
    std::uint32_t corners = 0;
    std::array<std::uint64_t, 2> edges{};

    /// The number of a corner, and of an edge, in the face's own frame. Edges follow the corners.
    [[nodiscard]] constexpr unsigned number_of_corner(unsigned v) const noexcept {
      return static_cast<unsigned>(std::popcount(corners & ((1u << v) - 1)));
    }
    [[nodiscard]] constexpr unsigned number_of_edge(unsigned e) const noexcept {
      const std::uint64_t below = (std::uint64_t{1} << (e % 64)) - 1;
      const int before =
          e < 64 ? std::popcount(edges[0] & below) : std::popcount(edges[0]) + std::popcount(edges[1] & below);
      return static_cast<unsigned>(std::popcount(corners) + before);
    }
  };

  std::array<std::uint16_t, 80> edges{}, squares{};
  std::array<std::uint16_t, 40> cubes{};
  std::array<std::uint16_t, 10> tesseracts{};
  std::array<std::uint8_t, 80> edge_order{};  ///< the builder's edges in the order of the lattice
  std::array<Frame, 11> frames{};             ///< of the tesseracts and of the 5-cube itself

  constexpr FiveCubeNumbers() {
    constexpr CubeFaces kCube(5);
    std::size_t edge = 0, square = 0, cube = 0;
    for (unsigned axes = 0; axes < 32; ++axes)
      for (unsigned base = 0; base < 32; ++base) {
        if ((base & axes) != 0) continue;
        if (std::popcount(axes) == 1) edges[edge++] = kCube.number(base, axes);
        if (std::popcount(axes) == 2) squares[square++] = kCube.number(base, axes);
        if (std::popcount(axes) == 3) cubes[cube++] = kCube.number(base, axes);
      }
    for (std::size_t e = 0; e < 80; ++e) edge_order[edges[e] - 32u] = static_cast<std::uint8_t>(e);
    for (unsigned f = 0; f < 10; ++f) {
      const unsigned axis = 1u << f / 2;
      tesseracts[f] = kCube.number(f % 2 != 0 ? axis : 0, 31u ^ axis);
      frames[f].corners = static_cast<std::uint32_t>(face_corners(5, f));
    }
    frames[10].corners = ~std::uint32_t{0};
    for (std::size_t e = 0; e < 80; ++e) {
      const CubeFace& face = kCube.cells()[edges[e]];
      const std::uint32_t ends = 1u << face.base | 1u << (face.base | face.axes);
      for (Frame& frame : frames)
        if ((ends & ~frame.corners) == 0) frame.edges[e / 64] |= std::uint64_t{1} << (e % 64);
    }
  }
};

inline constexpr FiveCubeNumbers kFiveCubeNumbers;

}  // namespace tegl::detail
