// SPDX-License-Identifier: BSD-3-Clause
//
// Access to the generated tables: simplices of a signature in either layout, and positions of the vertices that a cell
// owns (table contract: "Positions").
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>

#include "tegl/table_contract.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

/// The simplices of one signature of a k-tile.
template <int K>
class SimplexList {
 public:
  [[gnu::always_inline]] SimplexList(const tables::TileTable& table, unsigned signature) noexcept
      : list_(&table.lists[table.list_of[signature]]),
        simplices_(table.simplices + std::size_t{list_->first_simplex} * K),
        side_masks_(table.side_masks + list_->first_side) {
    if (table.element_of != nullptr) {
      const std::uint16_t element = table.element_of[signature];
      permutation_ = table.permutations + std::size_t{element} * table.permutation_stride;
      reversed_ = table.reverses[element] != 0;
      if constexpr (K == 4) swaps_ = table.slot_swaps[signature];
    }
  }
  [[nodiscard]] const tables::List& list() const noexcept { return *list_; }
  [[nodiscard]] unsigned size() const noexcept { return list_->simplex_count; }
  [[nodiscard]] unsigned own_vertices() const noexcept { return list_->cone_vertices + unsigned{list_->side_vertices}; }
  [[nodiscard]] bool reversed() const noexcept { return reversed_; }
  /// Whether the table has the class layout, in which stored vertices are those of the representative.
  [[nodiscard]] bool is_permuted() const noexcept { return permutation_ != nullptr; }

  /// Vertex j of simplex q, as stored. Vertices from first_tile_vertex(K) on need no mapping.
  [[nodiscard]] unsigned stored(unsigned q, unsigned j) const noexcept { return simplices_[q * K + j]; }
  /// Maps a stored vertex to the frame of the signature.
  [[nodiscard]] unsigned mapped(unsigned v) const noexcept {
    if (permutation_ == nullptr || v >= tables::first_tile_vertex(K)) return v;
    v = permutation_[(1u << K) + v];
    if constexpr (K == 4) {
      static_assert(tables::kFaceSlots == 2);
      if (v >= tables::edge_count(K)) v ^= swaps_ >> ((v - tables::edge_count(K)) / 2) & 1u;
    }
    return v;
  }
  /// Maps a stored corner to the frame of the signature.
  [[nodiscard]] unsigned mapped_corner(unsigned v) const noexcept {
    return permutation_ == nullptr ? v : permutation_[v];
  }
  /// Mask of side vertex j, as stored: bit v for a corner, bit 2^K + e for an edge.
  [[nodiscard]] std::uint64_t side_mask(unsigned j) const noexcept { return side_masks_[j]; }

 private:
  const tables::List* list_;
  const std::uint8_t* simplices_;
  const std::uint64_t* side_masks_;
  const std::uint8_t* permutation_ = nullptr;
  unsigned swaps_ = 0;
  bool reversed_ = false;
};

/// A point in the frame of a k-tile, in [0, 1]^k.
template <int K>
using TilePoint = std::array<double, K>;

template <int K>
constexpr TilePoint<K> corner_point(unsigned corner) noexcept {
  TilePoint<K> point{};
  for (int a = 0; a < K; ++a) point[a] = static_cast<double>(corner >> a & 1u);
  return point;
}

/// Base corners of a k-tile's edges.
template <int K>
inline constexpr auto kEdgeBases = [] {
  std::array<TilePoint<K>, tables::edge_count(K)> result{};
  for (unsigned e = 0; e < result.size(); ++e) result[e] = corner_point<K>(edge_base(K, e));
  return result;
}();

template <int K>
[[gnu::always_inline]] inline TilePoint<K> edge_point(unsigned edge, double alpha) noexcept {
  TilePoint<K> point = kEdgeBases<K>[edge];
  point[edge >> (K - 1)] = alpha;
  return point;
}

/// Same result as edge_point, without a store to a variable index, which would delay loading the whole point.
template <int K>
[[gnu::always_inline]] inline TilePoint<K> edge_point_at_once(unsigned edge, double alpha) noexcept {
  static constexpr auto kUnits = [] {
    std::array<TilePoint<K>, K> units{};
    for (std::size_t a = 0; a < K; ++a) units[a][a] = 1.0;
    return units;
  }();
  TilePoint<K> point = kEdgeBases<K>[edge];
  for (std::size_t a = 0; a < K; ++a) point[a] += alpha * kUnits[edge >> (K - 1)][a];
  return point;
}

