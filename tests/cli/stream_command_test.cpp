// SPDX-License-Identifier: BSD-3-Clause
//
// tegl contour --stream: images larger than memory.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "sample_files.hpp"
#include "tegl/check.hpp"
#include "tegl/io.hpp"
#include "tegl/measure.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kOcean = TEGL_SOURCE_DIR "/examples/data/ocean_temperature.nc";

class Stream : public ProgramTest {
 protected:
  /// Expects two saved contours to be equal byte by byte.
  static void expect_same(const std::string& a, const std::string& b) {
    const Mesh x = read_mesh(a);
    const Mesh y = read_mesh(b);
    ASSERT_EQ(x.coordinates.size(), y.coordinates.size());
    EXPECT_EQ(std::memcmp(x.coordinates.data(), y.coordinates.data(), x.coordinates.size() * sizeof(double)), 0);
    ASSERT_EQ(x.normals.size(), y.normals.size());
    EXPECT_TRUE(x.normals.empty() ||
                std::memcmp(x.normals.data(), y.normals.data(), x.normals.size() * sizeof(double)) == 0);
    EXPECT_EQ(x.simplices, y.simplices);
    EXPECT_EQ(x.axis_names, y.axis_names);
    EXPECT_EQ(x.axis_units, y.axis_units);
    EXPECT_EQ(x.dim, y.dim);
    EXPECT_EQ(x.space_dim, y.space_dim);
  }
  /// The contours with these options, streamed and in memory, which have equally many cells.
  [[nodiscard]] std::pair<Mesh, Mesh> contours(const std::vector<std::string>& options) const {
    const auto contour = [&](std::vector<std::string> more, const std::string& output) {
      std::vector<std::string> arguments = {"contour", "--json", "-o", output};
      arguments.insert(arguments.end(), options.begin(), options.end());
      arguments.insert(arguments.end(), more.begin(), more.end());
      const RunResult run = run_tegl(arguments);
      EXPECT_EQ(run.exit, 0) << run.err;
      return run.exit == 0 ? run.json()["tiles"].get<std::size_t>() : 0;
    };
    const std::string streamed = path("streamed.vtkhdf"), whole = path("whole.vtkhdf");
    EXPECT_EQ(contour({"--stream"}, streamed), contour({}, whole));
    return {read_mesh(streamed), read_mesh(whole)};
  }
};

TEST_F(Stream, SmallContoursMakeSmallFiles) {
  // with missing values, so that corners are replaced before the datasets exist
  Samples samples = ball({9, 9, 9}, 3);
  samples.values[4 * 81 + 4 * 9 + 1] = NAN;
  for (const std::string& file :
       {write("ball.nrrd", nrrd_bytes(ball({9, 9, 9}, 3))), write("hole.nrrd", nrrd_bytes(samples))}) {
    const auto [streamed, whole] = contours({file, "--iso", "0", "--normals"});
    ASSERT_GT(whole.simplices.size(), 300U);
    EXPECT_EQ(streamed.coordinates, whole.coordinates);
    EXPECT_EQ(streamed.simplices, whole.simplices);
    EXPECT_EQ(streamed.normals, whole.normals);
    EXPECT_LE(std::filesystem::file_size(path("streamed.vtkhdf")),
              std::filesystem::file_size(path("whole.vtkhdf")) + 4096);
  }
  // no contour at all
  std::vector<std::string> none = {"contour", path("ball.nrrd"),  "--iso", "9", "--allow-empty",
                                   "-o",      path("none.vtkhdf")};
  EXPECT_EQ(run_tegl(none).exit, 0);
  const auto size = std::filesystem::file_size(path("none.vtkhdf"));
  none.emplace_back("--stream");
  EXPECT_EQ(run_tegl(none).exit, 0);
  EXPECT_LE(std::filesystem::file_size(path("none.vtkhdf")), size + 4096);
  EXPECT_TRUE(read_mesh(path("none.vtkhdf")).simplices.empty());
}

