// SPDX-License-Identifier: BSD-3-Clause
//
// The commands tegl scale-space and tegl sample: their images, and other commands that take these.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "sample_files.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"
#include "tegl/measure.hpp"
#include "tegl/scale_space.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class ImageMakers : public ProgramTest {
 protected:
  template <int N>
  [[nodiscard]] OwnedImage<float, N> floats(const std::string& name) const {
    return std::get<OwnedImage<float, N>>(std::get<AnyImageN<N>>(read_image(path(name)).image));
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& part, int exit) const {
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.err;
    EXPECT_THAT(run.err, HasSubstr(part));
  }
};

TEST_F(ImageMakers, ScaleSpaceIsTheLibrarys) {
  const std::string volume = write("volume.nii", nifti_bytes(noise({9, 8, 7}, 1), {1, 2, 1}));
  const RunResult run =
      run_tegl({"scale-space", volume, "--sigmas", "0.5:2:3", "--iso", "128", "-o", path("a.nrrd"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.json()["sizes"], ElementsAre(9, 8, 7, 3));
  EXPECT_THAT(run.json()["sigmas"], ElementsAre(0.5, 1.0, 2.0));
  EXPECT_EQ(run.json()["sizes_of_contour"].size(), 3u);
  EXPECT_EQ(run.json()["most_stable"]["sigma"], 1.0);
  const auto image = std::get<OwnedImage<float, 3>>(std::get<AnyImageN<3>>(read_image(volume).image));
  ScaleSpaceLayers<float, 3> layers(image.view(), {0.5, 1, 2});
  const auto scales = floats<4>("a.nrrd");
  EXPECT_EQ(scales.values, layers.all().values);
  EXPECT_EQ(scales.grid.axes[3].name, "log2_sigma");
  EXPECT_EQ(scales.grid.axes[3][2], 1.0);
  // other quantities, uneven scales
  ASSERT_EQ(
      run_tegl({"scale-space", volume, "--sigmas", "1,2,3", "--samples", "--laplacian", "-o", path("b.nc"), "-q"}).exit,
      0);
  EXPECT_NEAR(floats<4>("b.nc").grid.axes[3][2], std::log2(3), 1e-15);
}

TEST_F(ImageMakers, OtherCommandsRunOverTheScale) {
  ASSERT_EQ(run_tegl({"sample", "metaballs", "--dim", "2", "--size", "48", "--set", "width=0.08", "--set", "count=30",
                      "-o", path("balls.nrrd"), "-q"})
                .exit,
            0);
  ASSERT_EQ(
      run_tegl({"scale-space", path("balls.nrrd"), "--sigmas", "0.03:0.4:12", "-o", path("scales.nrrd"), "-q"}).exit,
      0);
  const std::string scales = path("scales.nrrd");
  const RunResult contour = run_tegl({"contour", scales, "--iso", "0", "-o", path("scales.ply"), "--json"});
  ASSERT_EQ(contour.exit, 0) << contour.err;
  EXPECT_EQ(contour.json()["dim"], 2);
  const RunResult slice =
      run_tegl({"slice", scales, "--iso", "0", "--at", "log2_sigma=-4", "-o", path("cut.ply"), "--json"});
  EXPECT_EQ(slice.exit, 0) << slice.err;
  EXPECT_EQ(slice.json()["dim"], 1);
  EXPECT_EQ(run_tegl({"measure", scales, "--iso", "0", "--json"}).exit, 0);
  EXPECT_EQ(run_tegl({"track", scales, "--iso", "0", "-o", path("tracks.json"), "-q"}).exit, 0);
}

TEST_F(ImageMakers, ContourOfAScaleSpaceNeedsNoFile) {
  const std::string volume = write("volume.nii", nifti_bytes(noise({9, 8, 7}, 1), {1, 2, 1}));
  ASSERT_EQ(run_tegl({"scale-space", volume, "--sigmas", "0.5:2:3", "-o", path("a.nrrd"), "-q"}).exit, 0);
  ASSERT_EQ(run_tegl({"contour", path("a.nrrd"), "--iso", "128", "-o", path("a.vtkhdf"), "-q"}).exit, 0);
  const RunResult run =
      run_tegl({"contour", volume, "--scale-space", "0.5:2:3", "--iso", "128", "-o", path("b.vtkhdf"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["image_dim"], 4);
  const Mesh from_file = read_mesh(path("a.vtkhdf")), direct = read_mesh(path("b.vtkhdf"));
  EXPECT_EQ(from_file.simplices, direct.simplices);
  ASSERT_EQ(from_file.coordinates.size(), direct.coordinates.size());
  for (std::size_t i = 0; i < direct.coordinates.size(); ++i)  // NRRD is in the frame LPS, NIfTI in RAS
    EXPECT_NEAR(std::abs(from_file.coordinates[i]), std::abs(direct.coordinates[i]), 1e-12);
  // a scale by axis
  ASSERT_EQ(
      run_tegl({"scale-space", volume, "--sigmas", "0.5:2:3", "--factors", "1,0,2", "-o", path("f.nrrd"), "-q"}).exit,
      0);
  ASSERT_EQ(run_tegl({"contour", path("f.nrrd"), "--iso", "128", "-o", path("f.vtkhdf"), "-q"}).exit, 0);
  ASSERT_EQ(run_tegl({"contour", volume, "--scale-space", "0.5:2:3", "--factors", "1,0,2", "--iso", "128", "-o",
                      path("g.vtkhdf"), "-q"})
                .exit,
            0);
  EXPECT_EQ(read_mesh(path("f.vtkhdf")).simplices, read_mesh(path("g.vtkhdf")).simplices);
  EXPECT_NE(read_mesh(path("g.vtkhdf")).simplices, direct.simplices);
  expect_refused({"contour", volume, "--iso", "128", "-o", path("c.vtkhdf"), "--factors", "1,0,2"},
                 "--factors 1,0,2 without --scale-space", 2);
  for (const char* const one : {"1", ""})
    expect_refused({"contour", volume, "--iso", "128", "-o", path("c.vtkhdf"), "--scale-space", one}, "--scale-space",
                   2);
  expect_refused({"scale-space", volume, "--sigmas", "0.5:2:3", "--iso", "99999", "-o", path("d.nrrd")}, "99999", 5);
  EXPECT_FALSE(std::filesystem::exists(path("d.nrrd")));
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--scale-space", "2,1"},
                                                  {"--scale-space", "0.5:2:3", "--index", volume},
                                                  {"--scale-space", "0.5:2:3", "--lattice", "fcc"}}) {
    std::vector<std::string> arguments = {"contour", volume, "--iso", "128", "-o", path("c.vtkhdf")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run_tegl(arguments).exit, 2);
  }
}

TEST_F(ImageMakers, StreamedContoursOverTheScaleAreThoseInMemory) {
  const std::string picture = write("picture.nii", nifti_bytes(noise({21, 18}, 2), {1, 2}));
  const std::string volume = write("volume.nii", nifti_bytes(noise({9, 8, 7}, 1), {1, 2, 1}));
  const std::string film = write("film.nii", nifti_bytes(noise({5, 5, 4, 3}, 1), {1, 1, 1, 1}));
  const std::vector<std::string> scales = {"contour", "--scale-space", "0.5:2:5", "--no-check", "-q"};
  const auto run = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = scales;
    arguments.push_back(file);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tegl(arguments);
  };
  for (const std::string& file : {picture, volume})
    for (std::vector<std::string> more : std::vector<std::vector<std::string>>{
             {"--iso", "120,130"}, {"--iso", "128,131", "--close", "--normals", "--threads", "3"}}) {
      SCOPED_TRACE(file + more[1]);
      more.insert(more.end(), {"-o", path("whole{n}.vtkhdf")});
      ASSERT_EQ(run(file, more).exit, 0);
      more.back() = path("streamed{n}.vtkhdf");
      more.emplace_back("--stream");
      const RunResult streamed = run(file, more);
      ASSERT_EQ(streamed.exit, 0) << streamed.err;
      for (const char* const n : {"1", "2"}) {
        const Mesh x = read_mesh(path(std::string("whole") + n + ".vtkhdf"));
        const Mesh y = read_mesh(path(std::string("streamed") + n + ".vtkhdf"));
        EXPECT_GT(x.simplices.size(), 100u);
        EXPECT_TRUE(x.simplices == y.simplices && x.coordinates == y.coordinates && x.normals == y.normals);
        EXPECT_EQ(x.axis_names, y.axis_names);
        EXPECT_EQ(y.axis_names.back(), "log2_sigma");
      }
    }
  const auto before = files();
  EXPECT_EQ(run(volume, {"--iso", "99999", "--stream", "-o", path("c.vtkhdf")}).exit, 5);
  expect_refused({"contour", film, "--iso", "128", "-o", path("c.vtkhdf"), "--scale-space", "1,2", "--stream"},
                 "--scale-space and --stream with an image of 4 axes; expected 2 or 3", 2);
  expect_refused({"contour", volume, "--iso", "128", "-o", path("c.ply"), "--scale-space", "1,2", "--stream"}, ".ply",
                 6);
  EXPECT_EQ(files(), before);
}

TEST_F(ImageMakers, StreamedContoursOverTheScaleNeedMemoryForSomeLayersOnly) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space";
#endif
  // 1 MiB of samples with 160 scales: 640 MiB
  std::string pixels(std::size_t{1024} * 1024, '\0');
  for (std::size_t y = 500; y < 530; ++y) pixels.replace(y * 1024 + 500, 30, 30, 'd');
  const std::string raw = write("picture.raw", pixels);
  const std::string out = path("scales.vtkhdf");
  const auto run = [&](const char* stream) {
    const std::string command = "ulimit -v 491520; exec " TEGL_PROGRAM " contour " + raw +
                                " --raw 1024x1024 --raw-type uint8 --scale-space 0.5:2:160 --iso 20.5 --threads 1 -q " +
                                stream + " -o " + out + " 2> " + path("said");
    return WEXITSTATUS(std::system(command.c_str()));
  };
  EXPECT_EQ(run(""), 70);
  ASSERT_EQ(run("--stream"), 0);
  const RunResult check = run_tegl({"check", out, "--json"});
  EXPECT_EQ(check.json()["components"], 1);
}

