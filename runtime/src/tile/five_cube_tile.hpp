// SPDX-License-Identifier: BSD-3-Clause
//
// Compact tiles of 5D images, built by the emitted builder of 5-cubes, in the form that an extraction reads.
#pragma once

#include <memory>

#include "tile/built_tile.hpp"

namespace tegl::detail {

/// Builds compact tiles of 5D images. A maker keeps only its working storage.
std::unique_ptr<TileMaker> five_cube_maker(const TileKind& kind);

}  // namespace tegl::detail
