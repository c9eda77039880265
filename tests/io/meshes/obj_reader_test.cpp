// SPDX-License-Identifier: BSD-3-Clause
//
// Reading OBJ: written files are read back bit by bit, files of other programs are understood, and errors name the
// line.
#include "invariants.hpp"
#include "io_support.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

/// OBJ has no names and units; a mesh in the plane gets z = 0.
Mesh as_obj_has_it(const Mesh& mesh) {
  Mesh expected = mesh;
  expected.axis_names.assign(3, "");
  expected.axis_units.assign(3, "");
  if (mesh.space_dim == 3) return expected;
  expected.space_dim = 3;
  for (MeshArray<double> Mesh::*rows : {&Mesh::coordinates, &Mesh::normals}) {
    (expected.*rows).clear();
    for (std::size_t i = 0; i < (mesh.*rows).size(); i += 2)
      for (const double value : {(mesh.*rows)[i], (mesh.*rows)[i + 1], 0.0}) (expected.*rows).push_back(value);
  }
  return expected;
}

/// Expects a mesh to be read back. The text of a mesh in single precision has the digits of its floats and is read as
/// double.
void expect_comes_back(const Mesh& mesh) {
  TempDir dir;
  write_mesh(mesh, dir / "a.obj");
  const Mesh read = read_mesh(dir / "a.obj");
  Mesh rounded = read;
  if (mesh.single_precision)
    for (const auto rows : {&Mesh::coordinates, &Mesh::normals})
      for (double& value : rounded.*rows) value = static_cast<double>(static_cast<float>(value));
  expect_same(rounded, as_obj_has_it(mesh));
  // Writing it again gives the same file.
  write_mesh(read, dir / "b.obj");
  EXPECT_EQ(read_file(dir / "b.obj"), read_file(dir / "a.obj"));
}

/// Noise of integers of a small range, on axes that begin at `origin`. At an integer isovalue many vertices coincide.
template <int N>
OwnedImage<int, N> integer_noise(const std::array<std::size_t, N>& sizes, double origin, double step) {
  OwnedImage<int, N> image{Grid<N>::unit(sizes), {}};
  std::size_t count = 1;
  for (std::size_t a = 0; a < N; ++a) {
    image.grid.axes[a] = Axis::uniform(sizes[a], origin + static_cast<double>(a) * 4900000.0 * (origin != 0), step);
    count *= sizes[a];
  }
  std::mt19937_64 random(7);
  for (std::size_t i = 0; i < count; ++i) image.values.push_back(static_cast<int>(random() % 7));
  return image;
}

template <class Real>
class ObjOf : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ObjOf, Reals);

TYPED_TEST(ObjOf, AnyContourComesBackBitByBit) {
  for (const bool normals : {false, true})
    for (const bool close : {false, true})
      for (const double origin : {0.0, 500000.02}) {
        SCOPED_TRACE(testing::Message() << normals << ' ' << close << ' ' << origin);
        ExtractOptions options;
        options.normals = normals ? Normals::differences : Normals::none;
        options.close = close;
        const auto surface = integer_noise<3>({9, 10, 11}, origin, 0.05);
        expect_comes_back(to_mesh(extract<TypeParam>(surface.view(), 3.0, options)));
        const auto lines = integer_noise<2>({40, 41}, origin, 0.05);
        expect_comes_back(to_mesh(extract<TypeParam>(lines.view(), 3.0, options)));
      }
}

TYPED_TEST(ObjOf, VerticesAtOnePlaceStayApart) {
  TempDir dir;
  const auto image = integer_noise<3>({9, 10, 11}, 0, 1);
  ExtractOptions options;
  options.close = true;
  const Contour<3, TypeParam> contour = extract<TypeParam>(image.view(), 3.0, options);
  auto places = to_mesh(contour).coordinates;
  std::vector<std::array<double, 3>> sorted;
  for (std::size_t i = 0; i < places.size(); i += 3) sorted.push_back({places[i], places[i + 1], places[i + 2]});
  std::sort(sorted.begin(), sorted.end());
  ASSERT_TRUE(std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) << "no ties, nothing is shown";
  write_mesh(contour, dir / "a.obj");
  const Contour<3, double> again = to_contour<3>(read_mesh(dir / "a.obj"));
  const MeshReport report = expect_closed_manifold(again);
  EXPECT_EQ(report.vertices, contour.vertices.size());
  EXPECT_EQ(report.unused_vertices, 0U);
}

