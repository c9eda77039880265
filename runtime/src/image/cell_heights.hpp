// SPDX-License-Identifier: BSD-3-Clause
//
// The contour on rays inside a cell, by the dimension of the cell.
#pragma once

#include <type_traits>

#include "image/cube_heights.hpp"
#include "image/tile_heights.hpp"

namespace tegl::detail {

/// Heights at the corners of a cell of K dimensions, from which levels of rays are computed.
template <int K>
using CellHeights = std::conditional_t<K == 3, CubeHeights, TileHeights<K>>;

}  // namespace tegl::detail
