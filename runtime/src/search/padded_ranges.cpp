// SPDX-License-Identifier: BSD-3-Clause
//
// Padded numbering of tiles, and the ranges of all tiles.
#include "search/padded_ranges.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "base/workers.hpp"
#include "search/tile_ranges.hpp"

namespace tegl::detail {

template <Value T>
KeyOf<T> key_of(T value) noexcept {
  using Key = KeyOf<T>;
  constexpr Key kTop = static_cast<Key>(Key{1} << (sizeof(Key) * 8 - 1));
  if constexpr (std::is_floating_point_v<T>) {
    const Key bits = std::bit_cast<Key>(value == T{} ? T{} : value);
    return (bits & kTop) != 0 ? static_cast<Key>(~bits) : static_cast<Key>(bits | kTop);
  } else if constexpr (std::is_signed_v<T>) {
    return static_cast<Key>(static_cast<Key>(value) ^ kTop);
  } else {
    return value;
  }
}

template <Value T>
T value_of(KeyOf<T> key) noexcept {
  using Key = KeyOf<T>;
  constexpr Key kTop = static_cast<Key>(Key{1} << (sizeof(Key) * 8 - 1));
  if constexpr (std::is_floating_point_v<T>) {
    return std::bit_cast<T>((key & kTop) != 0 ? static_cast<Key>(key & static_cast<Key>(~kTop))
                                              : static_cast<Key>(~key));
  } else if constexpr (std::is_signed_v<T>) {
    return static_cast<T>(static_cast<Key>(key ^ kTop));
  } else {
    return key;
  }
}

std::vector<int> default_order(int dim) {
  std::vector<int> order(static_cast<std::size_t>(dim));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<Step> neighbour_steps(int dim, Neighbourhood neighbourhood) {
  const int most = neighbourhood == Neighbourhood::faces             ? 1
                   : neighbourhood == Neighbourhood::faces_and_edges ? std::max(1, dim - 1)
                                                                     : dim;
  std::size_t count = 1;
  for (int a = 0; a < dim; ++a) count *= 3;
  std::vector<Step> steps;
  for (std::size_t i = 0; i < count; ++i) {
    Step step{};
    int moved = 0;
    std::size_t rest = i;
    for (int a = 0; a < dim; ++a, rest /= 3) {
      step[a] = static_cast<std::int8_t>(static_cast<int>(rest % 3) - 1);
      moved += step[a] != 0 ? 1 : 0;
    }
    if (moved > 0 && moved <= most) steps.push_back(step);
  }
  return steps;
}

PaddedTiles::PaddedTiles(std::span<const std::size_t> tiles) : dim_(static_cast<int>(tiles.size())) {
  constexpr std::size_t kMost = std::numeric_limits<Place>::max();
  std::size_t padded = 1;
  std::size_t count = 1;
  for (int a = 0; a < dim_; ++a) {
    sizes_[a] = tiles[a];
    steps_[a] = static_cast<std::ptrdiff_t>(padded);
    lead_ += padded;
    count *= tiles[a];
    if (tiles[a] >= kMost || padded > kMost / (tiles[a] + 1)) padded = kMost + 1;
    if (padded <= kMost) padded *= tiles[a] + 1;
  }
  room_ = padded + 2 * lead_;
  if (room_ > kMost)
    throw Error(ErrorCode::TooLarge,
                fmt::format("seeds of an image with {} tiles; expected fewer than 2^32 with a margin",
                            fmt::join(tiles, " x ")));
  rows_ = count == 0 ? 0 : count / sizes_[0];
}

Place PaddedTiles::row_place(std::size_t row) const noexcept {
  auto at = static_cast<std::ptrdiff_t>(lead_);
  for (int a = 1; a < dim_; ++a) {
    at += static_cast<std::ptrdiff_t>(row % sizes_[a]) * steps_[a];
    row /= sizes_[a];
  }
  return static_cast<Place>(at);
}

std::array<std::size_t, kMostAxes> PaddedTiles::index(Place place) const noexcept {
  std::array<std::size_t, kMostAxes> index{};
  std::size_t rest = place - lead_;
  for (int a = 0; a < dim_; ++a) {
    index[a] = rest % (sizes_[a] + 1);
    rest /= sizes_[a] + 1;
  }
  return index;
}

TileNumber PaddedTiles::number(Place place) const noexcept {
  const auto at = index(place);
  TileNumber number = 0;
  for (int a = dim_; a-- > 0;) number = number * sizes_[a] + at[a];
  return number;
}

Place PaddedTiles::place(TileNumber number) const noexcept {
  auto at = static_cast<std::ptrdiff_t>(lead_);
  for (int a = 0; a < dim_; ++a) {
    at += static_cast<std::ptrdiff_t>(number % sizes_[a]) * steps_[a];
    number /= sizes_[a];
  }
  return static_cast<Place>(at);
}

std::vector<std::ptrdiff_t> PaddedTiles::neighbours(Neighbourhood neighbourhood) const {
  return neighbours(neighbourhood, default_order(dim_));
}

std::vector<std::ptrdiff_t> PaddedTiles::neighbours(Neighbourhood neighbourhood, std::span<const int> order) const {
  std::vector<std::ptrdiff_t> result;
  for (const Step& step : neighbour_steps(dim_, neighbourhood)) {
    std::ptrdiff_t distance = 0;
    for (int k = 0; k < dim_; ++k) distance += step[k] * steps_[order[k]];
    result.push_back(distance);
  }
  return result;
}

template <Value T>
RangeMap<KeyOf<T>> map_ranges(const SampleView<T>& samples, unsigned threads, const Progress& progress) {
  const TileShape grid(samples.axes());
  RangeMap<KeyOf<T>> map{PaddedTiles(grid.axes()), {}, {}};
  map.least.resize(map.tiles.room());
  map.greatest.resize(map.tiles.room());
  Workers<TileRanges<T>> workers(threads, [&] { return TileRanges<T>(samples); });
  const std::size_t rows = map.tiles.rows();
  constexpr std::size_t kAtOnce = 1u << 14;
  for (std::size_t first = 0; first < rows; first += kAtOnce) {
    if (progress && !progress(static_cast<double>(first) / static_cast<double>(rows)))
      throw Error(ErrorCode::Cancelled, "seeds: cancelled while ranges of tiles were read");
    workers.for_range(std::min(kAtOnce, rows - first), 16, [&](std::size_t from, std::size_t to, TileRanges<T>& own) {
      for (std::size_t row = first + from; row < first + to; ++row) {
        own.load(row);
        const Place at = map.tiles.row_place(row);
        for (std::size_t i = 0; i < grid.size(0); ++i) {
          const bool any = has_range(own.least()[i], own.greatest()[i]);
          map.least[at + i] = any ? key_of(own.least()[i]) : 0;
          map.greatest[at + i] = any ? key_of(own.greatest()[i]) : 0;
        }
      }
    });
  }
  return map;
}

#define TEGL_INSTANTIATE(T)                  \
  template KeyOf<T> key_of<T>(T) noexcept;   \
  template T value_of<T>(KeyOf<T>) noexcept; \
  template RangeMap<KeyOf<T>> map_ranges(const SampleView<T>&, unsigned, const Progress&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
