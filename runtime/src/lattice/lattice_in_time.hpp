// SPDX-License-Identifier: BSD-3-Clause
//
// The face-centred cubic lattice over time (Lattice::fcc_in_time): cells at one time, and their prisms.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tegl/complex.hpp"
#include "tegl/grid.hpp"

namespace tegl::detail {

/// The cells at one time, on the axes 0 to 2 of `grid`, without values. `margin`: as in `cells_of_lattice`. Errors:
/// InvalidArgument (a world map that mixes time and space; uneven steps; fewer than 2 layers), TooLarge.
[[nodiscard]] Complex<3> fcc_at_a_time(const Grid<4>& grid, const std::array<std::size_t, 4>& margin = {});

/// The prisms of these cells between all times of `grid`, which may descend. `values`: of its samples. Errors: those of
/// `in_time`.
[[nodiscard]] Complex<4> fcc_over_times(const Complex<3>& at_a_time, const Grid<4>& grid,
                                        std::span<const double> values);

}  // namespace tegl::detail
