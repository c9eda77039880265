// SPDX-License-Identifier: BSD-3-Clause
//
// Own vertices of cubes and tesseracts at the means of points on edges, of many cells at once. Compiled for several
// instruction sets, the best of which is chosen at run time; all give identical bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tegl/table_contract.hpp"

namespace tegl::detail {

/// In cells of K axes, K = 3 or 4.
template <int K>
struct EdgeMeans {
  static constexpr std::size_t kMost = 16;
  using Coordinates = std::array<std::array<double, kMost>, K>;

  std::size_t count = 0;
  std::array<std::uint32_t, kMost> edges;  ///< of each mean, as bits
  /// By edge and mean: position of the point on the edge, from 0 to 1.
  alignas(64) std::array<std::array<double, kMost>, tables::edge_count(K)> alphas;
};

/// Coordinates in the cell, equal to mask_place.
template <int K>
void find_means(const EdgeMeans<K>& means, typename EdgeMeans<K>::Coordinates& out) noexcept;

}  // namespace tegl::detail
