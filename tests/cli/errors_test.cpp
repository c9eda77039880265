// SPDX-License-Identifier: BSD-3-Clause
//
// Errors of all commands: exit code, a message with the file and the value, and no file left behind.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "sample_files.hpp"
#include "tegl/delaunay.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Errors : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ball_ = write("ball.nrrd", nrrd_bytes(ball({8, 8, 8}, 2.2)));
  }
  [[nodiscard]] const std::string& ball_file() const { return ball_; }

  /// Expects the exit code, one line on standard error with all the parts, nothing on standard output, and no new
  /// files.
  void expect_failure(int exit, const std::vector<std::string>& arguments,
                      const std::vector<std::string>& parts) const {
    const std::vector<std::string> before = files();
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.err;
    EXPECT_THAT(run.err, StartsWith("tegl: "));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    for (const std::string& part : parts) EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(files(), before);
  }
  void expect_contour_failure(int exit, const std::string& file, const std::string& iso, const std::string& out,
                              const std::vector<std::string>& parts) const {
    expect_failure(exit, {"contour", file, "--iso", iso, "-o", out}, parts);
  }

 private:
  std::string ball_;
};

TEST_F(Errors, HostileImagesExitWith4) {
  const std::string meta = "NDims = 2\nBinaryData = True\nDimSize = 2 2\nElementType = MET_UCHAR\n";
  const std::string nrrd = "NRRD0004\ntype: uchar\ndimension: 2\nsizes: 2 2\n";
  const auto refused = [&](const std::string& name, const std::string& bytes, const std::string& part) {
    expect_failure(4, {"info", write(name, bytes)}, {name, part});
  };
  refused("name.mha", meta + "Name = " + std::string(300, 'A') + "\nElementDataFile = LOCAL\n1234", "at most 254");
  refused("labels.nrrd", nrrd + "labels: \"" + std::string(1000, 'a') + "\nencoding: raw\n\n1234", "quotation mark");
  refused("ascii.nrrd", nrrd + "encoding: ascii\n\n1 2 3 300", "sample 3 is '300'");
  refused("name.nc",
          "CDF\5" + std::string(8, '\0') + std::string("\0\0\0\x0a", 4) + std::string(7, '\0') + "\1" +
              std::string(8, '\xff') + std::string(64, 'z'),
          "netCDF name of -1 bytes");
}

