// SPDX-License-Identifier: BSD-3-Clause
//
// The minimum of numbers that several threads find.
#pragma once

#include <atomic>
#include <cstddef>

namespace tegl::detail {

/// Sets the shared number to `candidate` if that is smaller.
inline void lower_to(std::atomic<std::size_t>& shared, std::size_t candidate) noexcept {
  for (std::size_t known = shared; candidate < known && !shared.compare_exchange_weak(known, candidate);) continue;
}

}  // namespace tegl::detail
