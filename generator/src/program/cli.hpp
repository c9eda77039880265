// SPDX-License-Identifier: BSD-3-Clause
//
// The command line of `gen`: converts text to checked Options. Prints nothing.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "program/options.hpp"

namespace tegl::gen {

/// Parses the arguments (without the program's name). `--name value` and `--name=value` are equivalent, the order does
/// not matter, and `--help` or `-h` anywhere overrides all other arguments. Errors: InvalidArgument, with actual and
/// expected text, for an unknown or repeated option, a missing or invalid value, no command without --dim or two
/// commands, and an option that the command does not accept.
[[nodiscard]] Options parse(std::span<const std::string_view> arguments);

/// The text of `--help`: usage, options, examples, exit codes.
[[nodiscard]] std::string help_text();

/// The text of `--version`.
[[nodiscard]] std::string version_text();

}  // namespace tegl::gen
