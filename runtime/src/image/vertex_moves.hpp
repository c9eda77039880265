// SPDX-License-Identifier: BSD-3-Clause
//
// An interface of sources of samples whose contours have vertices off the edges of the grid. The extraction by tables
// looks for it; vertices inside cells are computed from the unmoved ones.
#pragma once

#include <array>
#include <cstddef>

#include "image/sample_source.hpp"

namespace tegl::detail {

template <int N>
class VertexMoves {
 public:
  /// Moves vertices on edges along `axis` that start in layer k, at most kWordBits, with these interpolation
  /// parameters.
  virtual void move(std::size_t k, int axis, const EdgesInRows& edges, const double* alphas,
                    std::array<float, N>* vertices) const noexcept = 0;
  virtual void move(std::size_t k, int axis, const EdgesInRows& edges, const double* alphas,
                    std::array<double, N>* vertices) const noexcept = 0;

 protected:
  ~VertexMoves() = default;
};

}  // namespace tegl::detail
