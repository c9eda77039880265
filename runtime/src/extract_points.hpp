// SPDX-License-Identifier: BSD-3-Clause
//
// From critical edges to points, a row at a time; compiled for several instruction sets, which all give the same bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "bitplanes.hpp"

namespace tegl::detail {

/// Writes the places of the bits set in `words` words, ascending; returns how many there are. `at` needs room for three
/// more.
std::size_t list_bits(const Word* bits, std::size_t words, std::uint32_t* at) noexcept;

/// Critical edges of a row along one axis, and where their points go.
template <int N, class Real>
struct EdgeRow {
  using Vertex = std::array<Real, N>;

  const std::uint32_t* at;  ///< by edge: its first sample along the row
  const double* alphas;     ///< by edge: the point's place on it
  std::size_t count;
  int axis;
  std::array<double, N> start;  ///< coordinates of the row; [0] means nothing
  double end;                   ///< axis > 0: the coordinate at the other end of the edges
  const double* along;          ///< coordinates along the row; null: uniform
  double origin, step;          ///< of uniform coordinates along the row
  const double* linear;         ///< N x N, row by row; null: points stay where they are
  const double* offset;
  /// Where the last coordinate has to stay; not a number: anywhere.
  std::array<Real, 2> inside;
  Vertex* out;
};

/// The points, by the arithmetic of Placement (extract_place.hpp).
template <int N, class Real>
void write_points(const EdgeRow<N, Real>& row) noexcept;

}  // namespace tegl::detail
