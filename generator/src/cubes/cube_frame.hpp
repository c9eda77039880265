// SPDX-License-Identifier: BSD-3-Clause
//
// The cube's edges, squares and rays in the numbering of the table contract, and polygons on its boundary.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/lattice.hpp"
#include "embedding/embedding_proof.hpp"
#include "tegl/tile/face_lattice.hpp"

namespace tegl::gen {

/// A triangle of a cube's contour. Vertices below 12 are points on edges; 12 + j is own vertex j.
using CubeTriangle = std::array<std::uint8_t, 3>;
using CubeTriangles = std::vector<CubeTriangle>;
/// A polygon by its edges, with high corners on its left seen from outside.
using CubePolygon = std::vector<std::uint8_t>;

/// The mask of a vertex on a ray holds only corners: those of a corner, an edge or a square of the cube. The ray goes
/// from the cube's centre to their mean.
[[nodiscard]] constexpr bool is_on_ray(std::uint32_t mask) { return (mask & 0xffu) != 0; }

/// Vectors from the cube's centre to a corner, and along the ray of a mask, in halves of an edge.
[[nodiscard]] EmbeddingProof::Ray ray_to_corner(unsigned corner);
[[nodiscard]] EmbeddingProof::Ray ray_of(std::uint32_t mask);

/// The cube's faces, by number.
struct CubeFrame {
  static constexpr std::size_t kEdges = 12;

  tile::FaceLattice lattice = tile::FaceLattice::cube(3);
  CubeLattice tiles{3};
  std::vector<std::uint8_t> edge_of_face;              ///< by face of the lattice that is an edge
  std::array<std::uint32_t, 6> face_of_square{};       ///< in the lattice
  std::array<std::array<std::uint8_t, 4>, 6> squares;  ///< the corners of each square
  std::array<unsigned, kEdges> squares_of{};           ///< by edge: set of the squares that contain it

  CubeFrame();
  [[nodiscard]] const Tile& cube() const { return tiles.tile(3); }
  /// The midpoint of an edge, from the cube's centre, in halves of an edge.
  [[nodiscard]] std::array<double, 3> midpoint(std::size_t edge) const;
};

}  // namespace tegl::gen
