// SPDX-License-Identifier: BSD-3-Clause
//
// Active tiles by a min-max pyramid: minimum and maximum of each brick of tiles, of 2^N bricks each, and so on up to
// one. A query descends into the nodes whose range contains the isovalue and reads the samples of the active bricks.
// Memory beside the image: two values per brick, and about 1 / (2^N - 1) of that for all levels above.
//
// Based on: J. Wilhelms, A. Van Gelder, Octrees for Faster Isosurface Generation, 1992.
#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

#include "base/workers.hpp"
#include "image/bitplanes.hpp"
#include "search/active_tiles_methods.hpp"
#include "search/tile_ranges.hpp"

namespace tegl::detail {

namespace {

/// Tiles of a brick along axis 0 and along the other axes.
constexpr std::size_t kBrickLength = 8;
constexpr std::size_t brick_width(int dim) noexcept { return dim <= 3 ? 4 : 2; }

/// One level of the pyramid: ranges of bricks or of their unions, axis 0 fastest. A node without tiles that can be
/// active has greatest < least.
template <Value T, int N>
struct MinMaxLevel {
  std::array<std::size_t, N> sizes{};
  std::vector<T> least, greatest;

  void resize() {
    least.assign(count(), std::numeric_limits<T>::max());
    greatest.assign(count(), std::numeric_limits<T>::lowest());
  }
  [[nodiscard]] std::size_t count() const noexcept {
    std::size_t count = 1;
    for (const std::size_t size : sizes) count *= size;
    return count;
  }
  void widen(std::size_t at, T low, T high) noexcept {
    T* const from = least.data() + at;
    T* const to = greatest.data() + at;
    *from = std::min(*from, low);
    *to = std::max(*to, high);
  }
};

template <Value T, int N>
class MinMaxTree final : public tegl::ActiveTiles<N> {
 public:
  using Levels = std::vector<MinMaxLevel<T, N>>;
  using Index = std::array<std::size_t, N>;

  MinMaxTree(const IndexTask<T, N>& task, Levels levels)
      : tegl::ActiveTiles<N>(task.identity), image_(task.image), levels_(std::move(levels)) {}

  [[nodiscard]] ActiveMethod method() const noexcept override { return ActiveMethod::min_max_tree; }
  [[nodiscard]] bool needs_image() const noexcept override { return true; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept override {
    std::size_t bytes = levels_.capacity() * sizeof(levels_[0]);
    for (const auto& level : levels_) bytes += (level.least.capacity() + level.greatest.capacity()) * sizeof(T);
    return bytes;
  }

 protected:
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const Threshold<T> threshold = make_threshold<T>(isovalue);
    Bits bits;
    for (const std::size_t brick : active_bricks(threshold)) find_in_brick(brick, threshold, bits, tiles);
  }
  void collect_rows(double isovalue, TileRowSet& rows) const override {
    for (const std::size_t brick : active_bricks(make_threshold<T>(isovalue))) {
      const Brick at(*this, brick);
      at.for_rows(0, [&](const Index& index, std::size_t) { rows.add(this->grid().row(this->grid().number(index))); });
    }
  }
  void write(IndexWriter& to) const override {
    to.value(static_cast<std::uint32_t>(kBrickLength));
    to.value(static_cast<std::uint32_t>(brick_width(N)));
    for (const auto& level : levels_) {
      to.array(level.least);
      to.array(level.greatest);
    }
  }

 private:
  /// Rows of the samples of a brick, one bit per sample.
  struct Bits {
    std::vector<std::uint16_t> high, missing;
  };

  /// Position of a brick: its first tile and its number of tiles along each axis.
  struct Brick {
    Brick(const MinMaxTree& tree, std::size_t number) {
      for (int a = 0; a < N; ++a) {
        const std::size_t width = a == 0 ? kBrickLength : brick_width(N);
        first[a] = number % tree.levels_[0].sizes[a] * width;
        tiles[a] = std::min(width, tree.grid().size(a) - first[a]);
        number /= tree.levels_[0].sizes[a];
      }
    }
    /// Calls visit(index, ordinal) for the first tile of each row of tiles; with `more` = 1, for the first sample of
    /// each row of samples.
    template <class Visit>
    void for_rows(std::size_t more, const Visit& visit) const {
      Index index = first;
      for (std::size_t ordinal = 0;; ++ordinal) {
        visit(index, ordinal);
        int a = 1;
        for (; a < N && ++index[a] == first[a] + tiles[a] + more; ++a) index[a] = first[a];
        if (a == N) return;
      }
    }
    Index first, tiles;
  };

