// SPDX-License-Identifier: BSD-3-Clause
//
// The command tegl slice: slices of images and of saved contours, by axis and by plane.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class Slice : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    file_ = write("balls.nii", nifti_bytes(merging_balls(18, 5), {1, 1, 1, 2}));  // t = 0, 2, 4, 6, 8 s
  }
  [[nodiscard]] const std::string& file() const { return file_; }
  static std::string bytes(const std::string& name) {
    std::ifstream in(name, std::ios::binary);
    EXPECT_TRUE(in) << name;
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::string file_;
};

TEST_F(Slice, AMeshInAPlaneHasTheNamesOfItsAxes) {
  std::vector<std::string> steps;
  for (const std::string value : {"1", "2"}) {
    const auto array = [](const std::string& type, const std::string& name, const std::string& numbers) {
      return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\">" + numbers + "</DataArray>";
    };
    steps.push_back(write(
        "plane_" + value + ".vtu",
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points>"
        "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">-1 7 -1 1 7 -1 1 7 1 -1 7 1"
        "</DataArray></Points><Cells>" +
            array("Int32", "connectivity", "0 1 2 3") + array("Int32", "offsets", "4") + array("UInt8", "types", "9") +
            "</Cells><PointData>" + array("Float32", "f", "0 " + value + " " + value + " 0") +
            "</PointData></Piece></UnstructuredGrid></VTKFile>"));
  }
  const auto slice = [&](const std::string& at) {
    return run_tegl({"slice", steps[0], steps[1], "--iso", "0.5", "--at", at, "-o", path("cut.ply")});
  };
  EXPECT_THAT(slice("z=0").out, HasSubstr("Slice at z = 0"));
  for (const char* const at : {"y=0", "y=7"}) {
    const RunResult run = slice(at);
    EXPECT_EQ(run.exit, 2);
    EXPECT_THAT(run.err, HasSubstr(std::string("--at ") + at + " names no axis; expected one of x, z, t"));
  }
}

TEST_F(Slice, OfMovingBallsIsTwoSpheresThenOne) {
  const RunResult early = run_tegl({"slice", file(), "--iso", "0", "--at", "t=0.7", "-o", path("a.ply"), "--json"});
  ASSERT_EQ(early.exit, 0) << early.err;
  const nlohmann::json two = early.json();
  EXPECT_EQ(two["image_dim"], 4);
  EXPECT_EQ(two["dim"], 2);
  EXPECT_EQ(two["components"], 2);
  EXPECT_EQ(two["euler"], 4);
  EXPECT_EQ(two["boundary_simplices"], 0);
  EXPECT_EQ(two["at"]["value"], 0.7);
  EXPECT_GT(two["active_tiles"], 0);
  for (const char* stage : {"read", "slice", "check", "write"}) EXPECT_TRUE(two["seconds"].contains(stage));
  const RunResult late = run_tegl({"slice", file(), "--iso", "0", "--at", "t=7.3", "-o", path("b.ply"), "--json"});
  ASSERT_EQ(late.exit, 0) << late.err;
  EXPECT_EQ(late.json()["euler"], 2);
}

/// Samples with the last axis moved to the front.
Samples with_last_axis_first(const Samples& samples) {
  const std::size_t layers = samples.sizes.back();
  const std::size_t size = samples.values.size() / layers;
  Samples result{{layers}, {}};
  result.sizes.insert(result.sizes.end(), samples.sizes.begin(), samples.sizes.end() - 1);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t k = 0; k < layers; ++k) result.values.push_back(samples.values[k * size + i]);
  return result;
}

