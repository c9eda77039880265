// SPDX-License-Identifier: BSD-3-Clause
//
// Compressed streams (gzip and zlib), read in blocks. Readers use it to know, before they allocate or hand a file
// to a library, how many bytes really come out and that the checksum holds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "tegl/error.hpp"

namespace tegl::io_detail {

/// Takes a block of decompressed bytes; returns false to stop.
using InflateSink = std::function<bool(std::span<const unsigned char>)>;

/// Decompresses the gzip (any number of members) or zlib stream that starts at `offset`.
/// Errors: MalformedFile if the stream is damaged, fails its checksum or ends early. Bytes after it are ignored.
void inflate_file(const std::filesystem::path& path, std::uint64_t offset, const InflateSink& sink);

/// Number of bytes that come out of the stream, all of it checked.
std::uint64_t inflated_size(const std::filesystem::path& path, std::uint64_t offset, const Progress& progress);

/// The decompressed stream in memory. TooLarge when memory runs out.
std::vector<unsigned char> inflate_to_memory(const std::filesystem::path& path, const Progress& progress);

/// True if the file starts with the gzip magic.
bool is_gzip(const std::filesystem::path& path);

/// The first `count` bytes of a file, seen through gzip if it is compressed.
std::vector<unsigned char> read_prefix(const std::filesystem::path& path, std::size_t count);

}  // namespace tegl::io_detail
