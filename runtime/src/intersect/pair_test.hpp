// SPDX-License-Identifier: BSD-3-Clause
//
// Whether two simplices of a contour intersect outside of their common face: exactly, but without exact arithmetic for
// nearly all pairs.
#pragma once

#include <array>
#include <bit>
#include <cstddef>

#include "intersect/simplex_planes.hpp"

namespace tegl::detail {

/// Decides pairs of simplices that are not flat. Thread-safe if the simplices are not changed.
template <int N>
class PairTest {
 public:
  explicit PairTest(const SimplexPlanes<N>& simplices) : simplices_(simplices) {}

  /// Whether two different simplices have a common point outside of the convex hull of their common vertices, or the
  /// same vertices. Then `place` is such a point.
  [[nodiscard]] bool meet(Index s, Index t, PointN<N>& place) const;

 private:
  /// Two simplices, or faces of them.
  struct Pair {
    Index s, t;
    CornersN<N> a, b;             ///< corners of s and t
    unsigned a_common, b_common;  ///< bit i: corner i is a vertex of both
    unsigned a_face, b_face;      ///< the corners of the faces
    std::array<int, N> partner;   ///< by common corner of s, that of t

    [[nodiscard]] unsigned a_own() const noexcept { return a_face & ~a_common; }
    [[nodiscard]] unsigned b_own() const noexcept { return b_face & ~b_common; }
    [[nodiscard]] int common() const noexcept { return std::popcount(a_common & a_face); }
  };

  [[nodiscard]] Pair make_pair(Index s, Index t) const noexcept;
  static bool reduce_to_faces(Pair& pair) noexcept;
  [[nodiscard]] bool planes_separate(const Pair& pair) const noexcept;
  [[nodiscard]] bool found_separator(const Pair& pair) const noexcept;
  static bool separates(const Pair& pair, const PointN<N>& direction) noexcept;
  static bool meet_by_integers(const Pair& pair, PointN<N>& place);

  const SimplexPlanes<N>& simplices_;
};

/// How far two simplices reach through each other's hyperplanes: the smaller one, over both, of the greatest heights of
/// corners on either side. 0 if a simplex is on one side of the other's hyperplane.
template <int N>
double depth_of(const SimplexPlanes<N>& simplices, Index s, Index t) noexcept;

}  // namespace tegl::detail
