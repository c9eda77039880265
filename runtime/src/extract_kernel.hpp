// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction, from a source of samples to a contour. Private: tests and benchmarks use it to pass
// their own tables or limits.
#pragma once

#include <cstdint>
#include <limits>

#include "extract_count.hpp"
#include "extract_source.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Vertices that an extraction may have: one less than numbers, so that no number is the largest.
inline constexpr std::uint64_t kMaxVertices = std::numeric_limits<Index>::max();

/// Throws TooLarge if `count` vertices are more than `limit`.
void check_vertex_count(std::uint64_t count, std::uint64_t limit);

/// Throws InvalidIsovalue or InvalidArgument.
void check_arguments(double isovalue, const ExtractOptions& options);

/// The generated tables of one triangulation.
template <int N>
TableSet<N> generated_tables(const ExtractOptions& options);

/// The contour of `source` over `grid`. `stats` may be null. `closed_axes`: bit a: whether options.close
/// closes the borders across axis a.
template <int N, class Real>
Contour<N, Real> extract_source(const SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                                const ExtractOptions& options, ExtractStats* stats,
                                std::uint64_t max_vertices = kMaxVertices, unsigned closed_axes = ~0u);

}  // namespace tegl::detail