TEST_F(Stream, OnLatticesGivesTheContourInMemory) {
  const std::string ball = path("ball.nrrd");
  ASSERT_EQ(run_tegl({"sample", "ball", "--lattice", "fcc", "--size", "40", "-o", ball}).exit, 0);
  for (const char* const lattice : {"fcc", "bcc"}) {
    const auto [one, other] = contours({ball, "--iso", "0", "--lattice", lattice});
    EXPECT_EQ(one.coordinates, other.coordinates) << lattice;
    EXPECT_EQ(one.simplices, other.simplices) << lattice;
    EXPECT_GT(one.simplices.size(), 1000u);
  }
  // with other numbers
  const auto expect_equal = [&](const std::vector<std::string>& options) {
    const auto [one, other] = contours(options);
    EXPECT_EQ(one.coordinates.size(), other.coordinates.size());
    EXPECT_EQ(one.periods, other.periods);
    const auto contour = to_contour<3>(one), expected = to_contour<3>(other);
    const MeshReport report = check(contour);
    EXPECT_EQ(report.simplices, check(expected).simplices);
    EXPECT_EQ(report.boundary_simplices, check(expected).boundary_simplices);
    EXPECT_EQ(report.euler, check(expected).euler);
    EXPECT_EQ(report.bad_links + report.nonmanifold_simplices + report.orientation_conflicts, 0u);
    EXPECT_NEAR(measure(contour).size, measure(expected).size, 1e-9 * measure(expected).size);
    return report;
  };
  EXPECT_EQ(expect_equal({ball, "--iso", "-0.5", "--close"}).boundary_simplices, 0u);
  EXPECT_GT(expect_equal({ball, "--iso", "-0.5"}).boundary_simplices, 0u);
  (void)expect_equal({ball, "--iso", "-0.5", "--periodic", "x,y"});
  const auto waves = [](const std::vector<double>& x) {
    return x[2] > 30 && x[0] > 40 && x[1] > 60 && x[1] < 70 ? std::nan("")
                                                            : std::sin(x[0]) + std::cos(x[1] / 3) + std::sin(x[2] / 2);
  };
  const std::string holes = write("holes.nrrd", nrrd_bytes(sample({150, 120, 36}, waves)));
  (void)expect_equal({holes, "--iso", "0.3", "--lattice", "bcc"});
  (void)expect_equal({holes, "--iso", "0.3", "--lattice", "fcc", "--periodic", "z", "--close"});
  for (const char* const lattice : {"d4", "fcc_in_time"}) {
    const std::string moving = path("moving.nrrd");
    ASSERT_EQ(run_tegl({"sample", "ball", "--lattice", lattice, "--size", "9", "-o", moving}).exit, 0);
    const auto [one, other] = contours({moving, "--iso", "0", "--ambiguity", "mean"});
    EXPECT_EQ(one.coordinates.size(), other.coordinates.size()) << lattice;
    EXPECT_EQ(one.simplices.size(), other.simplices.size()) << lattice;
    EXPECT_GT(one.simplices.size(), 1000u);
  }
  const RunResult odd = run_tegl(
      {"contour", holes, "--iso", "0.3", "--lattice", "fcc", "--periodic", "z=37", "--stream", "-o", path("s.vtkhdf")});
  EXPECT_EQ(odd.exit, 2);
  EXPECT_THAT(odd.err, HasSubstr("the period of axis 2 (z) is 37; expected 36"));
}

TEST_F(Stream, GivesTheFileThatTheWholeImageGives) {
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{},
                                             {"--close"},
                                             {"--triangulation", "barycentric", "--precision", "float"},
                                             {"--threads", "3"},
                                             {"--normals"},
                                             {"--normals", "--close", "--precision", "float"}}) {
    std::vector<std::string> whole = {"contour", kOcean, "--iso", "20", "--no-check", "-o", path("whole.vtkhdf")};
    whole.insert(whole.end(), more.begin(), more.end());
    std::vector<std::string> streamed = {"contour", kOcean, "--iso", "20", "--stream", "-o", path("streamed.vtkhdf"),
                                         "--json"};
    streamed.insert(streamed.end(), more.begin(), more.end());
    ASSERT_EQ(run_tegl(whole).exit, 0);
    const RunResult run = run_tegl(streamed);
    ASSERT_EQ(run.exit, 0) << run.err;
    expect_same(path("whole.vtkhdf"), path("streamed.vtkhdf"));
    EXPECT_EQ(run.json()["simplices"], read_mesh(path("whole.vtkhdf")).simplices.size() / 4);
    EXPECT_TRUE(run.json()["euler"].is_null());
    const bool normals = !more.empty() && more[0] == "--normals";
    EXPECT_EQ(read_mesh(path("streamed.vtkhdf")).normals.empty(), !normals);
  }
}

