// SPDX-License-Identifier: BSD-3-Clause
//
// The command tegl filter: the library's results in files with the coordinates of the image, streaming, errors.
#include "tegl/filter.hpp"

#include <gmock/gmock.h>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <int N>
const OwnedImage<float, N>& floats(const ReadImageResult& read) {
  return std::get<OwnedImage<float, N>>(std::get<AnyImageN<N>>(read.image));
}

class FilterCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    volume_ = write("volume.nii", nifti_bytes(noise({9, 8, 7}, 1), {1, 2, 0.5F}));
    film_ = write("film.nii", nifti_bytes(noise({6, 5, 4, 7}, 2), {1, 1, 1, 2}));
  }
  [[nodiscard]] const std::string& volume() const { return volume_; }
  [[nodiscard]] const std::string& film() const { return film_; }

 private:
  std::string volume_, film_;
};

TEST_F(FilterCommand, SigmasAreInUnitsOfTheAxes) {
  const RunResult run = run_tegl({"filter", volume(), "--gaussian", "1.5", "-o", path("a.nrrd"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["kind"], "gaussian");
  EXPECT_EQ(run.json()["value_type"], "float");
  EXPECT_THAT(run.json()["sizes"], ElementsAre(9, 8, 7));
  const ReadImageResult input = read_image(volume()), output = read_image(path("a.nrrd"));
  const auto& image = floats<3>(input);
  SeparableConvolution filter{{gaussian_weights(1.5), gaussian_weights(0.75), gaussian_weights(3)}};
  EXPECT_EQ(floats<3>(output).values, filter_image(image.view(), filter).values);
  for (int a = 0; a < 3; ++a) {
    EXPECT_EQ(std::abs(floats<3>(output).grid.axes[a].step()), std::abs(image.grid.axes[a].step()));
    EXPECT_EQ(floats<3>(output).grid.axes[a].unit, "mm");
  }
  // in samples, one for each axis
  ASSERT_EQ(run_tegl({"filter", volume(), "--gaussian", "1.5,0.75,3", "--samples", "-o", path("b.nrrd"), "-q"}).exit,
            0);
  EXPECT_EQ(floats<3>(read_image(path("b.nrrd"))).values, floats<3>(output).values);
}

TEST_F(FilterCommand, CurvatureFlowIsInUnitsOfTheAxesAndLeavesTheTime) {
  ASSERT_EQ(run_tegl({"filter", volume(), "--curvature", "0.5", "-o", path("a.nrrd"), "-q"}).exit, 0);
  const ReadImageResult input = read_image(volume()), frames = read_image(film());
  EXPECT_EQ(floats<3>(read_image(path("a.nrrd"))).values,
            filter_image(floats<3>(input).view(), CurvatureFlow{{1, 2, 0.5}, 0.5}).values);
  ASSERT_EQ(run_tegl({"filter", film(), "--curvature", "0.5", "--stream", "-o", path("b.nrrd"), "-q"}).exit, 0);
  EXPECT_EQ(floats<4>(read_image(path("b.nrrd"))).values,
            filter_image(floats<4>(frames).view(), CurvatureFlow{{1, 1, 1, 0}, 0.5}).values);
  // a time in which everything vanishes
  EXPECT_EQ(run_tegl({"filter", volume(), "--curvature", "0.5", "-o", path("c.nrrd")}).err, "");
  const RunResult all = run_tegl({"filter", volume(), "--curvature", "500", "-o", path("c.nrrd")});
  EXPECT_EQ(all.exit, 0);
  EXPECT_NE(all.err.find("all closed contours vanish in this time"), std::string::npos) << all.err;
  // a flow of too many steps is refused
  const RunResult long_flow = run_tegl({"filter", volume(), "--curvature", "5000000", "-o", path("d.nrrd")});
  EXPECT_EQ(long_flow.exit, 2);
  EXPECT_NE(long_flow.err.find("steps; expected at most 100000"), std::string::npos) << long_flow.err;
  EXPECT_NE(all.err.find(" steps\n"), std::string::npos) << all.err;
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--curvature", "-1"}, {"--curvature", "x"}, {"--curvature", "1", "--fill"}}) {
    std::vector<std::string> arguments = {"filter", volume(), "-o", path("c.nrrd")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run_tegl(arguments).exit, 2);
  }
}

TEST_F(FilterCommand, TheTimeHasItsOwnSigma) {
  const auto filtered = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"filter", film(), "-o", path("a.nrrd"), "-q"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return floats<4>(read_image(path("a.nrrd"))).values;
  };
  const ReadImageResult input = read_image(film());
  const auto expected = [&](double space, double time) {
    SeparableConvolution filter{std::vector<AxisWeights>(3, binomial_weights(space))};
    filter.weights.push_back(time == 0 ? AxisWeights() : binomial_weights(time));
    return filter_image(floats<4>(input).view(), filter).values;
  };
  EXPECT_EQ(filtered({"--binomial", "1"}), expected(1, 0));
  EXPECT_EQ(filtered({"--binomial", "1", "--time-sigma", "3"}), expected(1, 1.5));  // steps of 2 s
  EXPECT_EQ(filtered({"--binomial", "1,1,1", "--time-sigma", "3"}), expected(1, 1.5));
  EXPECT_EQ(filtered({"--binomial", "1,1,1,3"}), expected(1, 1.5));
}

