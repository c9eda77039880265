// SPDX-License-Identifier: BSD-3-Clause
//
// --periodic of tegl contour and of commands that contour an image, curved grids, and options of contours of meshes,
// run as in a shell.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "sample_files.hpp"
#include "tegl/check.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class PeriodicCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    // a ball of radius 5 around x = 0, half of it at the other end
    file_ = write("ball.nii", nifti_bytes(sample({30, 20, 20},
                                                 [](const std::vector<double>& x) {
                                                   return 5.0 -
                                                          std::hypot(std::min(x[0], 30 - x[0]), x[1] - 9.5, x[2] - 9.5);
                                                 }),
                                          {1, 1, 1}));
  }
  [[nodiscard]] nlohmann::json run_json(std::vector<std::string> arguments) const {
    arguments.emplace_back("--json");
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  }
  void expect_refused(std::vector<std::string> arguments, const std::string& message) const {
    arguments.insert(arguments.begin(), {"contour", file_, "--iso", "0"});
    const RunResult run = run_tegl(arguments);
    EXPECT_NE(run.exit, 0);
    EXPECT_THAT(run.err, HasSubstr(message));
  }
  std::string file_;
};

TEST_F(PeriodicCommand, ABallAcrossTheSeamIsOneComponentAlsoFromASavedContour) {
  EXPECT_EQ(run_json({"components", file_, "--iso", "0"})["count"], 2);
  const nlohmann::json direct = run_json({"components", file_, "--iso", "0", "--periodic", "x"});
  EXPECT_EQ(direct["count"], 1);
  const std::string saved = path("ball.vtkhdf");
  (void)run_json({"contour", file_, "--iso", "0", "--periodic", "x=30", "-o", saved});
  const nlohmann::json components = run_json({"components", saved});
  EXPECT_EQ(components["count"], 1);
  EXPECT_EQ(components["components"], direct["components"]);
  EXPECT_EQ(run_json({"check", "--intersections", saved})["intersections"]["pairs"], 0);
  const nlohmann::json measure = run_json({"measure", saved});
  EXPECT_NEAR(measure["content"].get<double>(), 4.0 / 3.0 * std::numbers::pi * 125, 15);
}

TEST_F(PeriodicCommand, CloseAndNormalsWorkAcrossTheSeam) {
  const std::string output = path("closed.vtkhdf");
  (void)run_json({"contour", file_, "--iso", "-8", "--periodic", "x", "--close", "--normals", "-o", output});
  const Mesh mesh = read_mesh(output);
  EXPECT_EQ(check(to_contour<3>(mesh)).boundary_simplices, 0u);
  EXPECT_FALSE(mesh.normals.empty());
}

TEST_F(PeriodicCommand, OtherFormatsGetTheUnrolledContourWithItsMap) {
  for (const char* const name : {"ball.ply", "ball.vtkhdf"}) {
    const std::string output = path(name);
    (void)run_json({"contour", file_, "--iso", "0", "--periodic", "x", "--unroll", "-o", output});
    const Mesh mesh = read_mesh(output);
    EXPECT_TRUE(mesh.periods.empty());
    EXPECT_GT(check(to_contour<3>(mesh)).boundary_simplices, 0u);
    ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
    EXPECT_EQ(mesh.vertex_attributes[0].name, "original");
  }
}

TEST_F(PeriodicCommand, WrongAxesAndOtherOptionsAreRefused) {
  const std::string output = path("none.vtkhdf");
  expect_refused({"--periodic", "w", "-o", output}, "--periodic w names no axis; expected one of x, y, z, or all");
  expect_refused({"--periodic", "x,x", "-o", output}, "twice");
  expect_refused({"--periodic", "x=20", "-o", output}, "expected more than 29");
  expect_refused({"--periodic", "x=much", "-o", output}, "--periodic");
  expect_refused({"--periodic", "x", "--stream", "-o", output}, "--periodic x with --stream");
  expect_refused({"--periodic", "x", "--facets", "-o", output}, "--periodic x with --facets");
  expect_refused({"--periodic", "x", "--pick", "1,2,3", "-o", output}, "--periodic x with --pick");
  expect_refused({"--unroll", "-o", output}, "--unroll without --periodic");
  const std::string saved = path("ball.vtkhdf");
  (void)run_json({"contour", file_, "--iso", "0", "--periodic", "x", "-o", saved});
  const RunResult run = run_tegl({"simplify", saved, "--ratio", "0.5", "-o", path("few.vtkhdf")});
  EXPECT_NE(run.exit, 0);
  EXPECT_THAT(run.err, HasSubstr("a wrapped contour"));
}

TEST_F(PeriodicCommand, SlicesOfASavedContourAreWrappedToo) {
  const std::string saved = path("ball.vtkhdf");
  (void)run_json({"contour", file_, "--iso", "0", "--periodic", "x", "-o", saved});
  (void)run_json({"slice", saved, "--at", "z=9.5", "-o", path("circle.vtkhdf")});
  const Mesh circle = read_mesh(path("circle.vtkhdf"));
  EXPECT_EQ(circle.periods.size(), 5u);
  EXPECT_EQ(check(to_contour<2>(circle)).boundary_simplices, 0u);
  const RunResult run = run_tegl({"slice", saved, "--at", "x=1", "-o", path("none.ply")});
  EXPECT_NE(run.exit, 0);
  EXPECT_THAT(run.err, HasSubstr("across one of its periods"));
}

