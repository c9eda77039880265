// SPDX-License-Identifier: BSD-3-Clause
//
// Sorts the shared barycentres by the vertices of their polygons.
#include "complex/shared_points.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

#include "base/progress.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"
#include "complex/border_facets.hpp"
#include "regions/cube_frame.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

namespace {

struct SharedUse {
  PolygonKey key;
  std::uint64_t place;
};

/// The key of a polygon by its edges in a cell.
PolygonKey key_of(std::uint64_t edges, const Index* numbers) noexcept {
  PolygonKey key;
  key.fill(kNoPoint);
  std::size_t count = 0;
  for (; edges != 0; edges &= edges - 1) key[count++] = numbers[std::countr_zero(edges)];
  std::sort(key.begin(), key.end());  // kNoPoint is the largest
  return key;
}

/// The edge of the cube of images between two of its corners.
unsigned cube_edge(unsigned p, unsigned q) noexcept {
  unsigned e = 0;
  while (edge_base(3, e) != std::min(p, q) || 1u << e / 4 != (p ^ q)) ++e;
  return e;
}

/// A vertex in a hexahedron, from its mask in the cell (kOwnOfFacet).
CubePoint cube_point(const CellGroup& group, const tables::CellTable& table, const Index* corners,
                     std::uint64_t mask) noexcept {
  const CellFacet& facet = facets_of(group.shape)[static_cast<std::size_t>(std::countr_zero(mask >> kOwnOfFacet))];
  std::array<unsigned, 16> in_facet;
  in_facet.fill(8);
  CubePoint point{{}, 0, 0};
  for (unsigned v = 0; v < 8; ++v) {
    in_facet[facet.corners[v]] = v;
    point.corners[v] = corners[facet.corners[v]];
    point.mask |= static_cast<std::uint32_t>(mask >> facet.corners[v] & 1u) << v;
  }
  for (unsigned e = 0; e < table.edge_count; ++e)
    if ((mask >> (table.corner_count + e) & 1u) != 0)
      point.mask |= 256u << cube_edge(in_facet[table.edges[2 * e]], in_facet[table.edges[2 * e + 1]]);
  return point;
}

/// The smallest number of a vertex on the edges of a facet.
Index first_crossing(const CellGroup& group, const tables::CellTable& table, unsigned signature, std::uint64_t mask,
                     const Index* numbers) noexcept {
  const CellFacet& facet = facets_of(group.shape)[static_cast<std::size_t>(std::countr_zero(mask >> kOwnOfFacet))];
  unsigned corners = 0;
  for (unsigned v = 0; v < 8; ++v) corners |= 1u << facet.corners[v];
  Index first = kNoPoint;
  for (std::uint32_t edges = crossed_edges(table, signature); edges != 0; edges &= edges - 1) {
    const auto e = static_cast<unsigned>(std::countr_zero(edges));
    if ((corners >> table.edges[2 * e] & corners >> table.edges[2 * e + 1] & 1u) != 0)
      first = std::min(first, numbers[e]);
  }
  return first;
}

/// Keeps one of the cubes or loops for each vertex.
template <class Point>
std::vector<Point> distinct(std::vector<std::vector<Point>>& of_blocks) {
  std::vector<Point> points;
  for (std::vector<Point>& of_block : of_blocks)
    points.insert(points.end(), std::make_move_iterator(of_block.begin()), std::make_move_iterator(of_block.end()));
  std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.number < b.number; });
  points.erase(
      std::unique(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.number == b.number; }),
      points.end());
  return points;
}

/// The uses of shared vertices by the prisms of a block. Appends vertices in cubes, and loops, whose numbers are places
/// in the block.
void list_uses(const PolytopeBlock& block, std::uint64_t first, SharedUse* uses, std::vector<CubePoint>& in_cubes,
               std::vector<LoopPoint>& loops) {
  using Kind = PolytopeBlock::InnerVertex::Kind;
  for (std::size_t i = 0; i < block.shared.size(); ++i) {
    const PolytopeBlock::InnerVertex& of = block.shared[i];
    const auto place = static_cast<Index>(i);
    std::vector<Index> vertices;
    for (std::uint32_t v = of.first_vertex; v < of.vertices_end; ++v)
      vertices.push_back(block.numbers[block.vertices[block.inner_vertices[v]]]);
    std::sort(vertices.begin(), vertices.end());
    PolygonKey key;
    if (of.kind == Kind::in_cube) {
      key = key_of(in_cubes.emplace_back(CubePoint{of.points, of.mask, place}), vertices[0]);
    } else if (of.kind == Kind::loop) {
      key = key_of_loop(vertices[0], {of.points[0], of.points[1], of.points[2], of.points[3]});
      loops.push_back({std::move(vertices), place});
    } else {
      key.fill(kNoPoint);
      std::copy(vertices.begin(), vertices.end(), key.begin());
    }
    uses[i] = {key, first + i};
  }
}

}  // namespace

