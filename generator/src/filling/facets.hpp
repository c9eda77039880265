// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of one tile, by recursion over dimension: the facets of a tile's faces close up to a manifold
// on the tile's boundary (Sigma); each of its components is filled by one facet.
//
// Based on: M. Liversage, thesis, 1994, sections 7.6 and 10.1 (recursion, barycentres); the filling of
// components that are no spheres, the compact triangulation and the certificate go beyond it.
#pragma once

#include <memory>
#include <vector>

#include "base/lattice.hpp"
#include "filling/face_contours.hpp"
#include "filling/hull.hpp"
#include "filling/tile_contour.hpp"
#include "filling/tile_regions.hpp"

namespace tegl::gen {

/// Builds the contour of any signature of a lattice's n-tile, n = 1 ... 4, by one rule.
/// The result depends on the signature alone, and in each face on the face's own signature alone.
class ContourBuilder : public FaceContours {
 public:
  /// For n-tiles of a lattice, n at most its dimension. The lattice must outlive it.
  ContourBuilder(const Lattice& lattice, int n, Alternative alternative, Triangulation triangulation);
  ContourBuilder(const ContourBuilder&) = delete;
  ContourBuilder& operator=(const ContourBuilder&) = delete;

  /// Thread safe. Throws std::logic_error where a component could not be filled (never for n <= 4).
  [[nodiscard]] TileContour build(Signature signature) const;

 private:
  void find_orientation();

  std::unique_ptr<HullContours> hulls_;             ///< compact, n >= 3
  std::unique_ptr<SignatureRegions> side_regions_;  ///< 4-cubes: of the cubes that side filling copies
};

/// The contours of every signature of a lattice's tiles of dimension 1 to n, by dimension - 1 and signature.
[[nodiscard]] std::vector<std::vector<TileContour>> contours_by_dimension(const Lattice& lattice, int n,
                                                                          Alternative alternative,
                                                                          Triangulation triangulation);

}  // namespace tegl::gen
