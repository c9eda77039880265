// SPDX-License-Identifier: BSD-3-Clause
//
// Files that crash the library that reads them: an error with exit code 4 and the file name. Reading in a child process
// gives the same results as reading directly.
#include <gmock/gmock.h>
#include <netcdf.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include "sample_files.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SeparateProcess : public ProgramTest {
 protected:
  [[nodiscard]] std::string content(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

  /// A netCDF-4 file with one variable that takes some time to decompress.
  [[nodiscard]] std::string write_netcdf4(const std::string& name, std::size_t layers) const {
    const std::array<std::size_t, 3> sizes = {layers, 150, 200};
    const std::array<std::size_t, 3> chunks = {1, 150, 200};
    std::array<int, 3> dimensions{};
    int file = 0;
    int variable = 0;
    EXPECT_EQ(nc_create(path(name).c_str(), NC_NETCDF4 | NC_CLOBBER, &file), NC_NOERR);
    for (std::size_t d = 0; d < 3; ++d) nc_def_dim(file, std::array{"time", "y", "x"}[d], sizes[d], &dimensions[d]);
    nc_def_var(file, "v", NC_FLOAT, 3, dimensions.data(), &variable);
    nc_def_var_chunking(file, variable, NC_CHUNKED, chunks.data());
    nc_def_var_deflate(file, variable, 1, 1, 1);
    EXPECT_EQ(nc_enddef(file), NC_NOERR);
    const std::vector<float> values = noise({200, 150, layers}, 1).values;
    EXPECT_EQ(nc_put_var_float(file, variable, values.data()), NC_NOERR);
    EXPECT_EQ(nc_close(file), NC_NOERR);
    return path(name);
  }
};

/// The parent of a process, or 0.
int parent_of(const fs::path& process) {
  std::ifstream in(process / "stat");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::size_t end = text.rfind(')');
  int parent = 0;
  if (end != std::string::npos) std::sscanf(text.c_str() + end + 1, " %*c %d", &parent);
  return parent;
}

/// Kills the first child of a child of this process.
bool kill_grandchild() {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const int parent = parent_of(entry.path());
    if (parent > 0 && parent_of(fs::path("/proc") / std::to_string(parent)) == getpid())
      return kill(std::stoi(name), SIGKILL) == 0;
  }
  return false;
}

TEST_F(SeparateProcess, GivesTheSameBytes) {
  const std::string file = write_netcdf4("a.nc", 8);
  for (const std::vector<std::string>& stream : {std::vector<std::string>{}, {"--stream"}}) {
    for (const char* const how : {"apart", "here"}) {
      std::vector<std::string> arguments = {
          "contour", file, "--iso", "250", "--no-check", "-o", path(std::string(how) + ".vtkhdf")};
      arguments.insert(arguments.end(), stream.begin(), stream.end());
      if (how == std::string("here")) arguments.emplace_back("--in-process");
      const RunResult run = run_tegl(arguments);
      ASSERT_EQ(run.exit, 0) << run.err;
    }
    EXPECT_EQ(content("apart.vtkhdf"), content("here.vtkhdf"));
  }
  EXPECT_EQ(run_tegl({"check", path("apart.vtkhdf")}).exit, 0);
  EXPECT_EQ(run_tegl({"check", path("apart.vtkhdf"), "--in-process"}).exit, 0);
  const auto without_times = [](const std::string& text) { return text.substr(0, text.find("  seconds")); };
  EXPECT_EQ(without_times(run_tegl({"info", file}).out), without_times(run_tegl({"info", file, "--in-process"}).out));
}

TEST_F(SeparateProcess, ItsEndIsADamagedFile) {
  const std::string file = write_netcdf4("slow.nc", 600);
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"-o", path("out.ply")}, {"--stream", "-o", path("out.vtkhdf")}}) {
    std::atomic<bool> done = false;
    bool killed = false;
    std::thread killer([&] {
      while (!done && !killed) {
        killed = kill_grandchild();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    std::vector<std::string> arguments = {"contour", file, "--iso", "250"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const RunResult run = run_tegl(arguments);
    done = true;
    killer.join();
    EXPECT_TRUE(killed);
    EXPECT_EQ(run.exit, 4);
    EXPECT_THAT(run.err, HasSubstr(file + ": is damaged: reading it ended by signal 9 (Killed)"));
    EXPECT_THAT(files(), testing::ElementsAre("slow.nc"));
  }
}

TEST_F(SeparateProcess, HostileFilesAreDamaged) {
  const fs::path root = fs::path(TEGL_SHARED_DATA_DIR) / "hostile";
  if (!fs::exists(root)) GTEST_SKIP() << "no " << root;
  const auto expect = [&](const char* command, const char* name) {
    const std::string file = (root / name).string();
    const RunResult run = run_tegl({command, file});
    EXPECT_EQ(run.exit, 4) << name << run.err;
    EXPECT_THAT(run.err, HasSubstr(file));
  };
  for (const char* const name : {"n4_byte_0x1545.nc", "seq_10000.dcm", "chunk.nc"}) expect("info", name);
  for (const char* const name :
       {"vtkhdf_sig11_2_149.vtkhdf", "vtkhdf_sig11_2_330.vtkhdf", "vtkhdf_sig14_rss_1_899.vtkhdf"})
    expect("check", name);
}

}  // namespace
}  // namespace tegl::test
