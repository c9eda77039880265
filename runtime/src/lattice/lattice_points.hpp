// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices on the edges of a lattice, from samples of one row to samples of another, compiled for several instruction
// sets; all give identical bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tegl/image.hpp"

namespace tegl::detail {

/// A row of samples in memory.
struct RowOfSamples {
  const std::byte* first;
  std::ptrdiff_t step;  ///< in bytes, to the next sample
};

/// Reads the samples `at` of a row. For one value type.
using ReadSamples = void (*)(const RowOfSamples& row, const std::uint32_t* at, std::size_t count, double* out) noexcept;

template <Value T>
void read_samples(const RowOfSamples& row, const std::uint32_t* at, std::size_t count, double* out) noexcept {
  if (row.step == sizeof(T)) {
    const T* const samples = reinterpret_cast<const T*>(row.first);
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<double>(samples[at[i]]);
    return;
  }
  for (std::size_t i = 0; i < count; ++i)
    out[i] =
        static_cast<double>(*reinterpret_cast<const T*>(row.first + static_cast<std::ptrdiff_t>(at[i]) * row.step));
}

/// Coordinates on the grid of the samples of a row.
template <int N>
struct PlacesInRow {
  double shift = 0.0;              ///< added along the row
  std::ptrdiff_t ahead = 0;        ///< difference of the samples' indices
  std::array<double, N> others{};  ///< of all axes except the first
};

/// Edges of one kind of a row, and the destination of their vertices.
template <int N, class Real>
struct LatticePoints {
  using Vertex = std::array<Real, N>;
  static constexpr std::size_t kMargin = 8;

  // By edge: its first sample along the row, and interpolation parameter. kMargin entries more can be read.
  const std::uint32_t* at;
  const double* alphas;
  std::size_t count;
  PlacesInRow<N> from, to;
  const double* along;    ///< coordinates along the row, by sample; null: uniform
  double origin, step;    ///< of uniform coordinates
  const Grid<N>* mapped;  ///< grid with a world map, or null
  Vertex* out;
  Vertex* end;  ///< up to kMargin vertices after the last one are overwritten, none from here on
};

template <int N, class Real>
void write_points(const LatticePoints<N, Real>& edges) noexcept;

}  // namespace tegl::detail
