// SPDX-License-Identifier: BSD-3-Clause
//
// --periodic of tegl contour and of commands that contour an image, curved grids, lattices and divisions, run as in a
// shell.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "sample_files.hpp"
#include "tegl/check.hpp"
#include "tegl/io.hpp"
#include "tegl/measure.hpp"
#include "tegl/periodic.hpp"
#include "tegl/slice.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;
using testing::Not;

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
    expect_refused_of(file_, std::move(arguments), message);
  }
  void expect_refused_of(const std::string& file, std::vector<std::string> arguments,
                         const std::string& message) const {
    arguments.insert(arguments.begin(), {"contour", file, "--iso", "0"});
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
  expect_refused({"--periodic", "x", "--stream", "--unroll", "-o", output}, "--unroll with --stream");
  expect_refused({"--periodic", "w", "--stream", "-o", output}, "--periodic w names no axis");
  expect_refused({"--periodic", "x=20", "--stream", "-o", output}, "expected more than 29");
  expect_refused({"--periodic", "x", "--facets", "--unroll", "-o", output}, "--unroll with --facets");
  expect_refused({"--periodic", "x=20", "--facets", "-o", output}, "expected more than 29");
  for (const char* const option : {"--no-check", "--stream", "--facets"})  // a period in another unit
    expect_refused({"--periodic", "x=100", option, "-o", output},
                   "the period of axis 0 (x) is 100, and the step across the seam, from 29 to 100, is 71; expected");
  expect_refused({"--periodic", "x", "--triangulation", "fan", "-o", output}, "--periodic x with a triangulation");
  expect_refused({"--periodic", "x", "--pick", "1,2,3", "-o", output}, "--periodic x with --pick");
  expect_refused({"--unroll", "-o", output}, "--unroll without --periodic");
}

TEST_F(PeriodicCommand, StreamedContoursAreThoseInMemory) {
  for (const char* const axes : {"x", "z", "x,y,z"}) {
    const std::string streamed = path("streamed.vtkhdf"), in_memory = path("memory.vtkhdf");
    const std::vector<std::string> options = {"contour", file_,     "--iso",     "-4",      "--periodic",
                                              axes,      "--close", "--normals", "gradient"};
    auto stream = options, memory = options;
    stream.insert(stream.end(), {"--stream", "-o", streamed});
    memory.insert(memory.end(), {"-o", in_memory});
    const nlohmann::json report = run_json(stream);
    (void)run_json(memory);
    const Mesh one = read_mesh(streamed), other = read_mesh(in_memory);
    EXPECT_EQ(report["vertices"].get<std::size_t>(), other.coordinates.size() / 3) << axes;
    EXPECT_EQ(one.periods, other.periods);
    EXPECT_EQ(one.normals.size(), other.normals.size());
    const auto contour = to_contour<3>(one);
    EXPECT_EQ(check(contour).boundary_simplices, 0u);
    EXPECT_EQ(check(contour).euler, check(to_contour<3>(other)).euler);
    EXPECT_NEAR(measure(contour).size, measure(to_contour<3>(other)).size, 1e-9);
    EXPECT_EQ(run_json({"components", streamed})["components"], run_json({"components", in_memory})["components"]);
  }
}

TEST_F(PeriodicCommand, FacetsAreClosedAcrossTheSeam) {
  for (const char* const axes : {"x", "x,y,z"})
    for (const char* const name : {"facets.vtu", "facets.vtkhdf"}) {
      const std::string output = path(name);
      const nlohmann::json facets =
          run_json({"contour", file_, "--iso", "0", "--periodic", axes, "--facets", "-o", output});
      const nlohmann::json simplices =
          run_json({"contour", file_, "--iso", "0", "--periodic", axes, "-o", path("simplices.vtkhdf")});
      for (const char* const key : {"euler", "components", "tiles", "active_tiles"})
        EXPECT_EQ(facets[key], simplices[key]) << axes << " " << key;
      EXPECT_EQ(facets["components"], 1);
      EXPECT_EQ(facets["boundary_facets"], 0);
      std::ifstream file(output, std::ios::binary);
      EXPECT_THAT(std::string(std::istreambuf_iterator<char>(file), {}), HasSubstr("periods"));
    }
}

TEST_F(PeriodicCommand, SlicesOfASavedContourAreWrappedToo) {
  const std::string saved = path("ball.vtkhdf");
  (void)run_json({"contour", file_, "--iso", "0", "--periodic", "x", "-o", saved});
  (void)run_json({"slice", saved, "--at", "z=9.5", "-o", path("circle.vtkhdf")});
  const Mesh circle = read_mesh(path("circle.vtkhdf"));
  EXPECT_EQ(circle.periods.size(), 5u);
  EXPECT_EQ(check(to_contour<2>(circle)).boundary_simplices, 0u);
  // across the period: both ends of the unrolled contour
  (void)run_json({"slice", saved, "--at", "x=1", "-o", path("across.vtkhdf")});
  const Mesh across = read_mesh(path("across.vtkhdf"));
  EXPECT_TRUE(across.periods.empty());
  EXPECT_NEAR(*measure(to_contour<2>(across)).content, std::numbers::pi * 24, 1.5);
}

