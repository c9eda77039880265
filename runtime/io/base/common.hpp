// SPDX-License-Identifier: BSD-3-Clause
//
// What every reader and writer of this folder uses: errors that name the file, progress, and file basics.
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

namespace tegl::io_detail {

/// What to say of files with more axes than an image read from a file may have.
inline constexpr const char* kMoreAxes = "5 only in memory, by tegl::extract";

/// Throws Error{code, "path: message"}.
template <class... Args>
[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& path, fmt::format_string<Args...> format,
                       Args&&... args) {
  throw Error(code, path.string() + ": " + fmt::format(format, std::forward<Args>(args)...));
}

/// Calls `progress`, if there is one, and throws Cancelled where it says stop.
void tick(const Progress& progress, double fraction, const std::filesystem::path& path);

/// Throws FileNotFound unless `path` is a file that can be opened, MalformedFile if it is empty.
void require_readable_file(const std::filesystem::path& path);

/// Size of a file in bytes; FileNotFound if it cannot be asked.
std::uint64_t size_of_file(const std::filesystem::path& path);

/// Up to `count` bytes from `offset`; fewer only at the end of the file.
std::vector<unsigned char> read_bytes(const std::filesystem::path& path, std::uint64_t offset, std::size_t count);

/// The name of the last component in lower case: extensions are compared without regard to case.
std::string lower_name(const std::filesystem::path& path);
std::string lower(std::string_view text);
std::string_view trim(std::string_view text);

/// Printable form of bytes found where something else was expected, at most 16 of them.
std::string shown(std::span<const unsigned char> bytes);
std::string shown(std::string_view text);

/// Product of sizes; TooLarge where it (times `item` bytes) does not fit 63 bits.
std::uint64_t checked_bytes(std::span<const std::uint64_t> sizes, std::uint64_t item,
                            const std::filesystem::path& path);

/// "4 x 5 x 6"
template <class Range>
std::string shape_text(const Range& sizes) {
  return fmt::format("{}", fmt::join(sizes, " x "));
}

/// A number's text without its plus sign, which std::from_chars does not take; nothing if two signs follow each other.
std::string_view without_plus(std::string_view text);
/// Parses a whole text as a number, independent of the locale; false if anything is left over.
bool parse_number(std::string_view text, double& value);
bool parse_number(std::string_view text, std::uint64_t& value);
bool parse_number(std::string_view text, std::int64_t& value);

/// Words between blanks.
std::vector<std::string_view> words(std::string_view text);

}  // namespace tegl::io_detail
