// SPDX-License-Identifier: BSD-3-Clause
//
// Local vertices of the regions of cubes.
#pragma once

#include <array>
#include <cstdint>

namespace tegl::gen {

/// Numbers of the vertices of a region of a cube: its corners, the points on its edges, own vertices, centres.
struct RegionVertices {
  static constexpr unsigned kMostOwn = 4;                         ///< own vertices of a list, at most
  static constexpr unsigned kFirstEdge = 8;                       ///< after the corners
  static constexpr unsigned kFirstOwn = kFirstEdge + 12;          ///< own vertices of the list
  static constexpr unsigned kFirstCentre = kFirstOwn + kMostOwn;  ///< vertices that the region adds
  static constexpr unsigned kVertices = 32;                       ///< maximum
  static constexpr std::uint32_t kFirstDouble = 1u << 20;         ///< bit of masks of centres
  using Tetrahedron = std::array<std::uint8_t, 4>;
};

}  // namespace tegl::gen
