// SPDX-License-Identifier: BSD-3-Clause
//
// Weighted means with integer square roots. Places inside the tile are rounded down to the grid.
#include "filling/vertex_places.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace tegl::gen {

namespace {

__extension__ using Wide128 = __int128;

constexpr std::int64_t kUnit = std::int64_t{1} << kGridBits;

/// The largest integer whose square is at most x < 2^120. The result does not depend on the rounding of the first
/// guess.
Wide128 root_of(Wide128 x) {
  auto root = static_cast<Wide128>(std::sqrt(static_cast<double>(x)));
  if (root != 0) root = (root + x / root) / 2;  // a step of Newton's method
  while (root * root > x) --root;
  while ((root + 1) * (root + 1) <= x) ++root;
  return root;
}

Wide128 product(const GridPoint& a, const GridPoint& b) {
  Wide128 sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += static_cast<Wide128>(a[k]) * b[k];
  return sum;
}

GridPoint difference(const GridPoint& a, const GridPoint& b) {
  GridPoint result;
  for (std::size_t k = 0; k < 4; ++k) result[k] = a[k] - b[k];
  return result;
}

/// The distance in units of 2^-44 of an edge.
Wide128 distance(const GridPoint& a, const GridPoint& b) {
  const GridPoint d = difference(a, b);
  return root_of(product(d, d) << 32);
}

/// Twice the area of a triangle.
Wide128 area(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const GridPoint u = difference(b, a), v = difference(c, a);
  return root_of(product(u, u) * product(v, v) - product(u, v) * product(u, v));
}

/// A mean with integer weights.
class WeightedMean {
 public:
  void add(const GridPoint& point, Wide128 weight) {
    for (std::size_t k = 0; k < 4; ++k) sum_[k] += weight * point[k];
    weight_ += weight;
  }
  /// The mean, divided by `by`.
  [[nodiscard]] GridPoint value(std::int64_t by = 1) const {
    if (weight_ == 0) throw std::logic_error("the mean of a facet without extent");
    GridPoint result;
    for (std::size_t k = 0; k < 4; ++k) result[k] = static_cast<std::int64_t>(sum_[k] / (weight_ * by));
    return result;
  }

 private:
  std::array<Wide128, 4> sum_{};
  Wide128 weight_ = 0;
};

}  // namespace

VertexPlaces::VertexPlaces(const FaceContours& faces, const TileContour& contour)
    : tile_(&faces.tile()),
      triangulation_(faces.triangulation()),
      first_side_(faces.own_base() + contour.cone_vertices),
      side_masks_(contour.side_masks) {
  const int n = tile_->dim;
  for (const LocalSimplex& s : contour.boundary) add_to_cone(s, n - 1);
  for (const LocalFacet& facet : contour.facets)
    for (const LocalSimplex& s : facet.simplices)
      if (s[0] >= faces.own_base() && s[0] < first_side_) add_to_cone(s, n);
  for (std::uint8_t e = 0; e < tile_->edge_count(); ++e) edges_of_[e] = 1u << e;
  for (const Cone& cone : cones_)
    for (const LocalSimplex& face : cone.faces)
      for (int i = 0; i < cone.per_face; ++i) edges_of_[cone.apex] |= edges_of_[face[i]];
  for (std::size_t j = 0; j < side_masks_.size(); ++j)
    edges_of_[first_side_ + j] = static_cast<std::uint32_t>(side_masks_[j] >> tile_->corner_count());
  std::uint32_t all = 0;
  for (const LocalSimplex& s : contour.boundary)
    for (int i = 0; i < n - 1; ++i) all |= edges_of_[s[i]];
  for (; all != 0; all &= all - 1) edges_.push_back(static_cast<std::uint8_t>(std::countr_zero(all)));
}

