// SPDX-License-Identifier: BSD-3-Clause
//
// Child processes, pipes and pseudo-terminals for running `tegl`.
#include "tegl_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>

namespace tegl::test {

namespace {

namespace fs = std::filesystem;

/// Starts the program in a child process after calling `prepare` there.
pid_t start(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  std::vector<std::string> words = {TEGL_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    prepare();
    execv(TEGL_PROGRAM, pointers.data());
    _exit(127);
  }
  return child;
}

int exit_status(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

/// Reads everything from two pipes at the same time, so that the child never blocks on one of them.
void drain(std::array<int, 2> ends, std::array<std::string*, 2> texts) {
  std::array<pollfd, 2> waits = {{{ends[0], POLLIN, 0}, {ends[1], POLLIN, 0}}};
  std::array<char, 65536> buffer{};
  while (waits[0].fd >= 0 || waits[1].fd >= 0) {
    if (poll(waits.data(), waits.size(), -1) < 0) return;
    for (std::size_t i = 0; i < waits.size(); ++i) {
      if (waits[i].fd < 0 || waits[i].revents == 0) continue;
      const ssize_t got = read(waits[i].fd, buffer.data(), buffer.size());
      if (got > 0) {
        texts[i]->append(buffer.data(), static_cast<std::size_t>(got));
      } else {
        waits[i].fd = -1;
      }
    }
  }
}

}  // namespace

nlohmann::json RunResult::json() const {
  nlohmann::json document = nlohmann::json::parse(out, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << "no JSON: " << out << "\nstandard error: " << err;
  return document;
}

RunResult run_tegl(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  std::array<int, 2> out{};
  std::array<int, 2> err{};
  RunResult result;
  if (pipe(out.data()) != 0 || pipe(err.data()) != 0) return result;
  const pid_t child = start(arguments, [&] {
    const int null = open("/dev/null", O_RDONLY);
    dup2(null, STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    dup2(err[1], STDERR_FILENO);
    for (const int end : {null, out[0], out[1], err[0], err[1]}) close(end);
    if (prepare) prepare();
  });
  close(out[1]);
  close(err[1]);
  drain({out[0], err[0]}, {&result.out, &result.err});
  close(out[0]);
  close(err[0]);
  int status = 0;
  waitpid(child, &status, 0);
  result.exit = exit_status(status);
  return result;
}

namespace {

/// A new pseudo-terminal and its other side, both open; -1 if the machine has none (for example without /dev/pts).
std::array<int, 2> open_terminal() {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0) return {-1, -1};
  if (grantpt(terminal) == 0 && unlockpt(terminal) == 0)
    if (const char* name = ptsname(terminal); name != nullptr)
      if (const int other_side = open(name, O_RDWR | O_NOCTTY); other_side >= 0) return {terminal, other_side};
  close(terminal);
  return {-1, -1};
}

}  // namespace

bool has_terminals() {
  const auto sides = open_terminal();
  for (const int side : sides)
    if (side >= 0) close(side);
  return sides[0] >= 0;
}

RunResult run_tegl_on_terminal(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                               const std::string& interrupt_at, int signal) {
  RunResult result;
  const auto [terminal, other_side] = open_terminal();
  if (terminal < 0) return result;
  winsize size{.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
  for (const std::string& setting : environment) {
    if (setting.starts_with("LINES=")) size.ws_row = static_cast<unsigned short>(std::stoi(setting.substr(6)));
    if (setting.starts_with("COLUMNS=")) size.ws_col = static_cast<unsigned short>(std::stoi(setting.substr(8)));
  }
  ioctl(other_side, TIOCSWINSZ, &size);
  const pid_t child = start(arguments, [&, terminal = terminal, other_side = other_side] {
    setenv("TERM", "xterm", 1);
    unsetenv("NO_COLOR");
    for (const std::string& setting : environment) putenv(const_cast<char*>(setting.c_str()));
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(other_side, stream);
    close(other_side);
    close(terminal);
  });
  close(other_side);
  std::array<char, 4096> buffer{};
  bool interrupted = interrupt_at.empty();
  // Reading the terminal fails when the child has ended.
  for (ssize_t got = 0; (got = read(terminal, buffer.data(), buffer.size())) > 0;) {
    result.out.append(buffer.data(), static_cast<std::size_t>(got));
    if (!interrupted && result.out.find(interrupt_at) != std::string::npos) {
      kill(child, signal);
      interrupted = true;
    }
  }
  close(terminal);
  int status = 0;
  waitpid(child, &status, 0);
  result.exit = exit_status(status);
  return result;
}

void ProgramTest::SetUp() {
  const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string("tegl_") + info->test_suite_name() + "_" + info->name();
  std::replace(name.begin(), name.end(), '/', '_');
  folder_ = fs::path(testing::TempDir()) / (name + "_" + std::to_string(getpid()));
  fs::remove_all(folder_);
  fs::create_directories(folder_);
}

void ProgramTest::TearDown() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string ProgramTest::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(path(name), std::ios::binary) << bytes;
  return path(name);
}

}  // namespace tegl::test
