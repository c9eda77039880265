// SPDX-License-Identifier: BSD-3-Clause
//
// Compressed streams (gzip, zlib, and deflate as in zip archives), decompressed only as far as their reader needs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::io_detail {

/// Maximum expansion ratio of deflate.
inline constexpr std::uint64_t kMostInflation = 1032;
/// Assumed maximum expansion ratio of other compressions.
inline constexpr std::uint64_t kMostExpansion = 4096;

/// Decompresses the gzip (any number of members), zlib or raw deflate stream that starts at byte `offset` of a file.
/// Ignores bytes after the stream. Keeps the file open.
class InflateStream {
 public:
  /// `length`: size of the compressed stream; 0: up to the end of the file. `crc`: the stream is raw deflate, and this
  /// is the CRC-32 of its decompressed bytes. Errors: FileNotFound.
  InflateStream(const std::filesystem::path& path, std::uint64_t offset, std::uint64_t length = 0,
                std::optional<std::uint32_t> crc = std::nullopt);
  ~InflateStream();
  InflateStream(InflateStream&&) noexcept;
  InflateStream& operator=(InflateStream&&) noexcept;

  /// Fills `to` and returns the number of bytes, fewer only at the end of the stream. Errors: MalformedFile if the
  /// stream is damaged, fails its checksum or ends early.
  std::size_t read(std::span<unsigned char> to);

  /// Skips bytes; returns their number, as read() does.
  std::uint64_t skip(std::uint64_t count);

  /// Verifies the checksum if the stream ends within the next 1 MiB, which it decompresses. The limit bounds the time
  /// for longer streams. Errors: those of read().
  void check_end();

  /// Number of bytes read or skipped so far.
  [[nodiscard]] std::uint64_t position() const noexcept;

 private:
  class Inflater;
  std::unique_ptr<Inflater> inflater_;
};

/// Takes the first bytes of a stream and returns the number of bytes that a reader needs, at most the address space; 0
/// if it must see more bytes first.
using BytesNeeded = std::function<std::uint64_t(std::span<const unsigned char>)>;

/// Decompresses a gzip file up to the number of bytes that `needed` returns, or to its end. The result has capacity for
/// kInflateSpare more bytes, to append without a copy. TooLarge if memory runs out.
inline constexpr std::size_t kInflateSpare = 8192;
std::vector<unsigned char> inflate_to_memory(const std::filesystem::path& path, const BytesNeeded& needed,
                                             const Progress& progress);

/// True if the file starts with the gzip magic.
bool is_gzip(const std::filesystem::path& path);

/// The first `count` bytes of a file, decompressed if it is a gzip file.
std::vector<unsigned char> read_prefix(const std::filesystem::path& path, std::size_t count);

}  // namespace tegl::io_detail
