// SPDX-License-Identifier: BSD-3-Clause
//
// The command line of `gen`: text in, checked Options out. Prints nothing itself.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "program/options.hpp"

namespace tegl::gen {

/// Reads the arguments (without the program's name). `--name value` and `--name=value` are the same; the order does not
/// matter; `--help` or `-h` anywhere makes the rest irrelevant.
/// Errors: InvalidArgument, naming what was given and what is expected, for an unknown or repeated option, a missing or
/// invalid value, no command or two, and an option that the command does not take.
[[nodiscard]] Options parse(std::span<const std::string_view> arguments);

/// What `--help` shows: usage, options, examples, exit codes.
[[nodiscard]] std::string help_text();

/// What `--version` shows.
[[nodiscard]] std::string version_text();

}  // namespace tegl::gen
