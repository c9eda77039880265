// SPDX-License-Identifier: BSD-3-Clause
//
// Writes binary STL, for printing and milling: 80 arbitrary bytes, the number of triangles, and 50 bytes per triangle
// (a normal and three corners as float, and two zero bytes). Little-endian on any machine. The format does not support
// shared vertices, units, names or attributes. Corners are counter-clockwise seen from the side that the contour faces,
// as in memory, and the facet's normal points to that side.
//
// Based on: 3D Systems, "Stereolithography Interface Specification", 1988.
#include "meshes/stl_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include <Eigen/Geometry>

#include "base/block_writer.hpp"
#include "base/mesh_data.hpp"

namespace tegl::io_detail {

namespace {

std::array<char, 4> little_endian(std::uint32_t bits) {
  std::array<char, 4> bytes{};
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(bits >> 8 * i & 0xFFU);
  return bytes;
}

char* put_vector(const Eigen::Vector3f& vector, char* to) {
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(to, vector.data(), 3 * sizeof(float));
    return to + 3 * sizeof(float);
  }
  for (const float value : vector) {
    const auto bytes = little_endian(std::bit_cast<std::uint32_t>(value));
    to = std::copy(bytes.begin(), bytes.end(), to);
  }
  return to;
}

/// The unit normal; 0 for a triangle of zero area. Products of floats do not overflow double.
Eigen::Vector3f facet_normal(const std::array<Eigen::Vector3f, 3>& corners) {
  const Eigen::Vector3d first = corners[1].cast<double>() - corners[0].cast<double>();
  const Eigen::Vector3d second = corners[2].cast<double>() - corners[0].cast<double>();
  return first.cross(second).normalized().cast<float>();
}

/// Writes triangles as in the file.
template <class Real>
class TriangleBytes {
 public:
  static constexpr std::size_t kBytes = 50;

  TriangleBytes(const MeshView& mesh, std::span<const Real> coordinates, const std::filesystem::path& path)
      : mesh_(mesh), coordinates_(coordinates), path_(path) {}

  void operator()(std::size_t begin, std::size_t end, char* to) const {
    for (std::size_t triangle = begin; triangle < end; ++triangle) {
      std::array<Eigen::Vector3f, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = corner(mesh_.simplices[3 * triangle + c]);
      to = put_vector(facet_normal(corners), to);
      for (const Eigen::Vector3f& point : corners) to = put_vector(point, to);
      *to++ = 0;
      *to++ = 0;
    }
  }

 private:
  [[nodiscard]] Eigen::Vector3f corner(std::size_t vertex) const {
    constexpr auto kMost = static_cast<Real>(std::numeric_limits<float>::max());
    const auto n = static_cast<std::size_t>(mesh_.space_dim);
    const Real* const from = coordinates_.data() + vertex * n;
    const std::array<Real, 3> point = {from[0], from[1], n > 2 ? from[2] : Real{0}};
    const bool fits = std::abs(point[0]) <= kMost && std::abs(point[1]) <= kMost && std::abs(point[2]) <= kMost;
    if (!fits) float_position(mesh_, vertex, path_);  // throws
    return {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
  }

  const MeshView& mesh_;
  std::span<const Real> coordinates_;
  const std::filesystem::path& path_;
};

}  // namespace

std::uint32_t stl_triangle_count(std::uint64_t triangles, const std::filesystem::path& path) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (triangles > kMost)
    fail(ErrorCode::TooLarge, path, "{} triangles as .stl; expected at most 2^32 - 1 (write .ply or .vtkhdf)",
         triangles);
  return static_cast<std::uint32_t>(triangles);
}

void write_stl(const MeshView& mesh, const PendingPath& pending, const Progress& progress) {
  const std::filesystem::path& path = pending.target();
  const std::uint32_t count = stl_triangle_count(simplex_count(mesh), path);
  OutputFile file(pending);
  BlockWriter out(file, progress);
  // A file that begins with "solid" is read as text STL.
  constexpr std::size_t kHeader = 80;
  std::string header = "binary STL written by tegl";
  header.resize(kHeader, ' ');
  file.write(header);
  file.write(little_endian(count).data(), 4);
  mesh.coordinates.visit([&]<class Real>(std::span<const Real> coordinates) {
    const TriangleBytes<Real> triangles(mesh, coordinates, path);
    out.write_blocks(count, TriangleBytes<Real>::kBytes, 0.0, 1.0, triangles);
  });
  tick(progress, 1.0, path);
  file.close();
}

}  // namespace tegl::io_detail