TEST_F(PeriodicCommand, ALatticeHasItsOwnCells) {
  const std::string ball =
      write("fcc.nii", nifti_bytes(sample({20, 20, 28},
                                          [](const std::vector<double>& x) {
                                            const double shift = static_cast<int>(x[2]) % 2 == 0 ? 0.0 : 0.5;
                                            return 6.0 - std::hypot(x[0] + shift - 9.75, x[1] + shift - 9.75,
                                                                    std::sqrt(0.5) * (x[2] - 13.5));
                                          }),
                                   {1, 1, std::sqrt(0.5F)}));
  const std::string output = path("ball.ply");
  const nlohmann::json report = run_json({"contour", ball, "--iso", "0", "--lattice", "fcc", "-o", output});
  EXPECT_EQ(report["tiles"], 19 * 19 * 26 + 2 * 19 * 19 + 27 * 2 * 19 * 19);
  const MeshReport sphere = check(to_contour<3>(read_mesh(output)));
  EXPECT_EQ(sphere.euler, 2);
  EXPECT_EQ(sphere.boundary_simplices, 0u);
  const nlohmann::json measure = run_json({"measure", ball, "--iso", "0", "--lattice", "fcc"});
  EXPECT_NEAR(measure["content"].get<double>(), 4.0 / 3.0 * std::numbers::pi * 216, 20);
  expect_refused({"--lattice", "d4", "-o", output}, "lattice d4 of a 3D image; expected 4 dimensions");
  expect_refused({"--lattice", "hexagonal", "-o", output}, "hexagonal");
  expect_refused({"--lattice", "bcc", "--periodic", "x", "-o", output}, "--periodic x with --lattice bcc");
  expect_refused({"--lattice", "bcc", "--close", "-o", output}, "close");
  expect_refused({"--lattice", "bcc", "--facets", "-o", output}, "--lattice bcc with --facets");
  expect_refused({"--lattice", "bcc", "--normals=sobel", "-o", output}, "normals on a lattice by a kernel");
  (void)run_json({"contour", ball, "--iso", "0", "--lattice", "fcc", "--normals", "-o", output});
  EXPECT_FALSE(read_mesh(output).normals.empty());
}

TEST_F(PeriodicCommand, CellsMayBeDivided) {
  const std::string output = path("divided.ply");
  for (const auto& [division, cells] : {std::pair{"kuhn", 6}, {"alternating", 5}, {"symmetric", 24}, {"hybrid", 1}}) {
    const nlohmann::json report = run_json({"contour", file_, "--iso", "0", "--division", division, "-o", output});
    EXPECT_EQ(report["tiles"], cells * 29 * 19 * 19) << division;
    EXPECT_EQ(check(to_contour<3>(read_mesh(output))).components, 2u);
  }
  expect_refused({"--division", "kuhn", "--lattice", "bcc", "-o", output}, "--lattice bcc with --division kuhn");
  expect_refused({"--division", "kuhn", "--periodic", "x", "-o", output}, "--periodic x with --division kuhn");
  expect_refused({"--division", "kuhn", "--stream", "-o", output}, "--division kuhn with --stream");
  expect_refused({"--division", "random", "-o", output}, "random");
}

TEST_F(PeriodicCommand, MeshesAreClosedAndHaveNormalsFromTheGradient) {
  std::string text = R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="8" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="f" format="ascii">0 1 0 1 0 1 0 1</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">)";
  for (const char* const corner : {"0 0 0 ", "1 0 0 ", "0 1 0 ", "1 1 0 ", "0 0 1 ", "1 0 1 ", "0 1 1 ", "1 1 1 "})
    text += corner;
  text += R"(</DataArray></Points><Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7
</DataArray><DataArray type="Int64" Name="offsets" format="ascii">8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">11</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";
  const std::string file = write("cell.vtu", text), saved = path("half.vtkhdf");
  (void)run_json(
      {"contour", file, "--iso", "0.25", "--close", "--ambiguity", "saddle", "--normals", "gradient", "-o", saved});
  const Mesh half = read_mesh(saved);
  ASSERT_EQ(half.normals.size(), half.coordinates.size());
  for (std::size_t v = 0; v < half.normals.size(); v += 3) EXPECT_NEAR(half.normals[v], -1.0, 1e-12);
  const nlohmann::json measure = run_json({"measure", saved});
  EXPECT_NEAR(measure["content"].get<double>(), 0.75, 1e-12);
  const RunResult run = run_tegl({"contour", file, "--iso", "0.25", "--normals", "sobel", "-o", saved});
  EXPECT_NE(run.exit, 0);
  EXPECT_THAT(run.err, HasSubstr("--normals sobel with"));
}

}  // namespace
}  // namespace tegl::test