TEST_F(Errors, SamplesOutsideOfTheHeadersFolderNeedAnOption) {
  std::filesystem::create_directory(path("headers"));
  write("a.raw", "12345678");
  const std::string file = write("headers/a.nhdr",
                                 "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                                 "data file: ../a.raw\n");
  expect_failure(4, {"info", file}, {"a.nhdr", "../a.raw", path("headers"), "--allow-outside-paths"});
  expect_failure(4, {"contour", file, "--iso", "52", "--stream", "-o", path("o.vtkhdf")}, {"--allow-outside-paths"});
  EXPECT_EQ(run_tegl({"info", file, "--allow-outside-paths"}).exit, 0);
}

TEST_F(Errors, WrongUsageExitsWith2) {
  const std::string out = path("out.ply");
  expect_failure(2, {}, {"--help"});
  expect_failure(2, {"paint"}, {"paint", "contour"});
  expect_failure(2, {"contour", ball_file(), "-o", out}, {"--iso"});
  expect_failure(2, {"contour", ball_file(), "--iso", "0"}, {"--output"});
  expect_failure(2, {"contour", "--iso", "0", "-o", out}, {"FILE"});
  expect_failure(2, {"contour", ball_file(), "--iso", "0", "-o", out, "--colour"}, {"--colour", "tegl contour --help"});
  expect_failure(2, {"contour", ball_file(), "--iso", "0", "-o", out, "--triangulation", "fine"}, {"fine", "compact"});
  expect_failure(2, {"contour", ball_file(), "--iso", "0", "-o", out, "--ambiguity", "median"},
                 {"--ambiguity is 'median'; expected one of low, high, mean, saddle, squares, decider"});
  expect_failure(2, {"contour", ball_file(), "--iso", "0", "-o", out, "--precision", "half"}, {"half", "double"});
  expect_failure(2, {"contour", ball_file(), "--iso", "0", "-o", out, "--gradient-direction", "up"}, {"up", "descent"});
  expect_failure(2, {"slice", ball_file(), "--iso", "0", "-o", out, "--at", "7.3"}, {"7.3", "t=7.3"});
  expect_failure(2, {"slice", ball_file(), "--iso", "0", "-o", out}, {"--at"});
  expect_failure(2, {"check", ball_file(), "--require", "round"}, {"round", "closed"});
  EXPECT_EQ(run_tegl({"contour", ball_file(), "--iso", "0", "-o", out, "--json", "--quiet"}).exit, 2);
}

TEST_F(Errors, MemoryThatRunsOutInATriangulationIsReportedAsSuch) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space";
#endif
  if (!has_delaunay()) GTEST_SKIP() << "built without Qhull";
  std::string rows = "x,y,z,v\n";
  std::uint32_t state = 1;
  const auto next = [&] { return (state = state * 1664525U + 1013904223U) >> 8U; };
  for (int i = 0; i < 300000; ++i) {
    const auto x = next(), y = next(), z = next();
    rows += std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) + "," + std::to_string(i) + "\n";
  }
  const std::string table = write("points.csv", rows);
  const std::string command = "ulimit -v 400000; exec " TEGL_PROGRAM " contour " + table + " --iso 1000.5 -q -o " +
                              path("out.ply") + " 2> " + path("said");
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 70);
  std::ifstream said(path("said"));
  EXPECT_THAT(std::string(std::istreambuf_iterator<char>(said), {}), HasSubstr("points.csv: out of memory"));
}

TEST_F(Errors, ListsHaveNoEmptyWords) {
  const std::string out = path("out.vtkhdf");
  for (const std::string list : {",", "x,", ",x", "x,,y", ""})
    expect_failure(2, {"contour", ball_file(), "--iso", "0", "--periodic", list, "-o", out},
                   {"--periodic is '" + list + "'", "none of them empty"});
  for (const std::string list : {",", "2,", "2,,1"})
    expect_failure(2, {"index", ball_file(), "--method", "seed-set", "--scan-order", list, "-o", out},
                   {"--scan-order is '" + list + "'", "none of them empty"});
  expect_failure(2, {"check", ball_file(), "--require", "closed,"}, {"--require is 'closed,'", "none of them empty"});
  for (const std::string list : {",", "0,", "0,,1"})
    expect_failure(2, {"contour", ball_file(), "--iso", list, "-o", out}, {"--iso is ''", "expected a number"});
  // lists that are given twice are joined
  for (const char* const option : {"--periodic=x,y", "--periodic=y"})
    expect_failure(2, {"contour", ball_file(), "--iso", "0", "--periodic", "x", option, "--periodic=none", "-o", out},
                   {"--periodic x,", "expected none without other axes"});
  expect_failure(2, {"contour", ball_file(), "--iso", "0", "--periodic", "x=-1", "-o", out},
                 {"--periodic x=-1; expected a positive period"});
}

TEST_F(Errors, OptionsOfImagesAreRefusedWithMeshes) {
  const std::string table = write("points.csv", "x,y,v\n0,0,0\n1,0,1\n0,1,2\n");
  for (const std::vector<std::string>& given : {std::vector<std::string>{"--periodic", "x"},
                                                {"--lattice", "triangular"},
                                                {"--division", "kuhn"},
                                                {"--samples-are", "cells"}}) {
    for (std::vector<std::string> command : {std::vector<std::string>{"contour", table, "-o", path("out.vtkhdf")},
                                             std::vector<std::string>{"measure", table}}) {
      command.insert(command.end(), {"--iso", "1", given[0], given[1]});
      expect_failure(2, command,
                     {given[0] + " " + given[1] + " with " + table +
                      ", which is a mesh; expected an image, or the mesh without this option"});
    }
  }
}