  [[nodiscard]] std::vector<std::size_t> active_bricks(const Threshold<T>& threshold) const {
    std::vector<std::size_t> nodes;
    if (threshold.never) return nodes;
    const auto is_active = [&](const MinMaxLevel<T, N>& level, std::size_t at) {
      return level.least.data()[at] < threshold.value && !(level.greatest.data()[at] < threshold.value);
    };
    if (is_active(levels_.back(), 0)) nodes.push_back(0);
    std::vector<std::size_t> below;
    for (std::size_t l = levels_.size() - 1; l > 0; --l) {
      below.clear();
      for (const std::size_t node : nodes)
        for_children(l, node, [&](std::size_t child) {
          if (is_active(levels_[l - 1], child)) below.push_back(child);
        });
      nodes.swap(below);
    }
    return nodes;
  }

  template <class Visit>
  void for_children(std::size_t l, std::size_t node, const Visit& visit) const {
    const auto& above = levels_[l].sizes;
    const auto& sizes = levels_[l - 1].sizes;
    std::array<std::size_t, std::size_t{1} << N> children{};
    std::size_t count = 1;
    std::size_t stride = 1;
    for (int a = 0; a < N; ++a) {
      const std::size_t first = node % above[a] * 2;
      node /= above[a];
      const bool two = first + 1 < sizes[a];
      for (std::size_t c = 0; c < count; ++c) {
        children[c] += first * stride;
        if (two) children[c + count] = children[c] + stride;
      }
      if (two) count *= 2;
      stride *= sizes[a];
    }
    for (std::size_t c = 0; c < count; ++c) visit(children[c]);
  }

  void find_in_brick(std::size_t number, const Threshold<T>& threshold, Bits& bits,
                     std::vector<TileNumber>& tiles) const {
    const Brick brick(*this, number);
    std::array<std::size_t, N> strides{};  // in rows of samples, by axis
    std::size_t rows = 1;
    for (int a = 1; a < N; ++a) {
      strides[a] = rows;
      rows *= brick.tiles[a] + 1;
    }
    // classify the samples
    bits.high.resize(rows);
    bits.missing.resize(rows);
    brick.for_rows(1, [&](const Index& index, std::size_t row) { classify(brick, index, row, threshold, bits); });
    // combine the bits of the 2^N corners of each tile
    const auto inside = static_cast<std::uint16_t>((1u << brick.tiles[0]) - 1);
    brick.for_rows(0, [&](const Index& index, std::size_t) {
      std::size_t row = 0;
      for (int a = 1; a < N; ++a) row += (index[a] - brick.first[a]) * strides[a];
      unsigned any = 0, all = ~0u, missing = 0;
      for (unsigned corner = 0; corner < 1u << (N - 1); ++corner) {
        std::size_t at = row;
        for (int a = 1; a < N; ++a) at += (corner >> (a - 1) & 1u) * strides[a];
        any |= bits.high[at];
        all &= bits.high[at];
        missing |= bits.missing[at];
      }
      unsigned active = (any | any >> 1) & ~(all & all >> 1) & ~(missing | missing >> 1) & inside;
      const TileNumber first = this->grid().number(index);
      for (; active != 0; active &= active - 1)
        tiles.push_back(first + static_cast<unsigned>(std::countr_zero(active)));
    });
  }

  void classify(const Brick& brick, const Index& index, std::size_t row, const Threshold<T>& threshold,
                Bits& bits) const {
    const T* samples = image_.data();
    for (int a = 0; a < N; ++a) samples += static_cast<std::ptrdiff_t>(index[a]) * image_.strides()[a];
    unsigned high = 0, missing = 0;
    for (std::size_t i = 0; i <= brick.tiles[0]; ++i, samples += image_.strides()[0]) {
      high |= (*samples >= threshold.value ? 1u : 0u) << i;
      if constexpr (std::is_floating_point_v<T>) missing |= (*samples != *samples ? 1u : 0u) << i;
    }
    bits.high[row] = static_cast<std::uint16_t>(high);
    bits.missing[row] = static_cast<std::uint16_t>(missing);
  }

