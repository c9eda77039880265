// SPDX-License-Identifier: BSD-3-Clause
//
// Lists the facets of prisms over polyhedra.
#include "polytope/prism_facets.hpp"

#include <algorithm>

#include "polytope/polygon_prisms.hpp"

namespace tegl::detail {

namespace {

PrismFacet end_of(const PolytopeFaces& shape, std::size_t end) {
  PrismFacet facet{shape, PrismFacet::Kind::end, {}, {}, end == 1};
  for (std::size_t v = 0; v < shape.base_corners(); ++v)
    facet.corners.push_back(static_cast<std::uint8_t>(v + end * shape.base_corners()));
  for (std::size_t e = 0; e < shape.base_edges(); ++e)
    facet.edges.push_back(static_cast<std::uint16_t>(e + end * shape.base_edges()));
  return facet;
}

PrismFacet side_of(const PolytopeFaces& shape, std::size_t face) {
  const std::span<const std::uint8_t> ring = shape.ring(face), edges = shape.ring_edges(face);
  const std::size_t count = ring.size(), corners = shape.base_corners(), base = shape.base_edges();
  PrismFacet facet{kPolygonPrisms.over(count), PrismFacet::Kind::prism, {}, {}, false};
  if (count < 5) facet.kind = count == 3 ? PrismFacet::Kind::wedge : PrismFacet::Kind::hexahedron;
  for (const std::size_t end : {0u, 1u})
    for (const std::uint8_t v : ring) facet.corners.push_back(static_cast<std::uint8_t>(v + end * corners));
  for (const auto& [a, b] : facet.shape.edges()) {
    if (b == a + count) {
      facet.edges.push_back(static_cast<std::uint16_t>(2 * base + ring[a]));
      continue;
    }
    const std::size_t end = a < count ? 0 : 1, first = a % count, second = b % count;
    const std::size_t along = second == first + 1 ? first : second;  // the edge from here to the next corner
    facet.edges.push_back(static_cast<std::uint16_t>(edges[along] + end * base));
  }
  return facet;
}

}  // namespace

PrismFacet facet_of_prism(const PolytopeFaces& shape, std::size_t facet) {
  return facet < 2 ? end_of(shape, facet) : side_of(shape, facet - 2);
}

std::vector<PrismFacet> facets_of_prism(const PolytopeFaces& shape) {
  std::vector<PrismFacet> facets;
  for (std::size_t f = 0; f < shape.facet_count(); ++f) facets.push_back(facet_of_prism(shape, f));
  return facets;
}

std::array<Index, 4> key_of_facet(const PrismFacet& facet, const Index* points, std::optional<Index> entangled) {
  const auto point = [&](std::uint8_t corner) { return points[facet.corners[corner]]; };
  std::vector<std::uint8_t> corners(facet.corners.size());
  for (std::size_t v = 0; v < corners.size(); ++v) corners[v] = static_cast<std::uint8_t>(v);
  std::sort(corners.begin(), corners.end(), [&](std::uint8_t a, std::uint8_t b) { return point(a) < point(b); });
  constexpr Index kNone = ~Index{0};  // no point; nor are the numbers below it, by which polyhedra are counted
  if (entangled && facet.kind == PrismFacet::Kind::end)
    return {point(corners[0]), kNone - 1 - *entangled, kNone, kNone};
  // three corners are in one polygon at most
  std::size_t fourth = 3;
  for (std::size_t f = 0; f < facet.shape.face_count(); ++f) {
    const std::span<const std::uint8_t> ring = facet.shape.ring(f);
    const auto is_in = [&](std::uint8_t v) { return std::find(ring.begin(), ring.end(), v) != ring.end(); };
    if (!is_in(corners[0]) || !is_in(corners[1]) || !is_in(corners[2])) continue;
    while (is_in(corners[fourth])) ++fourth;
    break;
  }
  return {point(corners[0]), point(corners[1]), point(corners[2]), point(corners[fourth])};
}

}  // namespace tegl::detail
