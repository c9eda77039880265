// SPDX-License-Identifier: BSD-3-Clause
//
// The command tegl contour: results for fields with known contours, options, formats and reports; attributes from the
// points of meshes.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <set>
#include <sstream>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Contour : public ProgramTest {
 protected:
  /// Runs `tegl contour FILE --iso ISO -o OUT --json` with further options; expects success.
  nlohmann::json contour(const std::string& file, const std::string& iso, const std::string& out,
                         const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"contour", file, "--iso", iso, "-o", path(out), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  }
  [[nodiscard]] std::string bytes(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name), std::ios::binary).rdbuf();
    return text.str();
  }
};

TEST_F(Contour, OfADiscIsACircleOfSegments) {
  const nlohmann::json report = contour(write("disc.nrrd", nrrd_bytes(ball({16, 15}, 4.3))), "0", "out.ply");
  EXPECT_EQ(report["image_dim"], 2);
  EXPECT_EQ(report["dim"], 1);
  EXPECT_EQ(report["components"], 1);
  EXPECT_EQ(report["euler"], 0);
  EXPECT_EQ(report["boundary_simplices"], 0);
  EXPECT_EQ(report["vertices"], report["simplices"]);
}

TEST_F(Contour, OfABallIsASphereOfTriangles) {
  const nlohmann::json report = contour(write("ball.nrrd", nrrd_bytes(ball({12, 13, 14}, 4.3))), "0", "out.ply");
  EXPECT_EQ(report["image_dim"], 3);
  EXPECT_EQ(report["dim"], 2);
  EXPECT_EQ(report["euler"], 2);
  EXPECT_EQ(report["boundary_simplices"], 0);
}

TEST_F(Contour, OfMovingBallsIsAManifoldOfTetrahedra) {
  const std::string file = write("balls.nii", nifti_bytes(merging_balls(18, 5), {1, 1, 1, 1}));
  const nlohmann::json report = contour(file, "0", "out.vtkhdf");
  EXPECT_EQ(report["image_dim"], 4);
  EXPECT_EQ(report["dim"], 3);
  EXPECT_EQ(report["components"], 1);
  EXPECT_GT(report["boundary_simplices"], 0) << "open at the first and the last time";
  for (const char* key : {"nonmanifold_simplices", "bad_links", "orientation_conflicts"}) EXPECT_EQ(report[key], 0);
  const nlohmann::json closed = contour(file, "0", "closed.vtkhdf", {"--close"});
  EXPECT_EQ(closed["boundary_simplices"], 0);
  EXPECT_EQ(closed["euler"], 0) << "a closed 3-manifold";
}

TEST_F(Contour, OfIntegersWithASlopeIsTheContourOfTheirValues) {
  Samples stored = noise({9, 10, 11}, 5);  // 0 to 255: many samples are equal
  for (float& value : stored.values) value = std::round(value / 8);
  for (const float slope : {0.3f, -0.3f}) {
    Samples values = stored;
    for (float& value : values.values)
      value = static_cast<float>(static_cast<double>(slope) * static_cast<double>(value) + static_cast<double>(-2.7f));
    const std::string integers = write("integers.nii", nifti_bytes_int16(stored, slope, -2.7f));
    const std::string floats = write("floats.nii", nifti_bytes(values, {}));
    const auto exact = [](double number) {
      std::ostringstream text;
      text << std::setprecision(17) << number;
      return text.str();
    };
    const auto number = [&](std::size_t at) { return exact(static_cast<double>(values.values[at])); };
    // the value of a sample as it is rounded to float, a value between, and one that only the range has
    for (const std::string& iso : {number(3), number(17), exact(slope * 15.37)}) {
      SCOPED_TRACE(iso);
      const auto one = contour(integers, iso, "a.ply", {"--normals"});
      const auto other = contour(floats, iso, "b.ply", {"--normals"});
      for (const char* const key : {"isovalue", "vertices", "simplices", "boundary_simplices", "euler"})
        EXPECT_EQ(one[key], other[key]) << key;
      const Mesh a = read_mesh(path("a.ply"));
      const Mesh b = read_mesh(path("b.ply"));
      EXPECT_EQ(a.simplices, b.simplices);
      ASSERT_EQ(a.coordinates.size(), b.coordinates.size());
      for (std::size_t i = 0; i < a.coordinates.size(); ++i) ASSERT_NEAR(a.coordinates[i], b.coordinates[i], 1e-5);
    }
  }
  // two files as one 4D image: with one slope, and with two, so that the values are converted
  const std::string third = write("third.nii", nifti_bytes_int16(stored, 0.3f, 1));
  const auto of_two = [&](float slope) {
    const std::string fourth = write("fourth.nii", nifti_bytes_int16(stored, slope, 1));
    return run_tegl({"contour", third, fourth, "--iso", "5.2", "-o", path("series.vtkhdf"), "--json"}).json();
  };
  EXPECT_EQ(of_two(0.3f)["simplices"], of_two(std::nextafter(0.3f, 1.0f))["simplices"]);
  const std::string file = write("integers.nii", nifti_bytes_int16(stored, -0.3f, 1));
  const RunResult run = run_tegl({"contour", file, "--iso", "2", "-o", path("none.ply")});
  EXPECT_EQ(run.exit, 5) << run.err;
  EXPECT_THAT(run.err, HasSubstr("outside of the values, which are -8.6"));
}

