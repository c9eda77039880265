// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate of the tables' entries: proves by computation, independently of the filling, that neighbouring tiles
// match. Tables are written only after every entry has passed.
#pragma once

#include <vector>

#include "filling/facets.hpp"
#include "tegl/tile/certificate.hpp"

namespace tegl::gen {

/// Certifies the contours of one builder with tile::Certifier. Sigma is taken from the builder's faces, not from the
/// contour. Not thread-safe.
class TableCertifier {
 public:
  /// `builder` must outlive it; n = 2, 3, 4.
  explicit TableCertifier(const ContourBuilder& builder);

  /// Returns the fault of a tile's contour, or Fault::none. May be called for any number of signatures in sequence.
  tile::Fault certify(Signature signature, const TileContour& contour);

 private:
  const ContourBuilder& builder_;
  tile::FaceLattice lattice_;
  std::vector<std::uint32_t> face_;  ///< by maximal face of the lattice: its number in the tile
  tile::TileFacets tile_;
  tile::Certifier certifier_;
};

/// Certifies a single tile with a temporary TableCertifier.
tile::Fault certify(const ContourBuilder& builder, Signature signature, const TileContour& contour);

}  // namespace tegl::gen
