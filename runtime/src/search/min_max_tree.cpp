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
#include <functional>
#include <limits>
#include <numeric>
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

/// Rows of the samples of a brick, one bit per sample.
struct BrickBits {
  std::vector<std::uint16_t> high, missing;
};

/// Position of a brick: its first tile and its number of tiles along each axis.
struct Brick {
  /// `bricks`: number of bricks along each axis.
  Brick(const TileShape& grid, const TileShape::Index& bricks, std::size_t number) : dim(grid.dim()) {
    for (int a = 0; a < dim; ++a) {
      const std::size_t width = a == 0 ? kBrickLength : brick_width(dim);
      first[a] = number % bricks[a] * width;
      tiles[a] = std::min(width, grid.size(a) - first[a]);
      number /= bricks[a];
    }
  }
  /// Calls visit(index, ordinal) for the first tile of each row of tiles; with `more` = 1, for the first sample of
  /// each row of samples.
  template <class Visit>
  void for_rows(std::size_t more, const Visit& visit) const {
    TileShape::Index index = first;
    for (std::size_t ordinal = 0;; ++ordinal) {
      visit(index, ordinal);
      int a = 1;
      for (; a < dim && ++index[a] == first[a] + tiles[a] + more; ++a) index[a] = first[a];
      if (a == dim) return;
    }
  }
  [[nodiscard]] std::size_t sample_rows() const noexcept {
    std::size_t rows = 1;
    for (int a = 1; a < dim; ++a) rows *= tiles[a] + 1;
    return rows;
  }

  int dim;
  TileShape::Index first{}, tiles{};
};

