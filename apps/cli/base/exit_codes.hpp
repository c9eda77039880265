// SPDX-License-Identifier: BSD-3-Clause
//
// The program's exit codes. docs/command-line.md and the end of `tegl --help` document them; scripts rely on the
// numbers, so they never change their meaning.
#pragma once

#include <string>

#include "tegl/error.hpp"

namespace tegl::cli {

enum class ExitCode : int {
  Ok = 0,
  Faults = 1,         ///< the check found faults in a mesh that was read or made
  Usage = 2,          ///< an unknown or invalid option, value or variable name
  InputNotFound = 3,  ///< the input is missing, a directory, or not readable
  BadInput = 4,       ///< the input is damaged or of an unsupported kind
  Nothing = 5,        ///< nothing to contour: isovalue or cut outside of the data, no data, no tiles
  OutputFailed = 6,   ///< the output has an unknown extension, cannot hold the result, or cannot be written
  Internal = 70,      ///< a bug, or out of memory
  Cancelled = 130,    ///< Ctrl-C (SIGINT); other signals end the process with 128 + signal, as in shells
};

/// The exit code for an error of the library.
ExitCode exit_code(ErrorCode code) noexcept;

/// The table of exit codes for `tegl --help`, one per line.
std::string exit_code_help();

}  // namespace tegl::cli
