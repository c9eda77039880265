// SPDX-License-Identifier: BSD-3-Clause
//
// Names of the types of samples.
#include "tegl/value_type.hpp"

#include <algorithm>
#include <array>

namespace tegl {

namespace {

/// In the order of the enumeration.
constexpr std::array<std::string_view, 10> kTypeNames = {"uint8", "int8",   "uint16", "int16", "int32",
                                                         "float", "double", "uint32", "int64", "uint64"};

}  // namespace

std::string_view name_of(ValueType type) noexcept { return kTypeNames[static_cast<std::size_t>(type)]; }

std::optional<ValueType> parse_value_type(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(kTypeNames, name);
  if (found == kTypeNames.end()) return std::nullopt;
  return static_cast<ValueType>(found - kTypeNames.begin());
}

}  // namespace tegl
