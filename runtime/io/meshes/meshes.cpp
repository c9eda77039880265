// SPDX-License-Identifier: BSD-3-Clause
//
// Implements conversion between meshes and contours, and the selection of mesh formats.
#include "meshes/meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/common.hpp"
#include "base/mesh_data.hpp"
#include "base/pending_path.hpp"
#include "base/simplex_names.hpp"
#include "meshes/attributes.hpp"
#include "meshes/gltf_reader.hpp"
#include "meshes/gltf_writer.hpp"
#include "meshes/obj_reader.hpp"
#include "meshes/obj_writer.hpp"
#include "meshes/ply_reader.hpp"
#include "meshes/ply_writer.hpp"
#include "meshes/stl_reader.hpp"
#include "meshes/stl_writer.hpp"
#include "meshes/vtkhdf.hpp"
#include "process/separate_reading.hpp"
#include "tegl/periodic.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

using namespace io_detail;

constexpr std::array<MeshFileFormat, 6> kFormats = {
    {{".ply", 1, 2}, {".gltf", 1, 2}, {".glb", 1, 2}, {".vtkhdf", 1, 4}, {".stl", 2, 2}, {".obj", 1, 2}}};

const MeshFileFormat& format_of(const fs::path& path) {
  if (const MeshFileFormat* const format = find_mesh_file_format(path)) return *format;
  fail(ErrorCode::UnsupportedFormat, path,
       "unknown mesh format '{}'; expected .ply, .gltf, .glb, .vtkhdf, .stl or .obj", path.extension().string());
}

bool is_gltf(const MeshFileFormat& format) { return format.extension == ".gltf" || format.extension == ".glb"; }

void check_mesh(const MeshView& mesh, const fs::path& path) {
  const auto corners = static_cast<std::size_t>(mesh.dim) + 1;
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  if (mesh.dim < 1 || mesh.dim > 4 || mesh.space_dim < 2 || mesh.space_dim > 5 || mesh.dim > mesh.space_dim)
    fail(ErrorCode::InvalidArgument, path, "mesh of {}-simplices in {}-space; expected 1 to 4 in 2 to 5", mesh.dim,
         mesh.space_dim);
  if (mesh.simplices.size() % corners != 0 || mesh.coordinates.size() % n != 0)
    fail(ErrorCode::InvalidArgument, path,
         "mesh of {} vertex numbers and {} coordinates; expected multiples of {} and {}", mesh.simplices.size(),
         mesh.coordinates.size(), corners, n);
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.coordinates.size())
    fail(ErrorCode::InvalidArgument, path, "mesh of {} numbers in normals; expected {}, as in coordinates, or none",
         mesh.normals.size(), mesh.coordinates.size());
  check_attributes(mesh.vertex_attributes, vertex_count(mesh), "vertices", path);
  check_attributes(mesh.simplex_attributes, simplex_count(mesh), "simplices", path);
  const std::size_t vertices = vertex_count(mesh);
  // The maximum is found in vector registers, the first number that is too large is not.
  Index greatest = 0;
  for (const Index i : mesh.simplices) greatest = std::max(greatest, i);
  if (mesh.simplices.empty() || greatest < vertices) return;
  const auto bad = std::find_if(mesh.simplices.begin(), mesh.simplices.end(), [&](Index i) { return i >= vertices; });
  fail(ErrorCode::InvalidArgument, path, "mesh with vertex number {}; expected less than {}", *bad, vertices);
}

/// Throws unless the format can hold the periods of a wrapped contour.
void check_wrapped(const MeshView& mesh, const MeshFileFormat& format, const fs::path& path) {
  if (!mesh.periods.empty() && format.extension != ".vtkhdf")
    fail(ErrorCode::UnsupportedFormat, path,
         "'{}' cannot hold a wrapped contour, with periods; expected .vtkhdf, or an unrolled contour",
         path.extension().string());
  if (mesh.periods.size() % (2 * static_cast<std::size_t>(mesh.space_dim) + 1) != 0)
    fail(ErrorCode::InvalidArgument, path, "mesh with {} numbers of periods; expected a multiple of {}",
         mesh.periods.size(), 2 * mesh.space_dim + 1);
}

/// Every format supports triangles, and all except STL support lines. Tetrahedra, 4-simplices and more than three
/// coordinates are only supported by formats with most_dim = 4.
void check_combination(const MeshView& mesh, const MeshFileFormat& format, const fs::path& path) {
  if (mesh.dim < format.least_dim)
    fail(ErrorCode::UnsupportedFormat, path,
         "'{}' cannot hold segments, which lines are made of; expected .ply, .gltf, .glb, .obj or .vtkhdf",
         path.extension().string());
  if (mesh.dim > format.most_dim || (mesh.space_dim > 3 && format.most_dim < 3))
    fail(ErrorCode::UnsupportedFormat, path,
         "'{}' cannot hold {} in {}D space (the contour of a {}D image); expected .vtkhdf, or a slice of it",
         path.extension().string(), simplex_name(mesh.dim).plural, mesh.space_dim, mesh.space_dim);
}

