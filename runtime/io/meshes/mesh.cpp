// SPDX-License-Identifier: BSD-3-Clause
//
// Implements conversion between meshes and contours, and the selection of mesh formats.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/common.hpp"
#include "base/mesh_formats.hpp"
#include "meshes/attributes.hpp"
#include "meshes/obj_reader.hpp"
#include "process/separate_reading.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

using namespace io_detail;

constexpr std::array<MeshFileFormat, 6> kFormats = {
    {{".ply", 1, 2}, {".gltf", 1, 2}, {".glb", 1, 2}, {".vtkhdf", 1, 3}, {".stl", 2, 2}, {".obj", 1, 2}}};

const MeshFileFormat& format_of(const fs::path& path) {
  if (const MeshFileFormat* const format = find_mesh_file_format(path)) return *format;
  fail(ErrorCode::UnsupportedFormat, path,
       "unknown mesh format '{}'; expected .ply, .gltf, .glb, .vtkhdf, .stl or .obj", path.extension().string());
}

bool is_gltf(const MeshFileFormat& format) { return format.extension == ".gltf" || format.extension == ".glb"; }

void check_mesh(const Mesh& mesh, const fs::path& path) {
  const auto corners = static_cast<std::size_t>(mesh.dim) + 1;
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  if (mesh.dim < 1 || mesh.dim > 3 || mesh.space_dim < 2 || mesh.space_dim > 4 || mesh.dim > mesh.space_dim)
    fail(ErrorCode::InvalidArgument, path, "mesh of {}-simplices in {}-space; expected 1 to 3 in 2 to 4", mesh.dim,
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
  const auto bad = std::find_if(mesh.simplices.begin(), mesh.simplices.end(), [&](Index i) { return i >= vertices; });
  if (bad != mesh.simplices.end())
    fail(ErrorCode::InvalidArgument, path, "mesh with vertex number {}; expected less than {}", *bad, vertices);
}

/// Every format supports triangles, and all except STL support lines. Tetrahedra and a fourth coordinate are only
/// supported by formats with most_dim = 3.
void check_combination(const Mesh& mesh, const MeshFileFormat& format, const fs::path& path) {
  if (mesh.dim < format.least_dim)
    fail(ErrorCode::UnsupportedFormat, path,
         "'{}' cannot hold {}-simplices, which lines are made of; expected .ply, .gltf, .glb, .obj or .vtkhdf",
         path.extension().string(), mesh.dim);
  if (mesh.dim > format.most_dim || (mesh.space_dim == 4 && format.most_dim < 3))
    fail(ErrorCode::UnsupportedFormat, path,
         "'{}' cannot hold {}-simplices in {}-space (the contour of a {}D image); "
         "expected .vtkhdf, or a cut of it",
         path.extension().string(), mesh.dim, mesh.space_dim, mesh.space_dim);
}

template <class Names>
std::vector<std::string> as_vector(const Names& names) {
  return {names.begin(), names.end()};
}

}  // namespace

namespace io_detail {

ReadProgress::ReadProgress(const Progress& progress, const fs::path& path)
    : progress_(progress), path_(path), size_(size_of_file(path)) {
  tick(progress_, 0.0, path_);
}

void ReadProgress::add(std::uint64_t bytes) {
  constexpr std::uint64_t kTellEvery = std::uint64_t{1} << 20;
  done_ += bytes;
  if (done_ - told_ < kTellEvery) return;
  told_ = done_;
  tick(progress_, static_cast<double>(done_) / static_cast<double>(size_), path_);
}

void CopyLimit::add(std::uint64_t count, std::uint64_t bytes, std::string_view what) {
  std::uint64_t all = 0;
  if (__builtin_mul_overflow(count, bytes, &all) || __builtin_add_overflow(all, taken_, &all))
    all = std::numeric_limits<std::uint64_t>::max();
  taken_ = all;
  if (taken_ > most_)
    fail(ErrorCode::TooLarge, path_, "{} take {} bytes or more; expected at most {}, 64 times the file and 64 MiB",
         what, taken_, most_);
}

std::array<float, 3> float_position(const Mesh& mesh, std::size_t vertex, const fs::path& path) {
  std::array<float, 3> result{};
  const auto point = position(mesh, vertex);
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(std::abs(point[a]) <= static_cast<double>(std::numeric_limits<float>::max())))
      fail(ErrorCode::UnsupportedData, path, "vertex {} has the coordinate {}; expected a value in the range of float",
           vertex, point[a]);
    result[a] = static_cast<float>(point[a]);
  }
  return result;
}

void flatten(Mesh& mesh, const fs::path& path) {
  for (std::size_t v = 0; v < mesh.coordinates.size() / 3; ++v)
    if (mesh.coordinates[3 * v + 2] != 0.0)
      fail(ErrorCode::MalformedFile, path, "vertex {} has z = {}; expected 0, as the file is marked as planar", v,
           mesh.coordinates[3 * v + 2]);
  for (Buffer<double>* const rows : {&mesh.coordinates, &mesh.normals}) {
    const std::size_t count = rows->size() / 3;
    for (std::size_t v = 0; v < count; ++v) std::copy_n(rows->data() + 3 * v, 2, rows->data() + 2 * v);
    rows->resize(2 * count);
  }
  mesh.space_dim = 2;
}

