// SPDX-License-Identifier: BSD-3-Clause
//
// tegl elements, and --attribute and the kinds of --normals of tegl contour.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class ElementsCommand : public ProgramTest {
 protected:
  [[nodiscard]] std::string ball_file(const std::vector<std::size_t>& sizes, double radius) const {
    return write("ball.nrrd", nrrd_bytes(ball(sizes, radius)));
  }
  /// Rows of numbers, without lines that begin with #.
  [[nodiscard]] std::vector<std::vector<double>> table(const std::string& name) const {
    std::ifstream file(path(name));
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(file, line);) {
      if (line.front() == '#') continue;
      std::istringstream words(line);
      rows.emplace_back();
      for (std::string number; words >> number;) rows.back().push_back(std::stod(number));
    }
    return rows;
  }
};

TEST_F(ElementsCommand, OfAClosedHypersurfaceCloseUpAndHaveItsVolume) {
  const RunResult run =
      run_tegl({"elements", ball_file({16, 16, 16, 16}, 5.0), "--iso", "0", "-o", path("e.dat"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const nlohmann::json json = run.json();
  EXPECT_LT(json["closure_error"], 1e-13);
  EXPECT_NEAR(json["measure"].get<double>(), 2 * std::numbers::pi * std::numbers::pi * 125, 100);  // radius 5
  EXPECT_EQ(json["elements"], json["simplices"]);
  const auto rows = table("e.dat");
  ASSERT_EQ(rows.size(), json["elements"].get<std::size_t>());
  std::vector<double> sum(4, 0.0);
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 8u);
    double outwards = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      sum[a] += row[4 + a];
      outwards += (row[a] - 7.5) * row[4 + a];
    }
    ASSERT_GT(outwards, -1e-9);  // towards low
  }
  for (const double x : sum) EXPECT_NEAR(x, 0.0, 1e-9);
}

TEST_F(ElementsCommand, PerCellAreFewerAndAddUpToTheSame) {
  const std::string file = write("noise.nrrd", nrrd_bytes(noise({7, 6, 5, 6}, 3)));
  const std::vector<std::string> options = {"elements", file, "--iso", "128", "--close", "--json", "-o"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = options;
    all.insert(all.end(), more.begin(), more.end());
    const RunResult run = run_tegl(all);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  };
  const auto simplices = with({path("s.dat")});
  const auto cells = with({path("c.dat"), "--per", "cell"});
  EXPECT_LT(cells["elements"], simplices["elements"]);
  EXPECT_NEAR(cells["measure"].get<double>(), simplices["measure"].get<double>(), 1e-6);
  EXPECT_LT(cells["closure_error"], 1e-13);
}

TEST_F(ElementsCommand, OfASavedContourAreThoseOfTheImage) {
  const std::string file = ball_file({9, 9, 9}, 3.0);
  ASSERT_EQ(run_tegl({"contour", file, "--iso", "0", "-o", path("c.vtkhdf")}).exit, 0);
  ASSERT_EQ(run_tegl({"elements", path("c.vtkhdf"), "-o", path("a.txt")}).exit, 0);
  ASSERT_EQ(run_tegl({"elements", file, "--iso", "0", "-o", path("b.txt")}).exit, 0);
  EXPECT_EQ(table("a.txt"), table("b.txt"));
  EXPECT_GT(table("a.txt").size(), 100u);
}

