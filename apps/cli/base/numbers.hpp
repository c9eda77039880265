// SPDX-License-Identifier: BSD-3-Clause
//
// Conversion between numbers and text, independent of the locale.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tegl::cli {

/// Parses the whole text as a number: "7.3", "-4e2", "+1", "nan", "inf"; nullopt for other texts.
std::optional<double> parse_number(std::string_view text);

/// Splits a text at separators.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The finite number in the value of option `option`. Throws InvalidArgument with `text`, and with what is expected if
/// it is no number.
double parse_finite(std::string_view option, std::string_view text, std::string_view expected = "a number");

/// Validates counts: digits only, `least` to `most`. (CLI11 would read a minus sign as a huge number.)
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most = 1000000000);

/// A number for display: exact if that is short, else six significant digits.
std::string number(double value);

/// Formats numbers that are shown together: as `number` does, or with enough more significant digits that all errors
/// are less than a tenth of their minimum difference.
std::vector<std::string> numbers_apart(const std::vector<double>& values);

/// A count with digits in groups of three: "1 234 567".
std::string grouped(std::uint64_t count);

/// A count with its noun: "1 triangle", "1 234 triangles".
std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural);

/// A size in bytes for display: "812 B", "3.4 MB" (powers of ten).
std::string byte_size(std::uint64_t bytes);

/// Whether both are equal, ignoring the case of ASCII letters.
bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace tegl::cli
