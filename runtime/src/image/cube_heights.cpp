// SPDX-License-Identifier: BSD-3-Clause
//
// Roots of the trilinear interpolant on rays.
#include "image/cube_heights.hpp"

#include <bit>
#include <cmath>

#include "image/ray_level.hpp"

namespace tegl::detail {

namespace {

/// Sums of the heights of the corners at each distance from the end of a ray: the interpolant at `x` is a multiple of
/// sum over k of sums[k] (1 + x)^(degree - k) (1 - x)^k.
struct SumsByDistance {
  std::array<double, 4> sums{};
  unsigned degree;

  SumsByDistance(const std::array<double, 8>& heights, std::uint32_t corners) noexcept {
    const auto end = static_cast<unsigned>(std::countr_zero(corners));
    const unsigned along = end ^ (31u - static_cast<unsigned>(std::countl_zero(corners)));  // axes of the corners
    degree = 3u - static_cast<unsigned>(std::popcount(along));
    static constexpr std::array<std::uint8_t, 8> kCount = {0, 1, 1, 2, 1, 2, 2, 3};
    for (unsigned v = 0; v < 8; ++v) sums[kCount[(v ^ end) & ~along & 7u]] += heights[v];
  }
};

/// The largest root in (0, 1) of a + b x + c x^2, or 0.
double quadratic_level(double a, double b, double c) noexcept {
  const double discriminant = b * b - 4.0 * a * c;
  if (!(discriminant >= 0.0)) return 0.0;
  const double w = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  const double first = w / c, second = a / w;
  double level = 0.0;
  if (first > level && first < 1.0) level = first;
  if (second > level && second < 1.0) level = second;
  return level;
}

}  // namespace

double CubeHeights::level(std::uint32_t corners) const noexcept {
  const SumsByDistance at_end(at, corners);
  const auto& [s0, s1, s2, s3] = at_end.sums;
  const double a = s0 + s1 + s2 + s3;
  double level;
  switch (at_end.degree) {
    case 1:
      level = a / (s1 - s0);
      if (!(level >= 0.0)) level = 0.0;
      break;
    case 2:
      level = quadratic_level(a, 2.0 * (s0 - s2), s0 - s1 + s2);
      break;
    default:
      level = last_root<4>({a, 3.0 * (s0 - s3) + s1 - s2, 3.0 * (s0 + s3) - s1 - s2, s0 - s1 + s2 - s3});
  }
  if (!is_finite_enough(a)) return 0.5;
  return level_inside(level, epsilon);
}

}  // namespace tegl::detail
