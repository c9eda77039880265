// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays of values of any type that a file may store.
#pragma once

#include <cstdint>
#include <span>
#include <variant>

#include "tegl/values.hpp"

namespace tegl::io_detail {

/// A vector that leaves new values uninitialised.
using detail::ValueVector;

/// Values as stored in files; `to_any_image` narrows the last three types.
using ValueArray =
    std::variant<ValueVector<std::uint8_t>, ValueVector<std::int8_t>, ValueVector<std::uint16_t>,
                 ValueVector<std::int16_t>, ValueVector<std::int32_t>, ValueVector<float>, ValueVector<double>,
                 ValueVector<std::uint32_t>, ValueVector<std::int64_t>, ValueVector<std::uint64_t>>;

/// Views of values of the same types.
using ValueView =
    std::variant<std::span<const std::uint8_t>, std::span<const std::int8_t>, std::span<const std::uint16_t>,
                 std::span<const std::int16_t>, std::span<const std::int32_t>, std::span<const float>,
                 std::span<const double>, std::span<const std::uint32_t>, std::span<const std::int64_t>,
                 std::span<const std::uint64_t>>;

}  // namespace tegl::io_detail
