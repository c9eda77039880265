// SPDX-License-Identifier: BSD-3-Clause
//
// Messages about command lines that CLI11 refuses.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tegl::cli {

/// The message of an error of CLI11 in the form of the program's own: the option, its value, and what was expected.
/// `command`: the command that was named, or the program.
std::string parse_error_text(const CLI::App& command, const CLI::ParseError& error);

}  // namespace tegl::cli
