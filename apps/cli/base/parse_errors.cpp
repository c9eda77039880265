// SPDX-License-Identifier: BSD-3-Clause
//
// Rewrites the messages of CLI11, which have the option's name at the beginning.
#include "base/parse_errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/suggestions.hpp"

namespace tegl::cli {

namespace {

/// The parts of a text before and after a separator; nullopt if it is not there.
std::optional<std::pair<std::string, std::string>> parts_of(const std::string& text, std::string_view separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) return std::nullopt;
  return std::pair(text.substr(0, at), text.substr(at + separator.size()));
}

/// "a, b, c" for CLI11's set "{a,b,c}".
std::string list_of(std::string_view set) {
  std::string list;
  for (const char c : set)
    if (c != '{' && c != '}') list += c == ',' ? std::string(", ") : std::string(1, c);
  return list;
}

/// What an option or argument takes: "--output FILE", "one of float, double", "the image".
std::string usage_of(const CLI::App& command, const std::string& name) {
  const CLI::Option* const option = command.get_option_no_throw(name);
  if (option == nullptr) return name;
  if (option->get_positional()) {  // the begin of its description
    const std::string text = option->get_description();
    return text.substr(0, std::min(text.find_first_of(":;,"), text.find(" (")));
  }
  const std::string type = option->get_type_name();
  if (const auto set = parts_of(type, ":{")) return "one of " + list_of(set->second);
  return fmt::format("{} {}", name, type);
}

/// A value that a validator refused: one of CLI11's sets, or a validator of the program, whose message begins with the
/// value in quotes.
std::string of_validation(const std::string& what) {
  const auto named = parts_of(what, ": ");
  if (!named) return what;
  const auto& [option, message] = *named;
  if (const auto not_in = parts_of(message, " not in {"))
    return fmt::format("{} is '{}'; expected one of {}", option, not_in->first, list_of(not_in->second));
  return message.starts_with('\'') ? fmt::format("{} is {}", option, message) : what;
}

/// A value of another type than the option's, or of a flag.
std::string of_conversion(const CLI::App& command, const std::string& what) {
  constexpr std::string_view kStart = "Could not convert: ";
  if (!what.starts_with(kStart)) return what.substr(0, what.find(':')) + " has a value; expected none";
  const auto named = parts_of(what.substr(kStart.size()), " = ");
  if (!named) return what;
  const CLI::Option* const option = command.get_option_no_throw(named->first);
  const bool is_flag = option != nullptr && option->get_items_expected_max() == 0;
  return fmt::format("{} is '{}'; expected {}", named->first, named->second, is_flag ? "no value" : "a number");
}

std::string of_count(const CLI::App& command, const std::string& what) {
  const std::string option = what.substr(0, what.find(':'));
  if (what.find("At Most 1 required") != std::string::npos)
    return option + " is given more than once; expected it once";
  if (what.ends_with("missing")) return fmt::format("{} has no value; expected {}", option, usage_of(command, option));
  if (const auto flag = parts_of(what, " was given a disallowed flag override"))
    return flag->first + " has a value; expected none";
  return what;
}

std::string of_missing(const CLI::App& command, const std::string& what) {
  const auto named = parts_of(what, " is required");
  if (!named) return what;
  if (named->first == "A subcommand") return fmt::format("no command; expected {}", command_list(command));
  return fmt::format("{} is missing; expected {}", named->first, usage_of(command, named->first));
}

/// Arguments after the expected ones, as given: CLI11's message has them in reverse order. The program gets those after
/// a `--`.
std::string of_surplus(const CLI::App& command) {
  std::vector<std::string> surplus = command.remaining();
  if (command.get_parent() != nullptr) {
    const std::vector<std::string> rest = command.get_parent()->remaining();
    surplus.insert(surplus.end(), rest.begin(), rest.end());
  }
  std::erase(surplus, "--");
  return fmt::format("unexpected argument{} '{}'; expected none", surplus.size() == 1 ? "" : "s",
                     fmt::join(surplus, "', '"));
}

}  // namespace

std::string parse_error_text(const CLI::App& command, const CLI::ParseError& error) {
  const std::string what = error.what(), kind = error.get_name();
  if (kind == "ValidationError") return of_validation(what);
  if (kind == "ConversionError") return of_conversion(command, what);
  if (kind == "ArgumentMismatch") return of_count(command, what);
  if (kind == "RequiredError") return of_missing(command, what);
  if (kind == "ExcludesError")
    if (const auto pair = parts_of(what, " excludes "))
      return fmt::format("{} with {}; expected one of the two", pair->first, pair->second);
  if (kind == "RequiresError")
    if (const auto pair = parts_of(what, " requires "))
      return fmt::format("{} without {}; expected both", pair->first, pair->second);
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) return of_surplus(command);
  return what;
}

}  // namespace tegl::cli
