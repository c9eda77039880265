// SPDX-License-Identifier: BSD-3-Clause
//
// STL and OBJ: written meshes are read back as far as the formats permit. meshio_reads_test.py checks the files with
// other programs.
#include <algorithm>
#include <charconv>
#include <cstring>
#include <sstream>

#include "base/mesh_data.hpp"
#include "invariants.hpp"
#include "io_support.hpp"
#include "meshes/stl_writer.hpp"
#include "tegl/extract.hpp"
#include "tegl/measure.hpp"

namespace tegl::test {
namespace {

/// A closed surface of noise, of any precision, on axes of which some descend.
template <class Real>
Contour<3, Real> closed_noise(std::uint64_t seed, const std::array<double, 3>& steps = {0.7, 1.1, 1.3}) {
  OwnedImage<float, 3> image{Grid<3>::unit({11, 12, 13}), {}};
  for (std::size_t a = 0; a < 3; ++a) image.grid.axes[a] = Axis::uniform(image.grid.axes[a].size(), 0.1, steps[a]);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 11 * 12 * 13; ++i)
    image.values.push_back((random() % 2 == 0 ? 1.0F : -1.0F) * static_cast<float>(1 + random() % 1000));
  ExtractOptions options;
  options.close = true;
  options.normals = Normals::differences;
  return extract<Real>(image.view(), 0.0, options);
}

/// The corners of all triangles, as floats.
std::vector<float> corners_of(const Mesh& mesh) {
  std::vector<float> corners;
  for (const Index v : mesh.simplices)
    for (const double value : io_detail::position(mesh, v)) corners.push_back(static_cast<float>(value));
  return corners;
}

template <class Real>
class StlAndObj : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(StlAndObj, Reals);

TYPED_TEST(StlAndObj, ComeBackAsTheSameClosedManifold) {
  TempDir dir;
  for (const char* const name : {"a.stl", "a.obj"})
    for (const std::array<double, 3>& steps : {std::array<double, 3>{0.7, 1.1, 1.3}, {0.7, -1.1, 1.3}, {-1, -1, -1}}) {
      SCOPED_TRACE(testing::Message() << name << ' ' << steps[0] << ' ' << steps[1]);
      const Contour<3, TypeParam> contour = closed_noise<TypeParam>(3, steps);
      const Mesh mesh = to_mesh(contour);
      write_mesh(mesh, dir / name);
      const Mesh read = read_mesh(dir / name);
      EXPECT_EQ(corners_of(read), corners_of(mesh));
      const Contour<3, double> again = to_contour<3>(read);
      const MeshReport before = expect_closed_manifold(contour);
      const MeshReport after = expect_closed_manifold(again);
      EXPECT_EQ(after.components, before.components);
      EXPECT_EQ(after.euler, before.euler);
      const double enclosed = measure(contour).content.value();
      EXPECT_GT(enclosed, 100.0) << "high is inside";
      EXPECT_NEAR(measure(again).content.value(), enclosed, 1e-6 * enclosed);
    }
}

TYPED_TEST(StlAndObj, ObjHasTheDigitsThatItTakes) {
  TempDir dir;
  const Contour<3, TypeParam> contour = closed_noise<TypeParam>(5);
  write_mesh(contour, dir / "a.obj");
  std::istringstream lines(read_file(dir / "a.obj"));
  std::vector<TypeParam> positions, normals;
  std::size_t faces = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool is_normal = line.starts_with("vn ");
    faces += line.starts_with("f ") ? 1 : 0;
    if (!is_normal && !line.starts_with("v ")) continue;
    const char* at = line.data() + (is_normal ? 2 : 1);
    for (int a = 0; a < 3; ++a) {
      TypeParam value = 0;
      at = std::from_chars(at + 1, line.data() + line.size(), value).ptr;
      (is_normal ? normals : positions).push_back(value);
    }
  }
  const auto flat = [](const auto& rows) {
    std::vector<TypeParam> values;
    for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
    return values;
  };
  EXPECT_EQ(positions, flat(contour.vertices));
  EXPECT_EQ(normals, flat(contour.normals));
  EXPECT_EQ(faces, contour.simplices.size());
}

TEST(Stl, HasEightyFourBytesAndFiftyForEachTriangle) {
  TempDir dir;
  for (const std::size_t triangles : {0U, 1U, 1000U, 140000U}) {
    write_mesh(random_mesh(2, 3, triangles + 1, triangles, triangles), dir / "a.stl");
    EXPECT_EQ(fs::file_size(dir / "a.stl"), 84 + 50 * triangles);
  }
}

