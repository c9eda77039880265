// SPDX-License-Identifier: BSD-3-Clause
//
// Positions of a built tile's vertices, in the unit tile, so that they do not depend on the units of the axes.
//
// Based on: M. Liversage, thesis, 1994, definition 10.1.4: the barycentre of a facet is the mean of the barycentres of
// the facets around it, weighted by their measure. A position depends only on the face that contains the vertex: the
// frame of a tile adds exact zeros to it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "tile/built_tiles.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

/// Six times the volume of a tetrahedron, from the Gram determinant.
template <std::size_t N>
double tetrahedron_volume(std::span<const std::array<double, N>> points) noexcept {
  std::array<std::array<double, N>, 3> edges;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < N; ++a) edges[i][a] = points[i + 1][a] - points[0][a];
  const auto dot = [&](std::size_t i, std::size_t j) {
    double sum = 0;
    for (std::size_t a = 0; a < N; ++a) sum += edges[i][a] * edges[j][a];
    return sum;
  };
  const double uu = dot(0, 0), uv = dot(0, 1), uw = dot(0, 2), vv = dot(1, 1), vw = dot(1, 2), ww = dot(2, 2);
  const double gram = uu * (vv * ww - vw * vw) - uv * (uv * ww - vw * uw) + uw * (uv * vw - vv * uw);
  return std::sqrt(std::max(0.0, gram));
}

/// Measure of a simplex of 1 to 4 points, up to a factor that depends on its dimension only.
template <std::size_t N>
double simplex_measure(std::span<const std::array<double, N>> points) noexcept {
  static_assert(N <= 5, "larger simplices in more dimensions");
  switch (points.size()) {
    case 1:
      return 1.0;
    case 2:
      return distance(points[0], points[1]);
    case 3:
      return triangle_area(points[0], points[1], points[2]);
    default:
      return tetrahedron_volume(points);
  }
}

/// Barycentre (as defined above) of a facet that is a single simplex.
template <std::size_t N>
std::array<double, N> simplex_barycentre(std::span<const std::array<double, N>> points) noexcept {
  if (points.size() == 1) return points[0];
  if (points.size() == 2) return midpoint<static_cast<int>(N)>(points[0], points[1]);
  Weighted<static_cast<int>(N)> sum;
  for (std::size_t omitted = 0; omitted < points.size(); ++omitted) {
    std::array<std::array<double, N>, N> rest;
    for (std::size_t i = 0, j = 0; i < points.size(); ++i)
      if (i != omitted) rest[j++] = points[i];
    const std::span<const std::array<double, N>> face(rest.data(), points.size() - 1);
    sum.add(simplex_barycentre<N>(face), simplex_measure<N>(face));
  }
  if (!(sum.weight > 0)) return points[0];
  for (double& x : sum.point) x /= sum.weight;
  return sum.point;
}

/// Levels of the contour on rays inside the faces of a tile, by the number of the face in the lattice.
class TileRays {
 public:
  /// In a cube (CubeHeights).
  [[nodiscard]] virtual double level(std::size_t face, std::uint32_t corners) const noexcept = 0;
  /// In a face of four or five dimensions (TileHeights).
  [[nodiscard]] virtual double level(std::size_t face, const TilePoint<4>& end) const noexcept = 0;
  [[nodiscard]] virtual double level(std::size_t face, const TilePoint<5>& end) const noexcept = 0;

 protected:
  ~TileRays() = default;
};

/// Computes positions on request, for one tile at a time.
template <int N>
class TilePlaces {
 public:
  using Point = TilePoint<N>;

  TilePlaces(const CubeFaces& cube, const CubeSymmetries& symmetries) : cube_(cube), symmetries_(symmetries) {}
  /// `flat_axis`: axis along which all positions are 0; -1: none. Positions on edges must be set by `set_edge`.
  /// `rays` must live until the next tile.
  void begin(const SeenTile& seen, int flat_axis, const TileRays& rays) {
    tile_ = seen.tile.get();
    rays_ = &rays;
    symmetry_ = seen.symmetry;
    flat_axis_ = flat_axis;
    const BuiltTile& tile = *tile_;
    points_.resize(tile.vertices.size());
    known_.assign(tile.vertices.size(), false);
  }
  void set_edge(std::size_t v, double alpha) noexcept {
    const CubeFace& edge = cube_.cells()[tile_->vertices[v].face];
    const unsigned axes = symmetries_.axes(symmetry_, edge.axes);
    points_[v] = corner_point<N>(symmetries_.base(symmetry_, edge.base, axes));
    points_[v][std::countr_zero(axes)] = alpha;
    known_[v] = true;
  }

