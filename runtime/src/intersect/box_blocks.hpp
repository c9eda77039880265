// SPDX-License-Identifier: BSD-3-Clause
//
// A hierarchy of bounding boxes for the pairs of simplices whose boxes meet. The simplices are in Morton order, in
// blocks of eight; eight blocks of a level make one of the next. Eight boxes are compared with one at once.
//
// Based on: G. M. Morton, A computer oriented geodetic data base and a new technique in file sequencing, 1966.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "base/radix_sort.hpp"
#include "intersect/simplex_planes.hpp"

namespace tegl::detail {

/// Simplices that are flat meet none. The order stays; boxes may be replaced.
template <int N>
class BoxBlocks {
 public:
  static constexpr std::size_t kBlock = 8;
  class NearBlocks;

  BoxBlocks(const SimplexPlanes<N>& simplices, unsigned threads, const Progress& progress);

  /// The number of blocks of simplices.
  [[nodiscard]] std::size_t size() const noexcept { return levels_[0].size(); }
  /// The simplices in a block, in Morton order; fewer in the last one.
  [[nodiscard]] std::span<const Index> simplices(std::size_t block) const noexcept {
    const std::size_t first = block * kBlock;
    return std::span(order_).subspan(first, std::min(kBlock, order_.size() - first));
  }
  /// Replaces `near` by the blocks from `block` on whose boxes meet its box.
  void find_near(std::size_t block, NearBlocks& near) const;
  /// Calls visit(simplex) for the simplices whose boxes meet the box of simplex `k` of `block`, in the blocks `near`
  /// it. In `block` itself, only for those after `k`.
  template <class Visit>
  void visit_meeting(std::size_t block, std::size_t k, const NearBlocks& near, const Visit& visit) const;
  /// Calls visit(simplex) for all simplices whose boxes meet the box of these corners.
  template <class Visit>
  void visit_near(const CornersN<N>& corners, const Visit& visit) const {
    const Bounds bounds = bounds_of(corners);
    visit_blocks(bounds, 0, [&](std::size_t block) {
      for (unsigned bits = levels_[0][block].meeting(bounds); bits != 0; bits &= bits - 1)
        visit(order_[block * kBlock + static_cast<std::size_t>(std::countr_zero(bits))]);
    });
  }
  /// Replaces the box of a simplex, by its place in the order; without corners it meets no box from then on.
  void replace(std::size_t place, const CornersN<N>* corners) {
    Bounds bounds = corners != nullptr ? bounds_of(*corners) : Bounds::none();
    for (std::vector<Eight>& level : levels_) {
      level[place / kBlock].set(place % kBlock, bounds);
      place /= kBlock;
      bounds = level[place].whole();
    }
  }
  /// All simplices, in Morton order.
  [[nodiscard]] std::span<const Index> order() const noexcept { return order_; }

 private:
  /// Bounds are rounded outwards.
  struct Bounds {
    std::array<float, N> low, high;

    /// A box of NaN, which meets none.
    static Bounds none() noexcept {
      Bounds result;
      result.low.fill(std::numeric_limits<float>::quiet_NaN());
      result.high.fill(std::numeric_limits<float>::quiet_NaN());
      return result;
    }
  };
  struct alignas(32) Eight {
    std::array<std::array<float, kBlock>, N> low, high;

    /// Boxes are NaN, and so meet none, until they are set.
    Eight() noexcept {
      for (auto* const side : {&low, &high})
        for (auto& row : *side) row.fill(std::numeric_limits<float>::quiet_NaN());
    }
    [[nodiscard]] Bounds box(std::size_t i) const noexcept {
      Bounds result;
      for (int a = 0; a < N; ++a) {
        result.low[a] = low[a][i];
        result.high[a] = high[a][i];
      }
      return result;
    }
    /// The box around all that are set; none if there is none.
    [[nodiscard]] Bounds whole() const noexcept {
      Bounds result = Bounds::none();
      for (int a = 0; a < N; ++a)
        for (std::size_t i = 0; i < kBlock; ++i) {
          if (!(low[a][i] >= result.low[a])) result.low[a] = std::isnan(low[a][i]) ? result.low[a] : low[a][i];
          if (!(high[a][i] <= result.high[a])) result.high[a] = std::isnan(high[a][i]) ? result.high[a] : high[a][i];
        }
      return result;
    }
    void set(std::size_t i, const Bounds& bounds) noexcept {
      for (int a = 0; a < N; ++a) {
        low[a][i] = bounds.low[a];
        high[a][i] = bounds.high[a];
      }
    }
    /// Bit i: box i meets the box.
    [[nodiscard]] unsigned meeting(const Bounds& bounds) const noexcept {
      // loops of eight, which compilers turn into vector instructions
      std::array<std::uint32_t, kBlock> meets;
      meets.fill(~0u);
      for (int a = 0; a < N; ++a)
        for (std::size_t i = 0; i < kBlock; ++i)
          meets[i] &= (low[a][i] <= bounds.high[a] ? ~0u : 0u) & (high[a][i] >= bounds.low[a] ? ~0u : 0u);
      std::uint32_t bits = 0;
      for (std::size_t i = 0; i < kBlock; ++i) bits |= meets[i] & (1u << i);
      return bits;
    }
  };

