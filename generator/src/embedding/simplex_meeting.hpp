// SPDX-License-Identifier: BSD-3-Clause
//
// Exact test whether two simplices with vertices at integer points meet outside of the simplex of their common
// vertices.
//
// They do if and only if the relative interiors of the convex hulls of two disjoint sets P and Q of their vertices
// meet. Sets with at most n + 2 points in total are enough (P. Kirchberger, 1903), and of these the ones with a single
// affine dependence: then P and Q meet if and only if the dependence has one sign on P and the other one on Q, zeros
// apart.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/tile_contour.hpp"

namespace tegl::gen {

/// A point in units of 2^-28 of an edge; the first n coordinates count.
using GridPoint = std::array<std::int64_t, 4>;
inline constexpr int kGridBits = 28;  ///< determinants of 4 x 4 differences have 117 bits

/// Two simplices of one tile, compared at many positions of their vertices.
class SimplexMeeting {
 public:
  /// n-vertex simplices of an n-tile.
  SimplexMeeting(int n, const LocalSimplex& a, const LocalSimplex& b);

  /// How far the simplices are from meeting: the smallest share, over all P and Q with n + 2 points, of the dependence
  /// that has the wrong sign. 0 if and only if they meet; 1 if they have less than n + 2 points and do not meet.
  /// `places`: by local vertex. The same on all machines.
  [[nodiscard]] double miss(std::span<const GridPoint> places) const;

  /// A fast sufficient condition: true only if a hyperplane is strictly between the simplices.
  [[nodiscard]] bool are_clearly_apart(std::span<const GridPoint> places) const;

  /// The local vertices of the two simplices, without repetition.
  [[nodiscard]] std::span<const std::uint8_t> vertices() const noexcept { return vertices_; }

 private:
  /// Disjoint sets of vertices: P comes first.
  struct Faces {
    std::array<std::uint8_t, 6> points;
    std::uint8_t in_p, count;
  };
  [[nodiscard]] bool meet_in_smaller_faces(std::span<const GridPoint> places) const;

  int dim_;
  std::array<LocalSimplex, 2> simplices_;
  std::vector<std::uint8_t> vertices_;
  std::vector<Faces> whole_, smaller_;  ///< with n + 2 points; with fewer
};

}  // namespace tegl::gen
