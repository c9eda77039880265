// SPDX-License-Identifier: BSD-3-Clause
//
// Certifies the filling of one tile of any dimension by computation, independently of how it was filled.
#pragma once

#include <cstdint>
#include <memory>

#include "tegl/tile/facets.hpp"

namespace tegl::tile {

/// Why a filled tile fails.
enum class Fault : std::uint8_t {
  none,
  repeated_vertex,   ///< a simplex with a vertex twice, or two equal simplices
  branching,         ///< an (n-2)-simplex in more than two simplices
  orientation,       ///< two simplices that induce the same orientation on the one they share
  sigma,             ///< Sigma differs from the union of the contours in the faces
  boundary,          ///< (1) the boundary differs from Sigma in a simplex or in an orientation
  bubble,            ///< a component without boundary
  link,              ///< (2) link not proved a sphere (interior vertex) or a ball (vertex on Sigma)
  in_tile_boundary,  ///< (4) a simplex in the tile's boundary that is not a simplex of Sigma
};

/// The enumerator's name in words, for messages.
[[nodiscard]] const char* fault_name(Fault fault) noexcept;

/// Checks tiles one after the other and reuses its memory. Not thread-safe: one thread at a time.
class Certifier {
 public:
  Certifier();
  ~Certifier();
  Certifier(Certifier&&) noexcept;             ///< a moved-from object may only be assigned to or destroyed
  Certifier& operator=(Certifier&&) noexcept;  ///< as the constructor

  /// Checks the contour of one tile of dimension n >= 2:
  /// (1) its boundary is Sigma exactly, Sigma is the union of the contours in the tile's faces, with the signs of the
  /// faces in the tile's boundary, and every component has a boundary;
  /// (2) the link of every interior vertex is an (n-2)-sphere, and of every vertex on Sigma an (n-2)-ball;
  /// (3) orientations agree;
  /// (4) every simplex whose vertices all lie in one face of the tile belongs to the contour in that face.
  /// The contours in the faces are assumed correct; TileCertifier certifies them too. The certificate is combinatorial:
  /// it does not prove that the positions embed the complex, nor does it identify which of several fillings the complex
  /// is. Throws std::invalid_argument for malformed input: a wrong number of vertices in a simplex, indices out of
  /// range, more than 64 faces of codimension one.
  [[nodiscard]] Fault certify(const FaceLattice& lattice, const TileFacets& tile);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Checks a single tile with a temporary Certifier.
[[nodiscard]] Fault certify(const FaceLattice& lattice, const TileFacets& tile);

}  // namespace tegl::tile
