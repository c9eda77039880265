// SPDX-License-Identifier: BSD-3-Clause
//
// Simplices that edge contractions replace, and whether a contraction makes an intersection.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "intersect/box_blocks.hpp"
#include "intersect/pair_test.hpp"
#include "intersect/simplex_planes.hpp"
#include "intersect/star_test.hpp"

namespace tegl::detail {

/// A contour that shrinks by edge contractions: its points, simplices and a hierarchy of their boxes, which follow the
/// contractions.
template <int N>
class MovingSimplices {
 public:
  using Simplex = std::array<Index, N>;

  /// Points and simplices are copied. Coordinates must be finite, vertex numbers valid. O(S log S).
  MovingSimplices(std::vector<PointN<N>> points, std::span<const Simplex> simplices, const Progress& progress = {});

  MovingSimplices(const MovingSimplices&) = delete;
  MovingSimplices& operator=(const MovingSimplices&) = delete;

  /// The contraction of an edge u v into u: simplices with only one of the two, and those with both, which vanish.
  struct Contraction {
    Index u, v;
    std::span<const Index> only_u, only_v, both;
    PointN<N> at;  ///< the new point of u
  };

  /// Whether no simplex at u intersects another one after the contraction (see tegl/intersections.hpp). Simplices that
  /// are flat then are not tested.
  [[nodiscard]] bool stay_apart(const Contraction& contraction);
  /// Makes the contraction.
  void contract(const Contraction& contraction);

 private:
  void move(const Contraction& contraction);
  void restore(const Contraction& contraction, const PointN<N>& from);
  [[nodiscard]] bool are_apart(const Contraction& contraction);
  [[nodiscard]] bool star_is_apart(Index u);
  void find_candidates();
  void test_link(Index u);
  [[nodiscard]] bool share_embedded_vertex(Index s, Index t) const;
  [[nodiscard]] bool candidates_are_apart();

  std::vector<PointN<N>> points_;
  std::vector<Simplex> rows_;
  SimplexPlanes<N> simplices_;
  BoxBlocks<N> boxes_;
  std::vector<Index> place_;  ///< by simplex: its place in the order of boxes_
  PairTest<N> pairs_;
  StarTest<N> stars_;

  // During a test.
  struct Candidate {
    Index changed, other;
  };
  std::vector<Index> changed_;              ///< simplices at u after the contraction that are not flat
  std::vector<Candidate> candidates_;       ///< with simplices that stay, whose boxes meet; grouped by `changed`
  std::vector<Index> near_;                 ///< the simplices of the candidates that stay, each once
  std::vector<std::uint8_t> marked_;        ///< by simplex: whether it changes or vanishes, or is in near_; 0 else
  std::vector<Index> link_;                 ///< the other vertices of changed simplices
  std::vector<std::vector<Index>> around_;  ///< the stars of link_
  std::vector<std::uint8_t> embedded_;      ///< by vertex: 1 if it is in link_ and no simplices of its star intersect
};

extern template class MovingSimplices<2>;
extern template class MovingSimplices<3>;
extern template class MovingSimplices<4>;

}  // namespace tegl::detail
