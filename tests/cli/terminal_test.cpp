// SPDX-License-Identifier: BSD-3-Clause
//
// Output on terminals only: the progress bar and colours. Ctrl-C.
#include <gmock/gmock.h>

#include "sample_files.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kColour = "\x1b[1m";

class Terminal : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    if (!has_terminals()) GTEST_SKIP() << "this machine gives no pseudo-terminals";
    file_ = write("ball.nrrd", nrrd_bytes(ball({8, 8, 8}, 2.2)));
  }
  [[nodiscard]] std::vector<std::string> contour(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"contour", file_, "--iso", "0", "-o", path("out.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

 private:
  std::string file_;
};

TEST_F(Terminal, ShowsProgressAndColours) {
  const RunResult run = run_tegl_on_terminal(contour(), {});
  EXPECT_EQ(run.exit, 0) << run.out;
  EXPECT_THAT(run.out, HasSubstr("read "));
  EXPECT_THAT(run.out, HasSubstr("[..."));
  EXPECT_THAT(run.out, HasSubstr(kColour));
  EXPECT_THAT(run.out, HasSubstr("\r\x1b[K" + std::string(kColour))) << "the bar is gone before the report";
}

TEST_F(Terminal, ShowsNoColoursWhereNoneAreWanted) {
  for (const char* setting : {"NO_COLOR=1", "TERM=dumb"}) {
    const RunResult run = run_tegl_on_terminal(contour(), {setting});
    EXPECT_EQ(run.exit, 0);
    EXPECT_THAT(run.out, Not(HasSubstr(kColour))) << setting;
    EXPECT_THAT(run.out, HasSubstr("triangles"));
  }
}

TEST_F(Terminal, ShowsNoProgressWhereItCannotBeWrittenOver) {
  for (const char* setting : {"TERM=dumb", "TERM="}) {
    const RunResult run = run_tegl_on_terminal(contour({"--no-check"}), {setting, "NO_COLOR=1"});
    EXPECT_EQ(run.exit, 0);
    EXPECT_THAT(run.out, Not(HasSubstr("\x1b"))) << setting;
    EXPECT_THAT(run.out, Not(HasSubstr("%"))) << setting;
  }
}

TEST_F(Terminal, KeepsItsProgressInOneLineOfNarrowWindows) {
  for (const std::size_t columns : {2, 3, 7, 12, 20, 24, 30, 200}) {
    SCOPED_TRACE(columns);
    const RunResult run = run_tegl_on_terminal(contour({"--no-check"}), {"COLUMNS=" + std::to_string(columns)});
    EXPECT_EQ(run.exit, 0);
    const std::string bar = run.out.substr(0, run.out.rfind("\r\x1b[K"));
    EXPECT_THAT(bar, HasSubstr("\x1b[K"));
    for (std::size_t at = 0; at < bar.size();) {
      const std::size_t end = std::min(bar.find("\r\x1b[K", at), bar.size());
      EXPECT_LT(end - at, columns) << bar.substr(at, end - at);
      at = end + 4;
    }
  }
}

TEST_F(Terminal, ShowsNoProgressInQuietOrJsonRuns) {
  EXPECT_EQ(run_tegl_on_terminal(contour({"--quiet"}), {}).out, "");
  EXPECT_THAT(run_tegl_on_terminal(contour({"--json"}), {}).out, Not(HasSubstr("\x1b")));
}

TEST_F(Terminal, InterruptStopsTheWorkAndLeavesNoFile) {
  const std::string file = write("noise.nrrd", nrrd_bytes_uint8(noise({40, 40, 40, 12}, 9)));
  const RunResult run = run_tegl_on_terminal(
      {"contour", file, "--iso", "128", "--triangulation", "barycentric", "-o", path("noise.vtkhdf")}, {}, "contour ");
  EXPECT_EQ(run.exit, 130) << run.out;
  EXPECT_THAT(run.out, HasSubstr("cancelled\r\n")) << "nothing of callbacks";
  EXPECT_THAT(run.out, Not(HasSubstr("callback")));
  EXPECT_THAT(files(), ElementsAre("ball.nrrd", "noise.nrrd"));
}

TEST_F(Terminal, EveryEndingSignalLeavesNoFileAndEndsAsTheShellExpects) {
  const std::string file = write("noise.nrrd", nrrd_bytes_uint8(noise({40, 40, 40, 12}, 9)));
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    SCOPED_TRACE(signal);
    const RunResult run = run_tegl_on_terminal(
        {"contour", file, "--iso", "128", "--triangulation", "barycentric", "-o", path("noise.vtkhdf")}, {}, "check ",
        signal);
    EXPECT_EQ(run.exit, 128 + signal) << run.out;
    EXPECT_THAT(run.out, HasSubstr("cancelled"));
    EXPECT_THAT(files(), ElementsAre("ball.nrrd", "noise.nrrd"));
  }
}

}  // namespace
}  // namespace tegl::test