TEST(ObjReader, MeshesOfAnyBitsComeBack) {
  for (const bool normals : {false, true}) {
    expect_comes_back(random_mesh(2, 3, 1000, 2000, 3, normals));
    expect_comes_back(random_mesh(1, 2, 1000, 2000, 4, normals));
    expect_comes_back(random_mesh(1, 3, 1000, 2000, 5, normals));
  }
  Mesh mesh = random_mesh(2, 3, 4, 1, 1);
  mesh.coordinates = {-0.0, 5e-324,   1.7976931348623157e308, 0.1, -1.0 / 3, 2.2250738585072014e-308, 1e23, 0, -1e-310,
                      1,    1e15 + 1, 9007199254740993.0};
  expect_comes_back(mesh);  // with at least one vertex in no triangle
}

std::vector<Index> simplices_of(const Mesh& mesh) { return {mesh.simplices.begin(), mesh.simplices.end()}; }
std::vector<double> numbers_of(const MeshArray<double>& numbers) { return {numbers.begin(), numbers.end()}; }

Mesh read_text(const std::string& text) {
  TempDir dir;
  write_file(dir / "a.obj", text);
  return read_mesh(dir / "a.obj");
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\n";

TEST(ObjReader, UnderstandsWhatOtherProgramsWrite) {
  const std::vector<Index> fan = {0, 1, 2, 0, 2, 3};
  for (const char* const face :
       {"f 1 2 3 4", "f -4 -3 -2 -1", "f 1/1 2/2 3/3 4/4", "f 1/ 2/ 3/ 4/", "fo 1 2 3 4", "  f\t1  2 3 4  ",
        "f 1 2 3 4 # all of it", "f 1 2 \\\n 3 4", "f 1 2 3\\\r\n 4\r", "\\\nf 1 2 3 4\\", "f +1 2 3 4"}) {
    SCOPED_TRACE(face);
    const Mesh mesh = read_text(kSquare + face);
    EXPECT_EQ(mesh.dim, 2);
    EXPECT_EQ(simplices_of(mesh), fan);
    EXPECT_EQ(numbers_of(mesh.coordinates), (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5}));
    EXPECT_TRUE(mesh.normals.empty());
  }
  const Mesh mesh = read_text(
      "\xEF\xBB\xBF# made in C:\\models\\\r\nmtllib a.mtl\r\no thing\r\ng side 1\r\nusemtl steel\r\ns off\r\n"
      "f 1/1/1 2/1/1 3/1/1\r\n"  // before its vertices
      "v +1e0 .5 -2. 1.0\r\n\r\nv 1 2 3 0.5 0.25 1\r\nvt 0.5 x\r\nvn 0 0 1\r\nv 4 5 6\r\n"
      "f -1 -2 -3\r\nl 1 2\r\np 1\r\nvp 0.1 0.2\r\ncurv 0 1 1 2\r\n");
  EXPECT_EQ(numbers_of(mesh.coordinates), (std::vector<double>{1, 0.5, -2, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(simplices_of(mesh), (std::vector<Index>{0, 1, 2, 2, 1, 0}));
  EXPECT_TRUE(mesh.normals.empty()) << "one for all";
}

TEST(ObjReader, LinesAreReadWhereThereAreNoTriangles) {
  const Mesh mesh = read_text(kSquare + "l 1 2 -1\nl 3/1 4/7\n");
  EXPECT_EQ(mesh.dim, 1);
  EXPECT_EQ(simplices_of(mesh), (std::vector<Index>{0, 1, 1, 3, 2, 3}));
  EXPECT_EQ(read_text(kSquare + "l 1 2\nf 1 2 3\nl 3 4\n").simplices.size(), 3U);
}

TEST(ObjReader, NormalsAreTakenByTheNumberOfTheirVertex) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  const std::string normals = "vn 0 0 1\nvn 0 1 0\nvn 1 0 0\n";
  const std::vector<double> expected = {0, 0, 1, 0, 1, 0, 1, 0, 0};
  for (const char* const face : {"f 1//1 2//2 3//3", "f 1/9/1 2/8/2 3/7/3", "f -3//-3 2//-2 3//3"})
    EXPECT_EQ(numbers_of(read_text(three + normals + face).normals), expected) << face;
  for (const char* const face : {"f 1 2 3", "f 1//1 2//2 3//1", "f 1//1 2//2 3", "f 1//1 2//2 3//3\nf 1 2 3"})
    EXPECT_TRUE(read_text(three + normals + face).normals.empty()) << face;
  EXPECT_TRUE(read_text(three + normals + "vn 1 1 1\nf 1//1 2//2 3//3").normals.empty()) << "one more than vertices";
  EXPECT_EQ(numbers_of(read_text(three + normals + "l 1 2 3").normals), expected);
}

TEST(ObjReader, SaysWhatIsBrokenAndWhere) {
  TempDir dir;
  const auto expect = [&](const std::string& text, const std::string& part, ErrorCode code = ErrorCode::MalformedFile) {
    SCOPED_TRACE(part);
    write_file(dir / "a.obj", text);
    expect_error(code, {"a.obj: ", part}, [&] { read_mesh(dir / "a.obj"); });
  };
  expect(kSquare + "f 1 2 5", "line 5: vertex number 5; expected at most 4, the number of definitions");
  expect(kSquare + "f 1 9 2\nf 1 8 2", "line 5: vertex number 9; expected at most 4");
  expect(kSquare + "\n#\nf 1 \\\n2 -5", "line 7: vertex number -5; expected at least -4, the number so far");
  expect("f -1 -1 -1\n" + kSquare, "line 1: vertex number -1; expected at least 0");
  expect(kSquare + "f 1 2 0", "line 5: vertex number 0; expected 1 or more, or less than 0");
  expect(kSquare + "f 1 2 4294967296", "line 5: vertex number 4294967296; expected at most 4294967295");
  expect(kSquare + "f 1 2 99999999999999999999", "line 5: '9999999999999999...'; expected the number of a vertex");
  expect(kSquare + "f 1 2 -9223372036854775808", "line 5: vertex number -9223372036854775808; expected at least -4");
  expect(kSquare + "f 1 2 2.5", "line 5: '2.5'; expected the number of a vertex");
  expect(kSquare + "f 1 2 /3", "line 5: ''; expected the number of a vertex");
  expect(kSquare + "f 1//1 2//1 3//1", "line 5: normal number 1; expected at most 0, the number of definitions");
  expect(kSquare + "f 1//a 2 3", "line 5: 'a'; expected the number of a normal");
  expect(kSquare + "f 1 2\n", "line 5: face of 2 vertices; expected 3 or more");
  expect(kSquare + "l 1\n", "line 5: line of 1 vertices; expected 2 or more");
  expect("v 0 0\n", "line 1: 'v' with 2 numbers; expected 3 or more");
  expect("\r\nv 0 one 0\n", "line 2: 'one'; expected a number");
  expect("v 0 1,5 0\n", "line 1: '1,5'; expected a number");
  expect("v 0 1e999 0\n", "line 1: '1e999'; expected a number in the range of double");
  expect("v 0 0 0 red\n", "line 1: 'red'; expected a number");
  expect(kSquare + "vn 0 0 z\n", "line 5: 'z'; expected a number");
  expect(kSquare, "no triangles, no lines; expected a surface", ErrorCode::UnsupportedData);
  expect("solid a\nfacet normal 0 0 1\n", "no triangles, no lines", ErrorCode::UnsupportedData);
}

TEST(ObjReader, CutOffAnywhereNeverReadsWhatIsNotThere) {
  TempDir dir;
  write_mesh(random_mesh(2, 3, 30, 40, 6, true), dir / "a.obj");
  const std::string whole = read_file(dir / "a.obj");
  std::size_t errors = 0;
  for (std::size_t size = 1; size < whole.size(); size += 7) {
    write_file(dir / "b.obj", whole.substr(0, size));
    try {
      const Mesh mesh = read_mesh(dir / "b.obj");
      for (const Index v : mesh.simplices) ASSERT_LT(v, 30U);
    } catch (const Error& error) {
      ++errors;
      EXPECT_THAT(error.what(), testing::HasSubstr("b.obj"));
    }
  }
  EXPECT_GT(errors, 100U);
}

TEST(ObjReader, TellsItsProgressAndStops) {
  TempDir dir;
  write_mesh(random_mesh(2, 3, 60000, 60000, 6, true), dir / "a.obj");
  ASSERT_GT(fs::file_size(dir / "a.obj"), std::size_t{3} << 20);
  std::vector<double> told;
  const auto tell = [&](double fraction) {
    told.push_back(fraction);
    return true;
  };
  read_mesh(dir / "a.obj", {.work = {.progress = tell}});
  EXPECT_GE(told.size(), 4U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.front(), 0.0);
  EXPECT_EQ(told.back(), 1.0);
  expect_error(ErrorCode::Cancelled, {"a.obj"}, [&] {
    read_mesh(dir / "a.obj", {.work = {.progress = [](double fraction) { return fraction < 0.5; }}});
  });
}

}  // namespace
}  // namespace tegl::test
