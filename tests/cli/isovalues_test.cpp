// SPDX-License-Identifier: BSD-3-Clause
//
// tegl contour at several isovalues: the image is read once, outputs are separate files or one file, in memory and
// streamed.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kOcean = TEGL_SOURCE_DIR "/examples/data/ocean_temperature.nc";

class Isovalues : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ball_ = write("ball.nrrd", nrrd_bytes(ball({12, 12, 12}, 4)));
  }
  /// Runs `tegl contour`, expects success, and returns the JSON.
  static nlohmann::json contour(const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"contour", file, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  }
  void expect_refused(int exit, const std::vector<std::string>& more, const std::vector<std::string>& parts) const {
    const auto before = files();
    std::vector<std::string> arguments = {"contour", ball_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.err;
    for (const std::string& part : parts) EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_EQ(files(), before);
  }
  void expect_same(const std::string& a, const std::string& b) const {
    const Mesh x = read_mesh(path(a));
    const Mesh y = read_mesh(path(b));
    EXPECT_EQ(x.coordinates, y.coordinates) << a << " " << b;
    EXPECT_EQ(x.simplices, y.simplices);
    EXPECT_EQ(x.normals, y.normals);
    EXPECT_EQ(x.isovalue, y.isovalue);
  }
  static std::string raw_ball() {
    const Samples samples = ball({12, 12, 12}, 4);
    return {reinterpret_cast<const char*>(samples.values.data()), samples.values.size() * sizeof(float)};
  }
  static std::string read_text(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string ball_;
};

TEST_F(Isovalues, GiveAFileEachThatIsTheContourOfItsOwnRun) {
  const nlohmann::json all = contour(ball_, {"--iso", "0,1.5", "--iso=-2", "--normals", "-o", path("out.ply")});
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1]["isovalue"], 1.5);
  EXPECT_EQ(all[2]["output"], path("out_-2.ply"));
  for (const std::string iso : {"0", "1.5", "-2"}) {
    const nlohmann::json one = contour(ball_, {"--iso=" + iso, "--normals", "-o", path("one.ply")});
    expect_same("out_" + iso + ".ply", "one.ply");
    const auto place =
        std::find_if(all.begin(), all.end(), [&](const auto& other) { return other["isovalue"] == one["isovalue"]; });
    for (const char* const key : {"vertices", "simplices", "components", "euler", "boundary_simplices", "active_tiles"})
      EXPECT_EQ((*place)[key], one[key]) << key;
  }
}

TEST_F(Isovalues, TakeTheirPlaceInAPattern) {
  contour(ball_, {"--iso", "0:2:3", "-o", path("at{iso}.glb")});
  EXPECT_THAT(files(), ElementsAre("at0.glb", "at1.glb", "at2.glb", "ball.nrrd"));
  contour(ball_, {"--iso", "0.50", "-o", path("at{iso}.glb")});
  EXPECT_THAT(files(), testing::Contains("at0.50.glb"));
}

TEST_F(Isovalues, AreAnAttributeInOneFile) {
  const nlohmann::json report = contour(ball_, {"--iso", "0,1.5,-1", "--one-file", "-o", path("all.vtkhdf")});
  EXPECT_EQ(report["isovalues"], (std::vector<double>{0, 1.5, -1}));
  EXPECT_TRUE(report["isovalue"].is_null());
  EXPECT_EQ(report["components"], 3);
  EXPECT_EQ(report["euler"], 6);
  EXPECT_EQ(report["nonmanifold_simplices"], 0);
  const Mesh mesh = read_mesh(path("all.vtkhdf"));
  ASSERT_EQ(mesh.vertex_attributes.size(), 1U);
  ASSERT_EQ(mesh.simplex_attributes.size(), 1U);
  EXPECT_EQ(mesh.vertex_attributes[0].name, "isovalue");
  const auto& of_vertices = mesh.vertex_attributes[0].values;
  const auto& of_simplices = mesh.simplex_attributes[0].values;
  for (std::size_t s = 0; s < of_simplices.size(); ++s)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(of_vertices[mesh.simplices[3 * s + j]], of_simplices[s]);
  for (const double iso : {0.0, 1.5, -1.0}) {
    contour(ball_, {"--iso=" + std::to_string(iso), "-o", path("one.ply")});
    EXPECT_EQ(static_cast<std::size_t>(std::count(of_simplices.begin(), of_simplices.end(), iso)),
              read_mesh(path("one.ply")).simplices.size() / 3);
  }
}

