// SPDX-License-Identifier: BSD-3-Clause
//
// Raw values with coordinates, names and units of their axes, written to every format.
#include <gmock/gmock.h>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class Raw : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const Samples samples = ball({12, 10, 9}, 3);
    raw_ = write("ball.raw",
                 {reinterpret_cast<const char*>(samples.values.data()), samples.values.size() * sizeof(float)});
    nrrd_ = write("ball.nrrd", nrrd_bytes(samples));
  }
  /// Runs `tegl contour` of the raw file at isovalue 0.
  [[nodiscard]] RunResult contour(const std::string& output, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"contour", raw_,    "--raw", "12x10x9", "--raw-type",
                                          "float",   "--iso", "0",     "-o",      path(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tegl(arguments);
  }
  std::string raw_, nrrd_;
};

TEST_F(Raw, GoesIntoTheFormatsThatNeedTheWholeContour) {
  for (const std::string extension : {".ply", ".obj", ".stl", ".glb", ".vtkhdf"}) {
    const RunResult run = contour("raw" + extension, {});
    ASSERT_EQ(run.exit, 0) << run.err;
    ASSERT_EQ(run_tegl({"contour", nrrd_, "--iso", "0", "-o", path("whole" + extension)}).exit, 0);
    const Mesh mesh = read_mesh(path("raw" + extension));
    const Mesh whole = read_mesh(path("whole" + extension));
    EXPECT_EQ(mesh.simplices, whole.simplices);
    EXPECT_EQ(mesh.coordinates, whole.coordinates);
  }
}

TEST_F(Raw, TakesOptionsThatNeedTheImageInMemory) {
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--normals", "flat"},
                                             {"--pick", "5,5,5"},
                                             {"--triangulation", "halving-chord"},
                                             {"--iso", "1", "--one-file"},
                                             {"--attribute", nrrd_},
                                             {"--facets"}}) {
    const RunResult run = contour("out.vtkhdf", more);
    EXPECT_EQ(run.exit, 0) << more[0] << ": " << run.err;
  }
  ASSERT_EQ(run_tegl({"index", raw_, "--raw", "12x10x9", "--raw-type", "float", "-o", path("a.tindex")}).exit, 0);
  EXPECT_EQ(contour("out.vtkhdf", {"--index", path("a.tindex")}).exit, 0);
  EXPECT_EQ(contour("out.ply", {"--stream"}).exit, 6) << "what was requested cannot be";
}

TEST_F(Raw, HasTheSpacingOriginNamesAndUnitsOfItsAxes) {
  const std::vector<std::string> layout = {"--spacing",    "0.5,2,-3",       "--origin",     "10,-4,7",
                                           "--axis-names", "lon,lat,height", "--axis-units", "deg,deg,m"};
  for (const std::string name : {"raw.ply", "raw.vtkhdf"}) {
    SCOPED_TRACE(name);
    ASSERT_EQ(contour("plain_" + name, {}).exit, 0);
    const RunResult run = contour(name, layout);
    ASSERT_EQ(run.exit, 0) << run.err;
    const Mesh plain = read_mesh(path("plain_" + name));
    const Mesh mesh = read_mesh(path(name));
    EXPECT_EQ(mesh.axis_names, (std::vector<std::string>{"lon", "lat", "height"}));
    EXPECT_EQ(mesh.axis_units, (std::vector<std::string>{"deg", "deg", "m"}));
    ASSERT_EQ(mesh.coordinates.size(), plain.coordinates.size());
    for (std::size_t v = 0; v < mesh.coordinates.size(); v += 3) {
      EXPECT_NEAR(mesh.coordinates[v], 10 + 0.5 * plain.coordinates[v], 1e-12);
      EXPECT_NEAR(mesh.coordinates[v + 1], -4 + 2 * plain.coordinates[v + 1], 1e-12);
      EXPECT_NEAR(mesh.coordinates[v + 2], 7 - 3 * plain.coordinates[v + 2], 1e-12);
    }
  }
  // One number applies to all axes; --step is an alias.
  ASSERT_EQ(contour("half.ply", {"--step", "0.5"}).exit, 0);
  EXPECT_NEAR(run_tegl({"measure", path("half.ply"), "--json"}).json()["size"].get<double>() * 4,
              run_tegl({"measure", path("plain_raw.ply"), "--json"}).json()["size"].get<double>(), 1e-6);
}

