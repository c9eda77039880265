// SPDX-License-Identifier: BSD-3-Clause
//
// Options with lists of words, separated by commas. CLI11's delimiters drop empty words, and an option with none takes
// the next argument; here, an empty word is an error.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace tegl::cli {

/// Adds an option whose argument is a list of words, as in "x,y"; if it is given again, the lists are joined. `check`:
/// of each word. Sets `words`, which must outlive the app, when the command line is parsed.
CLI::Option* add_word_list(CLI::App& app, const std::string& name, std::vector<std::string>& words,
                           const std::string& description, const CLI::Validator& check = {});

}  // namespace tegl::cli
