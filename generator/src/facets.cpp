// SPDX-License-Identifier: BSD-3-Clause
//
// Sigma by recursion over dimension, its components, and the orientation. How a component is filled is in
// filling.cpp.
#include "tegl/gen/facets.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "determinant.hpp"
#include "filling.hpp"
#include "hull.hpp"
#include "tegl/gen/regions.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

namespace {

/// The corners of a 2-tile in cyclic order: a ring walked along its edges.
std::vector<std::uint8_t> ring_of(const Tile& tile) {
  std::vector<std::uint8_t> ring{0};
  std::vector<bool> used(tile.edges.size(), false);
  while (ring.size() < tile.corner_count())
    for (std::size_t e = 0; e < tile.edges.size(); ++e) {
      const auto& [a, b] = tile.edges[e];
      if (used[e] || (a != ring.back() && b != ring.back())) continue;
      used[e] = true;
      ring.push_back(a == ring.back() ? b : a);
      break;
    }
  return ring;
}

std::uint8_t edge_between(const Tile& tile, std::uint8_t a, std::uint8_t b) {
  for (std::uint8_t e = 0; e < tile.edge_count(); ++e)
    if ((tile.edges[e][0] == a && tile.edges[e][1] == b) || (tile.edges[e][0] == b && tile.edges[e][1] == a)) return e;
  throw std::logic_error("no edge between two corners of a ring");
}

/// Dimension 1: a critical edge has one point, signed like the boundary of its high part: + if the second end
/// is high.
TileContour contour_of_edge(Signature signature) {
  TileContour result;
  if (signature == 1 || signature == 2) {
    Facet facet;
    facet.filling = Filling::point;
    facet.sign = signature == 2 ? 1 : -1;
    facet.points = {0};
    facet.simplices = {Simplex{0}};
    result.facets.push_back(facet);
  }
  return result;
}

}  // namespace

ContourBuilder::ContourBuilder(const Lattice& lattice, int n, Alternative alternative, Triangulation triangulation)
    : tile_(&lattice.tile(n)), alternative_(alternative), triangulation_(triangulation) {
  if (n < 1 || n > 4) throw std::invalid_argument("contour builder: dimension must be 1 to 4");
  if (n == 1) return;
  face_builder_ = std::make_unique<ContourBuilder>(lattice, n - 1, alternative, triangulation);
  const Signature last = face_builder_->tile().full();
  face_contours_.reserve(std::size_t{last} + 1);
  for (Signature s = 0; s <= last; ++s) face_contours_.push_back(face_builder_->build(s));
  for (std::uint32_t f = 0; f < tile_->faces.size(); ++f) {
    for (const std::uint8_t e : tile_->faces[f].edge) faces_of_[e] |= 1u << f;
    if (n == 4)
      for (std::uint32_t j = 0; j < tables::kFaceSlots; ++j)
        faces_of_[tile_->edge_count() + f * tables::kFaceSlots + j] |= 1u << f;
  }
  if (n >= 3 && triangulation == Triangulation::compact) hulls_ = std::make_unique<HullContours>(*tile_);
  if (n == 4 && tile_->kind == TileKind::cube)  // a 4-simplex has no component that is no sphere
    side_regions_ = std::make_unique<RegionBuilder>(lattice, 3, Alternative::low, triangulation, RegionStyle::cone);
  find_orientation();
}

ContourBuilder::~ContourBuilder() = default;

std::uint32_t ContourBuilder::own_base() const {
  const std::uint32_t slots = tile_->dim == 4 ? tables::kFaceSlots : 0;
  return tile_->edge_count() + slots * static_cast<std::uint32_t>(tile_->faces.size());
}

const TileContour& ContourBuilder::face_contour(std::uint32_t f, Signature signature) const {
  return face_contours_[tile_->restrict_to(f, signature)];
}

std::uint8_t ContourBuilder::lift(std::uint32_t f, std::uint8_t vertex) const {
  const SubTile& face = tile_->faces[f];
  if (vertex < face.edge.size()) return face.edge[vertex];
  const std::uint32_t slot = vertex - face_builder_->own_base();
  if (slot >= tables::kFaceSlots || tile_->dim != 4)
    throw std::logic_error("a face's contour has more vertices of its own than the contract has slots for");
  return static_cast<std::uint8_t>(tile_->edge_count() + f * tables::kFaceSlots + slot);
}

