// SPDX-License-Identifier: BSD-3-Clause
//
// Values that lie in a file one after the other, compressed or not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "tegl/error.hpp"
#include "value_array.hpp"

namespace tegl::io_detail {

/// `count` values of a type ("uint8", ... as type_name gives it) from byte `offset` on, of the decompressed content
/// where the file is gzipped; `swapped`: in the other byte order. One pass, which checks the compressed stream to
/// its end. Errors: MalformedFile if the file holds less; TooLarge when memory runs out.
ValueArray read_raw_values(const std::filesystem::path& path, std::uint64_t offset, std::string_view type,
                           std::uint64_t count, bool swapped, const Progress& progress);

/// The same of a file that is not compressed, without progress.
ValueArray read_values_at(const std::filesystem::path& path, std::uint64_t offset, std::string_view type,
                          std::uint64_t count, bool swapped);

}  // namespace tegl::io_detail
