// SPDX-License-Identifier: BSD-3-Clause
//
// Places of many points in a curved grid, and coordinates at places, by vector instructions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tegl::detail {

/// Some points, and their places in the grid. Arrays by axis; only axes along which coordinates differ need bases and
/// shares. Points after the last one are 0, as whole vectors are read.
struct CurvedBlock {
  static constexpr std::size_t kMost = 64;  ///< a multiple of all numbers of lanes
  static constexpr std::size_t kMostAxes = 4;
  using Numbers = std::array<double, kMost>;
  std::size_t count = 0;
  std::array<Numbers, kMostAxes> point{}, share{};
  std::array<Numbers, kMostAxes> base{};  ///< whole numbers, exact as the arrays have fewer than 2^53 samples
  /// Of places on an edge: the share along it.
  Numbers edge_share{};
  /// Of the edges in arrays of coordinates: numbers of the ends, and weights of the second ones.
  struct Ends {
    std::array<std::int64_t, kMost> first{}, second{};
    Numbers weight{};
  };
  std::array<Ends, kMostAxes> ends{};             ///< by CurvedArrays
  std::array<Numbers, kMostAxes> here{}, next{};  ///< values at ends, by array of one CurvedArrays
  std::uint64_t inside = 0;                       ///< bit i: place i is not on an edge, or at its second end
};

/// Arrays of coordinates with the same axes.
struct CurvedArrays {
  using Strides = std::array<std::size_t, CurvedBlock::kMostAxes>;
  Strides strides{};      ///< distance of neighbours along each axis; 0 along axes that the arrays do not have
  bool is_large = false;  ///< whether values do not stay in the nearest caches
  std::size_t count = 0;
  std::array<const double*, CurvedBlock::kMostAxes> values{};
  std::array<std::size_t, CurvedBlock::kMostAxes> axis{};  ///< of each array's coordinates
};

/// Steps of indices by axis.
using IndexSteps = std::array<double, CurvedBlock::kMostAxes>;
/// Sets bases and shares along axes whose indices are step, 2 step, ..., for a step of 1 or -1; not along those with 0.
void find_places(CurvedBlock& block, const IndexSteps& steps) noexcept;
/// Sets edge_share and inside, and finds the ends of edges in arrays; `along`: bits of the axes that have shares.
void find_edges(CurvedBlock& block, unsigned along, std::span<const CurvedArrays> arrays) noexcept;
/// Loads block.count points of `dim` coordinates, or stores them: only those along axes with bits in `axes`.
void load_points(const float* points, std::size_t dim, unsigned axes, CurvedBlock& block) noexcept;
void load_points(const double* points, std::size_t dim, unsigned axes, CurvedBlock& block) noexcept;
void store_points(const CurvedBlock& block, std::size_t dim, unsigned axes, float* points) noexcept;
void store_points(const CurvedBlock& block, std::size_t dim, unsigned axes, double* points) noexcept;
/// Whether the coordinates of all points along the axes with bits in `axes` are finite.
bool are_finite(const CurvedBlock& block, unsigned axes) noexcept;
/// Starts to load the values at `count` ends if the arrays are large.
void request(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count) noexcept;
/// Replaces coordinates of points by those between the ends of their edges. Meanwhile requests the values at the first
/// `count` of the `next` ends: memory delivers only few at a time.
void interpolate(CurvedBlock& block, const CurvedArrays& arrays, const CurvedBlock::Ends& ends,
                 const CurvedBlock::Ends& next, std::size_t count) noexcept;

}  // namespace tegl::detail
