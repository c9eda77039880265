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
#include <vector>

#include "base/radix_sort.hpp"
#include "intersect/simplex_planes.hpp"

namespace tegl::detail {

/// Simplices that are flat are left out.
template <int N>
class BoxBlocks {
 public:
  static constexpr std::size_t kBlock = 8;

  BoxBlocks(const SimplexPlanes<N>& simplices, unsigned threads, const Progress& progress);

  /// The number of blocks of simplices.
  [[nodiscard]] std::size_t size() const noexcept { return levels_[0].size(); }
  /// The simplices in a block, in Morton order; fewer in the last one.
  [[nodiscard]] std::span<const Index> simplices(std::size_t block) const noexcept {
    const std::size_t first = block * kBlock;
    return std::span(order_).subspan(first, std::min(kBlock, order_.size() - first));
  }
  /// Replaces `near` by the blocks from `block` on whose boxes meet its box. Ascending.
  void find_near(std::size_t block, std::vector<Index>& near) const;
  /// Bit i: the box of simplex i of block `near` meets that of simplex `k` of `block`. For near == block only i > k.
  [[nodiscard]] unsigned meeting(std::size_t block, std::size_t k, std::size_t near) const noexcept {
    unsigned bits = levels_[0][near].meeting(levels_[0][block].box(k));
    if (near == block) bits &= ~0u << (k + 1);
    return bits;
  }

 private:
  /// Bounds are rounded outwards.
  struct Bounds {
    std::array<float, N> low, high;
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
    /// The box around all that are set, of which box 0 is one.
    [[nodiscard]] Bounds whole() const noexcept {
      Bounds result;
      for (int a = 0; a < N; ++a) {
        result.low[a] = *std::min_element(low[a].begin(), low[a].end());
        result.high[a] = *std::max_element(high[a].begin(), high[a].end());
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
      std::array<std::uint8_t, kBlock> meets;
      meets.fill(1);
      for (int a = 0; a < N; ++a)
        for (std::size_t i = 0; i < kBlock; ++i)
          meets[i] = static_cast<std::uint8_t>(meets[i] & (low[a][i] <= bounds.high[a] ? 1 : 0) &
                                               (high[a][i] >= bounds.low[a] ? 1 : 0));
      // gathers the lowest bits of eight bytes
      return static_cast<unsigned>((std::bit_cast<std::uint64_t>(meets) * 0x0102040810204080u) >> 56);
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
      for (unsigned bit = 0; bit < kBits; ++bit) key |= (digits >> bit & 1u) << (bit * N + static_cast<unsigned>(a));
    }
    keyed[i] = {key, order_[i]};
  });
  sort_by_bits(keyed, 64, [](const Keyed& k) { return k.key; });
  for (std::size_t i = 0; i < keyed.size(); ++i) order_[i] = keyed[i].simplex;
}

template <int N>
BoxBlocks<N>::BoxBlocks(const SimplexPlanes<N>& simplices, unsigned threads, const Progress& progress) {
  order_.reserve(simplices.size());
  for (std::size_t s = 0; s < simplices.size(); ++s)
    if (!simplices.is_flat(static_cast<Index>(s))) order_.push_back(static_cast<Index>(s));
  levels_.emplace_back((order_.size() + kBlock - 1) / kBlock);
  if (order_.empty()) return;
  sort(simplices, threads, part_of(progress, 0.0, 0.6));
  for_each_item(levels_[0].size(), threads, part_of(progress, 0.6, 1.0), [&](std::size_t block) {
    const std::span<const Index> here = this->simplices(block);
    for (std::size_t i = 0; i < here.size(); ++i) levels_[0][block].set(i, bounds_of(simplices.corners(here[i])));
  });
  while (levels_.back().size() > 1) {
    const std::vector<Eight>& below = levels_.back();
    std::vector<Eight> level((below.size() + kBlock - 1) / kBlock);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / kBlock].set(i % kBlock, below[i].whole());
    levels_.push_back(std::move(level));
  }
}

template <int N>
void BoxBlocks<N>::find_near(std::size_t block, std::vector<Index>& near) const {
  near.clear();
  const Bounds bounds = levels_[0][block].whole();
  struct Node {
    std::size_t level, number;
  };
  std::array<Node, 7 * 24 + 8> stack;  // at most seven siblings wait on each level
  std::size_t depth = 0;
  stack[depth++] = {levels_.size() - 1, 0};
  while (depth != 0) {
    const Node node = stack[--depth];
    if (node.level == 0) {
      near.push_back(static_cast<Index>(node.number));
      continue;
    }
    const unsigned bits = levels_[node.level][node.number].meeting(bounds);
    for (unsigned i = kBlock; i-- > 0;) {
      const std::size_t child = node.number * kBlock + i;
      // the last block below the child
      const unsigned shift = 3 * static_cast<unsigned>(node.level - 1);
      if ((bits >> i & 1u) != 0 && (child + 1) << shift > block) stack[depth++] = {node.level - 1, child};
    }
  }
}

}  // namespace tegl::detail