TEST_F(PeriodicCommand, CommandsForPlainContoursUnrollWrappedOnes) {
  const std::string saved = path("ball.vtkhdf"), fewer = path("few.vtkhdf");
  (void)run_json({"contour", file_, "--iso", "0", "--periodic", "x", "-o", saved});
  const RunResult run = run_tegl({"simplify", saved, "--ratio", "0.5", "-o", fewer});
  EXPECT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the contour is unrolled"));
  EXPECT_EQ(check(to_contour<3>(read_mesh(fewer))).components, 2u);
  const nlohmann::json direct =
      run_json({"simplify", file_, "--iso", "0", "--periodic", "x", "--ratio", "0.5", "-o", fewer});
  EXPECT_EQ(direct["vertices"], read_mesh(fewer).coordinates.size() / 3);
  // cuts of a contour that does not wind round, with what they enclose
  const nlohmann::json cuts = run_json({"measure", saved, "--at", "z=9.5,12"});
  EXPECT_NEAR(cuts["cuts"][0]["content"].get<double>(), std::numbers::pi * 25, 2);
  EXPECT_NEAR(cuts["cuts"][1]["content"].get<double>(), std::numbers::pi * (25 - 6.25), 2);
  EXPECT_EQ(run_json({"measure", file_, "--iso", "0", "--periodic", "x", "--at", "z=9.5,12"})["cuts"], cuts["cuts"]);
  // and across a period; along x, the ball ends at the samples 0 and 29
  const nlohmann::json across = run_json({"measure", file_, "--iso", "0", "--periodic", "z", "--at", "z=9.5"});
  EXPECT_NEAR(across["cuts"][0]["size"].get<double>(), 5 * std::numbers::pi + 10 * std::acos(0.2), 0.5);
  // a component that does not wind round encloses a volume
  const nlohmann::json all = run_json({"measure", file_, "--iso", "0", "--periodic", "all"});
  EXPECT_NEAR(all["content"].get<double>(), 4.0 / 3.0 * std::numbers::pi * 125, 15);
}

TEST_F(PeriodicCommand, CutsAcrossAPeriodAreModuloThePeriod) {
  const std::string saved = path("ball.vtkhdf");
  const auto z_last = [&](const std::string& name, double center) {
    return write(name, nifti_bytes(sample({20, 20, 30},
                                          [=](const std::vector<double>& x) {
                                            const double apart = std::abs(x[2] - center);
                                            return 5.0 -
                                                   std::hypot(x[0] - 9.5, x[1] - 9.5, std::min(apart, 30 - apart));
                                          }),
                                   {1, 1, 1}));
  };
  const std::string ball = z_last("last.nii", 0);
  (void)run_json({"contour", ball, "--iso", "0", "--periodic", "z", "-o", saved});
  for (const std::vector<std::string>& input :
       {std::vector<std::string>{saved}, {ball, "--iso", "0", "--periodic", "z"}}) {
    std::vector<std::string> measured = {"measure"};
    measured.insert(measured.end(), input.begin(), input.end());
    const auto cuts = [&](const std::string& option, const std::string& value) {
      std::vector<std::string> arguments = measured;
      arguments.insert(arguments.end(), {option, value});
      return run_json(arguments)["cuts"];
    };
    const nlohmann::json at = cuts("--at", "z=-1,1,29,29.5,31,-2.5,27.5,57.5");
    for (const std::size_t i : {0U, 1U, 2U, 4U})
      EXPECT_NEAR(at[i]["content"].get<double>(), std::numbers::pi * 24, 1.5) << i;
    EXPECT_EQ(at[0]["value"], -1);
    EXPECT_EQ(at[0]["content"], at[2]["content"]);
    EXPECT_EQ(at[1]["content"], at[4]["content"]);
    EXPECT_NEAR(at[3]["content"].get<double>(), std::numbers::pi * 24.75, 1.5);
    EXPECT_EQ(at[5]["content"], at[6]["content"]);
    EXPECT_EQ(at[7]["content"], at[6]["content"]);
    // from the start to the end of the period: the ball is at both
    const nlohmann::json samples = cuts("--samples", "31");
    for (std::size_t i = 0; i < 31; ++i) {
      const double z = std::min<double>(static_cast<double>(i), 30 - static_cast<double>(i));
      EXPECT_NEAR(samples[i]["value"].get<double>(), static_cast<double>(i), 1e-9);
      EXPECT_NEAR(samples[i]["content"].get<double>(), z < 5 ? std::numbers::pi * (25 - z * z) : 0.0, 2) << i;
    }
    std::vector<std::string> arguments = measured;
    arguments.insert(arguments.end(), {"--at", "z=1"});
    EXPECT_THAT(run_tegl(arguments).err, Not(HasSubstr("unrolled")));
    // slices, also between the last sample and the end of the period
    for (const auto& [option, place] :
         {std::pair("--at", "z=29.5"), std::pair("--at", "z=-0.5"), std::pair("--at", "z=59.5"),
          std::pair("--plane", "0,0,1=59.5"), std::pair("--plane", "0,0,-2=1")}) {
      arguments = {"slice"};
      arguments.insert(arguments.end(), input.begin(), input.end());
      arguments.insert(arguments.end(), {option, place, "-o", path("cut.vtkhdf")});
      const RunResult run = run_tegl(arguments);
      EXPECT_EQ(run.exit, 0) << run.err;
      EXPECT_THAT(run.err, Not(HasSubstr("unrolled")));
      EXPECT_NEAR(*measure(to_contour<2>(read_mesh(path("cut.vtkhdf")))).content, std::numbers::pi * 24.75, 1.5);
    }
  }
  // no period is crossed along y, where places are refused as before
  const RunResult run = run_tegl({"slice", saved, "--at", "y=-1", "-o", path("cut.vtkhdf")});
  EXPECT_NE(run.exit, 0);
  EXPECT_THAT(run.err, HasSubstr("lies outside of the saved contour"));
}

