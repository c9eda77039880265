// SPDX-License-Identifier: BSD-3-Clause
//
// The memory of a child process: large arrays in memory that the parent can map, all within a limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../src/base/block_source.hpp"

namespace tegl::io_detail {

/// A file in memory of so many bytes that nobody can make smaller; -1: there is none to be had. Mapped at `begin`.
int create_memory_file(std::size_t bytes, void*& begin) noexcept;

class ChildMemory final : public detail::BlockSource {
 public:
  /// From now on this process may take `bytes` of memory beyond what it has.
  explicit ChildMemory(std::uint64_t bytes);
  ~ChildMemory() override = default;
  /// Raises the limit.
  void allow(std::uint64_t bytes);
  [[nodiscard]] std::uint64_t allowed() const noexcept { return allowed_; }
  /// Whether it is this limit that memory ran out at, and not the machine's or one of the parent.
  [[nodiscard]] bool is_limiting() const;

  void* allocate(std::size_t bytes) noexcept override;
  /// Keeps a few blocks for the next arrays of their sizes, so that these need no fresh pages.
  bool release(void* block, std::size_t bytes) noexcept override;
  /// The file of a block; -1: it is not from here.
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

  std::uint64_t at_start_ = 0;  ///< private memory
  std::uint64_t allowed_;       ///< beyond it; as much again in blocks
  std::uint64_t in_blocks_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace tegl::io_detail
