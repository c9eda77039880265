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
  std::vector<std::uint32_t> centres;   ///< the corners (bit v) and edges (bit 8 + e) whose mean each is near, or
                                        ///< kFirstDouble << j: on the ray of own vertex j
};

/// `is_cap`: to close contours at the image border; then only the high sides. In squares, polygons are fans (CubeSide),
/// as in the regions of RegionStyle::fan. Certifies every region, and proves that its tetrahedra are positive for all
/// positions on edges and rays. Throws Error{CertificateFailed}.
[[nodiscard]] CubeRegions make_cube_regions(const CubeLists& lists, bool is_cap);

}  // namespace tegl::gen
