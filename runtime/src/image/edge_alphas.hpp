// SPDX-License-Identifier: BSD-3-Clause
//
// Intersections of contours with edges of the grid.
#pragma once

#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"
#include "tegl/image.hpp"

namespace tegl::detail {

/// Edges along one axis in rows of one layer. Edge i goes from starts[j] to ends[j], j = rows[i] + at[i] * stride.
template <Value T>
struct EdgeSamples {
  const T* starts;
  const T* ends;
  const std::ptrdiff_t* rows;
  const std::uint32_t* at;
  std::size_t count;
  std::ptrdiff_t stride;
};

/// Interpolation parameters of the isovalue on critical edges: 0 at the first end, 1 at the second (theory, section 1),
/// clamped to [epsilon, 1 - epsilon]. Infinite samples are treated as limits: the vertex is at the finite end, or at
/// the middle between two infinities.
template <Value T>
void edge_alphas(const EdgeSamples<T>& edges, double isovalue, double epsilon, double* out) noexcept;

/// Critical edges of one row, whose samples are adjacent in memory. Edge i goes from starts[i] to ends[i].
struct FloatRowEdges {
  const float* starts;
  const float* ends;
  std::size_t edges;     ///< of the row, critical or not; at least kLeastEdges
  const Word* critical;  ///< a bit for each edge; no bits are set after the last one
};
inline constexpr std::size_t kLeastEdges = 16;
/// edge_alphas for the edges of a row, in ascending order. Faster if many are critical.
void row_alphas(const FloatRowEdges& row, double isovalue, double epsilon, double* out) noexcept;

/// edge_alphas from the values at both ends of each edge.
void alphas_between(const float* from, const float* to, std::size_t count, double isovalue, double epsilon,
                    double* out) noexcept;
void alphas_between(const double* from, const double* to, std::size_t count, double isovalue, double epsilon,
                    double* out) noexcept;
/// Interpolation parameters for all 32 edges of a 4D tile, from the values at its 16 corners. Results for non-critical
/// edges are undefined.
void tile_alphas(const double* corners, double isovalue, double epsilon, double* out) noexcept;
/// The same for all edges of each of `count` cells of `dim` axes: edge e of cell i to out[e * pitch + i]. `corners`:
/// corner v of cell i at corners[v * pitch + i].
void alphas_of_cells(unsigned dim, const double* corners, std::size_t count, std::size_t pitch, double isovalue,
                     double epsilon, double* out) noexcept;

}  // namespace tegl::detail
