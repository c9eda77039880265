// SPDX-License-Identifier: BSD-3-Clause
//
// --positions of tegl contour, run as in a shell.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class PositionsCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const auto ball = [](const std::vector<double>& x) {
      return 8.3 - std::hypot(x[0] - 11.6, x[1] - 10.4, x[2] - 11);
    };
    mask_ = write("mask.nii",
                  nifti_bytes(sample({24, 22, 23}, [&](const auto& x) { return ball(x) > 0 ? 1.0 : 0.0; }), {1, 1, 1}));
    field_ = write("field.nii",
                   nifti_bytes(sample({24, 22, 23}, [&](const auto& x) { return 0.5 + 0.1 * ball(x); }), {1, 1, 1}));
  }
  [[nodiscard]] RunResult run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"contour", mask_, "--iso", "0.5"});
    return run_tegl(arguments);
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& message) const {
    const RunResult result = run(arguments);
    EXPECT_NE(result.exit, 0);
    EXPECT_THAT(result.err, HasSubstr(message));
  }
  /// Root mean square distance of the mesh's vertices from the sphere.
  [[nodiscard]] double error_of(const std::string& file) const {
    const Mesh mesh = read_mesh(file);
    double sum = 0;
    for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3) {
      const double distance =
          std::hypot(mesh.coordinates[i] - 11.6, mesh.coordinates[i + 1] - 10.4, mesh.coordinates[i + 2] - 11) - 8.3;
      sum += distance * distance;
    }
    return std::sqrt(3 * sum / static_cast<double>(mesh.coordinates.size()));
  }
  std::string mask_, field_;
};

TEST_F(PositionsCommand, MaskGetsTheSurfaceOfItsShape) {
  const std::string output = path("surface.ply");
  ASSERT_EQ(run({"-o", output}).exit, 0);
  EXPECT_GT(error_of(output), 0.2);
  ASSERT_EQ(run({"--positions", "relaxed", "-o", output}).exit, 0);
  EXPECT_LT(error_of(output), 0.17);
  ASSERT_EQ(run({"--positions", "gravitation", "-o", output}).exit, 0);
  EXPECT_LT(error_of(output), 0.25);
  ASSERT_EQ(run({"--positions", "filtered", "--positions-image", field_, "-o", output}).exit, 0);
  EXPECT_LT(error_of(output), 0.02);
  ASSERT_EQ(run({"--positions", "relaxed", "--last-axis-weight", "0", "-o", output}).exit, 0);
}

TEST_F(PositionsCommand, MasksNeedNoIsovalueAndLabelsAreMasks) {
  ASSERT_EQ(run({"--positions", "relaxed", "-o", path("a.ply")}).exit, 0);
  const RunResult middle = run_tegl({"contour", mask_, "--positions", "relaxed", "-o", path("b.ply"), "--json"});
  ASSERT_EQ(middle.exit, 0) << middle.err;
  EXPECT_THAT(middle.err, HasSubstr("the isovalue is 0.5, the middle of the image's two values, 0 and 1"));
  EXPECT_EQ(middle.json()["isovalue"], 0.5);
  EXPECT_EQ(read_mesh(path("b.ply")).coordinates, read_mesh(path("a.ply")).coordinates);
  // the number found is in the name of the file
  const RunResult named = run_tegl({"contour", mask_, "--positions", "relaxed", "-o", path("m_{iso}.ply"), "--json"});
  EXPECT_EQ(named.json()["output"], path("m_0.5.ply")) << named.err << named.out;
  EXPECT_EQ(read_mesh(path("m_0.5.ply")).coordinates, read_mesh(path("a.ply")).coordinates);
  const RunResult no_folder = run_tegl({"contour", mask_, "--positions", "relaxed", "-o", path("no{iso}/m.ply")});
  EXPECT_EQ(no_folder.exit, 6);
  EXPECT_THAT(no_folder.err, HasSubstr("no0.5"));
  const auto labels = [](const std::vector<double>& x) {
    return std::hypot(x[0] - 11.6, x[1] - 10.4, x[2] - 11) < 8.3 ? 7.0 : x[0] < 4 ? 9.0 : 0.0;
  };
  const std::string image = write("labels.nii", nifti_bytes(sample({24, 22, 23}, labels), {1, 1, 1}));
  const RunResult seven =
      run_tegl({"contour", image, "--label", "7", "--positions", "relaxed", "-o", path("c.ply"), "--json"});
  ASSERT_EQ(seven.exit, 0) << seven.err;
  EXPECT_EQ(read_mesh(path("c.ply")).coordinates, read_mesh(path("a.ply")).coordinates);
  const RunResult many = run_tegl({"contour", image, "--positions", "relaxed", "-o", path("d.ply")});
  EXPECT_EQ(many.exit, 2);
  EXPECT_THAT(many.err, HasSubstr("more than two values, such as"));
  EXPECT_EQ(seven.json()["label"], 7);
  const auto tenths = [&](const std::vector<double>& x) { return labels(x) / 10; };
  const std::string of_reals = write("reals.nii", nifti_bytes(sample({24, 22, 23}, tenths), {1, 1, 1}));
  EXPECT_EQ(run_tegl({"contour", of_reals, "--label", "0.7", "-o", path("c.ply")}).exit, 0);
  const RunResult absent = run_tegl({"contour", image, "--label", "6.5", "-o", path("d.ply")});
  EXPECT_EQ(absent.exit, 5);
  EXPECT_THAT(absent.err,
              testing::ContainsRegex("--label 6.5: no sample has this value; expected one that samples have, "
                                     "such as [0-6] or 7"));
  EXPECT_EQ(run_tegl({"contour", image, "--label", "8", "-o", path("d.ply")}).exit, 5);
  const RunResult above = run_tegl({"contour", image, "--label", "10", "-o", path("d.ply")});
  EXPECT_THAT(above.err, testing::HasSubstr("expected one that samples have: the greatest is 9"));
  EXPECT_EQ(run_tegl({"contour", image, "--label", "8", "--allow-empty", "-o", path("e.ply")}).exit, 0);
  EXPECT_EQ(run_tegl({"contour", image, "--label", "7", "--iso", "1", "-o", path("d.ply")}).exit, 2);
  EXPECT_EQ(run_tegl({"contour", image, "--label", "x", "-o", path("d.ply")}).exit, 2);
  EXPECT_EQ(run_tegl({"contour", image, "--label", "7", "--stream", "-o", path("d.vtkhdf")}).exit, 2);
  EXPECT_EQ(run_tegl({"contour", image, "-o", path("d.ply")}).exit, 2);
  EXPECT_FALSE(std::filesystem::exists(path("d.ply")));
}

