// SPDX-License-Identifier: BSD-3-Clause
//
// The faces of the 5-cube as C++ text (private to the generator).
#pragma once

#include <string>

namespace tegl::gen {

/// Definitions of the static members of FiveCube and of kEdgesOfTesseracts, for the builder of 5-cubes.
[[nodiscard]] std::string five_cube_faces();

/// Checks the numbers of the faces against the face lattice of the 5-cube. Throws Error{CertificateFailed}.
void certify_five_cube_faces();

}  // namespace tegl::gen
