// SPDX-License-Identifier: BSD-3-Clause
//
// What was probably meant by a word of the command line that does not exist.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tegl::cli {

/// The candidate nearest to a word: one that begins with it or that it begins with, or within an edit distance of a
/// third of its length. None if there is none such.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// The first of the arguments that looks like an option and is none of the command's; none if there is none. Values of
/// options are passed over.
std::optional<std::string> unknown_option(const CLI::App& command, const std::vector<std::string>& arguments);

/// "unknown option --isovalue (did you mean --iso?)".
std::string unknown_option_text(const CLI::App& command, const std::string& option);

/// "there is no command 'contuor' (did you mean contour?)"; without a similar one, with all commands.
std::string unknown_command_text(const CLI::App& program, std::string_view word);

}  // namespace tegl::cli