/// The contour around a single high corner is convex, so that one of its simplices fixes the sign for all.
void ContourBuilder::find_orientation() {
  const TileContour one = build(1);
  const Facet& facet = one.facets.at(0);
  const Simplex& simplex = facet.simplices.at(0);
  const int n = tile_->dim;
  const auto on_edge = [&](std::uint8_t e, int i) {
    return 0.5 * (tile_->corners[tile_->edges[e][0]][i] + tile_->corners[tile_->edges[e][1]][i]);
  };
  const auto midpoint = [&](std::uint8_t v, int i) {  // a barycentre: about the middle of the facet
    if (v < tile_->edge_count()) return on_edge(v, i);
    double sum = 0;
    for (const std::uint8_t e : facet.points) sum += on_edge(e, i);
    return sum / static_cast<double>(facet.points.size());
  };
  std::array<std::array<double, 4>, 4> m{};
  for (int i = 0; i < n; ++i) {
    for (int r = 1; r < n; ++r) m[r - 1][i] = midpoint(simplex[r], i) - midpoint(simplex[0], i);
    m[n - 1][i] = tile_->corners[0][i] - midpoint(simplex[0], i);
  }
  if (determinant(m, n) < 0) orientation_ = -orientation_;
}

/// Sigma: the facets of all faces, lifted, with the signs of the boundary.
TileContour ContourBuilder::sigma(Signature signature) const {
  TileContour result;
  const int k = tile_->dim - 1;  // vertices per simplex of Sigma
  for (std::uint32_t f = 0; f < tile_->faces.size(); ++f)
    for (const Facet& facet : face_contour(f, signature).facets)
      for (Simplex simplex : facet.simplices) {
        for (int i = 0; i < k; ++i) simplex[i] = lift(f, simplex[i]);
        const int sign = tile_->faces[f].sign * orientation_ * facet.sign;
        if (k == 1) result.boundary_sign.push_back(static_cast<std::int8_t>(sign));
        if (k > 1 && sign < 0) std::swap(simplex[k - 1], simplex[k - 2]);
        result.boundary.push_back(simplex);
      }
  return result;
}

/// Dimension 2 (section 6.2): each maximal run of high corners of the ring (low-connected: of low ones
/// otherwise) is cut off by a segment between the two critical edges at its ends.
static void cut_runs(const Tile& tile, Signature signature, Alternative alternative, TileContour& contour) {
  const auto ring = ring_of(tile);
  const std::size_t m = ring.size();
  const auto inside = [&](std::size_t i) {
    const bool high = ((signature >> ring[i % m]) & 1u) != 0;
    return high == (alternative == Alternative::low);
  };
  std::vector<std::int8_t> sign_of(tile.edges.size(), 0);
  for (std::size_t i = 0; i < contour.boundary.size(); ++i) sign_of[contour.boundary[i][0]] = contour.boundary_sign[i];
  for (std::size_t start = 0; start < m; ++start) {
    if (!inside(start) || inside(start + m - 1)) continue;  // a run starts here
    std::size_t end = start;
    while (inside(end + 1)) ++end;
    std::uint8_t from = edge_between(tile, ring[(start + m - 1) % m], ring[start]);
    std::uint8_t to = edge_between(tile, ring[end % m], ring[(end + 1) % m]);
    if (sign_of[from] > 0) std::swap(from, to);  // the boundary of a segment is to - from
    Facet facet;
    facet.boundary_euler = 2;
    facet.boundary_facets = 2;
    facet.points = {from, to};
    facet.simplices = {Simplex{from, to}};
    contour.facets.push_back(facet);
  }
}

TileContour ContourBuilder::build(Signature signature) const {
  if (tile_->dim == 1) return contour_of_edge(signature);
  TileContour contour = sigma(signature);
  if (contour.boundary.empty()) return contour;
  if (tile_->dim == 2)
    cut_runs(*tile_, signature, alternative_, contour);
  else
    fill(*this, signature, contour);
  return contour;
}

}  // namespace tegl::gen
