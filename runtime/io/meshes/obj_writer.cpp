// SPDX-License-Identifier: BSD-3-Clause
//
// Writes Wavefront OBJ as text: vertices (v), normals if there are any (vn), and segments (l) or triangles (f) with
// vertex numbers from 1. Numbers have enough digits to read back the same double (the same float for a mesh in single
// precision). The format does not support units, names, the isovalue or attributes.
//
// Based on: Wavefront Technologies, "The Advanced Visualizer", appendix B1, "Object Files (.obj)", 1991.
#include "meshes/obj_writer.hpp"

#include <cmath>

#include "base/block_writer.hpp"
#include "base/mesh_data.hpp"

namespace tegl::io_detail {

namespace {

/// Writes the line of a vertex or normal.
void put_row(BlockWriter& out, std::string_view key, const std::array<double, 3>& row, bool single_precision) {
  if (single_precision)
    out.put_format("{} {} {} {}\n", key, static_cast<float>(row[0]), static_cast<float>(row[1]),
                   static_cast<float>(row[2]));
  else
    out.put_format("{} {} {} {}\n", key, row[0], row[1], row[2]);
}

std::array<double, 3> finite_position(const MeshView& mesh, std::size_t vertex, const std::filesystem::path& path) {
  const auto point = position(mesh, vertex);
  for (const double value : point)
    if (!std::isfinite(value))
      fail(ErrorCode::UnsupportedData, path, "vertex {} has the coordinate {}; expected a finite number", vertex,
           value);
  return point;
}

}  // namespace

void write_obj(const MeshView& mesh, const PendingPath& pending, const Progress& progress) {
  const std::filesystem::path& path = pending.target();
  OutputFile file(pending);
  BlockWriter out(file, progress);
  const std::size_t vertices = vertex_count(mesh);
  const bool with_normals = !mesh.normals.empty();
  const auto corners = static_cast<std::size_t>(mesh.dim) + 1;
  file.write("# written by tegl\n");
  const bool single = mesh.single_precision;
  out.write_rows(vertices, 0.0, 0.3, [&](std::size_t v) { put_row(out, "v", finite_position(mesh, v, path), single); });
  if (with_normals)
    out.write_rows(vertices, 0.3, 0.6, [&](std::size_t v) { put_row(out, "vn", normal(mesh, v), single); });
  out.write_rows(simplex_count(mesh), 0.6, 1.0, [&](std::size_t s) {
    out.put_text(mesh.dim == 1 ? "l" : "f");
    for (std::size_t c = 0; c < corners; ++c) {
      const std::uint64_t number = std::uint64_t{mesh.simplices[s * corners + c]} + 1;
      // OBJ lines cannot refer to normals; normals of segments are only listed in the file.
      if (with_normals && mesh.dim == 2)
        out.put_format(" {}//{}", number, number);
      else
        out.put_format(" {}", number);
    }
    out.put_text("\n");
  });
  tick(progress, 1.0, path);
  file.close();
}

}  // namespace tegl::io_detail