TEST_F(Contour, GoesIntoStlAndObjWhereTheseHoldIt) {
  const std::string ball_file = write("ball.nrrd", nrrd_bytes(ball({12, 13, 14}, 4.3)));
  const nlohmann::json stl = contour(ball_file, "0", "part.stl", {"--normals", "flat"});
  EXPECT_EQ(std::filesystem::file_size(path("part.stl")), 84 + 50 * stl["simplices"].get<std::size_t>());
  const nlohmann::json obj = contour(ball_file, "0", "part.obj", {"--normals"});
  for (const char* const name : {"part.stl", "part.obj"}) {
    const RunResult run = run_tegl({"check", path(name), "--require", "closed", "--json"});
    ASSERT_EQ(run.exit, 0) << run.err;
    for (const char* const key : {"vertices", "simplices", "components", "euler"}) EXPECT_EQ(run.json()[key], obj[key]);
  }
  const std::string disc_file = write("disc.nrrd", nrrd_bytes(ball({16, 15}, 4.3)));
  contour(disc_file, "0", "line.obj");
  const auto refused = [&](const std::vector<std::string>& rest, const std::string& message) {
    std::vector<std::string> arguments = {"contour", "--iso", "0", "-o", path("no.stl")};
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 6) << run.err;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  refused({disc_file}, "'.stl' cannot hold a 2D contour, which is made of lines");
  refused({write("balls.nii", nifti_bytes(merging_balls(18, 5), {1, 1, 1, 1}))},
          "slice the contour first ('tegl slice')");
  refused({ball_file, "--normals"}, "cannot hold normals of vertices");
  refused({ball_file, "--attribute", ball_file}, "cannot hold attributes");
  refused({ball_file, "--stream"}, "expected .vtkhdf");
  const RunResult line = run_tegl({"slice", ball_file, "--iso", "0", "--at", "z=5", "-o", path("no.stl")});
  EXPECT_EQ(line.exit, 6);
  EXPECT_THAT(line.err, HasSubstr("made of lines"));
  EXPECT_THAT(files(), ElementsAre("ball.nrrd", "balls.nii", "disc.nrrd", "line.obj", "part.obj", "part.stl"));
}

TEST_F(Contour, OfIntegersIsAsSoundInObjAsItWasMade) {
  Samples integers = noise({9, 10, 11}, 5);
  for (float& value : integers.values) value = std::floor(std::fmod(value, 7.0F));
  const nlohmann::json made =
      contour(write("integers.nrrd", nrrd_bytes_uint8(integers)), "3", "out.obj", {"--close", "--normals"});
  EXPECT_GT(made["degenerate_simplices"], 100) << "vertices at the place of others";
  const RunResult run = run_tegl({"check", path("out.obj"), "--require", "closed", "--json"});
  ASSERT_EQ(run.exit, 0) << run.out << run.err;
  nlohmann::json found = run.json();
  found.erase("seconds");
  for (const auto& [key, value] : found.items()) EXPECT_EQ(value, made[key]) << key;
}

