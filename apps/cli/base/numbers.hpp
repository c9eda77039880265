// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers to text and back, independent of the locale.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tegl::cli {

/// The number that `text` spells, all of it: "7.3", "-4e2", "+1", "nan", "inf"; nothing else.
std::optional<double> parse_number(std::string_view text);

/// The parts of a text between separators.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The value of the option `option`, a finite number. Throws InvalidArgument that quotes `text`.
double parse_finite(std::string_view option, std::string_view text);

/// What an option that counts takes: digits alone, at least `least`. (A minus sign would be read as a huge number.)
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most = 1000000000);

/// A number for people: exact where that is short, else six significant digits.
std::string number(double value);

/// Numbers that stand beside each other in a message, each as `number` says it, or with as many significant digits more
/// as all need to be off by less than a tenth of how far they are apart.
std::vector<std::string> numbers_apart(const std::vector<double>& values);

/// A count in groups of three digits: "1 234 567".
std::string grouped(std::uint64_t count);

/// A count with its noun: "1 triangle", "1 234 triangles".
std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural);

/// A length in bytes for people: "812 B", "3.4 MB" (powers of ten).
std::string byte_size(std::uint64_t bytes);

/// True when both are equal but for the case of their ASCII letters.
bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace tegl::cli