/// Maps a point of the 3-face `cube` to the frame of its 4-tile.
inline TilePoint<4> cube_point(unsigned cube, const TilePoint<3>& inside) noexcept {
  TilePoint<4> point;
  for (unsigned a = 0, j = 0; a < 4; ++a) point[a] = a == cube / 2 ? static_cast<double>(cube % 2) : inside[j++];
  return point;
}

// The functions below are forced inline, like their callers: compilers otherwise leave calls in the innermost loops,
// which halves the speed.

template <std::size_t K>
[[gnu::always_inline]] inline double distance(const std::array<double, K>& p, const std::array<double, K>& q) noexcept {
  double sum = 0;
  for (std::size_t a = 0; a < K; ++a) sum += (q[a] - p[a]) * (q[a] - p[a]);
  return std::sqrt(sum);
}

/// A point with a weight: barycentre and measure of a part of a facet.
template <int K>
struct Weighted {
  TilePoint<K> point{};
  double weight = 0;

  [[gnu::always_inline]] void add(const TilePoint<K>& p, double w) noexcept {
    for (int a = 0; a < K; ++a) point[a] += w * p[a];
    weight += w;
  }
};

/// Area of a triangle from the Gram determinant.
template <std::size_t K>
[[gnu::always_inline]] inline double triangle_area(const std::array<double, K>& p, const std::array<double, K>& q,
                                                   const std::array<double, K>& r) noexcept {
  double uu = 0, uv = 0, vv = 0;
  for (std::size_t a = 0; a < K; ++a) {
    const double u = q[a] - p[a];
    const double v = r[a] - p[a];
    uu += u * u;
    uv += u * v;
    vv += v * v;
  }
  return 0.5 * std::sqrt(std::max(0.0, uu * vv - uv * uv));
}

template <int K>
[[gnu::always_inline]] inline TilePoint<K> midpoint(const TilePoint<K>& p, const TilePoint<K>& q) noexcept {
  TilePoint<K> point;
  for (int a = 0; a < K; ++a) point[a] = 0.5 * (p[a] + q[a]);
  return point;
}

/// Measure and barycentre of a cone's face opposite to the apex (table contract: "Positions"). `barycentred`: its first
/// vertex is a cube's barycentre.
template <int K>
[[gnu::always_inline]] inline Weighted<K> opposite_face(const std::array<TilePoint<K>, K - 1>& face,
                                                        bool barycentred) noexcept {
  if constexpr (K == 2) return {face[0], 1.0};
  if constexpr (K == 3) return {midpoint<3>(face[0], face[1]), distance(face[0], face[1])};
  if constexpr (K == 4) {
    const double area = triangle_area(face[0], face[1], face[2]);
    if (barycentred) return {face[0], area};
    Weighted<4> outline;
    for (unsigned i = 0; i < 3; ++i) {
      const auto& p = face[i];
      const auto& q = face[(i + 1) % 3];
      outline.add(midpoint<4>(p, q), distance(p, q));
    }
    if (!(outline.weight > 0)) return {face[0], area};
    for (double& x : outline.point) x /= outline.weight;
    return {outline.point, area};
  }
}

/// Sum of the faces opposite to `apex` in its cone, weighted by their measure or, if `plain`, equally.
template <int K, class Place>
[[gnu::always_inline]] inline Weighted<K> cone_sum(const SimplexList<K>& list, unsigned apex, bool plain,
                                                   const Place& place) noexcept {
  Weighted<K> sum;
  for (unsigned q = 0; q < list.size(); ++q) {
    if (list.stored(q, 0) != apex) continue;
    std::array<TilePoint<K>, K - 1> face;
    for (unsigned j = 1; j < K; ++j) face[j - 1] = place(list.stored(q, j));
    const Weighted<K> part = opposite_face<K>(face, list.stored(q, 1) >= tables::edge_count(K));
    sum.add(part.point, plain ? 1.0 : part.weight);
  }
  return sum;
}

