// SPDX-License-Identifier: BSD-3-Clause
//
// The command tegl check: reports, requirements and exit codes.
#include <gmock/gmock.h>

#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

/// Files with triangles on the corners of an octahedron and its centre (vertex 6).
class Check : public ProgramTest {
 protected:
  [[nodiscard]] std::string save(const std::vector<std::array<Index, 3>>& triangles) const {
    Mesh mesh;
    mesh.coordinates = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0};
    for (const auto& triangle : triangles) {
      mesh.simplices.insert(mesh.simplices.end(), triangle.begin(), triangle.end());
    }
    write_mesh(mesh, path("mesh.ply"));
    return path("mesh.ply");
  }
  static std::vector<std::array<Index, 3>> octahedron() {
    return {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  }
};

TEST_F(Check, OfASphereFindsNothing) {
  const RunResult run = run_tegl({"check", save(octahedron()), "--json"});
  EXPECT_EQ(run.exit, 0) << run.err;
  const nlohmann::json expected = {{"dim", 2},
                                   {"vertices", 6},
                                   {"simplices", 8},
                                   {"components", 1},
                                   {"euler", 2},
                                   {"boundary_simplices", 0},
                                   {"nonmanifold_simplices", 0},
                                   {"bad_links", 0},
                                   {"orientation_conflicts", 0},
                                   {"degenerate_simplices", 0},
                                   {"nonfinite_vertices", 0}};
  nlohmann::json found = run.json();
  for (const char* stage : {"read", "check", "total"}) EXPECT_GE(found["seconds"][stage], 0.0);
  found.erase("seconds");
  EXPECT_EQ(found, expected) << "these keys and no others";
}

TEST_F(Check, OfASurfaceWithABorderIsFineUnlessClosednessIsRequired) {
  auto triangles = octahedron();
  triangles.pop_back();
  const std::string file = save(triangles);
  const RunResult run = run_tegl({"check", file, "--json"});
  EXPECT_EQ(run.exit, 0);
  EXPECT_EQ(run.json()["boundary_simplices"], 3);
  const RunResult required = run_tegl({"check", file, "--require", "closed"});
  EXPECT_EQ(required.exit, 1);
  EXPECT_THAT(required.out, HasSubstr("has a border"));
  EXPECT_EQ(run_tegl({"check", save(octahedron()), "--require", "closed,nondegenerate"}).exit, 0);
}

TEST_F(Check, OfAnEmptyMeshSaysSoAndMeetsNoRequirement) {
  const std::string file = save({});
  const RunResult run = run_tegl({"check", file});
  EXPECT_EQ(run.exit, 0);
  EXPECT_THAT(run.out, HasSubstr("empty: no simplices"));
  EXPECT_EQ(run_tegl({"check", file, "--require", "closed"}).exit, 1);
}

TEST_F(Check, OfAFlippedTriangleFails) {
  auto triangles = octahedron();
  std::swap(triangles[0][0], triangles[0][1]);
  const RunResult run = run_tegl({"check", save(triangles), "--json"});
  EXPECT_EQ(run.exit, 1);
  EXPECT_EQ(run.json()["orientation_conflicts"], 3);
}

TEST_F(Check, OfAThirdTriangleOnAnEdgeFails) {
  auto triangles = octahedron();
  triangles.push_back({0, 2, 6});
  const RunResult run = run_tegl({"check", save(triangles)});
  EXPECT_EQ(run.exit, 1);
  EXPECT_THAT(run.out, HasSubstr("1 face in more than two simplices"));
}

TEST_F(Check, OfTwoTrianglesThatMeetInAVertexFails) {
  const RunResult run = run_tegl({"check", save({{0, 2, 6}, {1, 3, 6}})});
  EXPECT_EQ(run.exit, 1);
  EXPECT_THAT(run.out, HasSubstr("1 vertex with a bad link"));
}

TEST_F(Check, TellsDegenerateTriangles) {
  const std::string file = save({{0, 1, 6}});
  const RunResult run = run_tegl({"check", file, "--json"});
  EXPECT_EQ(run.exit, 0) << "a manifold all the same";
  EXPECT_EQ(run.json()["degenerate_simplices"], 1);
  EXPECT_EQ(run_tegl({"check", file, "--require", "nondegenerate"}).exit, 1);
  EXPECT_THAT(run_tegl({"check", file}).out, HasSubstr("1 triangle of zero size (if tegl made the contour: samples"))
      << "a mesh of another's may have other reasons";
}

TEST_F(Check, QuietlyTellsByTheExitCodeAlone) {
  auto triangles = octahedron();
  std::swap(triangles[0][0], triangles[0][1]);
  const RunResult run = run_tegl({"check", "-q", save(triangles)});
  EXPECT_EQ(run.exit, 1);
  EXPECT_EQ(run.out + run.err, "");
}

