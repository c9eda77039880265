// SPDX-License-Identifier: BSD-3-Clause
//
// The memory of a child process: large arrays in memory that the parent can map, within a limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../src/base/block_source.hpp"

namespace tegl::io_detail {

/// Creates a memory file of `bytes` bytes, sealed against resizing, and maps it at `begin`. Returns its descriptor, or
/// -1.
int create_memory_file(std::size_t bytes, void*& begin) noexcept;

class ChildMemory final : public detail::BlockSource {
 public:
  /// Limits this process to `bytes` of memory beyond its present memory.
  explicit ChildMemory(std::uint64_t bytes);
  ~ChildMemory() override = default;
  /// Raises the limit.
  void allow(std::uint64_t bytes);
  [[nodiscard]] std::uint64_t allowed() const noexcept { return allowed_; }
  /// Whether memory ran out at this limit, and not at the machine's or at an inherited one.
  [[nodiscard]] bool is_limiting() const;

  void* allocate(std::size_t bytes) noexcept override;
  /// Keeps a few blocks for later arrays of the same size, which then need no fresh pages.
  bool release(void* block, std::size_t bytes) noexcept override;
  /// The memory file of a block; -1 if it is not from this object.
  [[nodiscard]] int descriptor(const void* block) const noexcept;

 private:
  struct Block {
    void* begin;
    std::size_t bytes;
    int descriptor;
    bool used;
  };
  void free_unused(std::size_t most) noexcept;
  void set_limit();

  std::uint64_t at_start_ = 0;  ///< private memory at construction
  std::uint64_t allowed_;       ///< beyond at_start_; blocks may take as much again
  std::uint64_t in_blocks_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace tegl::io_detail
