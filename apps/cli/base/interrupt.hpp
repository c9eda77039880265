// SPDX-License-Identifier: BSD-3-Clause
//
// Handling of signals that end the program: SIGINT (Ctrl-C), SIGTERM, SIGHUP and SIGPIPE. No pending output is left.
#pragma once

#include <string>

namespace tegl::cli {

/// While an instance exists, the first such signal requests the end of the work, which stops at its next progress call
/// and removes its outputs. If the work does not end within a quarter of a second, or a second signal arrives, the
/// pending outputs are removed and the process ends by the signal at once. A SIGPIPE from the program's own write is
/// only an error of that write (BrokenPipe). An ignored SIGHUP stays ignored, as set by `nohup`. At most one instance
/// at a time.
class InterruptHandler {
 public:
  /// `farewell`: text written to standard error if the process is ended at once.
  explicit InterruptHandler(std::string farewell = {});
  ~InterruptHandler();
  InterruptHandler(const InterruptHandler&) = delete;
  InterruptHandler& operator=(const InterruptHandler&) = delete;

  /// Whether a signal has arrived since construction. Safe from any thread.
  [[nodiscard]] static bool requested() noexcept { return signal() != 0; }
  /// The first signal; 0 if none has arrived.
  [[nodiscard]] static int signal() noexcept;
  /// Throws Cancelled if a signal has arrived.
  static void throw_if_requested();

  /// While an instance exists, the process is not ended at once: for steps that must be completed, such as renaming
  /// several files. Keep them short.
  class Undivided {
   public:
    Undivided() noexcept;
    ~Undivided();
    Undivided(const Undivided&) = delete;
    Undivided& operator=(const Undivided&) = delete;
  };
};

/// Ends the process by the signal itself, so that its parent sees the reason: a shell's exit status is 128 + signal,
/// and a loop in a script ends on Ctrl-C.
[[noreturn]] void end_by_signal(int signal) noexcept;

/// Opens /dev/null for closed standard streams; otherwise the first output file would get the number of one of them.
/// Writing to standard output still fails.
void occupy_closed_streams() noexcept;

}  // namespace tegl::cli
