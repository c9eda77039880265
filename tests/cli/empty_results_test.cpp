// SPDX-License-Identifier: BSD-3-Clause
//
// Values outside the data, in all commands: an error with the value and the range, or with --allow-empty an empty
// result. A value within the data that has no contour gives an empty result without an error.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class EmptyResults : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    balls_ = write("balls.nrrd", nrrd_bytes(merging_balls(12, 4)));  // values from -12 to 3, t from 0 to 3
  }
  /// Expects exit code 5 and these texts; with --allow-empty expects exit code 0 and returns that run.
  static RunResult expect_outside(std::vector<std::string> arguments, const std::string& text) {
    SCOPED_TRACE(arguments[0]);
    const RunResult refused = run_tegl(arguments);
    EXPECT_EQ(refused.exit, 5) << refused.err;
    EXPECT_THAT(refused.err, AllOf(HasSubstr(text), HasSubstr("--allow-empty")));
    arguments.emplace_back("--allow-empty");
    RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    EXPECT_EQ(run.err, "");
    return run;
  }
  void expect_empty_mesh(const std::string& name, int dim) const {
    const Mesh mesh = read_mesh(path(name));
    EXPECT_EQ(mesh.simplices.size(), 0U) << name;
    if (name.ends_with(".vtkhdf")) {
      EXPECT_EQ(mesh.dim, dim) << name;
    }
  }

  std::string balls_;
};

TEST_F(EmptyResults, OfAnIsovalueOutsideOfTheValuesAreErrorsUnlessAllowed) {
  const std::string out = path("out.vtkhdf");
  const char* const range = "the isovalue 99 lies outside of the values";
  const std::vector<std::vector<std::string>> commands = {
      {"contour", balls_, "--iso", "99", "-o", out},
      {"contour", balls_, "--iso", "99", "--stream", "-o", out},
      {"contour", balls_, "--iso", "99,0", "--one-file", "-o", out},
      {"contour", balls_, "--iso", "99", "--pick", "1,2,3,1", "-o", out},
      {"contour", balls_, "--iso", "99", "--facets", "-o", path("out.vtu")},
      {"slice", balls_, "--iso", "99", "--at", "t=1.5", "-o", path("cut.ply")},
      {"slice", balls_, "--iso", "99", "--plane", "1,0,0,1=5", "-o", path("cut.ply")},
      {"project", balls_, "--iso", "99", "-o", path("sweep.ply")},
      {"project", balls_, "--iso", "99", "--as", "cuts", "-o", path("sweep.ply")},
      {"components", balls_, "--iso", "99", "-o", out, "--csv", path("table.csv")},
      {"measure", balls_, "--iso", "99", "--at", "t=1.5", "--samples", "3"},
      {"elements", balls_, "--iso", "99", "-o", path("e.dat")},
      {"track", balls_, "--iso", "99", "-o", path("graph.json"), "-o", out},
      {"simplify", balls_, "--iso", "99", "--ratio", "0.5", "-o", out}};
  for (std::vector<std::string> command : commands) {
    std::filesystem::remove(out);
    const bool streamed = std::find(command.begin(), command.end(), "--stream") != command.end();
    if (streamed) {  // a single NRRD cannot be streamed
      const Samples balls = merging_balls(12, 4);
      command[1] =
          write("balls.raw", {reinterpret_cast<const char*>(balls.values.data()), balls.values.size() * sizeof(float)});
      command.insert(command.end(), {"--raw", "12x12x12x4", "--raw-type", "float"});
    }
    SCOPED_TRACE(testing::PrintToString(command));
    expect_outside(command, range);
    const bool two = std::find(command.begin(), command.end(), "99,0") != command.end();
    if (std::find(command.begin(), command.end(), out) == command.end()) continue;
    if (two)
      EXPECT_GT(read_mesh(out).simplices.size(), 0U);
    else
      expect_empty_mesh("out.vtkhdf", 3);
  }
  expect_empty_mesh("cut.ply", 2);
  EXPECT_EQ(run_tegl({"view", balls_, "--iso", "99", "-o", path("page.html")}).exit, 5);
}

TEST_F(EmptyResults, OfImagesWithoutValuesAndWithOneValueAreErrorsUnlessAllowed) {
  const std::string nan = write("nan.nrrd", nrrd_bytes(sample({4, 4, 4}, [](auto&) { return NAN; })));
  expect_outside({"contour", nan, "--iso", "0", "-o", path("out.ply")}, "all samples are missing");
  const std::string flat = write("flat.nrrd", nrrd_bytes(sample({4, 4, 4}, [](auto&) { return 5.0; })));
  expect_outside({"contour", flat, "--iso", "5", "-o", path("out.ply")}, "all values are 5");
  expect_empty_mesh("out.ply", 2);
}