TEST_F(Errors, NumbersThatAreNoneExitWith2) {
  for (const char* iso : {"abc", "nan", "inf", "-inf", "7x", "1e999", ""}) {
    expect_contour_failure(2, ball_file(), iso, path("out.ply"), {iso, "--iso"});
  }
  for (const char* epsilon : {"0.5", "-0.1", "nan", "x"}) {
    expect_failure(2, {"contour", ball_file(), "--iso", "0", "-o", path("out.ply"), "--epsilon", epsilon},
                   {epsilon, "--epsilon"});
  }
  const auto refuse_periodic = [&](const std::string& periodic, const std::string& message) {
    expect_failure(2, {"contour", ball_file(), "--iso", "0", "-o", path("out.vtkhdf"), "--periodic", periodic},
                   {message});
  };
  refuse_periodic("x=nan", "--periodic x is 'nan'; expected a finite number");
  refuse_periodic("y=", "--periodic y is ''; expected a number");
  refuse_periodic("y,all", "--periodic names the axis y twice");
}

TEST_F(Errors, VariablesThatDoNotExistExitWith2) {
  expect_failure(2, {"contour", ball_file(), "--iso", "0", "-o", path("out.ply"), "--var", "TEMP"},
                 {ball_file(), "TEMP"});
}

TEST_F(Errors, InputThatIsNotThereExitsWith3) {
  for (const char* command : {"info", "check"}) {
    expect_failure(3, {command, path("none.nrrd")}, {path("none.nrrd"), "no such file"});
    expect_failure(3, {command, path("")}, {path(""), "directory"});
  }
  expect_contour_failure(3, path("none.nrrd"), "0", path("out.ply"), {path("none.nrrd"), "no such file"});
  expect_contour_failure(3, path(""), "0", path("out.ply"), {"directory"});
  expect_failure(3, {"slice", path("none.nii"), "--iso", "0", "--at", "t=1", "-o", path("out.ply")}, {"none.nii"});
  // A header whose data file is missing.
  const std::string header = write("detached.nhdr",
                                   "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 3 3\nencoding: raw\n"
                                   "data file: missing.raw\n");
  const RunResult run = run_tegl({"info", header});
  EXPECT_THAT(run.exit, testing::AnyOf(3, 4)) << run.err;
  EXPECT_THAT(run.err, HasSubstr("missing.raw"));
}

TEST_F(Errors, DamagedInputExitsWith4) {
  const Samples balls = merging_balls(9, 3);
  const std::vector<std::pair<std::string, std::string>> sound = {{"cut.nrrd", nrrd_bytes(balls)},
                                                                  {"cut.nii", nifti_bytes(balls, {1, 1, 1, 1})},
                                                                  {"cut.mha", metaimage_bytes(balls)}};
  for (const auto& [name, bytes] : sound) {
    const std::string file = write(name, bytes.substr(0, bytes.size() - 1000));
    expect_contour_failure(4, file, "0", path("out.vtkhdf"), {file});
    expect_failure(4, {"info", file}, {file});
    const std::string header = write("header_" + name, bytes.substr(0, 40));
    expect_contour_failure(4, header, "0", path("out.vtkhdf"), {header});
    const std::string empty = write("empty_" + name, "");
    expect_contour_failure(4, empty, "0", path("out.vtkhdf"), {empty});
    const std::string garbage = write("garbage_" + name, std::string(2000, '\x5a'));
    expect_contour_failure(4, garbage, "0", path("out.vtkhdf"), {garbage});
  }
  const std::string garbage = write("garbage.nc", std::string(2000, '\x5a'));
  expect_contour_failure(4, garbage, "0", path("out.vtkhdf"), {garbage});
}

