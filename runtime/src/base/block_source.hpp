// SPDX-License-Identifier: BSD-3-Clause
//
// Where large arrays of samples and of meshes lie, if not in memory of this process alone: tegl::io reads damaged
// files in a child process and gets the arrays in memory that both processes map.
#pragma once

#include <cstddef>

namespace tegl::detail {

/// Memory for large blocks, instead of the system's.
class BlockSource {
 public:
  BlockSource() = default;
  BlockSource(const BlockSource&) = delete;
  BlockSource& operator=(const BlockSource&) = delete;
  virtual ~BlockSource() = default;
  /// So many bytes that begin at a page, mapped by mmap; null: none, the caller takes other memory.
  virtual void* allocate(std::size_t bytes) noexcept = 0;
  /// A block of these bytes is no longer used. Returns false if it is not from here; it is then unmapped.
  virtual bool release(void* block, std::size_t bytes) noexcept = 0;
};

/// Makes `source` the one for this thread (null: none) and returns the one before.
BlockSource* exchange_block_source(BlockSource* source) noexcept;

/// Samples in a block of a source begin here; before them stands how the block is freed.
inline constexpr std::size_t kValuesOffset = 64;
/// From here on, samples get a block of a source.
inline constexpr std::size_t kLargeValues = std::size_t{1} << 21;
/// How many bytes a source is asked for, for `bytes` of samples, and for a Buffer of `bytes`.
std::size_t block_of_values(std::size_t bytes) noexcept;
std::size_t block_of_buffer(std::size_t bytes) noexcept;

}  // namespace tegl::detail
