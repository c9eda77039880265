// SPDX-License-Identifier: BSD-3-Clause
//
// Helpers for tests of readers and writers: a temporary folder, files from bytes, expected errors, and images and
// meshes to write.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tegl/eigen.hpp"
#include "tegl/io.hpp"

namespace tegl::test {

namespace fs = std::filesystem;

/// A temporary folder, removed with its contents by the destructor.
class TempDir {
 public:
  TempDir() {
    std::string name = (fs::temp_directory_path() / "tegl-io-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp");
    path_ = name;
  }
  ~TempDir() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const fs::path& path() const { return path_; }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
  }

 private:
  fs::path path_;
};

inline void write_file(const fs::path& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(out.good()) << path;
}

inline std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
std::string bytes_of(const Values<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Deflate-compressed bytes with a gzip frame (or a zlib frame, if `zlib`).
inline std::string compressed(const std::string& bytes, bool zlib = false) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, zlib ? 15 : 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// Runs `work` and returns the error that it must throw.
template <class Work>
Error error_of(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    return error;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "no tegl::Error, but: " << error.what();
    return {ErrorCode::InvalidArgument, ""};
  }
  ADD_FAILURE() << "no error";
  return {ErrorCode::InvalidArgument, ""};
}

/// Expects an error with this code and these parts in its message.
template <class Work>
void expect_error(ErrorCode code, const std::vector<std::string>& parts, Work&& work) {
  const Error error = error_of(work);
  EXPECT_EQ(error.code(), code) << name_of(error.code()) << ": " << error.what();
  for (const std::string& part : parts) EXPECT_THAT(error.what(), testing::HasSubstr(part));
}

inline void expect_unreadable(ErrorCode code, const fs::path& path, const std::vector<std::string>& parts) {
  std::vector<std::string> all = parts;
  all.push_back(path.string());
  expect_error(code, all, [&] { read_image(path); });
}

/// The image with the given value type and dimension; the test fails if it has others.
template <class T, int N>
OwnedImage<T, N> image_as(const AnyImage& any) {
  if (const auto* in_n = std::get_if<AnyImageN<N>>(&any))
    if (const auto* image = std::get_if<OwnedImage<T, N>>(in_n)) return *image;
  ADD_FAILURE() << "other value type (" << std::visit([](const auto& i) { return i.index(); }, any)
                << ") or dimension (" << any.index() + 2 << ")";
  throw std::runtime_error("no such image");
}

/// World position of an index.
template <int N>
Eigen::Matrix<double, N, 1> world(const Grid<N>& grid,
                                  const std::array<std::size_t, static_cast<std::size_t>(N)>& index) {
  Eigen::Matrix<double, N, 1> position;
  for (int a = 0; a < N; ++a) position[a] = grid.axes[a][index[static_cast<std::size_t>(a)]];
  return as_eigen(grid.linear) * position + as_eigen(grid.offset);
}

/// The numbers 0, 1, 2, ... in any type, wrapped to its range.
template <class T>
std::vector<T> counting(std::size_t count, double start = 0) {
  std::vector<T> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(start + static_cast<double>(i % 100));
  return values;
}

/// A mesh of random coordinates and vertex numbers.
inline Mesh random_mesh(int dim, int space_dim, std::size_t vertices, std::size_t simplices, std::uint64_t seed,
                        bool with_normals = false) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-1000, 1000);
  Mesh mesh;
  mesh.dim = dim;
  mesh.space_dim = space_dim;
  for (std::size_t i = 0; i < vertices * static_cast<std::size_t>(space_dim); ++i)
    mesh.coordinates.push_back(coordinate(random));
  for (std::size_t i = 0; with_normals && i < mesh.coordinates.size(); ++i)
    mesh.normals.push_back(i % 7 == 0 ? 0.0 : coordinate(random) / 1000);
  for (std::size_t i = 0; i < simplices * static_cast<std::size_t>(dim + 1); ++i)
    mesh.simplices.push_back(static_cast<Index>(random() % std::max<std::size_t>(1, vertices)));
  const std::array<const char*, 5> names = {"lon", "lat", "depth below", "time", "log2_sigma"};
  const std::array<const char*, 5> units = {"degrees_east", "degrees_north", "m", "months since 1900-01-01", ""};
  mesh.axis_names.assign(names.begin(), names.begin() + space_dim);
  mesh.axis_units.assign(units.begin(), units.begin() + space_dim);
  return mesh;
}

/// Adds random vertex and simplex attributes of widths 1 to 3.
inline void add_attributes(Mesh& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> number(-1000, 1000);
  const auto add = [&](std::vector<Attribute>& to, const char* name, const char* unit, int width, std::size_t rows) {
    Attribute& attribute = to.emplace_back(Attribute{name, unit, width, {}});
    for (std::size_t i = 0; i < rows * static_cast<std::size_t>(width); ++i) attribute.values.push_back(number(random));
  };
  const std::size_t vertices = mesh.coordinates.size() / static_cast<std::size_t>(mesh.space_dim);
  const std::size_t simplices = mesh.simplices.size() / static_cast<std::size_t>(mesh.dim + 1);
  add(mesh.vertex_attributes, "temperature of water", "degC", 1, vertices);
  add(mesh.vertex_attributes, "flow", "m s-1", 3, vertices);
  add(mesh.vertex_attributes, "age", "", 2, vertices);
  add(mesh.simplex_attributes, "label", "", 1, simplices);
  add(mesh.simplex_attributes, "flux/area", "kg m-2 s-1", 3, simplices);
}

inline void expect_same(const std::vector<Attribute>& a, const std::vector<Attribute>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].unit, b[i].unit);
    EXPECT_EQ(a[i].width, b[i].width);
    EXPECT_TRUE(a[i].values == b[i].values) << a[i].name;
  }
}

inline void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.dim, b.dim);
  EXPECT_EQ(a.space_dim, b.space_dim);
  ASSERT_EQ(a.coordinates.size(), b.coordinates.size());
  EXPECT_TRUE(a.coordinates.empty() ||
              std::memcmp(a.coordinates.data(), b.coordinates.data(), a.coordinates.size() * sizeof(double)) == 0);
  ASSERT_EQ(a.normals.size(), b.normals.size());
  EXPECT_TRUE(a.normals.empty() ||
              std::memcmp(a.normals.data(), b.normals.data(), a.normals.size() * sizeof(double)) == 0);
  EXPECT_TRUE(a.simplices == b.simplices);
  EXPECT_EQ(a.axis_names, b.axis_names);
  EXPECT_EQ(a.axis_units, b.axis_units);
  expect_same(a.vertex_attributes, b.vertex_attributes);
  expect_same(a.simplex_attributes, b.simplex_attributes);
}

/// A text `count` times in a row.
inline std::string repeated(const std::string& text, std::size_t count) {
  std::string result;
  for (std::size_t i = 0; i < count; ++i) result += text;
  return result;
}

/// The number of open files of this process.
inline std::size_t open_descriptors() {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator()));
}

}  // namespace tegl::test
