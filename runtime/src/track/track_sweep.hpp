// SPDX-License-Identifier: BSD-3-Clause
//
// The sweep of a level over a simplicial complex: which components the level set has, and at which vertices that
// changes. What comes out is the Reeb graph with every event that lasts no time (see tegl/track.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "tegl/track.hpp"
#include "track/sweep_result.hpp"

namespace tegl::detail {

/// The part of the whole progress after which the sweep is done.
inline constexpr double kSwept = 0.95;

/// Tells the progress up to kSwept. Instantiated for what `track` is. The options are sound, the contour's numbers
/// finite and in range.
template <int N, class Real>
SweepResult sweep(const Contour<N, Real>& contour, const TrackOptions& options);

}  // namespace tegl::detail
