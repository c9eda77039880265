// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes: between contours and files.
#include <algorithm>
#include <array>
#include <string_view>

#include "common.hpp"
#include "mesh_formats.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

using namespace io_detail;

enum class MeshFormat { Ply, Gltf, VtkHdf, Soup };

struct MeshExtension {
  std::string_view text;
  MeshFormat format;
};

constexpr std::array<MeshExtension, 6> kExtensions = {{{".ply", MeshFormat::Ply},
                                                       {".gltf", MeshFormat::Gltf},
                                                       {".glb", MeshFormat::Gltf},
                                                       {".vtkhdf", MeshFormat::VtkHdf},
                                                       {".stl", MeshFormat::Soup},
                                                       {".obj", MeshFormat::Soup}}};

MeshFormat format_of(const fs::path& path, std::string_view expected) {
  const std::string name = lower_name(path);
  for (const MeshExtension& extension : kExtensions)
    if (name.ends_with(extension.text)) return extension.format;
  fail(ErrorCode::UnsupportedFormat, path, "no mesh format known by the extension '{}'; expected {}",
       path.extension().string(), expected);
}

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
  const std::size_t vertices = vertex_count(mesh);
  const auto bad = std::find_if(mesh.simplices.begin(), mesh.simplices.end(), [&](Index i) { return i >= vertices; });
  if (bad != mesh.simplices.end())
    fail(ErrorCode::InvalidArgument, path, "mesh with vertex number {}; expected less than {}", *bad, vertices);
}

/// Lines and triangles go into every format; tetrahedra, and a fourth coordinate, into VTKHDF alone.
void check_combination(const Mesh& mesh, MeshFormat format, const fs::path& path) {
  if (format == MeshFormat::Soup)
    fail(ErrorCode::UnsupportedFormat, path, "'{}' is read only; expected .ply, .gltf, .glb or .vtkhdf to write",
         path.extension().string());
  if ((mesh.dim == 3 || mesh.space_dim == 4) && format != MeshFormat::VtkHdf)
    fail(ErrorCode::UnsupportedFormat, path,
         "'{}' cannot hold {}-simplices in {}-space (the contour of a {}D image); "
         "expected .vtkhdf",
         path.extension().string(), mesh.dim, mesh.space_dim, mesh.space_dim);
}

template <class Names>
std::vector<std::string> as_vector(const Names& names) {
  return {names.begin(), names.end()};
}

}  // namespace

namespace io_detail {

void flatten(Mesh& mesh, const fs::path& path) {
  const std::size_t vertices = mesh.coordinates.size() / 3;
  for (std::size_t v = 0; v < vertices; ++v) {
    if (mesh.coordinates[3 * v + 2] != 0.0)
      fail(ErrorCode::MalformedFile, path, "vertex {} has z = {}; expected 0, as the file says that it is planar", v,
           mesh.coordinates[3 * v + 2]);
    mesh.coordinates[2 * v] = mesh.coordinates[3 * v];
    mesh.coordinates[2 * v + 1] = mesh.coordinates[3 * v + 1];
  }
  mesh.coordinates.resize(2 * vertices);
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
Mesh to_mesh(const Contour<N, Real>& contour) {
  Mesh mesh;
  mesh.dim = N - 1;
  mesh.space_dim = N;
  mesh.coordinates.resize(contour.vertices.size() * N);
  for (std::size_t v = 0; v < contour.vertices.size(); ++v)
    for (std::size_t a = 0; a < N; ++a) mesh.coordinates[v * N + a] = static_cast<double>(contour.vertices[v][a]);
  mesh.simplices.resize(contour.simplices.size() * N);
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (std::size_t c = 0; c < N; ++c) mesh.simplices[s * N + c] = contour.simplices[s][c];
  mesh.axis_names = as_vector(contour.axis_names);
  mesh.axis_units = as_vector(contour.axis_units);
  return mesh;
}

template <int N>
Contour<N, double> to_contour(const Mesh& mesh) {
  const bool planar = N == 2 && mesh.dim == 1 && mesh.space_dim == 3;
  if (mesh.dim != N - 1 || (mesh.space_dim != N && !planar))
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("mesh of {}-simplices in {}-space; expected {}-simplices in {}-space", mesh.dim,
                            mesh.space_dim, N - 1, N));
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  Contour<N, double> contour;
  contour.vertices.resize(vertex_count(mesh));
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    for (std::size_t a = 0; a < N; ++a) contour.vertices[v][a] = mesh.coordinates[v * n + a];
    if (planar && mesh.coordinates[v * n + 2] != 0.0)
      throw Error(ErrorCode::UnsupportedData, fmt::format("segments in space, vertex {} with z = {}; expected z = 0", v,
                                                          mesh.coordinates[v * n + 2]));
  }
  contour.simplices.resize(simplex_count(mesh));
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (std::size_t c = 0; c < N; ++c) contour.simplices[s][c] = mesh.simplices[s * N + c];
  for (int a = 0; a < N; ++a) {
    contour.axis_names[static_cast<std::size_t>(a)] = axis_text(mesh.axis_names, a);
    contour.axis_units[static_cast<std::size_t>(a)] = axis_text(mesh.axis_units, a);
  }
  return contour;
}

void write_mesh(const Mesh& mesh, const fs::path& path, const Progress& progress) {
  const MeshFormat format = format_of(path, ".ply, .gltf, .glb or .vtkhdf");
  check_mesh(mesh, path);
  check_combination(mesh, format, path);
  tick(progress, 0.0, path);
  switch (format) {
    case MeshFormat::Ply:
      write_ply(mesh, path, progress);
      break;
    case MeshFormat::Gltf:
      write_gltf(mesh, path, progress);
      break;
    default:
      write_vtkhdf(mesh, path, progress);
      break;
  }
}

Mesh read_mesh(const fs::path& path) {
  require_readable_file(path);
  Mesh mesh;
  switch (format_of(path, ".ply, .gltf, .glb, .vtkhdf, .stl or .obj")) {
    case MeshFormat::Ply:
      mesh = read_ply(path);
      break;
    case MeshFormat::Gltf:
      mesh = read_gltf(path);
      break;
    case MeshFormat::VtkHdf:
      mesh = read_vtkhdf(path);
      break;
    default:
      mesh = read_with_assimp(path);
      break;
  }
  check_indices(mesh, path);
  return mesh;
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
