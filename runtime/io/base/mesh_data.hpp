// SPDX-License-Identifier: BSD-3-Clause
//
// Functions that the readers and writers of all mesh formats share.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "tegl/io/meshes.hpp"

namespace tegl::io_detail {

/// Progress of reading a mesh file.
class ReadProgress {
 public:
  /// Reports 0. `progress` and `path` must outlive this object.
  ReadProgress(const Progress& progress, const std::filesystem::path& path);

  /// Adds `bytes` processed bytes of the file; reports every megabyte. Throws Cancelled.
  void add(std::uint64_t bytes);
  /// For loops over rows of `row_bytes` bytes: call after row `i`; calls add() once in 4096 rows.
  void add_rows(std::size_t i, std::size_t row_bytes) {
    constexpr std::size_t kEvery = 4096;
    if (i % kEvery == kEvery - 1) add(kEvery * row_bytes);
  }

 private:
  const Progress& progress_;
  const std::filesystem::path& path_;
  std::uint64_t size_;
  std::uint64_t done_ = 0;
  std::uint64_t told_ = 0;
};

/// Name or unit of an axis; "" if the mesh has none.
inline const std::string& axis_text(std::span<const std::string> texts, int axis) {
  static const std::string kNone;
  return static_cast<std::size_t>(axis) < texts.size() ? texts[static_cast<std::size_t>(axis)] : kNone;
}

template <class AnyMesh>
std::size_t vertex_count(const AnyMesh& mesh) {
  return mesh.coordinates.size() / static_cast<std::size_t>(mesh.space_dim);
}
template <class AnyMesh>
std::size_t simplex_count(const AnyMesh& mesh) {
  return mesh.simplices.size() / (static_cast<std::size_t>(mesh.dim) + 1);
}

/// x, y, z of a vertex or normal; z = 0 in the plane.
inline std::array<double, 3> row_of(const CoordinateView& rows, const MeshView& mesh, std::size_t vertex) {
  std::array<double, 3> result{};
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  for (std::size_t a = 0; a < std::min<std::size_t>(n, 3); ++a) result[a] = rows[vertex * n + a];
  return result;
}
inline std::array<double, 3> position(const MeshView& mesh, std::size_t vertex) {
  return row_of(mesh.coordinates, mesh, vertex);
}
inline std::array<double, 3> normal(const MeshView& mesh, std::size_t vertex) {
  return row_of(mesh.normals, mesh, vertex);
}

/// The position as float; UnsupportedData if float cannot represent it.
std::array<float, 3> float_position(const MeshView& mesh, std::size_t vertex, const std::filesystem::path& path);

/// Makes a mesh planar that was read with space_dim 3, if its file was written with `space_dim` 2. MalformedFile unless
/// all z = 0.
void flatten(Mesh& mesh, const std::filesystem::path& path);

/// Limits the memory of copies of a file's numbers: instances of a mesh, and attributes repeated for the triangles of a
/// polygon. A small file can request any number of copies.
class CopyLimit {
 public:
  /// `file_bytes`: size of the file and its buffers.
  CopyLimit(const std::filesystem::path& path, std::uint64_t file_bytes)
      : path_(path), most_((std::uint64_t{1} << 26) + 64 * std::min(file_bytes, std::uint64_t{1} << 50)) {}
  /// Adds `count` copies of `bytes` each. Throws TooLarge with the size, `what` and the limit.
  void add(std::uint64_t count, std::uint64_t bytes, std::string_view what);

 private:
  const std::filesystem::path& path_;
  std::uint64_t most_;
  std::uint64_t taken_ = 0;
};

/// Throws MalformedFile if a simplex refers to a missing vertex.
void check_indices(const Mesh& mesh, const std::filesystem::path& path);

}  // namespace tegl::io_detail
