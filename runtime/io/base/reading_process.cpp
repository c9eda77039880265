// SPDX-License-Identifier: BSD-3-Clause
//
// Passes the reports of readers to the limits of their process.
#include "base/reading_process.hpp"

namespace tegl::io_detail {

namespace {

ReadingLimits* reading_limits = nullptr;  ///< set once, in a child process of one thread

}  // namespace

void set_reading_limits(ReadingLimits* limits) noexcept { reading_limits = limits; }

void now_reading(const std::filesystem::path& path) {
  if (reading_limits != nullptr) reading_limits->file(path);
}

void expect_memory(std::uint64_t bytes) {
  if (reading_limits != nullptr) reading_limits->memory(bytes);
}

void expect_objects(std::uint64_t count) {
  if (reading_limits != nullptr) reading_limits->objects(count);
}

void expect_step(std::uint64_t bytes) {
  if (reading_limits != nullptr) reading_limits->step(bytes);
}

}  // namespace tegl::io_detail
