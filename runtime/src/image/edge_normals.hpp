// SPDX-License-Identifier: BSD-3-Clause
//
// Unit normals from the values around critical edges, one row at a time. Compiled for several instruction sets; all
// give identical bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"
#include "image/gradient.hpp"

namespace tegl::detail {

/// Up to kEdgesAtOnce edges of a row along one axis. Calc: type of the arithmetic.
template <int N, class Real, class Calc>
struct NormalRow {
  using Vertex = std::array<Real, N>;
  const Calc* values;    ///< kEdgeValues x kEdgesAtOnce: the samples around each edge; undefined from `count` on
  const double* alphas;  ///< by edge: its vertex's position on it; up to 15 entries past the end are read
  std::size_t count;
  int axis;
  /// By axis: weights of the backward and forward difference at the first end, then at the second.
  std::array<std::array<Calc, 4>, N> weights;
  /// 4 x kEdgesAtOnce: weights[0] by edge, if they differ: samples along the row are not equidistant, or edges are at
  /// its ends. Otherwise null.
  const Calc* row_weights;
  const Calc* to_world;  ///< N x N, row-major, transforms gradients; null: only `sign` applies
  Calc sign;
  Vertex* out;
};

/// Writes normals of length 1. Returns as bits the edges whose gradient is too small, too large or not finite; their
/// normals are undefined.
template <int N, class Real, class Calc>
Word write_normals(const NormalRow<N, Real, Calc>& row) noexcept;

}  // namespace tegl::detail
