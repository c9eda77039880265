// SPDX-License-Identifier: BSD-3-Clause
//
// Compressed streams (gzip and zlib), inflated as far as their reader needs and no further.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "tegl/error.hpp"

namespace tegl::io_detail {

/// Deflate makes at most so many bytes of one.
inline constexpr std::uint64_t kMostInflation = 1032;
/// What other compressions are taken to make of one byte at most.
inline constexpr std::uint64_t kMostExpansion = 4096;

/// The decompressed bytes of the gzip (any number of members) or zlib stream that starts at byte `offset` of a file, in
/// order. Bytes after the stream are ignored. Keeps the file open.
class InflateStream {
 public:
  /// `length`: bytes of the compressed stream; 0: up to the end of the file. Errors: FileNotFound.
  InflateStream(const std::filesystem::path& path, std::uint64_t offset, std::uint64_t length = 0);
  ~InflateStream();
  InflateStream(InflateStream&&) noexcept;
  InflateStream& operator=(InflateStream&&) noexcept;

  /// Fills `to`; returns how many bytes there were, which is fewer only at the end of the stream. Errors: MalformedFile
  /// if the stream is damaged, fails its checksum or ends early.
  std::size_t read(std::span<unsigned char> to);

  /// Leaves out bytes; returns how many there were, as read() does.
  std::uint64_t skip(std::uint64_t count);

  /// For a reader that needs no more bytes: inflates up to 1 MiB more, so that the checksum of a stream that ends there
  /// is compared, and a stream of any length beyond costs nothing. Errors: those of read().
  void check_end();

  /// Bytes that read() and skip() gave.
  [[nodiscard]] std::uint64_t position() const noexcept;

 private:
  class Inflater;
  std::unique_ptr<Inflater> inflater_;
};

/// Takes the first bytes of a stream and returns how many of its bytes a reader needs, at most what memory addresses; 0
/// if more bytes are needed to know that.
using BytesNeeded = std::function<std::uint64_t(std::span<const unsigned char>)>;

/// The decompressed bytes of a gzip file, as many as `needed` says, or fewer if the stream ends before. So many bytes
/// more fit into the result without a copy. TooLarge when memory runs out.
inline constexpr std::size_t kInflateSpare = 8192;
std::vector<unsigned char> inflate_to_memory(const std::filesystem::path& path, const BytesNeeded& needed,
                                             const Progress& progress);

/// True if the file starts with the gzip magic.
bool is_gzip(const std::filesystem::path& path);

/// The first `count` bytes of a file, decompressed if it is a gzip file.
std::vector<unsigned char> read_prefix(const std::filesystem::path& path, std::size_t count);

}  // namespace tegl::io_detail
