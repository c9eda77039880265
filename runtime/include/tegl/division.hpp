// SPDX-License-Identifier: BSD-3-Clause
//
// Images whose cells are divided into simplices: contours without ambiguous cells, with more simplices.
//
// Based on: M. Liversage, thesis, 1994, section 9.3: asymmetric and symmetric divisions in any dimension, and the
// hybrid of 9.3.12.
#pragma once

#include <cstdint>
#include <string_view>

#include "tegl/complex.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// How the cells of a grid are divided.
enum class Division : std::uint8_t {
  /// Kuhn's: N! simplices (2, 6, 24), each along a path from the lowest to the highest corner. The same in all cells,
  /// so
  /// contours prefer one diagonal.
  kuhn,
  /// 2 triangles or 5 tetrahedra. Neighbouring cells are mirror images of each other. Not in 4D.
  alternating,
  /// 2^(N-1) N! simplices (4, 24, 192): cones over the faces from their centres. The value of a centre is the mean of
  /// the face's corners. All symmetries of the cell.
  symmetric,
  /// As `symmetric`, but only in cells that are ambiguous at the isovalue, and there only their ambiguous faces have
  /// centres: other faces are squares, as in the neighbours, so there are no cracks. Most cells are not divided. Not in
  /// 4D.
  hybrid,
};

/// The name of a division, such as "kuhn".
[[nodiscard]] std::string_view name_of(Division division) noexcept;

/// The cells of an image's grid, divided, with the values of the samples. `extract` of it is the contour. Points are
/// numbered as samples, axis 0 fastest; centres follow. `isovalue`: for `hybrid`, the isovalue of the contour; ignored
/// otherwise. Cells with missing corners have no contour. Errors: InvalidArgument (a division that the dimension does
/// not have), TooLarge (2^32 points or cells or more). O(P) time; per sample about 130 bytes in 3D (kuhn), 660
/// (symmetric); in 4D 600 and 5 000.
template <Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Complex<N> divided_complex(const Image<T, N>& image, Division division, double isovalue = 0.0);

}  // namespace tegl
