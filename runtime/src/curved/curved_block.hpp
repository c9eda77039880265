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

/// How the coordinates of a sample are in memory.
enum class CurvedColumns {
  separate,   ///< anywhere, or side by side in an order that has no vector instructions
  ascending,  ///< side by side, those of consecutive axes
  descending  ///< side by side, those of consecutive axes, the last axis first
};

/// Coordinates of samples with the same axes, of one type, and equally far apart: in arrays of their own, or columns of
/// points.
struct CurvedArrays {
  using Strides = std::array<std::size_t, CurvedBlock::kMostAxes>;
  template <class T>
  using Numbers = std::array<const T*, CurvedBlock::kMostAxes>;
  Strides strides{};      ///< in numbers, between neighbours along each axis; 0 along axes that the arrays do not have
  bool is_large = false;  ///< whether values do not stay in the nearest caches
  bool fits_32_bits = false;                               ///< whether all numbers are counted by std::int32_t
  std::size_t count = 0;                                   ///< of coordinates
  std::size_t pitch = 1;                                   ///< from a sample to the next one, in numbers
  bool are_floats = false;                                 ///< whether the coordinates are `floats`, not `doubles`
  Numbers<float> floats{};                                 ///< the first sample's, by coordinate
  Numbers<double> doubles{};                               ///< the first sample's, by coordinate
  std::array<std::size_t, CurvedBlock::kMostAxes> axis{};  ///< of each coordinate
  CurvedColumns columns = CurvedColumns::separate;
  std::size_t lowest_axis = 0;       ///< of the coordinates, unless they are separate
  std::size_t first_column = 0;      ///< number of the coordinate that is first in memory, unless they are separate
  bool may_be_in_two_lines = false;  ///< whether the coordinates of a sample, side by side, may be in two cache lines

  /// Adds a coordinate. All must be of the same type.
  void add(const float* first, std::size_t of_axis) noexcept { add_to(floats, first, of_axis); }
  void add(const double* first, std::size_t of_axis) noexcept { add_to(doubles, first, of_axis); }
  /// Sets `columns` and what depends on it, for points of `dim` coordinates. After all have been added.
  void find_columns(std::size_t dim) noexcept;

 private:
  template <class T>
  void add_to(Numbers<T>& numbers, const T* first, std::size_t of_axis) noexcept {
    numbers[count] = first;
    axis[count++] = of_axis;
  }
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
