// SPDX-License-Identifier: BSD-3-Clause
//
// Implements errors, progress and basic file access of the readers and writers.
#include "base/common.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include <fmt/ranges.h>

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File open_for_reading(const fs::path& path) {
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(ErrorCode::FileNotFound, path, "cannot be opened ({})", std::strerror(errno));
  return file;
}

template <class Number>
bool parse_with_from_chars(std::string_view text, Number& value) {
  text = without_plus(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

}  // namespace

void tick(const Progress& progress, double fraction, const fs::path& path) {
  if (progress && !progress(std::clamp(fraction, 0.0, 1.0))) fail(ErrorCode::Cancelled, path, "cancelled");
}

void require_readable_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail(ErrorCode::FileNotFound, path, "no such file");
  if (error) fail(ErrorCode::FileNotFound, path, "cannot be opened ({})", error.message());
  if (status.type() == fs::file_type::directory) fail(ErrorCode::FileNotFound, path, "is a directory; expected a file");
  if (status.type() != fs::file_type::regular)
    fail(ErrorCode::FileNotFound, path, "is not a regular file; expected a file that can be read more than once");
  open_for_reading(path);
  if (size_of_file(path) == 0) fail(ErrorCode::MalformedFile, path, "is empty (0 bytes)");
}

std::uint64_t size_of_file(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail(ErrorCode::FileNotFound, path, "cannot be opened ({})", error.message());
  return size;
}

std::vector<unsigned char> read_bytes(const fs::path& path, std::uint64_t offset, std::size_t count) {
  const std::uint64_t size = size_of_file(path);
  const std::uint64_t left = offset < size ? size - offset : 0;
  std::vector<unsigned char> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(count, left)));
  const File file = open_for_reading(path);
  if (fseeko(file.get(), static_cast<off_t>(offset), SEEK_SET) != 0 ||
      std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
    fail(ErrorCode::FileNotFound, path, "cannot be read ({})", std::strerror(errno));
  return bytes;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string lower_name(const fs::path& path) { return lower(path.filename().string()); }

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string shown(std::span<const unsigned char> bytes) {
  std::string result = "'";
  for (const unsigned char byte : bytes.first(std::min<std::size_t>(bytes.size(), 16)))
    result += byte >= 0x20 && byte < 0x7f ? std::string(1, static_cast<char>(byte)) : fmt::format("\\x{:02x}", byte);
  return result + (bytes.size() > 16 ? "...'" : "'");
}

std::string shown(std::string_view text) {
  return shown(std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

std::uint64_t checked_bytes(std::span<const std::uint64_t> sizes, std::uint64_t item, const fs::path& path) {
  std::uint64_t product = item;
  for (const std::uint64_t size : sizes)
    if (__builtin_mul_overflow(product, size, &product) || product > (std::uint64_t{1} << 62))
      fail(ErrorCode::TooLarge, path, "{} samples of {} bytes exceed any memory", shape_text(sizes), item);
  return product;
}

std::string_view without_plus(std::string_view text) {
  if (!text.starts_with('+')) return text;
  text.remove_prefix(1);
  return text.starts_with('+') || text.starts_with('-') ? std::string_view() : text;
}

bool parse_number(std::string_view text, double& value) {
  // from_chars also accepts NaN and infinities in any case, as they occur in headers.
  return parse_with_from_chars(text, value);
}
bool parse_number(std::string_view text, std::uint64_t& value) { return parse_with_from_chars(text, value); }
bool parse_number(std::string_view text, std::int64_t& value) { return parse_with_from_chars(text, value); }

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> result;
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = text.find_first_of(kBlanks, at);
    result.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlanks, end);
  }
  return result;
}

}  // namespace tegl::io_detail
