// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate of the tables' entries: a filled tile is shown, by computation and without trust in how it was made,
// to be what two neighbours can share. Tables are written only after every entry has passed.
#pragma once

#include <vector>

#include "filling/facets.hpp"
#include "tegl/facets/certificate.hpp"

namespace tegl::gen {

/// Certifies the contours of one builder (facets::Certifier). Sigma is taken from the builder's faces, not from the
/// contour. One thread at a time.
class TableCertifier {
 public:
  /// `builder` must outlive it; n = 2, 3, 4.
  explicit TableCertifier(const ContourBuilder& builder);

  /// What is wrong with a tile's contour, if anything; for all signatures one after the other.
  facets::Fault certify(Signature signature, const TileContour& contour);

 private:
  const ContourBuilder& builder_;
  facets::FaceLattice lattice_;
  std::vector<std::uint32_t> face_;  ///< by maximal face of the lattice: the tile's number of it
  facets::TileFacets tile_;
  facets::Certifier certifier_;
};

/// The same for a single tile.
facets::Fault certify(const ContourBuilder& builder, Signature signature, const TileContour& contour);

}  // namespace tegl::gen
