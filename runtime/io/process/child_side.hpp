// SPDX-License-Identifier: BSD-3-Clause
//
// The child's side of a child process: its limits, its connection to the parent, and what it does beside its work.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>

#include "process/child_messages.hpp"
#include "process/package.hpp"
#include "tegl/error.hpp"

namespace tegl::io_detail {

/// Limits of a child.
struct ChildLimits {
  /// Memory that it may take before it has opened a file; more by now_reading() and expect_memory().
  std::uint64_t memory = std::uint64_t{64} << 20;
  /// Of its processor time between two signs of progress; more for large files by now_reading(), expect_step().
  double seconds = 2;
};

/// The child's connection to its parent.
class ParentLink {
 public:
  explicit ParentLink(int socket) noexcept : socket_(socket) {}
  /// Reports to the parent, which may be often: few of the calls cost anything. Never says stop.
  [[nodiscard]] Progress progress() const;
  /// Sends a result.
  void send(const Packer& packer) const;
  /// Waits for the parent; none: it needs nothing more.
  [[nodiscard]] std::optional<LayerRequest> receive() const;

 private:
  int socket_;
};

/// What a child does for its parent.
using ChildWork = std::function<void(const ParentLink& parent)>;

/// Does the work of a child that has just been forked with all signals blocked, and ends the process. What is thrown
/// while a failure is sent ends it, too (SIGABRT), as the caller's code must not go on in the child.
[[noreturn]] void run_child_side(int socket, pid_t parent, const ChildLimits& limits, const ChildWork& work) noexcept;

}  // namespace tegl::io_detail