  static float rounded_down(double x) noexcept {
    const auto result = static_cast<float>(x);
    return static_cast<double>(result) <= x ? result : std::nextafter(result, -std::numeric_limits<float>::infinity());
  }
  static Bounds bounds_of(const CornersN<N>& corners) noexcept {
    Bounds result;
    for (int a = 0; a < N; ++a) {
      double low = corners[0][a], high = low;
      for (const PointN<N>& corner : corners) {
        low = std::min(low, corner[a]);
        high = std::max(high, corner[a]);
      }
      result.low[a] = rounded_down(low);
      result.high[a] = -rounded_down(-high);
    }
    return result;
  }
  /// Calls visit(block) for the blocks from `first` on that may contain a box that meets `bounds`. Ascending.
  template <class Visit>
  void visit_blocks(const Bounds& bounds, std::size_t first, const Visit& visit) const;
  /// Moves bit i to bit i N, for the lowest 64 / N bits.
  static std::uint64_t spread_bits(std::uint64_t x) noexcept {
    if constexpr (N == 2) {
      x = (x | x << 16) & 0x0000ffff0000ffffu;
      x = (x | x << 8) & 0x00ff00ff00ff00ffu;
      x = (x | x << 4) & 0x0f0f0f0f0f0f0f0fu;
      x = (x | x << 2) & 0x3333333333333333u;
      x = (x | x << 1) & 0x5555555555555555u;
    } else if constexpr (N == 3) {
      x = (x | x << 32) & 0x001f00000000ffffu;
      x = (x | x << 16) & 0x001f0000ff0000ffu;
      x = (x | x << 8) & 0x100f00f00f00f00fu;
      x = (x | x << 4) & 0x10c30c30c30c30c3u;
      x = (x | x << 2) & 0x1249249249249249u;
    } else {
      x = (x | x << 24) & 0x000000ff000000ffu;
      x = (x | x << 12) & 0x000f000f000f000fu;
      x = (x | x << 6) & 0x0303030303030303u;
      x = (x | x << 3) & 0x1111111111111111u;
    }
    return x;
  }
  void sort(const SimplexPlanes<N>& simplices, unsigned threads, const Progress& progress);

  std::vector<Index> order_;
  std::vector<std::vector<Eight>> levels_;  ///< level 0: boxes of simplices; level k + 1: of blocks of level k
};

/// Orders the simplices by the tile of a grid that contains their centroid, on a Morton curve. The tiles are as large
/// as the mean bounding box, so that axes with different units have comparable tiles.
template <int N>
void BoxBlocks<N>::sort(const SimplexPlanes<N>& simplices, unsigned threads, const Progress& progress) {
  constexpr unsigned kBits = 64 / N;
  constexpr auto kMostCells = static_cast<double>((std::uint64_t{1} << kBits) - 1);
  PointN<N> least, most, extent{};
  least.fill(std::numeric_limits<double>::infinity());
  most.fill(-std::numeric_limits<double>::infinity());
  for (const Index s : order_)
    for (int a = 0; a < N; ++a) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Index v : simplices.simplex(s)) {
        low = std::min(low, simplices.point(v)[a]);
        high = std::max(high, simplices.point(v)[a]);
      }
      least[a] = std::min(least[a], low);
      most[a] = std::max(most[a], high);
      extent[a] += 0.25 * (high / static_cast<double>(order_.size()) - low / static_cast<double>(order_.size()));
    }
  PointN<N> scale{};
  for (int a = 0; a < N; ++a) {
    const double range = 0.5 * most[a] - 0.5 * least[a];
    extent[a] = std::max(extent[a], std::ldexp(range, 1 - static_cast<int>(kBits)));
    if (extent[a] > 0.0 && std::isfinite(1.0 / extent[a])) scale[a] = 0.5 / extent[a];
  }
  struct Keyed {
    std::uint64_t key;
    Index simplex;
  };
  std::vector<Keyed> keyed(order_.size());
  for_each_item(order_.size(), threads, progress, [&](std::size_t i) {
    std::uint64_t key = 0;
    for (int a = 0; a < N; ++a) {
      double middle = 0.0;
      for (const Index v : simplices.simplex(order_[i])) middle += simplices.point(v)[a] / N;
      const double cell = (middle - least[a]) * scale[a];  // infinite or NaN for huge coordinates
      const auto digits = static_cast<std::uint64_t>(cell > 0.0 ? std::min(cell, kMostCells) : 0.0);
      key |= spread_bits(digits) << a;
    }
    keyed[i] = {key, order_[i]};
  });
  sort_by_bits(keyed, 64, [](const Keyed& k) { return k.key; });
  for (std::size_t i = 0; i < keyed.size(); ++i) order_[i] = keyed[i].simplex;
}