TEST_F(Errors, UnknownInputExitsWith4) {
  const std::string file = write("image.txt", "1 2 3\n");
  expect_contour_failure(4, file, "0", path("out.ply"), {file});
  // An image with a single axis.
  const std::string line = write("line.nrrd", nrrd_bytes(ball({9}, 2)));
  expect_contour_failure(4, line, "0", path("out.ply"), {line});
}

TEST_F(Errors, AnIsovalueOutOfRangeExitsWith5AndNamesTheRange) {
  const std::string file = write("small.nrrd", nrrd_bytes(sample({3, 3}, [](auto& x) { return x[0] + 3 * x[1]; })));
  expect_contour_failure(5, file, "8.5", path("out.ply"), {file, "8.5", "0 < isovalue <= 8"});
  expect_contour_failure(5, file, "-2", path("out.ply"), {file, "-2", "0 .. 8"});
  // No sample lies below the minimum.
  expect_contour_failure(5, file, "0", path("out.ply"), {file, "0 < isovalue <= 8"});
  expect_failure(5, {"contour", file, "--iso", "-2", "--close", "-o", path("out.ply")}, {"-2"});
}

TEST_F(Errors, AnAxisOfOneSampleExitsWith5) {
  const std::string file = write("flat.nrrd", nrrd_bytes(sample({1, 4, 4}, [](auto& x) { return x[1] + x[2]; })));
  expect_contour_failure(5, file, "2", path("out.ply"), {file, "1 sample", "'x'"});
}

TEST_F(Errors, NothingButMissingSamplesExitsWith5) {
  const std::string file = write("nan.nrrd", nrrd_bytes(sample({4, 4, 4}, [](auto&) { return NAN; })));
  expect_contour_failure(5, file, "0", path("out.ply"), {file, "missing"});
}

TEST_F(Errors, OutputThatCannotBeWrittenExitsWith6) {
  const std::string four = write("balls.nrrd", nrrd_bytes(merging_balls(9, 3)));
  for (const char* name : {"out.ply", "out.glb", "out.gltf"}) {
    expect_contour_failure(6, four, "0", path(name), {path(name), "4D", ".vtkhdf"});
  }
  expect_contour_failure(6, ball_file(), "0", path("out.xyz"), {path("out.xyz"), ".xyz", ".ply"});
  expect_contour_failure(6, ball_file(), "0", path("out"), {path("out"), "extension"});
  expect_contour_failure(6, ball_file(), "0", path("none/out.ply"), {path("none/out.ply"), "does not exist"});
  expect_contour_failure(6, ball_file(), "0", ball_file() + "/out.ply", {"not a folder"});
  expect_contour_failure(6, ball_file(), "0", "/proc/out.ply", {"/proc/out.ply"});
}

TEST_F(Errors, AFileThatGrowsBeyondItsLimitExitsWith6InEveryFormat) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  for (const char* name : {"out.ply", "out.glb", "out.vtkhdf"})
    for (const rlim_t limit : {rlim_t{100}, rlim_t{3000}}) {
      const rlimit small{limit, before.rlim_max};
      ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);  // inherited by the program
      expect_contour_failure(6, ball_file(), "0", path(name), {path(name), "File too large"});
      ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    }
  for (const std::string& name : {path("out.nc"), path("out.nrrd"), path("out.vti")}) {
    const rlimit small{300, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    expect_failure(6, {"filter", ball_file(), "--gaussian", "1", "-o", name},
                   {name + ": cannot be written (File too large)"});
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  }
}

TEST_F(Errors, AReportThatCannotBeWrittenExitsWith6) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  for (const std::string& command : {"info " + ball_file(), "info --json " + ball_file()}) {
    const int status = std::system((TEGL_PROGRAM " " + command + " > /dev/full 2> /dev/null").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 6) << command;
  }
}

