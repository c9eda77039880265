// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes: round trips, file contents in other programs' readers, combinations that no format supports, and failed
// writes that leave no files.
#include <sys/resource.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>
#include <type_traits>
#include <utility>

#include "io_support.hpp"

namespace tegl::test {
namespace {

Mesh written_and_read(const Mesh& mesh, const std::string& name) {
  TempDir dir;
  write_mesh(mesh, dir / name);
  EXPECT_EQ(dir.files(), 1U);
  return read_mesh(dir / name);
}

Mesh as_floats(Mesh mesh) {
  for (double& value : mesh.coordinates) value = static_cast<float>(value);
  for (double& value : mesh.normals) value = static_cast<float>(value);
  for (Attribute& attribute : mesh.vertex_attributes)
    for (double& value : attribute.values) value = static_cast<float>(value);
  return mesh;
}

/// A contour of one simplex with normals, names and attributes.
template <int N, class Real>
Contour<N, Real> small_contour() {
  Contour<N, Real> contour;
  for (int v = 0; v < N; ++v) {
    auto& vertex = contour.vertices.emplace_back();
    auto& normal = contour.normals.emplace_back();
    for (int a = 0; a < N; ++a) vertex[a] = static_cast<Real>(0.1 + v * N + a);
    normal.fill(0);
    normal[v % N] = 1;
    contour.simplices.resize(1);
    contour.simplices[0][v] = static_cast<Index>(v);
  }
  for (int a = 0; a < N; ++a) contour.axis_names[a] = std::string(1, "abcde"[a]);
  contour.axis_units[0] = "mm";
  contour.vertex_attributes = {{"heat", "K", 1, Buffer<double>(N, 0.3)}};
  contour.simplex_attributes = {{"pair", "", 2, {1.5, 2.5}}};
  return contour;
}

template <int N, class Real>
void expect_no_copies() {
  const Contour<N, Real> contour = small_contour<N, Real>();
  const Mesh copied = to_mesh(contour);
  // written as a view, with the same bytes as a mesh
  for (const char* const name : {"a.ply", "a.glb", "a.obj", "a.vtkhdf"}) {
    if (N == 4 && std::string(name) != "a.vtkhdf") continue;
    TempDir dir;
    fs::create_directory(dir / "view");
    Mesh mesh = copied;
    mesh.isovalue = 0.5;
    write_mesh(mesh, dir / name);
    MeshView view(contour);
    view.isovalue = 0.5;
    write_mesh(view, dir / "view" / name);
    EXPECT_EQ(read_file(dir / "view" / name), read_file(dir / name)) << name;
  }
  // memory taken over
  Contour<N, Real> source = contour;
  const void* const simplices = source.simplices.data();
  const void* const vertices = source.vertices.data();
  const void* const normals = source.normals.data();
  const void* const attribute = source.vertex_attributes[0].values.data();
  const Mesh moved = to_mesh(std::move(source));
  EXPECT_EQ(moved.simplices.data(), simplices);
  EXPECT_EQ(moved.coordinates.data() == vertices, (std::is_same_v<Real, double>));
  EXPECT_EQ(moved.normals.data() == normals, (std::is_same_v<Real, double>));
  EXPECT_EQ(moved.vertex_attributes[0].values.data(), attribute);
  expect_same(moved, copied);
  EXPECT_EQ(moved.single_precision, (std::is_same_v<Real, float>));
}

TEST(Mesh, OfAContourNeedsNoCopy) {
  expect_no_copies<2, float>();
  expect_no_copies<2, double>();
  expect_no_copies<3, float>();
  expect_no_copies<3, double>();
  expect_no_copies<4, float>();
  expect_no_copies<4, double>();
}

TEST(MeshArray, OfRowsIsAnArrayOfNumbers) {
  MeshArray<Index> array(Buffer<std::array<Index, 3>>{{0, 1, 2}, {3, 4, 5}});
  EXPECT_EQ(array.size(), 6U);
  EXPECT_EQ(array[4], 4U);
  const MeshArray<Index> copy = array;
  array.push_back(6);
  EXPECT_EQ(array, (MeshArray<Index>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(copy.size(), 6U);
  const Index* const data = array.data();
  const MeshArray<Index> moved = std::move(array);
  EXPECT_EQ(moved.data(), data);
  EXPECT_TRUE(array.empty());  // NOLINT(bugprone-use-after-move)
  array.insert(array.end(), copy.begin(), copy.end());
  EXPECT_EQ(array, copy);
  EXPECT_NE(array, moved);
  array.clear();
  EXPECT_TRUE(array.empty());
  EXPECT_TRUE(MeshArray<double>(Buffer<std::array<double, 2>>()).empty());
}

TEST(Mesh, PlyAndVtkhdfAreLossless) {
  for (const char* name : {"a.ply", "a.vtkhdf"})
    for (const auto& [dim, space_dim] : {std::pair(1, 2), std::pair(2, 3), std::pair(1, 3)})
      for (const std::size_t simplices : {0U, 1U, 1000U, 200000U}) {
        SCOPED_TRACE(testing::Message() << name << " dim " << dim << " in " << space_dim << ", " << simplices);
        const Mesh mesh = random_mesh(dim, space_dim, simplices / 2 + (simplices > 0), simplices, simplices);
        expect_same(written_and_read(mesh, name), mesh);
      }
}

TEST(Mesh, InSinglePrecisionComesBackFromSmallerFiles) {
  for (const char* name : {"a.ply", "a.obj", "a.vtkhdf"})
    for (const auto& [dim, space_dim] : {std::pair(1, 2), std::pair(2, 3)}) {
      SCOPED_TRACE(testing::Message() << name << " dim " << dim);
      Mesh mesh = as_floats(random_mesh(dim, space_dim, 3000, 6000, 5));
      mesh.vertex_attributes.clear();
      mesh.simplex_attributes.clear();
      TempDir dir_of_files;
      write_mesh(mesh, dir_of_files / (std::string("double_") + name));
      mesh.single_precision = true;
      write_mesh(mesh, dir_of_files / name);
      const Mesh back = read_mesh(dir_of_files / name);
      EXPECT_EQ(back.coordinates.size() / static_cast<std::size_t>(back.space_dim), 3000U);
      EXPECT_EQ(back.simplices, mesh.simplices);
      EXPECT_LT(std::filesystem::file_size(dir_of_files / name),
                9 * std::filesystem::file_size(dir_of_files / (std::string("double_") + name)) / 10);
      if (back.space_dim != space_dim) continue;
      ASSERT_EQ(back.coordinates.size(), mesh.coordinates.size());
      for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
        ASSERT_EQ(static_cast<float>(back.coordinates[i]), static_cast<float>(mesh.coordinates[i]));
    }
}

TEST(Mesh, CompressionIsForVtkhdfAndChangesNothing) {
  for (const bool single : {false, true}) {
    Mesh mesh = as_floats(random_mesh(3, 4, 3000, 9000, 5));
    mesh.single_precision = single;
    TempDir dir;
    write_mesh(mesh, dir / "plain.vtkhdf");
    write_mesh(mesh, dir / "packed.vtkhdf", {.compression = Compression::deflate});
    expect_same(read_mesh(dir / "packed.vtkhdf"), read_mesh(dir / "plain.vtkhdf"));
    EXPECT_LT(std::filesystem::file_size(dir / "packed.vtkhdf"), std::filesystem::file_size(dir / "plain.vtkhdf"));
    EXPECT_EQ(error_of([&] {
                write_mesh(random_mesh(2, 3, 10, 10, 1), dir / "a.ply", {.compression = Compression::deflate});
              }).code(),
              ErrorCode::UnsupportedFormat);
  }
}

TEST(Mesh, FourDimensionalContoursGoThroughVtkhdf) {
  for (const std::size_t simplices : {0U, 1U, 150000U}) {
    const Mesh mesh = random_mesh(3, 4, simplices + 4, simplices, simplices);
    expect_same(written_and_read(mesh, "a.vtkhdf"), mesh);
  }
}

TEST(Mesh, FiveDimensionalContoursGoThroughVtkhdf) {
  for (const std::size_t simplices : {0U, 1U, 70000U}) {
    const Mesh mesh = random_mesh(4, 5, simplices + 5, simplices, simplices);
    expect_same(written_and_read(mesh, "a.vtkhdf"), mesh);
  }
  TempDir dir;
  const Contour<5, float> contour = small_contour<5, float>();
  write_mesh(contour, dir / "b.vtkhdf");
  const Contour<5, double> back = to_contour<5>(read_mesh(dir / "b.vtkhdf"));
  EXPECT_EQ(back.vertices[4][4], contour.vertices[4][4]);
  EXPECT_EQ(back.normals[4][4], 1);
  EXPECT_TRUE(back.simplices == contour.simplices);
  EXPECT_EQ(back.axis_names[4], "e");
  expect_error(ErrorCode::UnsupportedFormat, {"4-simplices in 5D space (the contour of a 5D image)"},
               [&] { write_mesh(contour, dir / "b.ply"); });
}

TEST(Mesh, GltfKeepsFloatsAndOrder) {
  for (const char* name : {"a.gltf", "a.glb"})
    for (const auto& [dim, space_dim] : {std::pair(1, 2), std::pair(2, 3)})
      for (const std::size_t simplices : {1U, 1000U}) {
        SCOPED_TRACE(testing::Message() << name << " dim " << dim << ", " << simplices);
        const Mesh mesh = random_mesh(dim, space_dim, 500, simplices, simplices);
        expect_same(written_and_read(mesh, name), as_floats(mesh));
      }
}

TEST(Mesh, TheIsovalueComesBackFromEveryFormat) {
  for (const char* name : {"a.ply", "a.gltf", "a.glb", "a.vtkhdf"})
    for (const std::optional<double> isovalue : {std::optional<double>(), {0.1}, {-1e300}, {0.0}}) {
      Mesh mesh = random_mesh(2, 3, 50, 90, 4);
      mesh.isovalue = isovalue;
      EXPECT_EQ(written_and_read(mesh, name).isovalue, isovalue) << name;
    }
}

TEST(Mesh, EqualMeshesMakeEqualFilesWheneverTheyAreWritten) {
  TempDir dir;
  const Mesh mesh = random_mesh(3, 4, 100, 200, 5, true);
  write_mesh(mesh, dir / "first.vtkhdf");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 time stamps are in seconds
  write_mesh(mesh, dir / "second.vtkhdf");
  EXPECT_EQ(read_file(dir / "first.vtkhdf"), read_file(dir / "second.vtkhdf"));
}

TEST(Mesh, NormalsGoIntoEveryFormat) {
  for (const char* name : {"a.ply", "a.gltf", "a.glb", "a.vtkhdf"})
    for (const auto& [dim, space_dim] : {std::pair(1, 2), std::pair(2, 3), std::pair(3, 4)}) {
      SCOPED_TRACE(testing::Message() << name << " dim " << dim);
      const bool lossless = find_mesh_file_format(name)->extension[1] != 'g';
      if (find_mesh_file_format(name)->most_dim < dim) continue;
      const Mesh mesh = random_mesh(dim, space_dim, 70000, 1000, 5, true);
      expect_same(written_and_read(mesh, name), lossless ? mesh : as_floats(mesh));
    }
}

TEST(Mesh, AttributesWithTheirNamesAndUnitsGoIntoPlyAndVtkhdf) {
  for (const char* name : {"a.ply", "a.vtkhdf"})
    for (const auto& [dim, space_dim] : {std::pair(1, 2), std::pair(2, 3), std::pair(3, 4)})
      for (const std::size_t simplices : {0U, 1U, 70000U}) {
        SCOPED_TRACE(testing::Message() << name << " dim " << dim << ", " << simplices);
        if (find_mesh_file_format(name)->most_dim < dim) continue;
        Mesh mesh = random_mesh(dim, space_dim, 2 * simplices, simplices, simplices, simplices == 1);
        add_attributes(mesh, simplices);
        expect_same(written_and_read(mesh, name), mesh);
      }
}

TEST(Mesh, AttributesOfUpToFourNumbersPerVertexGoIntoGltf) {
  for (const char* name : {"a.gltf", "a.glb"})
    for (const auto& [dim, space_dim] : {std::pair(1, 2), std::pair(2, 3)}) {
      SCOPED_TRACE(testing::Message() << name << " dim " << dim);
      Mesh mesh = random_mesh(dim, space_dim, 300, 400, 1, true);
      add_attributes(mesh, 2);
      Mesh wide = mesh;
      Attribute& five = wide.vertex_attributes.emplace_back(Attribute{"five", "", 5, {}});
      five.values.assign(5 * 300, 0.0);
      mesh.simplex_attributes.clear();
      expect_same(written_and_read(wide, name), as_floats(mesh));
    }
}

TEST(Mesh, ColorsAreThoseThatViewersShow) {
  TempDir dir;
  Mesh mesh = random_mesh(2, 3, 4, 2, 1);
  mesh.vertex_attributes = {{"color", "", 3, {1, 0, 0, 0, 128 / 255.0, 0, 0, 0, 1, 0.2, 0.4, 0.6}}};
  write_mesh(mesh, dir / "a.ply");
  EXPECT_THAT(read_file(dir / "a.ply"),
              testing::HasSubstr("property uchar red\nproperty uchar green\nproperty uchar blue\n"));
  expect_same(read_mesh(dir / "a.ply"), mesh);
  write_mesh(mesh, dir / "a.gltf");
  const auto json = nlohmann::json::parse(read_file(dir / "a.gltf"));
  EXPECT_TRUE(json["meshes"][0]["primitives"][0]["attributes"].contains("COLOR_0"));
  expect_same(read_mesh(dir / "a.gltf"), as_floats(mesh));
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile((dir / "a.gltf").string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_NE(scene->mMeshes[0]->mColors[0], nullptr);
  // Other values are stored as plain numbers.
  mesh.vertex_attributes[0].values[1] = 0.123;
  expect_same((write_mesh(mesh, dir / "b.ply"), read_mesh(dir / "b.ply")), mesh);
  mesh.vertex_attributes[0].values[1] = -7;
  expect_same((write_mesh(mesh, dir / "b.glb"), read_mesh(dir / "b.glb")), as_floats(mesh));
}

TEST(Mesh, AttributesMayHaveNamesThatFormatsUseThemselves) {
  Mesh mesh = random_mesh(2, 3, 3, 2, 1, true);
  for (const char* name :
       {"x", "X", "nz", "t", "Normals", "a/b", "a_b", "a b", ".", "..", "\xc3\xa4", "_", "vertex1"}) {
    const auto i = static_cast<double>(mesh.vertex_attributes.size());
    mesh.vertex_attributes.push_back({name, "unit of it", 1, {i, 0.5, -i}});
    mesh.simplex_attributes.push_back({name, "", 2, {i, 1, 2, 3}});
  }
  for (const char* name : {"a.ply", "a.vtkhdf", "a.gltf"}) {
    SCOPED_TRACE(name);
    Mesh expected = std::string(name) == "a.gltf" ? as_floats(mesh) : mesh;
    if (std::string(name) == "a.gltf") expected.simplex_attributes.clear();
    expect_same(written_and_read(mesh, name), expected);
  }
  Mesh contour = random_mesh(3, 4, 4, 1, 1, true);
  contour.vertex_attributes = {{"t", "", 1, {1, 2, 3, 4}}, {"normal_t", "", 1, {5, 6, 7, 8}}};
  expect_same(written_and_read(contour, "a.vtkhdf"), contour);
}

TEST(Mesh, NamesThatDifferInControlCharactersStayApartInPly) {
  TempDir dir;
  Mesh mesh = random_mesh(2, 3, 3, 1, 1);
  mesh.vertex_attributes = {
      {"a\tb", "", 1, {1, 2, 3}}, {"a b", "", 1, {4, 5, 6}}, {"a\nb", "", 1, {7, 8, 9}}, {"c\td", "", 1, {1, 1, 1}}};
  write_mesh(mesh, dir / "a.ply");
  const std::vector<Attribute> read = read_mesh(dir / "a.ply").vertex_attributes;
  ASSERT_EQ(read.size(), 4U);
  EXPECT_EQ(read[0].name, "a b_2");
  EXPECT_EQ(read[1].name, "a b");
  EXPECT_EQ(read[2].name, "a b_3");
  EXPECT_EQ(read[3].name, "c d");
}

TEST(Mesh, TetrahedraInSpaceKeepATimeAsAnAttribute) {
  Mesh mesh = random_mesh(3, 3, 4, 1, 1);
  mesh.vertex_attributes = {{"t", "s", 1, {1, 2, 3, 4}}};
  expect_same(written_and_read(mesh, "a.vtkhdf"), mesh);
}

TEST(Mesh, AttributesThatContradictTheMeshAreRefused) {
  TempDir dir;
  const auto refused = [&](std::vector<Attribute> attributes, const std::string& part) {
    Mesh mesh = random_mesh(2, 3, 3, 1, 7);
    mesh.vertex_attributes = std::move(attributes);
    for (const char* name : {"a.ply", "a.glb", "a.vtkhdf"})
      expect_error(ErrorCode::InvalidArgument, {name, part}, [&] { write_mesh(mesh, dir / name); });
  };
  refused({{"", "", 1, {1, 2, 3}}}, "attribute of vertices with the name ''");
  refused({{"a", "", 1, {1, 2, 3}}, {"a", "", 1, {1, 2, 3}}}, "with the name 'a'; expected different names");
  refused({{"a", "", 1, {1, 2}}}, "attribute 'a' of 2 numbers, 1 for each of 3 vertices; expected 3");
  refused({{"a", "", 0, {}}}, "expected a width of 1 or more");
  Mesh mesh = random_mesh(2, 3, 3, 1, 7);
  mesh.simplex_attributes = {{"label", "", 1, {1, 2, 3}}};
  expect_error(ErrorCode::InvalidArgument, {"1 for each of 1 simplices; expected 1"},
               [&] { write_mesh(mesh, dir / "a.ply"); });
  mesh.simplex_attributes.clear();
  mesh.vertex_attributes = {{"a", "", 1, {1, std::nan(""), 3}}};
  expect_error(ErrorCode::UnsupportedData, {"vertex 1 has nan as 'a'"}, [&] { write_mesh(mesh, dir / "a.glb"); });
  EXPECT_EQ(dir.files(), 0U);
}

TEST(Mesh, NormalsOfLengthZeroPointUpInGltf) {
  Mesh mesh = random_mesh(2, 3, 3, 1, 7, true);
  std::fill_n(mesh.normals.begin() + 3, 3, 0.0);
  const Mesh read = written_and_read(mesh, "a.glb");
  EXPECT_EQ(std::vector<double>(read.normals.begin() + 3, read.normals.begin() + 6), (std::vector<double>{0, 0, 1}));
}

TEST(Mesh, GltfNormalsTurnWithTheirNodes) {
  TempDir dir;
  Mesh mesh = random_mesh(2, 3, 3, 1, 7);
  mesh.normals.assign(9, 0.0);
  for (std::size_t v = 0; v < 3; ++v) mesh.normals[3 * v] = mesh.normals[3 * v + 1] = std::sqrt(0.5);
  write_mesh(mesh, dir / "a.gltf");
  auto json = nlohmann::json::parse(read_file(dir / "a.gltf"));
  json["nodes"][0]["scale"] = {2.0, -1.0, 1.0};  // maps a plane x + y = c to x / 2 - y = c
  write_file(dir / "b.gltf", json.dump());
  const Mesh read = read_mesh(dir / "b.gltf");
  ASSERT_EQ(read.normals.size(), 9U);
  EXPECT_NEAR(read.normals[3], 0.5 / std::sqrt(1.25), 1e-7);
  EXPECT_NEAR(read.normals[4], -1.0 / std::sqrt(1.25), 1e-7);
}

TEST(Mesh, NormalsOfAnotherNumberAreRefused) {
  TempDir dir;
  Mesh mesh = random_mesh(2, 3, 3, 1, 7, true);
  mesh.normals.pop_back();
  expect_error(ErrorCode::InvalidArgument, {"8 numbers in normals; expected 9"},
               [&] { write_mesh(mesh, dir / "a.ply"); });
  EXPECT_EQ(dir.files(), 0U);
}

TEST(Mesh, EmptyMeshesAreValidFilesThatKeepTheirKind) {
  for (const char* name : {"a.ply", "a.gltf", "a.glb", "a.vtkhdf"})
    for (const auto& [dim, space_dim] : {std::pair(1, 2), std::pair(2, 3)}) {
      SCOPED_TRACE(testing::Message() << name << " dim " << dim);
      const Mesh mesh = random_mesh(dim, space_dim, 0, 0, 1);
      expect_same(written_and_read(mesh, name), mesh);
    }
}

TEST(Mesh, NamesMayHoldAnyCharacters) {
  Mesh mesh = random_mesh(2, 3, 3, 1, 7);
  mesh.axis_names = {"x \"quoted\" \\ name", "end_header", "\xc3\xa4"};
  mesh.axis_units = {"", "m s-1", "comment"};
  for (const char* name : {"a.ply", "a.gltf", "a.vtkhdf"}) {
    SCOPED_TRACE(name);
    expect_same(written_and_read(mesh, name), std::string(name) == "a.gltf" ? as_floats(mesh) : mesh);
  }
  mesh.axis_names[0] = "two\nlines";
  EXPECT_EQ(written_and_read(mesh, "a.ply").axis_names[0], "two lines");
}

TEST(Mesh, ContoursBecomeMeshesAndBack) {
  Contour<3, float> contour;
  contour.vertices = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8.5F}};
  contour.simplices = {{0, 1, 2}, {2, 1, 0}};
  contour.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  contour.axis_names = {"x", "y", "z"};
  contour.axis_units = {"mm", "mm", "mm"};
  contour.vertex_attributes = {{"age", "s", 1, {1, 2, 3}}};
  contour.simplex_attributes = {{"flow", "m", 2, {1, 2, 3, 4}}};
  const Mesh mesh = to_mesh(contour);
  const auto back = to_contour<3>(mesh);
  EXPECT_EQ(back.vertices[2], (std::array<double, 3>{6, 7, 8.5}));
  EXPECT_TRUE(back.simplices == contour.simplices);
  ASSERT_EQ(back.normals.size(), 3U);
  EXPECT_EQ(back.normals[2], (std::array<double, 3>{0, 0, -1}));
  EXPECT_EQ(back.axis_names, contour.axis_names);
  expect_same(back.vertex_attributes, contour.vertex_attributes);
  expect_same(back.simplex_attributes, contour.simplex_attributes);
  EXPECT_EQ(back.axis_units, contour.axis_units);
  expect_error(ErrorCode::UnsupportedData, {"2-simplices in 3-space; expected 3-simplices in 4-space"},
               [&] { to_contour<4>(to_mesh(contour)); });
}

TEST(Mesh, ContoursTakeTheMemoryOfAMeshOver) {
  Contour<3, double> contour;
  contour.vertices = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8.5}};
  contour.simplices = {{0, 1, 2}, {2, 1, 0}};
  contour.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  contour.vertex_attributes = {{"age", "s", 1, {1, 2, 3}}};
  const Contour<3, double> copy = contour;
  const auto* const vertices = contour.vertices.data();
  const auto* const simplices = contour.simplices.data();
  Mesh mesh = to_mesh(std::move(contour));
  // Numbers that a reader has put into the array are copied.
  mesh.normals = Buffer<double>{1, 0, 0, 0, 1, 0, 0, 0, -1};
  const double* const ages = mesh.vertex_attributes[0].values.data();
  const auto back = to_contour<3>(std::move(mesh));
  EXPECT_EQ(back.vertices.data(), vertices);
  EXPECT_EQ(back.simplices.data(), simplices);
  EXPECT_EQ(back.vertex_attributes[0].values.data(), ages);
  EXPECT_TRUE(back.vertices == copy.vertices);
  EXPECT_TRUE(back.simplices == copy.simplices);
  EXPECT_TRUE(back.normals == copy.normals);
}

TEST(Mesh, PlanarSegmentsOfOtherProgramsAreTwoDimensionalContours) {
  Mesh mesh = random_mesh(1, 3, 4, 3, 5);
  for (std::size_t v = 0; v < 4; ++v) mesh.coordinates[3 * v + 2] = 0;
  EXPECT_EQ(to_contour<2>(mesh).vertices[1][0], mesh.coordinates[3]);
  EXPECT_TRUE(to_contour<2>(Mesh(mesh)).vertices == to_contour<2>(mesh).vertices);
  mesh.coordinates[5] = 0.5;
  expect_error(ErrorCode::UnsupportedData, {"vertex 1 with z = 0.5"}, [&] { to_contour<2>(mesh); });
}

TEST(Mesh, AssimpReadsOurGltfAndPly) {
  const Mesh mesh = random_mesh(2, 3, 300, 500, 3);
  for (const char* name : {"a.gltf", "a.glb", "a.ply"}) {
    SCOPED_TRACE(name);
    TempDir dir;
    write_mesh(mesh, dir / name);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile((dir / name).string(), 0);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    ASSERT_EQ(scene->mNumMeshes, 1U);
    const aiMesh& part = *scene->mMeshes[0];
    ASSERT_EQ(part.mNumFaces, 500U);
    for (unsigned f = 0; f < part.mNumFaces; ++f)
      for (unsigned c = 0; c < 3; ++c) {
        const aiVector3D& at = part.mVertices[part.mFaces[f].mIndices[c]];
        const std::size_t v = mesh.simplices[3 * f + c];
        ASSERT_EQ(at.x, static_cast<float>(mesh.coordinates[3 * v])) << f;
        ASSERT_EQ(at.z, static_cast<float>(mesh.coordinates[3 * v + 2])) << f;
      }
  }
}

TEST(Mesh, AssimpReadsOurLines) {
  TempDir dir;
  write_mesh(random_mesh(1, 2, 30, 50, 3), dir / "a.glb");
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile((dir / "a.glb").string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  EXPECT_EQ(scene->mMeshes[0]->mNumFaces, 50U);
  EXPECT_EQ(scene->mMeshes[0]->mPrimitiveTypes, static_cast<unsigned>(aiPrimitiveType_LINE));
}

TEST(Mesh, GltfStatesWhatTheSpecificationAsks) {
  TempDir dir;
  const Mesh mesh = random_mesh(2, 3, 10, 4, 9);
  write_mesh(mesh, dir / "a.gltf");
  const auto json = nlohmann::json::parse(read_file(dir / "a.gltf"));
  EXPECT_EQ(json["asset"]["version"], "2.0");
  const auto& position = json["accessors"][0];
  EXPECT_EQ(position["count"], 10);
  double low = 1e9;
  for (std::size_t v = 0; v < 10; ++v) low = std::min<double>(low, static_cast<float>(mesh.coordinates[3 * v + 1]));
  EXPECT_EQ(position["min"][1].get<double>(), low);
  EXPECT_EQ(json["accessors"][1]["count"], 12);
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["mode"], 4);
  // A .glb consists of a header and chunks, each a multiple of 4 bytes long.
  write_mesh(mesh, dir / "a.glb");
  const std::string glb = read_file(dir / "a.glb");
  std::uint32_t total = 0;
  std::memcpy(&total, &glb[8], 4);
  EXPECT_EQ(total, glb.size());
  EXPECT_EQ(glb.size() % 4, 0U);
}

TEST(Mesh, ReadsPlyOfOtherPrograms) {
  TempDir dir;
  const std::string vertices = "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0.5 255\n";
  write_file(
      dir / "a.ply",
      "ply\r\nformat ascii 1.0\r\ncomment made elsewhere\r\nobj_info none\r\nelement vertex 4\r\nproperty float x\r\n"
      "property float y\r\nproperty float z\r\nproperty uchar red\r\nelement material 1\r\nproperty list uchar "
      "float shininess\r\nelement face 2\r\nproperty list uchar int vertex_index\r\nproperty int flag\r\n"
      "end_header\r\n" +
          vertices + "2 0.5 0.25\n4 0 1 2 3 7\n3 0 2 1 8\n");
  const Mesh mesh = read_mesh(dir / "a.ply");
  EXPECT_EQ(mesh.dim, 2);
  EXPECT_EQ(mesh.coordinates[11], 0.5);
  EXPECT_EQ((std::vector<Index>(mesh.simplices.begin(), mesh.simplices.end())),
            (std::vector<Index>{0, 1, 2, 0, 2, 3, 0, 2, 1}));
  // Other properties become attributes; a polygon's value is copied to all of its triangles.
  expect_same(mesh.vertex_attributes, {{"red", "", 1, {255, 255, 255, 255}}});
  expect_same(mesh.simplex_attributes, {{"flag", "", 1, {7, 7, 8}}});
  // Big-endian, preceded by an element to be skipped.
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement extra 1\nproperty list int double list\nelement vertex 2\n"
      "property short x\nproperty double y\nproperty float z\nelement edge 1\nproperty int vertex1\n"
      "property int vertex2\nend_header\n";
  bytes += std::string({0, 0, 0, 1}) + std::string(8, '\x7f');
  for (const char x : {'\x03', '\x04'})
    bytes += std::string({0, x, 0x40, 0, 0, 0, 0, 0, 0, 0, 0x3f, static_cast<char>(0x80), 0, 0});
  bytes += std::string({0, 0, 0, 1, 0, 0, 0, 0});
  write_file(dir / "b.ply", bytes);
  const Mesh edges = read_mesh(dir / "b.ply");
  EXPECT_EQ(edges.dim, 1);
  EXPECT_THAT(std::vector<double>(edges.coordinates.begin(), edges.coordinates.end()),
              testing::ElementsAre(3, 2, 1, 4, 2, 1));
  EXPECT_THAT(std::vector<Index>(edges.simplices.begin(), edges.simplices.end()), testing::ElementsAre(1, 0));
}

TEST(Mesh, StlIsJoinedWhereCoordinatesAreEqual) {
  TempDir dir;
  std::string stl = "solid tetrahedron\n";
  const std::array<const char*, 4> corners = {"0 0 0", "1 0 0", "0 1 0", "0 0 1e-7"};
  for (const auto& face : {std::array<int, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int c : face) stl += std::string("vertex ") + corners[static_cast<std::size_t>(c)] + "\n";
    stl += "endloop\nendfacet\n";
  }
  write_file(dir / "a.stl", stl + "endsolid\n");
  const Mesh mesh = read_mesh(dir / "a.stl");
  EXPECT_EQ(mesh.coordinates.size(), 12U);
  EXPECT_EQ(mesh.simplices.size(), 12U);
}

TEST(Mesh, GltfNodesPlaceTheirMeshes) {
  TempDir dir;
  const Mesh mesh = random_mesh(2, 3, 3, 1, 9);
  write_mesh(mesh, dir / "a.gltf");
  auto json = nlohmann::json::parse(read_file(dir / "a.gltf"));
  json["nodes"] = {
      {{"children", {1, 2}}, {"translation", {10, 0, 0}}}, {{"mesh", 0}, {"scale", {2, 2, 2}}}, {{"mesh", 0}}};
  write_file(dir / "b.gltf", json.dump());
  const Mesh placed = read_mesh(dir / "b.gltf");
  ASSERT_EQ(placed.coordinates.size(), 18U);
  EXPECT_NEAR(placed.coordinates[0], 2 * mesh.coordinates[0] + 10, 1e-3);
  EXPECT_NEAR(placed.coordinates[9], mesh.coordinates[0] + 10, 1e-3);
  EXPECT_EQ(placed.simplices[3], placed.simplices[0] + 3);
  json["nodes"][1] = {{"children", {0}}};
  write_file(dir / "c.gltf", json.dump());
  expect_error(ErrorCode::MalformedFile, {"nodes that do not form a tree"}, [&] { read_mesh(dir / "c.gltf"); });
}

TEST(Mesh, CombinationsThatAFormatCannotHoldAreNamed) {
  TempDir dir;
  for (const char* name : {"a.ply", "a.glb", "a.gltf", "a.stl", "a.obj"})
    expect_error(ErrorCode::UnsupportedFormat,
                 {name, "tetrahedra in 4D space (the contour of a 4D image); expected .vtkhdf, or a slice of it"},
                 [&] { write_mesh(random_mesh(3, 4, 4, 1, 1), dir / name); });
  for (const int space_dim : {2, 3})
    expect_error(ErrorCode::UnsupportedFormat, {"a.stl", "segments, which lines are made of; expected .ply"},
                 [&] { write_mesh(random_mesh(1, space_dim, 3, 1, 1), dir / "a.stl"); });
  expect_error(ErrorCode::UnsupportedFormat, {"a.xyz", "'.xyz'; expected .ply"},
               [&] { write_mesh(random_mesh(2, 3, 3, 1, 1), dir / "a.xyz"); });
  expect_error(ErrorCode::UnsupportedFormat, {"noextension"},
               [&] { write_mesh(random_mesh(2, 3, 3, 1, 1), dir / "noextension"); });
  Mesh bad = random_mesh(2, 3, 3, 1, 1);
  bad.simplices[1] = 3;
  expect_error(ErrorCode::InvalidArgument, {"vertex number 3; expected less than 3"},
               [&] { write_mesh(bad, dir / "a.ply"); });
  Mesh huge = random_mesh(2, 3, 3, 1, 1);
  huge.coordinates[4] = 1e300;
  for (const char* name : {"a.glb", "a.stl"})
    expect_error(ErrorCode::UnsupportedData, {name, "vertex 1 has the coordinate 1e+300"},
                 [&] { write_mesh(huge, dir / name); });
  huge.coordinates[4] = std::nan("");
  expect_error(ErrorCode::UnsupportedData, {"vertex 1 has the coordinate nan; expected a finite number"},
               [&] { write_mesh(huge, dir / "a.obj"); });
  EXPECT_EQ(dir.files(), 0U);
}

TEST(Mesh, FailedWritingLeavesNothingAndKeepsTheOldFile) {
  TempDir dir;
  const Mesh mesh = random_mesh(2, 3, 1000, 2000, 1);
  for (const char* name : {"a.ply", "a.glb", "a.gltf", "a.vtkhdf", "a.stl", "a.obj"}) {
    SCOPED_TRACE(name);
    expect_error(ErrorCode::WriteFailed, {"nowhere", "No such file or directory"},
                 [&] { write_mesh(mesh, dir / "nowhere" / name); });
    write_file(dir / name, "old");
    int calls = 0;
    expect_error(ErrorCode::Cancelled, {name},
                 [&] { write_mesh(mesh, dir / name, {.work = {.progress = [&](double) { return ++calls < 2; }}}); });
    EXPECT_EQ(read_file(dir / name), "old");
    EXPECT_EQ(dir.files(), 1U);
    write_mesh(mesh, dir / name);
    EXPECT_EQ(dir.files(), 1U);
    const bool has_all = std::string(name) != "a.stl" && std::string(name) != "a.obj";
    if (has_all) expect_same(read_mesh(dir / name), name[2] == 'g' ? as_floats(mesh) : mesh);
    EXPECT_EQ(read_mesh(dir / name).simplices.size(), mesh.simplices.size());
    fs::remove(dir / name);
    fs::create_directory(dir / name);
    expect_error(ErrorCode::WriteFailed, {name, "is a directory"}, [&] { write_mesh(mesh, dir / name); });
    fs::remove(dir / name);
  }
}

/// Writes with a file size limit of 100 kB; exits with 7 if the error is reported correctly.
[[noreturn]] void exit_with_limited_files(const Mesh& mesh, const TempDir& dir, const std::string& name) {
  signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{100000, 100000};
  setrlimit(RLIMIT_FSIZE, &limit);
  try {
    write_mesh(mesh, dir / name);
  } catch (const Error& error) {
    const bool named = std::string(error.what()).find(name) != std::string::npos;
    _exit(error.code() == ErrorCode::WriteFailed && named && dir.files() == 0 ? 7 : 1);
  }
  _exit(2);
}

TEST(Mesh, FullDisksAreReported) {
  // A limit on file size simulates a full disk: the same errno path, without a mount.
  TempDir dir;
  const Mesh mesh = random_mesh(2, 3, 20000, 40000, 1);
  for (const char* name : {"a.ply", "a.glb", "a.gltf", "a.vtkhdf", "a.stl", "a.obj"})
    EXPECT_EXIT(exit_with_limited_files(mesh, dir, name), testing::ExitedWithCode(7), "") << name;
}

TEST(Mesh, LinksAreWrittenThrough) {
  TempDir dir;
  write_file(dir / "real.ply", "old");
  fs::create_symlink("real.ply", dir / "link.ply");
  const Mesh mesh = random_mesh(2, 3, 10, 20, 1);
  write_mesh(mesh, dir / "link.ply");
  EXPECT_TRUE(fs::is_symlink(dir / "link.ply"));
  expect_same(read_mesh(dir / "real.ply"), mesh);
}

}  // namespace
}  // namespace tegl::test
