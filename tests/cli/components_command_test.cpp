// SPDX-License-Identifier: BSD-3-Clause
//
// The commands tegl components and tegl measure, run as in a shell.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "sample_files.hpp"
#include "tegl/check.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Balls of radii 5, 3 and 2 in a volume with steps of 1 mm.
Samples three_balls() {
  return sample({30, 20, 20}, [](const std::vector<double>& x) {
    const auto ball = [&](double centre, double radius) {
      return radius - std::hypot(x[0] - centre, x[1] - 9.5, x[2] - 9.5);
    };
    return std::max({ball(6.5, 5), ball(18, 3), ball(25, 2)});
  });
}

class ThreeBalls : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    file_ = write("balls.nii", nifti_bytes(three_balls(), {1, 1, 1}));
  }
  [[nodiscard]] nlohmann::json run_json(std::vector<std::string> arguments) const {
    arguments.emplace_back("--json");
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name)).rdbuf();
    return text.str();
  }
  std::string file_;
};

using Components = ThreeBalls;
using MeasureCommand = ThreeBalls;

TEST_F(Components, OfThreeBallsAreThree) {
  const nlohmann::json report = run_json({"components", file_, "--iso", "0"});
  EXPECT_EQ(report["count"], 3);
  EXPECT_EQ(report["size_unit"], "mm^2");
  EXPECT_EQ(report["content_unit"], "mm^3");
  ASSERT_EQ(report["components"].size(), 3u);
  for (const nlohmann::json& component : report["components"]) {
    EXPECT_EQ(component["euler"], 2);
    EXPECT_EQ(component["closed"], true);
    EXPECT_NEAR(component["centroid"][1], 9.5, 0.01);
  }
  const nlohmann::json largest = report["components"][0];
  EXPECT_EQ(largest["rank"], 1);
  EXPECT_NEAR(largest["size"], 4 * std::numbers::pi * 25, 8);
  EXPECT_NEAR(largest["content"], 4 * std::numbers::pi * 125 / 3, 15);
  EXPECT_NEAR(largest["highest"][0], 11.5, 0.1);
}

TEST_F(Components, OfASavedContourAreThoseOfItsImage) {
  ASSERT_EQ(run_tegl({"contour", file_, "--iso", "0", "-o", path("all.ply"), "-q"}).exit, 0);
  EXPECT_EQ(run_json({"components", path("all.ply"), "--threads", "2"})["components"],
            run_json({"components", file_, "--iso", "0"})["components"]);
}

TEST_F(Components, SelectedGoIntoOneFileWithTheirLabels) {
  const nlohmann::json report = run_json({"components", file_, "--iso", "0", "--select", "size < 200", "--select",
                                          "x.centroid > 10", "-o", path("some.vtkhdf")});
  ASSERT_EQ(report["components"].size(), 2u);
  const Mesh mesh = read_mesh(path("some.vtkhdf"));
  EXPECT_EQ(check(2, mesh.simplices, 3, mesh.coordinates).components, 2u);
  ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
  EXPECT_EQ(mesh.vertex_attributes[0].name, "component");
  EXPECT_EQ(mesh.vertex_attributes[0].values.front(), report["components"][0]["label"]);
  const auto& labels = mesh.simplex_attributes.at(0).values;
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(std::count(labels.begin(), labels.end(), report["components"][i]["label"].get<double>()),
              report["components"][i]["simplices"].get<int>());
}

TEST_F(Components, SplitAreAFileEach) {
  const nlohmann::json report =
      run_json({"components", file_, "--iso", "0", "--largest", "2", "--split", path("part_{label}.ply")});
  ASSERT_EQ(report["components"].size(), 2u);
  for (const nlohmann::json& component : report["components"]) {
    const Mesh mesh = read_mesh(component["output"].get<std::string>());
    const MeshReport found = check(2, mesh.simplices, 3, mesh.coordinates);
    EXPECT_EQ(found.components, 1u);
    EXPECT_EQ(found.boundary_simplices, 0u);
    EXPECT_EQ(found.simplices, component["simplices"]);
    EXPECT_EQ(found.bad_links, 0u);
  }
  EXPECT_EQ(files().size(), 3u);
}

