// SPDX-License-Identifier: BSD-3-Clause
//
// The whole command line of `tegl`, and what is generated from it: the manual page and the completion of shells. Both
// are made of the options themselves, as --help is, so that they never differ from it.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "input/commands.hpp"

namespace tegl::cli {

/// Adds all commands, and what the program says of itself.
std::vector<std::unique_ptr<Command>> add_commands(CLI::App& program, const std::string& version);

/// tegl(1) as troff with the macros of man(7). `date`: of the manual, as 2026-01-31.
std::string man_page(const CLI::App& program, const std::string& version, const std::string& date);

/// The script that completes commands, options and their values. `shell`: bash, zsh or fish. Throws InvalidArgument for
/// others.
std::string completion_script(const CLI::App& program, std::string_view shell);

}  // namespace tegl::cli