TEST_F(Check, FindsIntersections) {
  const RunResult none = run_tegl({"check", save(octahedron()), "--intersections"});
  EXPECT_EQ(none.exit, 0) << none.err;
  EXPECT_THAT(none.out, HasSubstr("intersect    none"));
  EXPECT_THAT(none.out, HasSubstr(" + intersections "));

  // a triangle that pierces another, and a flat one
  Mesh mesh;
  mesh.coordinates = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, -0.5, 1, 1, 2, 3, 3, 2, 8, 8, 8, 9, 9, 9, 10, 10, 10};
  mesh.simplices = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  write_mesh(mesh, path("crossed.ply"));
  const RunResult plain = run_tegl({"check", path("crossed.ply"), "--json"});
  EXPECT_EQ(plain.exit, 0);
  EXPECT_FALSE(plain.json().contains("intersections"));
  const RunResult run = run_tegl({"check", path("crossed.ply"), "--intersections", "--json", "--places", "5", "--tile",
                                  "10,10,1", "--tile-origin", "-0.5", "--threads", "2"});
  EXPECT_EQ(run.exit, 1);
  const auto found = run.json()["intersections"];
  EXPECT_EQ(found["pairs"], 1);
  EXPECT_EQ(found["simplices"], 2);
  EXPECT_EQ(found["flat_simplices"], 1);
  EXPECT_NEAR(found["depth"].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(found["tiles"], 3);
  EXPECT_EQ(found["tiles_with_pairs"], 2);
  ASSERT_EQ(found["places"].size(), 1u);
  EXPECT_EQ(found["places"][0]["simplices"], nlohmann::json({0, 1}));
  EXPECT_NEAR(found["places"][0]["at"][2].get<double>(), 0.0, 1e-12);
  EXPECT_GE(run.json()["seconds"]["intersections"], 0.0);

  const RunResult text = run_tegl({"check", path("crossed.ply"), "--intersections", "--places", "1", "--tile", "5"});
  EXPECT_EQ(text.exit, 1);
  EXPECT_THAT(text.out, HasSubstr("intersect    1 pair of 2 triangles, up to 0.5 deep"));
  EXPECT_THAT(text.out, HasSubstr("flat         1 triangle of zero size, not examined"));
  EXPECT_THAT(text.out, HasSubstr("tiles        1 of 2 with intersections (50 %)"));
  EXPECT_THAT(text.out, HasSubstr("pair         0 and 1 at ("));
}

TEST_F(Check, FailsIfFlatSimplicesAreNotExamined) {
  // the flat triangle passes through the other one
  Mesh mesh;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, -1, -1, 1, -1, 1, 1, 2, 0};
  mesh.simplices = {0, 1, 2, 3, 4, 5};
  write_mesh(mesh, path("flat.ply"));
  EXPECT_EQ(run_tegl({"check", path("flat.ply")}).exit, 0);
  const RunResult run = run_tegl({"check", path("flat.ply"), "--intersections"});
  EXPECT_EQ(run.exit, 1);
  EXPECT_THAT(run.out, HasSubstr("intersect    none among the others"));
  EXPECT_THAT(run.out, HasSubstr("flat         1 triangle of zero size, not examined"));
  EXPECT_EQ(run_tegl({"check", path("flat.ply"), "--intersections", "--quiet"}).exit, 1);
}

TEST_F(Check, ListsTheDeepestPairs) {
  // edges that reach 0.25, 1 and 0.5 below a large triangle
  Mesh mesh;
  mesh.coordinates = {-90, -90, 0, 90, -90, 0, 0, 90, 0};
  mesh.simplices = {0, 1, 2};
  double x = 0;
  for (const double below : {0.25, 1.0, 0.5}) {
    for (const double c : {x, 0.0, -below, x + 0.3, 0.0, 7.0, x, 0.3, 7.0}) mesh.coordinates.push_back(c);
    for (Index i = 0; i < 3; ++i) mesh.simplices.push_back(static_cast<Index>(mesh.simplices.size()));
    x += 5;
  }
  write_mesh(mesh, path("deep.ply"));
  const RunResult run = run_tegl({"check", path("deep.ply"), "--intersections", "--json", "--places", "2"});
  const auto found = run.json()["intersections"];
  EXPECT_EQ(found["pairs"], 3);
  EXPECT_NEAR(found["depth"].get<double>(), 1.0, 1e-12);
  ASSERT_EQ(found["places"].size(), 2u);
  EXPECT_EQ(found["places"][0]["simplices"], nlohmann::json({0, 2}));
  EXPECT_EQ(found["places"][1]["simplices"], nlohmann::json({0, 3}));
}

TEST_F(Check, RefusesBadOptionsOfIntersections) {
  const std::string file = save(octahedron());
  EXPECT_EQ(run_tegl({"check", file, "--tile", "1"}).exit, 2) << "without --intersections";
  EXPECT_EQ(run_tegl({"check", file, "--intersections", "--tile-origin", "1"}).exit, 2) << "without --tile";
  EXPECT_EQ(run_tegl({"check", file, "--intersections", "--places", "-1"}).exit, 2);
  EXPECT_THAT(run_tegl({"check", file, "--intersections", "--threads", "5000"}).err,
              HasSubstr("--threads is '5000'; expected a whole number from 0 to 4096"));
  const RunResult two = run_tegl({"check", file, "--intersections", "--tile", "1,2"});
  EXPECT_EQ(two.exit, 2);
  EXPECT_THAT(two.err, HasSubstr("--tile 1,2 has 2 numbers; expected one, or 3, one for each axis"));
  EXPECT_THAT(run_tegl({"check", file, "--intersections", "--tile", "0"}).err,
              HasSubstr("--tile is 0; expected positive numbers"));
}

TEST_F(Check, RefusesWhatIsNoMesh) {
  EXPECT_EQ(run_tegl({"check", path("none.ply")}).exit, 3);
  EXPECT_EQ(run_tegl({"check", write("text.ply", "this is no mesh\n")}).exit, 4);
  EXPECT_EQ(run_tegl({"check", write("empty.ply", "")}).exit, 4);
  EXPECT_EQ(run_tegl({"check", write("text.vtkhdf", "this is no mesh\n")}).exit, 4);
  const RunResult run = run_tegl({"check", write("mesh.xyz", "1 2 3\n")});
  EXPECT_EQ(run.exit, 4);
  EXPECT_THAT(run.err, HasSubstr(path("mesh.xyz")));
}

}  // namespace
}  // namespace tegl::test
