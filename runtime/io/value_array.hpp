// SPDX-License-Identifier: BSD-3-Clause
//
// Values of any type that a file may store.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

namespace tegl::io_detail {

/// Values as files store them; the last three are narrowed by `to_any_image`.
using ValueArray =
    std::variant<std::vector<std::uint8_t>, std::vector<std::int8_t>, std::vector<std::uint16_t>,
                 std::vector<std::int16_t>, std::vector<std::int32_t>, std::vector<float>, std::vector<double>,
                 std::vector<std::uint32_t>, std::vector<std::int64_t>, std::vector<std::uint64_t>>;

}  // namespace tegl::io_detail