TEST_F(FilterCommand, StreamsTheSameFile) {
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"--gaussian", "1"},
           {"--median", "1"},
           {"--bilateral", "1", "--value-sigma", "40"},
           {"--contextual", "128"},
           {"--kernel", "1x3x3:1,2,1,2,4,2,1,2,1", "--normalize", "--border", "cyclic"}}) {
    std::vector<std::string> arguments = {"filter", volume(), "-q", "-o", path("whole.nc")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    ASSERT_EQ(run_tegl(arguments).exit, 0);
    arguments[4] = path("streamed.nc");
    arguments.emplace_back("--stream");
    const RunResult run = run_tegl(arguments);
    ASSERT_EQ(run.exit, 0) << run.err;
    EXPECT_EQ(floats<3>(read_image(path("whole.nc"))).values, floats<3>(read_image(path("streamed.nc"))).values);
  }
}

TEST_F(FilterCommand, AFilteredImageIsContoured) {
  ASSERT_EQ(run_tegl({"filter", volume(), "--median", "2", "-o", path("clean.nrrd"), "-q"}).exit, 0);
  const RunResult run = run_tegl({"contour", path("clean.nrrd"), "--iso", "128", "-o", path("clean.ply"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_GT(run.json()["simplices"], 0);
}

TEST_F(FilterCommand, AMeshIsNoImage) {
  const std::string mesh = R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid/></VTKFile>)";
  const RunResult of_mesh = run_tegl({"filter", write("mesh.vtu", mesh), "--median", "1", "-o", path("a.nrrd")});
  EXPECT_EQ(of_mesh.exit, 4);
  EXPECT_THAT(of_mesh.err,
              HasSubstr("expected an image: ImageData or RectilinearGrid; commands with --iso, and info,"));
}

TEST_F(FilterCommand, NamesWhatIsWrong) {
  const auto refused = [&](std::vector<std::string> options, const std::string& part, int exit) {
    options.insert(options.begin(), {"filter", volume()});
    if (std::find(options.begin(), options.end(), "-o") == options.end())
      options.insert(options.end(), {"-o", path("a.nrrd")});
    const RunResult run = run_tegl(options);
    EXPECT_EQ(run.exit, exit) << run.err;
    EXPECT_THAT(run.err, HasSubstr(part));
  };
  refused({}, "no filter; expected one of --gaussian", 2);
  refused({"--gaussian", "1", "--median", "1"}, "--gaussian and --median together", 2);
  refused({"--gaussian", "1,2"}, "--gaussian has 2 numbers; expected one, or one for each of 3 axes", 2);
  refused({"--gaussian", "wide"}, "wide", 2);
  refused({"--gaussian", "-1"}, "--gaussian is -1; expected 0 or more", 2);
  refused({"--gaussian", "1", "--time-sigma", "1"}, "no axis is a time", 2);
  refused({"--gaussian", "1", "--time-sigma", "-2"}, "no axis is a time", 2);
  const RunResult negative =
      run_tegl({"filter", film(), "--gaussian", "1", "--time-sigma", "-2", "-o", path("a.nrrd")});
  EXPECT_EQ(negative.exit, 2);
  EXPECT_THAT(negative.err, HasSubstr("--time-sigma is -2; expected 0 or more"));
  const RunResult twice =
      run_tegl({"filter", film(), "--gaussian", ".2,.2,.2,.2", "--time-sigma", ".9", "-o", path("a.nrrd")});
  EXPECT_EQ(twice.exit, 2);
  EXPECT_THAT(twice.err, HasSubstr("--gaussian .2,.2,.2,.2 and --time-sigma .9 both give a sigma of the time"));
  refused({"--median", "0.5"}, "--median is 0.5; expected whole numbers", 2);
  refused({"--median", "1", "--samples"}, "--samples with --median, which has no sigma", 2);
  refused({"--median", "1", "--value-sigma", "1"}, "expected it with --bilateral", 2);
  refused({"--bilateral", "1"}, "--bilateral without --value-sigma", 2);
  refused({"--kernel", "1,2,1"}, "expected sizes and weights, as in 3x1:-0.5,0,0.5", 2);
  refused({"--kernel", "2x1x1:1,1"}, "2 weights along axis 0; expected an odd number", 2);
  refused({"--kernel", "3x1x1:1,1"}, "the kernel has 2 weights; expected 3", 2);
  refused({"--kernel", "3x3:1,2,1,2,4,2,1,2,1"}, "--kernel has 2 sizes; expected 3, one for each axis", 2);
  refused({"--kernel", "3x1x1:-1,0,1", "--normalize"}, "weights whose sum is 0", 2);
  refused({"--median", "1", "--border", "round"}, "--border is 'round'; expected extended, cyclic or missing", 2);
  refused({"--median", "1", "--border", "cyclic,cyclic"}, "2 borders; expected one for each of 3 axes", 2);
  refused({"--median", "1", "-o", path("a.png")}, "the extension '.png' is not known; expected .nrrd", 6);
  EXPECT_THAT(files(), ElementsAre("film.nii", "volume.nii"));
}

}  // namespace
}  // namespace tegl::test
