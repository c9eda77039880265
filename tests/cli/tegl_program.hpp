// SPDX-License-Identifier: BSD-3-Clause
//
// Runs the built program `tegl` as a user's shell does, and looks at what it leaves.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tegl::test {

/// What a run of a program gave.
struct RunResult {
  int exit = -1;  ///< exit status; 128 + signal if a signal ended it
  std::string out;
  std::string err;

  /// Standard output as JSON; fails the test if it is none.
  [[nodiscard]] nlohmann::json json() const;
};

/// Runs `tegl` with these arguments, without a terminal. `prepare` is called in its process before.
RunResult run_tegl(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});

/// Whether the machine gives pseudo-terminals, which run_tegl_on_terminal needs.
bool has_terminals();

/// A run on a pseudo terminal (TERM=xterm; 80 x 24, or COLUMNS x LINES), with `environment` added ("NAME=value").
/// If `interrupt_at` is not empty, sends the signal as soon as that text appeared. All that was shown is in `out`.
RunResult run_tegl_on_terminal(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                               const std::string& interrupt_at = "", int signal = SIGINT);

/// A test with an empty folder of its own, removed afterwards.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// A path in the folder.
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// The names of the files in the folder, sorted.
  [[nodiscard]] std::vector<std::string> files() const;
  /// Writes bytes to a file in the folder and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace tegl::test