  const Point& operator()(std::size_t v) noexcept {
    if (!known_[v]) {
      points_[v] = find(tile_->vertices[v]);
      known_[v] = true;
    }
    return points_[v];
  }

 private:
  Point find(const BuiltTile::Vertex& vertex) noexcept {
    switch (vertex.kind) {
      case tile::VertexKind::barycentre:
        return barycentre(vertex);
      case tile::VertexKind::centre:
        return vertex.first == vertex.end ? beside(vertex) : mean(vertex);
      case tile::VertexKind::side:
        if (vertex.copied != BuiltTile::kNone) return pushed_inwards(vertex);
        return is_on_ray(vertex) ? on_ray(vertex) : mean_of_points(vertex);
      default:
        return corner_point<N>(cube_.cells()[vertex.face].base);
    }
  }

  /// Insertion sort: for so few points, std::sort has code that cannot be reached, of which compilers warn.
  static void sort_few(Point* points, std::size_t count) noexcept {
    for (std::size_t i = 1; i < count; ++i)
      for (std::size_t j = i; j > 0 && points[j] < points[j - 1]; --j) std::swap(points[j], points[j - 1]);
  }

  Point barycentre(const BuiltTile::Vertex& vertex) noexcept {
    const std::size_t width = cube_.cells()[vertex.face].dim - 1u;
    // Tiles that share a face list its simplices in different orders, so they are sorted. For N <= 4 the tile itself is
    // sorted as well, to agree with 5D tiles that have it as a face.
    const bool is_shared = N <= 4 || vertex.face != cube_.tile();
    // Recursion: barycentres still being computed have terms before these.
    const auto first_term = static_cast<std::ptrdiff_t>(terms_.size());
    std::array<Point, N> corners;
    const std::span<const Point> simplex(corners.data(), width);
    for (std::size_t at = vertex.first; at < vertex.end; at += width) {
      const bool has_middle = (tile_->of[at] & BuiltTile::kIsMiddle) != 0;
      for (std::size_t j = 0; j < width; ++j)
        corners[j] = (*this)(tile_->of[at + j] & static_cast<std::uint16_t>(~BuiltTile::kIsMiddle));
      const Point middle = corners[0];
      if (is_shared || !has_middle) sort_few(corners.data(), width);
      terms_.push_back({has_middle ? middle : simplex_barycentre<N>(simplex), simplex_measure<N>(simplex)});
    }
    if (is_shared)
      std::sort(terms_.begin() + first_term, terms_.end(), [](const Weighted<N>& a, const Weighted<N>& b) {
        return a.point != b.point ? a.point < b.point : a.weight < b.weight;
      });
    Weighted<N> sum;
    Weighted<N> plain;  // equal weights, for a facet shrunk to a point
    for (auto term = terms_.begin() + first_term; term != terms_.end(); ++term) {
      sum.add(term->point, term->weight);
      plain.add(term->point, 1.0);
    }
    terms_.erase(terms_.begin() + first_term, terms_.end());
    return divided(sum.weight > 0 ? sum : plain);
  }

  Point mean(const BuiltTile::Vertex& vertex) noexcept {
    Weighted<N> sum;
    for (std::size_t at = vertex.first; at < vertex.end; ++at) sum.add((*this)(tile_->of[at]), 1.0);
    return divided(sum);
  }

