// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of one tile by recursion over dimension. The facets of a tile's faces close up to a manifold on the
// tile's boundary (Sigma). One facet fills each component of Sigma.
//
// Based on: M. Liversage, thesis, 1994, sections 7.6 and 10.1 (recursion, barycentres). The filling of non-spherical
// components, the compact triangulation and the certificate are additions of tegl.
#pragma once

#include <memory>
#include <vector>

#include "base/lattice.hpp"
#include "base/tile_contour.hpp"
#include "embedding/embedding_proof.hpp"
#include "filling/face_contours.hpp"
#include "filling/hull.hpp"
#include "filling/tile_regions.hpp"

namespace tegl::gen {

/// Builds the contour of any signature of a lattice's n-tile, n = 1 to 4. The result depends on the signature only, and
/// in each face on the face's own signature only.
class ContourBuilder : public FaceContours {
 public:
  /// Builds n-tiles of `lattice`; n is at most its dimension. The lattice must outlive this object.
  ContourBuilder(const Lattice& lattice, int n, Alternative alternative, Triangulation triangulation);
  /// Builds compact, low-connected n-tiles, n = 3, 4, whose faces have the given contours, by signature. For n = 4:
  /// only tiles whose Sigma consists of spheres.
  ContourBuilder(const Lattice& lattice, int n, std::vector<TileContour> of_faces);
  ContourBuilder(const ContourBuilder&) = delete;
  ContourBuilder& operator=(const ContourBuilder&) = delete;

  /// Thread-safe. Throws std::logic_error if a component could not be filled (never for n <= 4).
  [[nodiscard]] TileContour build(Signature signature) const;

 private:
  void find_orientation();

  std::unique_ptr<HullContours> hulls_;             ///< for the compact triangulation, n >= 3
  std::unique_ptr<EmbeddingProof> proof_;           ///< for the compact triangulation, n >= 3
  std::unique_ptr<SignatureRegions> side_regions_;  ///< for 4-cubes: regions of the cubes, copied by side filling
};

/// The contours of every signature of a lattice's tiles of dimension 1 to n, indexed by dimension - 1, then signature.
[[nodiscard]] std::vector<std::vector<TileContour>> contours_by_dimension(const Lattice& lattice, int n,
                                                                          Alternative alternative,
                                                                          Triangulation triangulation);

}  // namespace tegl::gen