void check_indices(const Mesh& mesh, const fs::path& path) {
  const std::size_t vertices = vertex_count(mesh);
  for (std::size_t i = 0; i < mesh.simplices.size(); ++i)
    if (mesh.simplices[i] >= vertices)
      fail(ErrorCode::MalformedFile, path, "simplex {} has vertex number {}; expected less than {}",
           i / (static_cast<std::size_t>(mesh.dim) + 1), mesh.simplices[i], vertices);
}

}  // namespace io_detail

template <int N, class Real>
requires DimensionBetween<N, 2, 4> Mesh to_mesh(const Contour<N, Real>& contour) {
  Mesh mesh;
  mesh.dim = N - 1;
  mesh.space_dim = N;
  const auto copy = [](const auto& rows, Buffer<double>& to) {
    to.resize(rows.size() * N);
    for (std::size_t v = 0; v < rows.size(); ++v)
      for (std::size_t a = 0; a < N; ++a) to[v * N + a] = static_cast<double>(rows[v][a]);
  };
  copy(contour.vertices, mesh.coordinates);
  copy(contour.normals, mesh.normals);
  mesh.simplices.resize(contour.simplices.size() * N);
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (std::size_t c = 0; c < N; ++c) mesh.simplices[s * N + c] = contour.simplices[s][c];
  mesh.single_precision = std::is_same_v<Real, float>;
  mesh.axis_names = as_vector(contour.axis_names);
  mesh.axis_units = as_vector(contour.axis_units);
  mesh.vertex_attributes = contour.vertex_attributes;
  mesh.simplex_attributes = contour.simplex_attributes;
  return mesh;
}

template <int N>
requires DimensionBetween<N, 2, 4> Contour<N, double> to_contour(const Mesh& mesh) {
  const bool planar = N == 2 && mesh.dim == 1 && mesh.space_dim == 3;
  if (mesh.dim != N - 1 || (mesh.space_dim != N && !planar))
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("mesh of {}-simplices in {}-space; expected {}-simplices in {}-space", mesh.dim,
                            mesh.space_dim, N - 1, N));
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  Contour<N, double> contour;
  const auto copy = [n](const Buffer<double>& from, auto& rows) {
    rows.resize(from.size() / n);
    for (std::size_t v = 0; v < rows.size(); ++v)
      for (std::size_t a = 0; a < N; ++a) rows[v][a] = from[v * n + a];
  };
  copy(mesh.coordinates, contour.vertices);
  copy(mesh.normals, contour.normals);
  for (std::size_t v = 0; v < contour.vertices.size() && planar; ++v)
    if (mesh.coordinates[v * n + 2] != 0.0)
      throw Error(ErrorCode::UnsupportedData, fmt::format("segments in space, vertex {} with z = {}; expected z = 0", v,
                                                          mesh.coordinates[v * n + 2]));
  contour.simplices.resize(simplex_count(mesh));
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (std::size_t c = 0; c < N; ++c) contour.simplices[s][c] = mesh.simplices[s * N + c];
  for (int a = 0; a < N; ++a) {
    contour.axis_names[static_cast<std::size_t>(a)] = axis_text(mesh.axis_names, a);
    contour.axis_units[static_cast<std::size_t>(a)] = axis_text(mesh.axis_units, a);
  }
  contour.vertex_attributes = mesh.vertex_attributes;
  contour.simplex_attributes = mesh.simplex_attributes;
  return contour;
}

std::span<const MeshFileFormat> mesh_file_formats() noexcept { return kFormats; }

const MeshFileFormat* find_mesh_file_format(const fs::path& path) {
  const std::string name = lower_name(path);
  const auto* const found =
      std::ranges::find_if(kFormats, [&](const MeshFileFormat& format) { return name.ends_with(format.extension); });
  return found == kFormats.end() ? nullptr : found;
}

void write_mesh(const Mesh& mesh, const fs::path& path, const Progress& progress, Compression compression) {
  const MeshFileFormat& format = format_of(path);
  if (compression != Compression::none && format.extension != ".vtkhdf")
    fail(ErrorCode::UnsupportedFormat, path, "'{}' has no compression; expected .vtkhdf", path.extension().string());
  check_mesh(mesh, path);
  check_combination(mesh, format, path);
  tick(progress, 0.0, path);
  if (format.extension == ".ply")
    write_ply(mesh, path, progress);
  else if (is_gltf(format))
    write_gltf(mesh, path, progress);
  else if (format.extension == ".stl")
    write_stl(mesh, path, progress);
  else if (format.extension == ".obj")
    write_obj(mesh, path, progress);
  else
    write_vtkhdf(mesh, path, progress, compression);
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
  Mesh mesh = separate ? read_separately(path, options.progress, read_format) : read_format(options.progress);
  check_indices(mesh, path);
  tick(options.progress, 1.0, path);
  return mesh;
}

Mesh read_mesh(const fs::path& path, const Progress& progress) {
  ReadMeshOptions options;
  options.progress = progress;
  return read_mesh(path, options);
}

template Mesh to_mesh(const Contour<2, float>&);
template Mesh to_mesh(const Contour<3, float>&);
template Mesh to_mesh(const Contour<4, float>&);
template Mesh to_mesh(const Contour<2, double>&);
template Mesh to_mesh(const Contour<3, double>&);
template Mesh to_mesh(const Contour<4, double>&);
template Contour<2, double> to_contour<2>(const Mesh&);
template Contour<3, double> to_contour<3>(const Mesh&);
template Contour<4, double> to_contour<4>(const Mesh&);

}  // namespace tegl
