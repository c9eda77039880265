// SPDX-License-Identifier: BSD-3-Clause
//
// Searches for the triangulation of a region of the cube's boundary, seen from the cube's centre, with own vertices on
// rays that always end in the region. One region of each orbit under the cube's isometries is triangulated.
#include "cubes/cube_tunnel.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/determinant.hpp"
#include "cubes/cube_embedding.hpp"
#include "cubes/surface_search.hpp"

namespace tegl::gen {

namespace {

using Ray = EmbeddingProof::Ray;

/// Determinant of three rays.
int determinant_of(const Ray& a, const Ray& b, const Ray& c) {
  const std::array<Ray, 3> rows = {a, b, c};
  return minor_of(rows, 0, 3, 7);
}

/// The polygon from its smallest edge on.
CubePolygon from_least(CubePolygon polygon) {
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  return polygon;
}

CubePolygon reversed(CubePolygon polygon) {
  std::reverse(polygon.begin(), polygon.end());
  return from_least(polygon);
}

/// The surface with its own vertices numbered in the order in which the triangles have them.
CubeSurface in_order(const CubeSurface& surface) {
  CubeSurface result{surface.triangles, {}};
  std::vector<std::uint8_t> old;
  for (CubeTriangle& t : result.triangles)
    for (std::uint8_t& v : t) {
      if (v < CubeFrame::kEdges) continue;
      const auto at = std::find(old.begin(), old.end(), v) - old.begin();
      if (at == std::ssize(old)) {
        old.push_back(v);
        result.masks.push_back(surface.masks[v - CubeFrame::kEdges]);
      }
      v = static_cast<std::uint8_t>(CubeFrame::kEdges + at);
    }
  return result;
}

void reverse(CubeTriangles& triangles) {
  for (CubeTriangle& t : triangles) std::swap(t[1], t[2]);
}

/// Which triangles a radial surface with given own vertices may have. Remembers what it computed.
class RadialTriangles {
 public:
  RadialTriangles(const CubeFrame& frame, const std::vector<std::uint32_t>& masks) : frame_(frame), masks_(masks) {
    for (const auto& ends : frame.cube().edges) ends_.push_back({ray_to_corner(ends[0]), ray_to_corner(ends[1])});
    for (const std::uint32_t mask : masks) ends_.push_back({ray_of(mask)});
  }

  /// Whether a triangle faces outwards and does not intersect the others, wherever its points are.
  [[nodiscard]] bool may_add(const CubeTriangle& t, const CubeTriangles& others) {
    std::int8_t& known = faces_outwards_[(t[0] * std::size_t{16} + t[1]) * 16 + t[2]];
    if (known == kUnknown) known = faces_outwards(t) ? 1 : 0;
    if (known == 0) return false;
    return embedding().may_add(t, others);
  }
  /// Made on request, as most choices of own vertices have no surface that faces outwards.
  [[nodiscard]] CubeEmbedding& embedding() {
    if (!embedding_) embedding_.emplace(frame_, masks_);
    return *embedding_;
  }

 private:
  /// The sign of a determinant, which is linear in each point, at the ends of the points' edges.
  [[nodiscard]] bool faces_outwards(const CubeTriangle& t) const {
    bool some = false;
    for (const Ray& a : ends_[t[0]])
      for (const Ray& b : ends_[t[1]])
        for (const Ray& c : ends_[t[2]]) {
          const int sign = determinant_of(a, b, c);
          if (sign < 0) return false;
          some = some || sign > 0;
        }
    return some;
  }

