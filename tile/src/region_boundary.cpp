// SPDX-License-Identifier: BSD-3-Clause
//
// Sums, parts and images of boundaries of regions.
#include "tegl/region_boundary.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "tegl/tile/disjoint_sets.hpp"

namespace tegl::detail {

using Vertices = ShapeVertices;

namespace {

/// A symmetry without barycentres: the images of the corners, then those of the edges.
RegionMap map_of(const tables::CellTable& shape, const std::uint8_t* images) {
  RegionMap map;
  std::iota(map.begin(), map.end(), std::uint8_t{0});
  std::copy_n(images, shape.corner_count, map.begin());
  for (unsigned e = 0; e < shape.edge_count; ++e)
    map[Vertices::kFirstEdge + e] = static_cast<std::uint8_t>(Vertices::kFirstEdge + images[shape.corner_count + e]);
  return map;
}

/// Moves a boundary; barycentres are numbered by the first of their edges, and `map` gets their numbers.
RegionTriangles moved(const RegionTriangles& boundary, RegionMap& map) {
  std::array<std::uint8_t, Vertices::kFirstOwn - Vertices::kFirstCentre> first{};
  first.fill(Vertices::kEnd);
  for (const RegionTriangle& t : boundary)
    for (const std::uint8_t v : t)
      for (const std::uint8_t u : t)
        if (v >= Vertices::kFirstCentre && u < Vertices::kFirstCentre)
          first[v - Vertices::kFirstCentre] = std::min(first[v - Vertices::kFirstCentre], map[u]);
  for (std::size_t i = 0; i < first.size(); ++i)
    map[Vertices::kFirstCentre + i] = static_cast<std::uint8_t>(
        Vertices::kFirstCentre + std::count_if(first.begin(), first.end(), [&](auto f) { return f < first[i]; }));
  RegionTriangles result;
  for (const RegionTriangle& t : boundary) result.push_back({map[t[0]], map[t[1]], map[t[2]]});
  sort_boundary(result);
  return result;
}

}  // namespace

RegionTriangle from_smallest(RegionTriangle t) noexcept {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::array<RegionTriangle, 4> faces_of(const RegionTetrahedron& t) noexcept {
  return {RegionTriangle{t[1], t[2], t[3]}, RegionTriangle{t[0], t[3], t[2]}, RegionTriangle{t[0], t[1], t[3]},
          RegionTriangle{t[0], t[2], t[1]}};
}

void sort_boundary(RegionTriangles& triangles) {
  for (RegionTriangle& t : triangles) t = from_smallest(t);
  std::sort(triangles.begin(), triangles.end());
}

void add_to_boundary(RegionTriangles& boundary, const RegionTriangle& triangle) {
  const RegionTriangle same = from_smallest(triangle),
                       opposite = from_smallest({triangle[1], triangle[0], triangle[2]});
  if (const auto at = std::lower_bound(boundary.begin(), boundary.end(), opposite);
      at != boundary.end() && *at == opposite)
    boundary.erase(at);
  else
    boundary.insert(std::lower_bound(boundary.begin(), boundary.end(), same), same);
}

std::uint64_t vertices_of(const RegionTriangles& triangles) noexcept {
  std::uint64_t all = 0;
  for (const RegionTriangle& t : triangles)
    for (const std::uint8_t v : t) all |= std::uint64_t{1} << v;
  return all;
}

std::vector<std::uint8_t> edges_around(const RegionTriangles& boundary, unsigned vertex) {
  std::uint64_t around = 0;
  for (const RegionTriangle& t : boundary)
    if (std::find(t.begin(), t.end(), vertex) != t.end()) around |= vertices_of({t});
  std::vector<std::uint8_t> edges;
  for (std::uint8_t v = Vertices::kFirstEdge; v < Vertices::kFirstCentre; ++v)
    if ((around >> v & 1u) != 0) edges.push_back(v);
  return edges;
}

std::vector<RegionTriangles> split_regions(const RegionTriangles& boundary) {
  BasicDisjointSets<std::uint32_t> sets(Vertices::kEnd);
  for (const RegionTriangle& t : boundary) sets.join(t[0], t[1]), sets.join(t[0], t[2]);
  std::map<std::uint32_t, RegionTriangles> regions;
  for (const RegionTriangle& t : boundary) regions[sets.find(t[0])].push_back(t);
  std::vector<RegionTriangles> result;
  for (auto& [root, triangles] : regions) result.push_back(std::move(triangles));
  return result;
}

RegionTriangles representative_of(const RegionTriangles& boundary, const tables::CellTable& shape,
                                  std::span<const std::uint8_t> symmetries, RegionMap& map) {
  RegionTriangles representative;
  const std::size_t stride = shape.corner_count + shape.edge_count;
  for (std::size_t at = 0; at < symmetries.size(); at += stride) {
    RegionMap symmetry = map_of(shape, symmetries.data() + at);
    RegionTriangles there = moved(boundary, symmetry);
    if (!representative.empty() && there >= representative) continue;
    representative = std::move(there);
    map = symmetry;
  }
  return representative;
}

}  // namespace tegl::detail
