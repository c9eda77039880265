// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes of cells: what the reader makes of small files, and the errors of wrong ones. Files that VTK writes are in
// vtk_writes_test.py, hostile ones in hostile, tables of points in point_table_test.cpp.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "io_support.hpp"

namespace tegl::test {
namespace {

CellMesh read(const fs::path& path, const CellMeshOptions& options = {}) {
  return read_cell_mesh(std::array{path}, options);
}

/// A .vtu file as text: an element of each part.
std::string vtu(const std::string& points, const std::string& corners, const std::string& ends,
                const std::string& types, const std::string& data, const std::string& sizes = "5 2") {
  const auto array = [](const std::string& type, const std::string& name, const std::string& numbers) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\">" + numbers + "</DataArray>";
  };
  return "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid><Piece "
         "NumberOfPoints=\"" +
         sizes.substr(0, sizes.find(' ')) + "\" NumberOfCells=\"" + sizes.substr(sizes.find(' ') + 1) +
         "\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" + points +
         "</DataArray></Points><Cells>" + array("Int64", "connectivity", corners) + array("Int64", "offsets", ends) +
         array("UInt8", "types", types) + "</Cells>" + data + "</Piece></UnstructuredGrid></VTKFile>";
}

std::string on_points(const std::string& values, const std::string& more = "Name=\"f\"") {
  return "<PointData><DataArray type=\"Float64\" format=\"ascii\" " + more + ">" + values + "</DataArray></PointData>";
}

const std::string kPoints = "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1";
const std::string kCorners = "0 1 2 3 1 2 3 4";

TEST(CellMesh, ReadsTetrahedraAndTheirValues) {
  TempDir dir;
  write_file(dir / "a.vtu", vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 nan")));
  const CellMesh mesh = read(dir / "a.vtu");
  EXPECT_EQ(mesh.dim, 3);
  EXPECT_EQ(mesh.types, std::vector(2, CellType::tetrahedron));
  EXPECT_THAT(mesh.corners, testing::ElementsAre(0, 1, 2, 3, 1, 2, 3, 4));
  EXPECT_EQ(mesh.points.size(), 15U);
  EXPECT_TRUE(std::isnan(mesh.values[4]));
  EXPECT_EQ(mesh.variable, "f");
  EXPECT_TRUE(mesh.times.empty());
  EXPECT_THAT(mesh.axis_names, testing::ElementsAre("x", "y", "z"));
}

TEST(CellMesh, VectorsHaveComponentsAndAMagnitude) {
  TempDir dir;
  write_file(dir / "a.vtu", vtu(kPoints, kCorners, "4 8", "10 10",
                                on_points("0 0 3 4 6 8 9 12 1 0", "Name=\"v\" NumberOfComponents=\"2\"")));
  CellMeshOptions options;
  options.variable = "v:1";
  EXPECT_THAT(read(dir / "a.vtu", options).values, testing::ElementsAre(0, 4, 8, 12, 0));
  options.variable = "v:magnitude";
  EXPECT_THAT(read(dir / "a.vtu", options).values, testing::ElementsAre(0, 5, 10, 15, 1));
  options.variable = "v:2";
  expect_error(ErrorCode::VariableNotFound, {"no component '2'", "0 to 1", "a.vtu"},
               [&] { read(dir / "a.vtu", options); });
  expect_error(ErrorCode::VariableNotFound, {"'v' of 2 components", "v"}, [&] { read(dir / "a.vtu"); });
}

TEST(CellMesh, CellsOfFewerDimensionsAreLeftOutWithARemark) {
  TempDir dir;
  write_file(dir / "a.vtu", vtu(kPoints, "0 1 2 0 1 2 3", "3 7", "5 10", on_points("0 1 2 3 4")));
  const CellMesh mesh = read(dir / "a.vtu");
  EXPECT_EQ(mesh.types, std::vector{CellType::tetrahedron});
  ASSERT_EQ(mesh.remarks.size(), 1U);
  EXPECT_THAT(mesh.remarks[0], testing::HasSubstr("cells of fewer than 3 dimensions are left out: 1"));
}

TEST(CellMesh, AnExtensionOfOtherDataIsARemark) {
  TempDir dir;
  const std::string bytes = vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 4"));
  write_file(dir / "a.vts", bytes);
  write_file(dir / "a.vtu", bytes);
  const std::string expected =
      (dir / "a.vts").string() + " holds UnstructuredGrid, whose extension is .vtu; .vts is for StructuredGrid";
  EXPECT_THAT(read(dir / "a.vts").remarks, testing::ElementsAre(expected));
  EXPECT_EQ(read(dir / "a.vts").values, read(dir / "a.vtu").values);
  EXPECT_THAT(describe_cell_mesh(dir / "a.vts").remarks, testing::ElementsAre(expected));
  EXPECT_THAT(read(dir / "a.vtu").remarks, testing::IsEmpty());
  EXPECT_THAT(describe_cell_mesh(dir / "a.vtu").remarks, testing::IsEmpty());
  // images
  write_file(dir / "b.vtr",
             "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 0\"><Piece Extent=\"0 1 0 1 0 0\">" +
                 on_points("0 1 2 3") + "</Piece></ImageData></VTKFile>");
  EXPECT_THAT(read_image(dir / "b.vtr").info.remarks,
              testing::Contains(testing::HasSubstr("b.vtr holds ImageData, whose extension is .vti")));
}

TEST(CellMesh, ValuesOfWhichOneIsTakenAreARemark) {
  TempDir dir;
  // two arrays of one name
  const std::string array = "<DataArray type=\"Float64\" Name=\"f\" format=\"ascii\">";
  const std::string twice =
      "<PointData>" + array + "0 1 2 3 4</DataArray>" + array + "4 3 2 1 0</DataArray></PointData>";
  write_file(dir / "a.vtu", vtu(kPoints, kCorners, "4 8", "10 10", twice));
  const std::string expected = (dir / "a.vtu").string() + " has several arrays 'f' of points; the first is taken";
  EXPECT_THAT(read(dir / "a.vtu").remarks, testing::ElementsAre(expected));
  EXPECT_THAT(read(dir / "a.vtu").values, testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(describe_cell_mesh(dir / "a.vtu").remarks, testing::ElementsAre(expected));
  // two pieces with a face in common
  const auto pieces = [](const std::string& second) {
    const std::string all = vtu("0 0 0 1 0 0 0 1 0 0 0 1", "0 1 2 3", "4", "10", on_points("0 1 2 3"), "4 1");
    const std::string other = vtu("1 1 1 1 0 0 0 1 0 0 0 1", "0 1 2 3", "4", "10", on_points(second), "4 1");
    const std::size_t begin = other.find("<Piece"), end = other.find("</UnstructuredGrid>");
    std::string both = all;
    return both.insert(both.find("</UnstructuredGrid>"), other.substr(begin, end - begin));
  };
  write_file(dir / "b.vtu", pieces("4 1 2 3"));
  EXPECT_THAT(read(dir / "b.vtu").remarks, testing::IsEmpty());
  write_file(dir / "c.vtu", pieces("4 1 7 8"));
  const std::string differing =
      (dir / "c.vtu").string() +
      ": 'f' has different values at 2 points that pieces have in common, such as 2 and 7 at (0, 1, 0); the value of "
      "the first piece is taken";
  EXPECT_THAT(read(dir / "c.vtu").remarks, testing::ElementsAre(differing));
  // a later file of a series
  EXPECT_THAT(read_cell_mesh(std::array{dir / "b.vtu", dir / "c.vtu"}).remarks, testing::ElementsAre(differing));
}

TEST(CellMesh, FilesThatAreNotReadAreErrorsThatSayWhatIs) {
  TempDir dir;
  write_file(dir / "b.vtu.gz", "\x1f\x8b\x08 compressed");
  expect_error(ErrorCode::UnsupportedFormat, {"b.vtu.gz", "compressed by gzip", "gunzip"},
               [&] { read(dir / "b.vtu.gz"); });
  write_file(dir / "mesh.vti", vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 4")));
  expect_error(ErrorCode::UnsupportedData, {"holds a mesh", "or the extension .vtu for this mesh"},
               [&] { read_image(dir / "mesh.vti"); });
  write_file(dir / "flat.vti",
             "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\" Direction=\"1 0 0 1 0 0 0 0 1\">"
             "<Piece Extent=\"0 1 0 1 0 1\">" +
                 on_points("0 1 2 3 4 5 6 7") + "</Piece></ImageData></VTKFile>");
  expect_error(ErrorCode::MalformedFile, {"Direction is '1 0 0 1 0 0 0 0 1', whose determinant is 0"},
               [&] { read_image(dir / "flat.vti"); });
}

struct WrongMesh {
  std::string bytes;
  ErrorCode code;
  std::vector<std::string> parts;
};

TEST(CellMesh, WrongNumbersAreErrorsThatNameThem) {
  const std::string data = on_points("0 1 2 3 4");
  const std::string good = vtu(kPoints, kCorners, "4 8", "10 10", data);
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  const std::vector<WrongMesh> all = {
      {vtu(kPoints, "0 1 2 3 1 2 3 5", "4 8", "10 10", data),
       ErrorCode::MalformedFile,
       {"cell 1", "corner 5", "0 to 4"}},
      {vtu(kPoints, "0 1 2 3 1 2 3 -1", "4 8", "10 10", data), ErrorCode::MalformedFile, {"cell 1", "corner -1"}},
      {vtu(kPoints, kCorners, "4 9", "10 10", data), ErrorCode::MalformedFile, {"cell 1", "4 to 9 of 8"}},
      {vtu(kPoints, kCorners, "8 4", "10 10", data), ErrorCode::MalformedFile, {"ascending offsets"}},
      {vtu(kPoints, kCorners, "3 8", "10 10", data), ErrorCode::MalformedFile, {"cell 0 (tetrahedron) has 3 corners"}},
      {vtu(kPoints, "0 1 2 2 1 2 3 4", "4 8", "10 10", data), ErrorCode::UnsupportedData, {"corner 2 twice"}},
      {vtu(kPoints, kCorners, "4 8", "10 300", data), ErrorCode::MalformedFile, {"number 1", "300", "uint8"}},
      {vtu(kPoints, kCorners, "4 8", "10 99", data), ErrorCode::UnsupportedData, {"type 99", "unknown"}},
      {vtu(kPoints, kCorners, "4 8", "1 1", data), ErrorCode::UnsupportedData, {"none of 2 or 3 dimensions"}},
      {vtu(kPoints + " 7", kCorners, "4 8", "10 10", data), ErrorCode::MalformedFile, {"16 numbers; expected 15"}},
      {vtu("0 0 inf 1 0 0 0 1 0 0 0 1 1 1 1", kCorners, "4 8", "10 10", data), ErrorCode::MalformedFile, {"point 0"}},
      {vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3")),
       ErrorCode::MalformedFile,
       {"4 numbers; expected 5"}},
      {vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 x 3 4")), ErrorCode::MalformedFile, {"number 2", "'x'"}},
      {vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 " + std::string(2000, '4'))),
       ErrorCode::MalformedFile,
       {"number 4", "more than 1000 characters"}},
      {vtu(kPoints, kCorners, "4 8", "10 10", ""), ErrorCode::UnsupportedData, {"has no arrays; expected one"}},
      {replaced("NumberOfPoints=\"5\"", "NumberOfPoints=\"-5\""), ErrorCode::MalformedFile, {"NumberOfPoints", "-5"}},
      {replaced("NumberOfPoints=\"5\"", "NumberOfPoints=\"99999999999\""), ErrorCode::TooLarge, {"99999999999 points"}},
      {replaced("NumberOfCells=\"2\"", "NumberOfCells=\"4000000000\""), ErrorCode::MalformedFile, {"4000000000"}},
      {replaced("type=\"UInt8\"", "type=\"Float32\""), ErrorCode::MalformedFile, {"'types'", "whole numbers"}},
      {replaced("Name=\"f\"", "Name=\"f\" NumberOfComponents=\"0x\""),
       ErrorCode::MalformedFile,
       {"NumberOfComponents"}},
      {replaced("type=\"Float64\" format=\"ascii\" Name=\"f\"", "type=\"Float128\" format=\"ascii\" Name=\"f\""),
       ErrorCode::MalformedFile,
       {"'f'", "Float128"}},
      {replaced("format=\"ascii\" Name=\"f\"", "format=\"appended\" offset=\"0\" Name=\"f\""),
       ErrorCode::MalformedFile,
       {"AppendedData"}},
      {replaced("format=\"ascii\" Name=\"f\"", "format=\"hex\" Name=\"f\""), ErrorCode::MalformedFile, {"hex"}},
      {replaced("</Cells>", "</Cell>"), ErrorCode::MalformedFile, {"line 1", "mismatched tag"}},
      {good.substr(0, 300), ErrorCode::MalformedFile, {"line 1"}},
      {replaced("type=\"UnstructuredGrid\"", "type=\"PUnstructuredGrid\""),
       ErrorCode::UnsupportedFormat,
       {"PUnstructuredGri", "names other files"}},
      {replaced("version=\"0.1\"", "compressor=\"vtkLZ4DataCompressor\""), ErrorCode::UnsupportedFormat, {"LZ4"}},
      {replaced("version=\"0.1\"", "byte_order=\"Middle\""), ErrorCode::MalformedFile, {"byte_order", "Middle"}},
      {replaced("<Piece", "<Peace"), ErrorCode::MalformedFile, {"line 1"}},
      {"<html></html>", ErrorCode::MalformedFile, {"html", "VTKFile"}},
      {"", ErrorCode::MalformedFile, {"empty"}},
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(i);
    TempDir dir;
    write_file(dir / "wrong.vtu", all[i].bytes);
    std::vector<std::string> parts = all[i].parts;
    parts.emplace_back("wrong.vtu");
    expect_error(all[i].code, parts, [&] { read(dir / "wrong.vtu"); });
    EXPECT_EQ(dir.files(), 1U);
  }
}

TEST(CellMesh, GhostTypesAreReadFromAllPiecesAndMustBeWhole) {
  const auto piece = [](const std::string& ghosts, const std::string& type) {
    const std::string one = vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 4"));
    const std::size_t begin = one.find("<Piece"), end = one.find("</UnstructuredGrid>");
    std::string text = one.substr(begin, end - begin);
    if (!ghosts.empty())
      text.insert(text.find("</Piece>"), "<CellData><DataArray type=\"" + type +
                                             "\" Name=\"vtkGhostType\" format=\"ascii\">" + ghosts +
                                             "</DataArray></CellData>");
    return text;
  };
  const auto file = [](const std::string& pieces) {
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>" + pieces + "</UnstructuredGrid></VTKFile>";
  };
  TempDir dir;
  // The pieces have the same points, and the second one hides both of its cells.
  write_file(dir / "a.vtu", file(piece("", "UInt8") + piece("1 32", "UInt8")));
  const CellMesh mesh = read(dir / "a.vtu");
  EXPECT_EQ(mesh.types.size(), 2U);
  ASSERT_EQ(mesh.remarks.size(), 1U);
  EXPECT_THAT(mesh.remarks[0], testing::HasSubstr("hidden by vtkGhostType are left out: 2"));
  write_file(dir / "b.vtu", file(piece("0 nan", "Float32")));
  expect_error(ErrorCode::MalformedFile, {"vtkGhostType", "float", "UInt8"}, [&] { read(dir / "b.vtu"); });
}

TEST(CellMesh, MarkupWithinNumbersIsTakenOut) {
  TempDir dir;
  const auto values = [&](const std::string& text) {
    write_file(dir / "a.vtu", vtu(kPoints, kCorners, "4 8", "10 10", on_points(text)));
    return read(dir / "a.vtu").values;
  };
  const std::vector<double> expected = {0, 1, 25, 3, 4};
  for (const std::string& text : {
           std::string("<!-- five numbers: 9 8 7 --> 0 1 25 3 4"),
           std::string("0 1 2<!---->5 3 4<!-- > -->"),
           std::string("<![CDATA[0 1 25]]> 3 <![CDATA[4]]>"),
           std::string("0 <?note 1 ?> 1 2<![CDATA[5 3]]> 4"),
       })
    EXPECT_EQ(values(text), expected) << text;
  EXPECT_EQ(values("0 1 25 3 <!--" + std::string(9000, '<') + " - - > --> 4"), expected);
  const auto refuse = [&](const std::string& text, const std::string& part) {
    expect_error(ErrorCode::MalformedFile, {"a.vtu", part}, [&] { values(text); });
  };
  refuse("0 1 25 3 <!-- 4 -->", "4 numbers; expected 5");
  refuse("0 1 <![CDATA[25]]]> 3 4", "25]");
  refuse("0 1 25] 3 4", "25]");
}

TEST(CellMesh, Base64OfAnotherLengthThanItsHeaderIsAnError) {
  TempDir dir;
  const auto read_values = [&](const std::string& base64, const std::string& header) {
    std::string text = vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 4"));
    text.insert(text.find("version=\"0.1\""), header);
    const std::size_t at = text.find("format=\"ascii\" Name=\"f\">0 1 2 3 4");
    text.replace(at, std::string("format=\"ascii\" Name=\"f\">0 1 2 3 4").size(),
                 "format=\"binary\" Name=\"f\">\n" + base64 + "\n");
    write_file(dir / "a.vtu", text);
    return read(dir / "a.vtu").values;
  };
  // the numbers 1 to 5 after the number of their bytes, 40
  const std::string numbers = "AAAAAAAA8D8AAAAAAAAAQAAAAAAAAAhAAAAAAAAAEEAAAAAAAAAUQA==";
  const std::string narrow = "KAAAAA==", wide = "KAAAAAAAAAA=";
  const std::vector<double> expected = {1, 2, 3, 4, 5};
  EXPECT_EQ(read_values(narrow + numbers, ""), expected);
  EXPECT_EQ(read_values(wide + numbers, "header_type=\"UInt64\" "), expected);
  expect_error(ErrorCode::MalformedFile,
               {"a.vtu", "'f' has 40 bytes by its header, and 44 in base64", "header_type=\"UInt64\""},
               [&] { read_values("KAAAAAAAAAAAAAAAAADwPwAAAAAAAABAAAAAAAAACEAAAAAAAAAQQAAAAAAAABRA", ""); });
  expect_error(ErrorCode::MalformedFile, {"a.vtu", "'f' has 40 bytes by its header, and 43 in base64"},
               [&] { read_values(wide + numbers + "AAAA", "header_type=\"UInt64\" "); });
}

TEST(CellMesh, PiecesThatRepeatCellsAreErrorsThatNameThem) {
  // a line before the cells; the second piece has its own points, and the cells in the other order
  const std::string one = vtu(kPoints, "0 1 " + kCorners, "2 6 10", "3 10 10", on_points("0 1 2 3 4"), "5 3");
  const std::string other = vtu(kPoints, "1 2 3 4 0 1 2 3", "4 8", "10 10", on_points("0 1 2 3 4"), "5 2");
  const auto piece = [](const std::string& text) {
    const std::size_t begin = text.find("<Piece");
    return text.substr(begin, text.find("</UnstructuredGrid>") - begin);
  };
  TempDir dir;
  write_file(dir / "a.vtu", "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>" + piece(one) + piece(other) +
                                "</UnstructuredGrid></VTKFile>");
  const std::string text = "cell 3 has the same corners as cell 2: the pieces 0 and 1 (of 2) repeat cells";
  expect_error(ErrorCode::UnsupportedData, {"a.vtu", text, "vtkGhostType"}, [&] { read(dir / "a.vtu"); });
  EXPECT_THAT(describe_cell_mesh(dir / "a.vtu").remarks, testing::ElementsAre(testing::HasSubstr(text)));
  // in one piece
  write_file(dir / "b.vtu", vtu(kPoints, "0 1 2 3 3 2 1 0", "4 8", "10 10", on_points("0 1 2 3 4")));
  expect_error(ErrorCode::UnsupportedData, {"b.vtu", "cell 1 has the same corners as cell 0; expected each cell once"},
               [&] { read(dir / "b.vtu"); });
  EXPECT_EQ(describe_cell_mesh(dir / "b.vtu").remarks.size(), 1U);
  write_file(dir / "c.vtu", vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 4")));
  EXPECT_THAT(describe_cell_mesh(dir / "c.vtu").remarks, testing::IsEmpty());
}

/// A pentagonal prism as a polyhedron; points 0 to 4 and 5 to 9 are the pentagons.
const std::string kPrismFaces = "7 5 0 1 2 3 4 5 5 6 7 8 9 4 0 1 6 5 4 1 2 7 6 4 2 3 8 7 4 3 4 9 8 4 4 0 5 9";

std::string prism(const std::string& faces, const std::string& ends, const std::string& types = "42",
                  const std::string& corners = "0 1 2 3 4 5 6 7 8 9", const std::string& cell_ends = "10",
                  const std::string& sizes = "10 1") {
  std::string points;
  for (const char* z : {" 0 ", " 1 "})
    for (const char* place : {"1 0", "0.3 1", "-0.8 0.6", "-0.8 -0.6", "0.3 -1"}) points += std::string(place) + z;
  std::string text = vtu(points, corners, cell_ends, types, on_points("0 1 2 3 4 5 6 7 8 9"), sizes);
  const std::string arrays = "<DataArray type=\"Int64\" Name=\"faces\" format=\"ascii\">" + faces +
                             "</DataArray><DataArray type=\"Int64\" Name=\"faceoffsets\" format=\"ascii\">" + ends +
                             "</DataArray>";
  return text.insert(text.find("</Cells>"), arrays);
}

TEST(CellMesh, PolyhedraHaveTheirFaces) {
  TempDir dir;
  write_file(dir / "a.vtu", prism(kPrismFaces, "38"));
  const CellMesh mesh = read(dir / "a.vtu");
  EXPECT_EQ(mesh.types, std::vector{CellType::polyhedron});
  EXPECT_THAT(mesh.ends, testing::ElementsAre(10));
  EXPECT_THAT(mesh.face_ends, testing::ElementsAre(5, 10, 14, 18, 22, 26, 30));
  EXPECT_THAT(mesh.face_lists_ends, testing::ElementsAre(7));
  const auto contour = extract<double>(std::get<Complex<3>>(to_complex(mesh)), 4.5);
  EXPECT_EQ(contour.vertices.size(), 5U);
  // the type of VTK for it
  write_file(dir / "b.vtu", prism("", "", "15"));
  const CellMesh same = read(dir / "b.vtu");
  EXPECT_EQ(same.face_corners, mesh.face_corners);
  EXPECT_EQ(same.types, mesh.types);
  EXPECT_THAT(describe_cell_mesh(dir / "a.vtu").cells, testing::ElementsAre(testing::Pair("polyhedron", 1)));
  // at two times the faces must be the same
  write_file(dir / "c.vtu", prism("7 5 5 6 7 8 9" + kPrismFaces.substr(1, 12) + kPrismFaces.substr(25), "38"));
  expect_error(ErrorCode::UnsupportedData, {"has other cells"}, [&] {
    read_cell_mesh(std::array{dir / "a.vtu", dir / "c.vtu"});
  });
  const CellMesh moving = read_cell_mesh(std::array{dir / "a.vtu", dir / "a.vtu"});
  const auto swept = extract<double>(std::get<Complex<4>>(to_complex(moving)), 4.5);
  EXPECT_EQ(swept.vertices.size(), 11U);   // the pentagon between the ends, at both times, and its middle
  EXPECT_EQ(swept.simplices.size(), 16U);  // cones over two pentagons and five quadrilaterals
}

/// The prism and a pyramid on its side 0 1 6 5, which both have as face 2, as VTK 9.4 and later write them.
std::string listed_faces(const std::string& corners, const std::string& ends, const std::string& faces,
                         const std::string& cell_ends) {
  std::string text = prism("", "", "5 42 42", "0 1 2 0 1 2 3 4 5 6 7 8 9 0 1 5 6 10", "3 13 18", "11 3");
  text.replace(text.find("0.3 -1 1 "), 9, "0.3 -1 1 2 1.5 0.5 ");
  text.replace(text.find("0 1 2 3 4 5 6 7 8 9", text.find("PointData")), 19, "0 1 2 3 4 5 6 7 8 9 10");
  std::string arrays;
  const auto add = [&](const char* name, const std::string& numbers) {
    arrays +=
        std::string("<DataArray type=\"Int64\" Name=\"") + name + "\" format=\"ascii\">" + numbers + "</DataArray>";
  };
  add("face_connectivity", corners);
  add("face_offsets", ends);
  add("polyhedron_to_faces", faces);
  add("polyhedron_offsets", cell_ends);
  const std::size_t from = text.find("<DataArray type=\"Int64\" Name=\"faces\"");
  return text.replace(from, text.find("</Cells>") - from, arrays);
}
const std::string kListedCorners =
    "0 1 2 3 4 5 6 7 8 9 0 1 6 5 1 2 7 6 2 3 8 7 3 4 9 8 4 0 5 9 0 1 10 1 6 10 6 5 10 5 0 10";
const std::string kListedEnds = "5 10 14 18 22 26 30 33 36 39 42", kListedFaces = "0 1 2 3 4 5 6 2 7 8 9 10";

TEST(CellMesh, FacesMayBeListedOnceForBothCells) {
  TempDir dir;
  write_file(dir / "a.vtu", listed_faces(kListedCorners, kListedEnds, kListedFaces, "0 7 12"));
  const CellMesh mesh = read(dir / "a.vtu");
  EXPECT_EQ(mesh.types, (std::vector{CellType::polyhedron, CellType::polyhedron}));
  EXPECT_THAT(mesh.face_ends, testing::ElementsAre(5, 10, 14, 18, 22, 26, 30, 34, 37, 40, 43, 46));
  EXPECT_THAT(mesh.face_lists_ends, testing::ElementsAre(7, 12));
  write_file(dir / "b.vtu", prism(kPrismFaces, "38"));
  const CellMesh alone = read(dir / "b.vtu");
  EXPECT_TRUE(std::equal(alone.face_corners.begin(), alone.face_corners.end(), mesh.face_corners.begin()));
  EXPECT_EQ((std::vector<Index>{0, 1, 6, 5, 0, 1, 10}),
            (std::vector<Index>(mesh.face_corners.begin() + 30, mesh.face_corners.begin() + 37)));
  // one file by VTK, one that make_seeds.py made of it in the layout of newer ones
  const fs::path seeds = TEGL_SOURCE_DIR "/tests/io/seeds";
  const CellMesh older = read(seeds / "vtk_polyhedra.vtu"), newer = read(seeds / "vtk_listed_faces.vtu");
  EXPECT_EQ(older.face_corners, newer.face_corners);
  EXPECT_EQ(older.face_ends, newer.face_ends);
  EXPECT_EQ(older.types, newer.types);
}

TEST(CellMesh, WrongListsOfFacesAreErrorsThatNameTheCellOrFace) {
  TempDir dir;
  const std::string& corners = kListedCorners;
  const std::vector<WrongMesh> all = {
      {listed_faces(corners, kListedEnds, kListedFaces, "0 7"), ErrorCode::MalformedFile, {"expected 3"}},
      {listed_faces(corners, kListedEnds, kListedFaces, "0 7 13"),
       ErrorCode::MalformedFile,
       {"cell 2", "7 to 13 of 12"}},
      {listed_faces(corners, kListedEnds, kListedFaces, "0 7 5"), ErrorCode::MalformedFile, {"cell 2", "ascending"}},
      {listed_faces(corners, kListedEnds, kListedFaces, "1 7 12"),
       ErrorCode::MalformedFile,
       {"cell 0 is a triangle with 1 faces"}},
      {listed_faces(corners, kListedEnds, "0 1 2 3 4 5 11 2 7 8 9 10", "0 7 12"),
       ErrorCode::MalformedFile,
       {"cell 1 has the face 11; expected 0 to 10"}},
      {listed_faces(corners, kListedEnds, "0 1 2 3 4 2 6 2 7 8 9 10", "0 7 12"),
       ErrorCode::MalformedFile,
       {"cell 2 has the face 2, which is listed twice before"}},
      {listed_faces(corners, kListedEnds, "0 1 2 2 2 5 6 3 7 8 9 10", "0 7 12"),
       ErrorCode::MalformedFile,
       {"cell 1 has the face 2, which is listed twice before"}},
      {listed_faces(corners, kListedEnds, "0 1 2 x 4 5 6 2 7 8 9 10", "0 7 12"),
       ErrorCode::MalformedFile,
       {"array 'polyhedron_to_faces'"}},
      {listed_faces(corners, "5 10 14 12 22 26 30 33 36 39 42", kListedFaces, "0 7 12"),
       ErrorCode::MalformedFile,
       {"face 3 has the corners 14 to 12 of 42"}},
      {listed_faces(corners, "5 10 14 18 22 26 30 33 36 39 43", kListedFaces, "0 7 12"),
       ErrorCode::MalformedFile,
       {"face 10", "39 to 43 of 42"}},
      {listed_faces(corners.substr(0, corners.size() - 2) + "11", kListedEnds, kListedFaces, "0 7 12"),
       ErrorCode::MalformedFile,
       {"face 10 has the point 11; expected 0 to 10"}},
      {prism("", "", "42").replace(prism("", "", "42").find("\"faces\""), 7, "\"other\""),
       ErrorCode::MalformedFile,
       {"without the array 'faces'", "'face_connectivity'"}},
  };
  for (const auto& [bytes, code, parts] : all) {
    write_file(dir / "a.vtu", bytes);
    expect_error(code, parts, [&] { read(dir / "a.vtu"); });
  }
}

TEST(CellMesh, WrongFacesOfPolyhedraAreErrorsThatNameTheCell) {
  TempDir dir;
  const std::vector<WrongMesh> all = {
      {prism(kPrismFaces, "39"), ErrorCode::MalformedFile, {"cell 0", "0 to 39 of 38"}},
      {prism(kPrismFaces, "-1"), ErrorCode::MalformedFile, {"cell 0", "ascending faceoffsets"}},
      {prism(kPrismFaces, "37"), ErrorCode::MalformedFile, {"cell 0 has faces that end within a face"}},
      {prism(kPrismFaces + " 3", "39"), ErrorCode::MalformedFile, {"1 numbers after its faces"}},
      {prism("9" + kPrismFaces.substr(1), "38"), ErrorCode::MalformedFile, {"the number of corners"}},
      {prism("99" + kPrismFaces.substr(1), "38"), ErrorCode::MalformedFile, {"the number of faces 99", "0 to 38"}},
      {prism(kPrismFaces.substr(0, kPrismFaces.size() - 3) + "9 10", "38"),
       ErrorCode::MalformedFile,
       {"the point 10", "0 to 9"}},
      {prism(kPrismFaces.substr(0, kPrismFaces.size() - 3) + "9 -5", "38"), ErrorCode::MalformedFile, {"the point -5"}},
      {prism(kPrismFaces, "38 38"), ErrorCode::MalformedFile, {"expected 1"}},
      {vtu(kPoints, kCorners, "4 8", "42 10", on_points("0 1 2 3 4")), ErrorCode::MalformedFile, {"faces"}},
      // without its last face; the triangle before it is left out, and counts
      {prism("6" + kPrismFaces.substr(1, kPrismFaces.size() - 11), "-1 33", "5 42", "0 1 2 0 1 2 3 4 5 6 7 8 9", "3 13",
             "10 2"),
       ErrorCode::UnsupportedData,
       {"a.vtu", "cell 1: the edge between the points", "in the face 0 only"}},
  };
  for (const auto& [bytes, code, parts] : all) {
    write_file(dir / "a.vtu", bytes);
    expect_error(code, parts, [&] { read(dir / "a.vtu"); });
  }
}

TEST(CellMesh, PolygonsOfUpTo32CornersArePolygons) {
  TempDir dir;
  const auto polygon = [&](int corners) {
    std::string points, numbers, values;
    for (int k = 0; k < corners; ++k) {
      points += std::to_string(std::cos(6.283185 * k / corners)) + " " +
                std::to_string(std::sin(6.283185 * k / corners)) + " 0 ";
      numbers += std::to_string(k) + " ";
      values += "1 ";
    }
    write_file(dir / "a.vtu",
               vtu(points, numbers, std::to_string(corners), "7", on_points(values), std::to_string(corners) + " 1"));
    return read(dir / "a.vtu");
  };
  EXPECT_EQ(polygon(3).types, std::vector{CellType::triangle});
  EXPECT_EQ(polygon(4).types, std::vector{CellType::quadrilateral});
  EXPECT_TRUE(polygon(4).ends.empty());
  EXPECT_EQ(polygon(32).types, std::vector{CellType::polygon});
  EXPECT_THAT(polygon(32).ends, testing::ElementsAre(32));
  EXPECT_EQ(polygon(33).types, std::vector(31, CellType::triangle));
}

TEST(CellMesh, FilesOfASeriesMustMatch) {
  TempDir dir;
  const std::string data = on_points("0 1 2 3 4");
  write_file(dir / "a.vtu", vtu(kPoints, kCorners, "4 8", "10 10", data));
  write_file(dir / "b.vtu", vtu(kPoints, "0 1 2 3 1 2 4 3", "4 8", "10 10", data));
  const std::vector<fs::path> both = {dir / "a.vtu", dir / "b.vtu"};
  expect_error(ErrorCode::UnsupportedData,
               {"b.vtu", "other cells than", "cell 1 (tetrahedron) has the points 1, 2, 4, 3, and 1, 2, 3, 4 there"},
               [&] { read_cell_mesh(both); });
  // cells have the numbers of the file: cell 0, a triangle, is left out
  write_file(dir / "c.vtu", vtu(kPoints, "0 1 2 0 1 2 3", "3 7", "5 10", data));
  write_file(dir / "d.vtu", vtu(kPoints, "0 1 2 0 1 2 4", "3 7", "5 10", data));
  expect_error(ErrorCode::UnsupportedData, {"cell 1 (tetrahedron) has the points 0, 1, 2, 4, and 0, 1, 2, 3 there"},
               [&] {
                 read_cell_mesh(std::array{dir / "c.vtu", dir / "d.vtu"});
               });
  write_file(dir / "e.vtu", vtu(kPoints, "0 1 2 3 4", "5", "14", data, "5 1"));
  write_file(dir / "f.vtu", vtu(kPoints, "0 1 2 3", "4", "10", data, "5 1"));
  expect_error(ErrorCode::UnsupportedData, {"cell 0 is a tetrahedron, and a pyramid there"}, [&] {
    read_cell_mesh(std::array{dir / "e.vtu", dir / "f.vtu"});
  });
  const std::vector<fs::path> same = {dir / "a.vtu", dir / "a.vtu"};
  CellMeshOptions options;
  options.times = {1.0, 0.5};
  expect_error(ErrorCode::InvalidArgument, {"given times (--times) have 0.5 for a.vtu after 1 for a.vtu", "ascending"},
               [&] { read_cell_mesh(same, options); });
  options.times = {0.5, 1.0};
  EXPECT_EQ(to_complex(read_cell_mesh(same, options)).index(), 2U);  // 4D
  options.time_step = 0.25;
  expect_error(ErrorCode::InvalidArgument, {"times and a time step"}, [&] { read_cell_mesh(same, options); });
  options.times.clear();
  EXPECT_THAT(read_cell_mesh(same, options).times, testing::ElementsAre(0.0, 0.25));
  for (const double step : {0.0, -0.25, std::numeric_limits<double>::infinity()}) {
    options.time_step = step;
    expect_error(ErrorCode::InvalidArgument, {fmt::format("(--time-step) is {}; expected a positive number", step)},
                 [&] { read_cell_mesh(same, options); });
  }
}

TEST(CellMesh, FilesOfASeriesHaveTheOrderOfNamesOrTimes) {
  TempDir dir;
  const auto write = [&](const std::string& name, int first) {
    write_file(dir / name, vtu(kPoints, kCorners, "4 8", "10 10", on_points(std::to_string(first) + " 1 2 3 4")));
  };
  write("step_10.vtu", 10);
  write("step_2.vtu", 2);
  write("step_9.vtu", 9);
  const std::vector<fs::path> listed = {dir / "step_10.vtu", dir / "step_2.vtu", dir / "step_9.vtu"};
  const auto first_values = [](const CellMesh& mesh) {
    return std::vector<double>{mesh.values[0], mesh.values[5], mesh.values[10]};
  };
  CellMeshOptions options;
  EXPECT_THAT(first_values(read_cell_mesh(listed, options)), testing::ElementsAre(10, 2, 9));
  options.order = SeriesOrder::by_name;
  options.time_step = 0.5;
  CellMesh mesh = read_cell_mesh(listed, options);
  EXPECT_THAT(first_values(mesh), testing::ElementsAre(2, 9, 10));
  EXPECT_THAT(mesh.times, testing::ElementsAre(0.0, 0.5, 1.0));
  EXPECT_EQ(mesh.files[0], listed[1]);
  options.order = SeriesOrder::coordinate;
  expect_error(ErrorCode::InvalidArgument, {"time step"}, [&] { read_cell_mesh(listed, options); });
  options.time_step.reset();
  expect_error(ErrorCode::InvalidArgument, {"step_10.vtu", "no time"}, [&] { read_cell_mesh(listed, options); });
  options.times = {2.0, 3.0, 1.0};  // in the order of the list
  mesh = read_cell_mesh(listed, options);
  EXPECT_THAT(first_values(mesh), testing::ElementsAre(9, 10, 2));
  EXPECT_THAT(mesh.times, testing::ElementsAre(1.0, 2.0, 3.0));
  options.order = SeriesOrder::by_name;
  expect_error(ErrorCode::InvalidArgument, {"ascending"}, [&] { read_cell_mesh(listed, options); });
  options.times.clear();
  expect_error(ErrorCode::InvalidArgument, {"one mesh"}, [&] { read(listed[0], options); });
}

TEST(CellMesh, FilesAreSortedByTheirOwnTimes) {
  TempDir dir;
  const auto write = [&](const std::string& name, double time, const std::string& points) {
    std::string text = vtu(points, kCorners, "4 8", "10 10", on_points(std::to_string(time) + " 1 2 3 4"));
    text.insert(text.find("<UnstructuredGrid>") + 18,
                "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" +
                    std::to_string(time) + "</DataArray></FieldData>");
    write_file(dir / name, text);
  };
  const std::string still(kPoints), moved = "5" + still.substr(1);
  write("a.vtu", 3.0, still);
  write("b.vtu", 1.0, moved);
  write("c.vtu", 2.0, still);
  const std::vector<fs::path> listed = {dir / "a.vtu", dir / "b.vtu", dir / "c.vtu"};
  expect_error(ErrorCode::InvalidArgument, {"b.vtu: has the time 1 (TimeValue), after 3 of a.vtu", "ascending"},
               [&] { read_cell_mesh(listed); });
  CellMeshOptions options;
  options.order = SeriesOrder::coordinate;
  const CellMesh mesh = read_cell_mesh(listed, options);
  EXPECT_THAT(mesh.times, testing::ElementsAre(1.0, 2.0, 3.0));
  EXPECT_EQ(mesh.files[0], listed[1]);
  ASSERT_TRUE(mesh.points_move);
  const std::size_t layer = mesh.points.size() / 3;
  EXPECT_EQ(mesh.points[0], 5.0);
  EXPECT_NE(mesh.points[layer], 5.0);
  EXPECT_EQ(mesh.values[0], 1.0);
  EXPECT_EQ(mesh.values[5], 2.0);
}

TEST(CellMesh, OptionsThatDoNotFitAreErrors) {
  TempDir dir;
  write_file(dir / "a.vtu", vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 4")));
  const std::vector<std::pair<std::string, CellMeshOptions>> wrong = {{"one mesh", {.times = {1.0}}},
                                                                      {"one mesh", {.time_step = 1.0}},
                                                                      {"values of points", {.cells_to_points = true}}};
  for (const auto& [part, options] : wrong)
    expect_error(ErrorCode::InvalidArgument, {"a.vtu", part}, [&] { read(dir / "a.vtu", options); });
}

TEST(CellMesh, CollectionsNameFilesInTheirFolder) {
  TempDir dir;
  write_file(dir / "a.vtu", vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 4")));
  const auto collection = [](const std::string& sets) {
    return "<VTKFile type=\"Collection\"><Collection>" + sets + "</Collection></VTKFile>";
  };
  write_file(dir / "a.pvd",
             collection("<DataSet timestep=\"2\" file=\"a.vtu\"/><DataSet timestep=\"1\" file=\"a.vtu\"/>"));
  EXPECT_TRUE(is_cell_mesh_file(dir / "a.pvd"));
  EXPECT_THAT(read(dir / "a.pvd").times, testing::ElementsAre(1, 2));
  write_file(dir / "b.vtu", vtu(kPoints, kCorners, "4 8", "10 10", on_points("0 1 2 3 4")));
  write_file(dir / "b.pvd",
             collection("<DataSet timestep=\"2\" file=\"a.vtu\"/><DataSet timestep=\"1\" file=\"b.vtu\"/>"));
  expect_error(ErrorCode::InvalidArgument, {"b.pvd: has the timestep 1 of b.vtu after 2 of a.vtu", "--sort time"},
               [&] { read(dir / "b.pvd", {.order = SeriesOrder::by_name}); });
  const CellMeshOptions equal{.times = {2.0, 2.0}};
  const auto error = error_of([&] { read_cell_mesh(std::array{dir / "a.vtu", dir / "b.vtu"}, equal); });
  EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("2 for b.vtu after 2 for a.vtu; expected a time of its"),
                                           testing::Not(testing::HasSubstr("--sort"))));
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"<DataSet timestep=\"x\" file=\"a.vtu\"/>", "timestep='x'"},
      {"<DataSet file=\"a.vtu\"/>", "<DataSet> has no timestep; expected one that is a finite number"},
      {"<DataSet timestep=\"\" file=\"a.vtu\"/>", "timestep=''"},
      {"<DataSet timestep=\"1\"/>", "<DataSet> has no file; expected the name of a file"},
      {"<DataSet timestep=\"1\" file=\"../a.vtu\"/>", "a.vtu"},
      {"<DataSet timestep=\"1\" file=\"a.exe\"/>", "a.exe"},
      {"<DataSet timestep=\"1\" file=\"a.vtu\"/><DataSet timestep=\"1\" file=\"a.vtu\"/>", "at the time 1"},
      {"", "without a <DataSet>"}};
  for (const auto& [sets, part] : wrong) {
    write_file(dir / "w.pvd", collection(sets));
    EXPECT_THAT(error_of([&] { read(dir / "w.pvd"); }).what(), testing::HasSubstr(part));
  }
}

}  // namespace
}  // namespace tegl::test
