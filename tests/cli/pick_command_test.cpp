// SPDX-License-Identifier: BSD-3-Clause
//
// The option --pick of tegl contour: the component nearest to a point.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "sample_files.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

/// Two balls beside each other.
class Pick : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const auto balls = [](const std::vector<double>& x) {
      return std::max(4.25 - std::hypot(x[0] - 9.0, x[1] - 9.5, x[2] - 9.5),
                      6.25 - std::hypot(x[0] - 29.0, x[1] - 9.5, x[2] - 9.5));
    };
    file_ = write("balls.nrrd", nrrd_bytes(sample({40, 20, 20}, balls)));
  }
  [[nodiscard]] const std::string& file() const { return file_; }
  RunResult pick(const std::string& point, const std::vector<std::string>& more = {"--json"}) {
    std::vector<std::string> arguments{"contour", file(), "--iso", "0", "--pick", point, "-o", path("one.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tegl(arguments);
  }

 private:
  std::string file_;
};

TEST_F(Pick, IsTheNearerOfTwo) {
  const RunResult whole = run_tegl({"contour", file(), "--iso", "0", "-o", path("whole.ply"), "--json"});
  ASSERT_EQ(whole.exit, 0) << whole.err;
  EXPECT_EQ(whole.json()["components"], 2);
  EXPECT_TRUE(whole.json()["pick"].is_null());
  const RunResult left = pick("9,9.5,9.5");
  ASSERT_EQ(left.exit, 0) << left.err;
  EXPECT_EQ(left.json()["components"], 1);
  EXPECT_EQ(left.json()["euler"], 2);
  EXPECT_EQ(left.json()["pick"]["point"], nlohmann::json({9.0, 9.5, 9.5}));
  EXPECT_EQ(left.json()["pick"]["components"], 1);
  EXPECT_GT(left.json()["pick"]["distance"], 2.0);
  const RunResult right = pick("39,0,0");
  ASSERT_EQ(right.exit, 0) << right.err;
  EXPECT_EQ(left.json()["simplices"].get<int>() + right.json()["simplices"].get<int>(), whole.json()["simplices"]);
  EXPECT_GT(right.json()["simplices"], left.json()["simplices"]);
}

TEST_F(Pick, SaysWhatWasPicked) {
  const RunResult run = pick("9,9.5,9.5", {"--close", "--precision", "float"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("picked       (9, 9.5, 9.5): tile ("));
  EXPECT_THAT(run.out, HasSubstr("1 of 1 component in "));
}

TEST_F(Pick, RefusesWrongUsage) {
  const RunResult few = pick("9,9.5");
  EXPECT_EQ(few.exit, 2);
  EXPECT_THAT(few.err, HasSubstr("--pick 9,9.5 has 2 numbers; expected 3"));
  EXPECT_EQ(pick("9,9.5,").exit, 2);
  EXPECT_EQ(pick("").exit, 2);
  EXPECT_EQ(pick("9,nan,9").exit, 2);
  const RunResult outside = pick("9,9,20");
  EXPECT_EQ(outside.exit, 2);
  EXPECT_THAT(outside.err, HasSubstr("(9, 9, 20) is not in the image; expected one from (0, 0, 0) to (39, 19, 19)"));
  const RunResult indexed = pick("9,9,9", {"--index", file()});
  EXPECT_EQ(indexed.exit, 2);
  EXPECT_THAT(indexed.err, HasSubstr("--pick with --index"));
}

}  // namespace
}  // namespace tegl::test
