// SPDX-License-Identifier: BSD-3-Clause
//
// Coordinates of many points in a curved grid: the edges on which the points are, by vector instructions, and the
// coordinates between the ends of the edges.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tegl::detail {

/// The edges of some points. Ends after the last one are the origin's, as whole vectors are written.
struct CurvedBlock {
  static constexpr std::size_t kMost = 64;  ///< a multiple of all numbers of lanes
  static constexpr std::size_t kMostAxes = 4;
  /// Coordinates of the block's points, one point after the other.
  template <class Real>
  using Points = std::array<Real, kMost * kMostAxes>;
  /// Ends of edges in arrays of coordinates, and weights of the second ones.
  struct alignas(64) Ends {
    std::array<std::int64_t, kMost> first{}, second{};
    std::array<double, kMost> weight{};
  };
  std::size_t count = 0;
  std::array<Ends, kMostAxes> ends{};  ///< by CurvedArrays, as offsets in numbers
  std::uint64_t inside = 0;            ///< bit i: point i is not on an edge, or at its second end
};

/// Coordinates of samples with the same axes: in arrays of their own, or columns of the same CurvedPoints.
struct CurvedArrays {
  using Strides = std::array<std::size_t, CurvedBlock::kMostAxes>;
  Strides strides{};      ///< in numbers, between neighbours along each axis; 0 along axes that the arrays do not have
  bool is_large = false;  ///< whether values do not stay in the nearest caches
  bool fits_32_bits = false;                                   ///< whether all numbers are counted by std::int32_t
  std::size_t count = 0;                                       ///< of coordinates
  std::array<const double*, CurvedBlock::kMostAxes> values{};  ///< by coordinate, if in arrays of their own
  std::array<std::size_t, CurvedBlock::kMostAxes> column{};    ///< by coordinate, of points
  std::array<std::size_t, CurvedBlock::kMostAxes> axis{};      ///< of each coordinate
  const float* floats = nullptr;                               ///< of points, if stored as float
  const double* doubles = nullptr;                             ///< of points, if stored as double
  std::size_t columns = 1, pitch = 1;

  [[nodiscard]] bool are_points() const noexcept { return floats != nullptr || doubles != nullptr; }
};

/// Steps of indices by axis: 1 or -1, and 0 along axes without indices.
using IndexSteps = std::array<double, CurvedBlock::kMostAxes>;
/// Finds the edges of block.count points with `dim` coordinates, which are indices times steps: the block's ends in
/// arrays, and `inside`. Reads kMost points.
void find_ends(const float* points, std::size_t dim, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
               CurvedBlock& block) noexcept;
void find_ends(const double* points, std::size_t dim, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
               CurvedBlock& block) noexcept;
/// Starts to load the values at `count` ends if the arrays are large.
void request(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count) noexcept;
/// Sets coordinates of `count` points, with `dim` coordinates each, between the ends of their edges. Meanwhile requests
/// the values at the first `requested` of the `next` ends: memory delivers only few at a time. Returns whether all
/// coordinates, before they are rounded to the points' type, are finite.
bool interpolate(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,
                 const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, float* points) noexcept;
bool interpolate(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,
                 const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, double* points) noexcept;

}  // namespace tegl::detail