TEST_F(PositionsCommand, MasksOfFiveAxesHaveRelaxedPositions) {
  std::string bytes;  // a ball
  for (std::size_t i = 0; i < 6 * 6 * 6 * 6 * 6; ++i) {
    double sum = 0;
    for (std::size_t rest = i, a = 0; a < 5; ++a, rest /= 6)
      sum += (static_cast<double>(rest % 6) - 2.4) * (static_cast<double>(rest % 6) - 2.4);
    bytes.push_back(sum < 4 ? 1 : 0);
  }
  const std::string raw = write("mask.raw", bytes);
  const auto contour = [&](const std::vector<std::string>& more, const std::string& output) {
    std::vector<std::string> arguments = {"contour",    raw,     "--raw", "6x6x6x6x6",
                                          "--raw-type", "uint8", "-o",    path(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return read_mesh(path(output));
  };
  const Mesh linear = contour({"--iso", "0.5"}, "a.vtkhdf"), relaxed = contour({"--positions", "relaxed"}, "b.vtkhdf");
  const Mesh label = contour({"--label", "1", "--positions", "relaxed"}, "c.vtkhdf");
  EXPECT_GT(linear.simplices.size(), 1000u);
  EXPECT_EQ(relaxed.simplices, linear.simplices);
  EXPECT_NE(relaxed.coordinates, linear.coordinates);
  EXPECT_EQ(relaxed.coordinates, label.coordinates);
  const auto spread = [](const Mesh& mesh) {
    double least = 100, most = 0;
    for (std::size_t i = 0; i < mesh.coordinates.size(); i += 5) {
      double sum = 0;
      for (std::size_t a = 0; a < 5; ++a) sum += std::pow(mesh.coordinates[i + a] - 2.4, 2);
      least = std::min(least, std::sqrt(sum));
      most = std::max(most, std::sqrt(sum));
    }
    return most - least;
  };
  EXPECT_LT(spread(relaxed), spread(linear));
}

TEST_F(PositionsCommand, WrongOptionsAreRefused) {
  const std::string output = path("none.vtkhdf");
  expect_refused({"--positions", "smooth", "-o", output}, "--positions");
  expect_refused({"--positions", "filtered", "-o", output}, "without --positions-image");
  expect_refused({"--positions-image", field_, "-o", output}, "expected --positions filtered");
  ASSERT_EQ(run_tegl({"sample", "ball", "--lattice", "fcc", "--size", "8", "-o", path("fcc.nrrd")}).exit, 0);
  expect_refused({"--positions", "filtered", "--positions-image", path("fcc.nrrd"), "-o", output},
                 "fcc.nrrd is on the lattice fcc; expected an image on a cubic grid");
  expect_refused({"--positions", "filtered", "--positions-image", path("nowhere.nii"), "-o", output},
                 "--positions-image " + path("nowhere.nii"));
  expect_refused({"--positions", "relaxed", "--last-axis-weight=-1", "-o", output}, "--last-axis-weight is -1");
  expect_refused({"--last-axis-weight", "2", "-o", output}, "expected --positions relaxed");
  expect_refused({"--positions", "relaxed", "--stream", "-o", output}, "--positions relaxed with --stream");
  expect_refused({"--positions", "relaxed", "--pick", "1,2,3", "-o", output}, "--positions relaxed with --pick");
  expect_refused({"--positions", "relaxed", "--facets", "-o", path("none.vtu")}, "--positions relaxed with --facets");
  expect_refused({"--positions", "relaxed", "--periodic", "x", "-o", output}, "--positions relaxed with --periodic x;");
  expect_refused({"--positions", "relaxed", "--division", "kuhn", "-o", output},
                 "--positions relaxed with --division kuhn; expected one of the two");
  const std::string small =
      write("small.nii", nifti_bytes(sample({24, 22, 5}, [](const auto&) { return 1.0; }), {1, 1, 1}));
  expect_refused({"--positions", "filtered", "--positions-image", small, "-o", output},
                 "has 24 x 22 x 5 samples; expected 24 x 22 x 23");
  EXPECT_FALSE(std::filesystem::exists(output));
}

}  // namespace
}  // namespace tegl::test