/// Takes a simplex whose first vertex is not on an edge.
void VertexPlaces::add_to_cone(const LocalSimplex& simplex, int count) {
  if (simplex[0] < tile_->edge_count()) return;
  auto found = std::find_if(cones_.begin(), cones_.end(), [&](const Cone& cone) { return cone.apex == simplex[0]; });
  if (found == cones_.end()) {
    cones_.push_back({simplex[0], static_cast<std::uint8_t>(count - 1), {}});
    found = cones_.end() - 1;
  }
  found->faces.push_back({simplex[1], simplex[2], simplex[3], 0});
}

void VertexPlaces::compute(std::span<const std::int64_t> at, std::span<GridPoint> places) const {
  for (const std::uint8_t e : edges_) {
    const auto& [a, b] = tile_->edges[e];
    GridPoint point{};
    for (int k = 0; k < tile_->dim; ++k)
      point[k] = static_cast<std::int64_t>(tile_->corners[a][k]) * (kUnit - at[e]) +
                 static_cast<std::int64_t>(tile_->corners[b][k]) * at[e];
    places[e] = point;
  }
  for (const Cone& cone : cones_)
    places[cone.apex] = triangulation_ == Triangulation::compact ? mean(cone, places) : barycentre(cone, places);
  for (std::size_t j = 0; j < side_masks_.size(); ++j) places[first_side_ + j] = side_place(side_masks_[j], places);
}

/// The barycentre of the facet that the cone is: faces weighted by their measure.
GridPoint VertexPlaces::barycentre(const Cone& cone, std::span<const GridPoint> places) const {
  WeightedMean sum;
  for (const LocalSimplex& face : cone.faces) {
    const GridPoint &a = places[face[0]], &b = places[face[1]];
    WeightedMean middle;
    if (cone.per_face == 2) {
      middle.add(a, 1), middle.add(b, 1);
      sum.add(middle.value(), distance(a, b));
      continue;
    }
    const GridPoint& c = places[face[2]];
    if (face[0] >= tile_->edge_count()) {
      sum.add(a, area(a, b, c));
      continue;
    }
    WeightedMean outline;  // its sides, weighted by their lengths
    const std::array<const GridPoint*, 4> ring = {&a, &b, &c, &a};
    for (std::size_t i = 0; i < 3; ++i) {
      const Wide128 length = distance(*ring[i], *ring[i + 1]);
      outline.add(*ring[i], length), outline.add(*ring[i + 1], length);
    }
    sum.add(outline.value(), area(a, b, c));
  }
  return sum.value();
}

/// The mean of the vertices that a compact cone is coned to.
GridPoint VertexPlaces::mean(const Cone& cone, std::span<const GridPoint> places) const {
  std::array<bool, 256> seen{};
  WeightedMean sum;
  for (const LocalSimplex& face : cone.faces)
    for (int i = 0; i < cone.per_face; ++i)
      if (!seen[face[i]]) seen[face[i]] = true, sum.add(places[face[i]], 1);
  return sum.value();
}

/// The mean of corners and points on edges; with corners, half way from there to the tile's centre, for any samples.
GridPoint VertexPlaces::side_place(std::uint64_t mask, std::span<const GridPoint> places) const {
  WeightedMean sum;
  bool has_corners = false;
  for (std::uint64_t rest = mask; rest != 0; rest &= rest - 1) {
    const auto v = static_cast<std::uint32_t>(std::countr_zero(rest));
    if (v >= tile_->corner_count()) {
      sum.add(places[v - tile_->corner_count()], 1);
      continue;
    }
    has_corners = true;
    GridPoint corner{};
    for (int k = 0; k < tile_->dim; ++k) corner[k] = static_cast<std::int64_t>(tile_->corners[v][k]) * kUnit;
    sum.add(corner, 1);
  }
  if (!has_corners) return sum.value();
  GridPoint result = sum.value(2);
  for (int k = 0; k < tile_->dim; ++k) result[k] += kUnit / 4;
  return result;
}

}  // namespace tegl::gen
