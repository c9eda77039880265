// SPDX-License-Identifier: BSD-3-Clause
//
// tegl demo, on a terminal and elsewhere. Colours and progress bars of every command appear on terminals only.
#include <gmock/gmock.h>

#include "sample_files.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kOcean = TEGL_SOURCE_DIR "/examples/data/ocean_temperature.nc";

class Demo : public ProgramTest {};

TEST_F(Demo, IsAReportWithAMapWhereThereIsNoTerminal) {
  const RunResult run = run_tegl({"demo"});
  EXPECT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, Not(HasSubstr("\x1b")));
  EXPECT_THAT(run.out, HasSubstr("%%%"));
  EXPECT_THAT(run.out, HasSubstr("Next steps"));
  EXPECT_THAT(run.out, HasSubstr("tegl contour $DATA --iso 20 -o ocean.vtkhdf"));
  EXPECT_TRUE(files().empty());
}

TEST_F(Demo, TellsTheSameContourAndCutsAsTheCommands) {
  const RunResult demo = run_tegl({"demo", "--json"});
  ASSERT_EQ(demo.exit, 0) << demo.err;
  const RunResult contour =
      run_tegl({"contour", kOcean, "--iso", "20", "--no-check", "-o", path("ocean.vtkhdf"), "--json"});
  EXPECT_EQ(demo.json()["simplices"], contour.json()["simplices"]);
  const RunResult cut = run_tegl({"slice", path("ocean.vtkhdf"), "--at", "t=4.25", "-o", path("cut.ply"), "--json"});
  EXPECT_EQ(demo.json()["cuts"][1]["t"], 4.25);
  EXPECT_EQ(demo.json()["cuts"][1]["simplices"], cut.json()["simplices"]);
}

TEST_F(Demo, PlaysOnATerminalAndLeavesItAsItWas) {
  if (!has_terminals()) GTEST_SKIP() << "this machine gives no pseudo-terminals";
  const RunResult run = run_tegl_on_terminal({"demo", "--frames", "3"}, {"LC_ALL=C.UTF-8"});
  EXPECT_EQ(run.exit, 0) << run.out;
  EXPECT_THAT(run.out, HasSubstr("\x1b[?25l"));
  EXPECT_THAT(run.out, HasSubstr("\x1b[38;2;"));
  EXPECT_THAT(run.out, HasSubstr("▀"));
  EXPECT_THAT(run.out, HasSubstr("t =  1.00"));
  EXPECT_THAT(run.out, HasSubstr("t =  6.50"));
  EXPECT_THAT(run.out, HasSubstr("t = 12.00"));
  EXPECT_GT(run.out.rfind("\x1b[?25h"), run.out.rfind("▀")) << "the cursor is back";
  EXPECT_THAT(run.out, HasSubstr("Next steps"));
}

TEST_F(Demo, PlaysWithoutColoursWhereNoneAreWanted) {
  if (!has_terminals()) GTEST_SKIP() << "this machine gives no pseudo-terminals";
  for (const char* const setting : {"NO_COLOR=1", "LC_ALL=C"}) {
    const RunResult run = run_tegl_on_terminal({"demo", "--frames", "2"}, {setting});
    EXPECT_EQ(run.exit, 0);
    EXPECT_THAT(run.out, Not(HasSubstr("\x1b[38;2;"))) << setting;
    EXPECT_THAT(run.out, HasSubstr("%%%")) << setting;
  }
}

TEST_F(Demo, ShowsOneMapIfNoAnimationIsWanted) {
  if (!has_terminals()) GTEST_SKIP() << "this machine gives no pseudo-terminals";
  const RunResult run = run_tegl_on_terminal({"demo", "--no-animation"}, {"LC_ALL=C.UTF-8"});
  EXPECT_THAT(run.out, Not(HasSubstr("\x1b[?25l")));
  EXPECT_THAT(run.out, HasSubstr("▀"));
  EXPECT_EQ(run_tegl_on_terminal({"demo", "--quiet"}, {}).out, "");
}

TEST_F(Demo, PlaysNothingOnATerminalThatCannotMoveItsCursor) {
  if (!has_terminals()) GTEST_SKIP() << "this machine gives no pseudo-terminals";
  const RunResult run = run_tegl_on_terminal({"demo"}, {"TERM=dumb", "LC_ALL=C.UTF-8"});
  EXPECT_EQ(run.exit, 0);
  EXPECT_THAT(run.out, Not(HasSubstr("\x1b[?25l")));
  EXPECT_THAT(run.out, Not(HasSubstr("t =  1.00 ")));
  EXPECT_THAT(run.out, HasSubstr("%%%"));
}

