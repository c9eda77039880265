// SPDX-License-Identifier: BSD-3-Clause
//
// Options with lists of words.
#include "base/word_list.hpp"

#include <fmt/format.h>

#include <string_view>

#include "base/numbers.hpp"

namespace tegl::cli {

CLI::Option* add_word_list(CLI::App& app, const std::string& name, std::vector<std::string>& words,
                           const std::string& description, const CLI::Validator& check) {
  const auto set = [&words](const std::vector<std::string>& texts) {
    words.clear();
    for (const std::string& text : texts)
      for (const std::string_view word : split(text, ',')) words.emplace_back(word);
  };
  const auto refuse = [check](const std::string& text) {
    for (const std::string_view word : split(text, ',')) {
      if (word.empty()) return fmt::format("'{}'; expected words separated by commas, none of them empty", text);
      std::string one(word);
      if (std::string error = check(one); !error.empty()) return error;
    }
    return std::string();
  };
  return app.add_option_function<std::vector<std::string>>(name, set, description)
      ->check(CLI::Validator([refuse](std::string& text) { return refuse(text); }, check.get_description()))
      ->allow_extra_args(false);
}

}  // namespace tegl::cli
