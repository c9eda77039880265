// SPDX-License-Identifier: BSD-3-Clause
//
// The high and the low part of a cube whose contour is a list of the table of the cube with every ambiguity resolved
// freely, in tetrahedra: what a copy of one side of a tesseract's boundary is put together from.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tile/cube_subcases.hpp"

namespace tegl::detail {

/// The connected parts of the high or of the low side of a cube. Any simplex whose vertices are the list's is the
/// list's, and any whose vertices lie in one square is part of that square's own triangulation, which depends on the
/// square alone. So the parts of all cubes around a tesseract fit together, and what they make has no simplex in the
/// tesseract's boundary but those of Sigma, once all vertices that are not Sigma's are moved inwards.
class CubeRegions {
 public:
  static constexpr unsigned kFirstEdge = 8;                                      ///< after the corners
  static constexpr unsigned kFirstOwn = kFirstEdge + 12;                         ///< own vertices of the list
  static constexpr unsigned kFirstCentre = kFirstOwn + ResolvedCubes::kMostOwn;  ///< vertices of the region
  static constexpr unsigned kVertices = 32;                                      ///< at most, but for the next
  /// In the regions of caps in the barycentric triangulation: barycentres of the high parts of squares.
  static constexpr unsigned kFirstSquare = kVertices;
  using Tetrahedron = std::array<std::uint8_t, 4>;

  struct Region {
    std::uint8_t corners;  ///< the cube's corners in it
    std::uint8_t centre_count;
    std::uint16_t tetrahedron_count;
    std::uint32_t first_tetrahedron, first_centre;
  };

  /// What sides of tesseracts are copied from. In a square each polygon is a fan from its lowest corner.
  static const CubeRegions& instance(int triangulation = kCompact);
  /// What closes contours at the image's border: the squares are those of tables::region_table, which close contours of
  /// 3D images.
  static const CubeRegions& of_caps(int triangulation);

  /// Of list number `list`; kNone: of a cube all on that side.
  [[nodiscard]] std::span<const Region> regions(unsigned list, bool high) const noexcept {
    const unsigned at = 2 * (list == ResolvedCubes::kNone ? whole_ : list) + (high ? 1 : 0);
    return {regions_.data() + first_region_[at], regions_.data() + first_region_[at + 1]};
  }
  /// Oriented so that the triangles of the list that they induce are those of the list, in the cube. Behind them stand
  /// kMoreTetrahedra, whatever they are.
  static constexpr std::size_t kMoreTetrahedra = 3;
  [[nodiscard]] std::span<const Tetrahedron> tetrahedra(const Region& region) const noexcept {
    return {tetrahedra_.data() + region.first_tetrahedron, region.tetrahedron_count};
  }
  /// Of each centre, local vertex kFirstCentre + j: the corners (bit v) and edges (bit 8 + e) whose mean it is near.
  [[nodiscard]] std::span<const std::uint32_t> centres(const Region& region) const noexcept {
    return {centres_.data() + region.first_centre, region.centre_count};
  }

 private:
  CubeRegions(int triangulation, bool has_square_centres);

  unsigned whole_;  ///< number in place of a list's
  std::vector<std::uint32_t> first_region_;
  std::vector<Region> regions_;
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<std::uint32_t> centres_;
};

}  // namespace tegl::detail