// The animation, between hiding and showing the cursor: every line is shorter than the window, so that it does not
// wrap, and there are at most as many lines as in the window, so that it does not scroll.
TEST_F(Demo, StandsInASmallWindowOrPlaysNothing) {
  if (!has_terminals()) GTEST_SKIP() << "this machine gives no pseudo-terminals";
  struct Window {
    std::size_t columns;
    std::size_t lines;
    bool fits;
  };
  for (const Window& window : {Window{20, 8, true}, Window{17, 6, true}, Window{150, 12, true}, Window{120, 24, true},
                               Window{3, 2, false}, Window{80, 5, false}, Window{16, 24, false}}) {
    for (const std::string setting : {"LC_ALL=C.UTF-8", "NO_COLOR=1"}) {
      SCOPED_TRACE(testing::Message() << window.columns << " x " << window.lines << " " << setting);
      const RunResult run = run_tegl_on_terminal(
          {"demo", "--frames", "3"},
          {setting, "COLUMNS=" + std::to_string(window.columns), "LINES=" + std::to_string(window.lines)});
      EXPECT_EQ(run.exit, 0);
      const std::string& shown = run.out;
      EXPECT_THAT(shown, HasSubstr("Next steps"));
      const std::size_t begin = shown.find("\x1b[?25l");
      EXPECT_EQ(begin != std::string::npos, window.fits);
      if (window.columns < 17) {
        EXPECT_THAT(shown, HasSubstr("too narrow"));
      }
      if (!window.fits) continue;
      const std::string film = shown.substr(begin, shown.find("\x1b[?25h") - begin);
      std::size_t wide = 0;
      std::size_t lines = 0;
      for (std::size_t i = 0; i < film.size(); ++i) {
        if (film[i] == '\x1b') {  // an escape sequence, of no width
          i = film.find_first_of("ABCDHJKhlm", i);
          ASSERT_NE(i, std::string::npos);
          if (film[i] == 'A') lines = 0;
        } else if (film[i] == '\n' || film[i] == '\r') {
          lines += film[i] == '\n' ? 1 : 0;
          EXPECT_LT(lines, window.lines);
          wide = 0;
        } else if ((film[i] & 0xc0) != 0x80) {  // the first byte of a UTF-8 character
          ++wide;
          ASSERT_LT(wide, window.columns);
        }
      }
    }
  }
}

TEST_F(Demo, EndsWhenItIsInterrupted) {
  if (!has_terminals()) GTEST_SKIP() << "this machine gives no pseudo-terminals";
  const RunResult run = run_tegl_on_terminal({"demo", "--frames", "100000"}, {"LC_ALL=C.UTF-8"}, "t =  1.00");
  EXPECT_EQ(run.exit, 130);
  EXPECT_THAT(run.out, HasSubstr("\x1b[?25h"));
}

TEST_F(Demo, RefusesFilesAndFramesThatCannotBe) {
  EXPECT_EQ(run_tegl({"--completion=zsh"}).out, run_tegl({"--completion", "zsh"}).out);
  EXPECT_THAT(run_tegl({"--completion", "bash", "contour"}).err, HasSubstr("--completion with 'contour'"));
  EXPECT_THAT(run_tegl({"--completion"}).err, HasSubstr("needs a shell"));
  EXPECT_EQ(run_tegl({"demo", "file.nii"}).exit, 2);
  EXPECT_EQ(run_tegl({"demo", "--frames", "1"}).exit, 2);
}

TEST_F(Demo, OrAnyOtherCommandShowsNoEscapesBesideATerminal) {
  const std::string file = write("balls.nrrd", nrrd_bytes(merging_balls(9, 4)));
  ASSERT_EQ(run_tegl({"contour", file, "--iso", "0.1", "-o", path("balls.vtkhdf")}).exit, 0);
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"info", file},
           {"contour", file, "--iso", "0.1,0.3", "-o", path("a.vtkhdf")},
           {"slice", file, "--iso", "0.1", "--at", "t=1.5", "-o", path("b.ply")},
           {"check", path("balls.vtkhdf")},
           {"components", file, "--iso", "0.1"},
           {"measure", file, "--iso", "0.1"},
           {"track", file, "--iso", "0.1"},
           {"index", file},
           {"elements", file, "--iso", "0.1", "-o", path("c.dat")},
           {"project", file, "--iso", "0.1", "-o", path("d.ply")},
           {"simplify", file, "--iso", "0.1", "--ratio", "0.5", "-o", path("e.vtkhdf")},
           {"info", path("none.nrrd")},
           {"--help"}}) {
    SCOPED_TRACE(arguments[0]);
    const RunResult plain = run_tegl(arguments);
    EXPECT_THAT(plain.out + plain.err, Not(HasSubstr("\x1b")));
    if (!has_terminals() || arguments[0] == "--help") continue;
    EXPECT_THAT(run_tegl_on_terminal(arguments, {}).out, HasSubstr("\x1b[")) << "a terminal has them";
    const std::string bare = run_tegl_on_terminal(arguments, {"NO_COLOR=1"}).out;
    EXPECT_THAT(bare, Not(testing::ContainsRegex("\x1b\\[[0-9;]*m"))) << "NO_COLOR";
  }
}

}  // namespace
}  // namespace tegl::test
