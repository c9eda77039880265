// SPDX-License-Identifier: BSD-3-Clause
//
// Writes binary STL, for printing and milling: 80 arbitrary bytes, the number of triangles, and 50 bytes per triangle
// (a normal and three corners as float, and two zero bytes). Little-endian on any machine. The format does not support
// shared vertices, units, names or attributes. Corners are counter-clockwise seen from the side that the contour faces,
// as in memory, and the facet's normal points to that side.
//
// Based on: 3D Systems, "Stereolithography Interface Specification", 1988.
#include "meshes/stl_writer.hpp"

#include <array>
#include <bit>
#include <limits>

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

void put_vector(BlockWriter& out, const Eigen::Vector3f& vector) {
  for (const float value : vector) out.put(little_endian(std::bit_cast<std::uint32_t>(value)).data(), 4);
}

/// The unit normal; 0 for a triangle of zero area. Products of floats do not overflow double.
Eigen::Vector3f facet_normal(const std::array<Eigen::Vector3f, 3>& corners) {
  const Eigen::Vector3d first = corners[1].cast<double>() - corners[0].cast<double>();
  const Eigen::Vector3d second = corners[2].cast<double>() - corners[0].cast<double>();
  return first.cross(second).normalized().cast<float>();
}

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
  out.write_rows(count, 0.0, 1.0, [&](std::size_t triangle) {
    std::array<Eigen::Vector3f, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto point = float_position(mesh, mesh.simplices[3 * triangle + c], path);
      corners[c] = Eigen::Vector3f(point.data());
    }
    put_vector(out, facet_normal(corners));
    for (const Eigen::Vector3f& corner : corners) put_vector(out, corner);
    out.put_byte(0);
    out.put_byte(0);
  });
  tick(progress, 1.0, path);
  file.close();
}

}  // namespace tegl::io_detail
