// SPDX-License-Identifier: BSD-3-Clause
//
// Map from vertex numbers to their positions in a list.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Position of each number in an ascending list without duplicates: a hash table at most half full.
class IndexMap {
 public:
  IndexMap() = default;
  explicit IndexMap(std::vector<Index> numbers) : numbers_(std::move(numbers)) {
    if (numbers_.empty()) return;
    places_.assign(std::bit_ceil(2 * numbers_.size()), 0);
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      std::size_t slot = slot_of(numbers_[i]);
      while (places_[slot] != 0) slot = (slot + 1) & (places_.size() - 1);
      places_[slot] = static_cast<Index>(i + 1);
    }
  }

  /// Position of a number, which must be in the list.
  [[nodiscard]] std::size_t operator()(Index number) const {
    std::size_t slot = slot_of(number);
    while (numbers_[places_[slot] - 1] != number) slot = (slot + 1) & (places_.size() - 1);
    return places_[slot] - 1;
  }
  [[nodiscard]] std::size_t size() const noexcept { return numbers_.size(); }
  [[nodiscard]] bool empty() const noexcept { return numbers_.empty(); }

 private:
  [[nodiscard]] std::size_t slot_of(Index number) const {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>((number * kGolden) >> 32) & (places_.size() - 1);
  }

  std::vector<Index> numbers_;
  std::vector<Index> places_;  ///< position plus 1; 0: empty
};

}  // namespace tegl::detail
