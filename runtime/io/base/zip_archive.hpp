// SPDX-License-Identifier: BSD-3-Clause
//
// The directory of a zip archive: where its members are in the file. Members are stored or deflated.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tegl/error.hpp"

namespace tegl::io_detail {

/// A file in a zip archive.
struct ZipMember {
  std::string name;
  bool is_deflated = false;            ///< a raw deflate stream; otherwise the bytes themselves
  std::uint64_t offset = 0;            ///< of its data in the archive
  std::uint64_t compressed_bytes = 0;  ///< size of its data in the archive
  std::uint64_t bytes = 0;             ///< size after decompression
  std::uint32_t crc = 0;               ///< CRC-32 of the decompressed bytes
};

/// The members of an archive, in the order of its directory, with sizes that fit into the file. Reads Zip64. Memory:
/// the directory. Errors: FileNotFound; MalformedFile if a directory is missing, damaged, or names data outside of the
/// file; UnsupportedFormat for encrypted members, other compressions than deflate, and archives in several parts.
std::vector<ZipMember> list_zip(const std::filesystem::path& path);

}  // namespace tegl::io_detail
