// SPDX-License-Identifier: BSD-3-Clause
//
// The contour on rays inside a cube: where the trilinear interpolant has the isovalue between the cube's centre and a
// point of its boundary. Vertices of tunnels are there.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
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

/// Rays in many cubes, all to corners, all to edges or all to squares.
struct CubeRays {
  static constexpr std::size_t kMost = 16;

  std::size_t count = 0;
  /// Heights at the cube's corners, those nearest to the ray's end first. `cube_levels` writes zeros from `count` on.
  alignas(64) std::array<std::array<double, kMost>, 8> heights;

  /// `corners`: the ray's end, as for CubeHeights::level.
  void add(const std::array<double, 8>& of_cube, std::uint32_t corners) noexcept {
    const std::array<std::uint8_t, 8>& nearest = kNearest[corners];
    for (std::size_t i = 0; i < 8; ++i) heights[i][count] = of_cube[nearest[i]];
    ++count;
  }

 private:
  /// By end: the corners by their distance from it, which counts no axis along which the end's corners differ.
  static constexpr auto kNearest = [] {
    std::array<std::array<std::uint8_t, 8>, 256> result{};
    for (unsigned corners = 1; corners < 256; ++corners) {
      const auto end = static_cast<unsigned>(std::countr_zero(corners));
      const unsigned along = end ^ (31u - static_cast<unsigned>(std::countl_zero(corners)));
      std::size_t count = 0;
      for (int distance = 0; distance <= 3; ++distance)
        for (unsigned v = 0; v < 8; ++v)
          if (std::popcount((v ^ end) & ~along) == distance) result[corners][count++] = static_cast<std::uint8_t>(v);
    }
    return result;
  }();
};

/// CubeHeights::level of all rays, by registers. `degree`: of the interpolant on them: 3, 2, 1 on rays to corners,
/// edges and squares.
void cube_levels(CubeRays& rays, unsigned degree, double epsilon, std::array<double, CubeRays::kMost>& out) noexcept;

}  // namespace tegl::detail
