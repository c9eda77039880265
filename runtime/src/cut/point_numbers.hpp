// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers for the points of a cut, which is made in parts: first in each part, then for all points in the order of
// their keys. A point is in several pieces, most of them of one part, so few keys are left to sort.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cut/slice_piece.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The different points of a part of a cut, numbered as they appear. Use one per thread.
class PartPoints {
 public:
  PartPoints();

  /// The number of a point: the next one if it is new.
  [[nodiscard]] Index number_of(PointKey key) {
    std::size_t at = place_of(key);
    for (; slots_[at].round == round_; at = (at + 1) & (slots_.size() - 1))
      if (slots_[at].key == key) return slots_[at].number;
    return add(key, at);
  }
  /// The keys by number; removes all.
  [[nodiscard]] std::vector<PointKey> take_keys();

 private:
  struct Slot {
    PointKey key = 0;
    Index number = 0;
    std::uint32_t round = 0;  ///< the part in which it was used
  };
  [[nodiscard]] std::size_t place_of(PointKey key) const { return static_cast<std::size_t>((key * kHash) >> shift_); }
  Index add(PointKey key, std::size_t at);
  void resize(std::size_t size);

  static constexpr std::uint64_t kHash = 0x9E3779B97F4A7C15u;
  std::vector<Slot> slots_;  ///< a hash table, at most a quarter full
  int shift_ = 0;
  std::uint32_t round_ = 1;
  std::vector<PointKey> keys_;
};

/// The different keys of all parts, ascending. Sets `numbers` to the numbers of the keys of the parts among them, part
/// by part. O(k) for k keys if few points are on edges from one vertex.
[[nodiscard]] std::vector<PointKey> number_points_of_parts(std::span<const std::span<const PointKey>> parts,
                                                           std::vector<Index>& numbers);

}  // namespace tegl::detail
