// SPDX-License-Identifier: BSD-3-Clause
//
// Implements conversion between numbers and text.
#include "base/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "tegl/error.hpp"

namespace tegl::cli {

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range)
    return std::strtod(std::string(text).c_str(), nullptr);  // infinite, or 0
  if (error != std::errc()) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t at = text.find(separator); at != std::string_view::npos; at = text.find(separator)) {
    parts.push_back(text.substr(0, at));
    text.remove_prefix(at + 1);
  }
  parts.push_back(text);
  return parts;
}

double parse_finite(std::string_view option, std::string_view text, std::string_view expected) {
  const std::optional<double> value = parse_number(text);
  if (!value) {
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} is '{}'; expected {}", option, text, expected));
  }
  if (!std::isfinite(*value)) {
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} is '{}'; expected a finite number", option, text));
  }
  return *value;
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  return {[least, most](std::string& text) {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto [at, error] = std::from_chars(text.data(), end, value);
            if (error == std::errc{} && at == end && value >= least && value <= most) return std::string();
            return fmt::format("'{}'; expected a whole number from {} to {}", text, least, most);
          },
          ""};
}

std::string number(double value) {
  std::string exact = fmt::format("{}", value);
  constexpr std::size_t kShort = 10;
  return exact.size() <= kShort ? exact : fmt::format("{:.6g}", value);
}

std::vector<std::string> numbers_apart(const std::vector<double>& values) {
  constexpr int kShort = 6;
  constexpr int kExact = std::numeric_limits<double>::max_digits10;
  double least = std::numeric_limits<double>::infinity();
  for (const double a : values)
    for (const double b : values)
      if (a != b) least = std::min(least, std::abs(a - b));
  const auto tell_apart = [&](const std::vector<std::string>& texts) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::abs(parse_number(texts[i]).value_or(values[i]) - values[i]) > 0.1 * least) return false;
    return true;
  };
  std::vector<std::string> texts(values.size());
  std::transform(values.begin(), values.end(), texts.begin(), number);
  for (int digits = kShort + 1; digits <= kExact && !tell_apart(texts); ++digits)
    std::transform(values.begin(), values.end(), texts.begin(), [&](double value) {
      return std::min(fmt::format("{}", value), fmt::format("{:.{}g}", value, digits),
                      [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
    });
  return texts;
}

std::string grouped(std::uint64_t count) {
  std::string text = fmt::format("{}", count);
  for (std::ptrdiff_t at = std::ssize(text) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), 1, ' ');
  return text;
}

std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural) {
  return fmt::format("{} {}", grouped(count), count == 1 ? singular : plural);
}

std::string byte_size(std::uint64_t bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  constexpr std::array<const char*, 4> kUnits = {"kB", "MB", "GB", "TB"};
  double size = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  // 999.95 would be printed as "1000.0".
  while (size >= 999.95 && unit + 1 < kUnits.size()) {
    size /= 1000;
    ++unit;
  }
  return fmt::format("{:.1f} {}", size, kUnits[unit]);
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace tegl::cli
