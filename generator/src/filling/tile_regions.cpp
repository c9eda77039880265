// SPDX-License-Identifier: BSD-3-Clause
//
// Regions by the recursion used for facets: the high parts of a tile's faces and the tile's own facets close up to
// spheres; each sphere is coned.
#include "filling/tile_regions.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

SignatureRegions::SignatureRegions(const Lattice& lattice, int k, std::span<const std::vector<TileContour>> contours,
                                   RegionStyle style, bool is_cap)
    : tile_(&lattice.tile(k)), style_(style) {
  if (k > 1) of_faces_ = std::make_unique<SignatureRegions>(lattice, k - 1, contours, style);
  if (is_cap && k == 3 && style == RegionStyle::fan && tile_->kind == TileKind::cube)
    proof_ = std::make_unique<RegionProof>();
  const std::vector<TileContour>& own = contours[static_cast<std::size_t>(k) - 1];
  for (Signature s = 0; s <= tile_->full(); ++s) regions_.push_back(build(s, own[s]));
}

std::uint32_t SignatureRegions::own_base() const {
  return tables::first_region_vertex(static_cast<std::uint32_t>(tile_->dim));
}

std::uint8_t SignatureRegions::lift(std::uint32_t f, std::uint8_t vertex) const {
  const SubTile& face = tile_->faces[f];
  const std::uint32_t corners = face.tile->corner_count();
  if (vertex < corners) return face.corner[vertex];
  if (vertex < corners + face.tile->edge_count())
    return static_cast<std::uint8_t>(tile_->corner_count() + face.edge[vertex - corners]);
  if (tile_->dim != 3 || vertex != of_faces_->own_base())
    throw std::logic_error("a square has more than one region that is not a triangle");
  return static_cast<std::uint8_t>(own_base() - tile_->faces.size() + f);
}

std::uint32_t SignatureRegions::mask_of(Signature signature, std::uint8_t vertex) const {
  const std::uint32_t points = tile_->corner_count() + tile_->edge_count();
  if (vertex < points) return 1u << vertex;
  if (vertex >= own_base()) return regions_[signature].own_masks[vertex - own_base()];
  const std::uint32_t f = vertex - (own_base() - static_cast<std::uint32_t>(tile_->faces.size()));
  const std::uint32_t in_face =
      of_faces_->mask_of(tile_->restrict_to(f, signature), static_cast<std::uint8_t>(of_faces_->own_base()));
  std::uint32_t mask = 0;
  for (std::uint8_t v = 0; v < tile_->faces[f].tile->corner_count() + tile_->faces[f].tile->edge_count(); ++v)
    if (((in_face >> v) & 1u) != 0) mask |= 1u << lift(f, v);
  return mask;
}

/// The oriented boundary of the high part: the faces' regions and the tile's facets. A facet gets the sign (-1)^k,
/// because the orientation of facets puts the direction towards high last.
std::vector<LocalSimplex> SignatureRegions::boundary(Signature signature, const TileContour& contour) const {
  const int k = tile_->dim;
  std::vector<LocalSimplex> result;
  const auto add = [&](LocalSimplex simplex, int sign) {
    if (sign < 0) std::swap(simplex[k - 1], simplex[k - 2]);
    result.push_back(simplex);
  };
  for (std::uint32_t f = 0; f < tile_->faces.size(); ++f)
    for (LocalSimplex simplex : of_faces_->regions(tile_->restrict_to(f, signature)).simplices) {
      for (int i = 0; i < k; ++i) simplex[i] = lift(f, simplex[i]);
      add(simplex, tile_->faces[f].sign);
    }
  for (const LocalFacet& facet : contour.facets)
    for (LocalSimplex simplex : facet.simplices) {
      for (int i = 0; i < k; ++i) simplex[i] = static_cast<std::uint8_t>(simplex[i] + tile_->corner_count());
      add(simplex, k % 2 == 0 ? 1 : -1);
    }
  return result;
}