TEST_F(Contour, FarFromTheOriginSaysHowManyVerticesSinglePrecisionLoses) {
  const std::string file =
      write("far.nrrd", nrrd_bytes(noise({9, 10, 11}, 5),
                                   "space dimension: 3\nspace directions: (0.05,0,0) (0,0.05,0) (0,0,0.05)\n"
                                   "space origin: (500000.02,5400000,0)\n"));
  for (const char* const extension : {".stl", ".glb", ".gltf"}) {
    SCOPED_TRACE(extension);
    const std::string out = path(std::string("far") + extension);
    const RunResult run = run_tegl({"contour", file, "--iso", "128.5", "-o", out, "--json"});
    ASSERT_EQ(run.exit, 0) << run.err;
    const auto vertices = run.json()["vertices"].get<std::size_t>();
    const auto together = run.json()["vertices_together"].get<std::size_t>();
    // Independent count: readers of STL merge equal vertices.
    const Mesh read = read_mesh(out);
    std::set<std::array<double, 3>> places;
    for (std::size_t i = 0; i < read.coordinates.size(); i += 3)
      places.insert({read.coordinates[i], read.coordinates[i + 1], read.coordinates[i + 2]});
    EXPECT_GT(together, vertices / 10);
    EXPECT_EQ(vertices - together, places.size());
    const std::string some = std::to_string(together) + " of " + std::to_string(vertices) + " vertices coincide";
    EXPECT_THAT(run.err, HasSubstr(out + ": " + extension + " has single precision, in which " + some));
    EXPECT_THAT(run.err, HasSubstr("expected a format with double precision (.ply, .obj or .vtkhdf)"));
    const RunResult told = run_tegl({"contour", file, "--iso", "128.5", "-o", out});
    EXPECT_THAT(told.out, HasSubstr("coincide (single precision)"));
    EXPECT_EQ(run_tegl({"contour", file, "--iso", "128.5", "-o", out, "--quiet"}).err, "");
    const RunResult cut = run_tegl({"components", file, "--iso", "128.5", "--split",
                                    path("{label}" + std::string(extension)), "--largest", "1", "--json"});
    EXPECT_THAT(cut.err, HasSubstr("coincide"));
    EXPECT_GT(cut.json()["vertices_together"], 0);
  }
  for (const char* const name : {"far.ply", "far.obj", "far.vtkhdf"}) {
    const RunResult run = run_tegl({"contour", file, "--iso", "128.5", "-o", path(name), "--json"});
    EXPECT_EQ(run.err, "") << name;
    EXPECT_EQ(run.json()["vertices_together"], 0) << name;
  }
  const std::string near = write("near.nrrd", nrrd_bytes(noise({9, 10, 11}, 5)));
  const RunResult run = run_tegl({"contour", near, "--iso", "128.5", "-o", path("near.stl"), "--json"});
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(run.json()["vertices_together"], 0);
}

TEST_F(Contour, OfTiesSaysThatStlMakesThemOne) {
  Samples integers = noise({9, 10, 11}, 5);
  for (float& value : integers.values) value = std::floor(std::fmod(value, 7.0F));
  const std::string file = write("integers.nrrd", nrrd_bytes_uint8(integers));
  const RunResult run = run_tegl({"contour", file, "--iso", "3", "-o", path("out.stl"), "--json"});
  const auto vertices = run.json()["vertices"].get<std::size_t>();
  const auto together = run.json()["vertices_together"].get<std::size_t>();
  EXPECT_EQ(vertices - together, read_mesh(path("out.stl")).coordinates.size() / 3);
  EXPECT_THAT(run.err,
              HasSubstr(std::to_string(together) + " of " + std::to_string(vertices) +
                        " vertices coincide with others, and .stl has no vertex numbers that distinguish them"));
  EXPECT_THAT(run.err, HasSubstr("--epsilon"));
  const RunResult glb = run_tegl({"contour", file, "--iso", "3", "-o", path("out.glb"), "--json"});
  EXPECT_EQ(glb.err, "") << "numbered";
}

TEST_F(Contour, WithAttributesThatOptionsPromiseIsRefusedWhereThereIsNoPlaceForThem) {
  const std::string file = write("ball.nrrd", nrrd_bytes(ball({12, 13, 14}, 4.3)));
  for (const char* const name : {"a.stl", "a.obj"}) {
    const RunResult run = run_tegl({"contour", file, "--iso", "0,1", "--one-file", "-o", path(name)});
    EXPECT_EQ(run.exit, 6) << run.err;
    EXPECT_THAT(run.err, HasSubstr("cannot hold attributes; expected .vtkhdf"));
    const RunResult components = run_tegl({"components", file, "--iso", "0", "-o", path(name)});
    EXPECT_EQ(components.exit, 6) << components.err;
    EXPECT_THAT(components.err, HasSubstr("cannot hold attributes; expected .vtkhdf"));
    EXPECT_EQ(run_tegl({"contour", file, "--iso", "0,1", "-o", path(name)}).exit, 0) << "a file each";
    EXPECT_EQ(run_tegl({"components", file, "--iso", "0", "--split", path("{label}" + std::string(name))}).exit, 0);
  }
  EXPECT_FALSE(std::filesystem::exists(path("a.stl")));
  EXPECT_THAT(run_tegl({"--help"}).out, HasSubstr("writes PLY, STL, OBJ, glTF and VTKHDF"));
}

TEST_F(Contour, ReportsEveryKey) {
  const nlohmann::json report = contour(write("ball.nrrd", nrrd_bytes(ball({8, 8, 8}, 2.2))), "0", "out.glb");
  for (const char* key : {"dim", "vertices", "simplices", "components", "euler", "boundary_simplices",
                          "nonmanifold_simplices", "bad_links", "orientation_conflicts", "degenerate_simplices",
                          "nonfinite_vertices", "active_tiles", "tiles", "isovalue", "image_dim", "input", "output"}) {
    EXPECT_TRUE(report.contains(key)) << key;
    EXPECT_FALSE(report[key].is_null()) << key;
  }
  for (const char* stage : {"read", "classify", "find", "generate", "close", "check", "write", "total"}) {
    ASSERT_TRUE(report["seconds"].contains(stage)) << stage;
    EXPECT_GE(report["seconds"][stage], 0) << stage;
  }
  EXPECT_EQ(report["tiles"], 343);
  EXPECT_GT(report["active_tiles"], 0);
  EXPECT_LT(report["active_tiles"], 343);
}

