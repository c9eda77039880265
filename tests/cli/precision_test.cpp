// SPDX-License-Identifier: BSD-3-Clause
//
// --precision float and --compress: smaller files that can be read back.
#include <gmock/gmock.h>

#include <filesystem>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class Precision : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    solid_ = write("solid.nrrd", nrrd_bytes(ball({40, 40, 40}, 15)));
    balls_ = write("balls.nrrd", nrrd_bytes(merging_balls(14, 7)));
  }
  /// Runs the command with this output; returns the file's size.
  [[nodiscard]] double size(std::vector<std::string> command, const std::string& output,
                            const std::vector<std::string>& more) const {
    command.insert(command.end(), {"-o", path(output)});
    command.insert(command.end(), more.begin(), more.end());
    const RunResult run = run_tegl(command);
    EXPECT_EQ(run.exit, 0) << run.err;
    return static_cast<double>(std::filesystem::file_size(path(output)));
  }
  static void expect_floats(const MeshArray<double>& values) {
    for (const double value : values) ASSERT_EQ(value, static_cast<double>(static_cast<float>(value)));
  }

  std::string solid_, balls_;
};

TEST_F(Precision, FloatMakesFilesSmallerInTheFormatsThatHaveBoth) {
  // Maximum size as a share of the file in double precision.
  const std::vector<std::pair<std::string, double>> formats = {
      {".ply", 0.75}, {".obj", 0.85}, {".vtkhdf", 0.56}, {".glb", 1.0}};
  for (const auto& [extension, share] : formats) {
    const std::vector<std::string> command = {"contour", solid_, "--iso", "0.3", "--normals"};
    const double in_double = size(command, "double" + extension, {});
    const double in_float = size(command, "float" + extension, {"--precision", "float"});
    EXPECT_LE(in_float, share * in_double) << extension;
    const Mesh a = read_mesh(path("double" + extension));
    const Mesh b = read_mesh(path("float" + extension));
    EXPECT_EQ(a.simplices, b.simplices);
    if (extension != ".obj") {  // OBJ has the digits of a float but is read as double
      expect_floats(b.coordinates);
      expect_floats(b.normals);
    }
    ASSERT_EQ(a.coordinates.size(), b.coordinates.size());
    for (std::size_t i = 0; i < a.coordinates.size(); ++i) ASSERT_NEAR(a.coordinates[i], b.coordinates[i], 1e-4);
  }
}

TEST_F(Precision, FloatHalvesContoursIn4dAndTheirParts) {
  const std::vector<std::vector<std::string>> commands = {
      {"contour", balls_, "--iso", "0"},
      {"contour", balls_, "--iso", "0", "--normals"},
      {"components", balls_, "--iso", "0", "--largest", "1"},
      {"contour", balls_, "--iso", "0", "--triangulation", "barycentric"}};
  for (const std::vector<std::string>& command : commands) {
    const double in_double = size(command, "double.vtkhdf", {});
    EXPECT_LE(size(command, "float.vtkhdf", {"--precision", "float"}), 0.65 * in_double)
        << testing::PrintToString(command);
    expect_floats(read_mesh(path("float.vtkhdf")).coordinates);
    EXPECT_EQ(read_mesh(path("float.vtkhdf")).simplices, read_mesh(path("double.vtkhdf")).simplices);
  }
  const std::vector<std::string> facets = {"contour", balls_, "--iso", "0", "--facets"};
  EXPECT_LE(size(facets, "float.vtu", {"--precision", "float"}), 0.56 * size(facets, "double.vtu", {}));
  const std::vector<std::string> cut = {"slice", balls_, "--iso", "0", "--at", "t=2.5"};
  EXPECT_LE(size(cut, "float.ply", {"--precision", "float"}), 0.8 * size(cut, "double.ply", {}));
}

TEST_F(Precision, CompressedFilesHoldTheSame) {
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{}, {"--precision", "float"}, {"--normals"}}) {
    std::vector<std::string> command = {"contour", balls_, "--iso", "0"};
    command.insert(command.end(), more.begin(), more.end());
    const double plain = size(command, "plain.vtkhdf", {});
    EXPECT_LE(size(command, "packed.vtkhdf", {"--compress"}), 0.7 * plain);
    const Mesh a = read_mesh(path("plain.vtkhdf"));
    const Mesh b = read_mesh(path("packed.vtkhdf"));
    EXPECT_EQ(a.coordinates, b.coordinates);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.simplices, b.simplices);
    EXPECT_EQ(a.axis_names, b.axis_names);
    EXPECT_EQ(a.isovalue, b.isovalue);
  }
  const std::string saved = path("plain.vtkhdf");
  const std::vector<std::vector<std::string>> others = {{"slice", saved, "--at", "t=2"},
                                                        {"components", saved},
                                                        {"track", saved},
                                                        {"project", saved},
                                                        {"simplify", saved, "--max-error", "0"},
                                                        {"contour", solid_, "--iso", "0.3", "--facets"}};
  for (const std::vector<std::string>& command : others)
    EXPECT_LT(size(command, "packed.vtkhdf", {"--compress"}), 0.8 * size(command, "plain2.vtkhdf", {}))
        << testing::PrintToString(command);
  const std::vector<std::string> facets = {"contour", balls_, "--iso", "0", "--facets"};
  EXPECT_LT(size(facets, "packed.vtu", {"--compress"}), 0.5 * size(facets, "plain.vtu", {}));
}

TEST_F(Precision, CompressionIsRefusedWhereAFormatHasNone) {
  for (const char* const name : {"a.ply", "a.obj", "a.stl", "a.glb"}) {
    const RunResult run = run_tegl({"contour", solid_, "--iso", "0.3", "--compress", "-o", path(name)});
    EXPECT_EQ(run.exit, 6);
    EXPECT_THAT(run.err, HasSubstr("has no compression; expected .vtkhdf"));
  }
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"components", solid_, "--iso", "0.3", "--compress"},
                                             {"track", solid_, "--iso", "0.3", "--compress", "-o", path("a.json")}}) {
    const RunResult run = run_tegl(command);
    EXPECT_EQ(run.exit, 2);
    EXPECT_THAT(run.err, HasSubstr("--compress without a file of a contour"));
  }
}

}  // namespace
}  // namespace tegl::test
