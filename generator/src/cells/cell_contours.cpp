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
  for (const tile::Face& face : cell.lattice.faces())
    edge_of_.push_back(face.dim != 1
                           ? std::uint8_t{0}
                           : tile.edge_between(static_cast<std::uint32_t>(std::countr_zero(face.corners)),
                                               63u - static_cast<std::uint32_t>(std::countl_zero(face.corners))));
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

std::uint8_t CellContours::edge_of(const tile::Vertex& vertex) const { return edge_of_[vertex.face]; }

/// The contour around the single high corner 0 is convex, so one of its simplices fixes the sign for all.
void CellContours::find_orientation() {
  facets_ = builder_.build(1);
  const tile::LocalContour contour = as_local(false);
  const LocalSimplex& simplex = contour.simplices.at(0);
  const Tile& tile = cell_.tile;
  const auto place = [&](std::uint8_t v) {  // a barycentre: approximately the middle of the facet
    std::array<double, 4> sum{};
    const std::uint64_t points =
        v < tile.edge_count() ? std::uint64_t{1} << v : contour.masks[v - tile.edge_count()] >> tile.corner_count();
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

tile::LocalContour CellContours::as_local(bool reversed) const {
  try {
    return tile::local_contour(cell_.lattice, edge_of_, cell_.tile.edge_count(), facets_, reversed);
  } catch (const std::exception& error) {
    throw Error(ErrorCode::Internal, fmt::format("{}: {}", cell_.name, error.what()));
  }
}

CellContour CellContours::local() const {
  tile::LocalContour contour = as_local(reversed_);
  return {std::move(contour.simplices), std::move(contour.masks), contour.added_count};
}

}  // namespace tegl::gen
