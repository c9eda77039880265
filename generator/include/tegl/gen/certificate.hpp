// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate: a filled tile is shown, by computation and without trust in how it was made, to be what two
// neighbours can share. Tables are written only after every entry has passed.
#pragma once

#include <string>

#include "tegl/gen/facets.hpp"

namespace tegl::gen {

/// Why a filled tile fails. `None`: it passed.
enum class Fault {
  None,
  RepeatedVertex,  ///< a simplex with a vertex twice, or two equal simplices
  Boundary,        ///< (1) the boundary is not Sigma, simplex by simplex and with its orientation
  Branching,       ///< an (n-2)-face in more than two simplices
  Link,            ///< (2) an interior vertex whose link is no sphere, or one on Sigma whose link is no ball
  Orientation,     ///< (3) two simplices that induce the same orientation on the face they share
  InTileBoundary,  ///< (4) a simplex in the tile's boundary that is not one of Sigma's own
};

const char* fault_name(Fault fault) noexcept;

struct Certificate {
  Fault fault = Fault::None;
  std::string detail;  ///< the simplex or vertex where it failed
  [[nodiscard]] bool passed() const { return fault == Fault::None; }
};

/// Checks the contour of one tile, n = 2, 3, 4: (1) its boundary is Sigma exactly; (2) the link of every interior
/// vertex is an (n-2)-sphere, of every vertex on Sigma an (n-2)-ball; (3) orientations agree; (4) every simplex
/// whose vertices all lie in one face of the tile belongs to Sigma's triangulation in that face.
/// Sigma is taken from the builder's faces, not from the contour.
Certificate certify(const ContourBuilder& builder, Signature signature, const TileContour& contour);

}  // namespace tegl::gen
