// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices on critical edges, one row at a time. Compiled for several instruction sets; all give identical bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"

namespace tegl::detail {

/// Writes the positions of the bits set in `words` words to `at`, ascending. Returns their number. `at` needs capacity
/// for three additional entries.
std::size_t list_bits(const Word* bits, std::size_t words, std::uint32_t* at) noexcept;

/// Critical edges along one axis in rows of one layer, and the destination of their vertices.
template <int N, class Real>
struct EdgePoints {
  using Vertex = std::array<Real, N>;

  const std::uint32_t* at;  ///< by edge: its first sample along the row
  const double* alphas;     ///< by edge: interpolation parameter of its vertex
  std::size_t count;
  int axis;
  bool in_one_row;                     ///< `start` and `end` have one entry for all edges
  std::array<const double*, N> start;  ///< for axes 1 ... N - 2, by edge: coordinate of its row
  const double* end;                   ///< for those axes, by edge: coordinate at its other end
  double layer, next_layer;            ///< coordinates of the layer and of the next one
  const double* along;                 ///< coordinates along the row; null: uniform
  double origin, step;                 ///< of uniform coordinates along the row
  const double* linear;                ///< N x N, row-major; null: no world map
  const double* offset;
  /// Range for the last coordinate; NaN: no restriction.
  std::array<Real, 2> inside;
  Vertex* out;
};

/// Writes the vertices, with the same arithmetic as Placement (placement.hpp).
template <int N, class Real>
void write_points(const EdgePoints<N, Real>& edges) noexcept;

}  // namespace tegl::detail
