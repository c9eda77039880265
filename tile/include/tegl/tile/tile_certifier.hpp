// SPDX-License-Identifier: BSD-3-Clause
//
// Builds tiles and certifies each together with the contours in its faces, from the squares up.
#pragma once

#include <functional>
#include <memory>

#include "tegl/tile/certificate.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::tile {

/// Certifier proves that a tile's boundary is Sigma. This class also proves Sigma correct, whatever the builder did. In
/// each face, Sigma must equal the contour of that face built on its own, so a neighbour that shares the face has the
/// same one. That contour is certified in turn, down to the squares, whose edges have a point if and only if their two
/// corners differ. Contours in faces are compared by sums of 64-bit hashes of their simplices. Faces of dimension up to
/// 3 (with at most 32 faces of their own) are certified once per signature and choices. Not thread-safe.
class TileCertifier {
 public:
  /// Builds a tile of the lattice. The result is read before the next call and must stay valid until then.
  using Build = std::function<const TileFacets&(Signature signature, const Resolution& resolution)>;

  /// Throws std::invalid_argument for a lattice of dimension less than 2.
  explicit TileCertifier(FaceLattice lattice);
  /// Certifies tiles from `build`. The contours in their faces are compared with those of FacetBuilder.
  TileCertifier(FaceLattice lattice, Build build);
  ~TileCertifier();
  TileCertifier(TileCertifier&&) noexcept;             ///< a moved-from object may only be assigned to or destroyed
  TileCertifier& operator=(TileCertifier&&) noexcept;  ///< as the constructor

  [[nodiscard]] const FaceLattice& lattice() const&;  ///< the lattice of the tiles
  [[nodiscard]] FaceLattice lattice() const&&;        ///< for a temporary: a copy

  /// Builds and certifies a tile. Errors: as FacetBuilder::build.
  [[nodiscard]] Fault certify(Signature signature, const Resolution& resolution);

  /// The last tile; without geometry if it was built by FacetBuilder.
  [[nodiscard]] const TileFacets& tile() const&;
  [[nodiscard]] TileFacets tile() const&&;  ///< for a temporary: a copy

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegl::tile
