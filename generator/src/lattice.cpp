// SPDX-License-Identifier: BSD-3-Clause
#include "tegl/gen/lattice.hpp"

#include <stdexcept>

namespace tegl::gen {

namespace {

/// Inserts a bit of value `bit` at position `at`.
std::uint32_t spread(std::uint32_t v, int at, std::uint32_t bit) {
  const std::uint32_t below = v & ((1u << at) - 1);
  return ((v & ~((1u << at) - 1)) << 1) | (bit << at) | below;
}

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
      const std::uint32_t base = spread(rest, axis, 0);
      tile.edges.push_back({static_cast<std::uint8_t>(base), static_cast<std::uint8_t>(base | (1u << axis))});
      tile.edge_names.push_back(edge_name(n, axis, base));
    }
  for (int axis = 0; axis < n; ++axis)
    for (std::uint32_t side = 0; side < 2; ++side) {
      SubTile sub{face, {}, {}, (axis % 2 == 0) == (side == 1) ? 1 : -1};
      for (std::uint32_t v = 0; v < half; ++v) sub.corner.push_back(static_cast<std::uint8_t>(spread(v, axis, side)));
      for (const auto& ends : face->edges)
        for (std::uint32_t e = 0; e < tile.edge_count(); ++e)
          if (tile.edges[e][0] == sub.corner[ends[0]] && tile.edges[e][1] == sub.corner[ends[1]])
            sub.edge.push_back(static_cast<std::uint8_t>(e));
      tile.faces.push_back(std::move(sub));
    }
  return tile;
}

}  // namespace

Signature Tile::restrict_to(std::uint32_t f, Signature signature) const {
  const auto& corner = faces[f].corner;
  Signature result = 0;
  for (std::size_t v = 0; v < corner.size(); ++v) result |= ((signature >> corner[v]) & 1u) << v;
  return result;
}

std::vector<std::uint8_t> edge_permutation(const Tile& tile, std::span<const std::uint32_t> corner_images) {
  std::vector<std::uint8_t> result;
  for (const auto& [a, b] : tile.edges) {
    const std::uint32_t to_a = corner_images[a], to_b = corner_images[b];
    for (std::uint8_t e = 0; e < tile.edge_count(); ++e)
      if ((tile.edges[e][0] == to_a && tile.edges[e][1] == to_b) ||
          (tile.edges[e][0] == to_b && tile.edges[e][1] == to_a))
        result.push_back(e);
  }
  return result;
}

CubeLattice::CubeLattice(int n) {
  if (n < 1 || n > 4) throw std::invalid_argument("cube lattice: dimension must be 1 to 4");
  tiles_.reserve(static_cast<std::size_t>(n) + 1);  // faces point at their tiles: no reallocation
  tiles_.push_back(make_cube(0, nullptr));
  for (int k = 1; k <= n; ++k) tiles_.push_back(make_cube(k, &tiles_.back()));
}

}  // namespace tegl::gen
