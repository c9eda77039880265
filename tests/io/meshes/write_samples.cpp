// SPDX-License-Identifier: BSD-3-Clause
//
// Writes small meshes of every kind, an image and contours of other tilings into a folder, for the readers of other
// programs.
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <random>

#include "tegl/extract.hpp"
#include "tegl/io.hpp"
#include "tegl/lattice.hpp"
#include "tegl/periodic.hpp"

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

/// The facets of the hyperplane x_last = 0.37 + 0.4 x + 0.3 y + 0.2 z over 4^(N-1) unit cells, with normals.
template <int N, class Real = double>
tegl::FacetHierarchy<N, Real> facets_of_plane() {
  constexpr std::array<double, 3> kSlopes = {0.4, 0.3, 0.2};
  std::array<std::size_t, N> sizes;
  sizes.fill(5);
  tegl::OwnedImage<double, N> image{tegl::Grid<N>::unit(sizes), {}};
  image.grid.axes[N - 1].name = "height & <time>";
  std::size_t samples = 1;
  for (const std::size_t size : sizes) samples *= size;
  for (std::size_t i = 0; i < samples; ++i) {
    double value = -0.37;
    std::size_t rest = i;
    for (std::size_t a = 0; a < N; ++a, rest /= 5)
      value += static_cast<double>(rest % 5) * (a + 1 == N ? 1.0 : -kSlopes[a]);
    image.values.push_back(value);
  }
  tegl::ExtractOptions options;
  options.normals = tegl::Normals::differences;
  return tegl::extract_facets<Real>(image.view(), 0.0, options);
}

/// A closed surface of noise with many components, tunnels and normals. No sample is near the isovalue.
tegl::Contour<3, double> closed_noise() {
  tegl::OwnedImage<float, 3> image{tegl::Grid<3>::unit({12, 13, 14}), {}};
  std::mt19937 random(7);
  for (int i = 0; i < 12 * 13 * 14; ++i)
    image.values.push_back((random() % 2 == 0 ? 1.0F : -1.0F) * static_cast<float>(1 + random() % 100));
  tegl::ExtractOptions options;
  options.close = true;
  options.normals = tegl::Normals::differences;
  return tegl::extract<double>(image.view(), 0.0, options);
}

/// A ball of radius 0.3 around (x, 0.5, 0.5) in 12 x 14 x 16 samples of the unit cube, of which the first axis is
/// periodic.
tegl::OwnedImage<double, 3> ball_at(double x) {
  tegl::OwnedImage<double, 3> image;
  for (const std::size_t size : {12u, 14u, 16u})
    image.grid.axes[(size - 12) / 2] = tegl::Axis::uniform(size, 0.0, 1.0 / static_cast<double>(size));
  for (std::size_t i = 0; i < 12 * 14 * 16; ++i) {
    const double dx = static_cast<double>(i % 12) / 12 - x, dy = static_cast<double>(i / 12 % 14) / 14 - 0.5;
    image.values.push_back(0.3 - std::hypot(dx - std::round(dx), dy, static_cast<double>(i / 168) / 16 - 0.5));
  }
  return image;
}

/// An image, and its contours: plain, wrapped, unrolled, and on a lattice.
void write_ball(const std::filesystem::path& folder) {
  const auto plain = ball_at(0.5), across = ball_at(0.0);
  tegl::write_image(plain.view(), folder / "ball.vti");
  tegl::write_mesh(tegl::to_mesh(tegl::extract<double>(plain.view(), 0.0)), folder / "ball.vtkhdf");
  const auto wrapped = tegl::extract_periodic<double>(across.view(), {1.0, 0.0, 0.0}, 0.0);
  tegl::write_mesh(tegl::to_mesh(wrapped), folder / "wrapped.vtkhdf");
  tegl::write_mesh(tegl::to_mesh(tegl::unroll(wrapped).contour), folder / "unrolled.vtkhdf");
  tegl::write_mesh(tegl::to_mesh(tegl::extract_lattice<double>(plain.view(), tegl::Lattice::fcc, 0.0)),
                   folder / "fcc.vtkhdf");
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
    for (auto* const mesh : {&surface, &contour4}) mesh->single_precision = true;
    tegl::write_mesh(surface, folder / "surface_float.vtkhdf", {.compression = tegl::Compression::deflate});
    tegl::write_mesh(surface, folder / "surface_float.ply");
    tegl::write_mesh(contour4, folder / "contour4_float.vtkhdf");
    tegl::write_mesh(mesh_of(2, 3, {}, {}), folder / "empty.vtkhdf");
    for (const char* const name : {"noise.ply", "noise.stl", "noise.obj"})
      tegl::write_mesh(closed_noise(), folder / name);
    tegl::write_mesh(lines, folder / "lines.obj");
    tegl::write_mesh(mesh_of(2, 3, {}, {}), folder / "empty.stl");
    write_ball(folder);
    tegl::write_facets(facets_of_plane<2>(), folder / "segments.vtu");
    tegl::write_facets(facets_of_plane<3>(), folder / "polygons.vtu");
    tegl::write_facets(facets_of_plane<3>(), folder / "polygons.vtkhdf");
    tegl::write_facets(facets_of_plane<4>(), folder / "polyhedra.vtu");
    tegl::write_facets(facets_of_plane<4>(), folder / "polyhedra_packed.vtu",
                       {.compression = tegl::Compression::deflate});
    tegl::write_facets(facets_of_plane<3, float>(), folder / "polygons_float.vtkhdf",
                       {.compression = tegl::Compression::deflate});
    tegl::write_facets(facets_of_plane<4, float>(), folder / "polyhedra_float.vtu");
    tegl::write_facets(facets_of_plane<4, float>(), folder / "polyhedra_float_packed.vtu",
                       {.compression = tegl::Compression::deflate});
    tegl::write_facets(tegl::FacetHierarchy<4, float>(), folder / "nothing.vtu");
    tegl::write_facets(tegl::FacetHierarchy<4, float>(), folder / "nothing_packed.vtu",
                       {.compression = tegl::Compression::deflate});
  } catch (const tegl::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