  Image<T, N> image_;
  Levels levels_;
};

/// Sizes of the levels, without values, from the bricks to the top.
template <Value T, int N>
std::vector<MinMaxLevel<T, N>> plan_levels(const TileGrid<N>& grid) {
  std::vector<MinMaxLevel<T, N>> levels(1);
  for (int a = 0; a < N; ++a) {
    const std::size_t width = a == 0 ? kBrickLength : brick_width(N);
    levels[0].sizes[a] = (grid.size(a) + width - 1) / width;
  }
  while (levels.back().count() > 1) {
    MinMaxLevel<T, N> above;
    for (int a = 0; a < N; ++a) above.sizes[a] = (levels.back().sizes[a] + 1) / 2;
    levels.push_back(above);
  }
  return levels;
}

/// Fills one row of bricks.
template <Value T, int N>
void fill_brick_row(std::size_t brick_row, TileRanges<T, N>& ranges, MinMaxLevel<T, N>& bricks) {
  const TileGrid<N>& grid = ranges.grid();
  std::array<std::size_t, N> first{}, index{}, end{};
  std::size_t rest = brick_row;
  for (int a = 1; a < N; rest /= bricks.sizes[a++]) {
    index[a] = first[a] = rest % bricks.sizes[a] * brick_width(N);
    end[a] = std::min(first[a] + brick_width(N), grid.size(a));
  }
  for (int a = 0; a < N;) {
    ranges.load(grid.row(grid.number(index)));
    for (std::size_t i = 0; i < grid.size(0); ++i)
      if (has_range(ranges.least()[i], ranges.greatest()[i]))
        bricks.widen(brick_row * bricks.sizes[0] + i / kBrickLength, ranges.least()[i], ranges.greatest()[i]);
    for (a = 1; a < N && ++index[a] == end[a]; ++a) index[a] = first[a];
  }
}

/// Fills all bricks; rows of bricks in parallel.
template <Value T, int N>
void fill_bricks(const IndexTask<T, N>& task, MinMaxLevel<T, N>& bricks) {
  Workers<TileRanges<T, N>> workers(task.options.threads, [&] { return TileRanges<T, N>(task.image); });
  workers.for_range(bricks.count() / bricks.sizes[0], 1,
                    [&](std::size_t from, std::size_t to, TileRanges<T, N>& ranges) {
                      for (std::size_t row = from; row < to; ++row) fill_brick_row(row, ranges, bricks);
                    });
}

template <Value T, int N>
void fill_above(const MinMaxLevel<T, N>& below, MinMaxLevel<T, N>& level) {
  for (std::size_t i = 0; i < below.count(); ++i) {
    std::size_t at = 0, stride = 1, rest = i;
    for (int a = 0; a < N; ++a) {
      at += rest % below.sizes[a] / 2 * stride;
      rest /= below.sizes[a];
      stride *= level.sizes[a];
    }
    level.widen(at, below.least[i], below.greatest[i]);
  }
}

}  // namespace

template <Value T, int N>
ActiveTilesPtr<N> build_min_max_tree(const IndexTask<T, N>& task) {
  const TileGrid<N> grid(task.identity.sizes);
  auto levels = plan_levels<T>(grid);
  for (auto& level : levels) level.resize();
  if (grid.count() > 0) fill_bricks(task, levels[0]);
  for (std::size_t l = 1; l < levels.size(); ++l) fill_above(levels[l - 1], levels[l]);
  return std::make_unique<MinMaxTree<T, N>>(task, std::move(levels));
}

template <Value T, int N>
ActiveTilesPtr<N> read_min_max_tree(IndexReader& from, const IndexTask<T, N>& task) {
  const auto length = from.value<std::uint32_t>("length of bricks");
  const auto width = from.value<std::uint32_t>("width of bricks");
  if (length != kBrickLength || width != brick_width(N))
    throw Error(ErrorCode::UnsupportedFormat, fmt::format("bricks of {} by {} tiles; expected {} by {}: build it again",
                                                          length, width, kBrickLength, brick_width(N)));
  auto levels = plan_levels<T>(TileGrid<N>(task.identity.sizes));
  for (auto& level : levels) {
    level.least = from.array<T>(level.count(), "minimum values");
    level.greatest = from.array<T>(level.count(), "maximum values");
    if (level.least.size() != level.count() || level.greatest.size() != level.count())
      IndexReader::damaged(fmt::format("{} minimum and {} maximum values of a level; expected {} each",
                                       level.least.size(), level.greatest.size(), level.count()));
  }
  return std::make_unique<MinMaxTree<T, N>>(task, std::move(levels));
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                      \
  template ActiveTilesPtr<N> build_min_max_tree<T, N>(const IndexTask<T, N>&); \
  template ActiveTilesPtr<N> read_min_max_tree<T, N>(IndexReader&, const IndexTask<T, N>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
