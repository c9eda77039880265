// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of mesh cells: facets, fans, local vertices.
#include "cells/cell_contours.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "base/determinant.hpp"
#include "base/error.hpp"

namespace tegl::gen {

namespace {

/// The polygon that a barycentre is coned over, along its orientation.
std::vector<tile::VertexId> cycle_of(const tile::Facet& facet, tile::VertexId apex) {
  std::vector<std::pair<tile::VertexId, tile::VertexId>> sides;
  for (const tile::Simplex& s : facet.simplices) {
    const auto at = std::find(s.begin(), s.begin() + 3, apex) - s.begin();
    sides.emplace_back(s[(at + 1) % 3], s[(at + 2) % 3]);
  }
  std::vector<tile::VertexId> cycle{sides.front().first};
  while (cycle.size() < sides.size()) {
    const auto next = std::find_if(sides.begin(), sides.end(), [&](const auto& s) { return s.first == cycle.back(); });
    cycle.push_back(next->second);
  }
  return cycle;
}

}  // namespace

CellContours::CellContours(const Cell& cell, Triangulation triangulation)
    : cell_(cell), triangulation_(triangulation), builder_(cell.lattice) {
  const Tile& tile = cell.tile;
  if (tile.dim == 4 && triangulation == Triangulation::compact)
    throw std::invalid_argument("compact contours of a 4-cell; expected barycentric");
  polygons_of_.assign(tile.edge_count(), 0);
  std::uint32_t polygon = 0;
  for (const tile::Face& face : cell.lattice.faces()) {
    if (face.dim != 2 || tile.dim != 3) continue;
    for (std::uint32_t e = 0; e < tile.edge_count(); ++e)
      if ((face.corners >> tile.edges[e][0] & face.corners >> tile.edges[e][1] & 1u) != 0)
        polygons_of_[e] |= 1u << polygon;
    ++polygon;
  }
  if (is_cube(cell) && tile.dim == 3 && triangulation == Triangulation::compact) {
    cubes_ = std::make_unique<CubeLattice>(3);
    cube_ = std::make_unique<ContourBuilder>(*cubes_, 3, Alternative::low, Triangulation::compact);
    for (const auto& [a, b] : cube_->tile().edges) edge_of_cube_.push_back(tile.edge_between(a, b));
  }
  find_orientation();
}

std::uint8_t CellContours::edge_of(const tile::Vertex& vertex) const {
  const Signature corners = cell_.lattice.faces()[vertex.face].corners;
  return cell_.tile.edge_between(static_cast<std::uint32_t>(std::countr_zero(corners)),
                                 static_cast<std::uint32_t>(63 - std::countl_zero(corners)));
}

/// The contour around the single high corner 0 is convex, so one of its simplices fixes the sign for all.
void CellContours::find_orientation() {
  facets_ = builder_.build(1);
  const tile::Simplex& simplex = facets_.facets.at(0).simplices.at(0);
  const Tile& tile = cell_.tile;
  const auto place = [&](tile::VertexId v) {  // a barycentre: approximately the middle of the facet
    std::array<double, 4> sum{};
    const std::uint64_t points = mask_of(v) >> tile.corner_count();
    for (std::uint32_t e = 0; e < tile.edge_count(); ++e)
      for (std::size_t i = 0; (points >> e & 1u) != 0 && i < 4; ++i)
        sum[i] += (tile.corners[tile.edges[e][0]][i] + tile.corners[tile.edges[e][1]][i]) / 2 / std::popcount(points);
    return sum;
  };
  const auto n = static_cast<std::size_t>(tile.dim);
  const auto origin = place(simplex[0]);
  std::array<std::array<double, 4>, 4> m{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t r = 1; r < n; ++r) m[r - 1][i] = place(simplex[r])[i] - origin[i];
    m[n - 1][i] = tile.corners[0][i] - origin[i];
  }
  reversed_ = determinant(m, tile.dim) < 0;
}

const tile::TileFacets& CellContours::build(Signature signature) {
  facets_ = builder_.build(signature);
  if (triangulation_ == Triangulation::compact && cell_.tile.dim == 3) make_compact(signature);
  return facets_;
}

void CellContours::make_compact(Signature signature) {
  if (cube_ != nullptr) {
    take_from_cube(signature);
    return;
  }
  for (tile::Facet& facet : facets_.facets)
    if (facet.filling == tile::Filling::cone) cut_into_fan(facet);
}

/// The entry of the cube's table. Facets of the table and of the lattice are oriented by the side that is high, in the
/// table against the coordinates, in the lattice against its own orientation.
void CellContours::take_from_cube(Signature signature) {
  std::vector<tile::VertexId> vertex(cell_.tile.edge_count(), tile::kNoVertex);
  for (std::size_t v = 0; v < facets_.vertices.size(); ++v)
    if (facets_.vertices[v].kind == tile::VertexKind::edge)
      vertex[edge_of(facets_.vertices[v])] = static_cast<tile::VertexId>(v);
  facets_.facets.clear();
  for (const LocalFacet& facet : cube_->build(signature).facets) {
    tile::Facet taken;
    for (const LocalSimplex& s : facet.simplices) {
      tile::Simplex simplex = tile::kNoSimplex;
      for (std::size_t i = 0; i < 3; ++i) simplex[i] = vertex[edge_of_cube_[s[i]]];
      if (reversed_) std::swap(simplex[1], simplex[2]);
      taken.simplices.push_back(simplex);
    }
    facets_.facets.push_back(std::move(taken));
  }
}

