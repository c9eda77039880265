// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles by the span space, whose axes are the least and the greatest value of tiles: active are those in a
// corner of it. It is cut into buckets of about as many tiles each by the greatest value; within a bucket tiles are in
// the order of their least. A query takes the beginning of every bucket above the isovalue, and looks at the greatest
// values in one: O(sqrt(n) log n + k) for k of n tiles. Images of few values (8 bits) have a bucket for each, and
// greatest values are then not kept.
//
// Based on: Y. Livnat, H.-W. Shen, C. Johnson, A Near Optimal Isosurface Extraction Algorithm Using the Span Space,
// 1996; H.-W. Shen, C. Hansen, Y. Livnat, C. Johnson, Isosurfacing in Span Space with Utmost Efficiency (ISSUE), 1996,
// whose lattice has buckets along both axes: sorted by least value, those of a row become one.
#include <algorithm>
#include <cmath>
#include <vector>

#include "image/bitplanes.hpp"
#include "search/tile_intervals.hpp"

namespace tegl::detail {

namespace {

template <Value T>
struct SpanBuckets {
  std::vector<T> bounds;             ///< by bucket: what its greatest values are not below
  std::vector<std::uint64_t> first;  ///< by bucket, and the end: where its tiles are below
  std::vector<TileId> tiles;         ///< in each bucket, by least value
  std::vector<T> least;              ///< of these
  std::vector<T> greatest;           ///< of these; none if every bucket has but one greatest value, its bound
};

template <Value T, int N>
class SpanSpace final : public tegl::ActiveTiles<N> {
 public:
  SpanSpace(const IndexedImage<N>& image, SpanBuckets<T> buckets)
      : tegl::ActiveTiles<N>(image), buckets_(std::move(buckets)) {}

  [[nodiscard]] ActiveMethod method() const noexcept override { return ActiveMethod::span_space; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept override {
    const auto bytes = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
    return bytes(buckets_.bounds) + bytes(buckets_.first) + bytes(buckets_.tiles) + bytes(buckets_.least) +
           bytes(buckets_.greatest);
  }

 protected:
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const Threshold<T> threshold = make_threshold<T>(isovalue);
    if (threshold.never || buckets_.bounds.empty()) return;
    const T value = threshold.value;
    const auto reached = std::lower_bound(buckets_.bounds.begin(), buckets_.bounds.end(), value);
    auto bucket = static_cast<std::size_t>(reached - buckets_.bounds.begin());
    // In the bucket before the first whose bound reaches the value, some tiles may reach it.
    if (bucket > 0 && !buckets_.greatest.empty()) {
      const std::size_t end = end_of_below(bucket - 1, value);
      for (std::size_t i = buckets_.first[bucket - 1]; i < end; ++i)
        if (!(buckets_.greatest[i] < value)) tiles.push_back(buckets_.tiles[i]);
    }
    for (; bucket < buckets_.bounds.size(); ++bucket)
      tiles.insert(tiles.end(), buckets_.tiles.begin() + static_cast<std::ptrdiff_t>(buckets_.first[bucket]),
                   buckets_.tiles.begin() + static_cast<std::ptrdiff_t>(end_of_below(bucket, value)));
  }

  void write(IndexWriter& to) const override {
    to.array(buckets_.bounds);
    to.array(buckets_.first);
    to.array(buckets_.tiles);
    to.array(buckets_.least);
    to.array(buckets_.greatest);
  }

 private:
  /// Where, in a bucket, tiles that begin below `value` end.
  [[nodiscard]] std::size_t end_of_below(std::size_t bucket, T value) const {
    const T* const least = buckets_.least.data();
    const T* const end = least + buckets_.first[bucket + 1];
    return static_cast<std::size_t>(std::lower_bound(least + buckets_.first[bucket], end, value) - least);
  }

  SpanBuckets<T> buckets_;
};

/// With more buckets bisections take longer than what they save.
constexpr std::size_t kMostBuckets = 4096;

}  // namespace

template <Value T, int N>
ActiveTilesPtr<N> build_span_space(const IndexTask<T, N>& task) {
  SpanBuckets<T> buckets;
  const TileIntervals<T> intervals = gather_intervals(task);
  Buffer<std::uint32_t> bucket_of;
  {
    const Buffer<TileId> order = ascending_order(intervals.greatest);
    // All values, where there are few of them; else quantiles.
    for (const TileId i : order) {
      const T value = intervals.greatest[i];
      if (!buckets.bounds.empty() && buckets.bounds.back() == value) continue;
      buckets.bounds.push_back(value);
      if (buckets.bounds.size() > kMostBuckets) break;
    }
    const bool few = buckets.bounds.size() <= std::min<std::size_t>(kMostBuckets, 256 + order.size() / 256);
    if (!few) {
      buckets.bounds.clear();
      const auto count = std::min(kMostBuckets, static_cast<std::size_t>(std::sqrt(order.size())) + 1);
      add_quantiles(intervals.greatest, order, order.size() / count + 1, buckets.bounds);
      sort_unique(buckets.bounds);
    }
    bucket_of = cells_of(intervals.greatest, order, buckets.bounds);
    for (std::uint32_t& bucket : bucket_of) --bucket;
    task.tell(0.5);
    Bins bins = distribute(ascending_order(intervals.least), bucket_of, buckets.bounds.size());
    task.tell(0.8);
    buckets.first = std::move(bins.first);
    buckets.tiles = in_order(intervals.tiles, bins.order);
    buckets.least = in_order(intervals.least, bins.order);
    if (!few) buckets.greatest = in_order(intervals.greatest, bins.order);
  }
  return std::make_unique<SpanSpace<T, N>>(task.identity, std::move(buckets));
}

template <Value T, int N>
ActiveTilesPtr<N> read_span_space(IndexReader& from, const IndexTask<T, N>& task) {
  const TileNumber tiles = TileGrid<N>(task.identity.sizes).count();
  SpanBuckets<T> buckets;
  buckets.bounds = from.array<T>(kMostBuckets + 1, "bounds of the buckets");
  buckets.first = from.array<std::uint64_t>(buckets.bounds.size() + 1, "places of the buckets");
  buckets.tiles = from.array<TileId>(tiles, "tiles by least value");
  const std::size_t count = buckets.tiles.size();
  buckets.least = from.array<T>(count, "least values");
  buckets.greatest = from.array<T>(count, "greatest values");
  if (buckets.first.size() != buckets.bounds.size() + 1 || buckets.least.size() != count ||
      (!buckets.greatest.empty() && buckets.greatest.size() != count))
    IndexReader::damaged(fmt::format("{} places, {} least and {} greatest values; expected {}, {} and as many or none",
                                     buckets.first.size(), buckets.least.size(), buckets.greatest.size(),
                                     buckets.bounds.size() + 1, count));
  require_offsets(buckets.first, count, "buckets");
  require_tiles(buckets.tiles, tiles);
  return std::make_unique<SpanSpace<T, N>>(task.identity, std::move(buckets));
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                    \
  template ActiveTilesPtr<N> build_span_space<T, N>(const IndexTask<T, N>&); \
  template ActiveTilesPtr<N> read_span_space<T, N>(IndexReader&, const IndexTask<T, N>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
