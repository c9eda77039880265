// SPDX-License-Identifier: BSD-3-Clause
//
// Convex hulls in exact integer arithmetic. A hyperplane through n edge midpoints with all points on one side contains
// a facet. The hyperplanes are few and the same for all signatures. Edge midpoints of a cube are in convex position and
// no three are collinear, so a set of vertices identifies a face of the hull, and intersections of these sets give the
// faces of faces.
//
// Based on: P. Bhaniramka, R. Wenger and R. Crawfis, Isosurface construction in any dimension using convex hulls, 2004
// (the hull); C. Lee, Regular triangulations of convex polytopes, 1991 (pulling).
#include "filling/hull.hpp"

#include <algorithm>
#include <bit>

#include "base/determinant.hpp"

namespace tegl::gen {

namespace {

using Point = std::array<int, 4>;

int dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

/// Number of affinely independent points, by division-free elimination.
int affine_rank(const std::vector<Point>& points) {
  std::vector<Point> rows;
  for (std::size_t i = 1; i < points.size(); ++i) {
    rows.emplace_back();
    for (int k = 0; k < 4; ++k) rows.back()[k] = points[i][k] - points[0][k];
  }
  int rank = 0;
  for (int c = 0; c < 4; ++c) {
    const auto pivot = std::find_if(rows.begin() + rank, rows.end(), [c](const Point& r) { return r[c] != 0; });
    if (pivot == rows.end()) continue;
    std::iter_swap(rows.begin() + rank, pivot);
    const Point by = rows[rank];
    for (std::size_t r = static_cast<std::size_t>(rank) + 1; r < rows.size(); ++r) {
      const int factor = rows[r][c];
      for (int k = 0; k < 4; ++k) rows[r][k] = rows[r][k] * by[c] - by[k] * factor;
    }
    ++rank;
  }
  return rank + 1;
}

template <class Call>
void for_each_bit(std::uint64_t set, const Call& call) {
  for (; set != 0; set &= set - 1) call(static_cast<std::uint8_t>(std::countr_zero(set)));
}

}  // namespace

HullContours::HullContours(const Tile& tile) : tile_(tile) {
  const auto doubled = [&](std::uint32_t a, std::uint32_t b) {
    Point p{};
    for (int i = 0; i < tile.dim; ++i) p[i] = static_cast<int>(tile.corners[a][i] + tile.corners[b][i]);
    return p;
  };
  for (std::uint32_t v = 0; v < tile.corner_count(); ++v) corners_.push_back(doubled(v, v));
  for (const auto& [a, b] : tile.edges) midpoints_.push_back(doubled(a, b));
  for (const SubTile& face : tile.faces) {
    tile_faces_.push_back(0);
    for (const std::uint8_t e : face.edge) tile_faces_.back() |= Edges{1} << e;
  }
  std::vector<std::uint8_t> chosen;
  add_hyperplanes(chosen);
}

/// Adds all hyperplanes through n midpoints, each once, except the hyperplanes of the tile's faces.
void HullContours::add_hyperplanes(std::vector<std::uint8_t>& chosen) {
  // choose n midpoints by recursion
  if (static_cast<int>(chosen.size()) < tile_.dim) {
    for (std::size_t e = chosen.empty() ? 0 : chosen.back() + std::size_t{1}; e < midpoints_.size(); ++e) {
      chosen.push_back(static_cast<std::uint8_t>(e));
      add_hyperplanes(chosen);
      chosen.pop_back();
    }
    return;
  }
  // skip dependent points, the tile's faces and known hyperplanes
  Edges set = 0;
  for (const std::uint8_t e : chosen) set |= Edges{1} << e;
  const auto covers = [set](Edges face) { return (set & ~face) == 0; };
  const Point normal = normal_of(chosen);
  if (normal == Point{} || std::any_of(tile_faces_.begin(), tile_faces_.end(), covers) ||
      std::any_of(hyperplanes_.begin(), hyperplanes_.end(), [&](const Hyperplane& h) { return covers(h.on); }))
    return;
  // classify all midpoints and corners
  Hyperplane plane{normal};
  const int level = dot(normal, midpoints_[chosen[0]]);
  for (std::size_t e = 0; e < midpoints_.size(); ++e) {
    const int d = dot(normal, midpoints_[e]) - level;
    (d == 0 ? plane.on : d > 0 ? plane.above : plane.below) |= Edges{1} << e;
  }
  for (std::size_t v = 0; v < corners_.size(); ++v) {
    const int d = dot(normal, corners_[v]) - level;
    if (d > 0) plane.corners_above |= Signature{1} << v;
    if (d < 0) plane.corners_below |= Signature{1} << v;
  }
  hyperplanes_.push_back(plane);
}

/// A normal of the hyperplane through the chosen midpoints; zero if they are affinely dependent.
Point HullContours::normal_of(const std::vector<std::uint8_t>& chosen) const {
  std::array<Point, 3> differences{};
  for (int r = 1; r < tile_.dim; ++r)
    for (int i = 0; i < 4; ++i) differences[r - 1][i] = midpoints_[chosen[r]][i] - midpoints_[chosen[0]][i];
  return cross_product(differences, static_cast<std::size_t>(tile_.dim));
}

bool HullContours::spans_facet(Edges vertices) const {
  if (std::popcount(vertices) < tile_.dim) return false;
  std::vector<Point> points;
  for_each_bit(vertices, [&](std::uint8_t e) { points.push_back(midpoints_[e]); });
  return affine_rank(points) == tile_.dim;
}

std::vector<LocalSimplex> HullContours::contour(Signature inside) const {
  // critical edges
  Edges critical = 0;
  for (std::uint32_t e = 0; e < tile_.edge_count(); ++e) {
    const auto [a, b] = tile_.edges[e];
    if (((inside >> a) & 1u) != ((inside >> b) & 1u)) critical |= Edges{1} << e;
  }
  // hyperplanes that contain a facet, with its outward normal
  std::vector<HullFacet> facets;
  for (const Hyperplane& h : hyperplanes_) {
    const bool above = (h.above & critical) != 0 || (h.corners_above & inside) != 0;
    const bool below = (h.below & critical) != 0 || (h.corners_below & inside) != 0;
    if ((above && below) || !spans_facet(h.on & critical)) continue;
    Point outward = h.normal;
    if (above)
      for (int& x : outward) x = -x;
    facets.push_back({h.on & critical, outward});
  }
  // triangulate each facet
  std::vector<Edges> all;
  for (const Edges face : tile_faces_) all.push_back(face & critical);
  for (const HullFacet& facet : facets) all.push_back(facet.vertices);
  std::vector<LocalSimplex> result;
  for (const HullFacet& facet : facets) {
    LocalSimplex simplex{};
    pull(facet.vertices, tile_.dim - 1, all, 0, simplex, facet.outward, result);
  }
  return result;
}

/// Cones a face of dimension `dim` from its smallest vertex over those of its facets that do not contain it.
void HullContours::pull(Edges face, int dim, const std::vector<Edges>& all, int depth, LocalSimplex& simplex,
                        const Point& outward, std::vector<LocalSimplex>& result) const {
  const auto apex = static_cast<std::uint8_t>(std::countr_zero(face));
  simplex[depth] = apex;
  if (dim == 0) return emit(simplex, outward, result);
  std::vector<Edges> subfaces;
  for (const Edges other : all)
    if (const Edges common = face & other; common != face && std::popcount(common) >= dim) subfaces.push_back(common);
  std::sort(subfaces.begin(), subfaces.end());
  subfaces.erase(std::unique(subfaces.begin(), subfaces.end()), subfaces.end());
  for (const Edges sub : subfaces) {
    if (((sub >> apex) & 1u) != 0) continue;
    const bool maximal =
        std::none_of(subfaces.begin(), subfaces.end(), [sub](Edges o) { return o != sub && (sub & ~o) == 0; });
    if (maximal) pull(sub, dim - 1, all, depth + 1, simplex, outward, result);
  }
}

void HullContours::emit(LocalSimplex simplex, const Point& outward, std::vector<LocalSimplex>& result) const {
  const int n = tile_.dim;
  std::array<Point, 4> m{};
  for (int r = 1; r < n; ++r)
    for (int i = 0; i < 4; ++i) m[r - 1][i] = midpoints_[simplex[r]][i] - midpoints_[simplex[0]][i];
  m[n - 1] = outward;
  if (cofactor_determinant(m, static_cast<std::size_t>(n)) < 0) std::swap(simplex[n - 1], simplex[n - 2]);
  result.push_back(simplex);
}

}  // namespace tegl::gen
