// SPDX-License-Identifier: BSD-3-Clause
//
// Malicious mesh, HDF5 and DICOM files: small files that require much memory, time or stack, and files that refer to
// other files. Each is read in a child process and must be refused with an error that has the file and the value,
// within a second and within twice the memory of the file plus 64 MiB.
#include <hdf5.h>

#include <functional>
#include <numeric>

#include "hostile/refused_files.hpp"
#include "images/netcdf_files.hpp"
#include "io_support.hpp"
#include "process/limited_child.hpp"

namespace tegl::test {
namespace {

void as_mesh(const fs::path& path) { read_mesh(path); }
void as_image(const fs::path& path) { read_image(path); }
void as_layers(const fs::path& path) { open_layers(path); }

template <class T>
std::string raw(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

// --- glTF

/// A binary glTF file with these members of its JSON and these bytes.
std::string glb(std::string json, const std::string& bytes) {
  json = R"({"asset":{"version":"2.0"},)" + json + "}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  return "glTF" + raw<std::uint32_t>(2) + raw(static_cast<std::uint32_t>(28 + json.size() + bytes.size())) +
         raw(static_cast<std::uint32_t>(json.size())) + "JSON" + json + raw(static_cast<std::uint32_t>(bytes.size())) +
         std::string("BIN\0", 4) + bytes;
}

/// A JSON list of `count` equal items.
std::string list(const std::string& item, std::size_t count) {
  std::string result = repeated(item + ",", count);
  if (!result.empty()) result.pop_back();
  return "[" + result + "]";
}

/// `nodes` nodes of one mesh of `primitives` primitives with `points` points each.
std::string instances(std::size_t nodes, std::size_t primitives, std::size_t points) {
  const std::size_t bytes = 12 * points;
  std::string scene = "[0";
  for (std::size_t i = 1; i < nodes; ++i) scene += "," + std::to_string(i);
  const std::string size = std::to_string(bytes);
  return glb(R"("scenes":[{"nodes":)" + scene + R"(]}],"nodes":)" + list(R"({"mesh":0})", nodes) +
                 R"(,"meshes":[{"primitives":)" + list(R"({"attributes":{"POSITION":0}})", primitives) +
                 R"(}],"buffers":[{"byteLength":)" + size + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + size +
                 R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" + std::to_string(points) +
                 R"(,"type":"VEC3"}])",
             std::string(bytes, '\0'));
}

/// A triangle whose points are in the file of this URI.
std::string triangle_at(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{)"
         R"("attributes":{"POSITION":0}}]}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,)"
         R"("componentType":5126,"count":3,"type":"VEC3"}],"buffers":[{"byteLength":36,"uri":")" +
         uri + R"("}]})";
}

TEST(HostileMeshes, NestedJsonIsRefusedBeforeItIsParsed) {
  TempDir dir;
  const std::string start = R"({"asset":{"version":"2.0"},"extensionsRequired":)";
  write_file(dir / "extreq.gltf", start + std::string(100000, '[') + std::string(100000, ']') + "}");
  expect_file_refused(dir / "extreq.gltf", ErrorCode::MalformedFile, {"more than 256 deep"}, as_mesh);
  write_file(dir / "list.gltf", start + R"(["KHR_draco_mesh_compression",[[]]]})");
  expect_file_refused(dir / "list.gltf", ErrorCode::MalformedFile, {"'extensionsRequired'", "not text"}, as_mesh);
  write_file(dir / "many.gltf", start + list(R"("KHR_draco_mesh_compression")", 10000) + "}");
  expect_file_refused(dir / "many.gltf", ErrorCode::UnsupportedData,
                      {"10000 extensions", "'KHR_draco_mesh_compression'", "expected none"}, as_mesh);
  // Brackets inside strings do not count.
  write_file(dir / "text.gltf", R"({"x":")" + std::string(1000, '[') + R"(\"{","asset":{"version":"1.0"}})");
  expect_file_refused(dir / "text.gltf", ErrorCode::MalformedFile, {"asset.version"}, as_mesh);
}