TEST_F(Slice, IsTheSameFromLayersAndFromTheWholeImage) {
  // The list of images is the last axis of one file, which is read by layers, and the first of the other, which is not.
  const Samples samples = merging_balls(10, 6);
  const std::string layers = write("layers.nrrd", nrrd_bytes(samples, "kinds: domain domain domain list\n"));
  const std::string whole =
      write("whole.nrrd", nrrd_bytes(with_last_axis_first(samples), "kinds: list domain domain domain\n"));
  EXPECT_EQ(run_tegl({"contour", whole, "--stream", "--iso", "0", "-o", path("a.vtkhdf")}).exit, 4);
  EXPECT_EQ(run_tegl({"contour", layers, "--stream", "--iso", "0", "-o", path("a.vtkhdf")}).exit, 0);
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{},
                                             {"--normals"},
                                             {"--normals", "sobel"},
                                             {"--precision", "float"},
                                             {"--ambiguity", "saddle", "--close"},
                                             {"--scale", "t=0.3"},
                                             {"--at", "x=4.5"}}) {
    const auto cut = [&](const std::string& from, const std::string& to) {
      std::vector<std::string> arguments = {
          "slice", from, "--iso", "0.25", "--at", "t=4.75,0,2,5,0.5", "-o", path(to + "_{axis}_{t}.ply"), "--json"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      const RunResult run = run_tegl(arguments);
      EXPECT_EQ(run.exit, 0) << run.err;
      nlohmann::json reports = run.json();
      for (nlohmann::json& report : reports) {
        report.erase("seconds");
        report.erase("input");
        report.erase("output");
      }
      return reports;
    };
    EXPECT_EQ(cut(layers, "layers"), cut(whole, "whole"));
    for (const char* const t : {"0", "0.5", "2", "4.75", "5"})
      EXPECT_EQ(bytes(path(std::string("layers_t_") + t + ".ply")), bytes(path(std::string("whole_t_") + t + ".ply")))
          << t;
  }
}

TEST_F(Slice, OfLayersFailsAsThatOfTheWholeImage) {
  const Samples samples = merging_balls(10, 6);
  const std::string layers = write("layers.nrrd", nrrd_bytes(samples, "kinds: domain domain domain list\n"));
  const std::string whole =
      write("whole.nrrd", nrrd_bytes(with_last_axis_first(samples), "kinds: list domain domain domain\n"));
  const auto before = files();
  for (const auto& [iso, at] : {std::pair("1000", "t=1.5"), std::pair("0", "t=7"), std::pair("1000", "t=7"),
                                std::pair("0", "q=1"), std::pair("nan", "t=1")}) {
    const auto cut = [&](const std::string& file) {
      return run_tegl({"slice", file, "--iso", iso, "--at", at, "-o", path("out.ply")});
    };
    const RunResult of_layers = cut(layers);
    const RunResult of_whole = cut(whole);
    EXPECT_EQ(of_layers.exit, of_whole.exit) << iso << " " << at;
    EXPECT_EQ(of_layers.err.substr(of_layers.err.rfind(".nrrd") + 1),
              of_whole.err.substr(of_whole.err.rfind(".nrrd") + 1));
  }
  EXPECT_EQ(files(), before);
}

TEST_F(Slice, ReportsWrongCutsBeforeItReadsSamples) {
  const std::string damaged = write(
      "damaged.nrrd",
      "NRRD0004\ntype: float\ndimension: 4\nsizes: 4 4 4 4\nendian: little\nencoding: gzip\n\nno compressed data");
  const auto cut = [&](const std::string& at) {
    return run_tegl({"slice", damaged, "--iso", "0", "--at", at, "-o", path("out.ply")});
  };
  EXPECT_THAT(cut("t=9").err, HasSubstr("the slice at t = 9 lies outside of the image"));
  EXPECT_THAT(cut("x=9").err, HasSubstr("the slice at x = 9 lies outside of the image"));
  EXPECT_THAT(cut("q=1").err, HasSubstr("--at q=1 names no axis"));
  const RunResult inside = cut("t=1.5");
  EXPECT_EQ(inside.exit, 4) << inside.err;
}

