// SPDX-License-Identifier: BSD-3-Clause
//
// Structured grids of VTK (.vts) as meshes and, with --curved-grid, as images on curved grids, run as in a shell.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

constexpr int kAround = 24, kOut = 6;

/// Rings of 24 x 6 points between the radii 1 and 2, in layers along z, with the radius as the value at points.
/// `of_cells`: arrays of the cells. `moved`: how far along x. `height`: of the first
/// layer.
std::string rings_vts(int layers, const std::string& of_cells = "", double moved = 0.0, double height = 0.0) {
  std::ostringstream points, values, text;
  points.precision(17);
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < kOut; ++j)
      for (int i = 0; i < kAround; ++i) {
        const double angle = 2 * std::numbers::pi * i / kAround, radius = 1 + 0.2 * j;
        points << moved + radius * std::cos(angle) << ' ' << radius * std::sin(angle) << ' ' << height + 0.5 * k
               << '\n';
        values << radius << '\n';
      }
  text << R"(<VTKFile type="StructuredGrid" version="0.1"><StructuredGrid WholeExtent="0 23 0 5 0 )" << layers - 1
       << R"("><Piece Extent="0 23 0 5 0 )" << layers - 1
       << R"("><PointData><DataArray type="Float32" Name="radius" format="ascii">)" << values.str()
       << "</DataArray></PointData><CellData>" << of_cells
       << R"(</CellData><Points><DataArray type="Float64" Name="p" NumberOfComponents="3" format="ascii">)"
       << points.str() << "</DataArray></Points></Piece></StructuredGrid></VTKFile>";
  return text.str();
}

/// An array of the cells of three layers of rings, 0 except for one cell.
std::string array_of_cells(const std::string& name, int other) {
  std::string text = R"(<DataArray type="UInt8" Name=")" + name + R"(" format="ascii">)";
  for (int c = 0; c < (kAround - 1) * (kOut - 1) * 2; ++c) text += (c == 7 ? std::to_string(other) : "0") + ' ';
  return text + "</DataArray>";
}

class StructuredGrids : public ProgramTest {
 protected:
  [[nodiscard]] nlohmann::json run_json(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--iso", "1.55", "--json"});
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  }
  void expect_refused(const std::string& file, std::vector<std::string> options, const std::string& message) const {
    options.insert(options.begin(), {"contour", file, "--iso", "1.55", "-o", path("none.vtkhdf")});
    const RunResult run = run_tegl(options);
    EXPECT_NE(run.exit, 0);
    EXPECT_THAT(run.err, HasSubstr(message));
  }
};

TEST_F(StructuredGrids, AreMeshesOrCurvedGridsWithTheSameContours) {
  for (const int layers : {4, 1}) {
    SCOPED_TRACE(layers);
    const std::string file = write("rings.vts", rings_vts(layers)), output = path("out.vtkhdf");
    const auto mesh = run_json({"contour", file, "-o", output});
    const auto open = run_json({"contour", file, "--curved-grid", "-o", output});
    for (const char* const count : {"vertices", "simplices"}) EXPECT_EQ(open[count], mesh[count]) << count;
    const double size =
        run_json({"measure", file})["size"];  // between the last points of each ring and the first: none
    EXPECT_NEAR(size, 2 * std::numbers::pi * 1.55 * 23 / 24 * (layers > 1 ? 1.5 : 1.0), 0.1);
    EXPECT_NEAR(run_json({"measure", file, "--curved-grid"})["size"].get<double>(), size, 1e-5 * size);
    for (const char* const axis : {"i", "x"}) {
      const auto around = run_json({"components", file, "--curved-grid", "--periodic", axis})["components"];
      ASSERT_EQ(around.size(), 1u);
      EXPECT_EQ(around[0]["euler"], 0);
      EXPECT_NEAR(around[0]["size"].get<double>(), size * 24 / 23, 1e-5 * size);
    }
    EXPECT_EQ(run_json({"components", file})["components"][0]["euler"], 1);
  }
}

TEST_F(StructuredGrids, OfPlanesThatMoveOutOfThemselvesAreErrors) {
  write("at0.vts", rings_vts(1));
  write("at5.vts", rings_vts(1, "", 0.0, 5.0));
  const auto collection = [&](const char* first, const char* second) {
    return write("rings.pvd", std::string(R"(<VTKFile type="Collection"><Collection><DataSet timestep="0" file=")") +
                                  first + R"("/><DataSet timestep="1" file=")" + second +
                                  R"("/></Collection></VTKFile>)");
  };
  expect_refused(collection("at0.vts", "at5.vts"), {"--curved-grid", "--periodic", "x"},
                 "has the constant coordinate z = 5; expected 0, as ");
  (void)run_json({"contour", collection("at5.vts", "at5.vts"), "--curved-grid", "-o", path("out.vtkhdf")});
}

