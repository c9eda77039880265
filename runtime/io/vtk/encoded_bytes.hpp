// SPDX-License-Identifier: BSD-3-Clause
//
// The bytes of a part of a file, stored as they are or in base64.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

namespace tegl::io_detail {

/// Reads a part of a file in order.
class EncodedBytes {
 public:
  /// The bytes [begin, end) of the file. Errors: FileNotFound.
  EncodedBytes(const std::filesystem::path& path, std::uint64_t begin, std::uint64_t end, bool base64);

  /// Fills `to`; returns the number of bytes, fewer only at the end. Base64: blanks between characters are allowed, and
  /// padding may be followed by further groups, which VTK writes after the header of compressed data. The end is the
  /// first '<'. Errors: MalformedFile for another character that is not base64.
  std::size_t read(std::span<unsigned char> to);

  /// The greatest number of bytes that may follow.
  [[nodiscard]] std::uint64_t at_most() const;

 private:
  int next_character();
  /// Decodes a group of four characters; false at the end.
  bool next_group();

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t left_;  ///< bytes of the file that are not in the block
  bool base64_;
  std::vector<unsigned char> block_;
  std::size_t at_ = 0;                    ///< in the block
  std::array<unsigned char, 3> group_{};  ///< decoded
  int group_size_ = 0;
  int group_at_ = 0;
};

}  // namespace tegl::io_detail
