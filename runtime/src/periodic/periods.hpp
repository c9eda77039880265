// SPDX-License-Identifier: BSD-3-Clause
//
// Checks of periodic axes, and their periods in the world.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tegl/periodic.hpp"

namespace tegl::detail {

inline constexpr double kTurn = 360.0;  ///< longitudes repeat after it, in degrees

/// An axis in messages, such as "axis 0 (lon)"; one without a name is x, y, z or t.
[[nodiscard]] std::string label_of_axis(const Axis& axis, int number);

/// An axis with its coordinates in the world, up to a constant, where its unit is that of longitudes; none if another
/// world coordinate differs along it, beyond a millionth. Its own one may differ along other axes, too, as in a moving
/// frame: the period does not.
template <int N>
[[nodiscard]] std::optional<Axis> axis_in_world(const Grid<N>& grid, int axis);

/// The message about a periodic axis on which samples that are `steps` (1 or 2) steps apart are half a period apart or
/// more: the shorter way between two neighbours would lead round the other side. Empty if there are none. O(samples)
/// time.
[[nodiscard]] std::string too_long_steps(const Axis& axis, int number, double period, int steps = 1);

/// Throws InvalidArgument for bad periods, and for options that periodic extraction does not have.
template <int N>
void check_periods(const Grid<N>& grid, const AxisPeriods<N>& periods, const ExtractOptions& options);

/// Throws InvalidGrid for a period of `axis` (in messages) so long or short that squares overflow: its products with
/// points would not be numbers.
template <int N>
void require_range(const Period<N>& period, const std::string& axis);

/// The periods of a wrapped contour of an image on `grid`.
template <int N>
std::vector<Period<N>> world_periods(const Grid<N>& grid, const AxisPeriods<N>& periods);

}  // namespace tegl::detail
