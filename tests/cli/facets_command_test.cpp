// SPDX-License-Identifier: BSD-3-Clause
//
// `tegl contour --facets` and `--triangulation fan|zigzag|halving-chord|halving-kink`.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class FacetsCommand : public ProgramTest {
 protected:
  /// Runs `tegl contour` with these arguments and --json; expects success.
  static nlohmann::json contour(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "contour");
    arguments.push_back("--json");
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  }
  void expect_failure(int exit, std::vector<std::string> arguments, const std::vector<std::string>& words) const {
    const auto before = files();
    arguments.insert(arguments.begin(), "contour");
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.out << run.err;
    for (const std::string& word : words) EXPECT_THAT(run.err, HasSubstr(word));
    EXPECT_EQ(files(), before);
  }
};

TEST_F(FacetsCommand, WritesThePolygonsInTheCellsOfAMesh) {
  std::string solid = "x,y,z,c\n", plane = "x,y,c\n";
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y) {
      plane += fmt::format("{},{},{}\n", x, y, 2.3 - std::hypot(x + 0.1 * y, y));
      for (int z = -3; z <= 3; ++z)
        solid += fmt::format("{},{},{},{}\n", x, y, z, 2.3 - std::hypot(x + 0.1 * y, y + 0.1 * z, z));
    }
  for (const auto& [table, kind] : {std::pair{solid, "polygons"}, {plane, "segments"}}) {
    const std::string file = write("points.csv", table);
    for (const char* const name : {"out.vtu", "out.vtkhdf"}) {
      const nlohmann::json report = contour({file, "--var", "c", "--iso", "0", "--facets", "-o", path(name)});
      const nlohmann::json expected = contour({file, "--var", "c", "--iso", "0", "-o", path("simplices.vtkhdf")});
      for (const char* key : {"euler", "components", "image_dim", "tiles", "active_tiles"})
        EXPECT_EQ(report[key], expected[key]) << kind << " " << key;
      for (const char* key : {"nonmanifold_facets", "orientation_conflicts", "open_boundaries", "boundary_facets"})
        EXPECT_EQ(report[key], 0) << kind << " " << key;
      EXPECT_EQ(report["facets"][kind], report["active_tiles"]);  // one facet in each simplex
    }
    contour({file, "--var", "c", "--iso", "0", "--facets", "-o", path("out.vtu")});
    std::ifstream written(path("out.vtu"));
    const std::string text{std::istreambuf_iterator<char>(written), {}};
    EXPECT_THAT(text, HasSubstr("Name=\"cell\""));
    // cut by the border
    const nlohmann::json open = contour({file, "--var", "c", "--iso", "-1", "--facets", "-o", path("out.vtu")});
    EXPECT_GT(open["boundary_facets"], 0);
    const nlohmann::json closed =
        contour({file, "--var", "c", "--iso", "-1", "--facets", "--close", "-o", path("out.vtu")});
    EXPECT_EQ(closed["boundary_facets"], 0);
    EXPECT_GT(closed["facets"][kind], open["facets"][kind]);
    EXPECT_EQ(closed["euler"],
              contour({file, "--var", "c", "--iso", "-1", "--close", "-o", path("simplices.vtkhdf")})["euler"]);
  }
}

TEST_F(FacetsCommand, WritesThePolyhedraInCellsIn4D) {
  const std::string points = write("points.csv", "x,y,z,t,c\n0,0,0,0,1\n1,0,0,0,0\n0,1,0,0,0\n0,0,1,0,0\n0,0,0,1,1\n");
  const nlohmann::json prism = contour({points, "--iso", "0.5", "--facets", "-o", path("o.vtu")});
  EXPECT_EQ(prism["facets"], (nlohmann::json{{"points", 6}, {"segments", 9}, {"polygons", 5}, {"polyhedra", 1}}));
  const nlohmann::json closed = contour({points, "--iso", "0.5", "--facets", "--close", "-o", path("o.vtu")});
  EXPECT_EQ(closed["facets"], (nlohmann::json{{"points", 8}, {"segments", 16}, {"polygons", 14}, {"polyhedra", 6}}));
  EXPECT_EQ(closed["boundary_facets"], 0);
  expect_failure(6, {points, "--iso", "0.5", "--facets", "-o", path("p.vtkhdf")}, {"cannot hold the polyhedra"});
  const std::string tetrahedron =
      R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="f" format="ascii">0 1 1 1</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";
  const std::string first = write("first.vtu", tetrahedron), second = write("second.vtu", tetrahedron);
  const nlohmann::json swept =
      contour({first, second, "--time-step", "1", "--iso", "0.5", "--facets", "-o", path("o.vtu")});
  EXPECT_EQ(swept["facets"], (nlohmann::json{{"points", 6}, {"segments", 9}, {"polygons", 5}, {"polyhedra", 1}}));
  EXPECT_EQ(swept["image_dim"], 4);
}

