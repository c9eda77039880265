// SPDX-License-Identifier: BSD-3-Clause
//
// Reports of readers to the process that runs them. In a child process they set the limits that end it on a damaged
// file; in any other process they do nothing.
#pragma once

#include <cstdint>
#include <filesystem>

namespace tegl::io_detail {

/// Starts the file `path`: messages name it, and memory for its headers and tables is allowed.
void now_reading(const std::filesystem::path& path);

/// Allows `bytes` more memory for values, whose size was checked against the file.
void expect_memory(std::uint64_t bytes);

/// Allows memory and time for the tables of `count` more variables, groups and types to be opened.
void expect_objects(std::uint64_t count);

/// Allows the time to read `bytes` bytes of values in one step.
void expect_step(std::uint64_t bytes);

/// Memory per value of a file until it is part of an image: as stored, converted, and with reordered axes, at most 8
/// bytes each.
inline constexpr std::uint64_t kBytesPerValue = 24;

}  // namespace tegl::io_detail