TEST_F(PeriodicCommand, PlacesOnAShearedAxisAndLatticePlanesCutTheRepetition) {
  OwnedImage<double, 3> image;
  image.grid.linear[0][2] = 0.3;
  for (Axis& axis : image.grid.axes) axis = Axis::uniform(24, 0.0, 1.0 / 24);
  const auto field = [](double x, double y, double z) {
    const double turn = 2 * std::numbers::pi;
    return std::sin(turn * (x - 0.3 * z)) + 0.7 * std::cos(turn * y) + 0.8 * std::sin(turn * z + 0.5);
  };
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i) image.values.push_back(field(i / 24.0 + 0.3 * k / 24.0, j / 24.0, k / 24.0));
  const std::string file = path("sheared.nrrd"), saved = path("sheared.vtkhdf"), output = path("cut.vtkhdf");
  write_image(image.view(), file);
  (void)run_json({"contour", file, "--iso", "0.4", "--periodic", "all", "-o", saved});
  for (const std::vector<std::string>& input :
       {std::vector<std::string>{saved}, {file, "--iso", "0.4", "--periodic", "all"}}) {
    const auto cut_by = [&](const std::string& option, const std::string& value) {
      std::vector<std::string> arguments = {"slice"};
      arguments.insert(arguments.end(), input.begin(), input.end());
      arguments.insert(arguments.end(), {option, value, "-o", output});
      const RunResult run = run_tegl(arguments);
      EXPECT_EQ(run.exit, 0) << run.err;
      EXPECT_THAT(run.err, Not(HasSubstr("unrolled")));
      return to_contour<2>(read_mesh(output));
    };
    const double size = measure(cut_by("--at", "z=0.2")).size;
    for (const double z : {0.2, 1.2, -0.8, 5.2})
      for (const auto& [option, value] :
           {std::pair("--at", "z=" + std::to_string(z)), std::pair("--plane", "0,0,2=" + std::to_string(2 * z))}) {
        const auto cut = cut_by(option, value);
        EXPECT_EQ(check(cut).boundary_simplices, 0u);
        EXPECT_NEAR(measure(cut).size, size, 1e-5) << value;
        for (const auto& x : cut.vertices) ASSERT_NEAR(field(x[0], x[1], z), 0.4, 0.02) << value;
      }
    // several periods cross a lattice plane, here y + z = 7.3
    const auto plane = cut_by("--plane", "0,1,1=7.3");
    EXPECT_EQ(check(plane).boundary_simplices, 0u);
    EXPECT_EQ(plane.periods.size(), 2u);
    std::vector<std::string> measured = {"measure"};
    measured.insert(measured.end(), input.begin(), input.end());
    measured.insert(measured.end(), {"--at", "z=0.2,1.2"});
    const nlohmann::json cuts = run_json(measured)["cuts"];
    EXPECT_NEAR(cuts[1]["size"].get<double>(), size, 1e-5);
  }
}