/// The format for a file's extension. Throws unless it supports the mesh and the options.
const MeshFileFormat& checked_format(const MeshView& mesh, const fs::path& path, const WriteOptions& options) {
  const MeshFileFormat& format = format_of(path);
  if (options.compression != Compression::none && format.extension != ".vtkhdf")
    fail(ErrorCode::UnsupportedFormat, path, "'{}' has no compression; expected .vtkhdf", path.extension().string());
  check_mesh(mesh, path);
  check_combination(mesh, format, path);
  check_wrapped(mesh, format, path);
  tick(options.work.progress, 0.0, path);
  return format;
}

void write_format(const MeshFileFormat& format, const MeshView& mesh, const PendingPath& file,
                  const WriteOptions& options) {
  const Progress& progress = options.work.progress;
  if (format.extension == ".ply")
    write_ply(mesh, file, progress);
  else if (is_gltf(format))
    write_gltf(mesh, file, progress);
  else if (format.extension == ".stl")
    write_stl(mesh, file, progress);
  else if (format.extension == ".obj")
    write_obj(mesh, file, progress);
  else
    write_vtkhdf(mesh, file, progress, options.compression);
}

template <class Names>
std::vector<std::string> as_vector(const Names& names) {
  return {names.begin(), names.end()};
}

/// The numbers of all rows, one row after the other.
template <class T, std::size_t Width>
std::span<const T> flat(const Buffer<std::array<T, Width>>& rows) {
  return rows.empty() ? std::span<const T>() : std::span<const T>(rows.data()->data(), rows.size() * Width);
}

/// The numbers of all rows as double; of a temporary in the same memory if they have that type.
template <class Rows>
MeshArray<double> as_doubles(Rows&& rows) {
  using Real = typename std::remove_cvref_t<Rows>::value_type::value_type;
  if constexpr (std::is_same_v<Real, double>) {
    return std::forward<Rows>(rows);
  } else {
    const std::span<const Real> numbers = flat(rows);
    return Buffer<double>(numbers.begin(), numbers.end());
  }
}

/// The mesh of a contour, which is a temporary (its memory is taken over) or not.
template <class AnyContour>
Mesh mesh_of(AnyContour&& contour) {
  using Vertex = typename std::remove_cvref_t<AnyContour>::Vertex;
  constexpr int kDim = std::tuple_size_v<Vertex>;
  Mesh mesh;
  mesh.dim = kDim - 1;
  mesh.space_dim = kDim;
  mesh.coordinates = as_doubles(std::forward<AnyContour>(contour).vertices);
  mesh.normals = as_doubles(std::forward<AnyContour>(contour).normals);
  mesh.simplices = std::forward<AnyContour>(contour).simplices;
  mesh.single_precision = std::is_same_v<typename Vertex::value_type, float>;
  mesh.axis_names = as_vector(contour.axis_names);
  mesh.axis_units = as_vector(contour.axis_units);
  mesh.periods = period_numbers(contour.periods);
  mesh.vertex_attributes = std::forward<AnyContour>(contour).vertex_attributes;
  mesh.simplex_attributes = std::forward<AnyContour>(contour).simplex_attributes;
  return mesh;
}

/// Throws UnsupportedData unless a mesh is an N-dimensional contour, or one of segments in the plane z = 0 for N = 2.
template <int N>
void require_contour(const Mesh& mesh) {
  const bool planar = N == 2 && mesh.dim == 1 && mesh.space_dim == 3;
  if (mesh.dim != N - 1 || (mesh.space_dim != N && !planar))
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("mesh of {}-simplices in {}-space; expected {}-simplices in {}-space", mesh.dim,
                            mesh.space_dim, N - 1, N));
  for (std::size_t i = 2; i < mesh.coordinates.size() && planar; i += 3)
    if (mesh.coordinates[i] != 0.0)
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("segments in space, vertex {} with z = {}; expected z = 0", i / 3, mesh.coordinates[i]));
}

/// The first Width of each `stride` numbers, as rows; of a temporary in the same memory if it holds such rows.
template <std::size_t Width, class Numbers>
auto rows_of(Numbers&& numbers, std::size_t stride) {
  using T = typename std::remove_cvref_t<Numbers>::value_type;
  if constexpr (!std::is_lvalue_reference_v<Numbers>)
    if (stride == Width) return std::move(numbers).template rows<Width>();
  Buffer<std::array<T, Width>> rows(numbers.size() / stride);
  for (std::size_t v = 0; v < rows.size(); ++v)
    for (std::size_t a = 0; a < Width; ++a) rows[v][a] = numbers[v * stride + a];
  return rows;
}

/// The contour of a mesh, which is a temporary (its memory is taken over) or not.
template <int N, class AnyMesh>
Contour<N, double> contour_of(AnyMesh&& mesh) {
  require_contour<N>(mesh);
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  Contour<N, double> contour;
  contour.vertices = rows_of<N>(std::forward<AnyMesh>(mesh).coordinates, n);
  contour.normals = rows_of<N>(std::forward<AnyMesh>(mesh).normals, n);
  contour.simplices = rows_of<N>(std::forward<AnyMesh>(mesh).simplices, N);
  for (int a = 0; a < N; ++a) {
    contour.axis_names[static_cast<std::size_t>(a)] = axis_text(mesh.axis_names, a);
    contour.axis_units[static_cast<std::size_t>(a)] = axis_text(mesh.axis_units, a);
  }
  if (mesh.space_dim == N) contour.periods = periods_of_numbers<N>(mesh.periods);
  contour.vertex_attributes = std::forward<AnyMesh>(mesh).vertex_attributes;
  contour.simplex_attributes = std::forward<AnyMesh>(mesh).simplex_attributes;
  return contour;
}

}  // namespace

