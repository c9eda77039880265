// SPDX-License-Identifier: BSD-3-Clause
//
// The contour on rays inside a cube: where the trilinear interpolant has the isovalue between the cube's centre and a
// point of its boundary. Vertices of tunnels are there.
#pragma once

#include <array>
#include <cstdint>

#include "image/ray_level.hpp"

namespace tegl::detail {

/// The samples at a cube's corners minus the isovalue, in the order of the cube's own corners.
struct CubeHeights {
  std::array<double, 8> at;
  double epsilon;  ///< as ExtractOptions::epsilon

  /// The contour's position on the ray from the cube's centre (0) to the mean of `corners` (1): those of a corner, an
  /// edge or a square of the cube, as a set of bits. Where the interpolant has the isovalue several times, the last one
  /// (on rays to corners, of those that are a fourth apart).
  /// Where nowhere, 0; on a ray to a square, the end whose height is smaller. Clamped to [kLeast, 1 - kLeast], or by
  /// epsilon if that is more. 0.5 if a sample is infinite. A multiple of 2^-32, so that positions computed from it are
  /// on the ray exactly.
  ///
  /// The interpolant is linear on rays to squares, quadratic on those to edges and cubic on those to corners.
  [[nodiscard]] double level(std::uint32_t corners) const noexcept;

  static constexpr double kLeast = kLeastRayLevel;
};

}  // namespace tegl::detail