TEST_F(ImageMakers, PackedImagesOfFiveAxesAreContouredAtTheirValues) {
  const std::vector<double> places = {0, 1, 2, 3};
  Samples samples = noise({4, 4, 4, 4, 4}, 5);
  for (float& value : samples.values) value = std::round(value / 8) * 8;
  for (const double scale : {8.0, -8.0, 0.0}) {
    const std::string file = path(fmt::format("{}.nc", scale));
    write_netcdf(file, {"x", "y", "z", "t", "u"}, {places, places, places, places, places},
                 {{"noise", samples, "1", scale}});
    ASSERT_EQ(run_tegl({"contour", file, "--iso", "101", "-o", path(fmt::format("{}.vtkhdf", scale)), "-q"}).exit, 0);
    EXPECT_EQ(run_tegl({"contour", file, "--iso", "300", "-o", path("none.vtkhdf")}).exit, 5);
  }
  const auto values = read_mesh(path("0.vtkhdf"));
  EXPECT_GT(values.simplices.size(), 1000u);
  EXPECT_EQ(read_mesh(path("8.vtkhdf")).simplices, values.simplices);
  EXPECT_EQ(read_mesh(path("-8.vtkhdf")).simplices, values.simplices);
}

TEST_F(ImageMakers, ScaleSpacesOfFourAxesAreSavedCutAndTracked) {
  const std::string film = write("film.nii", nifti_bytes(noise({6, 5, 6, 4}, 1), {1, 1, 1, 1}));
  ASSERT_EQ(run_tegl({"scale-space", film, "--sigmas", "0.5:2:3", "-o", path("a.nrrd"), "-q"}).exit, 0);
  const std::vector<std::filesystem::path> files = {path("a.nrrd")};
  const auto read = std::get<ReadSeries5dResult>(read_series_to_5d(files));
  const auto& scales = std::get<OwnedImage<float, 5>>(read.image);
  EXPECT_EQ(run_tegl({"info", path("a.nrrd"), "--json"}).json()["axes"][4]["name"], "log2_sigma");
  ExtractOptions options;  // slices at a layer have the bits of the layer's contour with ambiguities from the data
  options.ambiguity = Ambiguity::mean;
  // the contour as a file, from the scale space and without it
  const RunResult contour =
      run_tegl({"contour", path("a.nrrd"), "--iso", "128", "--ambiguity", "mean", "-o", path("a.vtkhdf"), "--json"});
  ASSERT_EQ(contour.exit, 0) << contour.err;
  EXPECT_EQ(contour.json()["image_dim"], 5);
  EXPECT_EQ(contour.json()["dim"], 4);
  EXPECT_EQ(contour.json()["bad_links"], 0);
  // netCDF, too
  ASSERT_EQ(run_tegl({"scale-space", film, "--sigmas", "0.5:2:3", "-o", path("a.nc"), "-q"}).exit, 0);
  const RunResult of_netcdf =
      run_tegl({"contour", path("a.nc"), "--iso", "128", "--ambiguity", "mean", "-o", path("n.vtkhdf"), "--json"});
  ASSERT_EQ(of_netcdf.exit, 0) << of_netcdf.err;
  EXPECT_EQ(read_mesh(path("n.vtkhdf")).simplices, read_mesh(path("a.vtkhdf")).simplices);
  const Contour<5, double> saved = to_contour<5>(read_mesh(path("a.vtkhdf")));
  const auto direct = extract<double>(scales.view(), 128.0, options);
  EXPECT_TRUE(saved.simplices == direct.simplices);
  EXPECT_TRUE(saved.vertices == direct.vertices);
  ASSERT_EQ(run_tegl({"contour", film, "--scale-space", "0.5:2:3", "--iso", "128", "--ambiguity", "mean", "-o",
                      path("b.vtkhdf"), "-q"})
                .exit,
            0);
  EXPECT_TRUE(read_mesh(path("b.vtkhdf")).simplices == read_mesh(path("a.vtkhdf")).simplices);
  // cuts, from the file and from the image: at a layer the contour of the layer
  const std::string layer = path("layer.vtkhdf");
  const RunResult from_file = run_tegl({"slice", path("a.vtkhdf"), "--at", "log2_sigma=0", "-o", layer, "--json"});
  const RunResult from_image = run_tegl({"slice", path("a.nrrd"), "--iso", "128", "--ambiguity", "mean", "--at",
                                         "log2_sigma=0", "-o", path("c.vtkhdf"), "--json"});
  ASSERT_EQ(from_file.exit, 0) << from_file.err;
  ASSERT_EQ(from_image.exit, 0) << from_image.err;
  Grid<4> grid = Grid<4>::unit({6, 5, 6, 4});
  std::copy_n(scales.grid.axes.begin(), 4, grid.axes.begin());
  const std::size_t layer_size = scales.values.size() / 3;
  const auto of_layer = extract<double>(Image<float, 4>(scales.values.data() + layer_size, grid), 128.0, options);
  EXPECT_EQ(from_file.json()["simplices"], of_layer.simplices.size());
  EXPECT_EQ(from_file.json()["euler"], check(of_layer).euler);
  EXPECT_EQ(from_image.json()["simplices"], from_file.json()["simplices"]);
  EXPECT_EQ(run_tegl({"slice", path("a.vtkhdf"), "--plane", "0,0,0,1,1=2", "-o", layer, "-q"}).exit, 0);
  // measures and tracks
  const auto size = run_tegl({"measure", path("a.vtkhdf"), "--at", "log2_sigma=0", "--json"}).json();
  EXPECT_NEAR(size["cuts"][0]["size"], measure(of_layer).size, 1e-9);
  const RunResult tracks =
      run_tegl({"track", path("a.nrrd"), "--iso", "128", "--ambiguity", "mean", "-o", path("t.svg"), "--json"});
  ASSERT_EQ(tracks.exit, 0) << tracks.err;
  EXPECT_EQ(tracks.json()["graph"]["space_dim"], 5);
  EXPECT_EQ(run_tegl({"track", path("a.vtkhdf"), "-o", path("t.json"), "--json"}).json()["events_by_kind"],
            tracks.json()["events_by_kind"]);
  const std::string bytes(reinterpret_cast<const char*>(scales.values.data()), scales.values.size() * sizeof(float));
  const RunResult raw = run_tegl({"contour", write("a.raw", bytes), "--raw", "6x5x6x4x3", "--raw-type", "float",
                                  "--iso", "128", "--ambiguity", "mean", "-o", path("r.vtkhdf"), "--json"});
  ASSERT_EQ(raw.exit, 0) << raw.err;
  EXPECT_EQ(raw.json()["simplices"], contour.json()["simplices"]);
  // files of 4 axes are one image of 5
  const std::string next = write("next.nrrd", nrrd_bytes(noise({6, 5, 6, 4}, 2), ""));
  const RunResult series = run_tegl({"contour", write("first.nrrd", nrrd_bytes(noise({6, 5, 6, 4}, 1), "")), next,
                                     "--iso", "128", "--times", "0,2", "-o", path("series.vtkhdf"), "--json"});
  ASSERT_EQ(series.exit, 0) << series.err;
  EXPECT_EQ(read_mesh(path("series.vtkhdf")).axis_names, (std::vector<std::string>{"x", "y", "z", "t", "u"}));
  // what is for fewer dimensions
  expect_refused({"contour", path("a.nrrd"), "--iso", "128", "--ambiguity", "mean", "-o", path("c.ply")}, "4-simplices",
                 6);
  expect_refused({"contour", path("a.nrrd"), "--iso", "128", "--ambiguity", "mean", "--samples-are", "cells", "-o",
                  path("c.vtkhdf")},
                 "with an image of 5 axes", 2);
  expect_refused({"contour", path("a.nrrd"), "--iso", "128", "--positions", "gravitation", "-o", path("c.vtkhdf")},
                 "--positions gravitation with an image of 5 axes; expected --positions linear or relaxed", 2);
  expect_refused({"contour", path("a.nrrd"), "--iso", "128", "--scale-space", "1,2", "-o", path("c.vtkhdf")},
                 "--scale-space with an image of 5 axes", 2);
  expect_refused({"simplify", path("a.vtkhdf"), "--ratio", "0.5", "-o", path("c.vtkhdf")}, "5D contour", 4);
  expect_refused({"filter", path("a.nrrd"), "--median", "1", "-o", path("c.nrrd")}, "image of 5 axes", 4);
}

