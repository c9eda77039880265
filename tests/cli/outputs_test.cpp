// SPDX-License-Identifier: BSD-3-Clause
//
// Commands with several results: one file each, or an error before any file is lost.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

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