/// Barycentre of the facet that is the cone from `apex`.
template <int K, class Place>
TilePoint<K> cone_place(const SimplexList<K>& list, unsigned apex, const Place& place) noexcept {
  Weighted<K> sum = cone_sum(list, apex, false, place);
  if (!(sum.weight > 0)) sum = cone_sum(list, apex, true, place);  // a facet shrunk to a point
  for (double& x : sum.point) x /= sum.weight;
  return sum.point;
}

/// Mean of the vertices that `apex` is coned to, used by the compact triangulation.
template <int K, class Place>
TilePoint<K> mean_place(const SimplexList<K>& list, unsigned apex, const Place& place) noexcept {
  static_assert(tables::edge_count(K) <= 64);
  std::uint64_t points = 0;
  for (unsigned q = 0; q < list.size(); ++q)
    if (list.stored(q, 0) == apex)
      for (unsigned j = 1; j < K; ++j) points |= std::uint64_t{1} << list.stored(q, j);
  Weighted<K> sum;
  for (; points != 0; points &= points - 1) sum.add(place(static_cast<unsigned>(std::countr_zero(points))), 1.0);
  for (double& x : sum.point) x /= sum.weight;
  return sum.point;
}

/// Corners of a k-tile.
template <int K>
inline constexpr auto kCornerPoints = [] {
  std::array<TilePoint<K>, std::size_t{1} << K> result{};
  for (unsigned v = 0; v < result.size(); ++v) result[v] = corner_point<K>(v);
  return result;
}();

/// Weight of point number v of an uneven mean (mask_place).
constexpr double uneven_weight(unsigned v) noexcept { return 1.0 + 0.01 * v; }

/// One coordinate of an own vertex without corners, from the mean of its points (mask_place). `axis`: number in the
/// vertex's face.
[[gnu::always_inline]] inline double own_coordinate(double mean, int axis, bool uneven) noexcept {
  return uneven ? 0.1 * (0.487 + 0.01 * axis) + 0.9 * mean : mean;
}

/// One coordinate of a vertex on the ray from a face's centre to `end`. Exact for corners and levels of TileHeights.
[[gnu::always_inline]] inline double ray_coordinate(double end, double level) noexcept {
  return 0.5 + level * (end - 0.5);
}

/// One coordinate of the next of several own vertices that have the same points: nearer to the face's centre.
[[gnu::always_inline]] inline double repeated_coordinate(double x) noexcept { return x + 0.0625 * (0.5 - x); }

/// Weights of mask_place, by bit of the mask.
inline constexpr auto kUnevenWeights = [] {
  std::array<double, 64> result{};
  for (unsigned v = 0; v < result.size(); ++v) result[v] = uneven_weight(v);
  return result;
}();

/// The level of rays of tiles without samples: half way.
struct NoRays {
  template <class End>
  double operator()(const End&) const noexcept {
    return 0.5;
  }
};

/// Mean of the points of a mask, with slightly unequal weights if `uneven` and not all are corners (mask_place).
template <int K, class Corner, class Place>
TilePoint<K> mask_mean(std::uint64_t mask, const Corner& corner, const Place& place, bool uneven) noexcept {
  constexpr unsigned kCorners = 1u << K;
  const bool has_uneven = uneven && mask >> kCorners != 0;
  const auto weight = [has_uneven](unsigned v) { return has_uneven ? kUnevenWeights[v] : 1.0; };
  Weighted<K> sum;
  for (std::uint64_t rest = mask & ((std::uint64_t{1} << kCorners) - 1); rest != 0; rest &= rest - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(rest));
    sum.add(kCornerPoints<K>[corner(v)], weight(v));
  }
  for (std::uint64_t rest = mask >> kCorners; rest != 0; rest &= rest - 1) {
    const auto e = static_cast<unsigned>(std::countr_zero(rest));
    sum.add(place(e), weight(kCorners + e));
  }
  TilePoint<K> point;
  for (int a = 0; a < K; ++a) point[a] = sum.point[a] / sum.weight;
  return point;
}