TEST_F(ImageMakers, FactorsOfScalesAreByAxis) {
  const std::string film = write("film.nii", nifti_bytes(noise({9, 8, 7}, 1), {1, 2, 1}));
  ASSERT_EQ(run_tegl({"scale-space", film, "--sigmas", "1,2", "--factors", "1,1,0.5", "-o", path("a.nrrd"), "-q"}).exit,
            0);
  const auto image = std::get<OwnedImage<float, 3>>(std::get<AnyImageN<3>>(read_image(film).image));
  ScaleSpaceOptions options;
  options.factors = {1, 1, 0.5};
  EXPECT_EQ(floats<4>("a.nrrd").values, (ScaleSpaceLayers<float, 3>(image.view(), {1, 2}, options).all().values));
  for (const char* const factors : {"1,1", "1,1,-1", "1,1,x"})
    EXPECT_EQ(run_tegl({"scale-space", film, "--sigmas", "1,2", "--factors", factors, "-o", path("b.nrrd")}).exit, 2);
}

TEST_F(ImageMakers, SamplesOfALatticeAreContouredOnIt) {
  for (const char* const lattice : {"triangular", "fcc", "bcc", "d4", "fcc_in_time"}) {
    ASSERT_EQ(run_tegl({"sample", "ball", "--lattice", lattice, "--size", "12", "--set", "radius=0.6", "-o",
                        path("a.nrrd"), "-q"})
                  .exit,
              0);
    const RunResult run = run_tegl({"contour", path("a.nrrd"), "--iso", "0", "-o", path("a.vtkhdf"), "--json"});
    ASSERT_EQ(run.exit, 0) << run.err;
    EXPECT_EQ(run.json()["components"], 1) << lattice;
    EXPECT_EQ(run.json()["boundary_simplices"], 0) << lattice;
  }
}