/// Lists the nodes below a node. `above`, `sizes`: number of nodes along each axis, of its level and of the next.
/// Returns how many there are.
std::size_t list_children(int dim, std::size_t node, const TileShape::Index& above, const TileShape::Index& sizes,
                          std::array<std::size_t, std::size_t{1} << kMostAxes>& children) noexcept {
  children[0] = 0;
  std::size_t count = 1;
  std::size_t stride = 1;
  for (int a = 0; a < dim; ++a) {
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
  return count;
}

/// Adds the active tiles of a brick: combines the bits of the corners of each tile.
void add_active(const TileShape& grid, const Brick& brick, const BrickBits& bits, std::vector<TileNumber>& tiles) {
  TileShape::Index strides{};  // in rows of samples, by axis
  std::size_t rows = 1;
  for (int a = 1; a < brick.dim; ++a) {
    strides[a] = rows;
    rows *= brick.tiles[a] + 1;
  }
  // the rows of samples around a row of tiles
  std::array<std::size_t, std::size_t{1} << (kMostAxes - 1)> around{};
  std::size_t corners = 1;
  for (int a = 1; a < brick.dim; ++a, corners *= 2)
    for (std::size_t c = 0; c < corners; ++c) around[corners + c] = around[c] + strides[a];
  const auto inside = static_cast<std::uint16_t>((1u << brick.tiles[0]) - 1);
  brick.for_rows(0, [&](const TileShape::Index& index, std::size_t) {
    std::size_t row = 0;
    for (int a = 1; a < brick.dim; ++a) row += (index[a] - brick.first[a]) * strides[a];
    unsigned any = 0, all = ~0u, missing = 0;
    for (std::size_t c = 0; c < corners; ++c) {
      const std::size_t at = row + around[c];
      any |= bits.high[at];
      all &= bits.high[at];
      missing |= bits.missing[at];
    }
    unsigned active = (any | any >> 1) & ~(all & all >> 1) & ~(missing | missing >> 1) & inside;
    const TileNumber first = grid.number(index);
    for (; active != 0; active &= active - 1) tiles.push_back(first + static_cast<unsigned>(std::countr_zero(active)));
  });
}

/// Numbers of nodes of the levels along each axis, from the bricks to the top; 1 beyond the dimension.
std::vector<TileShape::Index> plan_sizes(const TileShape& grid) {
  std::vector<TileShape::Index> sizes(1);
  sizes[0].fill(1);
  for (int a = 0; a < grid.dim(); ++a) {
    const std::size_t width = a == 0 ? kBrickLength : brick_width(grid.dim());
    sizes[0][a] = (grid.size(a) + width - 1) / width;
  }
  const auto count_of = [](const TileShape::Index& of) {
    return std::accumulate(of.begin(), of.end(), std::size_t{1}, std::multiplies<>());
  };
  while (count_of(sizes.back()) > 1) {
    TileShape::Index above;
    for (int a = 0; a < kMostAxes; ++a) above[a] = (sizes.back()[a] + 1) / 2;
    sizes.push_back(above);
  }
  return sizes;
}

/// One level of the pyramid: ranges of bricks or of their unions, axis 0 fastest. A node without tiles that can be
/// active has greatest < least. Axes beyond the dimension have size 1.
template <Value T>
struct MinMaxLevel {
  TileShape::Index sizes{};
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

template <Value T>
class MinMaxTree final : public IndexMethod {
 public:
  using Levels = std::vector<MinMaxLevel<T>>;

  MinMaxTree(const IndexTask<T>& task, Levels levels)
      : samples_(task.samples), tiles_(task.tiles), levels_(std::move(levels)) {}

  [[nodiscard]] bool needs_image() const noexcept override { return true; }
  [[nodiscard]] std::size_t memory_bytes() const noexcept override {
    // without the sizes of axes beyond the dimension
    std::size_t bytes = levels_.capacity() * (static_cast<std::size_t>(dim()) * sizeof(std::size_t) +
                                              sizeof(levels_[0].least) + sizeof(levels_[0].greatest));
    for (const auto& level : levels_) bytes += (level.least.capacity() + level.greatest.capacity()) * sizeof(T);
    return bytes;
  }
  void collect(double isovalue, std::vector<TileNumber>& tiles) const override {
    const Threshold<T> threshold = make_threshold<T>(isovalue);
    BrickBits bits;
    for (const std::size_t brick : active_bricks(threshold)) find_in_brick(brick, threshold, bits, tiles);
  }
  bool collect_rows(double isovalue, TileRowSet& rows) const override {
    for (const std::size_t brick : active_bricks(make_threshold<T>(isovalue))) {
      const Brick at(tiles_, levels_[0].sizes, brick);
      at.for_rows(0, [&](const TileShape::Index& index, std::size_t) { rows.add(tiles_.row(index)); });
    }
    return true;
  }
  void write(IndexWriter& to) const override {
    to.value(static_cast<std::uint32_t>(kBrickLength));
    to.value(static_cast<std::uint32_t>(brick_width(dim())));
    for (const auto& level : levels_) {
      to.array(level.least);
      to.array(level.greatest);
    }
  }

 private:
  [[nodiscard]] int dim() const noexcept { return tiles_.dim(); }

  [[nodiscard]] std::vector<std::size_t> active_bricks(const Threshold<T>& threshold) const {
    std::vector<std::size_t> nodes;
    if (threshold.never) return nodes;
    const auto is_active = [&](const MinMaxLevel<T>& level, std::size_t at) {
      return level.least.data()[at] < threshold.value && !(level.greatest.data()[at] < threshold.value);
    };
    if (is_active(levels_.back(), 0)) nodes.push_back(0);
    std::vector<std::size_t> below;
    std::array<std::size_t, std::size_t{1} << kMostAxes> children{};
    for (std::size_t l = levels_.size() - 1; l > 0; --l) {
      below.clear();
      for (const std::size_t node : nodes) {
        const std::size_t count = list_children(dim(), node, levels_[l].sizes, levels_[l - 1].sizes, children);
        for (std::size_t c = 0; c < count; ++c)
          if (is_active(levels_[l - 1], children[c])) below.push_back(children[c]);
      }
      nodes.swap(below);
    }
    return nodes;
  }

  void find_in_brick(std::size_t number, const Threshold<T>& threshold, BrickBits& bits,
                     std::vector<TileNumber>& tiles) const {
    const Brick brick(tiles_, levels_[0].sizes, number);
    const std::size_t rows = brick.sample_rows();
    bits.high.resize(rows);
    bits.missing.resize(rows);
    brick.for_rows(
        1, [&](const TileShape::Index& index, std::size_t row) { classify(brick, index, row, threshold, bits); });
    add_active(tiles_, brick, bits, tiles);
  }

  void classify(const Brick& brick, const TileShape::Index& index, std::size_t row, const Threshold<T>& threshold,
                BrickBits& bits) const {
    const T* samples = samples_.data;
    for (int a = 0; a < dim(); ++a) samples += static_cast<std::ptrdiff_t>(index[a]) * samples_.strides[a];
    unsigned high = 0, missing = 0;
    for (std::size_t i = 0; i <= brick.tiles[0]; ++i, samples += samples_.strides[0]) {
      high |= (*samples >= threshold.value ? 1u : 0u) << i;
      if constexpr (std::is_floating_point_v<T>) missing |= (*samples != *samples ? 1u : 0u) << i;
    }
    bits.high[row] = static_cast<std::uint16_t>(high);
    bits.missing[row] = static_cast<std::uint16_t>(missing);
  }

  SampleView<T> samples_;
  TileShape tiles_;
  Levels levels_;
};

/// Levels without values.
template <Value T>
std::vector<MinMaxLevel<T>> plan_levels(const TileShape& grid) {
  std::vector<MinMaxLevel<T>> levels;
  for (const TileShape::Index& sizes : plan_sizes(grid)) levels.push_back({sizes, {}, {}});
  return levels;
}

/// Fills one row of bricks.
template <Value T>
void fill_brick_row(std::size_t brick_row, TileRanges<T>& ranges, MinMaxLevel<T>& bricks) {
  const TileShape& grid = ranges.grid();
  TileShape::Index first{}, index{}, end{};
  std::size_t rest = brick_row;
  for (int a = 1; a < grid.dim(); rest /= bricks.sizes[a++]) {
    index[a] = first[a] = rest % bricks.sizes[a] * brick_width(grid.dim());
    end[a] = std::min(first[a] + brick_width(grid.dim()), grid.size(a));
  }
  for (int a = 0; a < grid.dim();) {
    ranges.load(grid.row(index));
    for (std::size_t i = 0; i < grid.size(0); ++i)
      if (has_range(ranges.least()[i], ranges.greatest()[i]))
        bricks.widen(brick_row * bricks.sizes[0] + i / kBrickLength, ranges.least()[i], ranges.greatest()[i]);
    for (a = 1; a < grid.dim() && ++index[a] == end[a]; ++a) index[a] = first[a];
  }
}

/// Fills all bricks; rows of bricks in parallel.
template <Value T>
void fill_bricks(const IndexTask<T>& task, MinMaxLevel<T>& bricks) {
  Workers<TileRanges<T>> workers(task.options.work.threads, [&] { return TileRanges<T>(task.samples); });
  workers.for_range(bricks.count() / bricks.sizes[0], 1, [&](std::size_t from, std::size_t to, TileRanges<T>& ranges) {
    for (std::size_t row = from; row < to; ++row) fill_brick_row(row, ranges, bricks);
  });
}

template <Value T>
void fill_above(int dim, const MinMaxLevel<T>& below, MinMaxLevel<T>& level) {
  for (std::size_t i = 0; i < below.count(); ++i) {
    std::size_t at = 0, stride = 1, rest = i;
    for (int a = 0; a < dim; ++a) {
      at += rest % below.sizes[a] / 2 * stride;
      rest /= below.sizes[a];
      stride *= level.sizes[a];
    }
    level.widen(at, below.least[i], below.greatest[i]);
  }
}

}  // namespace

template <Value T>
IndexMethodPtr build_min_max_tree(const IndexTask<T>& task) {
  auto levels = plan_levels<T>(task.tiles);
  for (auto& level : levels) level.resize();
  if (task.tiles.count() > 0) fill_bricks(task, levels[0]);
  for (std::size_t l = 1; l < levels.size(); ++l) fill_above(task.tiles.dim(), levels[l - 1], levels[l]);
  return std::make_unique<MinMaxTree<T>>(task, std::move(levels));
}

template <Value T>
IndexMethodPtr read_min_max_tree(IndexReader& from, const IndexTask<T>& task) {
  const auto length = from.value<std::uint32_t>("length of bricks");
  const auto width = from.value<std::uint32_t>("width of bricks");
  const std::size_t expected = brick_width(task.tiles.dim());
  if (length != kBrickLength || width != expected)
    throw Error(ErrorCode::UnsupportedFormat, fmt::format("bricks of {} by {} tiles; expected {} by {}: build it again",
                                                          length, width, kBrickLength, expected));
  auto levels = plan_levels<T>(task.tiles);
  for (auto& level : levels) {
    level.least = from.array<T>(level.count(), "minimum values");
    level.greatest = from.array<T>(level.count(), "maximum values");
    if (level.least.size() != level.count() || level.greatest.size() != level.count())
      IndexReader::damaged(fmt::format("{} minimum and {} maximum values of a level; expected {} each",
                                       level.least.size(), level.greatest.size(), level.count()));
  }
  return std::make_unique<MinMaxTree<T>>(task, std::move(levels));
}

#define TEGL_INSTANTIATE(T)                                           \
  template IndexMethodPtr build_min_max_tree<T>(const IndexTask<T>&); \
  template IndexMethodPtr read_min_max_tree<T>(IndexReader&, const IndexTask<T>&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