TEST_F(Contour, WithoutItsCheckHasNullsInstead) {
  const nlohmann::json report =
      contour(write("ball.nrrd", nrrd_bytes(ball({8, 8, 8}, 2.2))), "0", "out.ply", {"--no-check"});
  EXPECT_TRUE(report["euler"].is_null());
  EXPECT_TRUE(report["bad_links"].is_null());
  EXPECT_GT(report["vertices"], 0);
  EXPECT_GT(report["simplices"], 0);
}

TEST_F(Contour, ReportsToPeopleWithTheSameCounts) {
  const std::string file = write("ball.nrrd", nrrd_bytes(ball({8, 8, 8}, 2.2)));
  const RunResult run = run_tegl({"contour", file, "--iso", "0", "-o", path("out.ply")});
  ASSERT_EQ(run.exit, 0) << run.err;
  const nlohmann::json report = contour(file, "0", "again.ply");
  EXPECT_THAT(run.out, HasSubstr(report["simplices"].dump() + " triangles"));
  EXPECT_THAT(run.out, HasSubstr("an oriented manifold"));
  EXPECT_THAT(run.out, HasSubstr("none: closed"));
  EXPECT_THAT(run.out, HasSubstr(path("out.ply")));
  EXPECT_TRUE(run.err.empty()) << run.err;
}

TEST_F(Contour, SaysNothingWhenQuiet) {
  const std::string file = write("ball.nrrd", nrrd_bytes(ball({8, 8, 8}, 2.2)));
  const RunResult run = run_tegl({"contour", file, "--iso", "0", "-o", path("out.ply"), "--quiet"});
  EXPECT_EQ(run.exit, 0);
  EXPECT_EQ(run.out + run.err, "");
  EXPECT_THAT(files(), ElementsAre("ball.nrrd", "out.ply"));
}

TEST_F(Contour, IsTheSameFileEveryTime) {
  const std::string file = write("noise.nrrd", nrrd_bytes(noise({9, 8, 7}, 4)));
  contour(file, "128", "a.ply");
  contour(file, "128", "b.ply");
  EXPECT_EQ(bytes("a.ply"), bytes("b.ply"));
}

TEST_F(Contour, OptionsChangeTheResultAsTheySay) {
  const std::string file = write("noise.nrrd", nrrd_bytes_uint8(noise({9, 8, 7}, 4)));
  const nlohmann::json plain = contour(file, "128", "plain.ply");
  const nlohmann::json barycentric = contour(file, "128", "barycentric.ply", {"--triangulation", "barycentric"});
  EXPECT_GT(barycentric["simplices"], plain["simplices"]);
  EXPECT_EQ(barycentric["euler"], plain["euler"]);
  const nlohmann::json high = contour(file, "128", "high.ply", {"--ambiguity", "high"});
  EXPECT_NE(high["euler"], plain["euler"]);
  const auto by = [&](const std::string& rule) { return contour(file, "128", rule + ".ply", {"--ambiguity", rule}); };
  EXPECT_GT(by("squares")["euler"], by("mean")["euler"]) << "a tunnel takes 2";
  EXPECT_GE(by("decider")["euler"], by("saddle")["euler"]);
  const nlohmann::json closed = contour(file, "128", "closed.ply", {"--close"});
  EXPECT_GT(plain["boundary_simplices"], 0);
  EXPECT_EQ(closed["boundary_simplices"], 0);
  EXPECT_GT(plain["degenerate_simplices"], 0) << "some samples are 128";
  const nlohmann::json kept_away = contour(file, "128", "epsilon.ply", {"--epsilon", "0.01"});
  EXPECT_EQ(kept_away["degenerate_simplices"], 0);
  EXPECT_EQ(kept_away["simplices"], plain["simplices"]);
}

TEST_F(Contour, GradientDirectionReversesTheOrientation) {
  const std::string file = write("ball.nrrd", nrrd_bytes(ball({9, 9, 9}, 2.7)));
  const auto volume = [&](const std::vector<std::string>& more) {
    contour(file, "0", "out.ply", more);
    const Mesh mesh = read_mesh(path("out.ply"));
    double six_volumes = 0;
    for (std::size_t i = 0; i < mesh.simplices.size(); i += 3) {
      std::array<Eigen::Vector3d, 3> corners;
      for (std::size_t j = 0; j < 3; ++j) {
        corners[j] = Eigen::Map<const Eigen::Vector3d>(&mesh.coordinates[3 * std::size_t{mesh.simplices[i + j]}]);
      }
      six_volumes += corners[0].dot(corners[1].cross(corners[2]));
    }
    return six_volumes / 6;
  };
  const double outward = volume({});
  EXPECT_GT(outward, 60) << "normals to low values point out of the ball";
  EXPECT_LT(outward, 83);
  EXPECT_NEAR(volume({"--gradient-direction", "ascent"}), -outward, 1e-9);
  EXPECT_TRUE(read_mesh(path("out.ply")).normals.empty());
  EXPECT_EQ(volume({"--normals"}), outward);
  const Mesh mesh = read_mesh(path("out.ply"));
  ASSERT_EQ(mesh.normals.size(), mesh.coordinates.size());
  for (std::size_t v = 0; v < mesh.normals.size(); v += 3)
    EXPECT_NEAR(Eigen::Map<const Eigen::Vector3d>(&mesh.normals[v]).norm(), 1.0, 1e-12);
  EXPECT_NEAR(volume({"--precision", "float"}), outward, 1e-4);
}

