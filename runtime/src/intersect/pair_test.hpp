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

/// Decides pairs of simplices that are not flat. One object per thread.
template <int N>
class PairTest {
 public:
  explicit PairTest(const SimplexPlanes<N>& simplices) : simplices_(simplices) {}

  /// Sets the first simplex of pairs.
  void load(Index s) noexcept;
  /// Whether the loaded simplex and another one have a common point outside of the convex hull of their common
  /// vertices, or the same vertices. Then `place` is such a point.
  [[nodiscard]] bool meets(Index t, PointN<N>& place);

 private:
  static constexpr unsigned kAll = (1u << N) - 1;

  /// Bounds of some corners, for all axes.
  struct Bounds {
    PointN<N> low, high;
  };
  /// A simplex, or a face of it.
  struct Side {
    Index simplex = 0;
    CornersN<N> corners{};
    unsigned face = kAll;  ///< bit i: corner i is in the face
    unsigned common = 0;   ///< bit i: corner i is also a vertex of the other simplex
    Bounds bounds{};       ///< of the face
    [[nodiscard]] unsigned own() const noexcept { return face & ~common; }
  };

  void load_side(Side& side, Index s) const noexcept;
  void find_common() noexcept;
  static Bounds bounds_of(const CornersN<N>& corners) noexcept;
  static void restrict_bounds(Side& side) noexcept;
  [[nodiscard]] bool are_apart() const noexcept;
  bool reduce_to_faces() noexcept;
  [[nodiscard]] bool planes_separate() const noexcept;
  [[nodiscard]] bool found_separator() const noexcept;
  [[nodiscard]] bool separates(const PointN<N>& direction) const noexcept;
  [[nodiscard]] const PointN<N>& reference() const noexcept;
  [[nodiscard]] bool meet_by_integers(PointN<N>& place) const;

  const SimplexPlanes<N>& simplices_;
  Side a_, b_;
  Bounds a_bounds_{};             ///< of all corners of the loaded simplex
  std::array<int, N> partner_{};  ///< by common corner of a_, the corner of b_
};

}  // namespace tegl::detail