namespace {

TileRegions regions_of_edge(Signature signature) {
  TileRegions result;
  if (signature == 1) result.simplices = {LocalSimplex{0, 2}};
  if (signature == 2) result.simplices = {LocalSimplex{2, 1}};
  if (signature == 3) result.simplices = {LocalSimplex{0, 1}};
  return result;
}

/// Splits a closed complex into connected components, ordered by smallest vertex.
std::vector<std::vector<LocalSimplex>> split(std::vector<LocalSimplex> rest, int vertices_per_simplex) {
  std::vector<std::vector<LocalSimplex>> components;
  while (!rest.empty()) {
    std::array<bool, 256> reached{};
    std::uint8_t smallest = 255;
    for (const LocalSimplex& s : rest)
      smallest = std::min(smallest, *std::min_element(s.begin(), s.begin() + vertices_per_simplex));
    reached[smallest] = true;
    for (bool grown = true; grown;) {
      grown = false;
      for (const LocalSimplex& s : rest)
        if (std::any_of(s.begin(), s.begin() + vertices_per_simplex, [&](std::uint8_t v) { return reached[v]; }))
          for (int i = 0; i < vertices_per_simplex; ++i) {
            grown |= !reached[s[i]];
            reached[s[i]] = true;
          }
    }
    auto& component = components.emplace_back();
    const auto kept =
        std::stable_partition(rest.begin(), rest.end(), [&](const LocalSimplex& s) { return !reached[s[0]]; });
    component.assign(kept, rest.end());
    rest.erase(kept, rest.end());
  }
  return components;
}

constexpr std::uint8_t kNoVertex = 255;

/// Adds a division of a region of a cube, whose own vertices start at `own_base`.
void append(const RegionDivision& division, std::uint32_t own_base, TileRegions& to) {
  if (division.centres.size() > 1) throw std::logic_error("a region of a table has more than one vertex of its own");
  const auto centre = static_cast<std::uint8_t>(own_base + to.own_masks.size());
  to.own_masks.insert(to.own_masks.end(), division.centres.begin(), division.centres.end());
  for (LocalSimplex tetrahedron : division.tetrahedra) {
    std::replace(tetrahedron.begin(), tetrahedron.end(), std::uint8_t{RegionVertices::kFirstCentre}, centre);
    to.simplices.push_back(tetrahedron);
  }
}

/// The corner of a square between two others, if all three belong to a polygon's vertices; else `lowest`. The fan from
/// there is the one of the regions of cubes (builders/cube_regions.cpp), which are proved to be positive.
std::uint8_t fan_apex(const Tile& square, const std::array<bool, 256>& polygon, std::uint8_t lowest) {
  std::array<int, 256> neighbours{};
  for (const auto& [a, b] : square.edges)
    if (polygon[a] && polygon[b]) ++neighbours[a], ++neighbours[b];
  int corners = 0;
  for (std::uint8_t v = 0; v < square.corner_count(); ++v) corners += polygon[v] ? 1 : 0;
  for (std::uint8_t v = 0; corners == 3 && v < square.corner_count(); ++v)
    if (neighbours[v] == 2) return v;
  return lowest;
}

}  // namespace

/// The barycentre of the only facet in the boundary of a region with these vertices. From there, every point of the
/// region is visible, for all positions: the facet is a cone from the same point, and every other ray leaves the tile
/// once. kNoVertex if several facets bound the region, or one without a barycentre.
std::uint8_t SignatureRegions::only_barycentre(const TileContour& contour, const std::array<bool, 256>& region) const {
  std::uint8_t result = kNoVertex;
  int facets = 0;
  for (const LocalFacet& facet : contour.facets) {
    if (facet.points.empty() || !region[tile_->corner_count() + facet.points[0]]) continue;
    ++facets;
    if (facet.filling == Filling::cone)
      result = static_cast<std::uint8_t>(tile_->corner_count() + facet.simplices[0][0]);
  }
  return facets == 1 && tile_->dim == 3 ? result : kNoVertex;
}

/// The division of a region of a cube that is proved to be positive, if one is found.
std::optional<RegionDivision> SignatureRegions::divided(const TileContour& contour,
                                                        std::span<const LocalSimplex> surface) const {
  RegionFrame frame;
  frame.is_cap = true;
  for (const LocalFacet& facet : contour.facets)
    for (const std::uint8_t point : facet.points)
      if (facet.filling == Filling::cone)
        frame.points[tile_->corner_count() + facet.simplices[0][0]] |= frame.points[tile_->corner_count() + point];
  std::vector<std::array<std::uint8_t, 3>> triangles;
  for (const LocalSimplex& s : surface) triangles.push_back({s[0], s[1], s[2]});
  return divide_region(*proof_, frame, triangles);
}

TileRegions SignatureRegions::build(Signature signature, const TileContour& contour) const {
  const int k = tile_->dim;
  if (k == 1) return regions_of_edge(signature);
  TileRegions result;
  for (const auto& component : split(boundary(signature, contour), k)) {
    if (proof_) {
      const auto division = divided(contour, component);
      if (!division) throw Error(ErrorCode::CertificateFailed, "a cap of a cube without a proved division");
      append(*division, own_base(), result);
      continue;
    }
    // mask, smallest vertex and number of vertices of the component
    std::uint32_t mask = 0;
    std::uint8_t lowest = 255;
    std::array<bool, 256> seen{};
    std::size_t vertices = 0;
    for (const LocalSimplex& s : component)
      for (int i = 0; i < k; ++i) {
        vertices += seen[s[i]] ? 0 : 1;
        seen[s[i]] = true;
        lowest = std::min(lowest, s[i]);
        if (s[i] < tile_->corner_count() + tile_->edge_count()) mask |= 1u << s[i];
      }
    // cone from the smallest vertex, from the barycentre of the only facet around it, or from an own vertex
    const std::uint8_t barycentre = only_barycentre(contour, seen);
    const bool simplex = vertices == static_cast<std::size_t>(k) + 1 && component.size() == vertices;
    const bool from_own_vertex = simplex || (k == 2 && style_ == RegionStyle::fan);
    std::uint8_t apex = k == 2 && tile_->kind == TileKind::cube ? fan_apex(*tile_, seen, lowest) : lowest;
    if (!from_own_vertex && barycentre != kNoVertex) {
      apex = barycentre;
    } else if (!from_own_vertex) {
      apex = static_cast<std::uint8_t>(own_base() + result.own_masks.size());
      result.own_masks.push_back(mask);
    }
    for (const LocalSimplex& s : component) {
      if (std::find(s.begin(), s.begin() + k, apex) != s.begin() + k) continue;
      LocalSimplex cone{apex};
      std::copy_n(s.begin(), k, cone.begin() + 1);
      result.simplices.push_back(cone);
    }
  }
  return result;
}

}  // namespace tegl::gen