TEST_F(Contour, FloatPrecisionGivesFloats) {
  const std::string file = write("ball.nrrd", nrrd_bytes(ball({9, 9, 9}, 2.7)));
  contour(file, "0", "float.ply", {"--precision", "float"});
  contour(file, "0", "double.ply");
  const auto all_floats = [](const Mesh& mesh) {
    return std::all_of(mesh.coordinates.begin(), mesh.coordinates.end(),
                       [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
  };
  EXPECT_TRUE(all_floats(read_mesh(path("float.ply"))));
  EXPECT_FALSE(all_floats(read_mesh(path("double.ply"))));
}

TEST_F(Contour, ReadsTheVariableThatIsNamed) {
  const Samples disc = ball({9, 8}, 3.3);
  write_netcdf(path("two.nc"), {"x", "y"}, {{0, 1, 2, 3, 4, 5, 6, 7, 8}, {0, 1, 2, 3, 4, 5, 6, 7}},
               {{"ROUND", disc}, {"NOISE", noise({9, 8}, 2)}});
  EXPECT_EQ(contour(path("two.nc"), "0", "round.ply", {"--var", "ROUND"})["components"], 1);
  EXPECT_GT(contour(path("two.nc"), "128", "noise.ply", {"--var", "NOISE"})["components"], 1);
}

TEST_F(Contour, StaysOpenAroundMissingSamples) {
  Samples values = ball({11, 11, 11}, 3.6);
  values.values[5 + 11 * (5 + 11 * 8)] = NAN;  // on the sphere
  const nlohmann::json report = contour(write("hole.nrrd", nrrd_bytes(values)), "0", "out.ply");
  EXPECT_GT(report["boundary_simplices"], 0);
  EXPECT_EQ(report["euler"], 1) << "a sphere with one hole";
  EXPECT_EQ(report["bad_links"], 0);
}

TEST_F(Contour, OfACurvedGridHasItsCoordinates) {
  const std::string model = TEGL_SOURCE_DIR "/tests/io/seeds/netcdf_curved.nc";
  const RunResult run = run_tegl({"contour", model, "--iso", "1.5", "-o", path("o.vtkhdf")});
  EXPECT_EQ(run.exit, 0) << run.err;
  const Mesh mesh = read_mesh(path("o.vtkhdf"));
  ASSERT_EQ(mesh.space_dim, 3);
  EXPECT_EQ(mesh.axis_names[0], "lon");
  EXPECT_EQ(mesh.axis_units[1], "degrees_north");
  for (std::size_t v = 0; v < mesh.coordinates.size(); v += 3)
    EXPECT_NEAR(std::hypot(mesh.coordinates[v] - 179.5, mesh.coordinates[v + 1] - 37), 1.5, 0.15);
  // by the indices
  EXPECT_EQ(run_tegl({"contour", model, "--iso", "1.5", "--index-grid", "-o", path("i.vtkhdf")}).exit, 0);
  for (const double x : read_mesh(path("i.vtkhdf")).coordinates) EXPECT_LE(x, 6);
  // the same by a command that contours the file itself
  const RunResult components = run_tegl({"components", model, "--iso", "1.5", "--json"});
  ASSERT_EQ(components.exit, 0) << components.err;
  EXPECT_EQ(components.json()["count"], 1);
  EXPECT_NEAR(components.json()["components"][0]["lowest"][0].get<double>(), 178, 0.15);
  EXPECT_EQ(run_tegl({"info", model, "--json"}).json()["curved"], nlohmann::json({"lon", "lat"}));
  // what does not know such grids says so
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--stream"}, {"--facets"}, {"--scale-space", "1,2"}, {"--triangulation", "fan"}}) {
    std::vector<std::string> arguments = {"contour", model, "--iso", "1.5", "-o", path("x.vtkhdf")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult refused = run_tegl(arguments);
    EXPECT_NE(refused.exit, 0) << more[0];
    EXPECT_THAT(refused.err, HasSubstr("--index-grid")) << more[0];
  }
  EXPECT_THAT(run_tegl({"contour", model, "--iso", "1.5", "--division", "kuhn", "-o", path("x.vtkhdf")}).err,
              HasSubstr("curved grid"));
  // folds are counted
  EXPECT_EQ(run_tegl({"contour", model, "--iso", "1.5", "-o", path("x.vtkhdf"), "--json"}).json()["folded_cells"], 0);
  EXPECT_EQ(components.json()["folded_cells"], 0);
  const std::string straight = write("straight.nrrd", nrrd_bytes(noise({4, 4, 4}, 1), ""));
  EXPECT_FALSE(run_tegl({"contour", straight, "--iso", "128", "-o", path("x.vtkhdf"), "--json"})
                   .json()
                   .contains("folded_cells"));
  const RunResult no_grid = run_tegl({"contour", straight, "--iso", "128", "--index-grid", "-o", path("x.vtkhdf")});
  EXPECT_EQ(no_grid.exit, 2);
  EXPECT_THAT(no_grid.err, HasSubstr("--index-grid with"));
}

TEST_F(Contour, OfACurvedGridTakesPositionsAttributesAndPointsToPick) {
  const std::string model = TEGL_SOURCE_DIR "/tests/io/seeds/netcdf_curved.nc";
  const auto contour_with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"contour", model, "--iso", "1.5", "-o", path("o.vtkhdf"), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return std::pair{read_mesh(path("o.vtkhdf")), run.json()};
  };
  const Mesh plain = contour_with({}).first;
  // a point on the contour, in degrees: the nearest sample is beside it
  const auto [picked, report] = contour_with({"--pick", "179.5,38.5,0.5"});
  EXPECT_EQ(picked.coordinates, plain.coordinates);
  EXPECT_EQ(report["pick"]["distance"], 0);
  // the values of the image itself are the isovalue
  const Mesh with_values = contour_with({"--attribute", model}).first;
  EXPECT_EQ(with_values.coordinates, plain.coordinates);
  ASSERT_EQ(with_values.vertex_attributes.size(), 1u);
  EXPECT_EQ(with_values.vertex_attributes[0].values.size(), plain.coordinates.size() / 3);
  for (const double value : with_values.vertex_attributes[0].values) EXPECT_NEAR(value, 1.5, 1e-6);
  // the same simplices, vertices elsewhere on their edges
  const Mesh relaxed = contour_with({"--positions", "relaxed"}).first;
  EXPECT_EQ(relaxed.simplices, plain.simplices);
  EXPECT_NE(relaxed.coordinates, plain.coordinates);
  for (std::size_t v = 0; v < relaxed.coordinates.size(); v += 3)
    EXPECT_NEAR(std::hypot(relaxed.coordinates[v] - 179.5, relaxed.coordinates[v + 1] - 37), 1.5, 1.0);
  // an image on a curved grid has no values at the vertices of a contour elsewhere
  Samples straight = ball({7, 6, 2}, 2.0);
  const std::string other = write("straight.nrrd", nrrd_bytes(straight));
  EXPECT_THAT(run_tegl({"contour", other, "--iso", "0", "--attribute", model, "-o", path("x.vtkhdf")}).err,
              HasSubstr("has a curved grid, and the contour has none"));
  // nor has an image of another place, or with --index-grid of other sizes
  const std::string far = write("far.nrrd", nrrd_bytes(ball({8, 6, 2}, 2.0)));
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--index-grid"}}) {
    std::vector<std::string> arguments = {"contour", model, "--iso", "1.5", "--attribute", far, "-o", path("x.vtkhdf")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult unrelated = run_tegl(arguments);
    EXPECT_EQ(unrelated.exit, 4) << unrelated.err;
    EXPECT_THAT(unrelated.err, HasSubstr("an image of 8 x 6 x 2 samples; the image that is contoured has 7 x 6 x 2"));
  }
}

TEST_F(Contour, OfACurvedGridIsCutAndSimplifiedAsASavedOne) {
  const std::string model = TEGL_SOURCE_DIR "/tests/io/seeds/netcdf_curved.nc";
  ASSERT_EQ(run_tegl({"contour", model, "--iso", "1.5", "-o", path("o.vtkhdf")}).exit, 0);
  const auto expect_same_file = [&](const std::vector<std::string>& command, const std::vector<std::string>& more) {
    std::vector<std::string> of_image = {command[0], model, "--iso", "1.5", "-o", path("image.ply")};
    std::vector<std::string> of_saved = {command[0], path("o.vtkhdf"), "-o", path("saved.ply")};
    of_image.insert(of_image.end(), more.begin(), more.end());
    of_saved.insert(of_saved.end(), more.begin(), more.end());
    const RunResult image = run_tegl(of_image), saved = run_tegl(of_saved);
    EXPECT_EQ(image.exit, 0) << image.err;
    EXPECT_EQ(saved.exit, 0) << saved.err;
    EXPECT_EQ(bytes("image.ply"), bytes("saved.ply")) << command[0] << more[1];
  };
  expect_same_file({"slice"}, {"--at", "time=0.5"});
  expect_same_file({"slice"}, {"--at", "lon=179"});
  expect_same_file({"slice"}, {"--plane", "1,1,0=216.5"});
  expect_same_file({"simplify"}, {"--count", "12"});
  EXPECT_THAT(run_tegl({"slice", model, "--iso", "1.5", "--at", "lon=170", "-o", path("x.ply")}).err, HasSubstr("lon"));
}

/// A mesh of two tetrahedra with the arrays f and g = 10 f + z.
std::string tetrahedra(const std::string& f, const std::string& g, const std::string& last = "0 0 1") {
  return R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="2"><PointData>
<DataArray type="Float64" Name="f" format="ascii">)" +
         f + R"(</DataArray><DataArray type="Float64" Name="g" format="ascii">)" + g +
         R"(</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 -1 )" +
         last + R"(</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 4 0 2 1 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";
}

