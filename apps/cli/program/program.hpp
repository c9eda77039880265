// SPDX-License-Identifier: BSD-3-Clause
//
// The command line of `tegl`, and the manual page and shell completion generated from it. Both use the option
// definitions, as --help does, so they always agree with it.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "input/commands.hpp"

namespace tegl::cli {

/// Adds all commands, and the program's description.
std::vector<std::unique_ptr<Command>> add_commands(CLI::App& program, const std::string& version);

/// The manual page tegl(1), as troff with man(7) macros. `date`: of the manual, such as 2026-01-31.
std::string man_page(const CLI::App& program, const std::string& version, const std::string& date);

/// The script that completes commands, options and their values. `shell`: bash, zsh or fish; throws InvalidArgument for
/// others.
std::string completion_script(const CLI::App& program, std::string_view shell);

}  // namespace tegl::cli
