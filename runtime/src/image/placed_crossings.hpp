// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tegl::detail {

/// A base of sources whose contours meet edges of the grid at other points than linear interpolation of the samples at
/// the ends gives. The extraction by tables looks for it; otherwise it computes these points from samples.
class PlacedCrossings {};

}  // namespace tegl::detail
