// SPDX-License-Identifier: BSD-3-Clause
//
// The triangulated high part of a tile, built from the contours of the tile and of its faces.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/tile_contour.hpp"
#include "embedding/region_maker.hpp"

namespace tegl::gen {

/// cone: every region that is not a simplex is coned from its barycentre, or in a cube from the barycentre of its only
/// facet, so no chord joins two contour points. fan: regions of squares are fans from a corner instead.
enum class RegionStyle { cone, fan };

/// The high part of a k-tile (k <= 3): disjoint balls. Local vertices as in the table contract (RegionTable).
struct TileRegions {
  std::vector<LocalSimplex> simplices;   ///< k + 1 vertices each, det > 0
  std::vector<std::uint32_t> own_masks;  ///< one per own vertex: corners (bit v) and edges (bit 2^k + e)
};

/// The regions of every signature of a k-tile, k = 1, 2, 3.
class SignatureRegions {
 public:
  /// Builds k-tiles of `lattice`, which must outlive this object. `contours[d - 1]`: the contours of every signature of
  /// the d-tile, d = 1 to k. `is_cap`: divides the regions of a 3-cube by
  /// divide_region if the style is `fan`. Throws Error{CertificateFailed} if one is not proved.
  SignatureRegions(const Lattice& lattice, int k, std::span<const std::vector<TileContour>> contours, RegionStyle style,
                   bool is_cap = false);

  /// The regions of a signature.
  [[nodiscard]] const TileRegions& regions(Signature signature) const { return regions_[signature]; }
  [[nodiscard]] const Tile& tile() const { return *tile_; }  ///< the tile
  [[nodiscard]] std::uint32_t own_base() const;              ///< first local number of a tile's own vertices
  /// The corners (bit v) and edge points (bit 2^k + e) of which a local vertex is the mean. Not defined for the
  /// barycentres of the contour's facets.
  [[nodiscard]] std::uint32_t mask_of(Signature signature, std::uint8_t vertex) const;

 private:
  [[nodiscard]] TileRegions build(Signature signature, const TileContour& contour) const;
  [[nodiscard]] std::optional<RegionDivision> divided(const TileContour& contour,
                                                      std::span<const LocalSimplex> surface) const;
  [[nodiscard]] std::vector<LocalSimplex> boundary(Signature signature, const TileContour& contour) const;
  [[nodiscard]] std::uint8_t only_barycentre(const TileContour& contour, const std::array<bool, 256>& region) const;
  [[nodiscard]] std::uint8_t lift(std::uint32_t f, std::uint8_t vertex) const;

  const Tile* tile_;
  RegionStyle style_;
  std::unique_ptr<RegionProof> proof_;          ///< to divide the regions of a cap
  std::unique_ptr<SignatureRegions> of_faces_;  ///< k > 1
  std::vector<TileRegions> regions_;
};

}  // namespace tegl::gen