TEST_F(Components, TableIsShownAndWritten) {
  const RunResult run = run_tegl({"components", file_, "--iso", "0", "--csv", path("table.csv"), "--rows", "1"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 components"));
  EXPECT_THAT(run.out, HasSubstr("and 2 smaller ones"));
  std::istringstream lines(text_of("table.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "label,rank,vertices,simplices,size (mm^2),content (mm^3),euler,boundary,x.min (mm),y.min (mm),z.min (mm),"
            "x.max (mm),y.max (mm),z.max (mm),x.centroid (mm),y.centroid (mm),z.centroid (mm)");
  std::size_t rows = 0;
  while (std::getline(lines, line)) ++rows;
  EXPECT_EQ(rows, 3u);
}

TEST_F(Components, OfMovingThingsAreChosenByTime) {
  // One ball from t = 0 to 3, another from t = 6 to the end.
  const std::string file = write("moving.nrrd", nrrd_bytes(sample({16, 10, 10, 10}, [](const std::vector<double>& x) {
                                   const auto ball = [&](double centre, double time, double life) {
                                     return 2.6 - std::hypot(x[0] - centre, x[1] - 4.5, x[2] - 4.5) -
                                            std::max(0.0, std::abs(x[3] - time) - life);
                                   };
                                   return std::max(ball(4, 0, 2), ball(11, 9, 2));
                                 })));
  EXPECT_EQ(run_json({"components", file, "--iso", "0"})["count"], 2);
  const nlohmann::json early = run_json({"components", file, "--iso", "0", "--select", "t contains 1"});
  ASSERT_EQ(early["components"].size(), 1u);
  EXPECT_EQ(early["components"][0]["lowest"][3], 0);
  EXPECT_LT(early["components"][0]["highest"][3], 5);
  const RunResult none =
      run_tegl({"components", file, "--iso", "0", "--select", "t.span > 8", "-o", path("no.vtkhdf")});
  EXPECT_EQ(none.exit, 5);
  EXPECT_THAT(none.err, HasSubstr("none of the 2 components"));
  EXPECT_THAT(files(), ElementsAre("balls.nii", "moving.nrrd"));
}

TEST_F(Components, WrongOptionsAreRefusedBeforeAnythingIsWritten) {
  const auto refused = [&](std::vector<std::string> arguments, int exit, const std::string& message) {
    arguments.insert(arguments.begin(), {"components", file_});
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.err;
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_THAT(files(), ElementsAre("balls.nii"));
  };
  refused({"--iso", "0", "--split", path("a.ply")}, 2, "expected a name with {label}");
  refused({"--iso", "0", "--split", path("a_{label}.xyz")}, 6, ".xyz");
  refused({"--iso", "0", "--select", "size >"}, 2, "expected a number");
  refused({"--iso", "0", "--largest", "0"}, 2, "--largest");
  refused({"--iso", "0", "-o", path("nowhere/a.ply")}, 6, "does not exist");
  refused({"--iso", "0", "--csv", path("nowhere/a.csv")}, 6, "does not exist");
  refused({}, 2, "--iso is missing");
  refused({"--iso", "1000"}, 5, "outside of the values");
}

TEST_F(Components, AreAllWrittenOrNone) {
  ASSERT_EQ(run_tegl({"contour", file_, "--iso", "0", "-o", path("part_1.ply"), "-q"}).exit, 0);
  // The input has the name of the second output.
  const RunResult run = run_tegl({"components", path("part_1.ply"), "--split", path("part_{label}.ply")});
  EXPECT_EQ(run.exit, 6);
  EXPECT_THAT(run.err, HasSubstr("is the input itself"));
  EXPECT_THAT(files(), ElementsAre("balls.nii", "part_1.ply"));
}

TEST_F(Components, OfASavedContourTakeNoOptionsOfImages) {
  ASSERT_EQ(run_tegl({"contour", file_, "--iso", "0", "-o", path("all.ply"), "-q"}).exit, 0);
  const RunResult run = run_tegl({"components", path("all.ply"), "--iso", "0", "--close"});
  EXPECT_EQ(run.exit, 2);
  EXPECT_THAT(run.err, HasSubstr("does not take --iso, --close"));
}

TEST_F(MeasureCommand, OfBallsIsAreaAndVolume) {
  const nlohmann::json report = run_json({"measure", file_, "--iso", "0"});
  EXPECT_NEAR(report["size"], 4 * std::numbers::pi * (25 + 9 + 4), 12);
  EXPECT_NEAR(report["content"], 4 * std::numbers::pi * (125 + 27 + 8) / 3, 25);
  EXPECT_EQ(report["size_unit"], "mm^2");
  EXPECT_EQ(report["content_unit"], "mm^3");
  const RunResult text = run_tegl({"measure", file_, "--iso", "0"});
  EXPECT_THAT(text.out, HasSubstr("encloses     volume "));
  EXPECT_THAT(text.out, HasSubstr(" mm^3"));
}

TEST_F(MeasureCommand, OfAnOpenContourSaysSo) {
  const std::string file = write("open.nii", nifti_bytes(ball({12, 12, 12}, 7), {1, 1, 1}));
  const nlohmann::json open = run_json({"measure", file, "--iso", "0"});
  EXPECT_TRUE(open["content"].is_null());
  EXPECT_GT(open["boundary_simplices"], 0);
  EXPECT_THAT(run_tegl({"measure", file, "--iso", "0"}).out, HasSubstr("not defined: it is open"));
  EXPECT_GT(run_json({"measure", file, "--iso", "0", "--close"})["content"], 1000);
}

TEST_F(MeasureCommand, OfATimeOutsideIsRefused) {
  const RunResult run = run_tegl({"measure", file_, "--iso", "0", "--at", "z=-1"});
  EXPECT_EQ(run.exit, 5);
  EXPECT_THAT(run.err, HasSubstr("the slice at z = -1 lies outside of the image; expected "));
}

TEST_F(MeasureCommand, OverTimeIsThatOfTheCuts) {
  const std::string file = write("moving.nii", nifti_bytes(merging_balls(18, 5), {1, 1, 1, 2}));
  const nlohmann::json report =
      run_json({"measure", file, "--iso", "0", "--at", "t=0.7,8", "--samples", "3", "--csv", path("curve.csv")});
  std::vector<double> times;
  for (const nlohmann::json& cut : report["cuts"]) times.push_back(cut["value"].get<double>());
  EXPECT_THAT(times, ElementsAre(0, 0.7, 4, 8)) << "ascending, each once";
  EXPECT_NEAR(report["cuts"][1]["content"], 2 * 4 * std::numbers::pi * 27 / 3, 25);
  EXPECT_NEAR(report["cuts"][1]["size"], 2 * 4 * std::numbers::pi * 9, 12);
  const nlohmann::json two = run_json({"measure", file, "--iso", "0", "--at", "t=8,0.7"})["cuts"];
  EXPECT_EQ(two[0], report["cuts"][3]) << "without --samples in the order of --at";
  EXPECT_EQ(two[1], report["cuts"][1]);
  EXPECT_EQ(report["cut_content_unit"], "mm^3");
  EXPECT_THAT(text_of("curve.csv"), HasSubstr("t (s),area (mm^2),enclosed volume (mm^3)\n0,"));
  const RunResult text = run_tegl({"measure", file, "--iso", "0", "--at", "t=3"});
  EXPECT_THAT(text.out, HasSubstr("units        t in s, area in mm^2, enclosed volume in mm^3"));
}

TEST_F(MeasureCommand, RefusesWhatItCannotCut) {
  const auto refused = [&](std::vector<std::string> arguments, int exit, const std::string& message) {
    arguments.insert(arguments.begin(), {"measure", file_, "--iso", "0"});
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.err;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  refused({"--at", "x=3"}, 2, "expected z=3");
  refused({"--at", "7"}, 2, "--at is '7'");
  refused({"--samples", "1"}, 2, "--samples");
  refused({"--csv", path("a.csv")}, 2, "--csv without slices");
  EXPECT_THAT(files(), ElementsAre("balls.nii"));
}

}  // namespace
}  // namespace tegl::test