TEST_F(PeriodicCommand, PlanesThatAreNoLatticePlanesCutTheWholeUnrolledContour) {
  // the face-centred cell: cuts across an axis repeat after half of the contour's extent
  OwnedImage<double, 3> image;
  image.grid.linear = {{{0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};
  for (Axis& axis : image.grid.axes) axis = Axis::uniform(24, 0.0, 1.0 / 24);
  const double turn = 2 * std::numbers::pi / 24;
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i)
        image.values.push_back(std::sin(turn * i) + 0.7 * std::cos(turn * j) + 0.8 * std::sin(turn * k + 0.5));
  const std::string file = path("centred.nrrd"), saved = path("centred.vtkhdf"), output = path("cut.vtkhdf");
  write_image(image.view(), file);
  (void)run_json({"contour", file, "--iso", "0.4", "--periodic", "all", "-o", saved});
  const auto contour = to_contour<3>(read_mesh(saved));
  for (const std::vector<std::string>& input :
       {std::vector<std::string>{saved}, {file, "--iso", "0.4", "--periodic", "all"}})
    for (const double offset : {0.9, 0.2, 9.0}) {
      std::vector<std::string> arguments = {"slice"};
      arguments.insert(arguments.end(), input.begin(), input.end());
      arguments.insert(arguments.end(), {"--plane", "1,0.1,0.03=" + std::to_string(offset), "-o", output});
      const RunResult run = run_tegl(arguments);
      if (offset == 9.0) {
        EXPECT_NE(run.exit, 0);
        EXPECT_THAT(run.err, HasSubstr("lies outside of the"));
        continue;
      }
      EXPECT_EQ(run.exit, 0) << run.err;
      EXPECT_THAT(run.err, HasSubstr("unrolled"));
      const auto expected = slice(unroll(contour).contour, Hyperplane<3>{{1.0, 0.1, 0.03}, offset});
      EXPECT_GT(expected.simplices.size(), 50u);
      EXPECT_NEAR(measure(to_contour<2>(read_mesh(output))).size, measure(expected).size, 1e-4);
    }
}

TEST_F(PeriodicCommand, PlacesBesideThePeriodOfATurnedImageAreItsPlaces) {
  OwnedImage<float, 3> image = std::get<OwnedImage<float, 3>>(std::get<AnyImageN<3>>(read_image(file_).image));
  for (const double turned : {6e-17, 0.002}) {
    image.grid.linear[1][0] = turned;
    write_image(image.view(), path("turned.nrrd"));
    const std::vector<std::string> input = {path("turned.nrrd"), "--iso", "0", "--periodic", "x"};
    std::vector<std::string> arguments = {"slice"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), {"--at", "y=9.5", "-o", path("cut.vtkhdf")});
    const RunResult cut = run_tegl(arguments);
    ASSERT_EQ(cut.exit, 0) << cut.err;
    EXPECT_EQ(cut.err.find("unrolled") == std::string::npos, turned < 0.001) << cut.err;
    EXPECT_NEAR(measure(to_contour<2>(read_mesh(path("cut.vtkhdf")))).size, std::numbers::pi * 10, 0.5);
    arguments[arguments.size() - 3] = "y=-40";
    const RunResult outside = run_tegl(arguments);
    EXPECT_NE(outside.exit, 0);
  }
}

TEST_F(PeriodicCommand, ImagesAreInterpolatedAcrossTheSeam) {
  // the image itself has the isovalue at each vertex of its contour
  const std::string itself = path("itself.vtkhdf"), saved = path("saved.vtkhdf");
  (void)run_json({"contour", file_, "--iso", "0.5", "--periodic", "x", "--attribute", file_, "-o", itself});
  (void)run_json({"contour", file_, "--iso", "0.5", "--periodic", "x", "-o", saved});
  const auto expect_isovalues = [&](double rounding) {
    const Mesh mesh = read_mesh(itself);
    ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
    ASSERT_GT(mesh.vertex_attributes[0].values.size(), 20u);
    for (const double value : mesh.vertex_attributes[0].values) ASSERT_NEAR(value, 0.5, rounding);
  };
  expect_isovalues(1e-4);
  // slices are interpolated in triangles, and the image in cells
  for (const char* const place : {"z=9.25", "x=0.25", "x=29.5", "x=-0.5"}) {
    for (const std::string& output : {itself, path("itself.ply")}) {
      (void)run_json({"slice", saved, "--at", place, "--scale", "x=2", "--attribute", file_, "-o", output});
      const std::size_t count = read_mesh(output).vertex_attributes.size();
      EXPECT_GE(count, 1u);
    }
    expect_isovalues(0.1);
    (void)run_json(
        {"slice", file_, "--iso", "0.5", "--periodic", "x", "--at", place, "--attribute", file_, "-o", itself});
    expect_isovalues(0.1);
  }
  // values y + z, and a second image with half the samples along x
  const auto sum = [](const std::vector<double>& x) { return x[1] + x[2]; };
  const std::string fine = write("fine.nii", nifti_bytes(sample({30, 20, 20}, sum), {1, 1, 1}));
  const std::string coarse = write("coarse.nii", nifti_bytes(sample({15, 20, 20}, sum), {2, 1, 1}));
  for (const char* const name : {"wrapped.vtkhdf", "unrolled.ply"}) {
    (void)run_json({"contour", file_, "--iso", "0", "--periodic", "x", "--attribute", fine, "--attribute", coarse, "-o",
                    path(name)});
    const Mesh mesh = read_mesh(path(name));
    ASSERT_GE(mesh.vertex_attributes.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t v = 0; v < mesh.coordinates.size() / 3; ++v)
        ASSERT_NEAR(mesh.vertex_attributes[i].values[v], mesh.coordinates[3 * v + 1] + mesh.coordinates[3 * v + 2],
                    1e-4);
  }
}

