// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the tiles of every kind and dimension: corners, edges, and faces as tiles of one dimension less.
#include "base/lattice.hpp"

#include <stdexcept>
#include <utility>

#include "base/determinant.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

std::string edge_name(int n, int axis, std::uint32_t base) {
  std::string name;
  for (int i = n - 1; i >= 0; --i) name += i == axis ? 'e' : ((base >> i) & 1) != 0 ? '1' : '0';
  return name;
}

Tile make_cube(int n, const Tile* face) {
  Tile tile;
  tile.dim = n;
  for (std::uint32_t v = 0; v < 1u << n; ++v) {
    std::array<double, 4> x{};
    for (int i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] = (v >> i) & 1;
    tile.corners.push_back(x);
  }
  const std::uint32_t half = n > 0 ? 1u << (n - 1) : 0;
  for (int axis = 0; axis < n; ++axis)
    for (std::uint32_t rest = 0; rest < half; ++rest) {
      const std::uint32_t base = detail::unsqueeze(rest, static_cast<unsigned>(axis));
      tile.edges.push_back({static_cast<std::uint8_t>(base), static_cast<std::uint8_t>(base | (1u << axis))});
      tile.edge_names.push_back(edge_name(n, axis, base));
    }
  for (unsigned f = 0; f < 2 * static_cast<unsigned>(n); ++f) {
    SubTile sub{face, {}, {}, detail::face_sign(f)};
    for (std::uint32_t v = 0; v < half; ++v)
      sub.corner.push_back(static_cast<std::uint8_t>(detail::lifted_corner(f, v)));
    for (const auto& [a, b] : face->edges) sub.edge.push_back(tile.edge_between(sub.corner[a], sub.corner[b]));
    tile.faces.push_back(std::move(sub));
  }
  return tile;
}

using Coordinates = std::array<double, 4>;

Coordinates difference(const Coordinates& a, const Coordinates& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
}

Coordinates centre_of(const std::vector<Coordinates>& corners, const std::vector<std::uint8_t>& chosen) {
  Coordinates sum{};
  for (const std::uint8_t v : chosen)
    for (std::size_t i = 0; i < 4; ++i) sum[i] += corners[v][i] / static_cast<double>(chosen.size());
  return sum;
}

/// Adds every pair of corners for which `joined` holds as an edge.
template <class Joined>
void add_edges(Tile& tile, const Joined& joined) {
  for (std::uint8_t a = 0; a < tile.corner_count(); ++a)
    for (std::uint8_t b = static_cast<std::uint8_t>(a + 1); b < tile.corner_count(); ++b)
      if (joined(a, b)) {
        tile.edges.push_back({a, b});
        tile.edge_names.push_back(std::to_string(a) + std::to_string(b));
      }
}

/// Adds the simplex with these ascending corners as a face. Its sign is the orientation of (outward normal, own frame).
void add_face(Tile& tile, const Tile* face, std::vector<std::uint8_t> corner) {
  std::vector<std::uint8_t> all;
  for (std::uint8_t v = 0; v < tile.corner_count(); ++v) all.push_back(v);
  std::array<Coordinates, 4> frame{difference(centre_of(tile.corners, corner), centre_of(tile.corners, all))};
  for (std::size_t i = 1; i < corner.size(); ++i)
    frame[i] = difference(tile.corners[corner[i]], tile.corners[corner[0]]);
  SubTile sub{face, std::move(corner), {}, determinant(frame, tile.dim) > 0 ? 1 : -1};
  for (const auto& [a, b] : face->edges) sub.edge.push_back(tile.edge_between(sub.corner[a], sub.corner[b]));
  tile.faces.push_back(std::move(sub));
}

Tile make_simplex(int n, const Tile* face) {
  Tile tile;
  tile.kind = TileKind::simplex;
  tile.dim = n;
  for (int v = 0; v <= n; ++v) {
    Coordinates x{};
    if (v > 0) x[static_cast<std::size_t>(v - 1)] = 1;
    tile.corners.push_back(x);
  }
  add_edges(tile, [](int, int) { return true; });
  for (int without = 0; n > 0 && without <= n; ++without) {
    std::vector<std::uint8_t> corner;
    for (int v = 0; v <= n; ++v)
      if (v != without) corner.push_back(static_cast<std::uint8_t>(v));
    add_face(tile, face, std::move(corner));
  }
  return tile;
}

Tile make_octahedron(const Tile* triangle) {
  Tile tile;
  tile.kind = TileKind::octahedron;
  tile.dim = 3;
  for (std::size_t v = 0; v < 6; ++v) {
    Coordinates x{};
    x[v / 2] = v % 2 == 0 ? -1 : 1;
    tile.corners.push_back(x);
  }
  add_edges(tile, [](int a, int b) { return a / 2 != b / 2; });
  for (std::uint8_t f = 0; f < 8; ++f)
    add_face(tile, triangle,
             {static_cast<std::uint8_t>(f & 1u), static_cast<std::uint8_t>(2 + (f >> 1 & 1)),
              static_cast<std::uint8_t>(4 + (f >> 2 & 1))});
  return tile;
}

}  // namespace

Signature SubTile::corners() const {
  Signature result = 0;
  for (const std::uint8_t v : corner) result |= Signature{1} << v;
  return result;
}

Signature Tile::restrict_to(std::uint32_t f, Signature signature) const {
  const auto& corner = faces[f].corner;
  Signature result = 0;
  for (std::size_t v = 0; v < corner.size(); ++v) result |= ((signature >> corner[v]) & 1u) << v;
  return result;
}

std::uint8_t Tile::edge_between(std::uint32_t a, std::uint32_t b) const {
  for (std::uint8_t e = 0; e < edge_count(); ++e)
    if ((edges[e][0] == a && edges[e][1] == b) || (edges[e][0] == b && edges[e][1] == a)) return e;
  throw std::logic_error("no edge between two corners of a tile");
}

std::vector<std::uint8_t> edge_permutation(const Tile& tile, std::span<const std::uint32_t> corner_images) {
  std::vector<std::uint8_t> result;
  for (const auto& [a, b] : tile.edges) result.push_back(tile.edge_between(corner_images[a], corner_images[b]));
  return result;
}

const char* tile_kind_name(TileKind kind) noexcept {
  constexpr const char* kNames[] = {"cube", "simplex", "octahedron", "other"};
  return kNames[static_cast<std::size_t>(kind)];
}

Lattice::Lattice(TileKind kind, int n) {
  if (n < 1 || n > 4 || (kind == TileKind::octahedron && n != 3) || kind == TileKind::other)
    throw std::invalid_argument("lattice: expected cubes or simplices of dimension 1 to 4, or the octahedron");
  tiles_.reserve(static_cast<std::size_t>(n) + 1);  // faces point at their tiles: no reallocation
  tiles_.push_back(kind == TileKind::cube ? make_cube(0, nullptr) : make_simplex(0, nullptr));
  for (int k = 1; k <= n; ++k) {
    const Tile* const face = &tiles_.back();
    tiles_.push_back(kind == TileKind::cube                   ? make_cube(k, face)
                     : kind == TileKind::octahedron && k == n ? make_octahedron(face)
                                                              : make_simplex(k, face));
  }
}

}  // namespace tegl::gen
