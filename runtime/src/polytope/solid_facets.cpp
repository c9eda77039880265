// SPDX-License-Identifier: BSD-3-Clause
//
// Lists the facets of 4D polytopes.
#include "polytope/solid_facets.hpp"

#include <algorithm>

#include "polytope/polygon_prisms.hpp"

namespace tegl::detail {

namespace {

SolidFacet end_of(const PolytopeFaces& shape, std::size_t end) {
  SolidFacet facet{shape, SolidFacet::Kind::end, {}, {}, end == 1};
  for (std::size_t v = 0; v < shape.base_corners(); ++v)
    facet.corners.push_back(static_cast<std::uint8_t>(v + end * shape.base_corners()));
  for (std::size_t e = 0; e < shape.base_edges(); ++e)
    facet.edges.push_back(static_cast<std::uint16_t>(e + end * shape.base_edges()));
  return facet;
}

SolidFacet side_of(const PolytopeFaces& shape, std::size_t face) {
  const std::span<const std::uint8_t> ring = shape.ring(face), edges = shape.ring_edges(face);
  const std::size_t count = ring.size(), corners = shape.base_corners(), base = shape.base_edges();
  SolidFacet facet{kPolygonPrisms.over(count), SolidFacet::Kind::other, {}, {}, false};
  if (count < 5) facet.kind = count == 3 ? SolidFacet::Kind::wedge : SolidFacet::Kind::hexahedron;
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

/// A polyhedron that the compiler makes.
template <std::size_t Corners, std::size_t RingCorners, std::size_t Faces>
struct KnownPolyhedron {
  std::array<std::uint8_t, RingCorners> rings, ring_edges{};
  std::array<std::uint16_t, Faces> ends{};
  std::array<PolytopeFaces::Pair, RingCorners / 2> edges{}, faces_of{};

  /// `rings`: the triangles first; then, if any, quadrilaterals.
  constexpr explicit KnownPolyhedron(const std::array<std::uint8_t, RingCorners>& rings_, std::size_t triangles = Faces)
      : rings(rings_) {
    for (std::size_t f = 0, end = 0; f < Faces; ++f) ends[f] = static_cast<std::uint16_t>(end += f < triangles ? 3 : 4);
    number_edges(rings, ends, ring_edges, edges, faces_of);
  }
  [[nodiscard]] constexpr PolytopeFaces faces() const { return {Corners, rings, ring_edges, ends, edges, faces_of}; }
};

// As tables::shape_table, which a test compares.
constexpr KnownPolyhedron<4, 12, 4> kTetrahedron({2, 1, 0, 0, 1, 3, 3, 2, 0, 1, 2, 3});
constexpr KnownPolyhedron<5, 16, 5> kPyramid({0, 1, 4, 4, 2, 0, 1, 3, 4, 4, 3, 2, 2, 3, 1, 0}, 4);
constexpr KnownPolyhedron<6, 24, 8> kOctahedron({4, 2, 0, 1, 2, 4, 0, 3, 4, 4, 3, 1,
                                                 0, 2, 5, 5, 2, 1, 5, 3, 0, 1, 3, 5});

SolidFacet solid_of(const PolytopeSolids& solids, std::size_t facet) {
  const PolytopeSolids::Solid& solid = solids.solids[facet];
  const bool is_last = facet + 1 == solids.solids.size();
  SolidFacet result{{}, solid.kind, {}, {}, solid.is_inverted};
  result.shape = result.is_tabled() ? faces_of_known(static_cast<PolyhedronShape>(solid.kind))
                                    : static_cast<const PolytopeFaces&>(solids.lattices[solid.lattice]);
  const auto part = [&](const auto& of, std::uint32_t PolytopeSolids::Solid::*first) {
    return std::span(of).subspan(solid.*first,
                                 (is_last ? of.size() : std::size_t{solids.solids[facet + 1].*first}) - solid.*first);
  };
  const auto corners = part(solids.corners, &PolytopeSolids::Solid::first_corner);
  const auto edges = part(solids.edges, &PolytopeSolids::Solid::first_edge);
  result.corners.assign(corners.begin(), corners.end());
  result.edges.assign(edges.begin(), edges.end());
  return result;
}

}  // namespace

std::size_t PolytopeFaces::facet_count() const noexcept {
  if (solids_ != nullptr) return solids_->solids.size();
  return is_prism_ ? face_count() + 2 : face_count() == 1 ? corner_count_ : face_count();
}

PolytopeFaces faces_of_known(PolyhedronShape shape) {
  switch (shape) {
    case PolyhedronShape::tetrahedron:
      return kTetrahedron.faces();
    case PolyhedronShape::pyramid:
      return kPyramid.faces();
    case PolyhedronShape::wedge:
      return kPolygonPrisms.over(3);
    case PolyhedronShape::hexahedron:
      return kPolygonPrisms.over(4);
    default:
      return kOctahedron.faces();
  }
}

std::size_t known_corner(PolyhedronShape shape, std::size_t i) noexcept {
  return shape == PolyhedronShape::pyramid && (i == 2 || i == 3) ? 5 - i : i;
}

SolidFacet facet_of_solid(const PolytopeFaces& shape, std::size_t facet) {
  if (shape.solids() != nullptr) return solid_of(*shape.solids(), facet);
  return facet < 2 ? end_of(shape, facet) : side_of(shape, facet - 2);
}

std::vector<SolidFacet> facets_of_solid(const PolytopeFaces& shape) {
  std::vector<SolidFacet> facets;
  for (std::size_t f = 0; f < shape.facet_count(); ++f) facets.push_back(facet_of_solid(shape, f));
  return facets;
}

std::array<Index, 4> key_of_facet(const SolidFacet& facet, const Index* points, std::optional<Index> name) {
  const auto point = [&](std::uint8_t corner) { return points[facet.corners[corner]]; };
  std::vector<std::uint8_t> corners(facet.corners.size());
  for (std::size_t v = 0; v < corners.size(); ++v) corners[v] = static_cast<std::uint8_t>(v);
  std::sort(corners.begin(), corners.end(), [&](std::uint8_t a, std::uint8_t b) { return point(a) < point(b); });
  constexpr Index kNone = ~Index{0};  // no point; nor are the numbers below it, by which entangled facets are counted
  if (name) return {point(corners[0]), kNone - 1 - *name, kNone, kNone};
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
