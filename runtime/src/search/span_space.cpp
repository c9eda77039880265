// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles by the span space, whose axes are the minimum and the maximum of tiles. The active tiles lie in a
// quadrant. The maxima divide the space into buckets with about the same number of tiles; within a bucket tiles are
// sorted by minimum. A query takes a prefix of every bucket above the isovalue and tests the maxima of one bucket:
// O(sqrt(n) log n + k) for k active of n tiles. If there are few distinct values (8 bits), each has its own bucket and
// maxima are not stored.
//
// Based on: Y. Livnat, H.-W. Shen, C. Johnson, A Near Optimal Isosurface Extraction Algorithm Using the Span Space,
// 1996; H.-W. Shen, C. Hansen, Y. Livnat, C. Johnson, Isosurfacing in Span Space with Utmost Efficiency (ISSUE), 1996.
// The ISSUE lattice has buckets along both axes; here the buckets of a row are one, sorted by minimum.
#include <algorithm>
#include <cmath>
#include <vector>

#include "image/bitplanes.hpp"
#include "search/tile_intervals.hpp"

namespace tegl::detail {

namespace {

template <Value T>
struct SpanBuckets {
  std::vector<T> bounds;             ///< by bucket: lower bound of its maxima
  std::vector<std::uint64_t> first;  ///< by bucket: its first place in the arrays below; then the end
  std::vector<TileId> tiles;         ///< sorted by minimum within each bucket
  std::vector<T> least;              ///< of these
  std::vector<T> greatest;           ///< of these tiles; empty if every bucket has only one maximum, its bound
};

template <Value T>
class SpanSpace final : public IndexMethod {
 public:
  explicit SpanSpace(SpanBuckets<T> buckets) : buckets_(std::move(buckets)) {}

  [[nodiscard]] std::size_t memory_bytes() const noexcept override {
    const auto bytes = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
    return bytes(buckets_.bounds) + bytes(buckets_.first) + bytes(buckets_.tiles) + bytes(buckets_.least) +
           bytes(buckets_.greatest);
  }
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const Threshold<T> threshold = make_threshold<T>(isovalue);
    if (threshold.never || buckets_.bounds.empty()) return;
    const T value = threshold.value;
    const auto reached = std::lower_bound(buckets_.bounds.begin(), buckets_.bounds.end(), value);
    auto bucket = static_cast<std::size_t>(reached - buckets_.bounds.begin());
    // Only the last bucket with a bound below the value can hold both tiles that reach it and tiles that do not.
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
  /// End of the tiles of a bucket whose minimum is below `value`.
  [[nodiscard]] std::size_t end_of_below(std::size_t bucket, T value) const {
    const T* const least = buckets_.least.data();
    const T* const end = least + buckets_.first[bucket + 1];
    return static_cast<std::size_t>(std::lower_bound(least + buckets_.first[bucket], end, value) - least);
  }

  SpanBuckets<T> buckets_;
};

/// With more buckets the bisections take longer than they save.
constexpr std::size_t kMostBuckets = 4096;

}  // namespace

template <Value T>
IndexMethodPtr build_span_space(const IndexTask<T>& task) {
  SpanBuckets<T> buckets;
  const TileIntervals<T> intervals = gather_intervals(task);
  Buffer<std::uint32_t> bucket_of;
  {
    const Buffer<TileId> order = ascending_order(intervals.greatest);
    // bounds: all distinct maxima if they are few, else quantiles
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
    // sort by bucket, then by minimum
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
  return std::make_unique<SpanSpace<T>>(std::move(buckets));
}

template <Value T>
IndexMethodPtr read_span_space(IndexReader& from, const IndexTask<T>& task) {
  const TileNumber tiles = task.tiles.count();
  SpanBuckets<T> buckets;
  buckets.bounds = from.array<T>(kMostBuckets + 1, "bounds of the buckets");
  buckets.first = from.array<std::uint64_t>(buckets.bounds.size() + 1, "positions of the buckets");
  buckets.tiles = from.array<TileId>(tiles, "tiles by minimum");
  const std::size_t count = buckets.tiles.size();
  buckets.least = from.array<T>(count, "minimum values");
  buckets.greatest = from.array<T>(count, "maximum values");
  if (buckets.first.size() != buckets.bounds.size() + 1 || buckets.least.size() != count ||
      (!buckets.greatest.empty() && buckets.greatest.size() != count))
    IndexReader::damaged(fmt::format(
        "{} positions, {} minimum and {} maximum values; expected {}, {} and the same number or none",
        buckets.first.size(), buckets.least.size(), buckets.greatest.size(), buckets.bounds.size() + 1, count));
  require_offsets(buckets.first, count, "buckets");
  require_tiles(buckets.tiles, tiles);
  return std::make_unique<SpanSpace<T>>(std::move(buckets));
}

#define TEGL_INSTANTIATE(T)                                         \
  template IndexMethodPtr build_span_space<T>(const IndexTask<T>&); \
  template IndexMethodPtr read_span_space<T>(IndexReader&, const IndexTask<T>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
