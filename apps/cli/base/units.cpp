// SPDX-License-Identifier: BSD-3-Clause
//
// Derives units of measures from the units of the axes.
#include "base/units.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tegl::cli {

namespace {

std::string power(const std::string& unit, std::size_t exponent) {
  if (exponent == 1) return unit;
  // A unit of several words or signs is still one factor.
  const bool compound = unit.find_first_of(" */^") != std::string::npos;
  return compound ? fmt::format("({})^{}", unit, exponent) : fmt::format("{}^{}", unit, exponent);
}

}  // namespace

std::optional<std::string> measure_unit(const std::vector<std::string>& axis_units, int dimension) {
  if (std::adjacent_find(axis_units.begin(), axis_units.end(), std::not_equal_to<>()) != axis_units.end())
    return std::nullopt;
  if (axis_units.empty() || axis_units.front().empty()) return "";
  return power(axis_units.front(), static_cast<std::size_t>(dimension));
}

std::optional<std::string> content_unit(const std::vector<std::string>& axis_units) {
  const auto without = std::count(axis_units.begin(), axis_units.end(), std::string());
  if (without == static_cast<std::ptrdiff_t>(axis_units.size())) return "";
  if (without > 0) return std::nullopt;
  std::string product;
  for (std::size_t a = 0; a < axis_units.size(); ++a) {
    const std::string& unit = axis_units[a];
    const auto begin = axis_units.begin();
    if (std::find(begin, begin + static_cast<std::ptrdiff_t>(a), unit) != begin + static_cast<std::ptrdiff_t>(a))
      continue;  // this unit is already a factor
    const auto times = static_cast<std::size_t>(std::count(axis_units.begin(), axis_units.end(), unit));
    product += (product.empty() ? "" : " ") + power(unit, times);
  }
  return product;
}

std::string with_unit(const std::string& value, const std::optional<std::string>& unit) {
  return !unit || unit->empty() ? value : fmt::format("{} {}", value, *unit);
}

std::string heading_with_unit(const std::string& name, const std::optional<std::string>& unit) {
  return !unit || unit->empty() ? name : fmt::format("{} ({})", name, *unit);
}

std::string measure_name(int dimension, int space_dim) {
  switch (dimension) {
    case 1:
      return "length";
    case 2:
      return "area";
    case 3:
      return space_dim == 3 ? "volume" : "3-volume";
    default:
      return fmt::format("{}-volume", dimension);
  }
}

}  // namespace tegl::cli
