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