TEST_F(PeriodicCommand, ProjectionsAreInterpolatedAcrossTheSeam) {
  const std::string moving =
      write("moving.nii", nifti_bytes(sample({12, 8, 8, 3},
                                             [](const std::vector<double>& x) {
                                               return 2.0 + 0.3 * x[3] -
                                                      std::hypot(std::min(x[0], 12 - x[0]), x[1] - 3.5, x[2] - 3.5);
                                             }),
                                      {1, 1, 1, 1}));
  (void)run_json({"project", moving, "--iso", "0.25", "--periodic", "x", "--as", "cuts", "--attribute", moving, "-o",
                  path("swept.vtkhdf")});
  const Mesh mesh = read_mesh(path("swept.vtkhdf"));
  const auto own = std::find_if(mesh.vertex_attributes.begin(), mesh.vertex_attributes.end(),
                                [](const Attribute& attribute) { return attribute.name == "moving"; });
  ASSERT_NE(own, mesh.vertex_attributes.end());
  ASSERT_GT(own->values.size(), 20u);
  for (const double value : own->values) ASSERT_NEAR(value, 0.25, 0.2);
}

TEST_F(PeriodicCommand, SlicesOfAnImageKnowItsTiling) {
  const std::string direct = path("direct.vtkhdf"), saved = path("ball.vtkhdf"), cut = path("cut.vtkhdf");
  (void)run_json({"slice", file_, "--iso", "0", "--periodic", "x", "--at", "z=9.5", "-o", direct});
  (void)run_json({"contour", file_, "--iso", "0", "--periodic", "x", "-o", saved});
  (void)run_json({"slice", saved, "--at", "z=9.5", "-o", cut});
  EXPECT_EQ(read_mesh(direct).coordinates, read_mesh(cut).coordinates);
  EXPECT_EQ(read_mesh(direct).periods, read_mesh(cut).periods);
  const nlohmann::json divided =
      run_json({"slice", file_, "--iso", "0", "--division", "kuhn", "--at", "z=9.5", "-o", cut});
  EXPECT_EQ(divided["tiles"], 6 * 29 * 19 * 19);
  const RunResult run = run_tegl({"slice", saved, "--periodic", "x", "--at", "z=1", "-o", cut});
  EXPECT_NE(run.exit, 0);
  EXPECT_THAT(run.err, HasSubstr("saved contour, which does not take --periodic"));
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
  expect_refused({"--lattice", "bcc", "--periodic", "y=19", "-o", output},
                 "the period of axis 1 (y) is 19; expected 20");
  const nlohmann::json facets =
      run_json({"contour", ball, "--iso", "0", "--lattice", "fcc", "--facets", "-o", path("facets.vtu")});
  EXPECT_EQ(facets["tiles"], report["tiles"]);
  EXPECT_EQ(facets["active_tiles"], report["active_tiles"]);
  EXPECT_EQ(facets["facets"]["points"], report["vertices"]);
  EXPECT_LT(facets["facets"]["polygons"], report["simplices"]);
  EXPECT_EQ(facets["euler"], 2);
  EXPECT_EQ(facets["boundary_facets"], 0);
  expect_refused({"--lattice", "bcc", "--facets", "--periodic", "y=19", "-o", path("facets.vtu")},
                 "the period of axis 1 (y) is 19; expected 20");
  expect_refused({"--lattice", "bcc", "--normals=sobel", "-o", output},
                 "sobel normals on a lattice; expected gradient");
  (void)run_json({"contour", ball, "--iso", "0", "--lattice", "fcc", "--normals", "-o", output});
  EXPECT_FALSE(read_mesh(output).normals.empty());
}

TEST_F(PeriodicCommand, CurvedGridsMayBePeriodic) {
  // a global grid: longitudes and latitudes by two indices; a spot around 180 degrees east
  const std::string file = path("globe.nc");
  write_curved_globe(file);
  const std::string output = path("spot.vtkhdf");
  EXPECT_EQ(run_json({"components", file, "--iso", "0"})["count"], 2);
  for (const char* const axis : {"lon", "i", "i=360", "auto"}) {
    const nlohmann::json report = run_json({"contour", file, "--iso", "0", "--periodic", axis, "-o", output});
    EXPECT_EQ(report["components"], 1) << axis;
    EXPECT_EQ(report["boundary_simplices"], 0) << axis;
    EXPECT_EQ(run_json({"components", file, "--iso", "0", "--periodic", axis})["count"], 1);
    EXPECT_EQ(run_json({"components", output})["count"], 1);
  }
  const nlohmann::json by_index =
      run_json({"contour", file, "--iso", "0", "--index-grid", "--periodic", "i", "-o", output});
  EXPECT_EQ(by_index["components"], 1);
  expect_refused_of(file, {"--periodic", "depth", "-o", output},
                    "expected one of i or lon, j or lat, or x, y for them in this order, or longitude, or all");
  expect_refused_of(file, {"--periodic", "lon", "--attribute", file, "-o", output}, "--periodic and a curved grid");
  expect_refused_of(file, {"--periodic", "lon", "--lattice", "triangular", "-o", output}, "--lattice triangular with");
}