  const CubeFrame& frame_;
  const std::vector<std::uint32_t>& masks_;
  std::optional<CubeEmbedding> embedding_;
  std::vector<std::vector<Ray>> ends_;  ///< by vertex
  static constexpr std::int8_t kUnknown = -1;
  std::vector<std::int8_t> faces_outwards_ = std::vector<std::int8_t>(16 * 16 * 16, kUnknown);
};

/// Whether each own vertex is inside the surface, in one fan of triangles.
bool has_fans(const CubeTriangles& triangles, std::size_t own) {
  for (std::size_t v = CubeFrame::kEdges; v < CubeFrame::kEdges + own; ++v) {
    std::array<std::uint8_t, 16> next{};
    std::size_t count = 0;
    std::uint8_t first = 0;
    for (const CubeTriangle& t : triangles)
      for (std::size_t i = 0; i < 3; ++i)
        if (t[i] == v) next[first = t[(i + 1) % 3]] = t[(i + 2) % 3], ++count;
    std::size_t passed = 1;
    for (std::uint8_t at = next[first]; at != first && passed <= count; at = next[at]) ++passed;
    if (passed != count) return false;
  }
  return true;
}

}  // namespace

RadialFilling::RadialFilling(const CubeFrame& frame) : frame_(frame) {
  std::array<unsigned, 3> axes = {0, 1, 2};
  do {
    for (unsigned flips = 0; flips < 8; ++flips) {
      Isometry& map = isometries_.emplace_back();
      std::array<std::uint32_t, 8> images{};
      for (unsigned v = 0; v < 8; ++v) {
        for (unsigned a = 0; a < 3; ++a) images[v] |= ((v ^ flips) >> a & 1u) << axes[a];
        map.corner[v] = static_cast<std::uint8_t>(images[v]);
      }
      const std::vector<std::uint8_t> edges = edge_permutation(frame.cube(), images);
      std::copy(edges.begin(), edges.end(), map.edge.begin());
      // the images of three edges at a corner
      const auto along = [&](unsigned a) {
        Ray ray = ray_to_corner(map.corner[1u << a]);
        for (unsigned i = 0; i < 3; ++i) ray[i] -= ray_to_corner(map.corner[0])[i];
        return ray;
      };
      map.reverses = determinant_of(along(0), along(1), along(2)) < 0;
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
}

std::optional<CubeSurface> RadialFilling::fill(unsigned signature, const std::vector<CubePolygon>& polygons,
                                               bool is_high) {
  const Region region = region_of(signature, polygons, is_high);
  // the representative of its orbit
  const Isometry* to = nullptr;
  Region least;
  for (const Isometry& map : isometries_)
    if (Region image = image_of(region, map); to == nullptr || image < least) least = std::move(image), to = &map;
  const auto [at, is_new] = known_.try_emplace(least);
  if (is_new) at->second = search(least);
  if (!at->second) return std::nullopt;
  // back
  CubeSurface surface = *at->second;
  std::array<std::uint8_t, 16> vertex;
  std::iota(vertex.begin(), vertex.end(), std::uint8_t{0});
  for (std::uint8_t e = 0; e < CubeFrame::kEdges; ++e) vertex[to->edge[e]] = e;
  for (CubeTriangle& t : surface.triangles) t = {vertex[t[0]], vertex[t[1]], vertex[t[2]]};
  for (std::uint32_t& mask : surface.masks) {
    std::uint32_t before = 0;
    for (unsigned v = 0; v < 8; ++v) before |= (mask >> to->corner[v] & 1u) << v;
    mask = before;
  }
  if (to->reverses == is_high) reverse(surface.triangles);
  return in_order(surface);
}

/// The region has the corners of its sign that edges connect with its polygons.
RadialFilling::Region RadialFilling::region_of(unsigned signature, const std::vector<CubePolygon>& polygons,
                                               bool is_high) const {
  const unsigned inside = (is_high ? signature : ~signature) & 0xffu;
  Region region;
  for (const CubePolygon& polygon : polygons) {
    for (const std::uint8_t e : polygon)
      region.corners |= inside & (1u << frame_.cube().edges[e][0] | 1u << frame_.cube().edges[e][1]);
    region.polygons.push_back(is_high ? from_least(polygon) : reversed(polygon));
  }
  std::sort(region.polygons.begin(), region.polygons.end());
  for (unsigned before = 0; before != region.corners;) {
    before = region.corners;
    for (const auto& [a, b] : frame_.cube().edges)
      if ((inside >> a & inside >> b & (before >> a | before >> b) & 1u) != 0) region.corners |= 1u << a | 1u << b;
  }
  return region;
}

RadialFilling::Region RadialFilling::image_of(const Region& region, const Isometry& map) {
  Region image;
  for (unsigned v = 0; v < 8; ++v) image.corners |= (region.corners >> v & 1u) << map.corner[v];
  for (const CubePolygon& polygon : region.polygons) {
    CubePolygon& mapped = image.polygons.emplace_back();
    for (const std::uint8_t e : polygon) mapped.push_back(map.edge[e]);
    mapped = map.reverses ? reversed(mapped) : from_least(mapped);
  }
  std::sort(image.polygons.begin(), image.polygons.end());
  return image;
}

/// True if the mean of the corners of a face of the cube is in the region wherever the points on edges are.
bool RadialFilling::always_contains(const Region& region, unsigned corners) const {
  const unsigned outside = corners & ~region.corners;
  if (outside == 0) return true;
  if (std::popcount(corners) != 4) return false;
  if (std::popcount(outside) == 1) return true;
  if (std::popcount(outside) != 2) return false;
  // An ambiguous square, each of whose outer corners must be cut off by a segment, or two adjacent corners.
  for (unsigned v = 0; v < 8; ++v) {
    if ((outside >> v & 1u) == 0) continue;
    std::vector<std::uint8_t> edges;
    for (std::uint8_t e = 0; e < CubeFrame::kEdges; ++e) {
      const auto& [a, b] = frame_.cube().edges[e];
      if ((a == v || b == v) && (corners >> a & corners >> b & 1u) != 0) edges.push_back(e);
    }
    const bool is_cut_off =
        std::any_of(region.polygons.begin(), region.polygons.end(), [&](const CubePolygon& polygon) {
          const auto first = std::find(polygon.begin(), polygon.end(), edges[0]);
          if (first == polygon.end()) return false;
          const auto at = static_cast<std::size_t>(first - polygon.begin()), n = polygon.size();
          return polygon[(at + 1) % n] == edges[1] || polygon[(at + n - 1) % n] == edges[1];
        });
    if (!is_cut_off) return false;
  }
  return true;
}

/// The masks of the squares, edges and corners whose means are always in the region.
std::vector<std::uint32_t> RadialFilling::masks_in(const Region& region) const {
  std::vector<std::uint32_t> masks;
  const auto add = [&](unsigned corners) {
    if (always_contains(region, corners)) masks.push_back(corners);
  };
  for (const auto& square : frame_.squares) add(1u << square[0] | 1u << square[1] | 1u << square[2] | 1u << square[3]);
  for (const auto& [a, b] : frame_.cube().edges) add(1u << a | 1u << b);
  for (unsigned v = 0; v < 8; ++v) add(1u << v);
  return masks;
}

std::optional<CubeSurface> RadialFilling::search(const Region& region) const {
  const std::vector<std::uint32_t> masks = masks_in(region);
  const bool is_disc = region.polygons.size() == 1;
  std::optional<CubeSurface> best;
  double best_cost = SurfaceSearch::kAny;
  std::vector<std::uint32_t> chosen;
  const auto try_chosen = [&] {
    RadialTriangles radial(frame_, chosen);
    std::vector<SurfaceSearch::Point> own;
    for (const std::uint32_t mask : chosen) {
      const Ray ray = ray_of(mask);
      own.push_back({0.5 * ray[0], 0.5 * ray[1], 0.5 * ray[2]});
    }
    SurfaceSearch search(frame_, region.polygons, own);
    search.may_add = [&](const CubeTriangle& t, const CubeTriangles& others) { return radial.may_add(t, others); };
    search.accepts = [&](const CubeTriangles& all) {
      return has_fans(all, chosen.size()) && radial.embedding().is_embedded(all);
    };
    if (auto found = search.run(best_cost)) {
      best = {std::move(*found), chosen};
      best_cost = search.cost();
    }
  };
  const auto choose = [&](const auto& self, std::size_t count, std::size_t from) -> void {
    if (chosen.size() == count) return try_chosen();
    for (std::size_t i = from; i < masks.size(); ++i) {
      chosen.push_back(masks[i]);
      self(self, count, i + 1);
      chosen.pop_back();
    }
  };
  for (std::size_t count = is_disc ? 1 : 3; count <= (is_disc ? 1u : 4u) && !best; ++count) choose(choose, count, 0);
  return best;
}

}  // namespace tegl::gen