TEST_F(EmptyResults, OfAnIsovalueWithinValuesThatNeverMeetAreNone) {
  // Samples on both sides of the isovalue, separated by missing samples.
  const Samples split = sample({5, 4, 4}, [](auto& x) { return x[0] == 2 ? static_cast<double>(NAN) : x[0]; });
  const std::string file = write("split.nrrd", nrrd_bytes(split));
  const RunResult run = run_tegl({"contour", file, "--iso", "2", "-o", path("out.ply")});
  EXPECT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("no contour at 2: every active tile has a missing sample"));
  expect_empty_mesh("out.ply", 2);
  const std::string raw =
      write("split.raw", {reinterpret_cast<const char*>(split.values.data()), split.values.size() * sizeof(float)});
  const RunResult streamed =
      run_tegl({"contour", raw, "--raw", "5x4x4", "--raw-type", "float", "--iso", "2", "-o", path("out.vtkhdf")});
  EXPECT_EQ(streamed.exit, 0) << streamed.err;
  EXPECT_THAT(streamed.err, HasSubstr("no contour at 2"));
  expect_empty_mesh("out.vtkhdf", 2);
  const RunResult measured = run_tegl({"measure", file, "--iso", "2", "--json"});
  EXPECT_EQ(measured.json()["size"], 0);
}

TEST_F(EmptyResults, OfMeshesWhoseValuesNeverMeetAreNone) {
  // The middle points have no values: no triangle has points on both sides of the isovalue.
  std::string rows;
  for (int y = 0; y < 3; ++y)
    for (const char* const of_x : {"0,%,0", "1,%,", "2,%,4"})
      rows += std::string(of_x).replace(2, 1, std::to_string(y)) + "\n";
  const std::string missing = write("missing.csv", "x,y,v\n" + rows);
  // Two triangles without a common point, each with one value.
  const std::string apart = write(
      "apart.vtu",
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"6\" NumberOfCells=\"2\"><Points>"
      "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 5 0 0 6 0 0 5 1 0"
      "</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 4 5"
      "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 6</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5 5</DataArray></Cells><PointData>"
      "<DataArray type=\"Float32\" Name=\"v\" format=\"ascii\">0 0 0 4 4 4</DataArray></PointData></Piece>"
      "</UnstructuredGrid></VTKFile>");
  const std::string of_missing = "no contour at 2: no cell without missing values has values on both sides of it";
  const std::string of_apart = "no contour at 2: no cell has values on both sides of it";
  for (const auto& [file, text] : {std::pair(missing, of_missing), std::pair(apart, of_apart)}) {
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"contour", file, "--iso", "2", "-o", path("out.vtkhdf")},
          std::vector<std::string>{"contour", file, "--iso", "2", "--facets", "-o", path("out.vtu")},
          std::vector<std::string>{"measure", file, "--iso", "2"}}) {
      const RunResult run = run_tegl(command);
      EXPECT_EQ(run.exit, 0) << run.err;
      EXPECT_THAT(run.err, HasSubstr(text));
    }
    expect_empty_mesh("out.vtkhdf", 1);
    // outside of the values, which is allowed: no remark
    EXPECT_EQ(run_tegl({"contour", file, "--iso", "9", "--allow-empty", "-o", path("out.vtkhdf")}).err, "");
  }
}

TEST_F(EmptyResults, OfCutsOutsideOfTheExtentAreErrorsUnlessAllowed) {
  ASSERT_EQ(run_tegl({"contour", balls_, "--iso", "0", "-o", path("saved.vtkhdf")}).exit, 0);
  const std::string saved = path("saved.vtkhdf");
  for (const std::string& at : {std::string("t=-0.5"), std::string("t=3.5"), std::string("x=99")}) {
    expect_outside({"slice", balls_, "--iso", "0", "--at", at, "-o", path("cut.ply")}, "lies outside of the image");
    expect_empty_mesh("cut.ply", 2);
    expect_outside({"slice", saved, "--at", at, "-o", path("cut.ply")}, "lies outside of the saved contour");
    expect_empty_mesh("cut.ply", 2);
  }
  // a list with one cut outside: no file is written, not even for the cuts before it
  for (const std::string& at : {std::string("t=1,2,99"), std::string("t=98,99"), std::string("t=1:99:3")}) {
    const RunResult of_image = run_tegl({"slice", balls_, "--iso", "0", "--at", at, "-o", path("list_{n}.ply")});
    EXPECT_EQ(of_image.exit, 5) << of_image.err;
    EXPECT_THAT(of_image.err, HasSubstr("lies outside of the image; expected 0 <= t <= 3"));
    const RunResult of_saved = run_tegl({"slice", saved, "--at", at, "-o", path("list_{n}.ply")});
    EXPECT_EQ(of_saved.exit, 5) << of_saved.err;
    EXPECT_THAT(of_saved.err, HasSubstr("lies outside of the saved contour"));
    for (const char* const name : {"list_1.ply", "list_2.ply", "list_3.ply"})
      EXPECT_FALSE(std::filesystem::exists(path(name))) << at;
  }
  expect_outside({"slice", balls_, "--iso", "0", "--at", "t=1,2,99", "-o", path("list_{n}.ply")},
                 "the slice at t = 99");
  EXPECT_FALSE(read_mesh(path("list_1.ply")).simplices.empty());
  expect_empty_mesh("list_3.ply", 2);
  expect_outside({"slice", balls_, "--iso", "0", "--plane", "1,0,0,1=99", "-o", path("cut.ply")},
                 "the slice at x + t = 99 lies outside of the image; expected 0 <= x + t <= 14");
  expect_outside({"slice", saved, "--plane", "1,0,0,1=99", "-o", path("cut.ply")}, "lies outside of the saved contour");
  const RunResult image = expect_outside({"measure", balls_, "--iso", "0", "--at", "t=3.5", "--json"},
                                         "the slice at t = 3.5 lies outside of the image; expected 0 <= t <= 3");
  EXPECT_EQ(image.json()["cuts"][0]["size"], 0);
  expect_outside({"measure", saved, "--at", "t=3.5"}, "lies outside of the saved contour");
}

