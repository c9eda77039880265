// SPDX-License-Identifier: BSD-3-Clause
//
// Sorts a few numbers without a branch.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace tegl::detail {

template <class T, std::size_t Count>
void sort_few(std::array<T, Count>& numbers) noexcept {
  for (std::size_t end = Count; end > 1; --end)
    for (std::size_t i = 1; i < end; ++i) {
      const T low = std::min(numbers[i - 1], numbers[i]);
      numbers[i] = std::max(numbers[i - 1], numbers[i]);
      numbers[i - 1] = low;
    }
}

}  // namespace tegl::detail