TEST_F(Raw, RemarksOnBytesAfterTheLastSample) {
  // without the last layer: 12 x 10 floats are left over
  const std::string remark = raw_ + ": 480 of 4320 bytes follow the last of 12 x 10 x 8 samples of type float";
  const std::vector<std::string> layout = {"--raw", "12x10x8", "--raw-type", "float"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), layout.begin(), layout.end());
    return run_tegl(arguments);
  };
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"info", raw_},
                                             {"contour", raw_, "--iso", "0", "-o", path("short.ply")},
                                             {"contour", raw_, "--iso", "0", "-o", path("streamed.vtkhdf"), "--stream"},
                                             {"slice", raw_, "--iso", "0", "--at", "z=4", "-o", path("slice.ply")},
                                             {"measure", raw_, "--iso", "0"},
                                             {"components", raw_, "--iso", "0"},
                                             {"index", raw_, "-o", path("a.tindex")}}) {
    const RunResult short_of_layer = run(arguments);
    EXPECT_EQ(short_of_layer.exit, 0) << short_of_layer.err;
    EXPECT_THAT(short_of_layer.err, HasSubstr(remark)) << arguments[0];
  }
  EXPECT_EQ(run({"info", raw_, "--json"}).json()["remarks"][0], remark + ", and are ignored");
  EXPECT_EQ(run_tegl({"info", raw_, "--raw", "12x10x9", "--raw-type", "float"}).err, "") << "a file that fits";
  EXPECT_EQ(run({"info", raw_, "--raw-offset", "480"}).err, "") << "bytes before the first sample are skipped";
}

TEST_F(Raw, RemarksOnBytesOfAllFilesOfASeries) {
  std::vector<std::string> files;
  // the samples of a file are equal, and larger than in the file before
  for (const std::size_t rest : {0U, 8U, 4U, 4U, 4U})
    files.push_back(write("step_" + std::to_string(files.size()) + ".raw",
                          std::string(4 * 6 + rest, static_cast<char>(1 + files.size()))));
  const auto remark = [&](std::vector<std::size_t> chosen) {
    std::vector<std::string> arguments = {"info", "--json", "--raw", "3x2", "--raw-type", "float"};
    for (const std::size_t file : chosen) arguments.push_back(files[file]);
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    const nlohmann::json remarks = run.json()["remarks"];
    EXPECT_LE(remarks.size(), 1u);
    return remarks.empty() ? std::string() : remarks[0].get<std::string>();
  };
  const std::string samples = " follow the last of 3 x 2 samples of type float, and are ignored";
  EXPECT_EQ(remark({0, 2}), files[2] + ": 4 of 28 bytes" + samples);
  EXPECT_EQ(remark({2, 0, 3}), files[2] + ", " + files[3] + ": 4 bytes of each" + samples);
  EXPECT_EQ(remark({1, 2, 3}), files[1] + ", " + files[2] + ", " + files[3] + ": 4 to 8 bytes of each" + samples);
  EXPECT_EQ(remark({0, 1, 2, 3, 4}), "4 of 5 files, the first " + files[1] + ": 4 to 8 bytes of each" + samples);
  EXPECT_EQ(run_tegl({"info", "--raw", "3x2", "--raw-type", "float", "--raw-offset", "4", files[2], files[3]}).err, "");
  const RunResult streamed = run_tegl({"contour", "--stream", "--raw", "3x2", "--raw-type", "float", files[0], files[2],
                                       files[3], "--iso", "1e-37", "-o", path("series.vtkhdf")});
  EXPECT_EQ(streamed.exit, 0) << streamed.err;
  EXPECT_THAT(streamed.err, HasSubstr(files[2] + ", " + files[3] + ": 4 bytes of each" + samples));
}

TEST_F(Raw, NamesWhatDoesNotFitItsSizes) {
  const auto expect_refused = [&](const std::vector<std::string>& more, const std::string& text) {
    const RunResult run = contour("out.ply", more);
    EXPECT_EQ(run.exit, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr(text));
  };
  expect_refused({"--spacing", "1,2"}, "--spacing 1,2 has 2 parts; expected 3, one for each axis of --raw 12x10x9");
  expect_refused({"--spacing", "1,0,2"}, "--spacing is '1,0,2'; expected no 0");
  expect_refused({"--spacing", "1,x,2"}, "--spacing is 'x'");
  expect_refused({"--origin", "1,2,3,4"}, "--origin 1,2,3,4 has 4 parts");
  expect_refused({"--origin", "1e308", "--spacing", "1e308"}, "expected coordinates that are finite");
  expect_refused({"--axis-names", "a,b"}, "--axis-names a,b has 2 parts");
  expect_refused({"--axis-names", "a,b,A"}, "--axis-names has the axis A twice");
  EXPECT_THAT(run_tegl({"contour", nrrd_, "--iso", "0", "--spacing", "2", "-o", path("out.ply")}).err,
              HasSubstr("--spacing without --raw; expected both"));
}

}  // namespace
}  // namespace tegl::test
