// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the distinct lists of the resolved cube and converts their connected components to the frame of the
// tesseract.
#include "builders/cube_lists.hpp"

#include <algorithm>
#include <bit>

#include "base/error.hpp"
#include "cubes/ambiguity.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

constexpr unsigned kCubeEdges = CubeLists::kCubeEdges;

/// By vertex of a list: set of vertices connected to it by an edge, including itself.
using Neighbours = std::array<std::uint32_t, kCubeEdges + CubeLists::kMostOwn>;

Neighbours neighbours_of(std::span<const std::uint8_t> triangles) {
  Neighbours result{};
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    for (std::size_t i = t; i < t + 3; ++i)
      result[triangles[i]] |= 1u << triangles[t] | 1u << triangles[t + 1] | 1u << triangles[t + 2];
  return result;
}

/// Set of vertices connected to `vertex`.
std::uint32_t connected(const Neighbours& neighbours, unsigned vertex) {
  std::uint32_t reached = 1u << vertex, before = 0;
  while (reached != before) {
    before = reached;
    for (std::uint32_t rest = before; rest != 0; rest &= rest - 1)
      reached |= neighbours[static_cast<unsigned>(std::countr_zero(rest))];
  }
  return reached;
}

/// Whether the cone from this vertex has no simplex in the cube that is not in the list: it is adjacent to all other
/// vertices of its part, and any two adjacent ones of these form a triangle with it.
bool may_be_apex(std::span<const std::uint8_t> triangles, const Neighbours& neighbours, unsigned vertex,
                 std::uint32_t part) {
  if ((part & ~neighbours[vertex]) != 0) return false;
  unsigned around = 0, edges = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    if (triangles[t] == vertex || triangles[t + 1] == vertex || triangles[t + 2] == vertex) ++around;
  for (std::uint32_t rest = part & ~(1u << vertex); rest != 0; rest &= rest - 1) {
    const std::uint32_t beside = neighbours[static_cast<unsigned>(std::countr_zero(rest))];
    edges += static_cast<unsigned>(std::popcount(beside & part & ~(1u << vertex))) - 1;
  }
  return edges == 2 * around;  // each edge was counted from both ends
}

void take_compact(const ResolvedCube& cube, const tables::ResolvedList& from, CubeLists& result) {
  CubeLists::List& list = result.lists.back();
  const auto first = cube.triangles.begin() + 3 * std::ptrdiff_t{from.first_triangle};
  result.triangles.insert(result.triangles.end(), first, first + 3 * std::ptrdiff_t{from.triangle_count});
  list.triangle_count = from.triangle_count;
  list.own_vertices = from.own_vertices;
  for (std::size_t j = 0; j < from.own_vertices; ++j) list.masks[j] = cube.masks[from.first_mask + j];
}

void take_barycentric(const TileTables& table, CubeLists& result) {
  CubeLists::List& list = result.lists.back();
  const tables::List& from = table.lists[table.list_of[list.key]];
  const auto first = table.simplices.begin() + 3 * std::ptrdiff_t{from.first_simplex};
  const std::vector<std::uint8_t> triangles(first, first + 3 * std::ptrdiff_t{from.simplex_count});
  result.triangles.insert(result.triangles.end(), triangles.begin(), triangles.end());
  const unsigned own = unsigned{from.cone_vertices} + from.side_vertices;
  if (own > CubeLists::kMostOwn)
    throw Error(ErrorCode::Internal, "a cube with more vertices of its own than tesseracts have numbers for");
  for (unsigned j = from.cone_vertices; j < own; ++j)
    list.masks[j] = static_cast<std::uint32_t>(table.side_masks[from.first_side + j - from.cone_vertices]);
  for (std::size_t t = 0; t < triangles.size(); t += 3)  // a barycentre is the first vertex of its triangles
    if (triangles[t] >= kCubeEdges && triangles[t] < kCubeEdges + from.cone_vertices)
      list.masks[triangles[t] - kCubeEdges] |= 1u << (8 + triangles[t + 1]) | 1u << (8 + triangles[t + 2]);
  list.triangle_count = static_cast<std::uint8_t>(from.simplex_count);
  list.own_vertices = static_cast<std::uint8_t>(own);
  list.barycentres = from.cone_vertices;
}

