// SPDX-License-Identifier: BSD-3-Clause
//
// Collects tiles by their ranges and sorts them; see tile_intervals.hpp.
#include "search/tile_intervals.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/workers.hpp"
#include "search/padded_ranges.hpp"
#include "search/tile_ranges.hpp"

namespace tegl::detail {

template <Value T>
TileIntervals<T> gather_intervals(const IndexTask<T>& task) {
  const TileShape& grid = task.tiles;
  if (grid.count() > std::uint64_t{std::numeric_limits<TileId>::max()} + 1)
    throw Error(ErrorCode::TooLarge, fmt::format("an image of {} tiles; expected at most 2^32 for this method (the min-"
                                                 "max tree has no such limit)",
                                                 grid.count()));
  constexpr std::size_t kPartRows = 64;
  const std::size_t parts = (grid.rows() + kPartRows - 1) / kPartRows;
  std::vector<std::size_t> first(parts + 1);
  TileIntervals<T> result;
  Workers<TileRanges<T>> workers(task.options.work.threads, [&] { return TileRanges<T>(task.samples); });
  const std::size_t along = grid.size(0);
  // count per part, then write: buffers are allocated once
  workers.for_range(parts, 1, [&](std::size_t from, std::size_t to, TileRanges<T>& ranges) {
    for (std::size_t part = from; part < to; ++part) {
      std::size_t count = 0;
      for (std::size_t row = part * kPartRows; row < std::min(grid.rows(), (part + 1) * kPartRows); ++row) {
        ranges.load(row);
        for (std::size_t i = 0; i < along; ++i) count += has_range(ranges.least()[i], ranges.greatest()[i]) ? 1 : 0;
      }
      first[part + 1] = count;
    }
  });
  // prefix sum
  for (std::size_t part = 0; part < parts; ++part) first[part + 1] += first[part];
  task.tell(0.1);
  result.tiles.resize(first[parts]);
  result.least.resize(first[parts]);
  result.greatest.resize(first[parts]);
  // write
  workers.for_range(parts, 1, [&](std::size_t from, std::size_t to, TileRanges<T>& ranges) {
    for (std::size_t part = from; part < to; ++part) {
      std::size_t next = first[part];
      for (std::size_t row = part * kPartRows; row < std::min(grid.rows(), (part + 1) * kPartRows); ++row) {
        ranges.load(row);
        for (std::size_t i = 0; i < along; ++i) {
          if (!has_range(ranges.least()[i], ranges.greatest()[i])) continue;
          result.tiles.data()[next] = static_cast<TileId>(row * along + i);
          result.least.data()[next] = ranges.least()[i];
          result.greatest.data()[next] = ranges.greatest()[i];
          ++next;
        }
      }
    }
  });
  task.tell(0.2);
  return result;
}

namespace {

/// Turns the bits of a value into an unsigned integer with the order of the value. (-0 comes before +0; no later
/// comparison distinguishes them.)
template <class Bits>
struct BitOrder {
  Bits of_negative, of_others;  ///< bits to change in values with the highest bit set, and in others

