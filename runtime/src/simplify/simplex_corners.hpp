// SPDX-License-Identifier: BSD-3-Clause
//
// The corners of simplices, gathered from the points of their vertices when they are used. Neighbouring simplices share
// points, so these stay in the cache; a copy of all corners would not.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "mesh/simplex_shapes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

template <int N>
class SimplexCorners {
 public:
  /// Both must outlive it.
  SimplexCorners(std::span<const std::array<Index, N>> simplices, std::span<const PointN<N>> points)
      : simplices_(simplices), points_(points) {}

  [[nodiscard]] std::size_t size() const noexcept { return simplices_.size(); }
  [[nodiscard]] CornersN<N> operator[](std::size_t s) const {
    CornersN<N> result;
    for (int i = 0; i < N; ++i) result[i] = points_[simplices_[s][i]];
    return result;
  }

 private:
  std::span<const std::array<Index, N>> simplices_;
  std::span<const PointN<N>> points_;
};

}  // namespace tegl::detail
