// SPDX-License-Identifier: BSD-3-Clause
//
// The command tegl project: outlines of 4D contours with times and colours.
#include <gmock/gmock.h>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Project : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    file_ = write("balls.nii", nifti_bytes(merging_balls(18, 5), {1, 1, 1, 2}));  // t = 0, 2, 4, 6, 8 s
  }
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
};

const Attribute* attribute(const Mesh& mesh, const std::string& name) {
  for (const Attribute& attribute : mesh.vertex_attributes)
    if (attribute.name == name) return &attribute;
  return nullptr;
}

TEST_F(Project, MakesAClosedOutlineWithTimesAndColors) {
  const RunResult run = run_tegl({"project", file(), "--iso", "0", "--close", "-o", path("swept.ply"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["dim"], 2);
  EXPECT_EQ(run.json()["boundary_simplices"], 0);
  EXPECT_EQ(run.json()["bad_links"], 0);
  const Mesh mesh = read_mesh(path("swept.ply"));
  const Attribute* const times = attribute(mesh, "t");
  const Attribute* const colors = attribute(mesh, "color");
  ASSERT_TRUE(times != nullptr && colors != nullptr);
  EXPECT_EQ(times->unit, "s");
  const auto [first, last] = std::minmax_element(times->values.begin(), times->values.end());
  EXPECT_GE(*first, 0.0);
  EXPECT_LE(*last, 8.0);
  EXPECT_GT(*last - *first, 4.0);
  const auto at = static_cast<std::size_t>(last - times->values.begin());
  EXPECT_NEAR(colors->values[3 * at], 253 / 255.0, 1e-12);  // yellow
}

TEST_F(Project, CutsOfOneFileHaveTheirTimes) {
  ASSERT_EQ(run_tegl({"contour", file(), "--iso", "0", "-o", path("all.vtkhdf"), "-q"}).exit, 0);
  const RunResult run =
      run_tegl({"project", path("all.vtkhdf"), "--as", "cuts", "--count", "4", "-o", path("cuts.vtkhdf"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const Mesh mesh = read_mesh(path("cuts.vtkhdf"));
  std::vector<double> times(attribute(mesh, "t")->values.begin(), attribute(mesh, "t")->values.end());
  EXPECT_EQ(mesh.coordinates.size(), 3 * times.size());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  EXPECT_THAT(times, ElementsAre(1.0, 3.0, 5.0, 7.0));
  EXPECT_EQ(run.json()["boundary_simplices"], 0);
}

TEST_F(Project, AllTetrahedraGoToVtkhdfAlone) {
  const RunResult run = run_tegl({"project", file(), "--iso", "0", "--as", "tetrahedra", "--along", "1,0,0,0", "--eye",
                                  "20", "-o", path("all.vtkhdf"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const Mesh mesh = read_mesh(path("all.vtkhdf"));
  EXPECT_EQ(mesh.dim, 3);
  EXPECT_EQ(mesh.space_dim, 3);
  EXPECT_THAT(mesh.axis_names, ElementsAre("y", "z", "t"));
  EXPECT_NE(attribute(mesh, "x"), nullptr);
  ASSERT_EQ(mesh.simplex_attributes.size(), 1u);
  EXPECT_EQ(mesh.simplex_attributes[0].name, "side");
  EXPECT_EQ(run_tegl({"project", file(), "--iso", "0", "--as", "tetrahedra", "-o", path("a.ply")}).exit, 6);
}

TEST_F(Project, RefusesWhatItCannotDo) {
  const std::string volume = write("ball.nrrd", nrrd_bytes(ball({12, 12, 12}, 4.3)));
  const RunResult flat = run_tegl({"project", volume, "--iso", "0", "-o", path("a.ply")});
  EXPECT_EQ(flat.exit, 4);
  EXPECT_THAT(flat.err, HasSubstr("3D"));
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--along", "1,0"},
                                               {"--along", "0,0,0,0"},
                                               {"--eye", "-1"},
                                               {"--eye", "a"},
                                               {"--as", "cuts", "--eye", "1"},
                                               {"--as", "shadow"},
                                               {"--count", "0"},
                                               {"--count", "3"},
                                               {"--as", "tetrahedra", "--count", "3"}}) {
    std::vector<std::string> arguments = {"project", file(), "--iso", "0", "-o", path("a.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 2) << more.front();
    EXPECT_THAT(run.err, HasSubstr(more[more.size() - 2]));
  }
  EXPECT_THAT(files(), ElementsAre("ball.nrrd", "balls.nii"));
}

}  // namespace
}  // namespace tegl::test