TEST_F(EmptyResults, OfCutsWithinTheExtentWhereNothingIsAreNone) {
  // A ball that exists around t = 1 only.
  const Samples flash = sample({7, 7, 7, 5}, [](const std::vector<double>& x) {
    return 2.2 - std::hypot(x[0] - 3, x[1] - 3, x[2] - 3) - 3 * std::abs(x[3] - 1);
  });
  const std::string file = write("flash.nrrd", nrrd_bytes(flash));
  const RunResult run = run_tegl({"slice", file, "--iso", "0", "--at", "t=1,3", "-o", path("{t}.ply"), "--json"});
  EXPECT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_GT(run.json()[0]["simplices"], 0);
  EXPECT_EQ(run.json()[1]["simplices"], 0);
  expect_empty_mesh("3.ply", 2);
  const RunResult measured = run_tegl({"measure", file, "--iso", "0", "--at", "t=1,3", "--json"});
  EXPECT_EQ(measured.exit, 0) << measured.err;
  EXPECT_GT(measured.json()["cuts"][0]["size"], 0);
  EXPECT_EQ(measured.json()["cuts"][1]["size"], 0);
}

TEST_F(EmptyResults, AreReadAgainByEveryCommandThatAllowsThem) {
  ASSERT_EQ(run_tegl({"contour", balls_, "--iso", "99", "--allow-empty", "-o", path("none.vtkhdf")}).exit, 0);
  const std::string none = path("none.vtkhdf");
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"slice", none, "--at", "t=1", "-o", path("cut.ply")},
           {"project", none, "-o", path("sweep.ply")},
           {"components", none},
           {"measure", none},
           {"elements", none, "-o", path("e.dat")},
           {"track", none},
           {"simplify", none, "--ratio", "0.5", "-o", path("less.vtkhdf")},
           {"simplify", none, "--max-error", "0.5", "--scale", "auto", "-o", path("less.vtkhdf")}})
    expect_outside(command, "the saved contour is empty");
}

TEST_F(EmptyResults, DoNotExcuseAnAxisScaledTwice) {
  for (const std::vector<std::string>& scale :
       std::vector<std::vector<std::string>>{{"--scale", "t=1,t=2"}, {"--scale", "t=1", "--scale", "T=2"}}) {
    std::vector<std::string> arguments = {"slice", balls_, "--iso", "0", "--at", "t=1", "-o", path("cut.ply")};
    arguments.insert(arguments.end(), scale.begin(), scale.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 2);
    EXPECT_THAT(run.err, HasSubstr("--scale has the axis t twice"));
  }
  EXPECT_EQ(run_tegl({"index", balls_, "--method", "seed-set", "--scan-order", "0,0,1,2"}).exit, 2);
}

TEST_F(EmptyResults, OfAMeshWithoutVisibleCellsAreErrorsUnlessAllowed) {
  const std::string mesh = write(
      "hidden.vtu",
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points>"
      "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray>"
      "</Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells><PointData>"
      "<DataArray type=\"Float32\" Name=\"v\" format=\"ascii\">0 1 1 1</DataArray></PointData><CellData>"
      "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">32</DataArray></CellData></Piece>"
      "</UnstructuredGrid></VTKFile>");
  std::vector<std::string> command = {"contour", mesh, "--iso", "0.5", "-o", path("out.vtkhdf")};
  const RunResult refused = run_tegl(command);
  EXPECT_EQ(refused.exit, 5);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("hidden"), HasSubstr("--allow-empty")));
  command.emplace_back("--allow-empty");
  EXPECT_EQ(run_tegl(command).exit, 0);
  expect_empty_mesh("out.vtkhdf", 2);
}

}  // namespace
}  // namespace tegl::test