TEST_F(ElementsCommand, HaveOtherImagesValuesAsFurtherColumns) {
  const std::vector<std::vector<double>> coordinates = {{0, 1, 2, 3, 4, 5, 6}, {0, 1, 2, 3, 4, 5, 6}, {0, 2, 4, 6}};
  const Samples field = sample(
      {7, 7, 4}, [](const std::vector<double>& x) { return 2.3 - std::hypot(x[0] - 3, x[1] - 3, 2 * x[2] - 3); });
  const Samples slope = sample({7, 7, 4}, [](const std::vector<double>& x) { return 10 * x[0] - x[1] + 3 * x[2]; });
  write_netcdf(path("f.nc"), {"x", "y", "t"}, coordinates, {{"e", field}, {"T", slope}});
  const Samples fine = sample({13, 13, 7}, [](const std::vector<double>& x) { return x[0]; });
  const std::string other = write("other.nrrd", nrrd_bytes(fine, "spacings: 0.5 0.5 1\n"));
  const RunResult run =
      run_tegl({"elements", path("f.nc"), "--var", "e", "--iso", "0", "--attribute", path("f.nc") + ":T", "--attribute",
                other, "-o", path("e.dat"), "--header", "--order", "as-is", "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["attributes"][0]["name"], "T");
  EXPECT_EQ(run.json()["attributes"][1]["name"], "other");
  EXPECT_EQ(run.json()["attributes"][1]["missing"], 0);
  std::ifstream text(path("e.dat"));
  std::string header;
  std::getline(text, header);
  EXPECT_EQ(header, "# x y t dsigma_x dsigma_y dsigma_t T other");
  const auto rows = table("e.dat");
  ASSERT_GT(rows.size(), 20u);
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 8u);
    ASSERT_NEAR(row[6], 10 * row[0] - row[1] + 1.5 * row[2], 1e-5);  // exact: the field is linear
    ASSERT_NEAR(row[7], 2 * row[0], 1e-5);
  }
}

TEST_F(ElementsCommand, ContravariantOnesDifferInTheSignsOfSpace) {
  const std::string file = ball_file({7, 7, 7}, 2.0);
  ASSERT_EQ(run_tegl({"elements", file, "--iso", "0", "-o", path("a.dat")}).exit, 0);
  ASSERT_EQ(run_tegl({"elements", file, "--iso", "0", "--components", "contravariant", "-o", path("b.dat")}).exit, 0);
  const auto a = table("a.dat"), b = table("b.dat");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t e = 0; e < a.size(); ++e)
    for (std::size_t i = 0; i < 6; ++i) ASSERT_EQ(b[e][i], i > 3 ? -a[e][i] : a[e][i]);
}

TEST_F(ElementsCommand, SayWhatIsWrongBeforeTheLongWork) {
  const std::string file = ball_file({7, 7, 7}, 2.0);
  const auto fails = [&](std::vector<std::string> arguments, int exit, const std::string& message) {
    arguments.insert(arguments.begin(), "elements");
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, exit) << run.err;
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  fails({file, "-o", path("e.dat")}, 2, "--iso is missing");
  fails({file, "--iso", "0", "-o", path("e.csv")}, 6, "'.csv' is not known");
  fails({file, "--iso", "0", "--header", "-o", path("e.h5")}, 2, "--header");
  fails({file, "--iso", "0", "--attribute", path("none.nc"), "-o", path("e.dat")}, 3, "no such file");
  fails({file, "--iso", "0", "--attribute", file, "--attribute", file, "-o", path("e.dat")}, 2, "already");
  const std::string flat = write("flat.nrrd", nrrd_bytes(noise({5, 5}, 1)));
  fails({file, "--iso", "0", "--attribute", flat, "-o", path("e.dat")}, 4, "expected 3");
  ASSERT_EQ(run_tegl({"contour", file, "--iso", "0", "-o", path("c.ply")}).exit, 0);
  fails({path("c.ply"), "--per", "cell", "-o", path("e.dat")}, 2, "has no cells");
  for (const std::string& name : files()) EXPECT_EQ(name.find("e."), std::string::npos) << name;
}