TEST_F(PeriodicCommand, CurvedLongitudesAreNamedByDimensionCoordinateLetterOrUnit) {
  const std::string file = path("globe.nc"), turned = path("turned.nc"), output = path("spot.vtkhdf");
  write_curved_globe(file, "TLONG");
  write_curved_globe(turned, "TLONG", true);
  const auto expect_around = [&](const std::string& from, const std::string& axis) {
    const nlohmann::json report = run_json({"contour", from, "--iso", "0", "--periodic", axis, "-o", output});
    EXPECT_EQ(report["components"], 1) << from << " " << axis;
    EXPECT_EQ(report["boundary_simplices"], 0) << from << " " << axis;
  };
  for (const char* const axis : {"TLONG", "tlong", "i", "x", "lon", "Longitude", "longitude=360", "auto"})
    expect_around(file, axis);
  // the first dimension is the axis y of the program
  for (const char* const axis : {"TLONG", "i", "y", "lon", "longitude", "auto"}) expect_around(turned, axis);
  expect_refused_of(turned, {"--periodic", "nav_lon", "-o", output},
                    "--periodic nav_lon names no axis; expected one of j or lat, i or TLONG, or x, y for them in this "
                    "order, or longitude, or all");
  expect_refused_of(file, {"--periodic", "TLONG,lon", "-o", output}, "--periodic names the axis lon twice");
  // with the grid of the indices, there are no longitudes
  const std::string refused =
      "--periodic lon names no axis; expected one of i, j, or x, y for them in this order, or all";
  expect_refused_of(file, {"--periodic", "lon", "--index-grid", "-o", output}, refused);
}

TEST_F(PeriodicCommand, AxesOfFilesAreNamedByDimensionLetterOrUnit) {
  const auto write_globe = [&](const std::string& name, const std::string& unit) {
    OwnedImage<float, 2> image;
    image.grid = Grid<2>::unit({36, 17});
    image.grid.axes[0] = Axis::uniform(36, -175.0, 10.0);
    image.grid.axes[1] = Axis::uniform(17, -80.0, 10.0);
    image.grid.axes[0].name = name;
    image.grid.axes[0].unit = unit;
    image.grid.axes[1].name = "yt_ocean";
    for (std::size_t j = 0; j < 17; ++j)
      for (std::size_t i = 0; i < 36; ++i)
        image.values.push_back(
            static_cast<float>(40.0 - std::hypot(180.0 - std::abs(image.grid.axes[0][i]), image.grid.axes[1][j])));
    write_image(image.view(), path("globe.nc"));
    return path("globe.nc");
  };
  const auto components = [&](const std::string& file, const std::string& axis) {
    return run_json({"components", file, "--iso", "0", "--periodic", axis})["count"].get<int>();
  };
  const std::string output = path("spot.vtkhdf");
  const std::string globe = write_globe("xt_ocean", "degrees_E");
  for (const char* const axis : {"xt_ocean", "XT_Ocean", "x", "lon", "longitude", "lon=360", "x=360"})
    EXPECT_EQ(components(globe, axis), 1) << axis;
  expect_refused_of(globe, {"--periodic", "nav_lon", "-o", output},
                    "--periodic nav_lon names no axis; expected one of xt_ocean, yt_ocean, or x, y for them in this "
                    "order, or longitude, or all, auto or none");
  expect_refused_of(globe, {"--periodic", "z", "-o", output}, "--periodic z names no axis");
  // a name counts more than a letter, and lon is no name without a unit of longitudes
  const std::string crossed = write_globe("y", "");
  EXPECT_EQ(components(crossed, "y"), 1);
  // as of --at: an axis that is named by another letter has no other one
  expect_refused_of(crossed, {"--periodic", "x", "-o", output},
                    "--periodic x names no axis; expected one of y, yt_ocean, or all, auto or none");
  expect_refused_of(crossed, {"--periodic", "lon", "-o", output}, "--periodic lon names no axis; expected one of y, ");
  const std::string beside = write_globe("z", "");
  EXPECT_EQ(components(beside, "z"), 1);
  expect_refused_of(beside, {"--periodic", "x", "-o", output},
                    "--periodic x names no axis; expected one of z, yt_ocean, or y for yt_ocean, or all, auto or none");
  expect_refused_of(beside, {"--periodic", "y,y", "-o", output}, "--periodic names the axis y twice");
}