TEST(HostileMeshes, BuffersOfTheSameBytesShareThem) {
  TempDir dir;
  const std::string all = R"("buffers":)" + list(R"({"byteLength":1})", 5000);
  write_file(dir / "buffers.glb", glb(all, std::string(1000000, '\0')));
  expect_file_refused(dir / "buffers.glb", ErrorCode::MalformedFile, {"no scene"}, as_mesh);
  // A file that is named repeatedly, in different ways, is read once.
  write_file(dir / "b.bin", std::string(std::size_t{10} << 20, '\0'));
  write_file(dir / "files.gltf", R"({"asset":{"version":"2.0"},"buffers":)" +
                                     list(R"({"byteLength":1,"uri":"b.bin"},{"byteLength":1,"uri":"./b.bin"})", 500) +
                                     "}");
  expect_file_refused(dir / "files.gltf", ErrorCode::MalformedFile, {"no scene"}, as_mesh);
}

TEST(HostileMeshes, InstancesAreCountedBeforeTheyAreMade) {
  TempDir dir;
  write_file(dir / "instances.glb", instances(500, 500, 3000));
  expect_file_refused(dir / "instances.glb", ErrorCode::TooLarge, {"750000000 vertices", "expected at most"}, as_mesh);
  // Primitives without points take time.
  write_file(dir / "empty.glb", instances(20000, 20000, 0));
  expect_file_refused(dir / "empty.glb", ErrorCode::TooLarge,
                      {"400000000 primitives with 0 vertices", "expected at most"}, as_mesh);
  write_file(dir / "few.glb", instances(10, 10, 3));
  EXPECT_EQ(read_mesh(dir / "few.glb").coordinates.size(), 900U);
}

