// SPDX-License-Identifier: BSD-3-Clause
//
// Shared functions of all readers and writers: errors that name the file, progress, and basic file access.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::io_detail {

/// Part of messages about files with more axes than read_image supports.
inline constexpr const char* kMoreAxes = "5 for contours, slices, tracks, measures, components and elements";

/// Throws Error{code, "path: message"}.
template <class... Args>
[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& path, fmt::format_string<Args...> format,
                       Args&&... args) {
  throw Error(code, path.string() + ": " + fmt::format(format, std::forward<Args>(args)...));
}

/// Calls `progress`, if there is one, and throws Cancelled if it returns false.
void tick(const Progress& progress, double fraction, const std::filesystem::path& path);

/// Throws FileNotFound unless `path` is a file that can be opened, MalformedFile if it is empty.
void require_readable_file(const std::filesystem::path& path);

/// Size of a file in bytes. Errors: FileNotFound.
std::uint64_t size_of_file(const std::filesystem::path& path);

/// Up to `count` bytes from `offset`; fewer only at the end of the file.
std::vector<unsigned char> read_bytes(const std::filesystem::path& path, std::uint64_t offset, std::size_t count);

/// The last component of a path in lower case; extensions are compared without case.
std::string lower_name(const std::filesystem::path& path);
std::string lower(std::string_view text);
std::string_view trim(std::string_view text);

/// Printable form of unexpected bytes for messages, at most 16 of them.
std::string shown(std::span<const unsigned char> bytes);
std::string shown(std::string_view text);

/// The product of sizes and `item` in bytes; TooLarge if it exceeds 2^62.
std::uint64_t checked_bytes(std::span<const std::uint64_t> sizes, std::uint64_t item,
                            const std::filesystem::path& path);

/// "4 x 5 x 6"
template <class Range>
std::string shape_text(const Range& sizes) {
  return fmt::format("{}", fmt::join(sizes, " x "));
}

/// A number without its plus sign, which std::from_chars does not accept; empty if another sign follows.
std::string_view without_plus(std::string_view text);
/// Parses a whole text as a number, independent of the locale; false if characters remain.
bool parse_number(std::string_view text, double& value);
bool parse_number(std::string_view text, std::uint64_t& value);
bool parse_number(std::string_view text, std::int64_t& value);

/// Splits a text at blanks.
std::vector<std::string_view> words(std::string_view text);

}  // namespace tegl::io_detail
