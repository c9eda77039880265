// SPDX-License-Identifier: BSD-3-Clause
//
// Runs work in a child process, so that a crash on a damaged file is an error and does not end the program.
//
// The child is a fork without exec, so a library needs no program of its own. It has one thread. It takes only locks
// that the C library makes safe after a fork (the allocator's among them), runs no signal or exit handlers of the
// program, prints nothing, and leaves no core file. Its messages are validated like untrusted input. It ends with its
// parent.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "process/child_messages.hpp"
#include "process/child_side.hpp"
#include "process/package.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::io_detail {

/// A running child, seen by its parent. Belongs to the process that started it.
class ChildProcess {
 public:
  using Work = ChildWork;

  /// Starts `work` in a child; receive() throws its exceptions. Messages name `path`. Errors: FileNotFound if no
  /// process can be started.
  ChildProcess(std::filesystem::path path, const Work& work, const ChildLimits& limits = {});
  /// Ends the child in any state.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Owner of a result's blocks: the caller, or the child, which reuses them at the next request.
  enum class Blocks { given, lent };

  /// Waits for a result. Calls `progress` from time to time; Cancelled if it returns false. A lent block is in
  /// lent_block(): at most one. Errors: MalformedFile if the child dies or exceeds a limit, and those of the work; the
  /// child has then ended.
  Package receive(const Progress& progress, Blocks blocks = Blocks::given);
  [[nodiscard]] const Mapping& lent_block() const noexcept { return shared_block_; }
  /// Ends the child and throws MalformedFile: its messages are inconsistent.
  [[noreturn]] void fail_contradiction();
  /// Requests layers; call receive() for the result.
  void request(const LayerRequest& request);
  /// Ends the child after its work.
  void end() noexcept;
  [[nodiscard]] pid_t pid() const noexcept { return pid_; }

 private:
  struct Message;
  struct Waiting;
  void note_progress() noexcept;
  void take_message(Message& message, Waiting& waiting, const Progress& progress);
  Package wait(const Progress& progress, bool shared);
  [[nodiscard]] Message next_message();
  void take_block(int descriptor, std::vector<Mapping>& blocks, bool shared);
  [[noreturn]] void fail_damaged(const std::string& reason);
  [[noreturn]] void fail_died();
  [[noreturn]] void rethrow(const Message& message);
  void require_time(double fraction, const Progress& progress);

  std::filesystem::path path_;  ///< the file being read, as reported by the child
  ChildLimits limits_;
  int socket_ = -1;
  pid_t pid_ = -1;
  pid_t owner_ = -1;                                      ///< the process that started it
  std::optional<int> status_;                             ///< exit status, once known
  double used_last_ = 0;                                  ///< the child's processor time at the last check
  std::chrono::steady_clock::time_point standing_since_;  ///< time when used_last_ last increased
  double used_before_ = 0;                                ///< processor time at the last sign of progress
  double granted_ = 0;             ///< additional seconds allowed until the next sign of progress
  Mapping shared_block_;           ///< the last lent block
  std::uint64_t shared_file_ = 0;  ///< inode of its memory file
};

}  // namespace tegl::io_detail
