// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles by an interval tree. A node has a value and the tiles whose ranges contain it, sorted by minimum and
// again by maximum. Ranges below the value are in the left subtree, ranges above it in the right one. A query descends
// from the root to a leaf and takes a prefix of one list per node, found by bisection: O(log^2 n + k) for k active of n
// tiles.
//
// Based on: P. Cignoni, P. Marino, C. Montani, E. Puppo, R. Scopigno, Speeding Up Isosurface Extraction Using Interval
// Trees, 1997. Pseudo code: T. Takahashi, I. Ide, Y. Mekada, H. Murase, T. Yonekura, A Speedup Method for Isosurfacing
// Volumetric Data Sampled with a Face-Centered Cubic Lattice, section 2.3, which splits a node at the middle of its
// remaining values. Here the node values are quantiles of the range ends. So the node of a range follows from two small
// integers by bit operations, and a leaf keeps the few tiles that lie between two consecutive values.
#include <algorithm>
#include <bit>
#include <vector>

#include "image/bitplanes.hpp"
#include "search/tile_intervals.hpp"

namespace tegl::detail {

namespace {

/// Nodes are numbered 1 ... C in the order of their values. The children of a node with z trailing zeros are 2^(z-1)
/// away; if C + 1 is no power of two, some nodes of the implicit tree do not exist. Bin j - 1 is node j; bin C + c is
/// the leaf above the first c node values.
template <Value T>
struct IntervalLists {
  std::vector<T> values;             ///< by node
  std::vector<std::uint64_t> first;  ///< by bin: its first place in the arrays below; then the end
  std::vector<TileId> by_least;      ///< sorted by minimum within each bin
  std::vector<T> least;              ///< of these
  std::vector<TileId> by_greatest;   ///< sorted by descending maximum within each node; without leaves
  std::vector<T> greatest;  ///< maxima of these tiles; then maxima of the leaves' tiles, in the order of by_least

  [[nodiscard]] std::size_t nodes() const noexcept { return values.size(); }
  [[nodiscard]] std::size_t in_nodes() const noexcept { return first[nodes()]; }
};

template <Value T>
class IntervalTree final : public IndexMethod {
 public:
  explicit IntervalTree(IntervalLists<T> lists) : lists_(std::move(lists)) {}

  [[nodiscard]] std::size_t memory_bytes() const noexcept override {
    const auto bytes = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
    return bytes(lists_.values) + bytes(lists_.first) + bytes(lists_.by_least) + bytes(lists_.least) +
           bytes(lists_.by_greatest) + bytes(lists_.greatest);
  }
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const Threshold<T> threshold = make_threshold<T>(isovalue);
    if (threshold.never) return;
    const T value = threshold.value;
    std::size_t node = std::bit_floor(lists_.nodes());
    std::size_t cell = 0;  // number of node values that are below
    for (std::size_t step = node / 2; node != 0; step /= 2) {
      bool right = false;
      if (node <= lists_.nodes()) {
        const T split = lists_.values[node - 1];
        if (split == value) return take(lists_.by_least, lists_.first[node - 1], lists_.first[node], tiles);
        right = split < value;
        if (right) {
          cell = node;
          take_above(node, value, tiles);
        } else {
          take_below(node, value, tiles);
        }
      }
      if (step == 0) break;
      node = right ? node + step : node - step;
    }
    take_leaf(cell, value, tiles);
  }

  void write(IndexWriter& to) const override {
    to.array(lists_.values);
    to.array(lists_.first);
    to.array(lists_.by_least);
    to.array(lists_.least);
    to.array(lists_.by_greatest);
    to.array(lists_.greatest);
  }

 private:
  static void take(const std::vector<TileId>& from, std::size_t first, std::size_t end,
                   std::vector<TileNumber>& tiles) {
    tiles.insert(tiles.end(), from.begin() + static_cast<std::ptrdiff_t>(first),
                 from.begin() + static_cast<std::ptrdiff_t>(end));
  }
  /// End of the minima below `value` among the ascending minima first ... end - 1.
  [[nodiscard]] std::size_t end_of_below(std::size_t first, std::size_t end, T value) const {
    const T* const least = lists_.least.data();
    return static_cast<std::size_t>(std::lower_bound(least + first, least + end, value) - least);
  }
  /// The node's value is above `value`: the ranges of all its tiles reach beyond `value`; active are those that begin
  /// below it.
  void take_below(std::size_t node, T value, std::vector<TileNumber>& tiles) const {
    const std::size_t first = lists_.first[node - 1];
    take(lists_.by_least, first, end_of_below(first, lists_.first[node], value), tiles);
  }
  /// The node's value is below `value`: the ranges of all its tiles begin below `value`; active are those that reach
  /// it.
  void take_above(std::size_t node, T value, std::vector<TileNumber>& tiles) const {
    const T* const greatest = lists_.greatest.data();
    const std::size_t first = lists_.first[node - 1];
    const T* const end =
        std::partition_point(greatest + first, greatest + lists_.first[node], [&](T each) { return !(each < value); });
    take(lists_.by_greatest, first, static_cast<std::size_t>(end - greatest), tiles);
  }
  void take_leaf(std::size_t cell, T value, std::vector<TileNumber>& tiles) const {
    const std::size_t bin = lists_.nodes() + cell;
    const std::size_t first = lists_.first[bin];
    const std::size_t end = end_of_below(first, lists_.first[bin + 1], value);
    for (std::size_t i = first; i < end; ++i)
      if (!(lists_.greatest[i] < value)) tiles.push_back(lists_.by_least[i]);
  }

