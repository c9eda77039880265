// SPDX-License-Identifier: BSD-3-Clause
//
// Reads contiguous samples of a file, stored as bytes, compressed bytes or text: all of them or ranges.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/value_array.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::io_detail {

/// The encoding of samples.
enum class Encoding {
  raw,      ///< bytes
  deflate,  ///< bytes, as a gzip, zlib or (with a CRC-32) raw deflate stream
  text,     ///< decimal numbers between blanks or commas
  hex,      ///< two hexadecimal digits per byte
};

/// Location and encoding of an image's samples.
struct StoredSamples {
  std::filesystem::path path;
  Encoding encoding = Encoding::raw;
  std::uint64_t offset = 0;               ///< of the first sample, or of the compressed stream, in the file
  std::uint64_t skip = 0;                 ///< decompressed bytes before the first sample; deflate only
  std::uint64_t compressed_bytes = 0;     ///< of the stream; 0: to the end of the file
  std::string_view type;                  ///< "uint8", ... as type_name returns it
  std::vector<std::uint64_t> sizes;       ///< of the axes, fastest first
  bool swapped = false;                   ///< not in this machine's byte order
  std::optional<std::uint32_t> crc = {};  ///< raw deflate: CRC-32 of all decompressed bytes
};

/// Size of a sample of a type in bytes.
std::uint64_t bytes_of_type(std::string_view type);

/// Reads samples. Sizes are checked against the file size before memory is allocated, and memory grows with the samples
/// that are present. Keeps the file open.
class SampleReader {
 public:
  /// Errors: FileNotFound; MalformedFile if the file is too short for the samples; TooLarge.
  explicit SampleReader(StoredSamples samples);
  ~SampleReader();
  SampleReader(SampleReader&&) noexcept;
  SampleReader& operator=(SampleReader&&) noexcept;

  /// Changes values that were just read, [first, first + count) of all that are read, while they are in the cache.
  using OnBlock = std::function<void(ValueArray& values, std::size_t first, std::size_t count)>;

  /// Reads the samples [first, first + count). Encodings other than raw need one pass over the file if samples are read
  /// in ascending order; other orders start a new pass. After the last sample the end is checked: the checksum of a
  /// compressed stream, or that no further number follows in text. Errors: MalformedFile for missing samples, damaged
  /// compressed data, and words that are not numbers in the type's range; Cancelled; std::bad_alloc if memory runs out.
  /// `on_block` is called for each block of raw samples, and once for all others.
  ValueArray read(std::uint64_t first, std::uint64_t count, const Progress& progress, const OnBlock& on_block = {});

  /// Location and encoding, as given to the constructor.
  [[nodiscard]] const StoredSamples& samples() const noexcept;

 private:
  class Source;
  std::unique_ptr<Source> source_;
};

}  // namespace tegl::io_detail