  [[nodiscard]] Bits key(Bits bits) const noexcept {
    constexpr Bits kTop = static_cast<Bits>(Bits{1} << (8 * sizeof(Bits) - 1));
    return static_cast<Bits>(bits ^ ((bits & kTop) != 0 ? of_negative : of_others));
  }
};

template <Value T>
constexpr BitOrder<KeyOf<T>> bit_order() noexcept {
  using Bits = KeyOf<T>;
  constexpr Bits kTop = static_cast<Bits>(Bits{1} << (8 * sizeof(Bits) - 1));
  if constexpr (std::is_floating_point_v<T>) return {static_cast<Bits>(~Bits{0}), kTop};
  if constexpr (std::is_signed_v<T>) return {kTop, kTop};
  return {0, 0};
}

template <class Bits>
struct KeyedPlace {
  Bits key;
  TileId place;
};

/// `values`: `count` values of sizeof(Bits) bytes.
template <class Bits>
Buffer<TileId> order_of_bits(const void* values, std::size_t count, const BitOrder<Bits>& bit_order) {
  constexpr unsigned kDigitBits = sizeof(Bits) == 1 ? 8 : 11;
  constexpr unsigned kDigits = (8 * sizeof(Bits) + kDigitBits - 1) / kDigitBits;
  constexpr std::size_t kMask = (std::size_t{1} << kDigitBits) - 1;
  std::array<std::vector<std::uint32_t>, kDigits> first;
  for (auto& digit : first) digit.resize(kMask + 1);
  // count digits
  Buffer<KeyedPlace<Bits>> items(count);
  for (std::size_t i = 0; i < count; ++i) {
    Bits bits;
    std::memcpy(&bits, static_cast<const char*>(values) + i * sizeof(Bits), sizeof(Bits));
    const Bits key = bit_order.key(bits);
    items.data()[i] = {key, static_cast<TileId>(i)};
    for (unsigned d = 0; d < kDigits; ++d) ++first[d].data()[std::size_t{key} >> (d * kDigitBits) & kMask];
  }
  // distribute by one digit after the other
  Buffer<KeyedPlace<Bits>> sorted(count);
  for (unsigned d = 0; d < kDigits; ++d) {
    std::uint32_t* const next = first[d].data();
    // skip a digit that is equal in all keys
    if (std::find(next, next + kMask + 1, count) != next + kMask + 1) continue;
    std::uint32_t sum = 0;
    for (std::size_t digit = 0; digit <= kMask; ++digit) sum += std::exchange(next[digit], sum);
    for (const auto& item : items) sorted.data()[next[std::size_t{item.key} >> (d * kDigitBits) & kMask]++] = item;
    items.swap(sorted);
  }
  Buffer<TileId> order(count);
  for (std::size_t i = 0; i < order.size(); ++i) order.data()[i] = items.data()[i].place;
  return order;
}

}  // namespace

template <Value T>
Buffer<TileId> ascending_order(const Buffer<T>& keys) {
  return order_of_bits(keys.data(), keys.size(), bit_order<T>());
}

template <Value T>
void add_quantiles(const Buffer<T>& keys, const Buffer<TileId>& order, std::size_t step, std::vector<T>& values) {
  for (std::size_t i = 0; i < order.size(); i += step) values.push_back(keys[order[i]]);
}

template <Value T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

template <Value T>
Buffer<std::uint32_t> cells_of(const Buffer<T>& keys, const Buffer<TileId>& order, const std::vector<T>& bounds) {
  Buffer<std::uint32_t> cells(keys.size());
  std::uint32_t cell = 0;
  for (const TileId i : order) {
    while (cell < bounds.size() && bounds[cell] <= keys.data()[i]) ++cell;
    cells.data()[i] = cell;
  }
  return cells;
}

Bins distribute(const Buffer<TileId>& order, const Buffer<std::uint32_t>& bin_of, std::size_t bins) {
  Bins result;
  result.first.assign(bins + 1, 0);
  for (const TileId i : order) ++result.first[bin_of.data()[i] + std::size_t{1}];
  for (std::size_t b = 0; b < bins; ++b) result.first[b + 1] += result.first[b];
  std::vector<std::uint64_t> next(result.first.begin(), result.first.end() - 1);
  result.order.resize(order.size());
  for (const TileId i : order) result.order.data()[next.data()[bin_of.data()[i]]++] = i;
  return result;
}

void require_tiles(const std::vector<TileId>& tiles, TileNumber end) {
  const auto bad = std::find_if(tiles.begin(), tiles.end(), [&](TileId tile) { return tile >= end; });
  if (bad != tiles.end()) IndexReader::damaged(fmt::format("tile {} of {}", *bad, end));
}

#define TEGL_INSTANTIATE(T)                                                                              \
  template TileIntervals<T> gather_intervals<T>(const IndexTask<T>&);                                    \
  template Buffer<TileId> ascending_order<T>(const Buffer<T>&);                                          \
  template void add_quantiles<T>(const Buffer<T>&, const Buffer<TileId>&, std::size_t, std::vector<T>&); \
  template void sort_unique<T>(std::vector<T>&);                                                         \
  template Buffer<std::uint32_t> cells_of<T>(const Buffer<T>&, const Buffer<TileId>&, const std::vector<T>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