TEST_F(Errors, ASavedContourIsNoImage) {
  const std::string saved = path("saved.vtkhdf");
  ASSERT_EQ(run_tegl({"contour", ball_file(), "--iso", "0", "-o", saved}).exit, 0);
  expect_failure(4, {"index", saved}, {saved, "mesh", "expected an image"});
  expect_contour_failure(4, saved, "0", path("out.ply"), {saved, "mesh", "expected an image"});
}

/// A surface of four triangles with this last vertex, and further triangles.
std::string tetrahedron_ply(const std::string& last, const std::vector<std::string>& others = {}) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(4 + others.size()) +
      "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n" + last +
      "\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  for (const std::string& other : others) text += other + "\n";
  return text;
}

/// All commands that read a saved contour in space.
std::vector<std::vector<std::string>> all_of_saved_contours(const std::string& file, const std::string& out) {
  return {{"slice", file, "--at", "z=0.5", "-o", out},
          {"simplify", file, "--ratio", "0.5", "-o", out},
          {"simplify", file, "--method", "vertices", "--max-error", "0.5", "-o", out},
          {"measure", file},
          {"components", file, "-o", out},
          {"elements", file, "-o", out + ".dat"},
          {"track", file, "-o", out + ".json"}};
}

TEST_F(Errors, ASavedContourAtNoFinitePlaceExitsWith4) {
  for (const char* x : {"nan", "inf", "-inf"}) {
    const std::string file = write("nowhere.ply", tetrahedron_ply("0 " + std::string(x) + " 1"));
    auto all = all_of_saved_contours(file, path("out.ply"));
    all.push_back({"check", file});
    for (const auto& arguments : all) {
      SCOPED_TRACE(arguments[0]);
      expect_failure(4, arguments, {file, "a coordinate of vertex 3 is " + std::string(x) + "; expected finite ones"});
    }
  }
  Mesh mesh;
  mesh.dim = 3;
  mesh.space_dim = 4;
  mesh.coordinates = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, static_cast<double>(NAN)};
  mesh.simplices = {0, 1, 2, 3};
  write_mesh(mesh, path("nowhere.vtkhdf"));
  expect_failure(4, {"project", path("nowhere.vtkhdf"), "-o", path("out.ply")},
                 {path("nowhere.vtkhdf"), "a coordinate of vertex 3 is nan"});
  mesh.coordinates.back() = -static_cast<double>(NAN);
  write_mesh(mesh, path("nowhere.vtkhdf"));
  expect_failure(4, {"check", path("nowhere.vtkhdf")}, {"a coordinate of vertex 3 is nan"});
}

