// SPDX-License-Identifier: BSD-3-Clause
//
// The high and the low part of a cube, divided into tetrahedra, for each list of the table of cubes with every
// ambiguity resolved freely. Copies of one side of a tesseract's boundary are combined from these parts.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tile/cube_subcases.hpp"

namespace tegl::detail {

/// The connected components of the high or low side of a cube. Any simplex whose vertices all belong to the list is a
/// simplex of the list. Any simplex in a square belongs to that square's triangulation, which depends on the square
/// only. The regions of all cubes around a tesseract therefore match. Once all vertices not in Sigma are moved inwards,
/// no simplex lies in the tesseract's boundary except those of Sigma.
class CubeRegions {
 public:
  static constexpr unsigned kFirstEdge = 8;                                      ///< after the corners
  static constexpr unsigned kFirstOwn = kFirstEdge + 12;                         ///< own vertices of the list
  static constexpr unsigned kFirstCentre = kFirstOwn + ResolvedCubes::kMostOwn;  ///< vertices that the region adds
  static constexpr unsigned kVertices = 32;  ///< maximum, not counting square centres
  /// In caps of the barycentric triangulation: barycentres of the high parts of squares.
  static constexpr unsigned kFirstSquare = kVertices;
  using Tetrahedron = std::array<std::uint8_t, 4>;

  struct Region {
    std::uint8_t corners;  ///< corners of the cube in the region
    std::uint8_t centre_count;
    std::uint16_t tetrahedron_count;
    std::uint32_t first_tetrahedron, first_centre;
  };

  /// For copies of a tesseract's sides. In a square, each polygon is a fan from its lowest corner.
  static const CubeRegions& instance(Triangulation triangulation = Triangulation::compact);
  /// For closing contours at the image border. Squares are triangulated as in tables::region_table, which closes
  /// contours of 3D images.
  static const CubeRegions& of_caps(Triangulation triangulation);

  /// Regions of list number `list`; kNone: of a cube entirely on that side.
  [[nodiscard]] std::span<const Region> regions(unsigned list, bool high) const noexcept {
    const unsigned at = 2 * (list == ResolvedCubes::kNone ? whole_ : list) + (high ? 1 : 0);
    return {regions_.data() + first_region_[at], regions_.data() + first_region_[at + 1]};
  }
  /// Oriented so that they induce, in the cube, the list's triangles with the list's orientation. kMoreTetrahedra
  /// undefined entries follow the last.
  static constexpr std::size_t kMoreTetrahedra = 3;
  [[nodiscard]] std::span<const Tetrahedron> tetrahedra(const Region& region) const noexcept {
    return {tetrahedra_.data() + region.first_tetrahedron, region.tetrahedron_count};
  }
  /// For each centre (local vertex kFirstCentre + j): the corners (bit v) and edges (bit 8 + e) whose mean it is near.
  [[nodiscard]] std::span<const std::uint32_t> centres(const Region& region) const noexcept {
    return {centres_.data() + region.first_centre, region.centre_count};
  }

 private:
  CubeRegions(Triangulation triangulation, bool has_square_centres);

  unsigned whole_;  ///< index of the cube without contour, after the lists
  std::vector<std::uint32_t> first_region_;
  std::vector<Region> regions_;
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<std::uint32_t> centres_;
};

}  // namespace tegl::detail