TEST_F(Slice, OfASavedContourEqualsThatOfItsImage) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  for (const char* at : {"t=4", "t=7.3", "t=0", "t=8"}) {
    const RunResult saved = run_tegl({"slice", path("all.vtkhdf"), "--at", at, "-o", path("saved.ply"), "--json"});
    ASSERT_EQ(saved.exit, 0) << saved.err;
    const RunResult direct = run_tegl({"slice", file(), "--iso", "0", "--at", at, "-o", path("direct.ply"), "--json"});
    ASSERT_EQ(direct.exit, 0) << direct.err;
    for (const char* key : {"vertices", "simplices", "components", "euler", "boundary_simplices", "bad_links"}) {
      EXPECT_EQ(saved.json()[key], direct.json()[key]) << at << " " << key;
    }
    EXPECT_EQ(saved.json()["isovalue"], 0.0);
    EXPECT_TRUE(saved.json()["active_tiles"].is_null());
  }
}

TEST_F(Slice, AttributesAreThoseOfOtherImagesAtTheCutWhereverItComesFrom) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  std::vector<std::vector<double>> found;
  for (const std::vector<std::string>& from : {std::vector<std::string>{file(), "--iso", "0", "--at", "t=4"},
                                               {path("all.vtkhdf"), "--at", "t=4"},
                                               {path("all.vtkhdf"), "--plane", "0,0,0,2=8", "--scale", "t=3"}}) {
    std::vector<std::string> arguments = {"slice"};
    arguments.insert(arguments.end(), from.begin(), from.end());
    arguments.insert(arguments.end(), {"--attribute", file(), "-o", path("cut.vtkhdf"), "-q"});
    const RunResult run = run_tegl(arguments);
    ASSERT_EQ(run.exit, 0) << run.err;
    const Mesh cut = read_mesh(path("cut.vtkhdf"));
    ASSERT_EQ(cut.vertex_attributes.size(), 1u);
    const auto& values = cut.vertex_attributes[0].values;
    // At a time step vertices lie on edges of the grid, at which the image has the isovalue.
    for (const double value : values) ASSERT_NEAR(value, 0.0, 1e-5);
    found.emplace_back(values.begin(), values.end());
    EXPECT_GT(found.back().size(), 50u);
    EXPECT_EQ(found.back().size(), found.front().size());
  }
}

TEST_F(Slice, OfAContourSavedInSinglePrecisionMeetsItsOwnTimes) {
  // 0.1 and 0.7 differ between single and double precision; the first float is larger, the second smaller.
  const std::vector<double> places = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
  write_netcdf(path("balls.nc"), {"x", "y", "z", "t"}, {places, places, places, {0.1, 0.3, 0.4, 0.5, 0.7}},
               {{"TEMP", merging_balls(18, 5)}});
  ASSERT_EQ(
      run_tegl({"contour", path("balls.nc"), "--iso", "0", "--precision", "float", "-o", path("all.vtkhdf"), "-q"})
          .exit,
      0);
  for (const char* at : {"t=0.1", "t=0.3", "t=0.7"}) {
    const RunResult saved = run_tegl({"slice", path("all.vtkhdf"), "--at", at, "-o", path("saved.ply"), "--json"});
    ASSERT_EQ(saved.exit, 0) << saved.err;
    const RunResult direct = run_tegl(
        {"slice", path("balls.nc"), "--iso", "0", "--precision", "float", "--at", at, "-o", path("a.ply"), "--json"});
    ASSERT_EQ(direct.exit, 0) << direct.err;
    for (const char* key : {"at", "vertices", "simplices", "components", "euler", "boundary_simplices"})
      EXPECT_EQ(saved.json()[key], direct.json()[key]) << at << " " << key;
    for (const char* scale : {"t=10", "t=3"})
      EXPECT_EQ(run_tegl({"slice", path("all.vtkhdf"), "--at", at, "--scale", scale, "-o", path("b.ply"), "--json"})
                    .json()["simplices"],
                saved.json()["simplices"]);
    const nlohmann::json cut =
        run_tegl({"measure", path("balls.nc"), "--iso", "0", "--precision", "float", "--at", at, "--json"})
            .json()["cuts"][0];
    EXPECT_EQ(cut["value"], saved.json()["at"]["value"]);
    EXPECT_GT(cut["size"], 100);
    EXPECT_GT(cut["content"], 100);
  }
  EXPECT_EQ(run_tegl({"slice", path("all.vtkhdf"), "--at", "t=0.0999", "-o", path("no.ply")}).exit, 5);
}

