// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the (N-2)-faces of a complex at which the orientations of its simplices do not cancel, without the simplices
// around vertices.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "base/function_ref.hpp"
#include "mesh/faces_of_stars.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// As `count_faces` for one label and without the Euler characteristic, in a fifth of the time. Calls on_open(ridge) on
/// the calling thread, in ascending order. A contour without open faces is always found to have none. An open face of
/// another contour is overlooked with a probability below 1e-16: the search uses random numbers, which are the same in
/// each call. O(#S + b log b) time for b faces between vertices of open faces; memory of 8 (N - 2) bytes per vertex,
/// and 8 more per vertex and thread; at most 8 threads work at a time.
template <int N>
FaceCounts find_open_ridges(std::span<const Index> rows, std::size_t vertex_count, unsigned threads,
                            const Progress& progress, FunctionRef<void(const std::array<Index, N - 1>& ridge)> on_open);

}  // namespace tegl::detail
