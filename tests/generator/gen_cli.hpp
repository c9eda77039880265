// SPDX-License-Identifier: BSD-3-Clause
//
// Runs `gen` for the tests of its command line.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace tegl::test {

using nlohmann::json;
using testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

/// Runs gen with these arguments; `redirect` is appended to the shell command unchanged.
inline Outcome gen(std::initializer_list<std::string_view> arguments, const std::string& redirect = "") {
  const std::string messages =
      testing::TempDir() + "gen_" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".txt";
  std::string command = "'" TEGL_GEN_PROGRAM "'";
  for (const std::string_view argument : arguments) {
    command.append(" '").append(argument).append("'");
  }
  command.append(" 2>'").append(messages).append("' ").append(redirect);
  Outcome run;
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) {
    ADD_FAILURE() << "cannot run " << command;
    return run;
  }
  std::array<char, 4096> buffer{};
  for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    run.out.append(buffer.data(), got);
  }
  const int result = pclose(pipe);
  run.status = WIFEXITED(result) ? WEXITSTATUS(result) : -1;
  std::ifstream file(messages);
  run.err.assign(std::istreambuf_iterator<char>(file), {});
  (void)std::remove(messages.c_str());
  return run;
}

/// Expects a refused command line: status 2, nothing on standard output, and a message with all these texts.
inline void expect_refused(std::initializer_list<std::string_view> arguments,
                           std::initializer_list<const char*> texts) {
  const Outcome run = gen(arguments);
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_EQ(run.out, "");
  for (const char* const text : texts) {
    EXPECT_THAT(run.err, HasSubstr(text));
  }
}

/// A new empty folder, removed at the end.
class Folder {
 public:
  Folder() : path_(testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// The regular files in a folder and their bytes.
inline std::map<std::string, std::string> contents(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      std::ifstream file(entry.path(), std::ios::binary);
      files[entry.path().filename().string()].assign(std::istreambuf_iterator<char>(file), {});
    }
  }
  return files;
}

}  // namespace tegl::test
