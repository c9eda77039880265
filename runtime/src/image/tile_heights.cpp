// SPDX-License-Identifier: BSD-3-Clause
//
// Roots of the multilinear interpolant on rays of tiles.
#include "image/tile_heights.hpp"

#include <bit>
#include <cmath>
#include <type_traits>
#include <utility>

#include "image/ray_level.hpp"

namespace tegl::detail {

template <int K>
TileHeights<K>::TileHeights(const std::array<double, kCorners>& at, double epsilon) noexcept
    : products_(at), epsilon_(epsilon) {
  // Walsh-Hadamard transform: sum and difference along each axis. A common factor does not matter.
  double* const values = products_.data();
  const auto transform = [&]<std::size_t Step>(std::integral_constant<std::size_t, Step>) {
    const auto pair = [&](std::size_t v) {
      const double low = values[v], high = values[v + Step];
      values[v] = high + low;
      values[v + Step] = high - low;
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) { (pair(I / Step * 2 * Step + I % Step), ...); }
    (std::make_index_sequence<kCorners / 2>());
  };
  [&]<std::size_t... A>(std::index_sequence<A...>) {
    (transform(std::integral_constant<std::size_t, std::size_t{1} << A>{}), ...);
  }
  (std::make_index_sequence<K>());
}

template <int K>
double TileHeights<K>::level(const std::array<double, K>& end) const noexcept {
  std::array<double, K + 1> by_degree{};
  // unrolled, so that degrees are constants: the weight of a set of axes is the product of u over them
  [&]<std::size_t... Set>(std::index_sequence<Set...>) {
    std::array<double, kCorners> weights;
    const auto add = [&]<std::size_t S>(std::integral_constant<std::size_t, S>) {
      if constexpr (S == 0) {
        weights[0] = 1.0;
      } else {
        constexpr std::size_t kLast = std::bit_width(S) - 1;
        weights[S] = weights[S ^ std::size_t{1} << kLast] * (2.0 * end[kLast] - 1.0);
      }
      by_degree[std::popcount(S)] += products_[S] * weights[S];
    };
    (add(std::integral_constant<std::size_t, Set>{}), ...);
  }
  (std::make_index_sequence<kCorners>());
  if (!is_finite_enough(products_[0])) return 0.5;
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
