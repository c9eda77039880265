// SPDX-License-Identifier: BSD-3-Clause
//
// Reads meshes of cells, and refuses options that are for images.
#include "input/mesh_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/numbers.hpp"
#include "io/base/simplex_names.hpp"

namespace tegl::cli {

namespace {

/// The values at the corners of a mesh's cells.
struct CornerValues {
  ValueRange range;
  bool any_missing = false;
};

CornerValues corner_values(const CellMesh& mesh) {
  CornerValues result;
  const std::size_t points = mesh.values.size() / std::max<std::size_t>(1, mesh.times.size());
  for (std::size_t first = 0; first < mesh.values.size(); first += points)
    for (const Index p : mesh.corners) {
      const double value = mesh.values[first + p];
      result.range.min = std::fmin(result.range.min, value);
      result.range.max = std::fmax(result.range.max, value);
      result.any_missing = result.any_missing || std::isnan(value);
    }
  return result;
}

}  // namespace

bool are_cell_meshes(const std::vector<std::string>& files, const ImageOptions& images) {
  if (images.curved_grid()) {
    std::string extension = std::filesystem::path(files.front()).extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (images.raw() || (extension != ".vts" && extension != ".pvd"))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--curved-grid with {}{}; expected it with a .vts file, or a .pvd file of them",
                              files.front(), images.raw() ? " and --raw" : ""));
    return false;
  }
  return !images.raw() && is_cell_mesh_file(files.front(), images.allow_outside_paths());
}

void refuse_options_of_images(const std::string& file, const ExtractionOptions& extraction, const ImageOptions& images,
                              const std::vector<std::string>& others) {
  std::vector<std::string> refused = others;
  for (const std::string& option : images.given())
    if (option != "--var" && option != "--times" && option != "--time-step" && option != "--sort" &&
        option != "--cells-to-points")
      refused.push_back(option);
  const bool is_structured = file.ends_with(".vts");
  if (!refused.empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} with {}, which is a mesh; expected it with an image{}", refused.front(), file,
                            is_structured ? ", or with --curved-grid, which reads a structured grid as an image" : ""));
  const auto fail = [&](const std::string& option, const char* expected) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} with {}, which is a mesh; expected {}", option, file, expected));
  };
  if (const std::string tiling = extraction.given_tiling(); !tiling.empty())
    fail(tiling, is_structured ? "an image, or the mesh without this option, or --curved-grid, which reads a "
                                 "structured grid as an image"
                               : "an image, or the mesh without this option");
  const ExtractOptions options = extraction.library_options(true);
  if (options.normals != Normals::none && options.normals != Normals::differences)
    fail("--normals " + extraction.normals(), "--normals gradient, geometric or flat");
  if (extraction.polygon_triangulation())
    fail("--triangulation " + extraction.triangulation(), "compact or barycentric");
}

MeshInput read_cells(const std::vector<std::string>& files, const ImageOptions& images, const Progress& progress) {
  const CellMeshOptions options = images.cell_mesh_options(progress, files);
  const auto read = [&] {
    try {
      return read_cell_mesh(std::vector<std::filesystem::path>(files.begin(), files.end()), options);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::VariableNotFound || !options.variable.empty()) throw;
      throw Error(error.code(), fmt::format("{} (choose it with --var)", error.what()));
    }
  };
  return {read(), AnyComplex(Complex<2>({}, std::span<const CellType>(), {}))};
}

void make_complex(MeshInput& input) { input.complex = to_complex(input.mesh); }

MeshInput read_mesh_input(const std::vector<std::string>& files, const ImageOptions& images, const Progress& progress,
                          bool several) {
  MeshInput input = read_cells(files, images, progress);
  make_complex(input);
  if (several) std::visit([](auto& complex) { complex.find_edges(); }, input.complex);
  return input;
}

void keep_times(CellMesh& mesh, double first, double last) {
  const std::vector<double>& times = mesh.times;
  // A slice at a time of the mesh touches the intervals on both sides.
  const auto from = std::lower_bound(times.begin(), times.end(), first) - times.begin();
  const auto to = std::upper_bound(times.begin(), times.end(), last) - times.begin();
  const auto begin = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, from - 2));
  const std::size_t end = std::min(times.size(), static_cast<std::size_t>(to) + 2);
  if (begin == 0 && end == times.size()) return;
  const auto keep = [&](std::vector<double>& list, std::size_t size) {
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(end * size), list.end());
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(begin * size));
  };
  keep(mesh.values, mesh.values.size() / mesh.times.size());
  if (mesh.points_move) keep(mesh.points, mesh.points.size() / mesh.times.size());
  keep(mesh.times, 1);
}

CutSpace space_of(const MeshInput& input) {
  CutSpace space{{}, "mesh", {}};
  const CellMesh& mesh = input.mesh;
  const auto dim = static_cast<std::size_t>(mesh.dim);
  for (std::size_t a = 0; a < dim; ++a) {
    CutAxis& axis = space.axes.emplace_back();
    axis = {mesh.axis_names[a], std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t i = a; i < mesh.points.size(); i += dim) {
      axis.first = std::min(axis.first, mesh.points[i]);
      axis.last = std::max(axis.last, mesh.points[i]);
    }
  }
  if (input.is_moving()) space.axes.push_back({"t", mesh.times.front(), mesh.times.back()});
  return space;
}

namespace {

/// Whether no cell can be ambiguous: simplices at one time. Over time they are prisms, which can be.
bool are_simplices(const CellMesh& mesh) {
  return mesh.times.size() < 2 && std::ranges::all_of(mesh.types, [](CellType type) {
           return type == CellType::triangle || type == CellType::tetrahedron || type == CellType::simplex4;
         });
}

}  // namespace

void require_mesh_contour(const CellMesh& mesh, double isovalue, bool allow_empty, Ambiguity ambiguity) {
  if (ambiguity != Ambiguity::low && !mesh.types.empty() && are_simplices(mesh))
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("--ambiguity with a mesh of {}, none of which can be ambiguous; expected other cells, or the "
                    "mesh without this option",
                    io_detail::simplex_name(mesh.dim).plural));
  if (allow_empty) return;
  if (mesh.types.empty())
    throw EmptyResult(
        fmt::format("{}; expected cells (--allow-empty: an empty result)", fmt::join(mesh.remarks, ", ")));
  const ValueRange range = corner_values(mesh).range;
  if (!range.has_both_sides(isovalue)) throw outside_error(isovalue, range, "");
}

std::string remark_without_contour(const CellMesh& mesh, double isovalue) {
  const CornerValues values = corner_values(mesh);
  if (!values.range.has_both_sides(isovalue)) return {};
  return fmt::format("no contour at {}: no cell {}has values on both sides of it", number(isovalue),
                     values.any_missing ? "without missing values " : "");
}

}  // namespace tegl::cli
