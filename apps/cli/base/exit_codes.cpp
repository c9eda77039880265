// SPDX-License-Identifier: BSD-3-Clause
//
// Maps error codes to exit codes, and formats their table.
#include "base/exit_codes.hpp"

namespace tegl::cli {

ExitCode exit_code(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::InvalidArgument:
    case ErrorCode::InvalidIsovalue:
    case ErrorCode::VariableNotFound:
      return ExitCode::Usage;
    case ErrorCode::FileNotFound:
      return ExitCode::InputNotFound;
    case ErrorCode::InvalidGrid:
    case ErrorCode::MalformedFile:
    case ErrorCode::UnsupportedFormat:
    case ErrorCode::UnsupportedData:
    case ErrorCode::TooLarge:
      return ExitCode::BadInput;
    case ErrorCode::WriteFailed:
      return ExitCode::OutputFailed;
    case ErrorCode::Cancelled:
      return ExitCode::Cancelled;
  }
  return ExitCode::Internal;
}

std::string exit_code_help() {
  return "Exit codes:\n"
         "  0    success; for check: a manifold without conflicts (it may have a border)\n"
         "  1    the check found faults\n"
         "  2    wrong usage: an option, a value or a variable that does not exist\n"
         "  3    the input does not exist or cannot be read\n"
         "  4    the input is damaged or not supported\n"
         "  5    nothing to contour: isovalue or slice outside of the data, all samples missing, an axis of "
         "one sample\n"
         "  6    the output cannot be written, or its format cannot hold the result\n"
         "  70   internal error, or out of memory\n"
         "  130  cancelled (Ctrl-C); 129, 141, 143: ended by SIGHUP, SIGPIPE, SIGTERM\n"
         "No failure leaves a half-written file.\n";
}

}  // namespace tegl::cli
