// SPDX-License-Identifier: BSD-3-Clause
//
// Streams without a reader, system limits, and control characters of files on their way to a terminal.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class Endings : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ball_ = write("ball.nrrd", nrrd_bytes(ball({12, 12, 12}, 4)));
  }
  [[nodiscard]] std::vector<std::string> contour() const {
    return {"contour", ball_, "--iso", "0", "-o", path("out.ply")};
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string ball_;
};

/// Replaces a stream by a pipe without a reader, as in `tegl ... | head -c0`.
void break_pipe(int stream) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) _exit(1);
  close(ends[0]);
  dup2(ends[1], stream);
  close(ends[1]);
}

TEST_F(Endings, AReportThatNobodyReadsEndsBySigpipeWithTheOutputInPlace) {
  for (const char* const json : {"--json", "--no-check"}) {
    auto arguments = contour();
    arguments.emplace_back(json);
    EXPECT_EQ(run_tegl(arguments, [] { break_pipe(STDOUT_FILENO); }).exit, 128 + SIGPIPE);
    EXPECT_THAT(files(), ElementsAre("ball.nrrd", "out.ply"));
  }
  EXPECT_EQ(run_tegl({"info", ball_}, [] { break_pipe(STDOUT_FILENO); }).exit, 128 + SIGPIPE);
  EXPECT_EQ(run_tegl({"--help"}, [] { break_pipe(STDOUT_FILENO); }).exit, 128 + SIGPIPE);
  auto quiet = contour();
  quiet.emplace_back("--quiet");
  EXPECT_EQ(run_tegl(quiet, [] { break_pipe(STDOUT_FILENO); }).exit, 0);
}

TEST_F(Endings, ClosedStreamsAreNotTakenForOutputFiles) {
  ASSERT_EQ(run_tegl(contour()).exit, 0);
  const std::string expected = text_of("out.ply");
  for (const int closed : {STDOUT_FILENO, STDERR_FILENO}) {
    std::filesystem::remove(path("out.ply"));
    const RunResult run = run_tegl(contour(), [closed] { close(closed); });
    EXPECT_EQ(run.exit, closed == STDOUT_FILENO ? 6 : 0) << run.err;
    EXPECT_EQ(text_of("out.ply"), expected) << closed;
  }
  // The error message cannot be written then, and goes nowhere else.
  const RunResult run = run_tegl({"info", path("none.nrrd")}, [] {
    close(STDERR_FILENO);
    close(STDIN_FILENO);
  });
  EXPECT_EQ(run.exit, 3);
  EXPECT_EQ(run.out, "");
}

TEST_F(Endings, FewerThreadsThanTheMachineHasAreSaidAndEnough) {
  if (getuid() != 0) GTEST_SKIP() << "needs another user, who has no processes yet";
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers start threads of their own";
#endif
  if (sysconf(_SC_NPROCESSORS_ONLN) < 2) GTEST_SKIP() << "one processor needs one thread";
  const std::string file = write("noise.nrrd", nrrd_bytes_uint8(noise({64, 64, 64}, 3)));
  const auto as_nobody = [] {
    constexpr uid_t kOther = 64999;  // no account has this number
    const rlimit one{1, 1};
    if (setrlimit(RLIMIT_NPROC, &one) != 0 || setresuid(kOther, kOther, kOther) != 0) _exit(126);
  };
  if (const RunResult can = run_tegl({"--version"}, as_nobody); can.exit != 0)
    GTEST_SKIP() << "another user cannot run the program: " << can.err;
  const RunResult run = run_tegl({"measure", file, "--iso", "128"}, as_nobody);
  EXPECT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("lets 1 of "), HasSubstr("--threads 1")));
  const RunResult one = run_tegl({"measure", file, "--iso", "128", "--threads", "1"}, as_nobody);
  EXPECT_EQ(one.exit, 0);
  EXPECT_EQ(one.err, "");
}

/// Escape, bell, DEL, a C1 control character, a reversal of direction, an invalid UTF-8 byte, and a new line.
const std::string kControls = "\x1b[31mred\x07\x7f\xc2\x9b\xe2\x80\xae\xff\nC";

void expect_printable(const std::string& text) {
  for (const char c : text) EXPECT_TRUE(c == '\n' || (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f)) << text;
  for (const char* const raw : {"\xc2\x9b", "\xe2\x80\xae", "\xff"}) EXPECT_EQ(text.find(raw), std::string::npos);
}