TEST_F(ImageMakers, SamplesHaveTheirRangeAndSizes) {
  ASSERT_EQ(run_tegl({"sample", "ball", "--dim", "5", "--size", "6", "-o", path("five.nrrd"), "-q"}).exit, 0);
  const RunResult five = run_tegl({"contour", path("five.nrrd"), "--iso", "0", "-o", path("five.vtkhdf"), "--json"});
  ASSERT_EQ(five.exit, 0) << five.err;
  EXPECT_EQ(five.json()["dim"], 4);
  EXPECT_EQ(five.json()["boundary_simplices"], 0);
  for (const char* const option : {"--facets", "--stream"}) {
    const RunResult refused = run_tegl({"contour", path("five.nrrd"), "--iso", "0", option, "-o", path("no.vtkhdf")});
    EXPECT_EQ(refused.exit, 2) << refused.err;
    EXPECT_EQ(refused.err, std::string("tegl: ") + option + " with an image of 5 axes; expected 2 to 4 axes\n");
  }
  const auto divided = [&](const char* division, const char* option) {
    const RunResult made = run_tegl(
        {"contour", path("five.nrrd"), "--iso", "0", "--division", division, option, "-o", path("d.vtkhdf"), "--json"});
    EXPECT_EQ(made.exit, 0) << made.err;
    return made.json();
  };
  const nlohmann::json kuhn = divided("kuhn", "--close");
  EXPECT_EQ(kuhn["euler"], 2);
  EXPECT_EQ(kuhn["boundary_simplices"], 0);
  EXPECT_EQ(kuhn["tiles"], 3125 * 120);
  EXPECT_EQ(divided("symmetric", "--no-check")["tiles"], 3125 * 1920);
  // other commands contour the image in the same way
  const RunResult cut = run_tegl({"slice", path("five.nrrd"), "--iso", "0", "--division", "kuhn", "--at", "u=0.2", "-o",
                                  path("cut.vtkhdf"), "--json"});
  ASSERT_EQ(cut.exit, 0) << cut.err;
  EXPECT_EQ(cut.json()["euler"], 0);  // a 3-sphere
  EXPECT_EQ(cut.json()["boundary_simplices"], 0);
  const RunResult size = run_tegl({"measure", path("five.nrrd"), "--iso", "0", "--division", "kuhn", "--json"});
  ASSERT_EQ(size.exit, 0) << size.err;
  EXPECT_GT(size.json()["content"], 0.5);
  const auto expect_no_division = [&](const std::vector<std::string>& with, const std::string& part) {
    std::vector<std::string> arguments = {"contour", path("five.nrrd"), "--iso", "0", "--division", "kuhn",
                                          "-o",      path("no.vtkhdf")};
    arguments.insert(arguments.end(), with.begin(), with.end());
    expect_refused(arguments, part, 2);
  };
  expect_no_division({"--normals", "context"}, "normals context of a divided image; expected gradients of other kinds");
  expect_no_division({"--periodic", "auto"}, "--periodic auto with an image of 5 axes; expected names of axes");
  expect_refused({"contour", path("five.nrrd"), "--iso", "0", "--periodic", "x", "-o", path("no.vtkhdf")},
                 "--periodic x with an image of 5 axes; expected --division kuhn or symmetric with it", 2);
  expect_no_division({"--triangulation", "barycentric"},
                     "--triangulation barycentric with --division and an image of 5 axes; expected compact");
  expect_refused({"contour", path("five.nrrd"), "--iso", "0", "--division", "hybrid", "-o", path("no.vtkhdf")},
                 "division hybrid of a 5D image; expected kuhn or symmetric", 2);
  // periodic axes: wrapped in .vtkhdf, unrolled on request; cut along and across the period
  ASSERT_EQ(run_tegl({"sample", "ball", "--dim", "5", "--size", "4", "-o", path("four.nrrd"), "-q"}).exit, 0);
  const auto periodic = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"contour",   path("four.nrrd"), "--iso", "-0.5", "--division",
                                          "kuhn",      "--periodic",      "x,y",   "-o",   path("p.vtkhdf"),
                                          "--normals", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult made = run_tegl(arguments);
    EXPECT_EQ(made.exit, 0) << made.err;
    return made.json();
  };
  EXPECT_EQ(periodic({"--close"})["boundary_simplices"], 0);
  EXPECT_EQ(read_mesh(path("p.vtkhdf")).periods.size(), 2 * 11u);
  EXPECT_GT(periodic({"--close", "--unroll"})["boundary_simplices"], 0);
  for (const char* const place : {"u=0.2", "x=0.1"}) {
    const RunResult part = run_tegl({"slice", path("four.nrrd"), "--iso", "-0.5", "--division", "kuhn", "--periodic",
                                     "x,y", "--close", "--at", place, "-o", path("cut.vtkhdf"), "--json"});
    ASSERT_EQ(part.exit, 0) << part.err;
    EXPECT_GT(part.json()["simplices"], 100);
    EXPECT_EQ(part.json()["boundary_simplices"], 0) << place;
  }
  const RunResult about = run_tegl({"info", path("five.vtkhdf"), "--json"});
  ASSERT_EQ(about.exit, 0) << about.err;
  EXPECT_EQ(about.json()["image_dim"], 5);
  EXPECT_EQ(about.json()["simplices"], five.json()["simplices"]);
  const RunResult run = run_tegl({"sample", "ball", "--size", "5,4,3", "--range", "0:2", "-o", path("a.nc"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["input"], nullptr);
  EXPECT_EQ(run.json()["kind"], "ball");
  const auto image = floats<3>("a.nc");
  EXPECT_EQ(image.grid.axes[0][1], 0.5);
  EXPECT_EQ(image.grid.axes[2][2], 2.0);
  EXPECT_NEAR(image.values[1], 0.8 - 0.5, 1e-6);
}

TEST_F(ImageMakers, NameWhatIsWrong) {
  const std::string picture = write("a.nrrd", nrrd_bytes(noise({4, 4}, 1)));
  const std::string out = path("out.nrrd");
  expect_refused({"scale-space", picture, "--sigmas", "2:1:4", "-o", out},
                 "--sigmas 2:1:4: 4 scales from 2 to 1; expected", 2);
  expect_refused({"scale-space", picture, "--sigmas", "1:2:1.5", "-o", out}, "has the count 1.5", 2);
  expect_refused({"scale-space", picture, "--sigmas", "2,1", "-o", out}, "expected ascending scales", 2);
  expect_refused({"scale-space", picture, "--sigmas", "1,2,3", "-o", out}, "has uneven steps, which NRRD cannot hold",
                 6);
  EXPECT_THAT(run_tegl({"scale-space", picture, "--sigmas", "1,2,3", "-o", out}).err,
              AllOf(HasSubstr("out.nrrd"), Not(HasSubstr("a.nrrd"))));
  expect_refused({"sample", "cube", "-o", out}, "no field 'cube'; expected ball", 2);
  expect_refused({"sample", "ball", "--set", "size=3", "-o", out}, "has no parameter 'size'; expected radius", 2);
  expect_refused({"sample", "ball", "--set", "radius=nan", "-o", out}, "--set radius is 'nan'", 2);
  expect_refused({"sample", "ball", "--set", "radius=-1", "-o", out}, "radius is -1; expected a positive number", 2);
  expect_refused({"sample", "orbital", "--set", "n=1.5", "-o", out}, "n is 1.5; expected a whole number from 1 to 12",
                 2);
  expect_refused({"sample", "ball", "--set", "radius", "-o", out}, "--set is 'radius'; expected NAME=NUMBER", 2);
  expect_refused({"sample", "ball", "--size", "5,4", "-o", out}, "--size has 2 numbers; expected one", 2);
  expect_refused({"sample", "ball", "--size", "1", "-o", out}, "--size has 1; expected whole numbers from 2", 2);
  expect_refused({"sample", "ball", "--range", "1:0", "-o", out}, "--range is '1:0'", 2);
  expect_refused({"sample", "ball", "--range=-1e308:1e308", "-o", out}, "--range is '-1e308:1e308'", 2);
  expect_refused({"sample", "ball", "--lattice", "d4", "--dim", "3", "-o", out},
                 "--lattice d4 with --dim 3; expected 4", 2);
  expect_refused({"sample", "x +", "--set", "a=1", "-o", out}, "--set with an expression", 2);
  expect_refused({"sample", "x + 1", "--seed", "0", "-o", out}, "--seed with an expression; expected it with", 2);
  expect_refused({"sample", "gyroid", "--seed", "7", "-o", out}, "--seed with gyroid, which has no random numbers", 2);
  EXPECT_THAT(files(), ElementsAre("a.nrrd"));
}

}  // namespace
}  // namespace tegl::test