  /// Whether it belongs to a cube and depends on corners, with their numbers in the cube (cube_own_place).
  [[nodiscard]] bool is_on_ray(const BuiltTile::Vertex& vertex) const noexcept {
    return cube_.cells()[vertex.face].dim == 3 && vertex.first != vertex.end && tile_->of[vertex.first + 1] < 8;
  }
  Point on_ray(const BuiltTile::Vertex& vertex) const noexcept {
    std::uint32_t corners = 0;
    for (std::size_t at = vertex.first; at < vertex.end; at += 2) corners |= 1u << tile_->of[at + 1];
    const TilePoint<3> inside = ray_place(corners, rays_->level(vertex.face, corners));
    const CubeFace& face = cube_.cells()[vertex.face];
    Point point = corner_point<N>(face.base);
    for (int a = 0, own_axis = 0; a < N; ++a)
      if ((face.axes >> a & 1u) != 0) point[a] = inside[own_axis++];
    return point;
  }

  /// As own_place and mask_place of 4D tiles (extract_tables.hpp), in the frame of the vertex's face: a layer of
  /// a 5D contour equals the contour of the 4D image, bit by bit.
  Point mean_of_points(const BuiltTile::Vertex& vertex) noexcept {
    Weighted<N> sum;
    bool has_corners = false, has_edges = false;
    for (std::size_t at = vertex.first; at < vertex.end; at += 2)
      (tile_->vertices[tile_->of[at]].kind == tile::VertexKind::corner ? has_corners : has_edges) = true;
    const bool is_even = vertex.is_even || !has_edges;
    for (std::size_t at = vertex.first; at < vertex.end; at += 2)
      sum.add((*this)(tile_->of[at]), is_even ? 1.0 : uneven_weight(tile_->of[at + 1]));
    const Point mean = divided(sum);
    const double level = has_corners ? level_towards(mean, vertex.face) : 0.0;
    const CubeFace& face = cube_.cells()[vertex.face];
    Point point = corner_point<N>(face.base);
    int own_axis = 0;
    for (int a = 0; a < N; ++a) {
      if ((face.axes >> a & 1u) == 0) continue;
      point[a] = has_corners ? ray_coordinate(mean[a], level) : own_coordinate(mean[a], own_axis, !vertex.is_even);
      ++own_axis;
      for (unsigned repeat = 0; repeat < vertex.repeats; ++repeat) point[a] = repeated_coordinate(point[a]);
    }
    return point;
  }

  /// Level of the ray from the centre of a face of four or five dimensions to a point in it.
  [[nodiscard]] double level_towards(const Point& end, std::size_t face) const noexcept {
    const CubeFace& cell = cube_.cells()[face];
    if (cell.dim == 5) return rays_->level(face, in_frame<5>(end, cell.axes));
    return cell.dim == 4 ? rays_->level(face, in_frame<4>(end, cell.axes)) : 0.5;
  }
  template <int K>
  static TilePoint<K> in_frame(const Point& point, unsigned axes) noexcept {
    TilePoint<K> result{};
    for (int a = 0, own_axis = 0; a < N; ++a)
      if ((axes >> a & 1u) != 0) result[own_axis++] = point[a];
    return result;
  }

  /// Midpoint of a vertex and the contour's copy of it.
  Point beside(const BuiltTile::Vertex& vertex) noexcept {
    return midpoint<N>((*this)(vertex.copied), pushed_inwards(vertex));
  }

  /// On the ray from the centre of the face to the copied vertex; half way, unless that is a corner.
  Point pushed_inwards(const BuiltTile::Vertex& vertex) noexcept {
    Point point = (*this)(vertex.copied);
    const bool is_corner = tile_->vertices[vertex.copied].kind == tile::VertexKind::corner;
    const double level = is_corner ? level_towards(point, vertex.face) : 0.5;
    for (int a = 0; a < N; ++a)
      if (a != flat_axis_ && (cube_.cells()[vertex.face].axes >> a & 1u) != 0)
        point[a] = ray_coordinate(point[a], level);
    return point;
  }

  static Point divided(const Weighted<N>& sum) noexcept {
    Point point;
    for (int a = 0; a < N; ++a) point[a] = sum.point[a] / sum.weight;
    return point;
  }

  CubeFaces cube_;
  const CubeSymmetries& symmetries_;
  const BuiltTile* tile_ = nullptr;
  const TileRays* rays_ = nullptr;
  CubeSymmetry symmetry_;
  int flat_axis_ = -1;
  std::vector<Point> points_;
  std::vector<bool> known_;
  std::vector<Weighted<N>> terms_;
};

}  // namespace tegl::detail
