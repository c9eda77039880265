// SPDX-License-Identifier: BSD-3-Clause
//
// tegl demo, on a terminal and elsewhere; and that colours and bars are for terminals in every command.
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
  EXPECT_THAT(run.out, HasSubstr("What next"));
  EXPECT_THAT(run.out, HasSubstr("tegl contour $DATA --iso 20 -o ocean.vtkhdf"));
  EXPECT_TRUE(files().empty());
}

TEST_F(Demo, TellsTheSameContourAndCutsAsTheCommands) {
  const RunResult demo = run_tegl({"demo", "--json"});
  ASSERT_EQ(demo.exit, 0) << demo.err;
  const RunResult contour = run_tegl({"contour", kOcean, "--iso", "20", "--triangulation", "barycentric", "--no-check",
                                      "-o", path("ocean.vtkhdf"), "--json"});
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
  EXPECT_THAT(run.out, HasSubstr("What next"));
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

TEST_F(Demo, EndsWhenItIsInterrupted) {
  if (!has_terminals()) GTEST_SKIP() << "this machine gives no pseudo-terminals";
  const RunResult run = run_tegl_on_terminal({"demo", "--frames", "100000"}, {"LC_ALL=C.UTF-8"}, "t =  1.00");
  EXPECT_EQ(run.exit, 130);
  EXPECT_THAT(run.out, HasSubstr("\x1b[?25h"));
}

TEST_F(Demo, RefusesFilesAndFramesThatCannotBe) {
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
