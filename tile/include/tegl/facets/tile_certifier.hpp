// SPDX-License-Identifier: BSD-3-Clause
//
// Builds tiles and certifies them together with what they have in their faces, from the squares up.
#pragma once

#include <functional>
#include <memory>

#include "tegl/facets/certificate.hpp"
#include "tegl/facets/facets.hpp"

namespace tegl::facets {

/// The certificate of a tile says that its boundary is Sigma. This class shows as well that Sigma is right, whatever
/// the builder did: in each face it is the contour of that face built alone, hence the same for a neighbour that shares
/// the face; that one passes the certificate too, and so on down to the squares, whose edges have a point if and only
/// if their ends differ. Contours in faces are compared by sums of 64-bit hashes of their simplices. Faces of dimension
/// up to 3 are certified once for each signature and choices. One thread at a time.
class TileCertifier {
 public:
  /// Builds a tile of the lattice; what it returns is used up before its next call.
  using Build = std::function<const TileFacets&(Signature signature, const Resolution& resolution)>;

  /// Throws std::invalid_argument for a lattice of dimension less than 2.
  explicit TileCertifier(FaceLattice lattice);
  /// With tiles from elsewhere; what they have in their faces is built by FacetBuilder, alone.
  TileCertifier(FaceLattice lattice, Build build);
  ~TileCertifier();
  TileCertifier(TileCertifier&&) noexcept;             ///< moved from: good for nothing but to be assigned to
  TileCertifier& operator=(TileCertifier&&) noexcept;  ///< likewise

  [[nodiscard]] const FaceLattice& lattice() const&;  ///< what tiles are made of
  [[nodiscard]] FaceLattice lattice() const&&;        ///< of a temporary: a copy

  /// Builds and certifies a tile. Errors: as FacetBuilder::build.
  Fault certify(Signature signature, const Resolution& resolution);

  /// The tile built last, without geometry.
  [[nodiscard]] const TileFacets& tile() const&;
  [[nodiscard]] TileFacets tile() const&&;  ///< of a temporary: a copy

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegl::facets