TEST(HostileMeshes, AttributesWithManyNamesTakeLinearTime) {
  TempDir dir;
  std::string attributes = R"("POSITION":0)";
  std::string texts;
  for (int i = 0; i < 30000; ++i) {
    attributes += R"(,"_A)" + std::to_string(i) + R"(":1)";
    texts += (i == 0 ? "" : ",") + (R"({"semantic":"_A)" + std::to_string(i)) + R"(","name":"same"})";
  }
  write_file(dir / "names.glb",
             glb(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{)" +
                     attributes + R"(}}],"extras":{"tegl":{"attributes":[)" + texts +
                     R"(]}}}],"buffers":[{"byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
                     R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
                     R"({"bufferView":0,"componentType":5126,"count":3,"type":"SCALAR"}])",
                 std::string(36, '\0')));
  const double before = seconds_of_children();
  const ChildResult result = in_limited_child([&] {
    const Mesh mesh = read_mesh(dir / "names.glb");
    throw Error(ErrorCode::Cancelled,
                std::to_string(mesh.vertex_attributes.size()) + " " + mesh.vertex_attributes.at(29999).name);
  });
  EXPECT_EQ(result.signal, 0);
  EXPECT_EQ(result.message, "30000 same_30000");
  EXPECT_LT(seconds_of_children() - before, kMostSeconds);
}

TEST(HostileMeshes, UrisAreDecodedAndKeptInTheFolder) {
  TempDir dir;
  fs::create_directories(dir / "meshes/sub folder");
  const std::string points = bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  for (const char* const name : {"outside.bin", "meshes/100%25.bin", "meshes/sub folder/a b.bin"})
    write_file(dir / name, points);
  fs::create_symlink("../outside.bin", dir / "meshes/link.bin");
  fs::create_symlink("sub folder", dir / "meshes/inner");
  const fs::path path = dir / "meshes/a.gltf";
  for (const std::string uri : {"sub%20folder/a%20b.bin", "sub folder/a b.bin", "sub%20folder/../inner/a%20b.bin",
                                "../meshes/sub%20folder/a b.bin", "100%2525.bin"}) {
    SCOPED_TRACE(uri);
    write_file(path, triangle_at(uri));
    EXPECT_EQ(read_mesh(path).simplices.size(), 3U);
  }
  const std::string folder = fs::canonical(dir / "meshes").string();
  for (const std::string& uri : {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"),
                                 std::string("link.bin"), (dir / "outside.bin").string()}) {
    SCOPED_TRACE(uri);
    write_file(path, triangle_at(uri));
    expect_error(ErrorCode::UnsupportedData,
                 {path.string(), fs::canonical(dir / "outside.bin").string(), folder, "allow_outside_paths"},
                 [&] { read_mesh(path); });
    ReadMeshOptions options;
    options.allow_outside_paths = true;
    EXPECT_EQ(read_mesh(path, options).simplices.size(), 3U);
  }
  for (const std::string uri : {"http://localhost/a.bin", "file:///etc/passwd"}) {
    write_file(path, triangle_at(uri));
    expect_error(ErrorCode::UnsupportedData, {"a.gltf", "expected a relative path"}, [&] { read_mesh(path); });
  }
  write_file(path, triangle_at("a\\u0000b"));
  expect_error(ErrorCode::MalformedFile, {"a.gltf", "'a\\x00b'"}, [&] { read_mesh(path); });
}

// --- PLY

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "property list uchar int vertex_indices\n";

TEST(HostileMeshes, RepeatedNamesOfPlyAreRefused) {
  TempDir dir;
  write_file(dir / "props.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + kXyz + "element face 0\n" + kFaces +
                                    repeated("property uchar a\n", 30000) + "end_header\n0 0 0\n1 0 0\n0 1 0\n");
  expect_file_refused(dir / "props.ply", ErrorCode::MalformedFile, {"two properties 'a' of element 'face'"}, as_mesh);
  write_file(dir / "two_vertex.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + kXyz +
                                         "property float nx\nproperty float ny\nproperty float nz\nelement vertex 3\n" +
                                         kXyz + "element face 1\n" + kFaces +
                                         "end_header\n0 0 0 0 0 1\n0 0 0\n1 0 0\n0 1 1\n3 0 1 2\n");
  expect_file_refused(dir / "two_vertex.ply", ErrorCode::MalformedFile, {"two elements 'vertex'", "expected"}, as_mesh);
}

TEST(HostileMeshes, EqualNamesOfAttributesAreNumberedInLinearTime) {
  TempDir dir;
  std::string header = "ply\nformat ascii 1.0\n";
  std::string properties;
  for (int i = 0; i < 30000; ++i) {
    header += "comment tegl vertex attribute p" + std::to_string(i) + " 1 same\n";
    properties += "property uchar p" + std::to_string(i) + "\n";
  }
  write_file(dir / "same.ply",
             header + "element vertex 0\n" + kXyz + properties + "element face 0\n" + kFaces + "end_header\n");
  const double before = seconds_of_children();
  const ChildResult result = in_limited_child(
      [&] { throw Error(ErrorCode::Cancelled, read_mesh(dir / "same.ply").vertex_attributes.back().name); });
  EXPECT_EQ(result.message, "same_30000");
  EXPECT_LT(seconds_of_children() - before, kMostSeconds);
}

TEST(HostileMeshes, AttributesOfPolygonsAreNotCopiedWithoutLimit) {
  TempDir dir;
  std::string properties;
  for (int i = 0; i < 5000; ++i) properties += "property uchar p" + std::to_string(i) + "\n";
  const std::uint32_t corners = 200000;
  write_file(dir / "fan.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + kXyz +
                                  "element face 1\nproperty list uint uchar vertex_indices\n" + properties +
                                  "end_header\n" + std::string(12, '\0') + raw(corners) + std::string(corners, '\0') +
                                  std::string(5000, '\0'));
  expect_file_refused(dir / "fan.ply", ErrorCode::TooLarge,
                      {"attributes of the triangles of polygons", "expected at most"}, as_mesh);
}

TEST(HostileMeshes, CountsOfPlyGetNoMemoryThatTheFileCannotFill) {
  TempDir dir;
  // 20 million faces without corners, one byte each.
  std::string file = "ply\nformat binary_little_endian 1.0\nelement vertex 0\n" + kXyz + "element face 20000000\n" +
                     kFaces + "end_header\n" + std::string(20000000, '\0');
  write_file(dir / "faces.ply", file);
  expect_file_refused(dir / "faces.ply", ErrorCode::MalformedFile, {"face 0 of 0 vertices"}, as_mesh);
}

// --- STL

TEST(HostileMeshes, StlIsReadInLinearMemory) {
  TempDir dir;
  write_file(dir / "solids.stl", repeated("solid\n", 200000));
  expect_file_refused(dir / "solids.stl", ErrorCode::UnsupportedData, {"no triangles"}, as_mesh);
  write_file(dir / "count.stl", std::string(80, 'x') + raw<std::uint32_t>(0xffffffff) + std::string(50, '\0'));
  expect_file_refused(dir / "count.stl", ErrorCode::MalformedFile, {"4294967295 triangles", "expected at most 1"},
                      as_mesh);
}

TEST(HostileMeshes, TextOfStlIsReadByItsWords) {
  TempDir dir;
  const std::string start = "solid a b\nFACET normal 0 0 nan outer loop vertex 0 0 0 vertex +1 0 -0 vertex 0 1e0 0\n";
  const std::string end = "endloop endfacet\n endsolid a b";
  write_file(dir / "a.stl", start + end + "\n" + start + end);
  const Mesh mesh = read_mesh(dir / "a.stl");
  EXPECT_EQ(mesh.simplices.size(), 6U);
  EXPECT_EQ(mesh.coordinates.size(), 9U);
  const auto expect = [&](const std::string& text, const std::string& part) {
    write_file(dir / "a.stl", text);
    expect_error(ErrorCode::MalformedFile, {"a.stl", part}, [&] { read_mesh(dir / "a.stl"); });
  };
  expect(start + "vertex 0 0 1 " + end, "facet 0 of 4 vertices; expected 3");
  expect(start + "endfacet facet vertex 0 0 1 " + end, "facet 1 of 1 vertices; expected 3");
  expect(start, "facet 0 without 'endfacet'");
  expect("solid\nendfacet", "facet 0 of 0 vertices; expected 3");
  expect("solid\nfacet vertex 0 0 1e39", "'1e39' in facet 0");
  expect("solid\nfacet vertex 0 0", "'' in facet 0");
  expect("solid\nfacet vertez 0 0", "'vertez' after facet 0");
  expect("triangles", "9 bytes that do not begin with 'solid'");
}

// --- HDF5

/// Closes an HDF5 handle.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) { EXPECT_GE(id, 0); }
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor)

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// A VTKHDF file with a triangle, to which the test adds more; without points if these are to be in another file.
class TriangleFile {
 public:
  explicit TriangleFile(const fs::path& path, bool with_points = true) {
    Mesh mesh;
    for (const double x : {0, 0, 0, 1, 0, 0, 0, 1, 0}) mesh.coordinates.push_back(x);
    for (const Index i : {0U, 1U, 2U}) mesh.simplices.push_back(i);
    mesh.vertex_attributes.push_back({"a", "", 1, {1, 2, 3}});
    write_mesh(mesh, path);
    file_ = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    EXPECT_GE(file_, 0);
    if (!with_points) {
      EXPECT_GE(H5Ldelete(file_, "VTKHDF/Points", H5P_DEFAULT), 0);
    }
  }
  ~TriangleFile() { H5Fclose(file_); }
  TriangleFile(const TriangleFile&) = delete;
  TriangleFile& operator=(const TriangleFile&) = delete;
  [[nodiscard]] hid_t id() const { return file_; }
  /// A dataset of doubles with these creation properties.
  void add(const char* name, const std::vector<hsize_t>& size, hid_t properties, const double* values) const {
    const Id space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Id dataset(H5Dcreate2(file_, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
    if (values != nullptr) {
      EXPECT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0);
    }
  }

 private:
  hid_t file_;
};

constexpr std::array<double, 9> kPoints = {0, 0, 0, 1, 0, 0, 0, 1, 0};

TEST(HostileMeshes, DatasetsOfHdf5AreBoundedByWhatTheFileStores) {
  TempDir dir;
  {
    const TriangleFile file(dir / "links.vtkhdf");  // one array under many names
    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const std::vector<double> values(3 * 1000, 1.0);
    file.add("VTKHDF/PointData/wide", {3, 1000}, properties, values.data());
    for (int i = 0; i < 2000; ++i)
      H5Lcreate_hard(file.id(), "VTKHDF/PointData/wide", file.id(), ("VTKHDF/PointData/w" + std::to_string(i)).c_str(),
                     H5P_DEFAULT, H5P_DEFAULT);
  }
  expect_file_refused(dir / "links.vtkhdf", ErrorCode::MalformedFile, {"of which the file stores", "expected at most"},
                      as_mesh);
  {
    const TriangleFile file(dir / "unwritten.vtkhdf");  // arrays declared in the file but not stored
    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    for (int i = 0; i < 100; ++i)
      file.add(("VTKHDF/PointData/w" + std::to_string(i)).c_str(), {3, 60000}, properties, nullptr);
  }
  expect_file_refused(dir / "unwritten.vtkhdf", ErrorCode::MalformedFile,
                      {"'w0'", "3 x 60000", "1440000 bytes", "stores 0"}, as_mesh);
}

TEST(HostileMeshes, ChunksOfHdf5AreBoundedByTheirDataset) {
  TempDir dir;
  const auto write = [&](const char* name, hsize_t chunk_rows) {
    const TriangleFile file(dir / name, false);
    const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const std::array<hsize_t, 2> size{3, 3};
    const std::array<hsize_t, 2> most{H5S_UNLIMITED, 3};
    const std::array<hsize_t, 2> chunk{chunk_rows, 3};
    H5Pset_chunk(properties, 2, chunk.data());
    H5Pset_deflate(properties, 1);
    const Id space(H5Screate_simple(2, size.data(), most.data()), H5Sclose);
    const Id dataset(
        H5Dcreate2(file.id(), "VTKHDF/Points", H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
    EXPECT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, kPoints.data()), 0);
  };
  write("small.vtkhdf", 1000);
  EXPECT_EQ(read_mesh(dir / "small.vtkhdf").coordinates.size(), 9U);
  write("large.vtkhdf", 2000000);
  expect_file_refused(dir / "large.vtkhdf", ErrorCode::MalformedFile,
                      {"'Points'", "chunks of 48000000", "at most 16777216"}, as_mesh);
}

TEST(HostileMeshes, ChunksOfNetcdfAreBoundedByTheirVariable) {
  TempDir dir;
  {
    NcWriter file(dir / "chunk.nc", NC_NETCDF4);
    const int t = file.dimension("t", NC_UNLIMITED);
    const int y = file.dimension("y", 4);
    const int x = file.dimension("x", 4);
    const int v = file.variable("v", NC_FLOAT, {t, y, x});
    const std::array<std::size_t, 3> chunk{std::size_t{1} << 20, 4, 4};
    NcWriter::ok(nc_def_var_chunking(file.id(), v, NC_CHUNKED, chunk.data()));
    NcWriter::ok(nc_def_var_deflate(file.id(), v, 0, 1, 1));
    file.end();
    file.values(v, {4, 4, 4}, counting<double>(64));
  }
  const std::vector<std::string> parts = {"'v' of 256 bytes", "1048576 x 4 x 4", "67108864 bytes", "at most 16777216"};
  expect_file_refused(dir / "chunk.nc", ErrorCode::MalformedFile, parts, as_image);
  expect_file_refused(dir / "chunk.nc", ErrorCode::MalformedFile, parts, as_layers);
}

TEST(HostileMeshes, ChunksOfNetcdfAreNoMoreThanTheFileHolds) {
  TempDir dir;
  {
    NcWriter file(dir / "count.nc", NC_NETCDF4);
    const int v = file.variable("v", NC_UBYTE, {file.dimension("y", 5000), file.dimension("x", 2)});
    const std::array<std::size_t, 2> chunk{1, 1};
    NcWriter::ok(nc_def_var_chunking(file.id(), v, NC_CHUNKED, chunk.data()));
    file.end();
  }
  const std::vector<std::string> parts = {"'v' has 10000 chunks of 1 x 1", "expected at most 4096"};
  expect_file_refused(dir / "count.nc", ErrorCode::MalformedFile, parts, as_image);
  expect_file_refused(dir / "count.nc", ErrorCode::MalformedFile, parts, as_layers);
}

TEST(HostileMeshes, GroupsOfHdf5AreNotNestedDeeply) {
  TempDir dir;
  {
    const Id file(H5Fcreate((dir / "deep.nc").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    hid_t group = H5Gopen2(file, "/", H5P_DEFAULT);
    for (int i = 0; i < 5000; ++i) {
      const hid_t inner = H5Gcreate2(group, "g", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      H5Gclose(group);
      group = inner;
    }
    H5Gclose(group);
  }
  expect_file_refused(dir / "deep.nc", ErrorCode::MalformedFile, {"groups nested deeper than 32"}, as_image);
}

TEST(HostileMeshes, GroupsThatAreNoTreeAreRefusedBeforeNetCdfFollowsThem) {
  for (const bool soft : {false, true}) {
    TempDir dir;
    {
      const Id file(H5Fcreate((dir / "loop.nc").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
      const Id group(H5Gcreate2(file, "a", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
      if (soft)
        H5Lcreate_soft("/", group, "b", H5P_DEFAULT, H5P_DEFAULT);
      else
        H5Lcreate_hard(file, "/", group, "b", H5P_DEFAULT, H5P_DEFAULT);
    }
    expect_file_refused(dir / "loop.nc", ErrorCode::MalformedFile, {"two links lead to the group", "form a tree"},
                        as_image);
  }
}

/// VTKHDF files whose points are in another file, for each mechanism of HDF5.
struct PointsElsewhere {
  const char* way;
  std::function<void(const fs::path& path, const std::string& other)> write;
};

void write_points(const fs::path& path) {
  const Id file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  const std::array<hsize_t, 2> size{3, 3};
  const Id space(H5Screate_simple(2, size.data(), nullptr), H5Sclose);
  const Id dataset(H5Dcreate2(file, "p", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  EXPECT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, kPoints.data()), 0);
}

void link_points(const fs::path& path, const std::string& other) {
  const TriangleFile file(path, false);
  EXPECT_GE(H5Lcreate_external(other.c_str(), "/p", file.id(), "VTKHDF/Points", H5P_DEFAULT, H5P_DEFAULT), 0);
}

void view_points(const fs::path& path, const std::string& other) {
  const TriangleFile file(path, false);
  const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const std::array<hsize_t, 2> size{3, 3};
  const Id space(H5Screate_simple(2, size.data(), nullptr), H5Sclose);
  EXPECT_GE(H5Pset_virtual(properties, space, other.c_str(), "/p", space), 0);
  file.add("VTKHDF/Points", {3, 3}, properties, nullptr);
}

void store_points(const fs::path& path, const std::string& other) {
  const TriangleFile file(path, false);
  const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  EXPECT_GE(H5Pset_external(properties, other.c_str(), 0, sizeof(kPoints)), 0);
  file.add("VTKHDF/Points", {3, 3}, properties, nullptr);
}

/// Maps each row to a file of its own, with its number in the name.
void view_blocks(const fs::path& path, const std::string& other) {
  const TriangleFile file(path, false);
  const Id properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const std::array<hsize_t, 2> size{3, 3}, most{H5S_UNLIMITED, 3}, row{1, 3}, start{0, 0}, rows{H5S_UNLIMITED, 1};
  const Id space(H5Screate_simple(2, size.data(), most.data()), H5Sclose);
  const Id source(H5Screate_simple(2, row.data(), nullptr), H5Sclose);
  EXPECT_GE(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), row.data(), rows.data(), row.data()), 0);
  EXPECT_GE(H5Pset_virtual(properties, space, other.c_str(), "/p", source), 0);
  const Id dataset(H5Dcreate2(file.id(), "VTKHDF/Points", H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                   H5Dclose);
}

TEST(HostileMeshes, Hdf5LeadsToFilesInItsFolderOnly) {
  TempDir dir;
  fs::create_directories(dir / "meshes/sub");
  const fs::path path = dir / "meshes/a.vtkhdf";
  const std::string bytes(reinterpret_cast<const char*>(kPoints.data()), sizeof(kPoints));
  for (const char* const folder : {"", "meshes/sub/"}) {
    write_points(dir / (std::string(folder) + "points.h5"));
    write_file(dir / (std::string(folder) + "points.raw"), bytes);
  }
  const std::vector<PointsElsewhere> ways = {
      {"points.h5", link_points}, {"points.h5", view_points}, {"points.raw", store_points}};
  for (std::size_t i = 0; i < ways.size(); ++i) {
    SCOPED_TRACE(i);
    ways[i].write(path, std::string("sub/") + ways[i].way);
    const Mesh inside = read_mesh(path);
    EXPECT_TRUE(std::equal(kPoints.begin(), kPoints.end(), inside.coordinates.begin(), inside.coordinates.end()));
    const std::string outside = fs::canonical(dir / ways[i].way).string();
    for (const std::string& other : {std::string("../") + ways[i].way, outside}) {
      ways[i].write(path, other);
      expect_error(ErrorCode::UnsupportedData, {path.string(), outside, "allow_outside_paths"},
                   [&] { read_mesh(path); });
      ReadMeshOptions options;
      options.allow_outside_paths = true;
      const Mesh mesh = read_mesh(path, options);
      EXPECT_TRUE(std::equal(kPoints.begin(), kPoints.end(), mesh.coordinates.begin(), mesh.coordinates.end()));
    }
  }
  link_points(path, "nowhere.h5");  // HDF5 also searches the current folder
  expect_error(ErrorCode::UnsupportedData, {path.string(), "'nowhere.h5', which does not exist"},
               [&] { read_mesh(path); });
  view_blocks(path, "points%b.h5");
  expect_error(ErrorCode::UnsupportedData, {path.string(), "points%b.h5"}, [&] { read_mesh(path); });
}

TEST(HostileMeshes, Hdf5FilesThatAreNamedAreCheckedAsWell) {
  TempDir dir;
  fs::create_directories(dir / "meshes");
  write_points(dir / "points.h5");
  {
    const Id file(H5Fcreate((dir / "meshes/step.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    EXPECT_GE(H5Lcreate_external("../points.h5", "/p", file, "p", H5P_DEFAULT, H5P_DEFAULT), 0);
  }
  link_points(dir / "meshes/a.vtkhdf", "step.h5");
  expect_error(ErrorCode::UnsupportedData, {"points.h5", "allow_outside_paths"},
               [&] { read_mesh(dir / "meshes/a.vtkhdf"); });
}

TEST(HostileMeshes, NetcdfLeadsToFilesInItsFolderOnly) {
  TempDir dir;
  fs::create_directories(dir / "images");
  write_points(dir / "points.h5");
  const auto write = [&](const fs::path& path, const std::string& other) {
    {
      NcWriter file(path, NC_NETCDF4);
      const int y = file.dimension("y", 2);
      const int x = file.dimension("x", 2);
      const int v = file.variable("v", NC_FLOAT, {y, x});
      file.end();
      file.values(v, {1, 2, 3, 4});
    }
    const Id file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    EXPECT_GE(H5Lcreate_external(other.c_str(), "/p", file, "other", H5P_DEFAULT, H5P_DEFAULT), 0);
  };
  const fs::path path = dir / "images/a.nc";
  write(path, "../points.h5");
  for (const Read& read : {Read(as_image), Read(as_layers)})
    expect_error(ErrorCode::UnsupportedData, {path.string(), fs::canonical(dir / "points.h5").string()},
                 [&] { read(path); });
  write(path, fs::canonical(dir / "points.h5").string());
  write_file(dir / "images/a.nc.gz", compressed(read_file(path)));
  expect_error(ErrorCode::UnsupportedData, {"a.nc.gz", fs::canonical(dir / "points.h5").string()},
               [&] { read_image(dir / "images/a.nc.gz"); });
  write_points(dir / "images/points.h5");
  write(path, "points.h5");
  read_image(path, {"v", {}});
}

// --- DICOM

/// A DICOM element with a type of short or long length field.
std::string element(std::uint16_t group, std::uint16_t number, const std::string& type, const std::string& value) {
  return raw(group) + raw(number) + type + raw(static_cast<std::uint16_t>(value.size())) + value;
}
constexpr std::uint32_t kUndefined = 0xffffffff;
std::string item(std::uint32_t length) { return raw<std::uint16_t>(0xfffe) + raw<std::uint16_t>(0xe000) + raw(length); }
const std::string kItemEnd = raw<std::uint16_t>(0xfffe) + raw<std::uint16_t>(0xe00d) + raw<std::uint32_t>(0);
const std::string kSequenceEnd = raw<std::uint16_t>(0xfffe) + raw<std::uint16_t>(0xe0dd) + raw<std::uint32_t>(0);

enum class Syntax { implicit_little, explicit_little, explicit_big, deflated };

std::string sequence(Syntax syntax, const std::string& type, std::uint32_t length) {
  const std::string tag = raw<std::uint16_t>(0x0040) + raw<std::uint16_t>(0x0275);
  if (syntax == Syntax::implicit_little) return tag + raw(length);
  return tag + type + std::string(2, '\0') + raw(length);
}

/// Nested sequences, with lengths or with end marks.
std::string nested(Syntax syntax, int depth, bool with_lengths, const std::string& type) {
  const Syntax inner = type == "UN" ? Syntax::implicit_little : syntax;
  std::string body;
  for (int i = 0; i < depth; ++i) {
    const Syntax here = i + 1 == depth ? syntax : inner;
    const auto length = static_cast<std::uint32_t>(body.size());
    body = with_lengths ? sequence(here, type, length + 8) + item(length) + body
                        : sequence(here, type, kUndefined) + item(kUndefined) + body + kItemEnd + kSequenceEnd;
  }
  return body;
}

/// Raw deflate data without a frame.
std::string deflated(const std::string& bytes) {
  const std::string framed = compressed(bytes, true);
  return framed.substr(2, framed.size() - 6);
}

std::string dicom(Syntax syntax, const std::string& data) {
  const std::string uid = syntax == Syntax::implicit_little   ? "1.2.840.10008.1.2"
                          : syntax == Syntax::explicit_little ? "1.2.840.10008.1.2.1"
                          : syntax == Syntax::explicit_big    ? "1.2.840.10008.1.2.2"
                                                              : "1.2.840.10008.1.2.1.99";
  const std::string meta = element(2, 0x10, "UI", uid + std::string(uid.size() % 2, '\0'));
  return std::string(128, '\0') + "DICM" + element(2, 0, "UL", raw(static_cast<std::uint32_t>(meta.size()))) + meta +
         (syntax == Syntax::deflated ? deflated(data) : data);
}

/// Converts the output of `nested` to big endian: swaps bytes of two-byte and four-byte numbers.
std::string as_big_endian(const std::string& bytes) {
  std::string result = bytes;
  for (std::size_t at = 0; at + 8 <= result.size();) {
    const bool is_item = static_cast<unsigned char>(result[at]) == 0xfe;
    std::swap(result[at], result[at + 1]);
    std::swap(result[at + 2], result[at + 3]);
    const std::size_t length = at + (is_item ? 4 : 8);
    std::reverse(result.begin() + static_cast<std::ptrdiff_t>(length),
                 result.begin() + static_cast<std::ptrdiff_t>(length + 4));
    at = length + 4;
  }
  return result;
}

TEST(HostileMeshes, SequencesOfDicomAreNotNestedDeeply) {
  TempDir dir;
  write_file(dir / "none.dcm", dicom(Syntax::explicit_little, ""));
  if (error_of([&] { read_image(dir / "none.dcm"); }).code() == ErrorCode::UnsupportedFormat)
    GTEST_SKIP() << "built without DICOM";
  for (const Syntax syntax : {Syntax::implicit_little, Syntax::explicit_little, Syntax::explicit_big, Syntax::deflated})
    for (const bool with_lengths : {true, false})
      for (const std::string type : {"SQ", "UN"}) {
        if (type == "UN" && (syntax == Syntax::implicit_little || syntax == Syntax::explicit_big)) continue;
        SCOPED_TRACE(static_cast<int>(syntax));
        SCOPED_TRACE(type + (with_lengths ? " with lengths" : " with end marks"));
        const auto data = [&](int depth) {
          const std::string body = nested(syntax, depth, with_lengths, type);
          return syntax == Syntax::explicit_big ? as_big_endian(body) : body;
        };
        write_file(dir / "deep.dcm", dicom(syntax, data(with_lengths ? 2000 : 10000)));
        expect_file_refused(dir / "deep.dcm", ErrorCode::MalformedFile,
                            {"nested deeper than 64", "expected at most 64"}, as_image);
        write_file(dir / "flat.dcm", dicom(syntax, data(60)));
        EXPECT_THAT(error_of([&] { read_image(dir / "flat.dcm"); }).what(), testing::Not(testing::HasSubstr("nested")));
      }
}

TEST(HostileMeshes, ManyItemsOfDicomAreNotDeep) {
  TempDir dir;
  std::string items;
  for (int i = 0; i < 20000; ++i) items += item(kUndefined) + kItemEnd;
  write_file(dir / "wide.dcm", dicom(Syntax::explicit_little,
                                     sequence(Syntax::explicit_little, "SQ", kUndefined) + items + kSequenceEnd));
  EXPECT_THAT(error_of([&] { read_image(dir / "wide.dcm"); }).what(), testing::Not(testing::HasSubstr("nested")));
}

// --- files that were found

TEST(HostileMeshes, FoundFilesAreRefused) {
  const fs::path folder = fs::path(TEGL_SHARED_DATA_DIR) / "hostile";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  expect_file_refused(folder / "attrs.vtkhdf", ErrorCode::MalformedFile, {"expected"}, as_mesh);
  expect_file_refused(folder / "vtkhdf_sig14_rss_1_899.vtkhdf", ErrorCode::MalformedFile,
                      {"values of 1442840577 bytes", "expected numbers of 1 to 16"}, as_mesh);
  expect_file_refused(folder / "chunk.nc", ErrorCode::MalformedFile, {"chunks of", "expected at most"}, as_image);
  expect_file_refused(folder / "chunk.nc", ErrorCode::MalformedFile, {"chunks of", "expected at most"}, as_layers);
  expect_file_refused(folder / "seq_10000.dcm", ErrorCode::MalformedFile, {"nested deeper than 64"}, as_image);
  expect_file_refused(folder / "extreq.gltf", ErrorCode::MalformedFile, {"more than 256 deep"}, as_mesh);
  expect_file_refused(folder / "buffers.glb", ErrorCode::MalformedFile, {"no scene"}, as_mesh);
  expect_file_refused(folder / "instances.glb", ErrorCode::TooLarge, {"750000000 vertices"}, as_mesh);
  expect_file_refused(folder / "props.ply", ErrorCode::MalformedFile, {"two properties 'a'"}, as_mesh);
  expect_file_refused(folder / "two_vertex.ply", ErrorCode::MalformedFile, {"two elements 'vertex'"}, as_mesh);
  EXPECT_EQ(read_mesh(folder / "plain.vtkhdf").dim, 2);
}

}  // namespace
}  // namespace tegl::test
