// SPDX-License-Identifier: BSD-3-Clause
//
// Pages of large blocks that are freed, for blocks that are allocated afterwards. The system clears the pages of fresh
// memory when they are first used, which takes longer than to move pages.
#pragma once

#include <cstddef>

namespace tegl::detail {

/// While one exists, large blocks (allocate_large_block) of all threads get the pages of freed ones, also where they
/// are never used. The last one to be destroyed frees the pages that are left. Without effect on systems other than
/// Linux.
class KeptPages {
 public:
  /// `most`: bytes that are kept; more are freed. Of several objects, the largest number holds.
  explicit KeptPages(std::size_t most);
  ~KeptPages();
  KeptPages(const KeptPages&) = delete;
  KeptPages& operator=(const KeptPages&) = delete;
};

}  // namespace tegl::detail
