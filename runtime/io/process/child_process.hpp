// SPDX-License-Identifier: BSD-3-Clause
//
// Work in a child process, which may die of a damaged file: its end is an error, not that of the program.
//
// The child is a fork without exec, so that a library needs no program of its own beside it. It has one thread, takes
// no lock but those that the C library makes safe for that (the allocator's among them), runs neither handlers of
// signals nor those of the program's end, prints nothing, and leaves no core file. What it sends is checked as if it
// came from anyone. It ends with its parent.
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

namespace tegl::io_detail {

/// A child at work, as its parent sees it. Belongs to the process that started it.
class ChildProcess {
 public:
  using Work = ChildWork;

  /// Starts `work` in a child; what it throws is thrown by receive(). `path` is named in messages. Errors:
  /// FileNotFound if no process can be started.
  ChildProcess(std::filesystem::path path, const Work& work, const ChildLimits& limits = {});
  /// Ends the child, whatever it is doing.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Who has the blocks of a result: the caller, or the child, which uses them anew at the next request.
  enum class Blocks { given, lent };

  /// Waits for a result of the work. Calls `progress` now and then; Cancelled if it says stop. Lent blocks are in
  /// lent_block(): at most one. Errors: MalformedFile if the child dies or goes beyond a limit, and those of the work;
  /// the child has ended then.
  Package receive(const Progress& progress, Blocks blocks = Blocks::given);
  [[nodiscard]] const Mapping& lent_block() const noexcept { return shared_block_; }
  /// Throws MalformedFile: what the child has sent makes no sense. Ends it.
  [[noreturn]] void fail_contradiction();
  /// Asks for layers; the answer is received.
  void request(const LayerRequest& request);
  /// Ends the child, whose work is done.
  void end() noexcept;
  [[nodiscard]] pid_t pid() const noexcept { return pid_; }

 private:
  struct Message;
  Package wait(const Progress& progress, bool shared);
  [[nodiscard]] Message next_message();
  void take_block(int descriptor, std::vector<Mapping>& blocks, bool shared);
  [[noreturn]] void fail_damaged(const std::string& reason);
  [[noreturn]] void fail_died();
  [[noreturn]] void rethrow(const Message& message);
  void require_time(double fraction, const Progress& progress);

  std::filesystem::path path_;  ///< that is read, as far as the child has said so
  ChildLimits limits_;
  int socket_ = -1;
  pid_t pid_ = -1;
  pid_t owner_ = -1;                                      ///< the process that started it
  std::optional<int> status_;                             ///< of its end, once it is known
  double used_last_ = 0;                                  ///< its processor time when it was read last
  std::chrono::steady_clock::time_point standing_since_;  ///< when that last grew
  double used_before_ = 0;                                ///< its processor time at the last sign of progress
  double granted_ = 0;                                    ///< further seconds of it until the next one
  Mapping shared_block_;                                  ///< the last one that was lent
  std::uint64_t shared_file_ = 0;                         ///< and of which file it is
};

}  // namespace tegl::io_detail
