// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of the prisms over polygons, computed by the compiler.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "polytope/polytope_faces.hpp"

namespace tegl::detail {

/// The prisms over polygons of up to kPolytopeCorners corners. Corner v of the base is below corner `corners` + v. The
/// faces: the base, the top, then the sides by their first corner at the base; seen from outside as the polygon, the
/// base is clockwise, the top counterclockwise. Edges are numbered in the order in which the rings first pass them.
class PolygonPrisms {
 public:
  constexpr PolygonPrisms() {
    for (std::size_t n = 3; n <= kPolytopeCorners; ++n) add(n);
  }
  /// `corners`: of the polygon, at least 3.
  [[nodiscard]] constexpr PolytopeFaces over(std::size_t corners) const noexcept {
    const std::size_t n = corners, before = first(n);
    return {2 * n,
            std::span(rings_).subspan(6 * before, 6 * n),
            std::span(ring_edges_).subspan(6 * before, 6 * n),
            std::span(ends_).subspan(before + 2 * n, n + 2),
            std::span(edges_).subspan(3 * before, 3 * n),
            std::span(faces_of_).subspan(3 * before, 3 * n)};
  }

 private:
  using Pair = PolytopeFaces::Pair;
  /// Number of corners of all smaller polygons.
  [[nodiscard]] static constexpr std::size_t first(std::size_t n) noexcept { return n * (n - 1) / 2; }

  constexpr void add(std::size_t n) {
    const auto small = [](std::size_t i) { return static_cast<std::uint8_t>(i); };
    const std::size_t before = first(n);
    std::size_t at = 6 * before, end = before + 2 * n;
    const auto push = [&](std::size_t corner, std::size_t edge) {
      rings_[at] = small(corner);
      ring_edges_[at++] = small(edge);
    };
    const auto end_face = [&] { ends_[end++] = static_cast<std::uint16_t>(at - 6 * before); };
    const auto set_edge = [&](std::size_t e, std::size_t a, std::size_t b, std::size_t face, std::size_t other) {
      edges_[3 * before + e] = {small(a < b ? a : b), small(a < b ? b : a)};
      faces_of_[3 * before + e] = {small(face), small(other)};
    };
    // edges from corner v on: along the base and the top, and upwards
    const auto next = [&](std::size_t v) { return v + 1 == n ? 0 : v + 1; };
    const auto along_base = [&](std::size_t v) { return v + 1 == n ? v : n - 2 - v; };
    const auto upwards = [&](std::size_t v) { return v < 2 ? 2 * n + 1 - v : 2 * n + v; };
    for (std::size_t v = n; v-- > 0;) push(v, along_base(v == 0 ? n - 1 : v - 1));
    end_face();
    for (std::size_t v = 0; v < n; ++v) push(n + v, n + v);
    end_face();
    for (std::size_t v = 0; v < n; ++v) {
      push(v, along_base(v));
      push(next(v), upwards(next(v)));
      push(n + next(v), n + v);
      push(n + v, upwards(v));
      end_face();
      set_edge(along_base(v), v, next(v), 0, v + 2);
      set_edge(n + v, n + v, n + next(v), 1, v + 2);
      v == 0 ? set_edge(upwards(v), v, n + v, 2, n + 1) : set_edge(upwards(v), v, n + v, v + 1, v + 2);
    }
  }

  static constexpr std::size_t kCount = (kPolytopeCorners + 1) * kPolytopeCorners / 2;

  std::array<std::uint8_t, 6 * kCount> rings_{}, ring_edges_{};
  std::array<std::uint16_t, kCount + 2 * kPolytopeCorners + 2> ends_{};
  std::array<Pair, 3 * kCount> edges_{}, faces_of_{};
};

inline constexpr PolygonPrisms kPolygonPrisms;

}  // namespace tegl::detail
