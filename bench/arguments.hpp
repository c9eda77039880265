// SPDX-License-Identifier: BSD-3-Clause
//
// Parsing of numbers in the arguments of benchmark programs.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "tegl/error.hpp"

namespace tegl::bench {

/// Parses all of `text` as a whole number from `least` to `most`. Otherwise throws InvalidArgument with the argument's
/// name, the text and the range.
template <class Number>
Number whole_number(std::string_view argument, std::string_view text, Number least, Number most) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < least || number > most)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{}: '{}'; expected a whole number from {} to {}", argument, text, least, most));
  return number;
}

/// Parses all of `text` as a number from `least` to `most`. Otherwise throws InvalidArgument with the argument's name,
/// the text and the range.
inline double real_number(std::string_view argument, std::string_view text, double least, double most) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !(number >= least && number <= most))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{}: '{}'; expected a number from {} to {}", argument, text, least, most));
  return number;
}

}  // namespace tegl::bench