TEST_F(Slice, HasTheNormalsOfTheSavedContourOrOfTheImage) {
  const auto sorted = [&](const std::string& name) {
    const Mesh mesh = read_mesh(path(name));
    EXPECT_EQ(mesh.normals.size(), mesh.coordinates.size());
    std::vector<std::array<double, 6>> list(mesh.normals.size() / 3);
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
      list[i / 3][i % 3] = mesh.coordinates[i];
      list[i / 3][3 + i % 3] = mesh.normals[i];
    }
    std::sort(list.begin(), list.end());
    return list;
  };
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "--normals", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  for (const char* at : {"t=4", "t=7.3"}) {
    ASSERT_EQ(run_tegl({"slice", path("all.vtkhdf"), "--at", at, "-o", path("saved.ply"), "-q"}).exit, 0);
    ASSERT_EQ(run_tegl({"slice", file(), "--iso", "0", "--normals", "--at", at, "-o", path("direct.ply"), "-q"}).exit,
              0);
    EXPECT_FALSE(sorted("saved.ply").empty());
    EXPECT_EQ(sorted("saved.ply"), sorted("direct.ply"));
  }
}

TEST_F(Slice, OfAWholeTimeIsTheContourOfThatStep) {
  const Samples balls = merging_balls(18, 5);
  const std::size_t step = 18 * 18 * 18;
  const Samples layer{{18, 18, 18}, {balls.values.begin() + 2 * step, balls.values.begin() + 3 * step}};
  const std::string layer_file = write("layer.nii", nifti_bytes(layer, {1, 1, 1}));
  ASSERT_EQ(run_tegl({"contour", layer_file, "--iso", "0", "-o", path("layer.ply"), "-q"}).exit, 0);
  ASSERT_EQ(run_tegl({"slice", file(), "--iso", "0", "--at", "t=4", "-o", path("cut.ply"), "-q"}).exit, 0);
  const auto points = [&](const std::string& name) {
    const Mesh mesh = read_mesh(path(name));
    std::vector<std::array<double, 3>> list(mesh.coordinates.size() / 3);
    for (std::size_t i = 0; i < mesh.coordinates.size(); ++i) list[i / 3][i % 3] = mesh.coordinates[i];
    std::sort(list.begin(), list.end());
    return list;
  };
  EXPECT_EQ(points("cut.ply"), points("layer.ply"));
}

TEST_F(Slice, OfNoiseAtAWholeTimeIsTheContourOfThatStepFromTheImageAndFromASavedContour) {
  Samples film = noise({6, 7, 5, 4}, 3);
  for (float& value : film.values) value = std::floor(value / 64);  // many equal the isovalue
  const std::size_t step = 6 * 7 * 5;
  const std::string film_file = write("film.nii", nifti_bytes(film, {1, 1, 1, 1}));
  /// Triangles by corner positions, each from its smallest corner on.
  const auto triangles = [&](const std::string& name) {
    const Mesh mesh = read_mesh(path(name));
    std::vector<std::array<std::array<double, 3>, 3>> list(mesh.simplices.size() / 3);
    for (std::size_t i = 0; i < mesh.simplices.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a) list[i / 3][i % 3][a] = mesh.coordinates[3 * mesh.simplices[i] + a];
    for (auto& corners : list) {
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      const bool repeats = corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2];
      if (repeats) std::sort(corners.begin(), corners.end());  // ignores orientation
    }
    std::sort(list.begin(), list.end());
    return list;
  };
  for (const char* ambiguity : {"low", "mean", "saddle", "squares", "decider"})
    for (const char* triangulation : {"compact", "barycentric"}) {
      const std::vector<std::string> how = {"--iso",           "2",           "--ambiguity", ambiguity,
                                            "--triangulation", triangulation, "--close"};
      const auto run = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), how.begin(), how.end());
        const RunResult result = run_tegl(arguments);
        ASSERT_EQ(result.exit, 0) << result.err;
      };
      run({"contour", film_file, "-o", path("all.vtkhdf"), "-q"});
      for (const std::size_t k : {0u, 2u, 3u}) {
        const auto first = film.values.begin() + static_cast<std::ptrdiff_t>(k * step);
        const Samples layer{{6, 7, 5}, {first, first + static_cast<std::ptrdiff_t>(step)}};
        const std::string at = "t=" + std::to_string(k);
        run({"contour", write("layer.nii", nifti_bytes(layer, {1, 1, 1})), "-o", path("layer.vtkhdf"), "-q"});
        run({"slice", film_file, "--at", at, "-o", path("cut.vtkhdf"), "-q"});
        ASSERT_EQ(run_tegl({"slice", path("all.vtkhdf"), "--at", at, "-o", path("saved.vtkhdf"), "-q"}).exit, 0);
        const auto expected = triangles("layer.vtkhdf");
        EXPECT_GT(expected.size(), 100u);
        EXPECT_TRUE(triangles("cut.vtkhdf") == expected) << ambiguity << " " << triangulation << " " << at;
        EXPECT_TRUE(triangles("saved.vtkhdf") == expected) << ambiguity << " " << triangulation << " " << at;
      }
    }
}

