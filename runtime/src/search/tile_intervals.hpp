// SPDX-License-Identifier: BSD-3-Clause
//
// The tiles of an image as intervals of values, and linear-time sorting of them, for interval trees and buckets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "search/active_tiles_methods.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The tiles that are active at some isovalue, ascending.
template <Value T>
struct TileIntervals {
  Buffer<TileId> tiles;
  Buffer<T> least, greatest;  ///< by tile; least < greatest
};

/// Throws TooLarge if there are more tiles than TileId can number.
template <Value T>
TileIntervals<T> gather_intervals(const IndexTask<T>& task);

/// Permutation that sorts the keys in ascending order. Stable radix sort, O(keys).
template <Value T>
Buffer<TileId> ascending_order(const Buffer<T>& keys);

/// Appends every `step`-th key in this order, from the first on.
template <Value T>
void add_quantiles(const Buffer<T>& keys, const Buffer<TileId>& order, std::size_t step, std::vector<T>& values);

/// Sorts values and removes duplicates.
template <Value T>
void sort_unique(std::vector<T>& values);

/// For each key, the number of bounds <= key. `order` sorts the keys; `bounds` ascend.
template <Value T>
Buffer<std::uint32_t> cells_of(const Buffer<T>& keys, const Buffer<TileId>& order, const std::vector<T>& bounds);

/// Places 0 ... size - 1, grouped by bin.
struct Bins {
  std::vector<std::uint64_t> first;  ///< by bin: its first element in `order`; then the end
  Buffer<TileId> order;              ///< grouped by bin; within a bin in the input order
};
Bins distribute(const Buffer<TileId>& order, const Buffer<std::uint32_t>& bin_of, std::size_t bins);

/// values[order[0]], values[order[1]], ...
template <class V>
std::vector<V> in_order(const Buffer<V>& values, const Buffer<TileId>& order) {
  std::vector<V> result;
  result.reserve(order.size());
  for (const TileId i : order) result.push_back(values.data()[i]);
  return result;
}

/// Throws MalformedFile unless all tile numbers are below `end`.
void require_tiles(const std::vector<TileId>& tiles, TileNumber end);

}  // namespace tegl::detail
