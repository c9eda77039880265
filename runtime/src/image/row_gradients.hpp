// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at all samples of a row, and unit normals on its critical edges. Compiled for several
// instruction sets; all give the bytes of write_normals (edge_normals.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"
#include "image/gradient.hpp"

namespace tegl::detail {

/// Samples that arrays over a row have room for past its end: vector code reads and writes whole registers.
inline constexpr std::size_t kRowMargin = 32;

/// Length of the shortest row whose gradients are computed by registers.
inline constexpr std::size_t kLeastRow = 18;

/// A row of adjacent samples and the rows beside it.
template <int N>
struct RowDifferences {
  const float* here;
  std::array<const float*, N> backward, forward;  ///< by axis from 1 on; `here` if there is no such row
  std::array<StepWeights, N> weights;
  std::array<StepWeights, 2> ends;  ///< weights along the row of its first and its last sample
  std::size_t samples;  ///< at least kLeastRow
  std::ptrdiff_t next;  ///< to the row that is probably next; 0: unknown
  float* out;           ///< derivatives along axis a from a * pitch on; stores are faster if it is aligned
  std::size_t pitch;    ///< at least samples + kRowMargin
};

/// Writes the gradients in axis coordinates. The first and the last sample of the row are their own neighbours beyond
/// it.
template <int N>
void write_row_gradients(const RowDifferences<N>& row) noexcept;

/// Critical edges of a row, in ascending order.
template <int N>
struct EdgesOfRow {
  /// Gradients at the first and second end, by the edge's first sample; derivatives are `pitch` apart.
  std::array<const float*, 2> ends;
  std::size_t pitch;
  std::size_t samples;
  const Word* critical;     ///< samples bits: the first samples of the edges
  const std::uint32_t* at;  ///< by edge: its first sample
  const double* alphas;     ///< by edge: its vertex's position on it; up to 15 entries past the end are read
  std::size_t count;
  float sign;
  float* positions;  ///< samples + kRowMargin finite numbers: working storage
  float* gradients;  ///< N x pitch: working storage
  std::array<float, N>* out;
  Word* left;  ///< count + 1 bits: set where a normal is undefined, as write_normals returns them
};

/// Writes normals of length 1.
template <int N>
void write_row_normals(const EdgesOfRow<N>& edges) noexcept;

}  // namespace tegl::detail