TEST(Stl, HasTheCornersOfEachTriangleInEveryBlock) {
  TempDir dir;
  const Mesh mesh = random_mesh(2, 3, 20000, 40000, 3);
  write_mesh(mesh, dir / "a.stl");
  const std::string bytes = read_file(dir / "a.stl");
  const std::vector<float> corners = corners_of(mesh);
  for (std::size_t i = 0; i < 40000; ++i) {
    std::array<float, 9> found{};
    std::memcpy(found.data(), &bytes[84 + 50 * i + 12], sizeof found);
    ASSERT_TRUE(std::equal(found.begin(), found.end(), corners.begin() + static_cast<std::ptrdiff_t>(9 * i))) << i;
  }
}

TEST(Stl, NamesTheVertexThatFloatCannotHold) {
  TempDir dir;
  Mesh mesh = random_mesh(2, 3, 4, 1, 1);
  mesh.simplices = {0, 1, 2};
  mesh.coordinates[9] = 1e300;  // of a vertex in no triangle
  write_mesh(mesh, dir / "a.stl");
  mesh.coordinates[4] = -1e39;
  expect_error(ErrorCode::UnsupportedData, {"b.stl", "vertex 1", "-1e+39", "range of float"},
               [&] { write_mesh(mesh, dir / "b.stl"); });
  EXPECT_EQ(dir.files(), 1U);
}

TEST(Stl, HasBytesInOneOrderWhateverTheMachine) {
  TempDir dir;
  Mesh mesh = random_mesh(2, 3, 3, 1, 1);
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 0, -2, 0};  // seen from below
  mesh.simplices = {0, 1, 2};
  write_mesh(mesh, dir / "a.stl");
  const std::string bytes = read_file(dir / "a.stl");
  EXPECT_EQ(bytes.substr(80, 4), std::string("\x01\0\0\0", 4));
  EXPECT_EQ(bytes.substr(84 + 8, 4), std::string("\0\0\x80\xbf", 4));   // the normal's z: -1
  EXPECT_EQ(bytes.substr(84 + 24, 4), std::string("\0\0\x80\x3f", 4));  // the second corner's x: 1
  EXPECT_EQ(bytes.substr(84 + 40, 4), std::string("\0\0\0\xc0", 4));    // the third one's y: -2
}

TEST(Stl, TrianglesWithoutAreaHaveNoNormal) {
  TempDir dir;
  Mesh mesh = random_mesh(2, 3, 3, 1, 1);
  mesh.coordinates = {0, 0, 0, 1, 1, 1, 2, 2, 2};
  mesh.simplices = {0, 1, 2};
  write_mesh(mesh, dir / "a.stl");
  EXPECT_EQ(read_file(dir / "a.stl").substr(84, 12), std::string(12, '\0'));
}

TEST(Stl, MoreTrianglesThanItsCountHoldsAreRefused) {
  constexpr std::uint64_t kMost = 0xFFFFFFFFU;
  EXPECT_EQ(io_detail::stl_triangle_count(kMost, "a.stl"), kMost);
  expect_error(ErrorCode::TooLarge, {"a.stl", "4294967296 triangles as .stl; expected at most 2^32 - 1"},
               [] { (void)io_detail::stl_triangle_count(kMost + 1, "a.stl"); });
}

TEST(Obj, LinesComeBackAsLines) {
  TempDir dir;
  OwnedImage<float, 2> image{Grid<2>::unit({30, 31}), {}};
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 30; ++x)
      image.values.push_back(static_cast<float>(100.3 - (x - 14) * (x - 14) - (y - 15) * (y - 15)));
  ExtractOptions options;
  options.normals = Normals::differences;
  const Contour<2, float> contour = extract<float>(image.view(), 0.0, options);
  write_mesh(contour, dir / "a.obj");
  const Contour<2, double> again = to_contour<2>(read_mesh(dir / "a.obj"));
  ASSERT_EQ(again.simplices.size(), contour.simplices.size());
  for (std::size_t s = 0; s < again.simplices.size(); ++s)
    for (std::size_t c = 0; c < 2; ++c)
      for (int a = 0; a < 2; ++a)
        EXPECT_EQ(static_cast<float>(again.vertices[again.simplices[s][c]][a]),
                  contour.vertices[contour.simplices[s][c]][a]);
  expect_closed_manifold(again);
  EXPECT_NEAR(measure(again).content.value(), measure(contour).content.value(), 1e-3);
}

TEST(Obj, OfNothingIsAFileThatIsRefused) {
  TempDir dir;
  for (const char* const name : {"a.obj", "a.stl"}) {
    write_mesh(random_mesh(2, 3, 0, 0, 1), dir / name);
    EXPECT_TRUE(fs::exists(dir / name));
    EXPECT_THROW(read_mesh(dir / name), Error);
  }
}

}  // namespace
}  // namespace tegl::test
