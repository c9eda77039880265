// SPDX-License-Identifier: BSD-3-Clause
//
// Out of memory during file access: for every failing allocation, no partial file is left and all memory is released.
// (Not for glTF: the JSON library allocates in destructors, where a failure cannot be handled.)
#include "failing_memory.hpp"

#include <algorithm>

#include "io_support.hpp"

namespace tegl::test {
namespace {

class OutOfMemory : public testing::Test {
 protected:
  void SetUp() override {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "the thread sanitizer has its own memory";
#endif
  }
  /// `work` writes `name`, which does not exist before and is removed afterwards.
  void expect_whole_or_none(const std::string& name, const std::function<void(const fs::path&)>& work) {
    const fs::path path = folder_ / name;
    const auto run = [&] {
      work(path);
      return static_cast<std::uint64_t>(fs::remove(path) ? 1 : 0);
    };
    const auto expect_nothing_left = [&] { EXPECT_EQ(folder_.files(), 0U) << name << ": something is left behind"; };
    EXPECT_GT(expect_survives(name, run, true, expect_nothing_left), 5);
  }
  [[nodiscard]] const TempDir& folder() const { return folder_; }

 private:
  TempDir folder_;
};

TEST_F(OutOfMemory, LeavesNoHalfWrittenMesh) {
  for (const char* name : {"a.ply", "a.vtkhdf"}) {
    const Mesh mesh = random_mesh(2, 3, 70, 100, 1, true);
    expect_whole_or_none(name, [&](const fs::path& path) { write_mesh(mesh, path); });
  }
}

TEST_F(OutOfMemory, LeavesNoHalfWrittenStream) {
  const Grid<3> grid = Grid<3>::unit({20, 15, 9});
  ExtractOptions options;
  options.work.threads = 1;
  options.normals = Normals::differences;
  expect_whole_or_none("a.vtkhdf", [&](const fs::path& path) {
    FunctionLayers<float, 3> layers(grid, [](std::size_t k, float* to) {
      for (std::size_t i = 0; i < 300; ++i) to[i] = static_cast<float>((i * 7 + k * 11) % 13);
    });
    ContourFile<3, float> file(path, grid);
    extract_streamed<float>(layers, 5.5, file, options);
    file.commit();
  });
}

TEST_F(OutOfMemory, OfReadersIsSurvived) {
  const Mesh mesh = random_mesh(2, 3, 70, 100, 1, true);
  for (const char* name : {"a.ply", "a.vtkhdf"}) {
    write_mesh(mesh, folder() / name);
    expect_survives(
        name, [&] { return static_cast<std::uint64_t>(read_mesh(folder() / name).normals.size()); }, true);
  }
  write_file(folder() / "a.nrrd", "NRRD0001\ntype: uchar\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n\n" +
                                      bytes_of(counting<std::uint8_t>(24)));
  expect_survives(
      "a.nrrd", [&] { return static_cast<std::uint64_t>(read_image(folder() / "a.nrrd").image.index()); }, true);
}

}  // namespace
}  // namespace tegl::test