TEST_F(PeriodicCommand, LongitudesAreFoundByTheirUnitAndSpan) {
  // a spot around the date line, half of it at either end of the longitudes
  OwnedImage<float, 2> image;
  image.grid = Grid<2>::unit({36, 17});
  image.grid.axes[0] = Axis::uniform(36, -175.0, 10.0);
  image.grid.axes[1] = Axis::uniform(17, -80.0, 10.0);
  for (std::size_t j = 0; j < 17; ++j)
    for (std::size_t i = 0; i < 36; ++i)
      image.values.push_back(
          static_cast<float>(40.0 - std::hypot(180.0 - std::abs(image.grid.axes[0][i]), image.grid.axes[1][j])));
  image.grid.axes[1].unit = "degrees_north";
  const std::string file = path("globe.nc"), output = path("spot.vtkhdf");
  const auto remarks = [&](const std::vector<std::string>& options, const std::string& to = "spot.vtkhdf") {
    std::vector<std::string> arguments = {"contour", file, "--iso", "0", "-o", path(to)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.err;
  };
  const auto components = [&](const std::string& periodic) {
    return run_json({"components", file, "--iso", "0", "--periodic", periodic})["count"].get<int>();
  };
  // no longitudes
  write_image(image.view(), file);
  EXPECT_EQ(remarks({}), "");
  EXPECT_THAT(remarks({"--periodic", "auto"}), HasSubstr("no longitudes span 360 degrees"));
  EXPECT_EQ(components("auto"), 2);
  // longitudes around the globe
  image.grid.axes[0].name = "lon";
  image.grid.axes[0].unit = "degrees_east";
  write_image(image.view(), file);
  EXPECT_EQ(remarks({"--periodic", "none"}), "");
  for (const char* const none : {"none", "None"}) EXPECT_EQ(components(none), 2);
  for (const char* const found : {"auto", "AUTO"}) EXPECT_EQ(components(found), 1);
  for (const char* const way : {"--no-check", "--stream", "--facets"}) {
    const std::string to = std::string(way) == "--facets" ? "facets.vtu" : "spot.vtkhdf";
    EXPECT_THAT(remarks({way}, to), HasSubstr("lon spans 360 degrees, and the contour ends at both its ends"));
    EXPECT_THAT(remarks({way, "--periodic", "auto"}, to), HasSubstr("lon spans 360 degrees, so it is periodic"));
  }
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--positions", "linear"}, {"--lattice", "triangular", "--stream"}})
    EXPECT_THAT(remarks(more), HasSubstr("--periodic auto continues it across"));
  EXPECT_THAT(remarks({"--lattice", "triangular", "--stream", "--periodic", "auto"}), HasSubstr("so it is periodic"));
  // --periodic auto is refused with these
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--pick", "170,0"}, {"--merge"}, {"--positions", "gravitation"}})
    EXPECT_THAT(remarks(more), testing::AllOf(HasSubstr("both its ends: --periodic none suppresses this remark"),
                                              testing::Not(HasSubstr("--periodic auto"))));
  EXPECT_EQ(run_json({"contour", file, "--iso", "0", "--periodic", "auto", "-o", output})["boundary_simplices"], 0);
  EXPECT_EQ(read_mesh(output).periods.size(), 5u);
  expect_refused_of(file, {"--periodic", "auto,lat", "-o", output}, "expected auto without other axes");
  expect_refused_of(file, {"--periodic", "lon,none", "-o", output}, "expected none without other axes");
  expect_refused_of(file, {"--periodic", "auto", "--pick", "1,2", "-o", output}, "--periodic auto with --pick");
  EXPECT_EQ(run_json({"contour", file, "--iso", "0", "--periodic", "none", "--pick", "170,0", "-o", output})["dim"], 1);
  // uneven longitudes are not found, but have the period 360 by name
  const auto write_longitudes = [&](const auto& longitude) {
    std::vector<double> longitudes;
    for (std::size_t i = 0; i < 36; ++i) longitudes.push_back(longitude(i));
    image.grid.axes[0] = Axis::rectilinear(std::move(longitudes));
    image.grid.axes[0].name = "lon";
    image.grid.axes[0].unit = "degrees_east";
    write_image(image.view(), file);
  };
  write_longitudes([](std::size_t i) { return -175.0 + 10.0 * static_cast<double>(i) + static_cast<double>(i % 2); });
  EXPECT_THAT(remarks({"--periodic", "auto"}),
              HasSubstr("no longitudes span 360 degrees in even steps, so no axis is periodic; if they run around the "
                        "globe, --periodic lon makes the axis periodic"));
  for (const char* const name : {"lon", "longitude"}) {
    EXPECT_EQ(remarks({"--periodic", name}), "");
    EXPECT_EQ(read_mesh(output).periods.at(0), 360.0) << name;
  }
  write_longitudes([](std::size_t i) { return 361.0 / 35 * static_cast<double>(i); });
  expect_refused_of(file, {"--periodic", "lon", "-o", output}, "is not more than 361, the span of its samples");
}

TEST_F(PeriodicCommand, SlicesAtTimesFindLongitudes) {
  // a spot around the date line that shrinks
  OwnedImage<float, 3> image;
  image.grid = Grid<3>::unit({36, 17, 4});
  image.grid.axes[0] = Axis::uniform(36, -175.0, 10.0);
  image.grid.axes[1] = Axis::uniform(17, -80.0, 10.0);
  image.grid.axes[0].name = "lon";
  image.grid.axes[1].name = "lat";
  image.grid.axes[2].name = "t";
  for (std::size_t t = 0; t < 4; ++t)
    for (std::size_t j = 0; j < 17; ++j)
      for (std::size_t i = 0; i < 36; ++i)
        image.values.push_back(
            static_cast<float>(40.0 - std::hypot(180.0 - std::abs(image.grid.axes[0][i]), image.grid.axes[1][j]) -
                               static_cast<double>(t)));
  const std::string file = path("film.nc"), output = path("cut.vtkhdf");
  const auto remarks = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"slice", file, "--iso", "0", "--at", "t=1.5", "-o", output};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.err;
  };
  const auto components = [&] { return run_json({"components", output})["count"].get<int>(); };
  write_image(image.view(), file);
  EXPECT_EQ(remarks({}), "");
  const Mesh plain = read_mesh(output);
  EXPECT_THAT(remarks({"--periodic", "auto"}), HasSubstr("no longitudes span 360 degrees"));
  const Mesh found = read_mesh(output);
  EXPECT_TRUE(std::equal(plain.coordinates.begin(), plain.coordinates.end(), found.coordinates.begin(),
                         found.coordinates.end()));
  image.grid.axes[0].unit = "degrees_east";
  write_image(image.view(), file);
  EXPECT_THAT(remarks({}), HasSubstr("lon spans 360 degrees, and the contour ends at both its ends"));
  EXPECT_EQ(components(), 2);
  EXPECT_EQ(remarks({"--periodic", "none"}), "");
  EXPECT_EQ(components(), 2);
  EXPECT_THAT(remarks({"--periodic", "auto"}), HasSubstr("lon spans 360 degrees, so it is periodic"));
  EXPECT_EQ(components(), 1);
}