TEST_F(StructuredGrids, ThatMoveAreCurvedGridsOverTime) {
  for (const int layers : {1, 3}) {
    SCOPED_TRACE(layers);
    std::string sets;
    for (const auto& [time, moved] : {std::pair{"0", 0.0}, std::pair{"1", 0.5}, std::pair{"3", 2.5}}) {
      const std::string name = std::string("at") + time + ".vts";
      write(name, rings_vts(layers, "", moved));
      sets += std::string("<DataSet timestep=\"") + time + "\" file=\"" + name + "\"/>";
    }
    const std::string file =
        write("rings.pvd", "<VTKFile type=\"Collection\"><Collection>" + sets + "</Collection></VTKFile>");
    const std::string output = path("out.vtkhdf");
    // open at the seam, as the mesh; closed around it as a curved grid
    const auto mesh = run_json({"contour", file, "-o", output});
    const auto open = run_json({"contour", file, "--curved-grid", "-o", output});
    for (const char* const count : {"vertices", "simplices"}) EXPECT_EQ(open[count], mesh[count]) << count;
    const auto around = run_json({"components", file, "--curved-grid", "--periodic", "i"})["components"];
    ASSERT_EQ(around.size(), 1u);
    EXPECT_EQ(around[0]["euler"], 0);
    EXPECT_EQ(run_json({"track", file, "--curved-grid", "--periodic", "i"})["tracks_found"], 1);
    // at any time, the rings have moved
    for (const auto& [at, moved] : {std::pair{"0.5", 0.25}, std::pair{"2", 1.5}, std::pair{"3", 2.5}}) {
      const std::string axis = layers == 1 ? "z=" : "t=";
      const auto cut = run_json({"slice", file, "--curved-grid", "--periodic", "i", "--at", axis + at, "-o", output});
      EXPECT_EQ(cut["euler"], 0);
      const Mesh ring = read_mesh(output);
      ASSERT_GE(ring.coordinates.size(), 48u);
      const auto columns = static_cast<std::size_t>(ring.space_dim);
      double most = 0.0, least = 2.0;
      for (std::size_t v = 0; v < ring.coordinates.size(); v += columns) {
        const double radius = std::hypot(ring.coordinates[v] - moved, ring.coordinates[v + 1]);
        most = std::max(most, radius);
        least = std::min(least, radius);
      }
      EXPECT_NEAR(most, 1.55, 1e-5) << at;
      EXPECT_GE(least, 1.55 * std::cos(std::numbers::pi / kAround) - 1e-5) << at;  // on chords
    }
    const RunResult info = run_tegl({"info", file, "--curved-grid"});
    EXPECT_EQ(info.exit, 0) << info.err;
    EXPECT_THAT(info.out, HasSubstr("a curved grid: x, y"));
  }
}

TEST_F(StructuredGrids, WhatACurvedGridCannotHaveIsRefused) {
  const std::string file = write("rings.vts", rings_vts(3));
  expect_refused(file, {"--periodic", "i"}, "or --curved-grid, which reads a structured grid as an image");
  expect_refused(write("other.nrrd", "NRRD0004\n"), {"--curved-grid"},
                 "expected it with a .vts file, or a .pvd file of them");
  expect_refused(file, {"--index-grid"},
                 "expected it with an image, or with --curved-grid, which reads a structured grid as an image");
  expect_refused(write("plain.nrrd", "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 2 2\nencoding: ascii\n\n1 2 1 2\n"),
                 {"--index-grid"}, "expected it with a curved grid: a netCDF file, or a .vts file with --curved-grid");
  expect_refused(write("hidden.vts", rings_vts(3, array_of_cells("vtkGhostType", 32))), {"--curved-grid"},
                 "a curved grid with hidden cells or points");
  expect_refused(write("cells.vts", rings_vts(3, array_of_cells("material", 1))),
                 {"--curved-grid", "--var", "material"},
                 "'material' has values of cells on a curved grid; expected values of points");
  std::string bent = rings_vts(1);
  bent.replace(bent.find(" 0\n"), 3, " 1\n");  // z of the first point
  expect_refused(write("bent.vts", bent), {"--curved-grid"}, "on a curved surface; expected one in a plane");
}

