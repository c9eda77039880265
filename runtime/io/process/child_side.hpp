// SPDX-License-Identifier: BSD-3-Clause
//
// The child's side of a child process: its limits and its connection to the parent.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>

#include "process/child_messages.hpp"
#include "process/package.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::io_detail {

/// Limits of a child.
struct ChildLimits {
  /// Memory in bytes before it opens a file; now_reading() and expect_memory() raise it.
  std::uint64_t memory = std::uint64_t{64} << 20;
  /// Processor time in seconds between two signs of progress; now_reading() and expect_step() raise it for large files.
  double seconds = 2;
};

/// The child's connection to its parent.
class ParentLink {
 public:
  explicit ParentLink(int socket) noexcept : socket_(socket) {}
  /// Reports progress to the parent. May be called often: most calls send nothing. Always returns true.
  [[nodiscard]] Progress progress() const;
  /// Sends a result.
  void send(const Packer& packer) const;
  /// Waits for the parent's request; nullopt if there are no more.
  [[nodiscard]] std::optional<LayerRequest> receive() const;

 private:
  int socket_;
};

/// The work of a child.
using ChildWork = std::function<void(const ParentLink& parent)>;

/// Runs the work of a freshly forked child, with all signals blocked on entry, and ends the process. Exceptions while a
/// failure is being sent abort it (SIGABRT), because the caller's code must not continue in the child.
[[noreturn]] void run_child_side(int socket, pid_t parent, const ChildLimits& limits, const ChildWork& work) noexcept;

}  // namespace tegl::io_detail
