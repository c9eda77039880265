// SPDX-License-Identifier: BSD-3-Clause
//
// Values that lie in a file one after the other, compressed or not.
#include "raw_values.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <span>

#include "common.hpp"
#include "inflate.hpp"
#include "raw_image.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

template <class T>
void swap_bytes(ValueVector<T>& values) {
  auto* bytes = reinterpret_cast<unsigned char*>(values.data());
  for (std::size_t i = 0; i < values.size(); ++i) std::reverse(bytes + i * sizeof(T), bytes + (i + 1) * sizeof(T));
}

/// Keeps the part of a stream from `offset` on that fits into `to`; returns the length of the whole stream.
std::uint64_t fill(const fs::path& path, std::uint64_t offset, std::span<unsigned char> to, const Progress& progress) {
  std::uint64_t at = 0;
  const double end = static_cast<double>(offset + to.size());
  const auto take = [&](std::span<const unsigned char> block) {
    const std::uint64_t skipped = std::min<std::uint64_t>(block.size(), offset - std::min(offset, at));
    const std::uint64_t place = at + skipped - std::min(at + skipped, offset);
    if (place < to.size()) {
      const auto count = static_cast<std::size_t>(std::min(block.size() - skipped, to.size() - place));
      std::copy_n(block.begin() + static_cast<std::ptrdiff_t>(skipped), count,
                  to.begin() + static_cast<std::ptrdiff_t>(place));
    }
    at += block.size();
    tick(progress, std::min(0.99, static_cast<double>(at) / end), path);
    return true;
  };
  if (is_gzip(path)) {
    inflate_file(path, 0, take);
    return at;
  }
  constexpr std::size_t kBlock = std::size_t{1} << 22;
  const std::uint64_t size = size_of_file(path);
  while (at < std::min<std::uint64_t>(size, offset + to.size())) take(read_bytes(path, at, kBlock));
  return size;
}

}  // namespace

ValueArray read_raw_values(const fs::path& path, std::uint64_t offset, std::string_view type, std::uint64_t count,
                           bool swapped, const Progress& progress) {
  ValueArray result = array_of_type(type);
  std::visit(
      [&]<class T>(ValueVector<T>& values) {
        const std::uint64_t bytes = checked_bytes(std::array{count}, sizeof(T), path);
        // What deflate can make of a byte, at best: a header that promises more is damaged.
        constexpr std::uint64_t kBestRatio = 1032;
        const std::uint64_t most = size_of_file(path) * (is_gzip(path) ? kBestRatio : 1);
        if (offset + bytes > most)
          fail(ErrorCode::MalformedFile, path, "at most {} bytes; expected {} for {} values of type {}", most,
               offset + bytes, count, type);
        try {
          values.resize(static_cast<std::size_t>(count));
        } catch (const std::bad_alloc&) {
          fail(ErrorCode::TooLarge, path, "{} values of type {} do not fit into memory", count, type);
        }
        const std::uint64_t found = fill(
            path, offset, {reinterpret_cast<unsigned char*>(values.data()), static_cast<std::size_t>(bytes)}, progress);
        if (found < offset + bytes)
          fail(ErrorCode::MalformedFile, path, "{} bytes; expected {} for {} values of type {}", found, offset + bytes,
               count, type);
        if (swapped) swap_bytes(values);
      },
      result);
  return result;
}

ValueArray read_values_at(const fs::path& path, std::uint64_t offset, std::string_view type, std::uint64_t count,
                          bool swapped) {
  ValueArray result = array_of_type(type);
  std::visit(
      [&]<class T>(ValueVector<T>& values) {
        values.resize(static_cast<std::size_t>(count));
        std::ifstream file(path, std::ios::binary);
        file.seekg(static_cast<std::streamoff>(offset));
        file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
        if (!file)
          fail(ErrorCode::MalformedFile, path, "{} bytes from byte {} on cannot be read; expected {} values of type {}",
               count * sizeof(T), offset, count, type);
        if (swapped) swap_bytes(values);
      },
      result);
  return result;
}

}  // namespace tegl::io_detail
