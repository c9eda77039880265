// SPDX-License-Identifier: BSD-3-Clause
//
// The recursion over dimension, the contours of edges and polygons, and the orientation. filling.cpp fills the
// components of Sigma of larger tiles.
#include "filling/facets.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "base/determinant.hpp"
#include "filling/filling.hpp"

namespace tegl::gen {

namespace {

/// The corners of a 2-tile in cyclic order along its edges.
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

/// Dimension 1: a critical edge has one point. Its sign is that of the boundary of the high part: + if the second end
/// is high.
TileContour contour_of_edge(Signature signature) {
  TileContour result;
  if (signature == 1 || signature == 2) {
    LocalFacet facet;
    facet.filling = Filling::simplex;
    facet.sign = signature == 2 ? 1 : -1;
    facet.points = {0};
    facet.simplices = {LocalSimplex{0}};
    result.facets.push_back(facet);
  }
  return result;
}

/// Dimension 2 (section 6.2): each maximal run of high corners (low-connected; otherwise of low corners) is cut off by
/// a segment between the critical edges at its ends.
void cut_runs(const Tile& tile, Signature signature, Alternative alternative, TileContour& contour) {
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
    std::uint8_t from = tile.edge_between(ring[(start + m - 1) % m], ring[start]);
    std::uint8_t to = tile.edge_between(ring[end % m], ring[(end + 1) % m]);
    if (sign_of[from] > 0) std::swap(from, to);  // the boundary of a segment is to - from
    LocalFacet facet;
    facet.boundary_euler = 2;
    facet.boundary_facets = 2;
    facet.points = {from, to};
    facet.simplices = {LocalSimplex{from, to}};
    contour.facets.push_back(facet);
  }
}

const Tile& tile_of(const Lattice& lattice, int n) {
  if (n < 1 || n > 4) throw std::invalid_argument("contour builder: dimension must be 1 to 4");
  return lattice.tile(n);
}

std::vector<TileContour> all_contours(const ContourBuilder& builder) {
  const Signature last = builder.tile().full();
  std::vector<TileContour> result;
  result.reserve(std::size_t{last} + 1);
  for (Signature s = 0; s <= last; ++s) result.push_back(builder.build(s));
  return result;
}

std::vector<TileContour> contours_of_faces(const Lattice& lattice, int n, Alternative alternative,
                                           Triangulation triangulation) {
  if (tile_of(lattice, n).dim == 1) return {};
  return all_contours(ContourBuilder(lattice, n - 1, alternative, triangulation));
}

}  // namespace

ContourBuilder::ContourBuilder(const Lattice& lattice, int n, Alternative alternative, Triangulation triangulation)
    : FaceContours(tile_of(lattice, n), alternative, triangulation,
                   contours_of_faces(lattice, n, alternative, triangulation)) {
  if (n == 1) return;
  if (n >= 3 && triangulation == Triangulation::compact) {
    hulls_ = std::make_unique<HullContours>(tile());
    proof_ = std::make_unique<EmbeddingProof>(tile());
  }
  if (n == 4 && tile().kind == TileKind::cube) {  // 4-simplices have spherical components only
    const auto contours = contours_by_dimension(lattice, 3, Alternative::low, triangulation);
    side_regions_ = std::make_unique<SignatureRegions>(lattice, 3, contours, RegionStyle::cone);
  }
  find_orientation();
}

ContourBuilder::ContourBuilder(const Lattice& lattice, int n, std::vector<TileContour> of_faces)
    : FaceContours(tile_of(lattice, n), Alternative::low, Triangulation::compact, std::move(of_faces)),
      hulls_(std::make_unique<HullContours>(tile())),
      proof_(std::make_unique<EmbeddingProof>(tile())) {
  find_orientation();
}

/// The contour around a single high corner is convex, so one of its simplices fixes the sign for all.
void ContourBuilder::find_orientation() {
  const TileContour one = build(1);
  const LocalFacet& facet = one.facets.at(0);
  const LocalSimplex& simplex = facet.simplices.at(0);
  const int n = dim();
  const auto on_edge = [&](std::uint8_t e, int i) {
    return 0.5 * (tile().corners[tile().edges[e][0]][i] + tile().corners[tile().edges[e][1]][i]);
  };
  const auto midpoint = [&](std::uint8_t v, int i) {  // a barycentre: approximately the middle of the facet
    if (v < tile().edge_count()) return on_edge(v, i);
    double sum = 0;
    for (const std::uint8_t e : facet.points) sum += on_edge(e, i);
    return sum / static_cast<double>(facet.points.size());
  };
  std::array<std::array<double, 4>, 4> m{};
  for (int i = 0; i < n; ++i) {
    for (int r = 1; r < n; ++r) m[r - 1][i] = midpoint(simplex[r], i) - midpoint(simplex[0], i);
    m[n - 1][i] = tile().corners[0][i] - midpoint(simplex[0], i);
  }
  if (determinant(m, n) < 0) reverse_orientation();
}

TileContour ContourBuilder::build(Signature signature) const {
  if (dim() == 1) return contour_of_edge(signature);
  TileContour contour = sigma(signature);
  if (contour.boundary.empty()) return contour;
  if (dim() == 2)
    cut_runs(tile(), signature, alternative(), contour);
  else
    fill(*this, {hulls_.get(), proof_.get(), side_regions_.get()}, signature, contour);
  return contour;
}

std::vector<std::vector<TileContour>> contours_by_dimension(const Lattice& lattice, int n, Alternative alternative,
                                                            Triangulation triangulation) {
  std::vector<std::vector<TileContour>> result;
  for (int k = 1; k <= n; ++k) result.push_back(all_contours(ContourBuilder(lattice, k, alternative, triangulation)));
  return result;
}

}  // namespace tegl::gen
