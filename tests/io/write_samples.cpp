// SPDX-License-Identifier: BSD-3-Clause
//
// Writes small meshes of every kind into a folder, for readers that are not ours.
#include <filesystem>
#include <iostream>

#include "tegl/io.hpp"

namespace {

tegl::Mesh mesh_of(int dim, int space_dim, const std::vector<double>& coordinates,
                   const std::vector<tegl::Index>& simplices) {
  tegl::Mesh mesh;
  mesh.dim = dim;
  mesh.space_dim = space_dim;
  mesh.coordinates.assign(coordinates.begin(), coordinates.end());
  mesh.simplices.assign(simplices.begin(), simplices.end());
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  try {
    const auto lines = mesh_of(1, 2, {0, 0, 1, 0.1, 2, 3}, {0, 1, 1, 2});
    auto surface = mesh_of(2, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.1}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
    auto contour4 = mesh_of(3, 4, {0, 0, 0, 7, 1, 0, 0, 7.5, 0, 1, 0, 8, 0, 0, 0.1, 9}, {0, 1, 2, 3});
    surface.normals = {0, 0, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    contour4.normals = {0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0.6, 0, 0, -0.8};
    surface.vertex_attributes = {{"temperature", "degC", 1, {1, 2, 3, 4.5}},
                                 {"flow", "m s-1", 3, {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3}}};
    surface.simplex_attributes = {{"label", "", 1, {7, 8, 9, 10}}};
    contour4.vertex_attributes = {{"age", "s", 1, {1, 2, 3, 4}}};
    contour4.simplex_attributes = {{"dsigma", "", 4, {0.1, 0.2, 0.3, 0.4}}};
    tegl::write_mesh(lines, folder / "lines.vtkhdf");
    tegl::write_mesh(surface, folder / "surface.vtkhdf");
    tegl::write_mesh(surface, folder / "surface.ply");
    tegl::write_mesh(contour4, folder / "contour4.vtkhdf");
    tegl::write_mesh(mesh_of(2, 3, {}, {}), folder / "empty.vtkhdf");
  } catch (const tegl::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