class MeshAttribute : public ProgramTest {
 protected:
  /// Expects g = 10 f + z at the vertices of a contour of f.
  static void expect_g(const std::string& file, double f) {
    const Mesh mesh = read_mesh(file);
    ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
    const Attribute& g = mesh.vertex_attributes[0];
    EXPECT_EQ(g.name, "g");
    ASSERT_GT(g.values.size(), 2u);
    for (std::size_t v = 0; v < g.values.size(); ++v)
      EXPECT_NEAR(g.values[v], 10 * f + mesh.coordinates[v * static_cast<std::size_t>(mesh.space_dim) + 2], 1e-6);
  }
  void expect_refused(std::vector<std::string> arguments, const std::string& message) const {
    arguments.insert(arguments.begin(), {"contour", first_, "--var", "f", "--iso", "0.5", "-o", path("none.vtkhdf")});
    const RunResult run = run_tegl(arguments);
    EXPECT_NE(run.exit, 0);
    EXPECT_THAT(run.err, HasSubstr(message));
  }
  std::string first_ = "";
};

TEST_F(MeshAttribute, ArraysOfAMeshAreInterpolatedAtItsContour) {
  first_ = write("first.vtu", tetrahedra("1 0 0 0 0", "10 0 0 -1 1"));
  const std::string second = write("second.vtu", tetrahedra("2 1 1 1 1", "20 10 10 9 11"));
  const std::string out = path("out.vtkhdf");
  const auto run = [](const std::vector<std::string>& arguments) {
    const RunResult done = run_tegl(arguments);
    EXPECT_EQ(done.exit, 0) << done.err;
  };
  run({"contour", first_, "--var", "f", "--iso", "0.25", "--attribute", first_ + ":g", "-o", out});
  expect_g(out, 0.25);
  run({"contour", first_, "--var", "f", "--iso", "0.25", "--close", "--precision", "float", "--attribute",
       first_ + ":g", "-o", out});
  // over time, and slices of it
  run({"contour", first_, second, "--var", "f", "--iso", "1.25", "--attribute", first_ + ":g", "-o", out});
  expect_g(out, 1.25);
  run({"slice", first_, second, "--var", "f", "--iso", "1.25", "--at", "t=0.75", "--attribute", first_ + ":g", "-o",
       out});
  expect_g(out, 1.25);
  run({"elements", first_, "--var", "f", "--iso", "0.25", "--attribute", first_ + ":g", "-o", path("elements.dat")});
  expect_refused({"--attribute", first_ + ":h"}, "has no array 'h'");
  expect_refused({"--attribute", first_ + ":g", "--attribute", first_ + ":g"}, "already has an attribute 'g'");
  const std::string other = write("other.vtu", tetrahedra("1 0 0 0 0", "10 0 0 -1 1", "0 0 2"));
  expect_refused({"--attribute", other + ":g"}, "the mesh has other points than");
}

