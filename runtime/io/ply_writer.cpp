// SPDX-License-Identifier: BSD-3-Clause
//
// PLY, binary little-endian, with coordinates and normals as double: lossless. Segments become an `edge` element.
//
// Based on: G. Turk, "The PLY Polygon File Format", 1994.
#include <algorithm>
#include <bit>
#include <cstring>

#include "common.hpp"
#include "mesh_formats.hpp"
#include "output_file.hpp"

namespace tegl::io_detail {

namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

constexpr std::size_t kBlock = std::size_t{1} << 16;  ///< vertices or simplices between two reports

/// Comments end at the line's end: other control characters would end them too early.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

std::string header(const Mesh& mesh) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment written by tegl\n";
  text += fmt::format("comment tegl space_dim {}\n", mesh.space_dim);
  for (int a = 0; a < mesh.space_dim; ++a) {
    const std::string name = one_line(axis_text(mesh.axis_names, a));
    const std::string unit = one_line(axis_text(mesh.axis_units, a));
    if (!name.empty()) text += fmt::format("comment tegl axis {} name {}\n", a, name);
    if (!unit.empty()) text += fmt::format("comment tegl axis {} unit {}\n", a, unit);
  }
  text += fmt::format("element vertex {}\n", vertex_count(mesh));
  for (const char* const name : {"x", "y", "z"}) text += fmt::format("property double {}\n", name);
  if (!mesh.normals.empty())
    for (const char* const name : {"nx", "ny", "nz"}) text += fmt::format("property double {}\n", name);
  text += mesh.dim == 1
              ? fmt::format("element edge {}\nproperty uint vertex1\nproperty uint vertex2\n", simplex_count(mesh))
              : fmt::format("element face {}\nproperty list uchar uint vertex_indices\n", simplex_count(mesh));
  return text + "end_header\n";
}

void write_vertices(const Mesh& mesh, OutputFile& file, const Progress& progress) {
  const std::size_t count = vertex_count(mesh);
  std::vector<std::array<double, 3>> block;
  for (std::size_t first = 0; first < count; first += kBlock) {
    block.clear();
    for (std::size_t v = first; v < std::min(first + kBlock, count); ++v) {
      block.push_back(position(mesh, v));
      if (!mesh.normals.empty()) block.push_back(normal(mesh, v));
    }
    file.write(block.data(), block.size() * sizeof(block[0]));
    tick(progress, 0.5 * static_cast<double>(first) / static_cast<double>(count), file.target());
  }
}

void write_faces(const Mesh& mesh, OutputFile& file, const Progress& progress) {
  constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(Index);
  const std::size_t count = simplex_count(mesh);
  std::vector<unsigned char> block;
  for (std::size_t first = 0; first < count; first += kBlock) {
    block.resize(std::min(kBlock, count - first) * kFaceBytes);
    for (std::size_t i = 0; i < block.size() / kFaceBytes; ++i) {
      block[i * kFaceBytes] = 3;
      std::memcpy(&block[i * kFaceBytes + 1], &mesh.simplices[3 * (first + i)], 3 * sizeof(Index));
    }
    file.write(block.data(), block.size());
    tick(progress, 0.5 + 0.5 * static_cast<double>(first) / static_cast<double>(count), file.target());
  }
}

}  // namespace

void write_ply(const Mesh& mesh, const std::filesystem::path& path, const Progress& progress) {
  OutputFile file(path);
  file.write(header(mesh));
  write_vertices(mesh, file, progress);
  if (mesh.dim == 1)
    file.write_range(std::span<const Index>(mesh.simplices));
  else
    write_faces(mesh, file, progress);
  tick(progress, 1.0, path);
  file.commit();
}

}  // namespace tegl::io_detail
