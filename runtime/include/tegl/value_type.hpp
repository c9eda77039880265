// SPDX-License-Identifier: BSD-3-Clause
//
// The types of samples as values, and their names.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "tegl/image.hpp"

namespace tegl {

/// The types of samples in files. Images in memory have one of the first seven, the types of the concept Value.
enum class ValueType : std::uint8_t { uint8, int8, uint16, int16, int32, float32, float64, uint32, int64, uint64 };

/// "uint8", "int8", "uint16", "int16", "int32", "float", "double", "uint32", "int64" or "uint64".
[[nodiscard]] std::string_view name_of(ValueType type) noexcept;

/// The type of this name, as name_of spells it; none for another text.
[[nodiscard]] std::optional<ValueType> parse_value_type(std::string_view name) noexcept;

/// The ValueType of the samples of an Image<T, N>.
template <Value T>
inline constexpr ValueType kValueType = std::is_same_v<T, std::uint8_t>    ? ValueType::uint8
                                        : std::is_same_v<T, std::int8_t>   ? ValueType::int8
                                        : std::is_same_v<T, std::uint16_t> ? ValueType::uint16
                                        : std::is_same_v<T, std::int16_t>  ? ValueType::int16
                                        : std::is_same_v<T, std::int32_t>  ? ValueType::int32
                                        : std::is_same_v<T, float>         ? ValueType::float32
                                                                           : ValueType::float64;

}  // namespace tegl
