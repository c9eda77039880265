// SPDX-License-Identifier: BSD-3-Clause
//
// Whether any two simplices of a small contour intersect outside of their common face, exactly for the stored
// coordinates: all pairs, many times faster than find_intersections on contours of single cells.
//
// The side of each vertex at the hyperplane of each simplex is computed once, as bits, with bounds of all rounding
// errors. Let C be the common vertices of two simplices, A and B the others. If a hyperplane contains C and has A on or
// above it and B strictly below it, a common point of the simplices has no weight on B, so it lies in the hull of C.
// The hyperplanes of the two simplices are tried first, then all that contain C, 64 at a time. PairTest decides the
// other pairs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "intersect/pair_test.hpp"
#include "tegl/contour.hpp"

namespace tegl::bench {

/// One object per thread.
template <int N>
class TilePairs {
 public:
  static constexpr std::size_t kMostVertices = 64;

  /// False if two simplices intersect, one is flat, or there are too many vertices.
  [[nodiscard]] bool is_embedded(const Contour<N, double>& contour) {
    if (contour.vertices.size() > kMostVertices) return false;
    const detail::SimplexPlanes<N> planes(contour.vertices, contour.simplices, 1, {});
    const auto count = static_cast<Index>(planes.size());
    for (Index s = 0; s < count; ++s)
      if (planes.is_flat(s)) return false;
    find_sides(planes);
    detail::PairTest<N> test(planes);
    for (Index s = 0; s < count; ++s) {
      bool is_loaded = false;
      for (Index t = 0; t < s; ++t) {
        const bool has_same_vertices = planes_[s].on == planes_[t].on;
        if (!has_same_vertices && (own_planes_separate(planes_[s], planes_[t]) ||
                                   is_separated(planes.simplex(s), planes.simplex(t), planes_[s].on & planes_[t].on)))
          continue;
        if (!is_loaded) test.load(s);
        is_loaded = true;
        detail::PointN<N> place;
        if (test.meets(t, place)) return false;
      }
    }
    return true;
  }

 private:
  using Simplex = std::array<Index, N>;
  using Bits = std::uint64_t;
  static constexpr std::size_t kBits = 64;
  /// The vertices (in planes_) of a simplex, or the hyperplanes (in sides_) of a vertex's simplices; those that are
  /// strictly above and below, as seen from the hyperplane.
  struct Sides {
    Bits on = 0, above = 0, below = 0;
  };
  /// Hyperplanes with a common property of all vertices that were added.
  struct Common {
    Bits above = ~Bits{0}, not_below = ~Bits{0}, below = ~Bits{0}, not_above = ~Bits{0};
    void add(const Sides& sides) noexcept {
      above &= sides.above;
      not_below &= sides.above | sides.on;
      below &= sides.below;
      not_above &= sides.below | sides.on;
    }
  };

  void find_sides(const detail::SimplexPlanes<N>& planes) {
    const std::size_t count = planes.size(), vertices = planes.point_count();
    words_ = (count + kBits - 1) / kBits;
    planes_.assign(count, {});
    sides_.assign(vertices * words_, {});
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t v = 0; v < vertices; ++v) columns_[a][v] = planes.point(static_cast<Index>(v))[a];
    for (std::size_t s = 0; s < count; ++s) {
      Sides& sides = planes_[s];
      for (const Index v : planes.simplex(static_cast<Index>(s))) sides.on |= Bits{1} << v;
      find_sides_of(planes, static_cast<Index>(s), vertices, sides);
      for (std::size_t v = 0; v < vertices; ++v) {
        Sides& of_vertex = sides_[v * words_ + s / kBits];
        of_vertex.on |= (sides.on >> v & 1u) << s % kBits;
        of_vertex.above |= (sides.above >> v & 1u) << s % kBits;
        of_vertex.below |= (sides.below >> v & 1u) << s % kBits;
      }
    }
  }
  /// As SimplexPlane::side, for all vertices that are not on the simplex.
  void find_sides_of(const detail::SimplexPlanes<N>& planes, Index s, std::size_t vertices,
                     Sides& sides) const noexcept {
    const detail::SimplexPlane<N>& plane = planes.plane(s);
    const detail::PointN<N>& corner = planes.point(planes.simplex(s)[0]);
    std::array<double, kMostVertices> heights, sizes;
    for (std::size_t v = 0; v < vertices; ++v) heights[v] = sizes[v] = 0.0;
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t v = 0; v < vertices; ++v) {
        const double d = columns_[a][v] - corner[a];
        heights[v] += plane.normal[a] * d;
        sizes[v] = std::max(sizes[v], std::abs(d));
      }
    for (std::size_t v = 0; v < vertices; ++v) {
      const double bound = plane.bound * sizes[v] + 0x1p-1000;
      sides.above |= Bits{heights[v] > bound} << v;
      sides.below |= Bits{heights[v] < -bound} << v;
    }
    sides.above &= ~sides.on;
    sides.below &= ~sides.on;
  }
  static bool own_planes_separate(const Sides& s, const Sides& t) noexcept {
    const Bits a = s.on & ~t.on, b = t.on & ~s.on;
    return ((b & ~s.above) == 0 || (b & ~s.below) == 0 || (a & ~t.above) == 0 || (a & ~t.below) == 0);
  }
  [[nodiscard]] bool is_separated(const Simplex& s, const Simplex& t, Bits common) const noexcept {
    for (std::size_t w = 0; w < words_; ++w) {
      Common a, b;
      Bits on = ~Bits{0};
      for (std::size_t i = 0; i < N; ++i) {
        const Sides &of_s = sides_[s[i] * words_ + w], &of_t = sides_[t[i] * words_ + w];
        (common >> s[i] & 1u) != 0 ? void(on &= of_s.on) : a.add(of_s);
        if ((common >> t[i] & 1u) == 0) b.add(of_t);
      }
      const Bits separating =
          (a.above & b.not_above) | (a.not_below & b.below) | (a.below & b.not_below) | (a.not_above & b.above);
      if ((separating & on) != 0) return true;
    }
    return false;
  }

  std::array<std::array<double, kMostVertices>, N> columns_{};  ///< coordinates of the vertices
  std::size_t words_ = 0;                                       ///< for the bits of all simplices
  std::vector<Sides> planes_;                                   ///< by simplex: vertices
  std::vector<Sides> sides_;                                    ///< by vertex, then 64 simplices
};

}  // namespace tegl::bench
