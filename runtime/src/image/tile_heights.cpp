// SPDX-License-Identifier: BSD-3-Clause
//
// Roots of the multilinear interpolant on rays of tiles.
#include "image/tile_heights.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "image/ray_level.hpp"

namespace tegl::detail {

template <int K>
TileHeights<K>::TileHeights(const std::array<double, kCorners>& at, double epsilon) noexcept
    : products_(at), epsilon_(epsilon) {
  // Walsh-Hadamard transform: mean and half of the difference along each axis
  for (std::size_t step = 1; step < kCorners; step *= 2)
    for (std::size_t v = 0; v < kCorners; ++v)
      if ((v & step) == 0) {
        const double low = products_[v], high = products_[v | step];
        products_[v] = 0.5 * low + 0.5 * high;
        products_[v | step] = 0.5 * high - 0.5 * low;
      }
}

template <int K>
double TileHeights<K>::level(const std::array<double, K>& end) const noexcept {
  std::array<double, kCorners> weights;
  weights[0] = 1.0;
  std::array<double, K + 1> by_degree{};
  by_degree[0] = products_[0];
  for (int a = 0; a < K; ++a) {
    const double u = 2.0 * end[a] - 1.0;
    const std::size_t first = std::size_t{1} << a;
    for (std::size_t set = 0; set < first; ++set) weights[first + set] = u * weights[set];
  }
  for (std::size_t set = 1; set < kCorners; ++set)
    by_degree[static_cast<std::size_t>(std::popcount(set))] += products_[set] * weights[set];
  if (!(std::abs(products_[0]) <= std::numeric_limits<double>::max() / 64)) return 0.5;
  double level = last_root(by_degree);
  if (level < 0.0) {
    const double at_end = polynomial_value(by_degree, 1.0);
    level = std::abs(at_end) < std::abs(by_degree[0]) ? 1.0 : 0.0;
  }
  return level_inside(level, epsilon_);
}

template class TileHeights<4>;
template class TileHeights<5>;

}  // namespace tegl::detail
