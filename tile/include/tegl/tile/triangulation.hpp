// SPDX-License-Identifier: BSD-3-Clause
//
// How the facets of a tile are divided into simplices. The values are the numbers of the generated tables.
#pragma once

#include <cstdint>

namespace tegl {

/// How a tile's facets are divided into simplices. barycentric: cones from barycentres, with more simplices of better
/// shape. compact: few simplices; see docs/limits.md for intersections in 4D and biased volumes. In 5D both values mean
/// barycentric.
enum class Triangulation : std::uint8_t { barycentric = 0, compact = 1 };

}  // namespace tegl
