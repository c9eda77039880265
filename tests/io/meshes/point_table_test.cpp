// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of scattered points: what the reader makes of small files, and the errors of wrong ones.
#include <array>
#include <cmath>
#include <random>

#include "io_support.hpp"
#include "tegl/check.hpp"
#include "tegl/delaunay.hpp"

namespace tegl::test {
namespace {

CellMesh read_points(const fs::path& path, const CellMeshOptions& options = {}) {
  return read_cell_mesh(std::array{path}, options);
}

/// Rows of a ball of radius 0.7 in the square or cube from -1 to 1.
std::string ball_rows(int dim, char separator, std::size_t count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::string rows;
  for (std::size_t i = 0; i < count; ++i) {
    double square = 0;
    for (int a = 0; a < dim; ++a) {
      const double x = coordinate(random);
      square += x * x;
      rows += std::to_string(x) + separator;
    }
    rows += std::to_string(0.7 - std::sqrt(square)) + "\n";
  }
  return rows;
}

TEST(PointTable, HasTheDelaunayCellsOfItsPoints) {
  if (!has_delaunay()) GTEST_SKIP() << "built without Qhull";
  TempDir dir;
  for (int dim = 2; dim <= 4; ++dim) {
    write_file(dir / "a.csv", ball_rows(dim, ',', dim == 4 ? 150 : 400));
    const CellMesh mesh = read_points(dir / "a.csv");
    EXPECT_EQ(mesh.dim, dim);
    const AnyComplex complex = to_complex(mesh);
    std::visit(
        [&](const auto& any) {
          const auto contour = extract<double>(any, 0.1);
          EXPECT_GT(contour.simplices.size(), 10U);
          const MeshReport report = check(contour);
          EXPECT_EQ(report.bad_links + report.nonmanifold_simplices + report.orientation_conflicts, 0U);
        },
        complex);
  }
}

TEST(PointTable, ColumnsHaveNamesInAnyOrder) {
  if (!has_delaunay()) GTEST_SKIP() << "built without Qhull";
  TempDir dir;
  write_file(
      dir / "a.csv",
      "\xef\xbb\xbf# stations\r\n\"p, hPa\";Y;X;name it\r\n\r\n1;0;0;5\r\n2;0;1;nan\r\n3;1;0;\r\n4;1.5;+1;8\r\n");
  CellMeshOptions options;
  expect_error(ErrorCode::VariableNotFound, {"p, hPa", "name it"}, [&] { read_points(dir / "a.csv"); });
  options.variable = "p, hPa";
  const CellMesh mesh = read_points(dir / "a.csv", options);
  EXPECT_THAT(mesh.axis_names, testing::ElementsAre("X", "Y"));
  EXPECT_THAT(mesh.points, testing::ElementsAre(0, 0, 1, 0, 0, 1, 1, 1.5));
  EXPECT_THAT(mesh.values, testing::ElementsAre(1, 2, 3, 4));
  options.variable = "name it";
  const CellMesh other = read_points(dir / "a.csv", options);
  EXPECT_EQ(other.values[3], 8);
  EXPECT_TRUE(std::isnan(other.values[1]) && std::isnan(other.values[2]));
  // without x and y, all columns but one are coordinates
  write_file(dir / "b.csv", "lon\tlat\tt\n0\t0\t1\n1\t0\t2\n0\t1\t3\n1\t1\t4\n");
  EXPECT_THAT(read_points(dir / "b.csv").axis_names, testing::ElementsAre("lon", "lat"));
  write_file(dir / "c.csv", "0 0  1\n1 0 2\n 0 1 3\n1 1 4\n");
  EXPECT_THAT(read_points(dir / "c.csv").values, testing::ElementsAre(1, 2, 3, 4));
  options.variable = "value";
  EXPECT_THAT(read_points(dir / "c.csv", options).values, testing::ElementsAre(1, 2, 3, 4));
}

TEST(PointTable, ColumnsOfTextAreLeftOut) {
  if (!has_delaunay()) GTEST_SKIP() << "built without Qhull";
  TempDir dir;
  write_file(dir / "a.csv", "station,x,y,v\nA1,0,0,1\nB2,1,0,2\n3,0,1,3\nC,1,1,4\n");
  const CellMesh mesh = read_points(dir / "a.csv");
  EXPECT_EQ(mesh.variable, "v");
  EXPECT_THAT(mesh.values, testing::ElementsAre(1, 2, 3, 4));
  CellMeshOptions options;
  options.variable = "station";
  expect_error(ErrorCode::MalformedFile, {"line 2, column 1", "'A1'"}, [&] { read_points(dir / "a.csv", options); });
  write_file(dir / "b.csv", "x,y,a,b\n0,0,one,two\n");
  expect_error(ErrorCode::MalformedFile, {"line 2", "a, b"}, [&] { read_points(dir / "b.csv"); });
}

TEST(PointTable, ColumnsOfOneNameAreErrorsIfTheyAreRead) {
  if (!has_delaunay()) GTEST_SKIP() << "built without Qhull";
  TempDir dir;
  CellMeshOptions options;
  const auto refused = [&](const std::string& names, const std::vector<std::string>& parts) {
    write_file(dir / "a.csv", names + "\n0,0,1,5\n1,0,2,5\n0,1,3,5\n");
    expect_error(ErrorCode::MalformedFile, parts, [&] { (void)read_points(dir / "a.csv", options); });
  };
  refused("x,X,y,v", {"a.csv", "columns 1 ('x') and 2 ('X')"});
  refused("lon,lat,lat,v", {"columns 2 ('lat') and 3 ('lat')"});
  options.variable = "v";
  refused("x,y,v,v", {"columns 3 ('v') and 4 ('v')", "different names"});
  // the chosen column is no coordinate, and lower case comes first
  options.variable = "X";
  write_file(dir / "b.csv", "X,x,y,v\n1,0,0,5\n2,1,0,5\n3,0,1,5\n");
  EXPECT_THAT(read_points(dir / "b.csv", options).values, testing::ElementsAre(1, 2, 3));
  options.variable = "v";
  // columns that are not read may have any names
  write_file(dir / "b.csv", "x,y,v,note,note\n0,0,1,a,a\n1,0,2,b,b\n0,1,3,c,c\n");
  EXPECT_THAT(read_points(dir / "b.csv", options).values, testing::ElementsAre(1, 2, 3));
}

TEST(PointTable, WrongRowsAreErrorsWithTheirLine) {
  TempDir dir;
  struct WrongTable {
    std::string bytes;
    ErrorCode code;
    std::vector<std::string> parts;
  };
  const std::vector<WrongTable> all = {
      {"x,y,f\n0,0,1\n1,0\n", ErrorCode::MalformedFile, {"line 3 has 2 fields; expected 3"}},
      {"x,y,f\n0,0,1\n1,zero,2\n", ErrorCode::MalformedFile, {"line 3, column 2", "'zero'"}},
      {"x,y,f\n0,0,1\n1,,2\n", ErrorCode::MalformedFile, {"line 3, column 2"}},
      {"x,y,f\n0,inf,1\n", ErrorCode::MalformedFile, {"line 2, column 2", "finite"}},
      {"x,y,f\n0,0,1\n1,0,two\n", ErrorCode::MalformedFile, {"line 3, column 3", "'two'"}},
      {"x,y,f\n0,0,1\n1,0,2\n# again\n0,0,3\n", ErrorCode::MalformedFile, {"line 5 has the same point as line 2"}},
      {"x,y,f\n", ErrorCode::MalformedFile, {"without a row"}},
      {"x,f\n0,1\n", ErrorCode::UnsupportedData, {"2 columns, 1 of them"}},
      {"1,2,3,4,5,6\n", ErrorCode::UnsupportedData, {"6 columns, 5 of them"}},
      {std::string(3 << 20, '1'), ErrorCode::MalformedFile, {"a line of more than"}},
  };
  for (const WrongTable& wrong : all) {
    write_file(dir / "wrong.csv", wrong.bytes);
    std::vector<std::string> parts = wrong.parts;
    parts.emplace_back("wrong.csv");
    expect_error(wrong.code, parts, [&] { read_points(dir / "wrong.csv"); });
  }
  if (!has_delaunay()) return;
  write_file(dir / "wrong.csv", "0,0,1\n1,0,2\n2,0,3\n");  // all on a line
  expect_error(ErrorCode::MalformedFile, {"wrong.csv", "in a line"}, [&] { read_points(dir / "wrong.csv"); });
}

}  // namespace
}  // namespace tegl::test
