// SPDX-License-Identifier: BSD-3-Clause
//
// Runs the built program `tegl` as a shell does, and checks its output and files.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tegl::test {

/// Result of a run.
struct RunResult {
  int exit = -1;  ///< exit status; 128 + signal if a signal ended it
  std::string out;
  std::string err;

  /// Parses standard output as JSON; fails the test if it is not JSON.
  [[nodiscard]] nlohmann::json json() const;
};

/// Runs `tegl` with these arguments, without a terminal, after calling `prepare` in its process.
RunResult run_tegl(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});

/// True if the machine has pseudo-terminals, which run_tegl_on_terminal needs.
bool has_terminals();

/// Runs on a pseudo-terminal (TERM=xterm; 80 x 24, or COLUMNS x LINES), with `environment` added ("NAME=value"). If
/// `interrupt_at` is not empty, sends the signal when that text has appeared. `out` has all terminal output.
RunResult run_tegl_on_terminal(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                               const std::string& interrupt_at = "", int signal = SIGINT);

/// A test with its own empty folder, removed afterwards.
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
