// SPDX-License-Identifier: BSD-3-Clause
//
// Samples that lie in a file one after the other: as bytes, compressed or not, or as text. Whole, or some at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "base/value_array.hpp"
#include "tegl/error.hpp"

namespace tegl::io_detail {

/// How samples are written down.
enum class Encoding {
  raw,      ///< bytes
  deflate,  ///< bytes, as a gzip or zlib stream
  text,     ///< decimal numbers between blanks or commas
  hex,      ///< bytes, as two hexadecimal digits each
};

/// Where and how the samples of an image are stored.
struct StoredSamples {
  std::filesystem::path path;
  Encoding encoding = Encoding::raw;
  std::uint64_t offset = 0;            ///< in the file, of the first sample or of the compressed stream
  std::uint64_t skip = 0;              ///< decompressed bytes before the first sample; deflate only
  std::uint64_t compressed_bytes = 0;  ///< of the stream; 0: to the end of the file
  std::string_view type;               ///< "uint8", ... as type_name gives it
  std::vector<std::uint64_t> sizes;    ///< of the axes, the one that runs fastest first
  bool swapped = false;                ///< in the other byte order than this machine's
};

/// Bytes of a sample of a type.
std::uint64_t bytes_of_type(std::string_view type);

/// Reads samples. All that the file's size can contradict is checked before memory is taken, and memory grows with the
/// samples that are really there. Keeps the file open.
class SampleReader {
 public:
  /// Errors: FileNotFound; MalformedFile if the file is too short for the samples; TooLarge.
  explicit SampleReader(StoredSamples samples);
  ~SampleReader();
  SampleReader(SampleReader&&) noexcept;
  SampleReader& operator=(SampleReader&&) noexcept;

  /// The samples with numbers [first, first + count). Of encodings other than raw, samples in ascending order cost one
  /// pass over the file; others start a new one. Once the last sample is read, the end is checked: of a compressed
  /// stream the checksum, of text that no further number follows. Errors: MalformedFile for fewer samples, damaged
  /// compressed data, and words that are no number of the type's range; Cancelled. Memory that runs out is
  /// std::bad_alloc.
  ValueArray read(std::uint64_t first, std::uint64_t count, const Progress& progress);

  /// What a sample's file, place and encoding are.
  [[nodiscard]] const StoredSamples& samples() const noexcept;

 private:
  class Source;
  std::unique_ptr<Source> source_;
};

}  // namespace tegl::io_detail