TEST_F(Errors, AnInfiniteCoordinateOfAModelIsNamedAsSuch) {
  constexpr float kPlace = 12345.0F;  // searched for in the file
  Mesh mesh;
  mesh.dim = 2;
  mesh.space_dim = 3;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, kPlace};
  mesh.simplices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  write_mesh(mesh, path("far.glb"));
  std::ifstream stream(path("far.glb"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const auto raw = [](float x) {
    std::string result(sizeof(x), '\0');
    std::memcpy(result.data(), &x, sizeof(x));
    return result;
  };
  ASSERT_NE(bytes.find(raw(kPlace)), std::string::npos);
  bytes.replace(bytes.find(raw(kPlace)), sizeof(float), raw(INFINITY));
  const std::string file = write("away.glb", bytes);
  expect_failure(4, {"check", file}, {file, "a coordinate of vertex 3 is inf; expected finite ones"});
}

TEST_F(Errors, AMeshWithBytesInAnotherFolderNeedsAnOption) {
  std::filesystem::create_directories(path("meshes"));
  const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<unsigned char> corners = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  const std::string bytes = std::string(reinterpret_cast<const char*>(points.data()), 48) +
                            std::string(reinterpret_cast<const char*>(corners.data()), 12);
  write("outside.bin", bytes);
  const std::string file =
      write("meshes/a.gltf",
            R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{)"
            R"("attributes":{"POSITION":0},"indices":1}]}],"bufferViews":[{"buffer":0,"byteLength":48},)"
            R"({"buffer":0,"byteOffset":48,"byteLength":12}],"accessors":[{"bufferView":0,"componentType":5126,)"
            R"("count":4,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}],)"
            R"("buffers":[{"byteLength":60,"uri":"../outside.bin"}]})");
  auto all = all_of_saved_contours(file, path("out.ply"));
  all.push_back({"check", file});
  for (const auto& arguments : all) {
    SCOPED_TRACE(arguments[0]);
    expect_failure(4, arguments, {file, "outside.bin", "--allow-outside-paths"});
  }
  for (const char* const command : {"check", "measure"}) {
    const RunResult run = run_tegl({command, file, "--allow-outside-paths"});
    EXPECT_EQ(run.exit, 0) << run.err;
  }
}

TEST_F(Errors, ASavedContourWithoutSimplicesExitsWith5) {
  const std::string file = write("empty.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                                 "property float z\nelement face 0\nproperty list uchar int vertex_indices\n"
                                 "end_header\n");
  for (const auto& arguments : all_of_saved_contours(file, path("out.ply"))) {
    SCOPED_TRACE(arguments[0]);
    expect_failure(5, arguments, {file, "the saved contour is empty"});
  }
}

TEST_F(Errors, PinchesAndConflictsOfOrientationStayWhenSimplifiedAndExitWith1) {
  std::string turned = tetrahedron_ply("0 0 1");
  turned.replace(turned.find("3 0 2 1"), 7, "3 0 1 2");
  const std::string file = write("turned.ply", turned);
  const std::vector<std::string> arguments = {"simplify", file, "--ratio", "0.5", "-o", path("out.ply")};
  const RunResult run = run_tegl(arguments);
  EXPECT_EQ(run.exit, 1) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 orientation conflicts"));
  EXPECT_TRUE(std::filesystem::exists(path("out.ply")));
  auto unchecked = arguments;
  unchecked.emplace_back("--no-check");
  EXPECT_EQ(run_tegl(unchecked).exit, 0);
}

TEST_F(Errors, WhatIsNoManifoldIsNotSimplifiedAndExitsWith4) {
  const std::string branching = write("branching.ply", tetrahedron_ply("0 0 1", {"3 0 3 1"}));
  expect_failure(4, {"simplify", branching, "--ratio", "0.5", "-o", path("out.ply")},
                 {branching, "is in 3 simplices; expected 1 or 2"});
  const std::string collapsed = write("collapsed.ply", tetrahedron_ply("0 0 1", {"3 1 3 1"}));
  expect_failure(4, {"simplify", collapsed, "--ratio", "0.5", "-o", path("out.ply")},
                 {collapsed, "has the vertex 1 twice"});
}

TEST_F(Errors, ConstantValuesExitWith5AndSaySo) {
  const std::string file = write("constant.nrrd", nrrd_bytes(sample({3, 3}, [](auto&) { return 1.0; })));
  expect_contour_failure(5, file, "1", path("out.ply"), {file, "all values are 1"});
}

TEST_F(Errors, AnOptionGivenTwiceIsNamed) {
  expect_failure(2, {"contour", ball_file(), "--iso", "0", "--epsilon", "0", "--epsilon", "0.1", "-o", path("out.ply")},
                 {"--epsilon", "more than once"});
  expect_failure(2, {"measure", ball_file(), "--iso", "0", "--iso", "1"}, {"--iso has 2 numbers", "expected one"});
}

TEST_F(Errors, OutputChecksComeBeforeTheInputIsRead) {
  // The input is damaged and the output is invalid: the error is about the output.
  const std::string damaged = write("damaged.nrrd", nrrd_bytes(ball({8, 8, 8}, 2)).substr(0, 300));
  expect_contour_failure(6, damaged, "0", path("none/out.ply"), {path("none/out.ply")});
}

TEST_F(Errors, ComeAsJsonToThoseWhoAskForJson) {
  const auto error_of = [&](const std::vector<std::string>& arguments) {
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.out, "");
    const nlohmann::json document = nlohmann::json::parse(run.err, nullptr, false);
    EXPECT_FALSE(document.is_discarded()) << run.err;
    EXPECT_EQ(document["error"]["exit"], run.exit);
    EXPECT_FALSE(document["error"]["message"].get<std::string>().empty());
    return document["error"]["code"].get<std::string>();
  };
  EXPECT_EQ(error_of({"info", path("none.nrrd"), "--json"}), "FileNotFound");
  EXPECT_EQ(error_of({"contour", ball_file(), "--iso", "100", "-o", path("out.ply"), "--json"}), "EmptyResult");
  EXPECT_EQ(error_of({"contour", "--json", "--colour"}), "InvalidArgument");
}