/// Numbers the distinct lists by signature, resolution and choice.
void number_lists(const ResolvedCube& cube, const VariantTables& variants, CubeLists& result) {
  const std::vector<bool> ambiguous_signatures = ambiguous_cubes(cube);
  result.list_of.assign(3 * cube.entries.size(), CubeLists::kNone);
  for (unsigned s = 1; s < 255; ++s) {
    const unsigned ambiguous = cube.ambiguous[s];
    unsigned high = 0, r = 0;  // each subset of the ambiguous squares
    do {
      const unsigned entry = cube.first_entry[s] + r;
      const tables::ResolvedEntry& of = cube.entries[entry];
      const std::array<const tables::ResolvedList*, 3> lists = {&of.separate, &of.low, &of.high};
      for (unsigned choice = 0; choice < 3; ++choice) {
        unsigned same = 0;
        while (lists[same]->first_triangle != lists[choice]->first_triangle) ++same;
        if (same != choice) {
          result.list_of[3 * std::size_t{entry} + choice] = result.list_of[3 * std::size_t{entry} + same];
          continue;
        }
        result.list_of[3 * std::size_t{entry} + choice] = static_cast<std::uint16_t>(result.lists.size());
        CubeLists::List& list = result.lists.emplace_back();
        list.entry = static_cast<std::uint16_t>(entry);
        list.choice = static_cast<std::uint8_t>(choice);
        list.signature = static_cast<std::uint8_t>(s);
        list.high_squares = static_cast<std::uint8_t>(high);
        list.key = static_cast<std::uint16_t>(ambiguous_signatures[s] ? s | (1 + 3 * r + choice) << 8 : s);
        list.first_triangle = static_cast<std::uint32_t>(result.triangles.size() / 3);
        if (result.triangulation == Triangulation::compact)
          take_compact(cube, *lists[choice], result);
        else
          take_barycentric(variants.tile, result);
      }
      ++r;
      high = (high - ambiguous) & ambiguous;
    } while (high != 0);
  }
}

/// Appends the parts of a list in cube f.
void add_parts(unsigned f, std::size_t list, CubeLists& result) {
  const std::span<const std::uint8_t> triangles = result.triangles_of(list);
  const Neighbours neighbours = neighbours_of(triangles);
  std::uint32_t done = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    if ((done >> triangles[t] & 1u) != 0) continue;
    const std::uint32_t vertices = connected(neighbours, triangles[t]);
    done |= vertices;
    CubeLists::Part part{0, static_cast<std::uint32_t>(result.words.size()), 0, static_cast<std::uint8_t>(f), 0};
    for (std::uint32_t rest = vertices; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<unsigned>(std::countr_zero(rest));
      part.vertices |= std::uint64_t{1} << lifted_vertex(f, v);
      if (v < kCubeEdges && !may_be_apex(triangles, neighbours, v, vertices))
        part.not_apexes = static_cast<std::uint16_t>(part.not_apexes | 1u << v);
    }
    for (std::size_t u = t; u < triangles.size(); u += 3) {
      if ((vertices >> triangles[u] & 1u) == 0) continue;
      if (f == 0) result.words.push_back({128, triangles[u], triangles[u + 1], triangles[u + 2]});
      ++part.triangle_count;
    }
    if (f != 0)
      part.first_triangle = result.parts[result.parts.size() - f * std::size_t{result.parts_of_cube}].first_triangle;
    result.parts.push_back(part);
  }
}

}  // namespace

unsigned lifted_vertex(unsigned f, unsigned vertex) {
  return vertex < kCubeEdges ? detail::lifted_edge(4, f, vertex)
                             : CubeLists::kEdges + CubeLists::kMostOwn * f + vertex - kCubeEdges;
}

CubeLists make_cube_lists(const ResolvedCube& cube, const VariantTables& variants) {
  CubeLists result;
  result.triangulation = variants.tile.triangulation;
  number_lists(cube, variants, result);
  for (unsigned f = 0; f < CubeLists::kCubes; ++f) {
    for (std::size_t i = 0; i < result.lists.size(); ++i) {
      const std::size_t first = result.parts.size();
      add_parts(f, i, result);
      const std::size_t count = result.parts.size() - first;
      if (count > CubeLists::kMostParts) throw Error(ErrorCode::Internal, "a cube with more than four polygons");
      if (f != 0) continue;
      // In this cube, vertices of one part are not adjacent to those of another part.
      constexpr std::uint16_t kAll = (1u << CubeLists::kCubeEdges) - 1;
      result.lists[i].not_apexes = count > 1 ? kAll : result.parts[first].not_apexes;
      result.lists[i].first_part = static_cast<std::uint32_t>(first);
      result.lists[i].part_count = static_cast<std::uint8_t>(count);
    }
    if (f == 0) result.parts_of_cube = static_cast<std::uint32_t>(result.parts.size());
  }
  return result;
}

}  // namespace tegl::gen
