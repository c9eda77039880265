// SPDX-License-Identifier: BSD-3-Clause
//
// From critical edges to points, a row at a time; compiled for several instruction sets, which all give the same bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"

namespace tegl::detail {

/// Writes the places of the bits set in `words` words, ascending; returns how many there are. `at` needs room for three
/// more.
std::size_t list_bits(const Word* bits, std::size_t words, std::uint32_t* at) noexcept;

/// Critical edges along one axis in rows of one layer, and where their points go.
template <int N, class Real>
struct EdgePoints {
  using Vertex = std::array<Real, N>;

  const std::uint32_t* at;  ///< by edge: its first sample along the row
  const double* alphas;     ///< by edge: the point's place on it
  std::size_t count;
  int axis;
  std::array<const double*, N> start;  ///< for axes 1 ... N - 2, by edge: the coordinate of its row
  const double* end;                   ///< for those axes, by edge: the coordinate at the other end
  double layer, next_layer;            ///< coordinates of the layer and of the next
  const double* along;                 ///< coordinates along the row; null: uniform
  double origin, step;                 ///< of uniform coordinates along the row
  const double* linear;                ///< N x N, row by row; null: points stay where they are
  const double* offset;
  /// Where the last coordinate has to stay; not a number: anywhere.
  std::array<Real, 2> inside;
  Vertex* out;
};

/// The points, by the arithmetic of Placement (extract_place.hpp).
template <int N, class Real>
void write_points(const EdgePoints<N, Real>& edges) noexcept;

}  // namespace tegl::detail
