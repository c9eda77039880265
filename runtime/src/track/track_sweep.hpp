// SPDX-License-Identifier: BSD-3-Clause
//
// Sweep of a level over a simplicial complex: the components of the level set, and the vertices at which they change.
// The result is the Reeb graph including events of zero duration (see tegl/track.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/incidence_data.hpp"
#include "tegl/track.hpp"
#include "track/sweep_result.hpp"

namespace tegl::detail {

/// Progress at the end of the sweep.
inline constexpr double kSwept = 0.95;

/// Reports progress up to kSwept. Instantiated for the same types as `track`. The options must be valid, and the
/// contour's numbers finite and in range. `incidence`: null if it is not known.
template <int N, class Real>
SweepResult sweep(const Contour<N, Real>& contour, const IncidenceData<N>* incidence, const TrackOptions& options);

}  // namespace tegl::detail
