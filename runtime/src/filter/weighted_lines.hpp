// SPDX-License-Identifier: BSD-3-Clause
//
// The inner loop of all convolutions: a weighted sum of lines of samples.
#pragma once

#include <cstddef>

namespace tegl::detail {

/// out[i] = sum over t of weights[t] * lines[t][i], for i < width, summed in the order of t, without fused operations:
/// the same bits on every machine. At least one line. `out` must not overlap the lines.
template <class Real>
void weighted_lines(const Real* const* lines, const Real* weights, std::size_t count, std::size_t width,
                    Real* out) noexcept;

}  // namespace tegl::detail
