// SPDX-License-Identifier: BSD-3-Clause
//
// The vertex attribute "simplification_error": its unit, and the error of an earlier simplification.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

inline constexpr const char* kErrorName = "simplification_error";
inline constexpr std::string_view kScaleUnit = "scale ";

/// Maximum growth of distances since the errors in the attribute were computed, from the scale in its unit.
template <int N>
double growth_of_distances(const Attribute& attribute, const std::array<double, N>& scale) {
  const bool scaled = attribute.unit.starts_with(kScaleUnit);
  std::istringstream numbers(scaled ? attribute.unit.substr(kScaleUnit.size()) : "");
  numbers.imbue(std::locale::classic());
  double factor = 0.0;
  for (int a = 0; a < N; ++a) {
    double earlier = 1.0;
    const bool read =
        !scaled || ((a == 0 || numbers.get() == ',') && numbers >> earlier && (a + 1 < N || numbers.eof()));
    if (!read || !(earlier > 0.0))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("the attribute {} has the unit '{}'; expected {} positive numbers after '{}'",
                              attribute.name, attribute.unit, N, kScaleUnit));
    factor = std::max(factor, scale[a] / earlier);
  }
  return factor;
}

/// The largest error of earlier simplifications of the contour, in units of `scale`. 0 without the attribute.
template <int N, class Real>
double earlier_error(const Contour<N, Real>& contour, const std::array<double, N>& scale) {
  double result = 0.0;
  for (const Attribute& attribute : contour.vertex_attributes) {
    if (attribute.name != kErrorName) continue;
    const double factor = growth_of_distances<N>(attribute, scale);
    for (const double error : attribute.values) {
      if (!(error >= 0.0 && std::isfinite(error)))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("the attribute {} has the value {}; expected finite numbers, 0 or more", attribute.name,
                                error));
      result = std::max(result, factor * error);
    }
  }
  return result;
}

/// Unit of errors: the common unit of the axes, or the scale.
template <int N, class Real>
std::string error_unit(const Contour<N, Real>& contour, const std::array<double, N>& scale) {
  const auto& units = contour.axis_units;
  const auto is_one = [](double factor) { return factor == 1.0; };
  if (!std::all_of(scale.begin(), scale.end(), is_one)) return fmt::format("{}{}", kScaleUnit, fmt::join(scale, ","));
  const bool same = std::all_of(units.begin(), units.end(), [&](const std::string& unit) { return unit == units[0]; });
  return same ? units[0] : std::string();
}

}  // namespace tegl::detail
