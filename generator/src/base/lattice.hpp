// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles as face lattices. A tile holds its corners, its edges, and its faces of codimension one as tiles with their
// embedding and their sign in the boundary. The recursion over dimension in filling/ uses only these data, so it works
// for any polytope described this way.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tegl/tile/face_lattice.hpp"

namespace tegl::gen {

using tile::Signature;

struct Tile;

/// Shape of a tile. It determines all lower tiles of a lattice: faces of cubes are cubes; faces of simplices and of the
/// octahedron are simplices. `other`: any polytope that is given by its faces (cells/cell.hpp); it has no Lattice.
enum class TileKind { cube, simplex, octahedron, other };
const char* tile_kind_name(TileKind kind) noexcept;  ///< "cube", "simplex", "octahedron", "other"

/// A face of codimension one, as a tile with its embedding.
struct SubTile {
  const Tile* tile;                  ///< owned by the lattice
  std::vector<std::uint8_t> corner;  ///< the face's corner -> the tile's corner
  std::vector<std::uint8_t> edge;    ///< the face's edge -> the tile's edge, ends in the same order
  int sign;                          ///< incidence number in the tile's boundary, outward normal first

  [[nodiscard]] Signature corners() const;  ///< the tile's corners in this face
};

/// A tile of some dimension.
struct Tile {
  TileKind kind = TileKind::cube;                  ///< the kind of tile
  int dim = 0;                                     ///< dimension
  std::vector<std::array<double, 4>> corners;      ///< coordinates; only the first `dim` are used
  std::vector<std::array<std::uint8_t, 2>> edges;  ///< from the end with coordinate 0 to the one with 1
  std::vector<std::string> edge_names;  ///< cubes: ternary, highest axis first, 'e' = free axis; else the two corners
  std::vector<SubTile> faces;           ///< codimension one; empty for dim 0

  [[nodiscard]] std::uint32_t corner_count() const { return static_cast<std::uint32_t>(corners.size()); }  ///< count
  [[nodiscard]] std::uint32_t edge_count() const { return static_cast<std::uint32_t>(edges.size()); }      ///< count
  /// All corners.
  [[nodiscard]] Signature full() const { return ~Signature{0} >> (64 - corner_count()); }
  /// The signature restricted to face f, in the numbering of the face's corners.
  [[nodiscard]] Signature restrict_to(std::uint32_t f, Signature signature) const;
  /// The edge between two corners, in either order. Throws std::logic_error if there is none.
  [[nodiscard]] std::uint8_t edge_between(std::uint32_t a, std::uint32_t b) const;
};

/// The images of a tile's edges under a permutation of its corners that maps edges to edges.
std::vector<std::uint8_t> edge_permutation(const Tile& tile, std::span<const std::uint32_t> corner_images);

/// A tile of dimension n and the tiles of its faces, of every dimension down to 0. n <= 4; the octahedron has n = 3.
///
/// Cubes are numbered as in the table contract. Simplices: corner 0 is the origin, corner i the unit point of axis i -
/// 1; face i lacks corner i. Octahedron: corner 2 a + side is the point -1 or +1 of axis a; face f has the corners 2 a
/// + (f >> a & 1). Edges of simplices and octahedra are the pairs (a, b), a < b, in ascending order, and their faces
/// keep the order of corners.
class Lattice {
 public:
  /// Throws std::invalid_argument if the kind does not exist in dimension n.
  Lattice(TileKind kind, int n);
  Lattice(const Lattice&) = delete;
  Lattice& operator=(const Lattice&) = delete;

  [[nodiscard]] int dim() const { return static_cast<int>(tiles_.size()) - 1; }                ///< highest dimension
  [[nodiscard]] const Tile& tile(int k) const { return tiles_[static_cast<std::size_t>(k)]; }  ///< of dimension k

 private:
  std::vector<Tile> tiles_;
};

/// The unit cubes of dimension 0 to n (n <= 4).
class CubeLattice : public Lattice {
 public:
  /// Builds the cubes of dimension 0 to n.
  explicit CubeLattice(int n) : Lattice(TileKind::cube, n) {}
};

}  // namespace tegl::gen
