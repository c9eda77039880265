// SPDX-License-Identifier: BSD-3-Clause
//
// Requests for memory of a result that will be written soon. The pages of a new result have just been cleared by the
// system, which leaves them in a far cache: stores would wait for each line.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tegl::detail {

/// Distance in bytes from the next store. At 2 KiB, lines are replaced before they are written.
inline constexpr std::size_t kRequestedAhead = 1024;

/// Requests the lines that stores reach after kRequestedAhead bytes; `bytes` are stored at `to` now. The lines may be
/// beyond the result's end, where nothing is read.
[[gnu::always_inline]] inline void request_ahead(const void* to, std::size_t bytes = 1) noexcept {
  constexpr std::size_t kLine = 64;
  const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(to) + kRequestedAhead;
  for (std::size_t i = 0; i < bytes; i += kLine) __builtin_prefetch(reinterpret_cast<const void*>(first + i), 1);
}

}  // namespace tegl::detail