template <int N>
BoxBlocks<N>::BoxBlocks(const SimplexPlanes<N>& simplices, unsigned threads, const Progress& progress) {
  order_.resize(simplices.size());
  std::iota(order_.begin(), order_.end(), Index{0});
  levels_.emplace_back((order_.size() + kBlock - 1) / kBlock);
  if (order_.empty()) return;
  sort(simplices, threads, part_of(progress, 0.0, 0.6));
  for_each_item(levels_[0].size(), threads, part_of(progress, 0.6, 1.0), [&](std::size_t block) {
    const std::span<const Index> here = this->simplices(block);
    for (std::size_t i = 0; i < here.size(); ++i)
      if (!simplices.is_flat(here[i])) levels_[0][block].set(i, bounds_of(simplices.corners(here[i])));
  });
  while (levels_.back().size() > 1) {
    const std::vector<Eight>& below = levels_.back();
    std::vector<Eight> level((below.size() + kBlock - 1) / kBlock);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / kBlock].set(i % kBlock, below[i].whole());
    levels_.push_back(std::move(level));
  }
}

template <int N>
template <class Visit>
void BoxBlocks<N>::visit_blocks(const Bounds& bounds, std::size_t first, const Visit& visit) const {
  struct Node {
    std::size_t level, number;
  };
  std::array<Node, 7 * 24 + 8> stack;  // at most seven siblings wait on each level
  std::size_t depth = 0;
  if (!order_.empty()) stack[depth++] = {levels_.size() - 1, 0};
  while (depth != 0) {
    const Node node = stack[--depth];
    if (node.level == 0) {
      visit(node.number);
      continue;
    }
    const unsigned bits = levels_[node.level][node.number].meeting(bounds);
    const unsigned shift = 3 * static_cast<unsigned>(node.level - 1);  // eight blocks below each block
    for (unsigned i = kBlock; i-- > 0;) {
      const std::size_t child = node.number * kBlock + i;
      if ((bits >> i & 1u) != 0 && (child + 1) << shift > first) stack[depth++] = {node.level - 1, child};
    }
  }
}

/// Some blocks with their boxes, eight at a time.
template <int N>
class BoxBlocks<N>::NearBlocks {
 private:
  friend class BoxBlocks;
  void clear() noexcept {
    blocks_.clear();
    boxes_.clear();
  }
  void add(std::size_t block, const Bounds& bounds) {
    if (blocks_.size() % kBlock == 0) boxes_.emplace_back();
    boxes_.back().set(blocks_.size() % kBlock, bounds);
    blocks_.push_back(block);
  }

  std::vector<std::size_t> blocks_;  ///< ascending
  std::vector<Eight> boxes_;
};

template <int N>
void BoxBlocks<N>::find_near(std::size_t block, NearBlocks& near) const {
  near.clear();
  visit_blocks(levels_[0][block].whole(), block, [&](std::size_t found) {
    near.add(found, levels_.size() > 1 ? levels_[1][found / kBlock].box(found % kBlock) : levels_[0][found].whole());
  });
}

template <int N>
template <class Visit>
void BoxBlocks<N>::visit_meeting(std::size_t block, std::size_t k, const NearBlocks& near, const Visit& visit) const {
  const Bounds bounds = levels_[0][block].box(k);
  for (std::size_t i = 0; i < near.boxes_.size(); ++i)
    for (unsigned blocks = near.boxes_[i].meeting(bounds); blocks != 0; blocks &= blocks - 1) {
      const std::size_t other = near.blocks_[i * kBlock + static_cast<std::size_t>(std::countr_zero(blocks))];
      unsigned bits = levels_[0][other].meeting(bounds);
      if (other == block) bits &= ~0u << (k + 1);
      for (; bits != 0; bits &= bits - 1)
        visit(order_[other * kBlock + static_cast<std::size_t>(std::countr_zero(bits))]);
    }
}

}  // namespace tegl::detail