TEST_F(MeshAttribute, ErrorsOfFilesThatAnAttributeRefersToNameTheOption) {
  first_ = write("image.nii",
                 nifti_bytes(sample({3, 3, 3}, [](const std::vector<double>& x) { return x[0] / 2; }), {1, 1, 1}));
  (void)write("cells.vtu", tetrahedra("1 0 0 0 0", "10 0 0 -1 1"));
  const std::string collection = write("series.pvd",
                                       R"(<VTKFile type="Collection"><Collection>
<DataSet timestep="0" file="cells.vtu"/></Collection></VTKFile>)");
  const RunResult run =
      run_tegl({"contour", first_, "--iso", "0.25", "--attribute", collection + ":g", "-o", path("none.vtkhdf")});
  EXPECT_NE(run.exit, 0);
  EXPECT_THAT(run.err, HasSubstr("--attribute " + collection));
  EXPECT_THAT(run.err, testing::Not(HasSubstr(first_)));
}

TEST_F(MeshAttribute, TheErrorOfAnUnknownFormatNamesMeshesAndTables) {
  const std::string file = write("what.foo", "abc");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", file}, {"contour", file, "--iso", "1", "-o", path("none.ply")}}) {
    const RunResult run = run_tegl(arguments);
    EXPECT_NE(run.exit, 0);
    EXPECT_THAT(run.err, HasSubstr("meshes (.vtu, .vts, .pvd) and tables of points (.csv)"));
  }
}