TEST_F(Slice, CutsAtSeveralTimesAtOnce) {
  const RunResult run = run_tegl(
      {"slice", "--at", "t=1,2.50", "--at", "t=7.3", file(), "--iso", "0", "-o", path("cut_{t}.ply"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(files(), ElementsAre("balls.nii", "cut_1.ply", "cut_2.50.ply", "cut_7.3.ply"));
  ASSERT_EQ(run.json().size(), 3u);
  EXPECT_EQ(run.json()[1]["at"]["value"], 2.5);
  EXPECT_EQ(run.json()[1]["output"], path("cut_2.50.ply"));
}

TEST_F(Slice, TakesTheAxisByItsOwnName) {
  write_netcdf(path("balls.nc"), {"LON", "LAT", "DEPTH", "MONTH"},
               {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17},
                {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17},
                {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17},
                {1, 2, 4, 7, 12}},
               {{"TEMP", merging_balls(18, 5)}});
  const std::vector<std::string> rest = {"--iso", "0", "-o", path("out.ply"), "--json"};
  for (const char* at : {"MONTH=1.5", "month=1.5", "t=1.5"}) {
    std::vector<std::string> arguments = {"slice", path("balls.nc"), "--at", at};
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    const RunResult run = run_tegl(arguments);
    ASSERT_EQ(run.exit, 0) << run.err;
    EXPECT_EQ(run.json()["at"]["axis"], "MONTH");
    EXPECT_EQ(run.json()["euler"], 4);
  }
  const RunResult other = run_tegl({"slice", path("balls.nc"), "--at", "HEIGHT=3", "--iso", "0", "-o", path("no.ply")});
  EXPECT_EQ(other.exit, 2);
  EXPECT_THAT(other.err, HasSubstr("HEIGHT"));
  EXPECT_THAT(other.err, HasSubstr("MONTH"));
}

TEST_F(Slice, AcrossLongitudesTakesPlacesATurnAway) {
  for (const std::size_t axis : {0, 2}) {  // across the last axis, only layers are read
    SCOPED_TRACE(axis);
    OwnedImage<float, 3> image;
    for (std::size_t a = 0; a < 3; ++a) {
      image.grid.axes[a] = Axis::uniform(9, -20.0, 5.0);
      image.grid.axes[a].name = std::string(1, "pqr"[a]);
    }
    image.grid.axes[axis] = Axis::uniform(9, 160.0, 5.0);
    image.grid.axes[axis].name = "lon";
    image.grid.axes[axis].unit = "degrees_east";
    for (int k = 0; k < 9; ++k)
      for (int j = 0; j < 9; ++j)
        for (int i = 0; i < 9; ++i) image.values.push_back(static_cast<float>(4.2 - std::hypot(i - 4, j - 4, k - 4)));
    const std::string input = path("ball.nc"), saved = path("ball.vtkhdf");
    write_image(image.view(), input);
    ASSERT_EQ(run_tegl({"contour", input, "--iso", "0", "-o", saved}).exit, 0);
    for (const bool of_saved : {false, true}) {
      const auto arguments = [&](const std::string& place) {
        std::vector<std::string> all = {"slice", of_saved ? saved : input, "--at", place, "-o", path("cut.ply")};
        if (!of_saved) all.insert(all.end(), {"--iso", "0"});
        return all;
      };
      const auto cut = [&](const std::string& place) {
        const RunResult run = run_tegl(arguments(place));
        EXPECT_EQ(run.exit, 0) << run.err;
        return bytes(path("cut.ply"));
      };
      const std::string expected = cut("lon=195");
      for (const char* const place : {"lon=-165", "lon=555"}) EXPECT_EQ(cut(place), expected) << place;
      EXPECT_THAT(run_tegl(arguments("lon=0")).err, HasSubstr("the slice at lon = 0 lies outside of the"));
      EXPECT_THAT(run_tegl(arguments("q=-340")).err, HasSubstr("the slice at q = -340 lies outside of the"));
    }
  }
}

TEST_F(Slice, OutsideOfTheTimesIsRefusedWithTheirRange) {
  for (const char* at : {"t=-0.1", "t=8.01", "t=1e9"}) {
    const RunResult run = run_tegl({"slice", file(), "--iso", "0", "--at", at, "-o", path("out.ply")});
    EXPECT_EQ(run.exit, 5);
    EXPECT_THAT(run.err, HasSubstr("0 <= t <= 8"));
    EXPECT_THAT(run.err, HasSubstr(file()));
  }
  EXPECT_THAT(files(), ElementsAre("balls.nii"));
}

TEST_F(Slice, OfASavedContourTakesNoOptionsOfTheExtraction) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--iso", "0"}, {"--close"}, {"--var", "T"}, {"--triangulation", "compact"}}) {
    std::vector<std::string> arguments = {"slice", path("all.vtkhdf"), "--at", "t=1", "-o", path("out.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 2);
    EXPECT_THAT(run.err, HasSubstr(more.front()));
  }
  EXPECT_THAT(files(), testing::Not(Contains("out.ply")));
}

TEST_F(Slice, AcrossAnyAxisIsASurfaceInTheOthers) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  for (const std::string& input : {file(), path("all.vtkhdf")}) {
    std::vector<std::string> arguments = {"slice", input, "--at", "x=5.3", "-o", path("x.vtkhdf"), "--json"};
    if (input == file()) arguments.insert(arguments.end(), {"--iso", "0"});
    const RunResult run = run_tegl(arguments);
    ASSERT_EQ(run.exit, 0) << run.err;
    EXPECT_EQ(run.json()["at"]["axis"], "x");
    EXPECT_EQ(run.json()["dim"], 2);
    EXPECT_EQ(run.json()["bad_links"], 0);
    const Mesh mesh = read_mesh(path("x.vtkhdf"));
    EXPECT_THAT(mesh.axis_names, ElementsAre("y", "z", "t"));
    EXPECT_THAT(mesh.axis_units, ElementsAre("mm", "mm", "s"));
    double last = 0;
    for (std::size_t i = 2; i < mesh.coordinates.size(); i += 3) last = std::max(last, mesh.coordinates[i]);
    EXPECT_EQ(last, 8.0);  // the last time
  }
}

TEST_F(Slice, ByAPlaneReportsItsFrame) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  const RunResult saved =
      run_tegl({"slice", path("all.vtkhdf"), "--plane", "1,0,0,2=14,15.5", "-o", path("saved_{t}.ply"), "--json"});
  ASSERT_EQ(saved.exit, 0) << saved.err;
  ASSERT_EQ(saved.json().size(), 2u);
  EXPECT_EQ(saved.json()[0]["at"]["axis"], "x + 2 t");
  EXPECT_EQ(saved.json()[1]["at"]["value"], 15.5);
  EXPECT_EQ(saved.json()[0]["bad_links"], 0);
  const auto frame = saved.json()[0]["at"]["frame"];
  ASSERT_EQ(frame["axes"].size(), 3u);
  const Mesh mesh = read_mesh(path("saved_14.ply"));
  for (std::size_t v = 0; v < mesh.coordinates.size() / 3; ++v) {  // x + 2 t = 14 at every vertex
    double sum = 0;
    for (const std::size_t a : {0u, 3u}) {
      double x = frame["origin"][a];
      for (std::size_t i = 0; i < 3; ++i) x += frame["axes"][i][a].get<double>() * mesh.coordinates[3 * v + i];
      sum += a == 0 ? x : 2 * x;
    }
    ASSERT_NEAR(sum, 14.0, 1e-12);
  }
  const RunResult direct =
      run_tegl({"slice", file(), "--iso", "0", "--plane=1,0,0,2=14", "-o", path("direct.ply"), "--json"});
  ASSERT_EQ(direct.exit, 0) << direct.err;
  EXPECT_EQ(read_mesh(path("direct.ply")).coordinates, mesh.coordinates);
  EXPECT_GT(direct.json()["active_tiles"], 0);
}

