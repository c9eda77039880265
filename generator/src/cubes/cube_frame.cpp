// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of the cube's faces, and its rays.
#include "cubes/cube_frame.hpp"

#include <algorithm>
#include <bit>

namespace tegl::gen {

EmbeddingProof::Ray ray_to_corner(unsigned corner) {
  EmbeddingProof::Ray ray{};
  for (unsigned a = 0; a < 3; ++a) ray[a] = (corner >> a & 1u) != 0 ? 1 : -1;
  return ray;
}

EmbeddingProof::Ray ray_of(std::uint32_t mask) {
  EmbeddingProof::Ray sum{};
  for (unsigned v = 0; v < 8; ++v)
    for (unsigned a = 0; a < 3; ++a)
      if ((mask >> v & 1u) != 0) sum[a] += ray_to_corner(v)[a];
  const int corners = std::popcount(mask & 0xffu);
  for (int& x : sum) x /= corners;
  return sum;
}

CubeFrame::CubeFrame() : edge_of_face(lattice.faces().size()) {
  for (std::uint8_t e = 0; e < kEdges; ++e)
    edge_of_face[lattice.find(Signature{1} << cube().edges[e][0] | Signature{1} << cube().edges[e][1]).value()] = e;
  for (std::size_t q = 0; q < 6; ++q) {
    std::copy_n(cube().faces[q].corner.begin(), 4, squares[q].begin());
    face_of_square[q] = lattice.find(cube().faces[q].corners()).value();
    for (const std::uint8_t e : cube().faces[q].edge) squares_of[e] |= 1u << q;
  }
}

std::array<double, 3> CubeFrame::midpoint(std::size_t edge) const {
  std::array<double, 3> point;
  for (std::size_t a = 0; a < 3; ++a)
    point[a] = cube().corners[cube().edges[edge][0]][a] + cube().corners[cube().edges[edge][1]][a] - 1;
  return point;
}

}  // namespace tegl::gen
