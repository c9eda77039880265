// SPDX-License-Identifier: BSD-3-Clause
//
// Complexes of images on lattices with periodic axes.
#pragma once

#include <cstddef>

#include "tegl/lattice.hpp"
#include "tegl/periodic.hpp"

namespace tegl::detail {

/// Samples that are repeated at both ends of a periodic axis; even, so that layers keep their parity.
inline constexpr std::size_t kLatticeMargin = 2;

/// Bit a: axis a has a period.
template <int N>
[[nodiscard]] unsigned periodic_axes(const AxisPeriods<N>& periods) noexcept {
  unsigned axes = 0;
  for (int a = 0; a < N; ++a) axes |= periods[a] != 0.0 ? 1u << a : 0u;
  return axes;
}

/// Throws InvalidArgument unless a lattice continues across the ends of its periodic axes.
template <int N>
void check_lattice_periods(const Grid<N>& grid, Lattice lattice, const AxisPeriods<N>& periods);

/// The complex of an image on a lattice with periodic axes. Its points are the samples; the corners
/// of cells across the seam are a period apart, with the orientations of cells that are not.
template <Value T, int N>
[[nodiscard]] Complex<N> periodic_lattice_complex(const Image<T, N>& image, Lattice lattice,
                                                  const AxisPeriods<N>& periods);

}  // namespace tegl::detail
