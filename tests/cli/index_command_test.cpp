// SPDX-License-Identifier: BSD-3-Clause
//
// The command tegl index, and contours by its files.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "sample_files.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Index : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    file_ = write("ball.nrrd", nrrd_bytes(ball({40, 30, 20}, 8)));
  }
  [[nodiscard]] const std::string& file() const { return file_; }
  static std::string bytes_of(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

 private:
  std::string file_;
};

TEST_F(Index, OfEveryMethodGivesTheSameContour) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "--close", "-o", path("plain.vtkhdf"), "-q"}).exit, 0);
  for (const char* method : {"full-scan", "interval-tree", "span-space", "min-max-tree", "seed-set"}) {
    const RunResult built =
        run_tegl({"index", file(), "--method", method, "-o", path("a.tindex"), "--threads", "2", "--json"});
    ASSERT_EQ(built.exit, 0) << built.err;
    EXPECT_EQ(built.json()["method"], method);
    EXPECT_EQ(built.json()["tiles"], 39 * 29 * 19);
    EXPECT_EQ(built.json()["image_dim"], 3);
    EXPECT_EQ(built.json()["output_bytes"], bytes_of(path("a.tindex")).size());
    const RunResult contour = run_tegl({"contour", file(), "--index", path("a.tindex"), "--iso", "0", "--close", "-o",
                                        path("indexed.vtkhdf"), "--json"});
    ASSERT_EQ(contour.exit, 0) << contour.err;
    EXPECT_EQ(contour.json()["euler"], 2);
    EXPECT_EQ(contour.json()["boundary_simplices"], 0);
    EXPECT_EQ(bytes_of(path("indexed.vtkhdf")), bytes_of(path("plain.vtkhdf"))) << method;
  }
}

TEST_F(Index, OfSeedsTakesTheirMethodAndOrder) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("plain.vtkhdf"), "-q"}).exit, 0);
  for (const char* seeds : {"cover", "whole1", "volume-thinning", "sweeping"}) {
    const RunResult built = run_tegl({"index", file(), "--method", "seed-set", "--seeds", seeds, "--scan-order",
                                      "2,0,1", "-o", path("a.tindex"), "-q"});
    ASSERT_EQ(built.exit, 0) << built.err;
    ASSERT_EQ(
        run_tegl({"contour", file(), "--index", path("a.tindex"), "--iso", "0", "-o", path("b.vtkhdf"), "-q"}).exit, 0);
    EXPECT_EQ(bytes_of(path("b.vtkhdf")), bytes_of(path("plain.vtkhdf"))) << seeds;
  }
  const RunResult order = run_tegl({"index", file(), "--method", "seed-set", "--scan-order", "0,0,1"});
  EXPECT_EQ(order.exit, 2);
  EXPECT_THAT(order.err, HasSubstr("[0, 0, 1]"));
  const RunResult other = run_tegl({"index", file(), "--seeds", "whole1"});
  EXPECT_EQ(other.exit, 2);
  EXPECT_THAT(other.err, HasSubstr("--method seed-set"));
}

TEST_F(Index, StandsBesideTheImageUnlessToldOtherwise) {
  const RunResult run = run_tegl({"index", file()});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("span-space"));
  EXPECT_THAT(files(), ElementsAre("ball.nrrd", "ball.nrrd.tindex"));
}

TEST_F(Index, IsDescribedByInfo) {
  ASSERT_EQ(run_tegl({"index", file(), "-q"}).exit, 0);
  const RunResult text = run_tegl({"info", file() + ".tindex"});
  ASSERT_EQ(text.exit, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("40 x 30 x 20 float"));
  const nlohmann::json info = run_tegl({"info", file() + ".tindex", "--json"}).json();
  EXPECT_EQ(info["method"], "span-space");
  EXPECT_EQ(info["image"]["sizes"], nlohmann::json({40, 30, 20}));
  EXPECT_EQ(info["image"]["type"], "float");
  EXPECT_EQ(run_tegl({"info", file() + ".tindex", "--var", "a"}).exit, 2);
}

