// SPDX-License-Identifier: BSD-3-Clause
//
// Reports of readers to the process that runs them. In a child process they set the limits that end it on a damaged
// file; in any other process they do nothing.
#pragma once

#include <cstdint>
#include <filesystem>

namespace tegl::io_detail {

/// The limits of a process that reads files, which the functions below raise.
class ReadingLimits {
 public:
  ReadingLimits() = default;
  ReadingLimits(const ReadingLimits&) = delete;
  ReadingLimits& operator=(const ReadingLimits&) = delete;
  virtual ~ReadingLimits() = default;
  virtual void file(const std::filesystem::path& path) = 0;  ///< see now_reading
  virtual void memory(std::uint64_t bytes) = 0;              ///< see expect_memory
  virtual void objects(std::uint64_t count) = 0;             ///< see expect_objects
  virtual void step(std::uint64_t bytes) = 0;                ///< see expect_step
};

/// Sets the limits of this process, which must live as long as it reads; null: none, as at the start.
void set_reading_limits(ReadingLimits* limits) noexcept;

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
