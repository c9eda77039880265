// SPDX-License-Identifier: BSD-3-Clause
//
// Reads arrays at the points of a mesh, and checks that they belong to it.
#include "input/point_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace tegl::cli {

namespace {

/// Throws unless the arrays of `other` are at the points of `mesh`.
void require_same_mesh(const std::string& file, const CellMesh& other, const CellMesh& mesh) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("--attribute {}: the mesh has {} than {}; expected the mesh that is contoured", file, what,
                            mesh.files.front().string()));
  };
  const std::size_t points = mesh.points.size() / static_cast<std::size_t>(mesh.dim);
  const std::size_t others = other.points.size() / static_cast<std::size_t>(other.dim);
  if (other.dim != mesh.dim) refuse(fmt::format("{}D cells, others", other.dim));
  if (other.times.size() > 1 && other.times != mesh.times) refuse(fmt::format("{} other times", other.times.size()));
  if (other.types != mesh.types || other.corners != mesh.corners || other.ends != mesh.ends ||
      other.face_corners != mesh.face_corners || other.face_ends != mesh.face_ends)
    refuse("other cells");
  // points that move, and an array at one time: the first points decide
  const std::size_t count = std::min(points, others) * static_cast<std::size_t>(mesh.dim);
  const bool is_short = points != others && !(mesh.points_move && other.times.size() < 2);
  if (is_short ||
      !std::equal(other.points.begin(), other.points.begin() + static_cast<std::ptrdiff_t>(count), mesh.points.begin()))
    refuse("other points");
}

}  // namespace

std::vector<PointArray> read_point_arrays(const AttributeOptions& attributes, const CellMesh& input,
                                          const std::vector<std::string>& files, const ImageOptions& images,
                                          ProgressBar& bar) {
  std::vector<PointArray> arrays;
  for (const FileAndVariable& from : attributes.meshes(images.allow_outside_paths())) {
    CellMeshOptions options = images.cell_mesh_options(bar.stage("attribute"));
    options.variable = from.variable;
    std::error_code ignored;
    const bool is_input = std::filesystem::equivalent(from.file, files.front(), ignored);
    if (!is_input) {
      options.times.clear();
      options.time_step.reset();
      options.order = SeriesOrder::given;
    }
    std::vector<std::filesystem::path> paths = {from.file};
    if (is_input) paths.assign(files.begin(), files.end());
    const auto read = [&] {
      try {
        return read_cell_mesh(paths, options);
      } catch (const Error& error) {
        throw Error(error.code(), fmt::format("--attribute: {}", error.what()));
      }
    };
    CellMesh mesh = read();
    require_same_mesh(from.file, mesh, input);
    std::string name = mesh.variable;
    if (std::any_of(arrays.begin(), arrays.end(), [&](const PointArray& other) { return other.name == name; }))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--attribute {}: the contour already has an attribute '{}'; expected each once",
                              from.file, name));
    arrays.push_back({std::move(name), std::move(mesh)});
  }
  return arrays;
}

}  // namespace tegl::cli
