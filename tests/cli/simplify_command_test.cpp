// SPDX-License-Identifier: BSD-3-Clause
//
// tegl simplify, run as in a shell.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "distance_oracle.hpp"
#include "sample_files.hpp"
#include "tegl/check.hpp"
#include "tegl/io.hpp"
#include "tegl/simplify.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class SimplifyCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    file_ = write("ball.nii", nifti_bytes(tegl::test::ball({20, 20, 20}, 7), {1, 1, 1}));
  }
  /// Runs with these arguments after the image and its isovalue; expects success.
  [[nodiscard]] nlohmann::json run_json(const std::vector<std::string>& more, const std::string& out) const {
    std::vector<std::string> arguments = {"simplify", file_, "--iso", "0", "-o", path(out), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  }
  void expect_refused(int exit, const std::vector<std::string>& more, const std::vector<std::string>& parts) const {
    std::vector<std::string> arguments = {"simplify", file_, "--iso", "0", "-o", path("refused.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.err;
    for (const std::string& part : parts) EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(std::filesystem::exists(path("refused.ply")));
  }
  [[nodiscard]] Contour<3, double> saved(const std::string& name) const { return to_contour<3>(read_mesh(path(name))); }
  std::string file_;
};

TEST_F(SimplifyCommand, LeavesTheShareThatWasAskedForAndAManifold) {
  for (const char* method : {"quadric", "facets", "vertices"}) {
    SCOPED_TRACE(method);
    const nlohmann::json report = run_json({"--ratio", "0.1", "--method", method}, "tenth.vtkhdf");
    EXPECT_EQ(report["method"], method);
    const auto before = report["simplices_before"].get<std::uint64_t>(),
               after = report["simplices"].get<std::uint64_t>();
    EXPECT_LE(after, before / 10 + 1);
    EXPECT_GE(after, before / 20);
    EXPECT_EQ(report["error"], std::max(report["error_of_original"], report["error_of_result"]));
    const RunResult checked = run_tegl({"check", path("tenth.vtkhdf"), "--json"});
    EXPECT_EQ(checked.exit, 0) << checked.out;
    EXPECT_EQ(checked.json()["euler"], 2);
    // The file contains the largest error.
    const Mesh mesh = read_mesh(path("tenth.vtkhdf"));
    ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
    EXPECT_EQ(mesh.vertex_attributes[0].name, "simplification_error");
    EXPECT_EQ(*std::max_element(mesh.vertex_attributes[0].values.begin(), mesh.vertex_attributes[0].values.end()),
              report["error"]);
  }
}

TEST_F(SimplifyCommand, KeepsTheLargestErrorAsSamplesShow) {
  ASSERT_EQ(run_tegl({"contour", file_, "--iso", "0", "-o", path("all.ply"), "-q"}).exit, 0);
  const Contour<3, double> original = saved("all.ply");
  std::size_t last = original.simplices.size();
  for (const double allowed : {0.02, 0.1, 0.5}) {
    const nlohmann::json report = run_json({"--max-error", std::to_string(allowed)}, "near.ply");
    EXPECT_LE(report["error"], allowed);
    EXPECT_GE(report["rounds"], 1);
    const Contour<3, double> result = saved("near.ply");
    EXPECT_LT(result.simplices.size(), last);
    last = result.simplices.size();
    EXPECT_LE(sampled_deviation(original, result, 100, 1), allowed);
    EXPECT_LE(sampled_deviation(result, original, 100, 2), allowed);
  }
}

TEST_F(SimplifyCommand, OfASavedContourIsThatOfTheImage) {
  ASSERT_EQ(run_tegl({"contour", file_, "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  const nlohmann::json of_image = run_json({"--count", "200"}, "a.ply");
  const RunResult run =
      run_tegl({"simplify", path("all.vtkhdf"), "--count", "200", "-o", path("b.ply"), "--threads", "2", "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["simplices"], 200);
  EXPECT_EQ(run.json()["error"], of_image["error"]);
  const auto a = saved("a.ply"), b = saved("b.ply");
  EXPECT_TRUE(std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end()));
  EXPECT_TRUE(std::equal(a.simplices.begin(), a.simplices.end(), b.simplices.begin(), b.simplices.end()));
}

/// A contour whose error already exceeds the allowed one is an error, not a result.
TEST_F(SimplifyCommand, RefusesALargestErrorBelowTheOneThatAContourHas) {
  const nlohmann::json report = run_json({"--ratio", "0.1"}, "tenth.vtkhdf");
  const RunResult run =
      run_tegl({"simplify", path("tenth.vtkhdf"), "--max-error", "0.001", "-o", path("again.vtkhdf")});
  EXPECT_EQ(run.exit, 2);
  EXPECT_THAT(run.err, HasSubstr("0.001"));
  EXPECT_THAT(run.err, HasSubstr("from before"));
  EXPECT_THAT(run.err, HasSubstr(fmt::format("{}", report["error"].get<double>())));
  EXPECT_EQ(run.out, "");
  EXPECT_FALSE(std::filesystem::exists(path("again.vtkhdf")));
  // As documented, the stored bound can be ignored.
  EXPECT_EQ(run_tegl({"simplify", path("tenth.vtkhdf"), "--ratio", "1", "--no-bound", "-o", path("new.vtkhdf")}).exit,
            0);
  EXPECT_EQ(run_tegl({"simplify", path("new.vtkhdf"), "--max-error", "0.001", "-o", path("again.vtkhdf")}).exit, 0);
}

TEST_F(SimplifyCommand, RefusesToLeaveNothing) {
  if (!has_fast_simplify()) GTEST_SKIP() << "built without meshoptimizer";
  expect_refused(2, {"--method", "fast", "--ratio", "0"}, {"left none of"});
}

TEST_F(SimplifyCommand, ScalesDistances) {
  const nlohmann::json one = run_json({"--ratio", "0.2"}, "a.ply");
  const nlohmann::json two = run_json({"--ratio", "0.2", "--scale", "2,2,2"}, "b.ply");
  EXPECT_EQ(two["scale"], (std::vector<double>{2, 2, 2}));
  EXPECT_NEAR(two["error"], 2.0 * one["error"].get<double>(), 0.2 * one["error"].get<double>());
}

TEST_F(SimplifyCommand, CurvatureAloneIsAGoalOfFacets) {
  const nlohmann::json none = run_json({"--method", "facets", "--max-curvature", "0"}, "a.ply");
  EXPECT_EQ(none["simplices"], none["simplices_before"]);
  const nlohmann::json some = run_json({"--method", "facets", "--max-curvature", "1"}, "b.ply");
  EXPECT_LT(some["simplices"], some["simplices_before"]);
  const nlohmann::json most = run_json({"--method", "facets", "--max-curvature", "1000"}, "c.ply");
  EXPECT_LT(most["simplices"], some["simplices"].get<int>() / 2);
}

TEST_F(SimplifyCommand, LeavesOutTheBoundAndTheCheckWhenTold) {
  const nlohmann::json report = run_json({"--ratio", "0.2", "--no-bound", "--no-check"}, "a.vtkhdf");
  EXPECT_TRUE(report["error"].is_null());
  EXPECT_TRUE(read_mesh(path("a.vtkhdf")).vertex_attributes.empty());
  const RunResult text = run_tegl({"simplify", file_, "--iso", "0", "--ratio", "0.2", "-o", path("b.ply")});
  EXPECT_THAT(text.out, HasSubstr("error"));
  EXPECT_THAT(text.out, HasSubstr("20 % of the simplices are left"));
}

TEST_F(SimplifyCommand, MovesTheBorderOnlyWhenTold) {
  // A ball that extends beyond the image: its contour has a border.
  const std::string cut = write("cut.nii", nifti_bytes(ball({14, 14, 9}, 6), {1, 1, 1}));
  std::array<std::uint64_t, 2> border{};
  for (const bool within : {false, true}) {
    const RunResult run = run_tegl({"simplify", cut, "--iso", "0", "--ratio", "0.02", "--no-bound", "--border",
                                    within ? "within" : "fixed", "-o", path("a.ply")});
    ASSERT_EQ(run.exit, 0) << run.err;
    border[within ? 1 : 0] = check(saved("a.ply")).boundary_simplices;
  }
  ASSERT_EQ(run_tegl({"contour", cut, "--iso", "0", "-o", path("all.ply"), "-q"}).exit, 0);
  EXPECT_EQ(border[0], check(saved("all.ply")).boundary_simplices);
  EXPECT_LT(border[1], border[0]);
}

TEST_F(SimplifyCommand, TellsWhichOptionIsWrong) {
  expect_refused(2, {}, {"no goal", "--ratio", "--max-curvature"});
  expect_refused(2, {"--ratio", "2"}, {"--ratio", "2", "0 to 1"});
  expect_refused(2, {"--ratio", "half"}, {"--ratio", "half"});
  expect_refused(2, {"--count", "2.5"}, {"--count", "2.5"});
  expect_refused(2, {"--max-error", "-1"}, {"--max-error", "-1"});
  expect_refused(2, {"--max-error", "1", "--no-bound"}, {"--max-error", "--no-bound"});
  expect_refused(2, {"--ratio", "0.5", "--scale", "1,0,1"}, {"--scale", "0"});
  expect_refused(2, {"--ratio", "0.5", "--scale", "1,2"}, {"--scale", "2 numbers", "3"});
  expect_refused(2, {"--ratio", "0.5", "--max-curvature", "1"}, {"--max-curvature", "facets"});
  expect_refused(2, {"--ratio", "0.5", "--allow-nonmanifold"}, {"--allow-nonmanifold", "fast"});
  expect_refused(2, {"--ratio", "0.5", "--method", "fast", "--keep-embedded"}, {"--keep-embedded", "fast"});
  expect_refused(2, {"--ratio", "0.5", "--method", "best"}, {"--method", "best", "quadric"});
}

TEST_F(SimplifyCommand, SaysWhatStoppedIt) {
  EXPECT_EQ(run_json({"--ratio", "0.5"}, "a.ply")["end"], "count");
  EXPECT_EQ(run_json({"--ratio", "0", "--max-error", "0.05"}, "a.ply")["end"], "error");
  EXPECT_EQ(run_json({"--ratio", "0", "--max-error", "1000"}, "a.ply")["end"], "shape");
  const auto text = [&](const char* error) {
    return run_tegl({"simplify", file_, "--iso", "0", "--ratio", "0", "--max-error", error, "-o", path("b.ply")}).out;
  };
  EXPECT_THAT(text("0.05"), HasSubstr("fewer simplices would exceed --max-error"));
  EXPECT_THAT(text("0"), HasSubstr("no simplex can be removed within --max-error 0"));
  EXPECT_THAT(text("1000"), HasSubstr("topology, border or the shapes of simplices prevent"));
}

TEST_F(SimplifyCommand, KeepsContoursEmbeddedIfRequested) {
  const std::string rough = write("noise.nrrd", nrrd_bytes(noise({12, 12, 12}, 1)));
  const auto exit_of_check = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"simplify", rough,        "--iso", "127.5",      "--ratio",
                                          "0.3",      "--no-bound", "-o",    path("a.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_tegl(arguments).exit, 0);
    return run_tegl({"check", path("a.ply"), "--intersections"}).exit;
  };
  EXPECT_EQ(exit_of_check({}), 1);
  EXPECT_EQ(exit_of_check({"--keep-embedded"}), 0);
}

TEST_F(SimplifyCommand, ReportsIntersectionsOfTheResult) {
  const std::string rough = write("noise.nrrd", nrrd_bytes(noise({12, 12, 12}, 1)));
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"simplify", rough,        "--iso", "127.5",      "--ratio",
                                          "0.3",      "--no-bound", "-o",    path("a.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tegl(arguments);
  };
  const auto found = run({"--json"}).json()["intersections"];
  const auto checked = run_tegl({"check", path("a.ply"), "--intersections", "--json"}).json()["intersections"];
  EXPECT_GT(found["pairs"], 0);
  EXPECT_EQ(found["pairs"], checked["pairs"]);
  EXPECT_EQ(found["simplices"], checked["simplices"]);
  EXPECT_THAT(run({}).out, HasSubstr(fmt::format("intersect    {} pairs of {} triangles", found["pairs"].get<int>(),
                                                 found["simplices"].get<int>())));
  EXPECT_THAT(run({"--keep-embedded"}).out, HasSubstr("intersect    none"));
  EXPECT_TRUE(run({"--no-check", "--json"}).json()["intersections"].is_null());
}

TEST_F(SimplifyCommand, RefusesWhatIsNoManifoldUnlessAllowed) {
  if (!has_fast_simplify()) GTEST_SKIP() << "built without meshoptimizer";
  const std::string rough = write("noise.nrrd", nrrd_bytes(noise({12, 12, 12}, 1)));
  const std::vector<std::string> arguments = {"simplify", rough,     "--iso", "127.5", "--close",    "--method",
                                              "fast",     "--ratio", "0.3",   "-o",    path("a.ply")};
  const RunResult refused = run_tegl(arguments);
  EXPECT_EQ(refused.exit, 4) << refused.out;
  EXPECT_THAT(refused.err, HasSubstr("--allow-nonmanifold"));
  EXPECT_FALSE(std::filesystem::exists(path("a.ply")));
  auto allowed = arguments;
  allowed.emplace_back("--allow-nonmanifold");
  EXPECT_EQ(run_tegl(allowed).exit, 0);
  EXPECT_TRUE(std::filesystem::exists(path("a.ply")));
}

TEST_F(SimplifyCommand, OfFourDimensionsIsAManifold) {
  const std::string four = write("four.nrrd", nrrd_bytes(ball({9, 9, 9, 9}, 3)));
  const RunResult run =
      run_tegl({"simplify", four, "--iso", "0", "--ratio", "0.2", "-o", path("four.vtkhdf"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_LE(run.json()["simplices"], run.json()["simplices_before"].get<int>() / 5 + 1);
  EXPECT_EQ(run_tegl({"check", path("four.vtkhdf"), "-q"}).exit, 0);
}

}  // namespace
}  // namespace tegl::test
