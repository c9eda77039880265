// SPDX-License-Identifier: BSD-3-Clause
//
// Derives the sets of ambiguous tiles, and the joins of cubes. Theory of the joins: runtime/src/ambiguity/saddle.cpp.
#include "cubes/ambiguity.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

#include "tegl/tile/corners.hpp"
#include "tegl/tile/diagonal_edges.hpp"

namespace tegl::gen {

namespace {

using detail::edge_base;
using detail::face_signature;

/// Vertices of Sigma, joined by its segments in squares.
class EdgeSets {
 public:
  EdgeSets() { std::iota(root_.begin(), root_.end(), 0u); }
  [[nodiscard]] unsigned find(unsigned edge) const {
    while (root_[edge] != edge) edge = root_[edge];
    return edge;
  }
  void join(unsigned a, unsigned b) { root_[find(a)] = find(b); }
  /// Number of sets among the edges of a bit set.
  [[nodiscard]] int count(std::uint32_t edges) const {
    std::uint32_t roots = 0;
    for (std::uint32_t rest = edges; rest != 0; rest &= rest - 1) roots |= 1u << find(unsigned(std::countr_zero(rest)));
    return std::popcount(roots);
  }

 private:
  std::array<unsigned, 32> root_{};
};

bool is_settled_tesseract(unsigned signature) {
  const std::uint32_t critical = detail::critical_edges<4>(signature);
  EdgeSets in_tile;
  int segments = 0, polygons = 0;
  for (unsigned f = 0; f < 8; ++f) {
    EdgeSets in_cube;
    for (unsigned q = 0; q < 6; ++q) {
      // the square's edges with a vertex, numbered in the tile
      std::uint32_t found = 0;
      for (unsigned e = 0; e < 4; ++e) found |= 1u << detail::lifted_edge(4, f, detail::lifted_edge(3, q, e));
      found &= critical;
      if (std::popcount(found) == 4) return false;  // ambiguous
      if (found == 0) continue;
      const auto a = unsigned(std::countr_zero(found)), b = unsigned(std::countr_zero(found & (found - 1)));
      in_cube.join(a, b);
      in_tile.join(a, b);
      ++segments;
    }
    const int in_this = in_cube.count(detail::face_edges(4, f) & critical);
    if (in_this > 1) return false;
    polygons += in_this;
  }
  // each square lies in two cubes
  return critical == 0 || (in_tile.count(critical) == 1 && std::popcount(critical) - segments / 2 + polygons == 2);
}

/// Regions of the corners of one sign, as the cube's surface joins them.
class Regions {
 public:
  Regions(unsigned corners, unsigned ambiguous, unsigned joined_squares) {
    for (std::uint8_t v = 0; v < 8; ++v) region_[v] = v;
    for (unsigned v = 0; v < 8; ++v)
      for (unsigned step = 1; step < 8; step *= 2)
        if (((corners >> v) & 1u) != 0 && ((corners >> (v ^ step)) & 1u) != 0) join(v, v ^ step);
    for (unsigned q = 0; q < 6; ++q) {
      if (((ambiguous & joined_squares) >> q & 1u) == 0) continue;
      const auto& s = detail::kSquareCorners[q];
      if ((corners >> s[0] & 1u) != 0)
        join(s[0], s[3]);
      else
        join(s[1], s[2]);
    }
  }
  [[nodiscard]] std::uint8_t operator[](unsigned corner) const { return region_[corner]; }

  void join(unsigned v, unsigned w) {
    const std::uint8_t from = region_[v], to = region_[w];
    std::replace(region_.begin(), region_.end(), from, to);
  }
  /// Number of regions among the given corners.
  [[nodiscard]] int count(unsigned corners) const {
    unsigned seen = 0;
    for (unsigned v = 0; v < 8; ++v)
      if ((corners >> v & 1u) != 0) seen |= 1u << region_[v];
    return std::popcount(seen);
  }

 private:
  std::array<std::uint8_t, 8> region_{};
};

/// Whether a pair of edges could join two regions. `corners`: all of the regions' sign.
bool could_join(const detail::DiagonalEdges& pair, unsigned corners, const Regions& regions) {
  const auto has = [&](unsigned v) { return (corners >> v & 1u) != 0; };
  const auto end_of = [&](unsigned v) { return has(v) ? v : v + pair.step; };
  const auto stays = [&](unsigned v) { return has(v) && has(v + pair.step); };
  const unsigned a = end_of(pair.a), c = end_of(pair.c);
  return has(a) && has(c) && !stays(pair.b) && !stays(pair.d) && regions[a] != regions[c];
}

/// 1 + the pair that decides whether regions are joined; 0: none are. ("Third" in saddle.cpp.)
std::uint8_t deciding_pair(unsigned corners, unsigned ambiguous, unsigned joined_squares) {
  const Regions regions(corners, ambiguous, joined_squares);
  if (regions.count(corners) != 2) return 0;
  std::uint8_t deciding = 0;
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const bool first = could_join(detail::kDiagonalEdges[std::size_t{2} * axis], corners, regions);
    const bool second = could_join(detail::kDiagonalEdges[std::size_t{2} * axis + 1], corners, regions);
    if (!first && !second) return 0;
    if (first != second) deciding = static_cast<std::uint8_t>(2 * axis + (first ? 1 : 2));
  }
  return deciding;
}

tables::CubeJoin join_of(std::uint8_t high_pair, std::uint8_t low_pair) {
  tables::CubeJoin join{};
  join.high_pair = high_pair;
  join.low_pair = low_pair;
  join.pairs = static_cast<std::uint8_t>((high_pair != 0) + (low_pair != 0));
  if (join.pairs != 1) return join;
  join.high = high_pair != 0;
  const detail::DiagonalEdges& pair = detail::kDiagonalEdges[(join.high ? high_pair : low_pair) - 1u];
  unsigned at = 0;
  for (const std::uint8_t lower : {pair.a, pair.c, pair.b, pair.d})
    for (const unsigned end : {unsigned{lower}, unsigned{lower} + pair.step})
      join.corners[at++] = static_cast<std::uint8_t>(end);
  return join;
}

}  // namespace

std::vector<bool> ambiguous_cubes(const ResolvedCube& cube) {
  std::vector<bool> result(256);
  for (unsigned s = 0; s < 256; ++s)
    result[s] = cube.ambiguous[s] != 0 || cube.entries[cube.first_entry[s]].components > 1;
  return result;
}

std::vector<bool> ambiguous_tesseracts() {
  std::vector<bool> result(65536);
  for (unsigned s = 0; s < result.size(); ++s) result[s] = !is_settled_tesseract(s);
  return result;
}

std::vector<tables::CubeJoin> make_cube_joins(const ResolvedCube& cube) {
  std::vector<tables::CubeJoin> result;
  for (unsigned s = 0; s < 256; ++s) {
    const unsigned ambiguous = cube.ambiguous[s];
    unsigned high = 0;  // each subset of the ambiguous squares
    do {
      result.push_back(join_of(deciding_pair(s, ambiguous, high), deciding_pair(~s & 0xffu, ambiguous, ~high)));
      high = (high - ambiguous) & ambiguous;
    } while (high != 0);
  }
  return result;
}

}  // namespace tegl::gen
