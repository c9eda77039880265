// SPDX-License-Identifier: BSD-3-Clause
//
// Local vertices of the regions of cubes.
#pragma once

#include <array>
#include <cstdint>

#include "builders/cube_lists.hpp"

namespace tegl::gen {

/// Numbers of the vertices of a region of a cube: its corners, the points on its edges, own vertices, centres.
struct RegionVertices {
  static constexpr unsigned kFirstEdge = 8;                                  ///< after the corners
  static constexpr unsigned kFirstOwn = kFirstEdge + CubeLists::kCubeEdges;  ///< own vertices of the list
  static constexpr unsigned kFirstCentre = kFirstOwn + CubeLists::kMostOwn;  ///< vertices that the region adds
  static constexpr unsigned kVertices = 32;                                  ///< maximum, not counting square centres
  static constexpr unsigned kFirstSquare = kVertices;                        ///< barycentres of squares' high parts
  static constexpr std::uint32_t kFirstDouble = 1u << 20;                    ///< bit of masks of centres
  using Tetrahedron = std::array<std::uint8_t, 4>;
};

}  // namespace tegl::gen
