// SPDX-License-Identifier: BSD-3-Clause
//
// Interface for memory of large arrays that other processes can map. tegl::io reads damaged files in a child process
// and receives the arrays in shared memory.
#pragma once

#include <cstddef>

namespace tegl::detail {

/// Source of memory for large blocks, used instead of the system's.
class BlockSource {
 public:
  BlockSource() = default;
  BlockSource(const BlockSource&) = delete;
  BlockSource& operator=(const BlockSource&) = delete;
  virtual ~BlockSource() = default;
  /// Returns `bytes` bytes of page-aligned memory mapped by mmap, or null; the caller then uses other memory.
  virtual void* allocate(std::size_t bytes) noexcept = 0;
  /// Called when a block is no longer used. Returns false if the block is not from this source; it is then unmapped.
  virtual bool release(void* block, std::size_t bytes) noexcept = 0;
};

/// Sets the source of this thread (null: none) and returns the previous one.
BlockSource* exchange_block_source(BlockSource* source) noexcept;

/// Offset of the samples in a block of a source. The bytes before them describe how to free the block.
inline constexpr std::size_t kValuesOffset = 64;
/// Minimum bytes of samples for which a source is used.
inline constexpr std::size_t kLargeValues = std::size_t{1} << 21;
/// Bytes requested from a source for `bytes` bytes of samples, and for a Buffer of `bytes` bytes.
std::size_t block_of_values(std::size_t bytes) noexcept;
std::size_t block_of_buffer(std::size_t bytes) noexcept;

}  // namespace tegl::detail