TEST_F(Isovalues, AreStreamedInOnePassWithTheSameBytes) {
  const std::vector<std::string> isos = {"10", "20", "27.5"};
  const nlohmann::json all =
      contour(kOcean, {"--iso", "10,20,27.5", "--stream", "--normals", "-o", path("all_{iso}.vtkhdf")});
  ASSERT_EQ(all.size(), 3U);
  for (std::size_t i = 0; i < isos.size(); ++i) {
    const nlohmann::json one = contour(kOcean, {"--iso", isos[i], "--stream", "--normals", "-o", path("one.vtkhdf")});
    expect_same("all_" + isos[i] + ".vtkhdf", "one.vtkhdf");
    EXPECT_EQ(all[i]["simplices"], one["simplices"]);
    EXPECT_EQ(all[i]["active_tiles"], one["active_tiles"]);
  }
}

TEST_F(Isovalues, WorkWithIndexFacetsPicksAndTriangulations) {
  ASSERT_EQ(run_tegl({"index", ball_, "-o", path("ball.tindex")}).exit, 0);
  contour(ball_, {"--iso", "0,1", "-o", path("plain.ply")});
  contour(ball_, {"--iso", "0,1", "--index", path("ball.tindex"), "-o", path("indexed.ply")});
  for (const std::string iso : {"0", "1"}) expect_same("plain_" + iso + ".ply", "indexed_" + iso + ".ply");
  EXPECT_EQ(contour(ball_, {"--iso", "0,1", "--pick", "5,5,1", "-o", path("picked.ply")}).size(), 2U);
  EXPECT_EQ(contour(ball_, {"--iso", "0,1", "--triangulation", "fan", "-o", path("fan.ply")}).size(), 2U);
  EXPECT_EQ(contour(ball_, {"--iso", "0,1", "--facets", "-o", path("facets.vtu")})[1]["facets"]["polygons"],
            contour(ball_, {"--iso", "1", "--facets", "-o", path("facet.vtu")})["facets"]["polygons"]);
}

// The name of the second output exceeds the limit of file systems, which fails only when it is written.
TEST_F(Isovalues, KeepWhatWasThereIfALateOneFails) {
  const std::string late = "1." + std::string(240, '0');
  const std::string raw = write("ball.raw", raw_ball());
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"contour", ball_, "-o", path("out_{iso}.vtkhdf")},
        {"contour", ball_, "--facets", "-o", path("out_{iso}.vtkhdf")},
        {"contour", raw, "--raw", "12x12x12", "--raw-type", "float", "-o", path("out_{iso}.vtkhdf")}}) {
    const std::string old = write("out_0.vtkhdf", "what was there before");
    const auto before = files();
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--iso", "0," + late});
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 6) << run.err;
    EXPECT_THAT(run.err, HasSubstr(path("out_" + late + ".vtkhdf")));
    EXPECT_EQ(read_text(old), "what was there before") << command[2];
    EXPECT_EQ(files(), before) << command[2];
  }
}

TEST_F(Isovalues, AreWrittenThroughLinksAndOverWhatWasThere) {
  write("old_0.ply", "what was there before");
  std::filesystem::create_symlink(path("old_0.ply"), path("out_0.ply"));
  write("out_1.ply", "what was there before");
  contour(ball_, {"--iso", "0,1", "-o", path("out.ply")});
  EXPECT_TRUE(std::filesystem::is_symlink(path("out_0.ply")));
  for (const char* const name : {"old_0.ply", "out_1.ply"}) EXPECT_GT(read_mesh(path(name)).simplices.size(), 0U);
}

TEST_F(Isovalues, LeaveNothingIfOneOfThemFails) {
  for (const char* const more : {"--no-check", "--one-file"})
    expect_refused(5, {"--iso", "0,99", more, "-o", path("out.vtkhdf")}, {"99"});
  const std::string raw = write("ball.raw", raw_ball());
  const auto before = files();
  const RunResult run =
      run_tegl({"contour", raw, "--raw", "12x12x12", "--raw-type", "float", "--iso", "0,99", "-o", path("out.vtkhdf")});
  EXPECT_EQ(run.exit, 5) << run.err;
  EXPECT_THAT(run.err, HasSubstr("99"));
  EXPECT_EQ(files(), before);
}

TEST_F(Isovalues, AreStreamedAsManyAsThereMayBeOpenFiles) {
  const std::string raw = write("ball.raw", raw_ball());
  const std::vector<std::string> command = {"contour", raw,      "--raw",   "12x12x12", "--raw-type",           "float",
                                            "--iso",   "0:2:80", "--quiet", "-o",       path("at_{iso}.vtkhdf")};
  const auto with_files = [&](rlim_t allowed, rlim_t at_most) {
    return run_tegl(command, [=] {
      const rlimit limit{allowed, at_most};
      setrlimit(RLIMIT_NOFILE, &limit);
    });
  };
  const RunResult refused = with_files(64, 64);
  EXPECT_EQ(refused.exit, 2) << refused.err;
  EXPECT_THAT(refused.err, testing::AllOf(HasSubstr("80 numbers"), HasSubstr("allows 64 open files"),
                                          HasSubstr("expected at most 32")));
  EXPECT_EQ(files().size(), 2U) << "the image and its raw values";
  const RunResult raised = with_files(64, 256);  // the program may raise its limit, and does
  EXPECT_EQ(raised.exit, 0) << raised.err;
  EXPECT_EQ(files().size(), 82U);
}

