// SPDX-License-Identifier: BSD-3-Clause
//
// From the values around critical edges to unit normals, a row at a time; compiled for several instruction sets, which
// all give the same bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"
#include "image/gradient.hpp"

namespace tegl::detail {

/// Up to kEdgesAtOnce edges of a row along one axis. Calc: the type of the arithmetic.
template <int N, class Real, class Calc>
struct NormalRow {
  using Vertex = std::array<Real, N>;
  /// Values per edge: those around it, and its point's place.
  static constexpr unsigned kValues = kEdgeValues<N> + 1;

  const Calc* values;  ///< kValues x kEdgesAtOnce; beyond `count` anything
  std::size_t count;
  int axis;
  /// By axis: what the differences at the first end backward and forward, then at the second, are multiplied by.
  std::array<std::array<Calc, 4>, N> weights;
  /// Where the distances along the row differ, weights [0] by edge: 4 x kEdgesAtOnce. Else null.
  const Calc* row_weights;
  const Calc* to_world;  ///< N x N, row by row, carries gradients along; null: only `sign` does
  Calc sign;
  Vertex* out;
};

/// Writes normals of length 1. Returns, as bits, the edges whose gradient is too small, too large or not finite: what
/// is written for those means nothing.
template <int N, class Real, class Calc>
Word write_normals(const NormalRow<N, Real, Calc>& row) noexcept;

}  // namespace tegl::detail