TEST_F(FacetsCommand, WritesFacetsWithTheTopologyOfTheContour) {
  const std::vector<std::string> images = {write("flat.nrrd", nrrd_bytes(noise({20, 21}, 1))),
                                           write("solid.nrrd", nrrd_bytes(noise({9, 10, 11}, 2))),
                                           write("moving.nrrd", nrrd_bytes(noise({5, 6, 7, 5}, 3)))};
  for (const std::string& image : images)
    for (const bool close : {false, true}) {
      std::vector<std::string> more = {"--iso", "128", "--ambiguity", close ? "mean" : "low"};
      if (close) more.push_back("--close");
      std::vector<std::string> facets = {image, "--facets", "-o", path("out.vtu")};
      std::vector<std::string> simplices = {image, "-o", path("out.vtkhdf")};
      facets.insert(facets.end(), more.begin(), more.end());
      simplices.insert(simplices.end(), more.begin(), more.end());
      const nlohmann::json report = contour(facets), expected = contour(simplices);
      for (const char* key : {"euler", "components", "image_dim", "tiles", "active_tiles"})
        EXPECT_EQ(report[key], expected[key]) << image << " " << key;
      for (const char* key : {"nonmanifold_facets", "orientation_conflicts", "open_boundaries"})
        EXPECT_EQ(report[key], 0) << image << " " << key;
      EXPECT_EQ(report["boundary_facets"] == 0, close);
      EXPECT_EQ(report["facets"].size(), report["image_dim"]);
      EXPECT_GT(std::filesystem::file_size(path("out.vtu")), 1000u);
    }
}