TEST_F(Isovalues, ThatCannotBeAreRefused) {
  expect_refused(2, {"--iso", "0,1,0", "-o", path("out.ply")}, {"--iso has 0 twice"});
  expect_refused(2, {"--iso", "0,", "-o", path("out.ply")}, {"--iso"});
  expect_refused(2, {"--iso", "0", "--one-file", "-o", path("out.ply")}, {"--one-file with one isovalue"});
  expect_refused(2, {"--iso", "0,1", "--one-file", "-o", path("out_{iso}.ply")}, {"expected a name without {iso}"});
  expect_refused(2, {"--iso", "0,1", "--one-file", "--facets", "-o", path("out.vtu")}, {"--one-file with --facets"});
  const RunResult run = run_tegl({"slice", ball_, "--iso", "0,1", "--at", "z=5", "-o", path("out.ply")});
  EXPECT_EQ(run.exit, 2);
  EXPECT_THAT(run.err, HasSubstr("--iso has 2 numbers"));
}

/// Commands with several results: one file each, or an error before any file is lost.
class Outputs : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ball_ = write("ball.nrrd", nrrd_bytes(ball({12, 12, 12}, 4)));
  }
  void expect_refused(const std::vector<std::string>& arguments) const {
    const auto before = files();
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 2) << run.out << run.err;
    EXPECT_THAT(run.err, HasSubstr("expected a file for each result"));
    EXPECT_EQ(files(), before);
  }
  std::string ball_;
};

// Around 1013.25 hPa in Pa, six digits do not distinguish neighbouring isovalues.
TEST_F(Outputs, OfARangeFarFromZeroHaveNamesOfTheirOwn) {
  Samples samples = ball({12, 12, 12}, 4);
  for (float& value : samples.values) value = 101325.0F + value;
  const std::string image = write("pressure.nrrd", nrrd_bytes(samples));
  const RunResult run =
      run_tegl({"contour", image, "--iso", "101325:101325.4:5", "--json", "-o", path("p_{iso}.ply"), "--no-check"});
  ASSERT_EQ(run.exit, 0) << run.err;
  std::vector<std::string> names;
  for (const std::string& name : files())
    if (name.ends_with(".ply")) names.push_back(name);
  std::sort(names.begin(), names.end());
  EXPECT_THAT(names,
              ElementsAre("p_101325.1.ply", "p_101325.2.ply", "p_101325.3.ply", "p_101325.4.ply", "p_101325.ply"));
  for (const std::string& name : names) EXPECT_NEAR(*read_mesh(path(name)).isovalue, std::stod(name.substr(2)), 1e-9);
}

TEST_F(Outputs, ThatAreOneFileAreRefused) {
  expect_refused({"components", ball_, "--iso", "0", "-o", path("a.ply"), "--csv", path("a.ply")});
  expect_refused({"components", ball_, "--iso", "0", "-o", path("a0.ply"), "--split", path("a{label}.ply")});
  std::filesystem::create_symlink("a.ply", path("b.ply"));
  expect_refused({"components", ball_, "--iso", "0", "-o", path("a.ply"), "--csv", path("b.ply")});
  std::filesystem::create_symlink("s_5.ply", path("s_6.ply"));
  expect_refused({"slice", ball_, "--iso", "0", "--at", "z=5,6", "-o", path("s_{at}.ply")});
  expect_refused({"contour", ball_, "--iso", "5,6", "-o", path("s_{iso}.ply")});
  expect_refused({"track", ball_, "--iso", "0", "-o", path("g.json"), "-o", path("./g.json")});
  expect_refused(
      {"track", ball_, "--iso", "0", "-o", path("g-events.csv.dot"), "-o", path("g.svg"), "-o", path("g.svg")});
}

TEST_F(Outputs, OfTracksAppearTogetherWithTheirTables) {
  const std::string late(250, 'g');
  write("g.json", "what was there before");
  const auto before = files();
  const RunResult run =
      run_tegl({"track", ball_, "--iso", "0", "-o", path("g.json"), "-o", path(late + ".svg"), "--csv", path("t")});
  EXPECT_EQ(run.exit, 6) << run.out << run.err;
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace tegl::test
