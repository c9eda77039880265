// SPDX-License-Identifier: BSD-3-Clause
//
// What the program's exit status means. Documented for users in docs/command-line.md and at the
// end of `tegl --help`; scripts rely on the numbers, so they never change their meaning.
#pragma once

#include <string>

#include "tegl/error.hpp"

namespace tegl::cli {

enum class ExitCode : int {
  Ok = 0,
  Faults = 1,         ///< the mesh was read, or made, and the check found faults in it
  Usage = 2,          ///< an option, a value or a variable name that does not exist or does not fit
  InputNotFound = 3,  ///< the input is missing, a directory, or not readable
  BadInput = 4,       ///< the input is damaged, or of a kind that is not supported
  Nothing = 5,        ///< nothing to contour: isovalue or cut outside of the data, no data, no tiles
  OutputFailed = 6,   ///< the output has an unknown extension, or cannot hold the result, or be written
  Internal = 70,      ///< a bug, or memory ran out
  Cancelled = 130,    ///< Ctrl-C (SIGINT); by other signals the process ends with 128 + signal, as shells have it
};

/// The exit status for an error of the library.
ExitCode exit_code(ErrorCode code) noexcept;

/// The table of exit codes as text, one per line, for `tegl --help`.
std::string exit_code_help();

}  // namespace tegl::cli
