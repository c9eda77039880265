// SPDX-License-Identifier: BSD-3-Clause
//
// Values of any type that a file may store.
#pragma once

#include <cstdint>
#include <span>
#include <variant>

#include "tegl/values.hpp"

namespace tegl::io_detail {

/// Leaves new values unset when it grows.
using detail::ValueVector;

/// Values as files store them; the last three are narrowed by `to_any_image`.
using ValueArray =
    std::variant<ValueVector<std::uint8_t>, ValueVector<std::int8_t>, ValueVector<std::uint16_t>,
                 ValueVector<std::int16_t>, ValueVector<std::int32_t>, ValueVector<float>, ValueVector<double>,
                 ValueVector<std::uint32_t>, ValueVector<std::int64_t>, ValueVector<std::uint64_t>>;

/// Values of the same types that lie elsewhere.
using ValueView =
    std::variant<std::span<const std::uint8_t>, std::span<const std::int8_t>, std::span<const std::uint16_t>,
                 std::span<const std::int16_t>, std::span<const std::int32_t>, std::span<const float>,
                 std::span<const double>, std::span<const std::uint32_t>, std::span<const std::int64_t>,
                 std::span<const std::uint64_t>>;

}  // namespace tegl::io_detail
