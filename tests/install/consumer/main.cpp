// SPDX-License-Identifier: BSD-3-Clause
//
// Uses the installed core library: the contour of a ball in 4D, its slice between two time steps, and their invariants;
// single tiles, their certificate and the recognition of spheres. Returns 0 only if all are correct.
#include <cstdio>
#include <vector>

#include "tegl/tegl.hpp"
#include "tegl/tile/certificate.hpp"
#include "tegl/tile/complex.hpp"
#include "tegl/tile/facets.hpp"
#include "tegl/tile/tile_certifier.hpp"

/// A cube with two opposite high corners and a high centre: a tunnel, topologically a cylinder.
bool tunnel_is_sound() {
  using namespace tegl::tile;
  std::vector<Choice> signs(tegl::kFaceCount<3>);
  signs[tegl::face_number<3>(0, 7)] = Choice::high;
  const TileFacets tile = tegl::tile_facets<3>(0b10000001, signs);
  Simplices tunnel = tile.facets.at(0).simplices;
  for (Simplex& s : tunnel) sort_vertices(s);
  const FaceLattice cube = FaceLattice::cube(3);
  TileCertifier certifier(cube);
  std::printf("3D tile: %zu facet of %zu triangles\n", tile.facets.size(), tunnel.size());
  return tile.facets.size() == 1 && euler_characteristic(tunnel) == 0 && shape_of(tunnel) == Shape::other &&
         certify(cube, tile) == Fault::none &&
         certifier.certify(0b10000001, {.choices = signs, .alternative = Alternative::low}) == Fault::none &&
         FacetBuilder(cube).build(0b10000001).facets.size() == 2;
}

int main() {
  constexpr std::size_t kSize = 12;
  std::vector<float> values;
  for (std::size_t t = 0; t < kSize; ++t)
    for (std::size_t z = 0; z < kSize; ++z)
      for (std::size_t y = 0; y < kSize; ++y)
        for (std::size_t x = 0; x < kSize; ++x) {
          float value = 20.0F;
          for (const std::size_t c : {x, y, z, t})
            value -= (static_cast<float>(c) - 5.5F) * (static_cast<float>(c) - 5.5F);
          values.push_back(value);
        }
  const tegl::Image<float, 4> image(values.data(), tegl::Grid<4>::unit({kSize, kSize, kSize, kSize}));
  const auto contour = tegl::extract(image, 0.0);
  const tegl::MeshReport whole = tegl::check(contour);
  const tegl::MeshReport cut = tegl::check(tegl::slice(contour, tegl::Hyperplane<4>::across(3, 5.3)));
  std::printf("4D: %zu tetrahedra, Euler characteristic %lld; cut: %zu triangles, Euler characteristic %lld\n",
              static_cast<std::size_t>(whole.simplices), static_cast<long long>(whole.euler),
              static_cast<std::size_t>(cut.simplices), static_cast<long long>(cut.euler));
  const bool sound = whole.components == 1 && whole.boundary_simplices == 0 && whole.euler == 0 &&
                     cut.components == 1 && cut.boundary_simplices == 0 && cut.euler == 2;
  return sound && tunnel_is_sound() ? 0 : 1;
}
