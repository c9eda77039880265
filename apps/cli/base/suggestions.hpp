// SPDX-License-Identifier: BSD-3-Clause
//
// Suggestions for unknown words of the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tegl::cli {

/// The candidate nearest to a word: one is a prefix of the other, or their edit distance is at most a third of the
/// word's length. nullopt if there is none.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// The first argument that looks like an option and is unknown to the command; nullopt if there is none. Values of
/// options are skipped.
std::optional<std::string> unknown_option(const CLI::App& command, const std::vector<std::string>& arguments);

/// "unknown option --isovalue (did you mean --iso?)".
std::string unknown_option_text(const CLI::App& command, const std::string& option);

/// All commands: "info, contour or slice".
std::string command_list(const CLI::App& program);

/// "there is no command 'contuor' (did you mean contour?)"; without a similar command, a list of all.
std::string unknown_command_text(const CLI::App& program, std::string_view word);

}  // namespace tegl::cli
