// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate of a filled tile of any dimension: shown by computation, without trust in how it was filled.
#pragma once

#include <cstdint>
#include <memory>

#include "tegl/facets/facets.hpp"

namespace tegl::facets {

/// Why a filled tile fails. `none`: it passed.
enum class Fault : std::uint8_t {
  none,
  repeated_vertex,   ///< a simplex with a vertex twice, or two equal simplices
  branching,         ///< an (n-2)-simplex in more than two simplices
  orientation,       ///< two simplices that induce the same orientation on the one they share
  sigma,             ///< Sigma is not what the contours in the faces make
  boundary,          ///< (1) the boundary is not Sigma, simplex by simplex and with its orientation
  bubble,            ///< a component that has no boundary
  link,              ///< (2) an interior vertex whose link is not shown to be a sphere, or one on Sigma, a ball
  in_tile_boundary,  ///< (4) a simplex in the tile's boundary that is not one of Sigma's own
};

/// The name of a fault as in the enumeration, for messages.
const char* fault_name(Fault fault) noexcept;

/// Checks tiles, one after the other; its memory is kept. One thread at a time.
class Certifier {
 public:
  Certifier();
  ~Certifier();
  Certifier(Certifier&&) noexcept;             ///< moved from: good for nothing but to be assigned to
  Certifier& operator=(Certifier&&) noexcept;  ///< likewise

  /// Checks the contour of one tile of dimension n >= 2: (1) its boundary is Sigma exactly, and Sigma is what the
  /// contours in the tile's faces make, with the signs of the faces in the tile's boundary; no component is without
  /// boundary; (2) the link of every interior vertex is an (n-2)-sphere, of every vertex on Sigma an (n-2)-ball; (3)
  /// orientations agree; (4) every simplex whose vertices all lie in one face of the tile belongs to the contour in
  /// that face. The contours in the faces are taken as they are (TileCertifier certifies these too). What is shown is
  /// about the complex: not that positions embed it, nor which of several fillings it is.
  Fault certify(const FaceLattice& lattice, const TileFacets& tile);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same for a single tile.
Fault certify(const FaceLattice& lattice, const TileFacets& tile);

}  // namespace tegl::facets