/// A chord whose ends lie in a common face could be a chord of the neighbour, too: only fans without one are allowed.
/// Of these, the one from the smallest vertex is taken.
void CellContours::cut_into_fan(tile::Facet& facet) const {
  tile::VertexId apex = tile::kNoVertex;
  for (const tile::Simplex& s : facet.simplices)
    for (std::size_t i = 0; i < 3; ++i)
      if (facets_.vertices[s[i]].kind == tile::VertexKind::barycentre) apex = s[i];
  std::vector<tile::VertexId> cycle = cycle_of(facet, apex);
  const auto faces = [&](std::size_t i) { return polygons_of_[edge_of(facets_.vertices[cycle[i]])]; };
  std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
  for (std::size_t turn = 0; turn < cycle.size(); ++turn) {
    bool allowed = true;
    for (std::size_t i = 2; i + 1 < cycle.size(); ++i) allowed = allowed && (faces(0) & faces(i)) == 0;
    if (allowed) {
      facet.simplices.clear();
      for (std::size_t i = 1; i + 1 < cycle.size(); ++i) {
        tile::Simplex simplex = tile::kNoSimplex;
        simplex[0] = cycle[0], simplex[1] = cycle[i], simplex[2] = cycle[i + 1];
        facet.simplices.push_back(simplex);
      }
      facet.filling = tile::Filling::pulled;
      return;
    }
    std::rotate(cycle.begin(), cycle.begin() + 1, cycle.end());
  }
  throw Error(ErrorCode::Internal,
              fmt::format("{}: a polygon of {} points without a fan inside", cell_.name, cycle.size()));
}

std::uint64_t CellContours::mask_of(tile::VertexId v) const {
  const tile::Vertex& vertex = facets_.vertices[v];
  const std::uint32_t corners = cell_.tile.corner_count();
  if (vertex.kind == tile::VertexKind::corner) return cell_.lattice.faces()[vertex.face].corners;
  if (vertex.kind == tile::VertexKind::edge) return std::uint64_t{1} << (corners + edge_of(vertex));
  if (vertex.copied != tile::kNoVertex) return mask_of(vertex.copied);
  std::uint64_t mask = 0;
  for (const tile::Simplex& s : vertex.of)
    for (const tile::VertexId w : s)
      if (w != tile::kNoVertex && w != v) mask |= mask_of(w);
  return mask;
}

/// The mask of a side vertex: in a 3-face with one polygon that has a barycentre, the barycentre's. So the copy of the
/// barycentre is on its ray. A vertex near the corners of the side would see triangles of the polygon from behind, for
/// some positions.
std::uint64_t CellContours::on_ray(std::uint64_t mask,
                                   const std::vector<std::pair<std::uint64_t, tile::VertexId>>& barycentres) const {
  std::uint64_t found = 0;
  for (const auto& [points, v] : barycentres) {
    if ((points & ~mask) != 0) continue;
    if (found != 0) return mask;
    found = points;
  }
  return found != 0 ? found : mask;
}

CellContour CellContours::local() const {
  const auto n = static_cast<std::size_t>(cell_.tile.dim);
  // added vertices by kind, ordered by mask
  std::array<std::vector<std::pair<std::uint64_t, tile::VertexId>>, 3> added;
  std::vector<bool> seen(facets_.vertices.size(), false);
  for (const tile::Facet& facet : facets_.facets)
    for (const tile::Simplex& s : facet.simplices)
      for (std::size_t i = 0; i < n; ++i) {
        const tile::Vertex& vertex = facets_.vertices[s[i]];
        if (vertex.kind == tile::VertexKind::edge || seen[s[i]]) continue;
        seen[s[i]] = true;
        const bool own = vertex.face == cell_.lattice.tile(), cone = vertex.kind == tile::VertexKind::barycentre;
        if (!(own || cone) || (!cone && vertex.kind != tile::VertexKind::side))
          throw Error(ErrorCode::Internal, fmt::format("{}: a vertex of another kind", cell_.name));
        added[!own ? 0 : cone ? 1 : 2].emplace_back(mask_of(s[i]), s[i]);
      }
  for (auto& [mask, v] : added[2]) mask = on_ray(mask, added[0]);
  // local numbers
  CellContour contour;
  std::vector<std::uint8_t> local(facets_.vertices.size(), 0);
  for (std::size_t v = 0; v < facets_.vertices.size(); ++v)
    if (facets_.vertices[v].kind == tile::VertexKind::edge) local[v] = edge_of(facets_.vertices[v]);
  for (std::size_t kind = 0; kind < 3; ++kind) {
    std::sort(added[kind].begin(), added[kind].end());
    for (const auto& [mask, v] : added[kind]) {
      const std::size_t number = cell_.tile.edge_count() + contour.masks.size();
      if (number > 255) throw Error(ErrorCode::Internal, fmt::format("{}: more than 256 vertices", cell_.name));
      local[v] = static_cast<std::uint8_t>(number);
      contour.masks.push_back(mask);
    }
    contour.added_count[kind] = static_cast<std::uint8_t>(added[kind].size());
  }
  for (const tile::Facet& facet : facets_.facets)
    for (const tile::Simplex& s : facet.simplices) {
      LocalSimplex simplex{};
      for (std::size_t i = 0; i < n; ++i) simplex[i] = local[s[i]];
      if (reversed_) std::swap(simplex[n - 1], simplex[n - 2]);
      contour.simplices.push_back(simplex);
    }
  return contour;
}

}  // namespace tegl::gen