TEST_F(Stream, TakesOneFileOfAnyFormat) {
  const Samples balls = merging_balls(12, 7);
  const std::vector<std::string> files = {write("balls.nrrd", nrrd_bytes(balls)),
                                          write("balls.nii", nifti_bytes(balls, {1, 2, 3, 0.5F})),
                                          write("balls.mha", metaimage_bytes(balls))};
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    ASSERT_EQ(run_tegl({"contour", file, "--iso", "0.25", "-o", path("whole.vtkhdf")}).exit, 0);
    const RunResult run = run_tegl({"contour", file, "--iso", "0.25", "--stream", "-o", path("streamed.vtkhdf")});
    ASSERT_EQ(run.exit, 0) << run.err;
    expect_same(path("whole.vtkhdf"), path("streamed.vtkhdf"));
  }
}

TEST_F(Stream, HasNormalsOfRawValues) {
  const Samples balls = merging_balls(12, 7);
  const std::string nrrd = write("balls.nrrd", nrrd_bytes(balls));
  const std::vector<float> values(balls.values.begin(), balls.values.end());
  const std::string raw =
      write("balls.raw", {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
  ASSERT_EQ(run_tegl({"contour", nrrd, "--iso", "0.25", "--normals", "-o", path("whole.vtkhdf")}).exit, 0);
  const RunResult run = run_tegl({"contour", raw, "--raw", "12x12x12x7", "--raw-type", "float", "--iso", "0.25",
                                  "--normals", "-o", path("raw.vtkhdf")});
  ASSERT_EQ(run.exit, 0) << run.err;
  const Mesh whole = read_mesh(path("whole.vtkhdf"));
  const Mesh streamed = read_mesh(path("raw.vtkhdf"));
  ASSERT_FALSE(whole.normals.empty());
  EXPECT_EQ(whole.simplices, streamed.simplices);
}

TEST_F(Stream, OfRawValuesNamesTheOptionThatIsMissingOrWrong) {
  const std::string raw = write("a.raw", std::string(64, '\0'));
  const RunResult untyped = run_tegl({"contour", raw, "--raw", "4x4x4", "--iso", "1", "-o", path("a.vtkhdf")});
  EXPECT_EQ(untyped.exit, 2);
  EXPECT_THAT(untyped.err, HasSubstr("--raw-type"));
  const RunResult before = run_tegl({"contour", raw, "--raw", "4x4x4", "--raw-type", "uint8", "--raw-offset", "-1",
                                     "--iso", "1", "-o", path("a.vtkhdf")});
  EXPECT_EQ(before.exit, 2);
  EXPECT_THAT(before.err, AllOf(HasSubstr("--raw-offset"), HasSubstr("-1")));
}

TEST_F(Stream, ReadsRawValues) {
  const Samples balls = merging_balls(12, 7);
  const std::string nrrd = write("balls.nrrd", nrrd_bytes(balls));
  const std::vector<float> values(balls.values.begin(), balls.values.end());
  std::string bytes(5, '?');
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  const std::string raw = write("balls.raw", bytes);
  ASSERT_EQ(run_tegl({"contour", nrrd, "--iso", "0.25", "-o", path("whole.vtkhdf")}).exit, 0);
  const RunResult run = run_tegl({"contour", raw, "--raw", "12x12x12x7", "--raw-type", "float", "--raw-offset", "5",
                                  "--iso", "0.25", "-o", path("raw.vtkhdf")});
  ASSERT_EQ(run.exit, 0) << run.err;
  const Mesh whole = read_mesh(path("whole.vtkhdf"));
  const Mesh streamed = read_mesh(path("raw.vtkhdf"));
  EXPECT_EQ(whole.simplices, streamed.simplices);
}

TEST_F(Stream, NeedsLittleMemoryWhateverTheLengthOfTheLastAxis) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space";
#endif
  // 2 GiB of samples, most of them in the holes of a sparse file, with a ball in every 16th volume.
  constexpr std::uintmax_t kSize = 256;
  constexpr std::uintmax_t kSteps = 128;
  constexpr int kLimitKiB = 480 * 1024;  // limit of address space, program and libraries included
  static_assert(kSize * kSize * kSize * kSteps >= 3 * std::uintmax_t{kLimitKiB} * 1024);
  const std::string raw = path("large.raw");
  {
    std::ofstream file(raw, std::ios::binary);
    for (std::uintmax_t t = 3; t < kSteps; t += 16)
      for (std::uintmax_t z = 100; z < 120; ++z)
        for (std::uintmax_t y = 100; y < 120; ++y) {
          std::string row(20, '\0');
          for (std::size_t x = 0; x < row.size(); ++x) {
            const auto square = [](double a) { return (a - 9.5) * (a - 9.5); };
            const double r = std::sqrt(square(static_cast<double>(x)) + square(static_cast<double>(y - 100)) +
                                       square(static_cast<double>(z - 100)));
            row[x] = static_cast<char>(std::max(0.0, 9.0 - r) * 10);
          }
          file.seekp(static_cast<std::streamoff>(((t * kSize + z) * kSize + y) * kSize + 100));
          file.write(row.data(), static_cast<std::streamsize>(row.size()));
        }
  }
  std::filesystem::resize_file(raw, kSize * kSize * kSize * kSteps);
  const std::string out = path("large.vtkhdf");
  const std::string command = "ulimit -v " + std::to_string(kLimitKiB) + "; exec " TEGL_PROGRAM " contour " + raw +
                              " --raw 256x256x256x128 --raw-type uint8 --iso 20.5 --threads 2 -q -o " + out;
  const int status = std::system(command.c_str());
  ASSERT_EQ(WEXITSTATUS(status), 0);
  const RunResult check = run_tegl({"check", out, "--require", "closed", "--json"});
  EXPECT_EQ(check.exit, 0) << check.out;
  EXPECT_EQ(check.json()["components"], 8);
}

TEST_F(Stream, SaysSoAndLeavesNoFileWhenMemoryRunsOut) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space";
#endif
  const std::string raw = write("layers.raw", "");
  std::filesystem::resize_file(raw, std::uintmax_t{30000} * 30000 * 2);  // a hole
  const auto before = files();
  const std::string command = "ulimit -v 500000; exec " TEGL_PROGRAM " contour " + raw +
                              " --raw 30000x30000x2 --raw-type uint8 --iso 20.5 --threads 1 -q -o " + path("a.vtkhdf") +
                              " 2> " + path("said");
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 70);
  std::ifstream said(path("said"));
  EXPECT_THAT(std::string(std::istreambuf_iterator<char>(said), {}), HasSubstr("layers.raw: out of memory"));
  std::filesystem::remove(path("said"));
  EXPECT_EQ(files(), before);
}

