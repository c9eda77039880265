// SPDX-License-Identifier: BSD-3-Clause
//
// Measured files, if the folder of shared data exists.
#include <gmock/gmock.h>

#include "tegl_program.hpp"

namespace tegl::test {
namespace {

namespace fs = std::filesystem;

class RealData : public ProgramTest {
 protected:
  /// The path of a shared file; skips the test if it does not exist.
  static std::string shared(const std::string& name) {
    const fs::path file = fs::path(TEGL_SHARED_DATA_DIR) / name;
    return fs::exists(file) ? file.string() : std::string();
  }
  /// Runs the command; expects a manifold with simplices of this dimension.
  static nlohmann::json expect_manifold(std::vector<std::string> arguments, int dim) {
    arguments.emplace_back("--json");
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    const nlohmann::json report = run.json();
    EXPECT_EQ(report["dim"], dim);
    EXPECT_GT(report["simplices"], 0);
    for (const char* key : {"nonmanifold_simplices", "bad_links", "orientation_conflicts"}) EXPECT_EQ(report[key], 0);
    return report;
  }
};

TEST_F(RealData, ContourLinesOfATerrain) {
  const std::string file = shared("dem2d/jacksboro_403x344_int16.nhdr");
  if (file.empty()) GTEST_SKIP() << "no shared data";
  const nlohmann::json report = expect_manifold({"contour", file, "--iso", "600", "-o", path("lines.glb")}, 1);
  EXPECT_EQ(report["tiles"], 402 * 343);
  EXPECT_GT(report["components"], 1);
}

TEST_F(RealData, SurfaceOfAnObliqueScan) {
  const std::string file = shared("ct_mri/shear.nii.gz");
  if (file.empty()) GTEST_SKIP() << "no shared data";
  const nlohmann::json info = run_tegl({"info", file, "--json"}).json();
  EXPECT_EQ(info["image_dim"], 3);
  EXPECT_FALSE(info["world"].is_null()) << "the scan is sheared";
  const nlohmann::json report =
      expect_manifold({"contour", file, "--iso", "199.5", "--close", "-o", path("skin.ply")}, 2);
  EXPECT_EQ(report["boundary_simplices"], 0);
}

TEST_F(RealData, MeshesOfHexahedraTetrahedraAndACurvedGrid) {
  struct MeshFile {
    const char* name;
    const char* variable;
    const char* isovalue;
    int tiles;
  };
  for (const MeshFile& mesh : {MeshFile{"mesh/disk_out_ref_hex.vtu", "Temp", "400", 7472},
                               MeshFile{"mesh/disk_out_ref_tet.vtu", "Temp", "400", 44832},
                               MeshFile{"mesh/comb_57x33x25.vts", "Density", "0.3", 56 * 32 * 24}}) {
    SCOPED_TRACE(mesh.name);
    const std::string file = shared(mesh.name);
    if (file.empty()) GTEST_SKIP() << "no shared data";
    const nlohmann::json report =
        expect_manifold({"contour", file, "--var", mesh.variable, "--iso", mesh.isovalue, "-o", path("mesh.ply")}, 2);
    EXPECT_EQ(report["tiles"], mesh.tiles);
  }
}

TEST_F(RealData, AFlowOnAMeshOverSixTimes) {
  const std::string file = shared("mesh/cavity.pvd");
  if (file.empty()) GTEST_SKIP() << "no shared data";
  const nlohmann::json info = run_tegl({"info", file, "--json"}).json();
  EXPECT_EQ(info["times"], nlohmann::json({0.0, 0.5, 1.0, 1.5, 2.0, 2.5}));
  EXPECT_EQ(info["cells"]["hexahedron"], 400);
  const std::vector<std::string> speed = {"--var", "speed", "--iso", "0.1"};
  const auto with_speed = [&](std::vector<std::string> words) {
    words.insert(words.end(), speed.begin(), speed.end());
    return words;
  };
  const nlohmann::json report = expect_manifold(with_speed({"contour", file, "-o", path("p.vtkhdf")}), 3);
  EXPECT_EQ(report["tiles"], 5 * 400);
  for (const char* const at : {"t=0.2", "t=0.8"})
    expect_manifold(with_speed({"slice", file, "--at", at, "-o", path("p.ply")}), 2);
}

TEST_F(RealData, CutOfAFilmOfTheBrain) {
  const std::string file = shared("fourd/functional.nii");
  if (file.empty()) GTEST_SKIP() << "no shared data";
  expect_manifold({"slice", file, "--iso", "3600.5", "--at", "t=7.3", "-o", path("cut.ply")}, 2);
}

TEST_F(RealData, ContourAndCutsOfTheOcean) {
  const std::string file = shared("fourd/ocean_atlas_subset.nc.gz");
  if (file.empty()) GTEST_SKIP() << "no shared data";
  expect_manifold({"contour", file, "--iso", "20", "-o", path("ocean.vtkhdf")}, 3);
  const nlohmann::json axis = run_tegl({"info", file, "--json"}).json()["axes"][3];
  const double first = axis["first"];
  const double last = axis["last"];
  const std::string at = "t=" + nlohmann::json(first + 0.63 * (last - first)).dump();
  const nlohmann::json saved = expect_manifold({"slice", path("ocean.vtkhdf"), "--at", at, "-o", path("saved.ply")}, 2);
  const nlohmann::json direct = expect_manifold({"slice", file, "--iso", "20", "--at", at, "-o", path("cut.ply")}, 2);
  for (const char* key : {"vertices", "simplices", "components", "euler"}) EXPECT_EQ(saved[key], direct[key]) << key;
}

}  // namespace
}  // namespace tegl::test
