// SPDX-License-Identifier: BSD-3-Clause
//
// Local vertices of a cell's contour.
#include "tegl/tile/local_contour.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

namespace tegl::tile {

namespace {

using Added = std::vector<std::pair<std::uint64_t, VertexId>>;

class Masks {
 public:
  Masks(const FaceLattice& lattice, std::span<const std::uint8_t> edge_of, const TileFacets& facets)
      : lattice_(lattice),
        edge_of_(edge_of),
        facets_(facets),
        corners_(static_cast<unsigned>(std::popcount(lattice.faces().back().corners))) {}

  [[nodiscard]] std::uint64_t operator()(VertexId v) const {
    const Vertex& vertex = facets_.vertices[v];
    if (vertex.kind == VertexKind::corner) return lattice_.faces()[vertex.face].corners;
    if (vertex.kind == VertexKind::edge) return std::uint64_t{1} << (corners_ + edge_of_[vertex.face]);
    if (vertex.copied != kNoVertex) return (*this)(vertex.copied);
    std::uint64_t mask = 0;
    for (const Simplex& s : vertex.of)
      for (const VertexId w : s)
        if (w != kNoVertex && w != v) mask |= (*this)(w);
    return mask;
  }

 private:
  const FaceLattice& lattice_;
  std::span<const std::uint8_t> edge_of_;
  const TileFacets& facets_;
  unsigned corners_;
};

/// The mask of a side vertex: in a 3-face with one polygon that has a barycentre, the barycentre's. So the copy of the
/// barycentre is on its ray. A vertex near the corners of the side would see triangles of the polygon from behind, for
/// some positions.
std::uint64_t on_ray(std::uint64_t mask, const Added& barycentres) {
  std::uint64_t found = 0;
  for (const auto& [points, v] : barycentres) {
    if ((points & ~mask) != 0) continue;
    if (found != 0) return mask;
    found = points;
  }
  return found != 0 ? found : mask;
}

/// The added vertices of the facets by kind: in 3-faces, barycentres, side vertices; each kind ordered by mask.
std::array<Added, 3> added_vertices(const FaceLattice& lattice, const TileFacets& facets, const Masks& mask_of) {
  const auto n = static_cast<std::size_t>(lattice.dim());
  std::array<Added, 3> added;
  std::vector<bool> seen(facets.vertices.size(), false);
  for (const Facet& facet : facets.facets)
    for (const Simplex& s : facet.simplices)
      for (std::size_t i = 0; i < n; ++i) {
        const Vertex& vertex = facets.vertices[s[i]];
        if (vertex.kind == VertexKind::edge || seen[s[i]]) continue;
        seen[s[i]] = true;
        const bool own = vertex.face == lattice.tile(), cone = vertex.kind == VertexKind::barycentre;
        if (!(own || cone) || (!cone && vertex.kind != VertexKind::side))
          throw std::logic_error("a vertex of another kind");
        added[!own ? 0 : cone ? 1 : 2].emplace_back(mask_of(s[i]), s[i]);
      }
  for (auto& [mask, v] : added[2]) mask = on_ray(mask, added[0]);
  for (Added& kind : added) std::sort(kind.begin(), kind.end());
  return added;
}

}  // namespace

LocalContour local_contour(const FaceLattice& lattice, std::span<const std::uint8_t> edge_of, unsigned edge_count,
                           const TileFacets& facets, bool reversed) {
  const auto n = static_cast<std::size_t>(lattice.dim());
  const std::array<Added, 3> added = added_vertices(lattice, facets, Masks(lattice, edge_of, facets));
  LocalContour contour;
  std::vector<std::uint8_t> local(facets.vertices.size(), 0);
  for (std::size_t v = 0; v < facets.vertices.size(); ++v)
    if (facets.vertices[v].kind == VertexKind::edge) local[v] = edge_of[facets.vertices[v].face];
  for (std::size_t kind = 0; kind < 3; ++kind) {
    for (const auto& [mask, v] : added[kind]) {
      const std::size_t number = edge_count + contour.masks.size();
      if (number > 255) throw std::length_error("more than 256 vertices");
      local[v] = static_cast<std::uint8_t>(number);
      contour.masks.push_back(mask);
    }
    contour.added_count[kind] = static_cast<std::uint8_t>(added[kind].size());
  }
  for (const Facet& facet : facets.facets)
    for (const Simplex& s : facet.simplices) {
      auto& simplex = contour.simplices.emplace_back();
      for (std::size_t i = 0; i < n; ++i) simplex[i] = local[s[i]];
      if (reversed) std::swap(simplex[n - 1], simplex[n - 2]);
    }
  return contour;
}

}  // namespace tegl::tile
