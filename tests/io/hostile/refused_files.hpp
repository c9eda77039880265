// SPDX-License-Identifier: BSD-3-Clause
//
// Reads a hostile file in a child process, which must refuse it in little time and memory.
#pragma once

#include <sys/resource.h>

#include <functional>
#include <string>
#include <vector>

#include "io_support.hpp"
#include "process/limited_child.hpp"

namespace tegl::test {

using Read = std::function<void(const fs::path&)>;

/// CPU seconds of the children of this process, which do not depend on the machine's load.
inline double seconds_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

inline constexpr double kMostSeconds = kHasSanitizer ? 10.0 : 1.0;

/// Reads a file in a child process; expects this error within the limits of time and memory.
inline void expect_file_refused(const fs::path& path, ErrorCode code, const std::vector<std::string>& parts,
                                const Read& read) {
  SCOPED_TRACE(path.string());
  const double before = seconds_of_children();
  const ChildResult result = in_limited_child([&] { read(path); });
  EXPECT_EQ(result.signal, 0);
  ASSERT_TRUE(result.code) << "no tegl::Error: '" << result.message << "'";
  EXPECT_EQ(*result.code, code) << name_of(*result.code) << ": " << result.message;
  for (const std::string& part : parts) EXPECT_THAT(result.message, testing::HasSubstr(part));
  EXPECT_THAT(result.message, testing::HasSubstr(path.filename().string()));
  EXPECT_LT(result.message.size(), 2000U);
  EXPECT_LT(seconds_of_children() - before, kMostSeconds);
  if (!kHasSanitizer) {
    EXPECT_LT(result.peak_bytes, 2 * fs::file_size(path) + (std::uint64_t{64} << 20));
  }
}

}  // namespace tegl::test
