// SPDX-License-Identifier: BSD-3-Clause
//
// The contour on rays inside a tile: where the multilinear interpolant has the isovalue between the tile's centre and
// a point of its boundary. Copies of a side of the boundary have their vertices there.
#pragma once

#include <array>
#include <cstddef>

#include "image/many_rays.hpp"

namespace tegl::detail {

/// The interpolant in a tile of K dimensions, minus the isovalue, as a polynomial on rays from the centre.
template <int K>
class TileHeights {
 public:
  static constexpr std::size_t kCorners = std::size_t{1} << K;

  /// `at`: the samples at the corners minus the isovalue. `epsilon`: as ExtractOptions::epsilon.
  TileHeights(const std::array<double, kCorners>& at, double epsilon) noexcept;

  /// The contour's position on the ray from the centre (0) to `end` (1), in the unit tile: the last change of sign, of
  /// those that are a fourth apart. If there is none, the end with the smaller absolute height. Clamped, and a multiple
  /// of 2^-32: level_inside. 0.5 if a sample is infinite.
  [[nodiscard]] double level(const std::array<double, K>& end) const noexcept;

  /// Sets the levels of `rays`, equal to those of `level`.
  template <int M = K>  // a template, so that it is not instantiated with the class
  void find_levels(TesseractRays& rays) const noexcept requires(M == 4) {
    detail::find_levels(products_, epsilon_, rays);
  }
  [[nodiscard]] const std::array<double, kCorners>& products() const noexcept { return products_; }
  [[nodiscard]] double epsilon() const noexcept { return epsilon_; }

 private:
  /// Coefficients of the products of u_a = 2 x_a - 1 over sets of axes.
  std::array<double, kCorners> products_;
  double epsilon_;
};

}  // namespace tegl::detail