TEST_F(Slice, ScaleStretchesWhatIsCutAndNotThePlane) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  const auto coordinates = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"slice", path("all.vtkhdf"), "-o", path("out.ply"), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return read_mesh(path("out.ply")).coordinates;
  };
  const auto plain = coordinates({"--at", "x=5.25"});
  const auto stretched = coordinates({"--at", "x=5.25", "--scale", "t=4,x=2"});
  ASSERT_EQ(plain.size(), stretched.size());
  for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_EQ(stretched[i], i % 3 == 2 ? 4 * plain[i] : plain[i]);
  // The plane x + t = 9 contains the same number of vertices at any scale.
  EXPECT_EQ(coordinates({"--plane", "1,0,0,1=9"}).size(),
            coordinates({"--plane", "1,0,0,1=9", "--scale", "t=4"}).size());
  for (const char* scale : {"t=0", "t=-1", "q=2", "t", "t=a"})
    EXPECT_EQ(run_tegl({"slice", path("all.vtkhdf"), "--at", "t=1", "--scale", scale, "-o", path("out.ply")}).exit, 2)
        << scale;
}

TEST_F(Slice, ErrorsOfCutsFarFromAPeriodNameTheCutAndItsOwnNumbers) {
  const Samples waves = sample({12, 12, 12}, [](const std::vector<double>& x) {
    constexpr double kTurn = 6.283185307179586 / 12;
    return std::cos(kTurn * x[0]) + std::cos(kTurn * x[1]) + std::cos(kTurn * x[2]);
  });
  const auto saved = [&](const std::string& name, const std::string& directions) {
    const std::string image =
        write(name + ".nrrd", nrrd_bytes(waves, "space dimension: 3\nspace directions: " + directions + "\n"));
    const RunResult run =
        run_tegl({"contour", image, "--iso", "0.5", "--periodic", "all", "-o", path(name + ".vtkhdf")});
    EXPECT_EQ(run.exit, 0) << run.err;
    return path(name + ".vtkhdf");
  };
  const auto refused = [&](std::vector<std::string> options, const std::string& message) {
    options.insert(options.begin(), "slice");
    options.insert(options.end(), {"-o", path("cut_{n}.vtkhdf")});
    const RunResult run = run_tegl(options);
    EXPECT_EQ(run.exit, 2);
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  const std::string cube = saved("cube", "(1,0,0) (0,1,0) (0,0,1)"),
                    oblique = saved("oblique", "(1,0,0) (0,1,0) (0.5,0,1)");
  refused({cube, "--plane", "0,3,3=1,1e12"},
          "the slice at 3 y + 3 z = 1e12: a slice across a period has the coordinate 1000000000000 along the normal, "
          "with the period 36 from 0; expected at most 536870912 periods from there");
  refused({oblique, "--at", "z=1e12", "--scale", "z=10"},
          "the slice at z = 1e12, on axes scaled by --scale: a slice across a period has the coordinate 10000000000000 "
          "along the axis z, with the period 120 from 0");
  // it does repeat itself, but not within 32 periods
  const RunResult steep = run_tegl({"slice", cube, "--plane", "33,1,0=20", "-o", path("cut.vtkhdf")});
  EXPECT_EQ(steep.exit, 0) << steep.err;
  EXPECT_THAT(steep.err, HasSubstr("unrolled for slices along which it does not repeat itself within 32 periods"));
}

TEST_F(Slice, ThroughVerticesNamesTheReasonOfZeroSizes) {
  // vertices on edges along x lie in the plane, up to rounding
  const std::string image = write("balls.nrrd", nrrd_bytes(merging_balls(12, 8), "spacings: 0.1 0.1 0.1 0.1\n"));
  ASSERT_EQ(run_tegl({"contour", image, "--iso", "0.1", "--epsilon", "0.01", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  const RunResult run = run_tegl({"slice", path("all.vtkhdf"), "--plane", "0,0,1,1=0.9", "-o", path("cut.vtkhdf")});
  EXPECT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("of zero size (the slice passes through vertices of the contour, or samples equal"));
}

TEST_F(Slice, AStackIsEachOfItsCuts) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  const RunResult run =
      run_tegl({"slice", path("all.vtkhdf"), "--at", "t=0:8:5", "-o", path("stack_{t}.ply"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  ASSERT_EQ(run.json().size(), 5u);
  for (const char* t : {"0", "2", "4", "6", "8"}) {
    ASSERT_EQ(run_tegl({"slice", path("all.vtkhdf"), "--at", std::string("t=") + t, "-o", path("one.ply"), "-q"}).exit,
              0);
    const Mesh one = read_mesh(path("one.ply"));
    const Mesh of_stack = read_mesh(path(std::string("stack_") + t + ".ply"));
    EXPECT_EQ(one.coordinates, of_stack.coordinates);
    EXPECT_EQ(one.simplices, of_stack.simplices);
  }
}

TEST_F(Slice, NeedsAPlaceToCut) {
  const RunResult run = run_tegl({"slice", file(), "--iso", "0", "-o", path("out.ply")});
  EXPECT_EQ(run.exit, 2);
  EXPECT_THAT(run.err, HasSubstr("--at"));
  for (const char* plane : {"1,2=3", "0,0,0,0=1", "1,0,0,a=1", "=1", "1,0,0,1"}) {
    const RunResult bad = run_tegl({"slice", file(), "--iso", "0", "--plane", plane, "-o", path("out.ply")});
    EXPECT_EQ(bad.exit, 2) << plane;
    EXPECT_THAT(bad.err, HasSubstr("--plane"));
  }
}

TEST_F(Slice, OfAnImageNeedsAnIsovalue) {
  const RunResult run = run_tegl({"slice", file(), "--at", "t=1", "-o", path("out.ply")});
  EXPECT_EQ(run.exit, 2);
  EXPECT_THAT(run.err, HasSubstr("--iso"));
}

TEST_F(Slice, OfAVolumeIsItsContourLines) {
  const std::string volume = write("ball.nrrd", nrrd_bytes(ball({12, 12, 12}, 4.3)));
  const RunResult run = run_tegl({"slice", volume, "--iso", "0", "--at", "z=5.2", "-o", path("line.ply"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["dim"], 1);
  EXPECT_EQ(run.json()["components"], 1);
  EXPECT_EQ(run.json()["boundary_simplices"], 0);
}

TEST_F(Slice, OfAPlaneImageIsRefused) {
  const std::string disc = write("disc.nrrd", nrrd_bytes(ball({9, 9}, 3)));
  const RunResult run = run_tegl({"slice", disc, "--iso", "0", "--at", "y=5", "-o", path("out.ply")});
  EXPECT_EQ(run.exit, 4);
  EXPECT_THAT(run.err, HasSubstr("2D"));
}

}  // namespace
}  // namespace tegl::test