TEST_F(MeshAttribute, ColumnsOfATableAreInterpolatedToo) {
  std::string table = "x,y,f,g\n";
  for (int i = 0; i < 49; ++i) {
    const int x = i % 7, y = i / 7;
    table += std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(x + 2 * y) + "," +
             std::to_string(3 * x) + "\n";
  }
  const std::string file = write("points.csv", table), out = path("line.vtkhdf");
  const RunResult run =
      run_tegl({"contour", file, "--var", "f", "--iso", "7.5", "--attribute", file + ":g", "-o", out});
  ASSERT_EQ(run.exit, 0) << run.err;
  const Mesh mesh = read_mesh(out);
  const auto line = to_contour<2>(mesh);
  ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
  for (std::size_t v = 0; v < line.vertices.size(); ++v)
    EXPECT_NEAR(mesh.vertex_attributes[0].values[v], 3 * line.vertices[v][0], 1e-5);
  // as few points as possible, and points without area
  const std::string few = write("few.csv", "x,y,v\n0,0,1\n1,0,0\n0,1,0\n");
  EXPECT_EQ(run_tegl({"contour", few, "--iso", "0.5", "-o", path("few.ply")}).exit, 0);
  const RunResult flat =
      run_tegl({"contour", write("flat.csv", "x,y,v\n0,0,1\n1,1,0\n2,2,0\n"), "--iso", "0.5", "-o", path("f.ply")});
  EXPECT_NE(flat.exit, 0);
  EXPECT_THAT(flat.err, HasSubstr("3 points that lie in a line; expected points in 2 dimensions"));
}

TEST_F(Contour, NamesTheReasonOfZeroSizes) {
  const auto index = [](std::size_t x, std::size_t y, std::size_t z, std::size_t t) {
    return x + 7 * (y + 7 * (z + 7 * t));
  };
  Samples samples = noise({7, 7, 7, 7}, 3);
  samples.values[index(2, 2, 2, 2)] = samples.values[index(4, 4, 4, 2)] = NAN;  // their cells share edges along t
  const auto text_of = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"contour", write("image.nrrd", nrrd_bytes(samples)), "-o", path("out.vtkhdf")});
    const RunResult run = run_tegl(options);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.out;
  };
  const std::string missing = "regions of missing values meet in an edge of a cell)";
  EXPECT_THAT(text_of({"--iso", "127.3"}), HasSubstr("of zero size (" + missing));
  EXPECT_THAT(text_of({"--iso", "127.3", "--epsilon", "0.01"}), HasSubstr("of zero size (" + missing));
  for (float& value : samples.values) value = std::round(value / 64);
  EXPECT_THAT(text_of({"--iso", "2"}),
              HasSubstr("of zero size (samples equal the isovalue, which --epsilon avoids, or " + missing));
  samples.values[index(2, 2, 2, 2)] = samples.values[index(4, 4, 4, 2)] = 0;
  EXPECT_THAT(text_of({"--iso", "2"}), HasSubstr("of zero size (samples equal the isovalue; --epsilon avoids them)"));
}

TEST_F(Contour, MeshesAreClosedAndHaveNormalsFromTheGradient) {
  std::string text = R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="8" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="f" format="ascii">0 1 0 1 0 1 0 1</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">)";
  for (const char* const corner : {"0 0 0 ", "1 0 0 ", "0 1 0 ", "1 1 0 ", "0 0 1 ", "1 0 1 ", "0 1 1 ", "1 1 1 "})
    text += corner;
  text += R"(</DataArray></Points><Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7
</DataArray><DataArray type="Int64" Name="offsets" format="ascii">8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">11</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";
  const std::string file = write("cell.vtu", text), saved = path("half.vtkhdf");
  (void)contour(file, "0.25", "half.vtkhdf", {"--close", "--ambiguity", "saddle", "--normals", "gradient"});
  const Mesh half = read_mesh(saved);
  ASSERT_EQ(half.normals.size(), half.coordinates.size());
  for (std::size_t v = 0; v < half.normals.size(); v += 3) EXPECT_NEAR(half.normals[v], -1.0, 1e-12);
  const RunResult measured = run_tegl({"measure", saved, "--json"});
  ASSERT_EQ(measured.exit, 0) << measured.err;
  EXPECT_NEAR(measured.json()["content"].get<double>(), 0.75, 1e-12);
  const RunResult run = run_tegl({"contour", file, "--iso", "0.25", "--normals", "sobel", "-o", saved});
  EXPECT_NE(run.exit, 0);
  EXPECT_THAT(run.err, HasSubstr("--normals sobel with"));
}

}  // namespace
}  // namespace tegl::test
