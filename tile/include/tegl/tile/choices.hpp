// SPDX-License-Identifier: BSD-3-Clause
//
// How the ambiguous faces of a tile are resolved.
#pragma once

#include <cstdint>

namespace tegl::tile {

/// How a face of dimension 2 or more fills its contour.
enum class Choice : std::uint8_t {
  separate,  ///< spheres are coned; other components and ambiguous polygons follow the default alternative
  low,       ///< the centre is low: high regions of the boundary are copied, or coned if one sphere bounds them
  high,      ///< the centre is high: low regions of the boundary are copied, or coned if one sphere bounds them
};

/// The sign of all centres that `Choice` leaves open. low: the high corners of an ambiguous face are separate; high:
/// they are connected. The values are the numbers of the generated tables.
enum class Alternative : std::uint8_t { low = 0, high = 1 };

}  // namespace tegl::tile