TEST_F(Stream, LeavesNoFileWhenItFails) {
  const Samples balls = merging_balls(12, 7);
  const std::string raw = write("short.raw", std::string(1000, '\0'));
  const auto expect_failure = [&](int exit, std::vector<std::string> arguments, const std::string& text) {
    const auto before = files();
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.err;
    EXPECT_THAT(run.err, HasSubstr(text));
    EXPECT_EQ(files(), before);
  };
  const std::string out = path("out.vtkhdf");
  expect_failure(4, {"contour", raw, "--raw", "10x10x11", "--raw-type", "uint8", "--iso", "1", "-o", out},
                 "1000 bytes");
  expect_failure(2, {"contour", raw, "--raw", "10x10", "--raw-type", "half", "--iso", "1", "-o", out}, "half");
  expect_failure(2, {"contour", raw, "--raw", "10y10", "--raw-type", "uint8", "--iso", "1", "-o", out}, "10y10");
  expect_failure(2, {"contour", raw, "--raw", "10x0", "--raw-type", "uint8", "--iso", "1", "-o", out}, "10x0");
  expect_failure(2, {"contour", raw, "--raw-type", "uint8", "--iso", "1", "-o", out}, "--raw");
  expect_failure(5, {"contour", raw, "--raw", "10x10x10", "--raw-type", "uint8", "--iso", "1", "-o", out},
                 "all values are 0");
  expect_failure(
      6, {"contour", raw, "--raw", "10x10x10", "--raw-type", "uint8", "--iso", "1", "--stream", "-o", path("out.ply")},
      ".vtkhdf");
  const std::string list = "kinds: list domain domain domain\n";
  expect_failure(4, {"contour", write("a.nrrd", nrrd_bytes(balls, list)), "--stream", "--iso", "0", "-o", out},
                 "expected the list along the last axis");
  const std::string full = "ulimit -f 40; exec " TEGL_PROGRAM " contour " + kOcean +
                           " --iso 20 --stream --in-process -q -o " + out + " 2> /dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(full.c_str())), 6);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace tegl::test