TEST_F(Errors, AnOldOutputSurvivesAFailure) {
  write("out.ply", "precious");
  expect_contour_failure(5, ball_file(), "100", path("out.ply"), {});
  EXPECT_EQ(std::filesystem::file_size(path("out.ply")), 8u);
}

TEST_F(Errors, KindsOfNormalsThatThereAreNotAreNamed) {
  const RunResult run = run_tegl({"contour", "image.nc", "--normals", "wrong", "--iso", "0", "-o", path("a.ply")});
  EXPECT_EQ(run.exit, 2);
  EXPECT_THAT(run.err, HasSubstr("--normals is 'wrong'; expected one of gradient, sobel, prewitt, context, forward, "
                                 "backward, geometric, flat"));
  EXPECT_THAT(run_tegl({"contour", ball_file(), "--normals=", "--iso", "0", "-o", path("a.ply")}).err,
              HasSubstr("--normals is ''; expected one of gradient, sobel"));
}

TEST_F(Errors, MessagesAboutOptionsHaveOneForm) {
  const auto refused = [&](const std::vector<std::string>& more, const std::string& text) {
    std::vector<std::string> arguments = {"contour", ball_file(), "-o", path("a.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_failure(2, arguments, {"tegl: " + text, " (see tegl contour --help)"});
  };
  refused({"--iso", "0", "--raw", "3x3"}, "--raw without --raw-type; expected both");
  refused({"--iso", "0", "--threads", "-1"}, "--threads is '-1'; expected a whole number from 0 to 4096");
  refused({"--iso", "0", "--precision", "half"}, "--precision is 'half'; expected one of float, double");
  refused({"--iso", "0", "--precision"}, "--precision has no value; expected one of float, double");
  refused({"--iso", "0", "--close=maybe"}, "--close is 'maybe'; expected no value");
  refused({"--iso", "0", "-o", path("b.ply")}, "--output is given more than once; expected it once");
  expect_failure(2, {"contour", ball_file(), "--iso", "0"}, {"--output is missing; expected --output FILE"});
  expect_failure(2, {"contour", "--iso", "0", "-o", path("a.ply")}, {"FILE is missing; expected the image"});
  expect_failure(2, {"demo", "film"}, {"unexpected argument 'film'; expected none"});
  expect_failure(2, {"demo", "film", "2"}, {"unexpected arguments 'film', '2'; expected none"});
  expect_failure(2, {"demo", "--", "film", "2"}, {"unexpected arguments 'film', '2'; expected none"});
  expect_failure(2, {"demo", "film", "--", "2"}, {"unexpected arguments 'film', '2'; expected none"});
  expect_failure(2, {}, {"no command; expected info, contour, slice"});
  expect_failure(2, {"simplify", ball_file(), "--iso", "0", "--ratio", "10%", "-o", path("a.ply")},
                 {"--ratio is '10%'; expected a number from 0 to 1"});
  expect_failure(2, {"simplify", ball_file(), "--iso", "0", "--ratio", "7.3", "-o", path("a.ply")},
                 {"--ratio is '7.3'; expected a number from 0 to 1"});
}

TEST_F(Errors, FilesOfTheOtherKindAreNamed) {
  ASSERT_EQ(run_tegl({"contour", ball_file(), "--iso", "0", "-o", path("saved.ply"), "-q"}).exit, 0);
  expect_failure(4, {"contour", path("saved.ply"), "--iso", "0", "-o", path("a.ply")},
                 {"saved.ply: holds a mesh, such as a saved contour; expected an image: 'tegl check' and 'tegl slice' "
                  "take meshes"});
  ASSERT_EQ(run_tegl({"contour", ball_file(), "--iso", "0", "-o", path("saved.vtkhdf"), "-q"}).exit, 0);
  const std::string mesh =
      "saved.vtkhdf: holds a mesh (VTKHDF), such as a saved contour; expected an image: 'tegl "
      "check' and 'tegl slice' take meshes";
  expect_failure(4, {"contour", path("saved.vtkhdf"), "--iso", "0", "-o", path("a.ply")}, {mesh});
  expect_failure(4, {"contour", ball_file(), "--iso", "0", "--attribute", path("saved.vtkhdf"), "-o", path("a.ply")},
                 {mesh});
  expect_failure(4, {"check", ball_file()}, {"ball.nrrd: no saved contour, by its name; expected .ply"});
  const std::string table = write("two.csv", "x,y,v,w\n0,0,0,1\n1,0,1,1\n0,1,2,1\n");
  expect_failure(2, {"contour", table, "--iso", "0.5", "-o", path("a.ply")},
                 {"2 columns, and none chosen; expected one of v, w (choose it with --var)"});
}

TEST_F(Errors, RulesOfAmbiguousCellsAreRefusedWhereThereAreNone) {
  if (!has_delaunay()) GTEST_SKIP() << "built without Qhull";
  const std::string table = write("points.csv", "x,y,v\n0,0,0\n1,0,1\n0,1,2\n");
  for (const char* const command : {"contour", "measure"}) {
    std::vector<std::string> arguments = {command, table, "--iso", "1.5", "--ambiguity", "saddle"};
    if (command == std::string("contour")) arguments.insert(arguments.end(), {"-o", path("a.ply")});
    expect_failure(2, arguments, {"--ambiguity with a mesh of triangles, none of which can be ambiguous; expected "});
  }
  EXPECT_EQ(run_tegl({"measure", table, "--iso", "1.5", "--ambiguity", "low"}).exit, 0);
}

TEST_F(Errors, NamesOfFilesThatLookLikeOptionsAreRefused) {
  const RunResult run = run_tegl({"track", ball_file(), "--iso", "0", "--csv", "-q"});
  EXPECT_EQ(run.exit, 6);
  EXPECT_THAT(run.err, HasSubstr("-q-events.csv: looks like an option"));
}

TEST_F(Errors, HelpAndVersionAreNone) {
  const RunResult help = run_tegl({"--help"});
  EXPECT_EQ(help.exit, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("contour"), HasSubstr("slice"), HasSubstr("Exit codes"), HasSubstr("130")));
  EXPECT_THAT(help.err, IsEmpty());
  for (const char* command : {"info", "contour", "slice", "check"}) {
    const RunResult run = run_tegl({command, "--help"});
    EXPECT_EQ(run.exit, 0);
    EXPECT_THAT(run.out, AllOf(HasSubstr("Examples:"), HasSubstr(std::string("tegl ") + command)));
  }
  const RunResult version = run_tegl({"--version"});
  EXPECT_EQ(version.exit, 0);
  EXPECT_THAT(version.out, StartsWith("tegl 0."));
}

}  // namespace
}  // namespace tegl::test
