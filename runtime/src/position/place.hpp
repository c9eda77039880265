// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction with positions by a rule, for any type of samples.
#pragma once

#include "kernel/contour_output.hpp"
#include "position/placed_source.hpp"
#include "tegl/extract.hpp"
#include "tegl/positions.hpp"

namespace tegl::detail {

/// Throws InvalidArgument or UnsupportedData. `samples`: of the image, which has `dimensions`.
void check_positions(const PositionOptions& positions, std::size_t samples, int dimensions);

/// Extracts the contour of samples in memory, with positions by a rule other than `linear`. `starts_high`: of these
/// samples.
template <int N, class Real>
Extraction<N, Real> extract_placed_from(SampleSource<N>& samples, StartsHigh starts_high, const Grid<N>& grid,
                                        const PositionOptions& positions, const ExtractOptions& options,
                                        const ExtractPlan& plan = {});

}  // namespace tegl::detail
