// SPDX-License-Identifier: BSD-3-Clause
//
// Signals that end the program: SIGINT (Ctrl-C), SIGTERM, SIGHUP and SIGPIPE. None leaves a pending output behind.
#pragma once

#include <string>

namespace tegl::cli {

/// While one of these lives, the first such signal requests the end of the work, which then ends at its next progress
/// call and removes its outputs. Work that does not end within a quarter of a second, or gets a second signal, is ended
/// at once: the pending outputs are removed, and the process ends by the signal. A SIGPIPE of the program's own writing
/// is an error of that write instead (BrokenPipe). A SIGHUP that is ignored stays ignored, as `nohup` has it. One
/// handler at a time.
class InterruptHandler {
 public:
  /// `farewell`: written to standard error if the process is ended at once.
  explicit InterruptHandler(std::string farewell = {});
  ~InterruptHandler();
  InterruptHandler(const InterruptHandler&) = delete;
  InterruptHandler& operator=(const InterruptHandler&) = delete;

  /// Whether a signal has arrived since the handler was made. Safe from any thread.
  [[nodiscard]] static bool requested() noexcept { return signal() != 0; }
  /// The first of them; 0 if none has.
  [[nodiscard]] static int signal() noexcept;
  /// Throws Cancelled if one has.
  static void throw_if_requested();

  /// While one of these lives, the process is not ended at once: for steps that are to be done as a whole, such as
  /// renaming several files. Keep them short.
  class Undivided {
   public:
    Undivided() noexcept;
    ~Undivided();
    Undivided(const Undivided&) = delete;
    Undivided& operator=(const Undivided&) = delete;
  };
};

/// Ends the process by the signal itself, so that whoever started it sees why: a shell's exit status is 128 + signal,
/// and a loop in a script ends by Ctrl-C.
[[noreturn]] void end_by_signal(int signal) noexcept;

/// Opens /dev/null for those of the three standard streams that are closed, else the first output file would be one of
/// them. Writing to standard output fails as before.
void occupy_closed_streams() noexcept;

}  // namespace tegl::cli
