// SPDX-License-Identifier: BSD-3-Clause
//
// Caps in facets of 4D polytopes that cells with tables do not have: each region of the high part is bounded by one
// sphere, as the contour's polygons are discs, and is a cone from its only corner or from the mean of its points.
#include <algorithm>
#include <map>

#include "base/disjoint_sets.hpp"
#include "complex/complex_caps.hpp"
#include "prisms/solid_cell.hpp"

namespace tegl::detail {

namespace {

using CapTriangle = std::array<CapVertex, 3>;

}  // namespace

template <int N>
void ComplexCaps<N>::add_solid(const SolidFacet& facet, const Index* points, std::optional<Index> name, bool flip) {
  if constexpr (N == 4) {
    std::vector<double> at;
    for (const std::uint8_t v : facet.corners) {
      at.push_back(values_[points[v]]);
      if (at.back() >= isovalue_) corners_.push_back(points[v]);
    }
    // the boundary of the high part, facing outwards
    std::vector<CapTriangle> triangles;
    for (std::size_t f = 0; f < facet.shape.face_count(); ++f) {
      std::vector<Index> ring;
      for (const std::uint8_t v : facet.shape.ring(f)) ring.push_back(points[facet.corners[v]]);
      for (std::vector<CapVertex>& part : parts_around(ring)) add_fan(std::move(part), triangles);
    }
    const PolytopeRules rules = rules_of(options_, isovalue_);
    Loops().for_each(facet.shape, at.data(), rules, [&](std::span<const std::uint8_t> loop) {
      std::vector<CapVertex> around;
      std::vector<Index> numbers;
      for (const std::uint8_t e : loop) {
        const auto& [a, b] = facet.shape.edges()[e];
        around.push_back(on_edge(points[facet.corners[a]], points[facet.corners[b]]));
        numbers.push_back(static_cast<Index>(around.back().number()));
      }
      const std::size_t size = loop.size();
      const Index centre = size > 3 ? numbers_.polygon_in(key_of_facet(facet, points, name), numbers) : kNoPoint;
      const auto start = centre == kNoPoint ? fan_of_loop(rules, facet, loop, points) : std::nullopt;
      const CapVertex apex = start ? around[*start] : CapVertex::of_contour(centre);
      for (std::size_t i = start ? *start + 1 : 0, end = start ? i + size - 2 : size; i < end; ++i)
        triangles.push_back({apex, around[(i + 1) % size], around[i % size]});
    });
    // regions
    std::map<CapVertex, Index> number;
    for (const CapTriangle& t : triangles)
      for (const CapVertex v : t) number.try_emplace(v, static_cast<Index>(number.size()));
    DisjointSets sets(number.size());
    for (const CapTriangle& t : triangles) {
      sets.join(number[t[0]], number[t[1]]);
      sets.join(number[t[0]], number[t[2]]);
    }
    std::map<Index, std::vector<CapVertex>> regions;
    for (const auto& [v, n] : number) regions[sets.find(n)].push_back(v);
    for (auto& [root, vertices] : regions) {
      std::vector<CapVertex> corners;
      std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(corners),
                   [](CapVertex v) { return v.is_corner(); });
      // the mean of corners and of points on edges
      std::erase_if(vertices,
                    [&](CapVertex v) { return v.is_of_contour() && v.number() >= numbers_.edge_ends().size(); });
      const CapVertex apex = corners.size() == 1 ? corners[0] : add_mean(vertices);
      for (const CapTriangle& t : triangles)
        if (sets.find(number[t[0]]) == root && std::find(t.begin(), t.end(), apex) == t.end())
          add_simplex({apex, t[0], t[1], t[2]}, flip);
    }
  }
}

template void ComplexCaps<2>::add_solid(const SolidFacet&, const Index*, std::optional<Index>, bool);
template void ComplexCaps<3>::add_solid(const SolidFacet&, const Index*, std::optional<Index>, bool);
template void ComplexCaps<4>::add_solid(const SolidFacet&, const Index*, std::optional<Index>, bool);

}  // namespace tegl::detail