MeshView::MeshView(const Mesh& mesh)
    : dim(mesh.dim),
      space_dim(mesh.space_dim),
      coordinates(std::span<const double>(mesh.coordinates)),
      normals(std::span<const double>(mesh.normals)),
      simplices(mesh.simplices),
      axis_names(mesh.axis_names),
      axis_units(mesh.axis_units),
      vertex_attributes(mesh.vertex_attributes),
      simplex_attributes(mesh.simplex_attributes),
      isovalue(mesh.isovalue),
      periods(mesh.periods),
      single_precision(mesh.single_precision) {}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> MeshView::MeshView(const Contour<N, Real>& contour)
    : dim(N - 1),
      space_dim(N),
      coordinates(flat(contour.vertices)),
      normals(flat(contour.normals)),
      simplices(flat(contour.simplices)),
      axis_names(contour.axis_names),
      axis_units(contour.axis_units),
      vertex_attributes(contour.vertex_attributes),
      simplex_attributes(contour.simplex_attributes),
      periods(period_numbers(contour.periods)),
      single_precision(std::is_same_v<Real, float>) {}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Mesh to_mesh(const Contour<N, Real>& contour) { return mesh_of(contour); }

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Mesh to_mesh(Contour<N, Real>&& contour) { return mesh_of(std::move(contour)); }

template <int N>
requires DimensionBetween<N, 2, 5> Contour<N, double> to_contour(const Mesh& mesh) { return contour_of<N>(mesh); }

template <int N>
requires DimensionBetween<N, 2, 5> Contour<N, double> to_contour(Mesh&& mesh) { return contour_of<N>(std::move(mesh)); }

std::span<const MeshFileFormat> mesh_file_formats() noexcept { return kFormats; }

const MeshFileFormat* find_mesh_file_format(const fs::path& path) {
  const std::string name = lower_name(path);
  const auto* const found =
      std::ranges::find_if(kFormats, [&](const MeshFileFormat& format) { return name.ends_with(format.extension); });
  return found == kFormats.end() ? nullptr : found;
}

void write_mesh(const MeshView& mesh, const PendingPath& file, const WriteOptions& options) {
  write_format(checked_format(mesh, file.target(), options), mesh, file, options);
}

void write_mesh(const MeshView& mesh, const fs::path& path, const WriteOptions& options) {
  const MeshFileFormat& format = checked_format(mesh, path, options);
  write_complete_file(path, [&](const PendingPath& file) { write_format(format, mesh, file, options); });
}

Mesh read_mesh(const fs::path& path, const ReadMeshOptions& options) {
  require_readable_file(path);
  const MeshFileFormat& format = format_of(path);
  const auto read_format = [&](const Progress& progress) {
    ReadProgress read(progress, path);
    return format.extension == ".ply"      ? read_ply(path, read)
           : format.extension == ".vtkhdf" ? read_vtkhdf(path, read, options.allow_outside_paths)
           : is_gltf(format)               ? read_gltf(path, read, options.allow_outside_paths)
           : format.extension == ".obj"    ? read_obj(path, read)
                                           : read_stl(path, read);
  };
  const bool separate = options.separate_process && format.extension == ".vtkhdf";
  Mesh mesh = separate ? read_separately(path, options.work.progress, read_format) : read_format(options.work.progress);
  check_indices(mesh, path);
  tick(options.work.progress, 1.0, path);
  return mesh;
}

#define TEGL_INSTANTIATE(N, Real)                       \
  template MeshView::MeshView(const Contour<N, Real>&); \
  template Mesh to_mesh(const Contour<N, Real>&);       \
  template Mesh to_mesh(Contour<N, Real>&&);
TEGL_INSTANTIATE(2, float)
TEGL_INSTANTIATE(2, double)
TEGL_INSTANTIATE(3, float)
TEGL_INSTANTIATE(3, double)
TEGL_INSTANTIATE(4, float)
TEGL_INSTANTIATE(4, double)
TEGL_INSTANTIATE(5, float)
TEGL_INSTANTIATE(5, double)
#undef TEGL_INSTANTIATE
template Contour<2, double> to_contour<2>(const Mesh&);
template Contour<2, double> to_contour<2>(Mesh&&);
template Contour<3, double> to_contour<3>(const Mesh&);
template Contour<3, double> to_contour<3>(Mesh&&);
template Contour<4, double> to_contour<4>(const Mesh&);
template Contour<4, double> to_contour<4>(Mesh&&);
template Contour<5, double> to_contour<5>(const Mesh&);
template Contour<5, double> to_contour<5>(Mesh&&);

}  // namespace tegl