TEST_F(PeriodicCommand, CellsMayBeDivided) {
  const std::string output = path("divided.ply");
  for (const auto& [division, cells] : {std::pair{"kuhn", 6}, {"alternating", 5}, {"symmetric", 24}, {"hybrid", 1}}) {
    const nlohmann::json report = run_json({"contour", file_, "--iso", "0", "--division", division, "-o", output});
    EXPECT_EQ(report["tiles"], cells * 29 * 19 * 19) << division;
    EXPECT_EQ(check(to_contour<3>(read_mesh(output))).components, 2u);
  }
  expect_refused({"--division", "kuhn", "--lattice", "bcc", "-o", output}, "--lattice bcc with --division kuhn");
  expect_refused({"--division", "kuhn", "--index", "i.tindex", "-o", output}, "--division kuhn with --index");
  expect_refused({"--division", "kuhn", "--normals", "context", "-o", output}, "normals context of a divided image");
  expect_refused({"--division", "kuhn", "--stream", "-o", output}, "--division kuhn with --stream");
  expect_refused({"--division", "random", "-o", output}, "random");
}

TEST_F(PeriodicCommand, DividedCellsContinueAcrossTheSeam) {
  const std::string output = path("divided.vtkhdf");
  const auto report = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"contour", file_, "--iso", "0", "--periodic", "x", "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_json(arguments);
  };
  const nlohmann::json plain = report({});
  for (const char* const division : {"kuhn", "symmetric", "alternating", "hybrid"}) {
    const nlohmann::json wrapped = report({"--division", division, "--normals", "sobel"});
    EXPECT_EQ(wrapped["components"], plain["components"]) << division;
    EXPECT_EQ(wrapped["euler"], plain["euler"]) << division;
    EXPECT_EQ(wrapped["boundary_simplices"] == 0, plain["boundary_simplices"] == 0) << division;
    const Contour<3, double> contour = to_contour<3>(read_mesh(output));
    EXPECT_EQ(contour.periods.size(), 1u);
    EXPECT_EQ(contour.normals.size(), contour.vertices.size());
    EXPECT_GT(report({"--division", division, "--unroll"})["vertices"], wrapped["vertices"]) << division;
  }
}

}  // namespace
}  // namespace tegl::test
