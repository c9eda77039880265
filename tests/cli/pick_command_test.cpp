// SPDX-License-Identifier: BSD-3-Clause
//
// The option --pick of tegl contour: the component nearest to a point.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

/// Two balls beside each other.
class Pick : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const auto balls = [](const std::vector<double>& x) {
      return std::max(4.25 - std::hypot(x[0] - 9.0, x[1] - 9.5, x[2] - 9.5),
                      6.25 - std::hypot(x[0] - 29.0, x[1] - 9.5, x[2] - 9.5));
    };
    file_ = write("balls.nrrd", nrrd_bytes(sample({40, 20, 20}, balls)));
  }
  [[nodiscard]] const std::string& file() const { return file_; }
  RunResult pick(const std::string& point, const std::vector<std::string>& more = {"--json"}) {
    std::vector<std::string> arguments{"contour", file(), "--iso", "0", "--pick", point, "-o", path("one.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tegl(arguments);
  }

 private:
  std::string file_;
};

TEST_F(Pick, IsTheNearerOfTwo) {
  const RunResult whole = run_tegl({"contour", file(), "--iso", "0", "-o", path("whole.ply"), "--json"});
  ASSERT_EQ(whole.exit, 0) << whole.err;
  EXPECT_EQ(whole.json()["components"], 2);
  EXPECT_TRUE(whole.json()["pick"].is_null());
  const RunResult left = pick("9,9.5,9.5");
  ASSERT_EQ(left.exit, 0) << left.err;
  EXPECT_EQ(left.json()["components"], 1);
  EXPECT_EQ(left.json()["euler"], 2);
  EXPECT_EQ(left.json()["pick"]["point"], nlohmann::json({9.0, 9.5, 9.5}));
  EXPECT_EQ(left.json()["pick"]["components"], 1);
  EXPECT_GT(left.json()["pick"]["distance"], 2.0);
  const RunResult right = pick("39,0,0");
  ASSERT_EQ(right.exit, 0) << right.err;
  EXPECT_EQ(left.json()["simplices"].get<int>() + right.json()["simplices"].get<int>(), whole.json()["simplices"]);
  EXPECT_GT(right.json()["simplices"], left.json()["simplices"]);
}

TEST_F(Pick, SaysWhatWasPicked) {
  const RunResult run = pick("9,9.5,9.5", {"--close", "--precision", "float"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("picked       (9, 9.5, 9.5): tile ("));
  EXPECT_THAT(run.out, HasSubstr("1 of 1 component in "));
}

TEST_F(Pick, RefusesWrongUsage) {
  const RunResult few = pick("9,9.5");
  EXPECT_EQ(few.exit, 2);
  EXPECT_THAT(few.err, HasSubstr("--pick 9,9.5 has 2 numbers; expected 3"));
  EXPECT_EQ(pick("9,9.5,").exit, 2);
  EXPECT_EQ(pick("").exit, 2);
  EXPECT_EQ(pick("9,nan,9").exit, 2);
  const RunResult outside = pick("9,9,20");
  EXPECT_EQ(outside.exit, 2);
  EXPECT_THAT(outside.err, HasSubstr("(9, 9, 20) is not in the image; expected one from (0, 0, 0) to (39, 19, 19)"));
  const RunResult indexed = pick("9,9,9", {"--index", file()});
  EXPECT_EQ(indexed.exit, 2);
  EXPECT_THAT(indexed.err, HasSubstr("--pick with --index; expected one of the two"));
  EXPECT_THAT(pick("9,9,9", {"--facets"}).err, HasSubstr("--pick with --facets; expected one of the two"));
  EXPECT_THAT(pick("9,9,9", {"--stream"}).err, HasSubstr("--pick with --stream; expected one of the two"));
  EXPECT_THAT(pick("9,a,9").err, HasSubstr("--pick is 'a'; expected numbers, one for each axis"));
}

/// On a lattice the whole contour is made.
class PickOnALattice : public Pick {
 protected:
  RunResult whole(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"contour", file(), "--iso", "0", "-o", path("whole.ply"), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tegl(arguments);
  }
};

TEST_F(PickOnALattice, IsTheNearerOfTwo) {
  for (const std::string lattice : {"fcc", "bcc"}) {
    const nlohmann::json all = whole({"--lattice", lattice}).json();
    ASSERT_EQ(all["components"], 2);
    const RunResult left = pick("9,9.5,9.5", {"--lattice", lattice, "--json"});
    ASSERT_EQ(left.exit, 0) << left.err;
    EXPECT_EQ(left.json()["components"], 1);
    EXPECT_EQ(left.json()["euler"], 2);
    EXPECT_EQ(left.json()["pick"]["components"], 2);
    EXPECT_TRUE(left.json()["pick"]["tile"].is_null());
    EXPECT_TRUE(left.json()["pick"]["tiles"].is_null());
    EXPECT_GT(left.json()["pick"]["distance"], 2.0);
    const RunResult right = pick("39.5,0,0", {"--lattice", lattice, "--json"});
    ASSERT_EQ(right.exit, 0) << right.err;
    EXPECT_EQ(left.json()["simplices"].get<int>() + right.json()["simplices"].get<int>(), all["simplices"]);
    EXPECT_GT(right.json()["simplices"], left.json()["simplices"]);
  }
  const RunResult run = pick("9,9.5,9.5", {"--lattice", "fcc", "--close", "--precision", "float"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("picked       (9, 9.5, 9.5): the nearest vertex is "));
  EXPECT_THAT(run.out, HasSubstr("1 of 2 components"));
}

TEST_F(PickOnALattice, HasAttributesAndNormals) {
  const RunResult left =
      pick("9,9.5,9.5", {"--lattice", "fcc", "--normals", "gradient", "--attribute", file(), "--json"});
  ASSERT_EQ(left.exit, 0) << left.err;
  EXPECT_EQ(left.json()["components"], 1);
  const Mesh mesh = read_mesh(path("one.ply"));
  const std::size_t vertices = left.json()["vertices"];
  EXPECT_EQ(mesh.coordinates.size(), 3 * vertices);
  ASSERT_EQ(mesh.normals.size(), 3 * vertices);
  ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
  const Attribute& values = mesh.vertex_attributes[0];
  EXPECT_EQ(values.name, "balls");
  ASSERT_EQ(values.values.size(), vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    EXPECT_NEAR(values.values[v], 0.0, 1e-5);  // the image itself, at its isovalue
    EXPECT_NEAR(std::hypot(mesh.normals[3 * v], mesh.normals[3 * v + 1], mesh.normals[3 * v + 2]), 1.0, 1e-5);
  }
}

TEST_F(PickOnALattice, IsNearestModuloThePeriod) {
  // x = 41 is x = 1: nearer to the left ball
  const std::vector<std::string> periodic = {"--lattice", "fcc", "--periodic", "x", "--json"};
  const RunResult left = pick("41,9.5,9.5", periodic), right = pick("37,9.5,9.5", periodic);
  ASSERT_EQ(left.exit, 0) << left.err;
  ASSERT_EQ(right.exit, 0) << right.err;
  EXPECT_LT(left.json()["simplices"], right.json()["simplices"]);
  EXPECT_EQ(left.json()["pick"]["point"], nlohmann::json({41.0, 9.5, 9.5}));
  // other axes have ends
  const RunResult outside = pick("41,90,9.5", periodic);
  EXPECT_EQ(outside.exit, 2);
  EXPECT_THAT(outside.err, HasSubstr("(41, 90, 9.5) is not in the image; expected one from (-inf, 0, 0) to "
                                     "(inf, 19.5, 19)"));
}

TEST_F(PickOnALattice, SaysTheUnitOfTheDistance) {
  EXPECT_THAT(pick("9,9.5,9.5", {"--lattice", "fcc"}).out, HasSubstr(" steps away\n"));
  const std::string mapped = write(
      "mapped.nrrd",
      nrrd_bytes(sample({12, 12, 12},
                        [](const std::vector<double>& x) { return 3.0 - std::hypot(x[0] - 6, x[1] - 6, x[2] - 6); }),
                 "space dimension: 3\nspace directions: (0,2,0) (2,0,0) (0,0,2)\n"));
  const RunResult run =
      run_tegl({"contour", mapped, "--iso", "0", "--lattice", "fcc", "--pick", "12,12,12", "-o", path("one.ply")});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr(" away in the world\n"));
}

TEST_F(Pick, OfAnEmptyContourIsNone) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--lattice", "fcc"}}) {
    std::vector<std::string> arguments{"contour",   file(), "--iso",          "99",           "--pick",
                                       "9,9.5,9.5", "-o",   path("none.ply"), "--allow-empty"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    ASSERT_EQ(run.exit, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("(9, 9.5, 9.5): no component, as the contour is empty"));
    arguments.emplace_back("--json");
    const nlohmann::json picked = run_tegl(arguments).json()["pick"];
    EXPECT_TRUE(picked["distance"].is_null());
    EXPECT_TRUE(picked["tile"].is_null());
    EXPECT_EQ(picked["components"], 0);
  }
}

TEST_F(PickOnALattice, OfAFileIsMeasuredInItsSteps) {
  // a layer is sqrt(2) / 2 away
  ASSERT_EQ(run_tegl({"sample", "x^2 + y^2 + z^2", "--lattice", "fcc", "--size", "20", "--range", "-2:2", "-o",
                      path("ball.nrrd")})
                .exit,
            0);
  const RunResult run =
      run_tegl({"contour", path("ball.nrrd"), "--iso", "1", "--pick", "0,0,0", "-o", path("b.ply"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_NEAR(run.json()["pick"]["distance"].get<double>(), 19.0 / 4.0, 0.2);
}

TEST_F(PickOnALattice, RefusesPointsOutside) {
  const RunResult outside = pick("9,9,20", {"--lattice", "fcc"});
  EXPECT_EQ(outside.exit, 2);
  EXPECT_THAT(outside.err,
              HasSubstr("(9, 9, 20) is not in the image; expected one from (0, 0, 0) to (39.5, 19.5, 19)"));
  EXPECT_EQ(pick("9,9", {"--lattice", "fcc"}).exit, 2);
  EXPECT_EQ(pick("9,9,9", {"--lattice", "fcc", "--index", file()}).exit, 2);
  EXPECT_EQ(pick("9,9,9", {"--lattice", "fcc", "--stream"}).exit, 2);
}

}  // namespace
}  // namespace tegl::test