TEST_F(Index, OfAnotherImageIsRefused) {
  ASSERT_EQ(run_tegl({"index", file(), "-o", path("a.tindex"), "-q"}).exit, 0);
  const std::string other = write("other.nrrd", nrrd_bytes(ball({40, 30, 20}, 7)));
  const RunResult run =
      run_tegl({"contour", other, "--index", path("a.tindex"), "--iso", "0", "-o", path("x.ply"), "--json"});
  EXPECT_EQ(run.exit, 2);
  EXPECT_THAT(run.err, HasSubstr("a.tindex: the index is of an image with other values"));
  EXPECT_EQ(run.out, "");
  const std::string smaller = write("smaller.nrrd", nrrd_bytes(ball({20, 30, 20}, 7)));
  const RunResult sizes =
      run_tegl({"contour", smaller, "--index", path("a.tindex"), "--iso", "0", "-o", path("x.ply")});
  EXPECT_EQ(sizes.exit, 2);
  EXPECT_THAT(sizes.err, HasSubstr("40 x 30 x 20 float; expected the one of 20 x 30 x 20 float"));
  EXPECT_THAT(files(), ElementsAre("a.tindex", "ball.nrrd", "other.nrrd", "smaller.nrrd"));
}

TEST_F(Index, ThatIsDamagedOrNoneIsRefused) {
  ASSERT_EQ(run_tegl({"index", file(), "-o", path("a.tindex"), "-q"}).exit, 0);
  const std::string bytes = bytes_of(path("a.tindex"));
  write("cut.tindex", bytes.substr(0, bytes.size() / 2));
  const auto contour = [&](const std::string& index) {
    return run_tegl({"contour", file(), "--index", index, "--iso", "0", "-o", path("x.ply")});
  };
  EXPECT_EQ(contour(path("cut.tindex")).exit, 4);
  EXPECT_THAT(contour(path("cut.tindex")).err, HasSubstr("cut.tindex: the index is damaged"));
  EXPECT_EQ(contour(file()).exit, 4);
  EXPECT_THAT(contour(file()).err, HasSubstr("not an index of active tiles"));
  EXPECT_EQ(contour(path("none.tindex")).exit, 3);
  for (const bool json : {false, true}) {
    std::vector<std::string> arguments{"info", path("cut.tindex")};
    if (json) arguments.emplace_back("--json");
    const RunResult info = run_tegl(arguments);
    EXPECT_EQ(info.exit, 4) << "its head is whole, but not the rest";
    EXPECT_THAT(info.err, HasSubstr("cut.tindex: the index is damaged"));
    EXPECT_EQ(info.out, "");
  }
}

TEST_F(Index, RefusesWrongUsage) {
  EXPECT_EQ(run_tegl({"index", file(), "--method", "guess"}).exit, 2);
  EXPECT_EQ(run_tegl({"index", path("none.nrrd")}).exit, 3);
  const RunResult named = run_tegl({"index", file(), "-o", path("a.ply")});
  EXPECT_EQ(named.exit, 6);
  EXPECT_THAT(named.err, HasSubstr("expected a file named *.tindex"));
  EXPECT_EQ(run_tegl({"index", file(), "-o", path("no/a.tindex")}).exit, 6);
  const RunResult streamed = run_tegl({"contour", file(), "--index", file(), "--raw", "40x30x20", "--raw-type", "float",
                                       "--iso", "0", "--stream", "-o", path("x.vtkhdf")});
  EXPECT_EQ(streamed.exit, 2);
  EXPECT_THAT(streamed.err, HasSubstr("--index with --stream"));
  EXPECT_THAT(files(), ElementsAre("ball.nrrd"));
}

}  // namespace
}  // namespace tegl::test
