// SPDX-License-Identifier: BSD-3-Clause
//
// Finds similar words by edit distance, and unknown options.
#include "base/suggestions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace tegl::cli {

namespace {

/// Edit distance: the number of insertions, deletions, replacements and exchanges of adjacent letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> rows(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) rows[i][0] = i;
  std::iota(rows[0].begin(), rows[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t other = a[i - 1] == b[j - 1] ? 0 : 1;
      rows[i][j] = std::min({rows[i - 1][j] + 1, rows[i][j - 1] + 1, rows[i - 1][j - 1] + other});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
    }
  return rows[a.size()][b.size()];
}

std::string_view without_dashes(std::string_view word) {
  word.remove_prefix(std::min(word.find_first_not_of('-'), word.size()));
  return word;
}

/// The names of an option with their dashes, such as "--iso" and "-o".
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

/// The option with this name, including dashes; null if there is none.
const CLI::Option* option_called(const CLI::App& command, std::string_view name) {
  for (const CLI::Option* const option : command.get_options())
    for (const std::string& own : names_of(*option))
      if (own == name) return option;
  return nullptr;
}

std::vector<std::string> names_of_commands(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* const command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

bool looks_like_option(std::string_view argument) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return argument.size() > 1 && argument[0] == '-' &&
         (is_letter(argument[1]) || (argument.size() > 2 && argument[1] == '-' && is_letter(argument[2])));
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string_view wanted = without_dashes(word);
  std::optional<std::string> nearest;
  std::size_t least = wanted.size() / 3 + 1;  // first distance that is rejected
  for (const std::string& candidate : candidates) {
    const std::string_view name = without_dashes(candidate);
    if (name.size() < 2) continue;
    constexpr std::size_t kShortest = 3;
    const bool begins =
        std::min(name.size(), wanted.size()) >= kShortest && (name.starts_with(wanted) || wanted.starts_with(name));
    const std::size_t distance = begins ? 0 : edit_distance(wanted, name);
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::optional<std::string> unknown_option(const CLI::App& command, const std::vector<std::string>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--") return std::nullopt;
    if (!looks_like_option(argument)) continue;
    const bool is_long = argument.starts_with("--");
    const std::string name = is_long ? argument.substr(0, argument.find('=')) : argument.substr(0, 2);
    const CLI::Option* const option = option_called(command, name);
    if (option == nullptr) return is_long ? name : argument;
    // The value may be joined to a short option.
    const bool is_joined = is_long ? name.size() < argument.size() : argument.size() > 2;
    if (option->get_items_expected_min() > 0 && !is_joined) ++i;
  }
  return std::nullopt;
}

std::string unknown_option_text(const CLI::App& command, const std::string& option) {
  std::vector<std::string> names;
  for (const CLI::Option* const each : command.get_options())
    for (std::string& name : names_of(*each)) names.push_back(std::move(name));
  const std::optional<std::string> nearest = nearest_word(option, names);
  return fmt::format("unknown option {}{}", option, nearest ? fmt::format(" (did you mean {}?)", *nearest) : "");
}

std::string command_list(const CLI::App& program) {
  const std::vector<std::string> names = names_of_commands(program);
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i)
    all += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
  return all;
}

std::string unknown_command_text(const CLI::App& program, std::string_view word) {
  if (const auto nearest = nearest_word(word, names_of_commands(program)))
    return fmt::format("there is no command '{}' (did you mean {}?)", word, *nearest);
  return fmt::format("there is no command '{}'; expected {}", word, command_list(program));
}

}  // namespace tegl::cli
