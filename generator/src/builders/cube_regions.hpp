// SPDX-License-Identifier: BSD-3-Clause
//
// The high and the low part of a cube, divided into tetrahedra, for each list of the resolved cube: data of the
// tesseract's builder, which combines copies of one side of a tesseract's boundary from these parts.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "builders/cube_lists.hpp"
#include "embedding/region_vertices.hpp"

namespace tegl::gen {

/// The connected components of the low and the high side of a cube, by list; last those of a cube of one sign. Any
/// simplex whose vertices all belong to the list is a simplex of the list. Any simplex in a square belongs to that
/// square's triangulation, which depends on the square only. The regions of all cubes around a tesseract therefore
/// match.
struct CubeRegions : RegionVertices {
  struct Region {
    std::uint8_t corners, centre_count;
    std::uint16_t tetrahedron_count;
    std::uint32_t first_tetrahedron, first_centre;
  };

  std::vector<std::uint32_t> first_region;  ///< by 2 * list + side
  std::vector<Region> regions;
  std::vector<Tetrahedron> tetrahedra;  ///< oriented so that they induce the list's triangles
  std::vector<bool> is_undivided;       ///< by list: whether it has no regions here, as one of them has no division
  std::vector<std::uint32_t> centres;   ///< the corners (bit v) and edges (bit 8 + e) whose mean each is near, or
                                        ///< kFirstDouble << j: on the ray of own vertex j
};

/// For what regions are made.
enum class RegionUse : std::uint8_t {
  copies,       ///< copies of sides; polygons in squares are SquareFans::lowest, as in the regions of RegionStyle::fan
  caps,         ///< to close contours at the image border: only the high sides, with the same fans
  even_copies,  ///< copies of sides of tesseracts whose diagonals alternate; of cubes at the lower ends of axes
  odd_copies,   ///< the same of cubes at the upper ends
};

/// Certifies every region, and proves that its tetrahedra are positive for all positions on edges and rays. With
/// alternating diagonals, regions have fewer tetrahedra and centres, but not all have a division. Throws
/// Error{CertificateFailed}, also if a region for other uses has none.
[[nodiscard]] CubeRegions make_cube_regions(const CubeLists& lists, RegionUse use);

}  // namespace tegl::gen