TEST_F(Endings, NoCommandShowsControlCharactersOfFilesAsTheyAre) {
  write_netcdf(
      path("ctl.nc"), {"x", "y", "z", "t"}, {{0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, {0, 1, 2, 3}},
      {{"v", ball({5, 5, 5, 4}, 1.7), kControls}},
      {{0, "units", kControls}, {2, "units", kControls}, {3, "units", kControls}, {1, "long_name", kControls}});
  const std::string file = path("ctl.nc");
  const std::string out = path("out.vtkhdf");
  const std::vector<std::vector<std::string>> commands = {
      {"info", file},
      {"contour", file, "--iso", "0.2", "-o", out},
      {"contour", file, "--iso", "99", "-o", out},
      {"contour", file, "--iso", "0.2", "-o", path("a" + kControls + ".ply")},
      {"slice", file, "--iso", "0.2", "--at", "t=1.5", "-o", path("cut.ply")},
      {"slice", file, "--iso", "0.2", "--at", kControls + "=1.5", "-o", path("cut.ply")},
      {"measure", file, "--iso", "0.2", "--samples", "3"},
      {"measure", out, "--samples", "3"},
      {"components", file, "--iso", "0.2"},
      {"track", file, "--iso", "0.2"},
      {"simplify", out, "--ratio", "0.9", "-o", path("less.vtkhdf")},
      {"elements", file, "--iso", "0.2", "-o", path("e.dat")},
      {"index", file},
      {"view", file, "--iso", "0.2", "--title", kControls, "-o", path("page.html")},
      {"info", path(kControls)},
      {"contour", file, "--iso", kControls, "-o", out},
      {"contour", file, "--" + kControls, "-o", out},
      {kControls}};
  for (const std::vector<std::string>& command : commands) {
    const RunResult run = run_tegl(command);
    SCOPED_TRACE(command[0] + ": " + run.out + run.err);
    EXPECT_NE(run.out + run.err, "");
    expect_printable(run.out);
    expect_printable(run.err);
    auto with_json = command;
    with_json.emplace_back("--json");
    const RunResult json = run_tegl(with_json);
    expect_printable(json.out);
    expect_printable(json.err);
    EXPECT_TRUE(json.out.empty() || nlohmann::json::accept(json.out)) << json.out;
  }
  const nlohmann::json info = run_tegl({"info", file, "--json"}).json();
  // JSON has the text unchanged, except for the invalid UTF-8 byte.
  EXPECT_THAT(info.dump(), HasSubstr("\\u001b[31mred\\u0007\x7f\xc2\x9b\xe2\x80\xae"));
  EXPECT_THAT(run_tegl({"info", file}).out, HasSubstr("\\x1b[31mred\\x07\\x7f\\u009b\\u202e\\xff\\x0aC"));
}

TEST_F(Endings, PagesHoldNoControlCharactersOfFiles) {
  write_netcdf(path("ctl.nc"), {"x", "y", "z"}, {{0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}},
               {{"v", ball({5, 5, 5}, 1.7), kControls}}, {{0, "units", kControls}});
  const RunResult run =
      run_tegl({"view", path("ctl.nc"), "--iso", "0.2", "--title", kControls + "</title><b>", "-o", path("page.html")});
  if (run.err.find("no viewer") != std::string::npos) GTEST_SKIP() << "no viewer in this build";
  ASSERT_EQ(run.exit, 0) << run.err;
  const std::string page = text_of("page.html");
  const std::string head = page.substr(page.find("<title>"), page.find("</title>") - page.find("<title>"));
  EXPECT_EQ(head, "<title>\\x1b[31mred\\x07\\x7f\\u009b\\u202e\\xff\\x0aC&lt;/title>&lt;b>");
  const std::string scene =
      page.substr(page.find("id=\"scene\""), page.find("id=\"numbers\"") - page.find("id=\"scene\""));
  expect_printable(scene);
  EXPECT_THAT(scene, HasSubstr("\\\\x1b[31mred"));
}

TEST_F(Endings, FilesReadBesidesTheImageAreNamedThemselves) {
  auto by_index = contour();
  by_index.insert(by_index.end(), {"--index", path("none.tindex")});
  const RunResult index = run_tegl(by_index);
  EXPECT_EQ(index.exit, 3);
  EXPECT_EQ(index.err, "tegl: " + path("none.tindex") + ": no such file\n");
  auto with_attribute = contour();
  with_attribute.insert(with_attribute.end(), {"--attribute", path("none.nc")});
  const RunResult attribute = run_tegl(with_attribute);
  EXPECT_EQ(attribute.exit, 3);
  EXPECT_EQ(attribute.err, "tegl: " + path("none.nc") + ": no such file\n");
}

TEST_F(Endings, UnknownOptionsAndCommandsAreNamedWithWhatWasMeant) {
  const auto error = [](const std::vector<std::string>& arguments) {
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 2);
    return run.err;
  };
  EXPECT_EQ(error({"contour", ball_, "--isovalue", "60", "-o", path("out.ply")}),
            "tegl: unknown option --isovalue (did you mean --iso?) (see tegl contour --help)\n");
  EXPECT_THAT(error({"contour", ball_, "--iso", "0", "--ouput", path("out.ply")}),
              HasSubstr("unknown option --ouput (did you mean --output?)"));
  EXPECT_THAT(error({"contour", ball_, "--iso=0", "--triangluation=compact", "-o", path("out.ply")}),
              HasSubstr("unknown option --triangluation (did you mean --triangulation?)"));
  EXPECT_THAT(error({"measure", ball_, "--iso", "0", "--zzzzzzzz"}), HasSubstr("unknown option --zzzzzzzz (see"));
  EXPECT_THAT(error({"info", ball_, "-Z"}), HasSubstr("unknown option -Z (see"));
  EXPECT_THAT(error({"--jsno"}), HasSubstr("unknown option --jsno"));
  EXPECT_THAT(error({"contuor", ball_}), HasSubstr("there is no command 'contuor' (did you mean contour?)"));
  EXPECT_THAT(error({"paint", ball_}), HasSubstr("there is no command 'paint'; expected info, "));
}

}  // namespace
}  // namespace tegl::test
