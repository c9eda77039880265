// SPDX-License-Identifier: BSD-3-Clause
//
// What readers report while they read. In a child process this sets the limits that end it on a damaged file; in any
// other process nothing happens.
#pragma once

#include <cstdint>
#include <filesystem>

namespace tegl::io_detail {

/// This file is read from now on: messages name it, and memory for its headers and tables may be used.
void now_reading(const std::filesystem::path& path);

/// So much more memory is needed for values that the file is large enough for.
void expect_memory(std::uint64_t bytes);

/// So many variables, groups and types of a file will be opened, each with memory and time for its tables.
void expect_objects(std::uint64_t count);

/// So many bytes of values are read in one step, which may take the time for that.
void expect_step(std::uint64_t bytes);

/// Bytes that values of a file take until they are those of an image: as they are stored, converted, and in another
/// order of the axes, each of up to 8 bytes.
inline constexpr std::uint64_t kBytesPerValue = 24;

}  // namespace tegl::io_detail