PolygonKey key_of(const CubePoint& point, Index crossing) noexcept {
  const CubeFrame frame = CubeFrame::of_number(CubeFrame::number_of(point.corners.data()));
  Index mask = 0;
  for (unsigned v = 0; v < 8; ++v) mask |= (point.mask >> frame.corner(v) & 1u) << v;
  for (unsigned e = 0; e < 12; ++e) {
    const unsigned base = edge_base(3, e);
    mask |= (point.mask >> (8 + cube_edge(frame.corner(base), frame.corner(base | 1u << e / 4))) & 1u) << (8 + e);
  }
  PolygonKey key;
  key.fill(kNoPoint);
  key[0] = crossing;
  key[1] = point.corners[frame.corner(0)];
  key[2] = point.corners[frame.corner(7)];
  key[3] = mask;
  key.back() = kInCube;
  return key;
}

PolygonKey key_of_loop(Index smallest, const std::array<Index, 4>& facet) noexcept {
  PolygonKey key;
  key.fill(kNoPoint);
  key[0] = smallest;
  std::copy(facet.begin(), facet.end(), key.begin() + 1);
  key.back() = kInFacet;
  return key;
}

SharedPoints number_shared_points(const CellGroups& cells, const CellTables& tables,
                                  const std::vector<ActiveBlock>& blocks, const std::vector<PolytopeBlock>& polytopes,
                                  const CrossingNumbers& crossings, const WorkOptions& work) {
  SharedPoints points;
  auto first = sums_before(blocks, &ActiveBlock::shared);
  for (const PolytopeBlock& block : polytopes) first.push_back(first.back() + block.shared.size());
  if (first.back() == 0) return points;
  // list
  std::vector<SharedUse> uses(first.back());
  std::vector<std::vector<CubePoint>> in_cubes(first.size());  // their numbers are places in the block
  std::vector<std::vector<LoopPoint>> loops(first.size());
  for_each_block(
      blocks.size(), 1, work.threads, part_of(work.progress, 0.0, 0.5), [&](std::size_t b, std::size_t, std::size_t) {
        const CellCases& cases = tables.of_group[blocks[b].group];
        const CellGroup& group = cells.groups[blocks[b].group];
        std::uint64_t place = first[b];
        std::size_t crossing = 0;
        std::array<Index, 32> numbers{};
        for (const ActiveCell& cell : blocks[b].cells) {
          const CellContour contour = cases.of(cell.signature, cell.variant);
          crossings.of_cell(b, cell, crossing, numbers.data());
          for (unsigned j = 0; j < contour.list().shared_vertices; ++j, ++place) {
            const std::uint64_t mask = contour.mask(j);
            if (mask >> kOwnOfFacet == 0) {
              uses[place] = {key_of(mask >> cases.table().corner_count, numbers.data()), place};
              continue;
            }
            CubePoint& point = in_cubes[b].emplace_back(cube_point(group, cases.table(), group.cell(cell.cell), mask));
            point.number = static_cast<Index>(place - first[b]);
            uses[place] = {key_of(point, first_crossing(group, cases.table(), cell.signature, mask, numbers.data())),
                           place};
          }
        }
      });
  for_each_item(polytopes.size(), work.threads, nullptr, [&](std::size_t p) {
    const std::size_t b = blocks.size() + p;
    list_uses(polytopes[p], first[b], uses.data() + first[b], in_cubes[b], loops[b]);
  });
  // sort by the first vertex, then among equal ones by the others
  const auto bits = static_cast<unsigned>(std::bit_width(crossings.ends().size()));
  sort_by_bits(uses, bits, [](const SharedUse& use) { return std::uint64_t{use.key[0]}; });
  tell(work.progress, 0.8);
  for (auto at = uses.begin(); at != uses.end();) {
    const auto end = std::find_if(at, uses.end(), [&](const SharedUse& use) { return use.key[0] != at->key[0]; });
    std::sort(at, end, [](const SharedUse& a, const SharedUse& b) { return a.key < b.key; });
    at = end;
  }
  // number
  points.numbers.resize(uses.size());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (i == 0 || uses[i].key != uses[i - 1].key) points.keys.push_back(uses[i].key);
    points.numbers[uses[i].place] = static_cast<Index>(points.keys.size() - 1);
  }
  for (std::size_t b = 0; b + 1 < first.size(); ++b) {
    for (CubePoint& point : in_cubes[b]) point.number = points.numbers[first[b] + point.number];
    for (LoopPoint& point : loops[b]) point.number = points.numbers[first[b] + point.number];
  }
  points.in_cubes = distinct(in_cubes);
  points.loops = distinct(loops);
  tell(work.progress, 1.0);
  return points;
}

}  // namespace tegl::detail