TEST_F(FacetsCommand, SaysWhatItFoundAndCanLeaveOutTheCheck) {
  const std::string image = write("ball.nrrd", nrrd_bytes(ball({12, 12, 12}, 4.3)));
  const RunResult run = run_tegl({"contour", image, "--iso", "0", "--facets", "-o", path("out.VTU")});
  EXPECT_EQ(run.exit, 0) << run.err;
  for (const char* words : {"polygons", "Euler        2", "none: closed", "at most two facets at each ridge"})
    EXPECT_THAT(run.out, HasSubstr(words));
  EXPECT_EQ(contour({image, "--iso", "0", "--facets", "--no-check", "-o", path("out.vtkhdf")})["euler"], nullptr);
  const RunResult quiet = run_tegl({"contour", image, "--iso", "0", "--facets", "-q", "-o", path("q.vtu")});
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(FacetsCommand, SaysHowManyPolyhedraAreNoBalls) {
  const std::string image = write("noise.nrrd", nrrd_bytes(noise({10, 10, 10, 10}, 7)));
  const auto unlike_balls = [&](const char* ambiguity) {
    return contour(
        {image, "--iso", "127.5", "--ambiguity", ambiguity, "--facets", "-o", path("o.vtu")})["unlike_balls"];
  };
  const nlohmann::json low = unlike_balls("low");
  EXPECT_GT(low["euler_0"], 0);
  EXPECT_EQ(low["euler_below_0"], 0);
  EXPECT_EQ(low["euler_above_1"], 0);
  const nlohmann::json mean = unlike_balls("mean");
  for (const char* kind : {"euler_0", "euler_below_0", "euler_above_1"}) EXPECT_GT(mean[kind], 0) << kind;
  const RunResult run =
      run_tegl({"contour", image, "--iso", "127.5", "--ambiguity", "mean", "--facets", "-o", path("o.vtu")});
  for (const char* words : {"with several handles", "solid torus", "with cavities"})
    EXPECT_THAT(run.out, HasSubstr(words));
}

TEST_F(FacetsCommand, RefusesWhatDoesNotGoTogether) {
  const std::string solid = write("ball.nrrd", nrrd_bytes(ball({9, 9, 9}, 3.3)));
  const std::string moving = write("balls.nrrd", nrrd_bytes(merging_balls(9, 3)));
  expect_failure(2, {solid, "--iso", "0", "--facets", "--triangulation", "fan", "-o", path("o.vtu")},
                 {"--facets", "--triangulation"});
  expect_failure(2, {solid, "--iso", "0", "--facets", "--stream", "-o", path("o.vtkhdf")}, {"--facets", "--stream"});
  expect_failure(2, {solid, "--iso", "0", "--facets", "--index", solid, "-o", path("o.vtu")}, {"--facets", "--index"});
  expect_failure(2, {solid, "--iso", "0", "--triangulation", "fan", "--index", solid, "-o", path("o.ply")}, {"fan"});
  expect_failure(6, {solid, "--iso", "0", "--facets", "-o", path("o.ply")}, {".ply", "expected .vtu"});
  expect_failure(6, {solid, "--iso", "0", "-o", path("o.vtu")}, {".vtu"});
  expect_failure(6, {moving, "--iso", "0", "--facets", "-o", path("o.vtkhdf")}, {".vtkhdf", "polyhedra", ".vtu"});
  expect_failure(6, {solid, "--iso", "0", "--facets", "-o", path("no/o.vtu")}, {"no", "exist"});
  expect_failure(5, {solid, "--iso", "99", "--facets", "-o", path("o.vtu")}, {"99"});
  expect_failure(2, {moving, "--iso", "0", "--triangulation", "zigzag", "-o", path("o.vtkhdf")},
                 {"4 dimensions", "compact"});
  expect_failure(2, {solid, "--iso", "0", "--triangulation", "fan", "--stream", "-o", path("o.vtkhdf")},
                 {"fan", "--stream", "compact"});
}

TEST_F(FacetsCommand, TriangulatesPolygonsEachInItsOwnWay) {
  const std::string image = write("noise.nrrd", nrrd_bytes(noise({14, 15, 16}, 4)));
  std::vector<MeshArray<tegl::Index>> different;
  const nlohmann::json compact = contour({image, "--iso", "128", "-o", path("compact.ply")});
  for (const char* method : {"fan", "zigzag", "halving-chord", "halving-kink"}) {
    const nlohmann::json report =
        contour({image, "--iso", "128", "--triangulation", method, "--normals", "-o", path("out.ply")});
    for (const char* key : {"vertices", "simplices", "euler", "components", "boundary_simplices", "active_tiles"})
      EXPECT_EQ(report[key], compact[key]) << method << " " << key;
    EXPECT_EQ(report["nonmanifold_simplices"], 0);
    EXPECT_EQ(report["bad_links"], 0);
    EXPECT_EQ(report["orientation_conflicts"], 0);
    const Mesh mesh = read_mesh(path("out.ply"));
    EXPECT_EQ(mesh.normals.size(), mesh.coordinates.size());
    for (const auto& other : different) EXPECT_NE(mesh.simplices, other) << method;
    different.push_back(mesh.simplices);
  }
}

TEST_F(FacetsCommand, OfRealDataHaveTheTopologyOfTheContour) {
  const std::filesystem::path shared = TEGL_SHARED_DATA_DIR;
  // image, isovalue, whether it is 3D
  const std::vector<std::tuple<std::filesystem::path, std::string, bool>> images = {
      {std::filesystem::path(TEGL_SOURCE_DIR) / "examples/data/ocean_temperature.nc", "20", false},
      {shared / "classic/fuel_64x64x64_uint8.nhdr", "100", true},
      {shared / "classic/silicium_98x34x34_uint8.nhdr", "120", true},
      {shared / "classic/neghip_64x64x64_uint8.nhdr", "60", true}};
  int found = 0;
  for (const auto& [image, iso, is_solid] : images) {
    if (!std::filesystem::exists(image)) continue;
    ++found;
    SCOPED_TRACE(image.string());
    const nlohmann::json expected = contour({image, "--iso", iso, "-o", path("out.vtkhdf")});
    const nlohmann::json report = contour({image, "--iso", iso, "--facets", "-o", path("out.vtu")});
    for (const char* key : {"euler", "components", "active_tiles"}) EXPECT_EQ(report[key], expected[key]) << key;
    for (const char* method : {"fan", "zigzag", "halving-chord", "halving-kink"}) {
      if (!is_solid) continue;
      const nlohmann::json surface = contour({image, "--iso", iso, "--triangulation", method, "-o", path("out.ply")});
      for (const char* key : {"euler", "components", "boundary_simplices", "simplices"})
        EXPECT_EQ(surface[key], expected[key]) << method << " " << key;
      EXPECT_EQ(surface["bad_links"], 0);
      EXPECT_EQ(surface["nonmanifold_simplices"], 0);
    }
  }
  EXPECT_GE(found, 1);
}

TEST_F(FacetsCommand, SliceSaysThatItKnowsNoPolygons) {
  const std::string moving = write("balls.nrrd", nrrd_bytes(merging_balls(9, 3)));
  const RunResult run =
      run_tegl({"slice", moving, "--iso", "0", "--at", "t=0.5", "--triangulation", "fan", "-o", path("o.ply")});
  EXPECT_EQ(run.exit, 2);
  EXPECT_THAT(run.err, HasSubstr("expected compact or barycentric"));
}

TEST_F(FacetsCommand, FacetsOfPeriodicLatticesAreClosedAcrossTheSeam) {
  const std::string gyroid = path("gyroid.nrrd");
  const std::string field =
      "sin(6.283185307179586*x)*cos(6.283185307179586*y)"
      "+sin(6.283185307179586*y)*cos(6.283185307179586*z)"
      "+sin(6.283185307179586*z)*cos(6.283185307179586*x)";
  for (const auto& [lattice, sizes] : {std::pair("fcc", "12,12,16"), std::pair("bcc", "10,10,20")}) {
    ASSERT_EQ(run_tegl({"sample", field, "--lattice", lattice, "--size", sizes, "--range", "0:1", "-o", gyroid}).exit,
              0);
    for (const char* const name : {"facets.vtu", "facets.vtkhdf"}) {
      const nlohmann::json facets =
          contour({gyroid, "--iso", "0.01", "--periodic", "all", "--facets", "-o", path(name)});
      const nlohmann::json simplices =
          contour({gyroid, "--iso", "0.01", "--periodic", "all", "-o", path("simplices.vtkhdf")});
      for (const char* const key : {"euler", "components", "tiles", "active_tiles"})
        EXPECT_EQ(facets[key], simplices[key]) << lattice << " " << key;
      EXPECT_EQ(facets["boundary_facets"], 0);
      EXPECT_EQ(facets["facets"]["points"], simplices["vertices"]);
      std::ifstream file(path(name), std::ios::binary);
      EXPECT_THAT(std::string(std::istreambuf_iterator<char>(file), {}), HasSubstr("periods"));
    }
  }
}

TEST_F(FacetsCommand, FacetsOfDivisionsAreThoseOfSimplices) {
  const std::string file = write("noise.nrrd", nrrd_bytes(noise({8, 6, 5}, 3)));
  for (const char* const division : {"kuhn", "alternating", "symmetric", "hybrid"}) {
    const nlohmann::json facets = contour({file, "--iso", "0.5", "--division", division, "--facets", "--close",
                                           "--periodic", "x", "-o", path("facets.vtu")});
    const nlohmann::json simplices =
        contour({file, "--iso", "0.5", "--division", division, "--close", "--periodic", "x", "-o", path("s.vtkhdf")});
    for (const char* const key : {"euler", "components", "tiles", "active_tiles"})
      EXPECT_EQ(facets[key], simplices[key]) << division << " " << key;
    EXPECT_EQ(facets["boundary_facets"], 0);
  }
}

TEST_F(FacetsCommand, OfSeveralIsovaluesAreThoseOfEach) {
  const std::string file = write("noise.nrrd", nrrd_bytes(noise({7, 6, 8}, 3)));
  const std::vector<std::vector<std::string>> tilings = {{"--lattice", "fcc"}, {"--division", "symmetric"}, {}};
  const auto read = [&](const std::string& name) {
    std::ifstream stream(path(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  for (const std::vector<std::string>& tiling : tilings) {
    std::vector<std::string> several = {"contour",  file,     "--iso", "0.4,0.6",
                                        "--facets", "--json", "-o",    path("of_{iso}.vtu")};
    several.insert(several.end(), tiling.begin(), tiling.end());
    const RunResult run = run_tegl(several);
    ASSERT_EQ(run.exit, 0) << run.err;
    const nlohmann::json results = run.json();
    ASSERT_EQ(results.size(), 2u);
    for (const std::size_t i : {0u, 1u}) {
      const std::string iso = i == 0 ? "0.4" : "0.6";
      std::vector<std::string> one = {file, "--iso", iso, "--facets", "-o", path("one.vtu")};
      one.insert(one.end(), tiling.begin(), tiling.end());
      const nlohmann::json expected = contour(one);
      for (const char* const key : {"facets", "isovalue", "euler", "tiles", "active_tiles"})
        EXPECT_EQ(results[i][key], expected[key]) << key;
      EXPECT_FALSE(read("one.vtu").empty());
      EXPECT_EQ(read("of_" + iso + ".vtu"), read("one.vtu"));
    }
  }
}

}  // namespace
}  // namespace tegl::test