TEST_F(StructuredGrids, GhostTypesThatHideNothingAreAllowed) {
  const std::string file = write("rings.vts", rings_vts(3)), output = path("out.vtkhdf");
  const auto expected = run_json({"contour", file, "--curved-grid", "-o", output});
  for (const int other : {0, 2}) {  // of cells, 2 is no mark of hidden ones
    const std::string marked = write("marked.vts", rings_vts(3, array_of_cells("vtkGhostType", other)));
    EXPECT_EQ(run_json({"contour", marked, "--curved-grid", "-o", output})["vertices"], expected["vertices"]);
  }
  std::string points = rings_vts(3);
  const auto with_points = [&](int first) {
    std::string array = R"(<PointData><DataArray type="UInt8" Name="vtkGhostType" format="ascii">)";
    for (int p = 0; p < kAround * kOut * 3; ++p) array += (p == 0 ? std::to_string(first) : "0") + ' ';
    std::string text = points;
    return text.replace(text.find("<PointData>"), 11, array + "</DataArray>");
  };
  EXPECT_EQ(run_json({"contour", write("points.vts", with_points(0)), "--curved-grid", "--var", "radius", "-o",
                      output})["vertices"],
            expected["vertices"]);
  expect_refused(write("points.vts", with_points(2)), {"--curved-grid", "--var", "radius"},
                 "a curved grid with hidden cells or points (1 points by the array 'vtkGhostType')");
  expect_refused(write("points.vts", with_points(1)), {"--curved-grid", "--var", "radius"}, "(1 points by");
}

/// The rings of one layer in two pieces, from i = 0 to `first_end` and from `second_begin` to the last one. The cells
/// and points of the first piece after i = 10 are marked as duplicates, and the cell before i = 10 by `before`.
std::string pieces_vts(int first_end, int second_begin, int before = 0) {
  std::ostringstream text;
  text.precision(17);
  text << R"(<VTKFile type="StructuredGrid" version="0.1"><StructuredGrid WholeExtent="0 23 0 5 0 0">)";
  const auto write_piece = [&](int begin, int end) {
    std::ostringstream points, values, of_points, of_cells;
    points.precision(17);
    for (int j = 0; j < kOut; ++j)
      for (int i = begin; i <= end; ++i) {
        const double angle = 2 * std::numbers::pi * i / kAround, radius = 1 + 0.2 * j;
        points << radius * std::cos(angle) << ' ' << radius * std::sin(angle) << " 0\n";
        values << radius << ' ';
        of_points << (begin == 0 && i > 10 ? 1 : 0) << ' ';
        if (j + 1 < kOut && i < end) of_cells << (begin == 0 && i >= 10 ? 1 : begin == 0 && i == 9 ? before : 0) << ' ';
      }
    const auto ghosts = [](const std::ostringstream& numbers) {
      return R"(<DataArray type="UInt8" Name="vtkGhostType" format="ascii">)" + numbers.str() + "</DataArray>";
    };
    text << "<Piece Extent=\"" << begin << ' ' << end << R"( 0 5 0 0"><PointData>)" << ghosts(of_points)
         << R"(<DataArray type="Float32" Name="radius" format="ascii">)" << values.str() << "</DataArray></PointData>"
         << "<CellData>" << ghosts(of_cells) << "</CellData><Points>"
         << R"(<DataArray type="Float64" Name="p" NumberOfComponents="3" format="ascii">)" << points.str()
         << "</DataArray></Points></Piece>";
  };
  write_piece(0, first_end);
  write_piece(second_begin, kAround - 1);
  text << "</StructuredGrid></VTKFile>";
  return text.str();
}

TEST_F(StructuredGrids, DuplicatesOfPiecesAreNotHidden) {
  const std::string whole = write("rings.vts", rings_vts(1)), output = path("out.vtkhdf");
  const auto expected = run_json({"contour", whole, "-o", output});
  for (const int first_end : {10, 11, 13}) {
    SCOPED_TRACE(first_end);
    const std::string pieces = write("pieces.vts", pieces_vts(first_end, 10));
    for (const bool is_curved : {false, true}) {
      std::vector<std::string> arguments = {"contour", pieces, "--var", "radius", "-o", output};
      if (is_curved) arguments.emplace_back("--curved-grid");
      for (const char* const count : {"vertices", "simplices"})
        EXPECT_EQ(run_json(arguments)[count], expected[count]) << count << ' ' << is_curved;
    }
  }
  expect_refused(write("pieces.vts", pieces_vts(11, 10, 32)), {"--curved-grid", "--var", "radius"}, "(5 cells by");
  // the first piece's duplicates are in no other piece
  expect_refused(write("pieces.vts", pieces_vts(13, 12)), {"--curved-grid", "--var", "radius"}, "(10 cells by");
}

}  // namespace
}  // namespace tegl::test
