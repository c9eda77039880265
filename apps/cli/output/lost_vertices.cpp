// SPDX-License-Identifier: BSD-3-Clause
//
// Counts vertices that coincide in single precision or without vertex numbers.
#include "output/lost_vertices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/numbers.hpp"

namespace tegl::cli {

namespace {

/// Number of distinct positions of the used vertices, with coordinates converted to `Real`.
template <class Real>
std::uint64_t places(const MeshView& mesh, const std::vector<bool>& used) {
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  std::vector<std::array<Real, 4>> rows;
  rows.reserve(used.size());
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    auto& row = rows.emplace_back();
    for (std::size_t a = 0; a < n; ++a) row[a] = static_cast<Real>(mesh.coordinates[v * n + a]);
  }
  std::sort(rows.begin(), rows.end());
  return static_cast<std::uint64_t>(std::unique(rows.begin(), rows.end()) - rows.begin());
}

}  // namespace

LostVertices& LostVertices::operator+=(const LostVertices& other) {
  vertices += other.vertices;
  in_single += other.in_single;
  by_place += other.by_place;
  return *this;
}

std::string LostVertices::text() const {
  if (count() == 0) return "";
  return fmt::format("{} of {} coincide ({})", grouped(count()), counted(vertices, "vertex", "vertices"),
                     in_single == 0  ? "the file has no vertex numbers"
                     : by_place == 0 ? "single precision"
                                     : "single precision, and no vertex numbers");
}

std::string LostVertices::remark(const std::filesystem::path& output) const {
  const std::string extension = output.extension().string();
  std::string text;
  if (in_single > 0)
    text = fmt::format(
        "{}: {} has single precision, in which {} of {} vertices coincide with others; expected a format with double "
        "precision (.ply, .obj or .vtkhdf), or an origin nearer to the contour",
        output.string(), extension, in_single, vertices);
  if (by_place > 0)
    text += fmt::format(
        "{}{} of {} vertices coincide with others, and {} has no vertex numbers that distinguish them; expected .ply, "
        ".obj or .vtkhdf, or --epsilon if samples equal the isovalue",
        text.empty() ? output.string() + ": " : ". Also, ", by_place, vertices, extension);
  return text;
}

LostVertices lost_vertices(const MeshView& mesh, const std::filesystem::path& output) {
  const MeshFileFormat* const format = find_mesh_file_format(output);
  const bool is_stl = format != nullptr && format->extension == ".stl";
  LostVertices lost;
  if (!is_stl && (format == nullptr || (format->extension != ".gltf" && format->extension != ".glb"))) return lost;
  std::vector<bool> used(mesh.coordinates.size() / static_cast<std::size_t>(mesh.space_dim), false);
  for (const Index v : mesh.simplices) used[v] = true;
  lost.vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
  const std::uint64_t in_float = places<float>(mesh, used);
  if (in_float == lost.vertices) return lost;
  const std::uint64_t in_double = places<double>(mesh, used);
  lost.in_single = in_double - in_float;
  if (is_stl) lost.by_place = lost.vertices - in_double;
  return lost;
}

}  // namespace tegl::cli