/// Position of an own vertex from its mask (bit v: corner v, bit 2^K + e: edge e). With edges only, it is their mean;
/// with corners, on the ray from the tile's centre to the mean of all, as copies of a side must be. `corner(v)`: maps a
/// corner to the current frame. `rays(end)`: level of a ray (TileHeights).
///
/// `uneven`: slightly unequal weights, unless all points are corners: the mean of a cube's corners is its centre, on
/// the rays of its own vertices. If samples have few different values, as masks have, vertices on edges take few
/// positions. The mean could then lie on the line through two of them, and a triangle would have zero area. The vertex
/// is also moved towards the centre, as all edges may lie in one face of the tile, which must contain only the face's
/// own vertices.
template <int K, class Corner, class Place, class Rays>
TilePoint<K> mask_place(std::uint64_t mask, const Corner& corner, const Place& place, bool uneven,
                        Rays&& rays) noexcept {
  constexpr unsigned kCorners = 1u << K;
  if ((mask & (mask - 1)) == 0 && mask >> kCorners == 0) {  // one corner: the most frequent copies
    TilePoint<K> point = kCornerPoints<K>[corner(static_cast<unsigned>(std::countr_zero(mask)))];
    const double level = rays(point);
    for (double& x : point) x = ray_coordinate(x, level);
    return point;
  }
  TilePoint<K> point = mask_mean<K>(mask, corner, place, uneven);
  if ((mask & ((std::uint64_t{1} << kCorners) - 1)) != 0) {
    const double level = rays(point);
    for (double& x : point) x = ray_coordinate(x, level);
  } else {
    for (int a = 0; a < K; ++a) point[a] = own_coordinate(point[a], a, uneven);
  }
  return point;
}

/// Whether a vertex of a cube with this mask lies on a ray (tables::ResolvedList): it has corners.
constexpr bool is_on_ray(std::uint64_t mask) noexcept { return (mask & 0xffu) != 0; }

/// Position of a cube's own vertex on the ray from the cube's centre to the mean of `corners`. `level`: from
/// CubeHeights. Every vertex of a tunnel is here, in images of all dimensions.
inline TilePoint<3> ray_place(std::uint32_t corners, double level) noexcept {
  std::uint32_t all = 7, some = 0;  // axes along which all corners, and any corner, are at 1
  for (; corners != 0; corners &= corners - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(corners));
    all &= v;
    some |= v;
  }
  TilePoint<3> point;
  for (unsigned a = 0; a < 3; ++a)
    point[a] = 0.5 + 0.5 * level * (static_cast<double>(all >> a & 1u) + static_cast<double>(some >> a & 1u) - 1.0);
  return point;
}

/// Position of a cube's own vertex from its mask, as mask_place, except for vertices on rays. `rays(corners)`: level of
/// a ray.
template <class Place, class Rays>
TilePoint<3> cube_own_place(std::uint32_t mask, const Place& place, Rays&& rays) noexcept {
  if (is_on_ray(mask)) return ray_place(mask, rays(mask));
  return mask_place<3>(mask, std::identity(), place, true, NoRays());
}

/// Positions of a tile's cone vertices and side vertices in the unit tile, so that they do not depend on the units of
/// the axes. `place(v)`: position of the stored vertex v < first_tile_vertex(K), in the frame of the signature. `out`:
/// list.own_vertices() points. `rays`: as for cube_own_place or, if K = 4, mask_place.
///
/// Tiles of a 3D image and cubes of a 4D image use the same function. Their barycentres agree bit by bit, so a 4D
/// contour contains the 3D contours of its time steps.
template <int K, class Place, class Rays = NoRays>
void own_places(const SimplexList<K>& list, [[maybe_unused]] bool compact, const Place& place, TilePoint<K>* out,
                [[maybe_unused]] Rays&& rays = {}) noexcept {
  const unsigned cones = list.list().cone_vertices;
  for (unsigned j = 0; j < cones; ++j) {
    const unsigned apex = tables::first_tile_vertex(K) + j;
    if constexpr (K == 4) {
      out[j] = compact ? mean_place(list, apex, place) : cone_place(list, apex, place);
    } else {
      out[j] = cone_place(list, apex, place);  // compact polygons have no barycentres
    }
  }
  const auto corner = [&](unsigned v) { return list.mapped_corner(v); };
  for (unsigned j = 0; j < list.list().side_vertices; ++j)
    if constexpr (K == 3)  // cubes have side vertices only if they are resolved from the data
      out[cones + j] = cube_own_place(static_cast<std::uint32_t>(list.side_mask(j)), place, rays);
    else
      out[cones + j] = mask_place<K>(list.side_mask(j), corner, place, false, rays);
}

}  // namespace tegl::detail