  IntervalLists<T> lists_;
};

/// Approximate maximum number of tiles in a leaf.
constexpr std::size_t kLeafTiles = 64;

}  // namespace

template <Value T>
IndexMethodPtr build_interval_tree(const IndexTask<T>& task) {
  IntervalLists<T> lists;
  TileIntervals<T> intervals = gather_intervals(task);
  const Buffer<TileId> up = ascending_order(intervals.least);
  task.tell(0.4);
  Buffer<TileId> down = ascending_order(intervals.greatest);
  task.tell(0.6);
  // node values
  add_quantiles(intervals.least, up, kLeafTiles, lists.values);
  add_quantiles(intervals.greatest, down, kLeafTiles, lists.values);
  sort_unique(lists.values);
  const std::size_t nodes = lists.nodes();
  // the bin of each tile
  Buffer<std::uint32_t> bins = cells_of(intervals.least, up, lists.values);
  {
    const Buffer<std::uint32_t> ends = cells_of(intervals.greatest, down, lists.values);
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const std::uint32_t a = bins.data()[i];
      const std::uint32_t b = ends.data()[i];
      // Among the nodes a + 1 ... b, the one nearest to the root.
      bins.data()[i] = a == b ? static_cast<std::uint32_t>(nodes) + a : (b & ~(std::bit_floor(a ^ b) - 1)) - 1;
    }
  }
  task.tell(0.7);
  // lists by minimum
  Bins by_least = distribute(up, bins, 2 * nodes + 1);
  lists.by_least = in_order(intervals.tiles, by_least.order);
  lists.least = in_order(intervals.least, by_least.order);
  lists.first = std::move(by_least.first);
  task.tell(0.85);
  // lists by maximum
  std::reverse(down.begin(), down.end());
  Bins by_greatest = distribute(down, bins, 2 * nodes + 1);
  // In leaves, maxima are in the order of by_least.
  const auto leaves = static_cast<std::ptrdiff_t>(lists.in_nodes());
  std::copy(by_least.order.begin() + leaves, by_least.order.end(), by_greatest.order.begin() + leaves);
  lists.greatest = in_order(intervals.greatest, by_greatest.order);
  by_greatest.order.resize(lists.in_nodes());
  lists.by_greatest = in_order(intervals.tiles, by_greatest.order);
  return std::make_unique<IntervalTree<T>>(std::move(lists));
}

template <Value T>
IndexMethodPtr read_interval_tree(IndexReader& from, const IndexTask<T>& task) {
  const TileNumber tiles = task.tiles.count();
  IntervalLists<T> lists;
  lists.values = from.array<T>(2 * (tiles / kLeafTiles + 1), "values of the nodes");
  const std::size_t nodes = lists.nodes();
  lists.first = from.array<std::uint64_t>(2 * nodes + 2, "positions of the nodes");
  lists.by_least = from.array<TileId>(tiles, "tiles by minimum");
  const std::size_t count = lists.by_least.size();
  lists.least = from.array<T>(count, "minimum values");
  if (lists.first.size() != 2 * nodes + 2 || lists.least.size() != count)
    IndexReader::damaged(fmt::format("{} positions and {} minimum values; expected {} and {}", lists.first.size(),
                                     lists.least.size(), 2 * nodes + 2, count));
  require_offsets(lists.first, count, "nodes");
  lists.by_greatest = from.array<TileId>(count, "tiles by maximum");
  lists.greatest = from.array<T>(count, "maximum values");
  if (lists.by_greatest.size() != lists.in_nodes() || lists.greatest.size() != count)
    IndexReader::damaged(fmt::format("{} tiles by maximum and {} maximum values; expected {} and {}",
                                     lists.by_greatest.size(), lists.greatest.size(), lists.in_nodes(), count));
  require_tiles(lists.by_least, tiles);
  require_tiles(lists.by_greatest, tiles);
  return std::make_unique<IntervalTree<T>>(std::move(lists));
}

#define TEGL_INSTANTIATE(T)                                            \
  template IndexMethodPtr build_interval_tree<T>(const IndexTask<T>&); \
  template IndexMethodPtr read_interval_tree<T>(IndexReader&, const IndexTask<T>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