TEST_F(ElementsCommand, TellWhetherTheyCloseUp) {
  EXPECT_THAT(run_tegl({"elements", ball_file({9, 9, 9}, 3.0), "--iso", "0", "-o", path("e.dat")}).out,
              HasSubstr("closed (Gauss)"));
  EXPECT_THAT(run_tegl({"elements", ball_file({9, 9, 9}, 6.0), "--iso", "0", "-o", path("e.dat")}).out,
              HasSubstr("0 up to rounding"));  // the ball leaves through all sides, so the missing parts add up to 0
  const std::string plane = write("p.nrrd", nrrd_bytes(sample({5, 5, 5}, [](const auto& x) { return x[2] - 1.5; })));
  EXPECT_THAT(run_tegl({"elements", plane, "--iso", "0", "-o", path("e.dat")}).out, HasSubstr("is open"));
}

// ---- tegl contour ----

TEST_F(ElementsCommand, ContoursTakeAttributesAlong) {
  const std::string file = ball_file({9, 9, 9}, 3.0);
  const std::string other = write("slope.nrrd", nrrd_bytes(sample({9, 9, 9}, [](const auto& x) { return x[0]; })));
  const RunResult run =
      run_tegl({"contour", file, "--iso", "0", "--attribute", other, "-o", path("c.vtkhdf"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const Mesh mesh = read_mesh(path("c.vtkhdf"));
  ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
  EXPECT_EQ(mesh.vertex_attributes[0].name, "slope");
  for (std::size_t v = 0; v < mesh.vertex_attributes[0].values.size(); ++v)
    ASSERT_NEAR(mesh.vertex_attributes[0].values[v], mesh.coordinates[3 * v], 1e-6);
  const RunResult streamed =
      run_tegl({"contour", file, "--iso", "0", "--stream", "--attribute", other, "-o", path("s.vtkhdf")});
  EXPECT_EQ(streamed.exit, 2);
  EXPECT_THAT(streamed.err, HasSubstr("--attribute"));
}

TEST_F(ElementsCommand, ContoursHaveNormalsOfTheKindAskedFor) {
  const std::string file = ball_file({12, 12, 12}, 4.0);
  std::vector<MeshArray<double>> kinds;
  const std::vector<std::vector<std::string>> spellings = {
      {"--normals"},          {"--normals", "gradient"},  {"--normals=sobel"},
      {"--normals", "sobel"}, {"--normals", "geometric"}, {"--normals", "flat"}};
  for (const auto& spelling : spellings) {
    std::vector<std::string> arguments = {"contour"};
    arguments.insert(arguments.end(), spelling.begin(), spelling.end());  // FILE may follow the bare flag
    arguments.insert(arguments.end(), {file, "--iso", "0", "-o", path("c.vtkhdf")});
    const RunResult run = run_tegl(arguments);
    ASSERT_EQ(run.exit, 0) << run.err;
    const Mesh mesh = read_mesh(path("c.vtkhdf"));
    kinds.push_back(mesh.normals);
    const bool flat = spelling.back() == "flat";
    ASSERT_EQ(mesh.normals.empty(), flat);
    ASSERT_EQ(mesh.simplex_attributes.size(), flat ? 1u : 0u);
    // The normals of a ball point outwards.
    const MeshArray<double> normals = flat ? MeshArray<double>(mesh.simplex_attributes[0].values) : mesh.normals;
    for (std::size_t i = 0; i < normals.size() / 3; ++i) {
      const std::size_t v = flat ? mesh.simplices[3 * i] : i;
      double along = 0;
      for (std::size_t a = 0; a < 3; ++a) along += normals[3 * i + a] * (mesh.coordinates[3 * v + a] - 5.5);
      ASSERT_GT(along / 4.0, 0.9);
    }
  }
  EXPECT_EQ(kinds[0], kinds[1]);
  EXPECT_EQ(kinds[2], kinds[3]);
  EXPECT_NE(kinds[0], kinds[2]);
  EXPECT_NE(kinds[0], kinds[4]);
  const RunResult streamed =
      run_tegl({"contour", file, "--iso", "0", "--stream", "--normals", "geometric", "-o", path("s.vtkhdf")});
  EXPECT_EQ(streamed.exit, 2);
  EXPECT_THAT(streamed.err, HasSubstr("geometric"));
}

}  // namespace
}  // namespace tegl::test
