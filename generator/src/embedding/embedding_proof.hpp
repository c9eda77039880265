// SPDX-License-Identifier: BSD-3-Clause
//
// Proves that simplices in a tile do not intersect, for all positions of the points on the tile's edges.
//
// Let P and Q be disjoint sets of points on edges. For some positions, the relative interiors of their convex hulls
// meet if and only if the relative interiors of the convex hulls of the ends of P's and of Q's edges meet: a positive
// combination of points, each free on its edge, is any positive combination of the ends. Two convex hulls of corners
// have disjoint relative interiors if and only if a hyperplane separates them properly (R. T. Rockafellar, Convex
// Analysis, 1970, theorem 11.3), and it can be moved until it is spanned by corners. So a finite set of hyperplanes
// decides exactly, for all positions at once.
//
// The same holds for vertices that are free on other segments, as on rays from the tile's centre: their ends count as
// corners.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/tile_contour.hpp"

namespace tegl::gen {

/// Two simplices of one contour.
using SimplexPair = std::pair<LocalSimplex, LocalSimplex>;

/// The hyperplanes spanned by a tile's corners, and the proofs that they give. n = 2, 3, 4.
class EmbeddingProof {
 public:
  /// A vector from the tile's centre to a point of its boundary, in halves of an edge.
  using Ray = std::array<int, 4>;

  /// Local vertices from the edge count on are free on these rays: anywhere between the tile's centre and the ray's
  /// end. At most 32 corners and ray ends, and 32 edges and rays.
  explicit EmbeddingProof(const Tile& tile, std::span<const Ray> rays = {});

  /// For the local vertices after those on edges and rays: the set of edges (bit e; rays follow) of whose points the
  /// vertex is a positive combination, with any weights. Vertices may share edges. Local vertices are below 64.
  using Means = std::vector<std::uint32_t>;

  /// True if no two of the simplices (n vertices each) meet outside of the simplex of their common vertices, for all
  /// positions. Simplices in a facet of the tile are not compared: the contour of that facet has them. If all vertices
  /// lie on edges, false means that two simplices intersect for some positions. O(#S^2).
  [[nodiscard]] bool holds(std::span<const LocalSimplex> simplices, const Means& means = {}) const;
  /// The same for each simplex of `first` with each of `second`.
  [[nodiscard]] bool holds_between(std::span<const LocalSimplex> first, std::span<const LocalSimplex> second,
                                   const Means& means = {}) const;
  /// Adds to `pairs` the pairs of the simplices for which `holds` is false.
  void add_meeting(std::span<const LocalSimplex> simplices, const Means& means, std::vector<SimplexPair>& pairs) const;
  /// The same for each simplex of `first` with each of `second`.
  void add_meeting(std::span<const LocalSimplex> first, std::span<const LocalSimplex> second, const Means& means,
                   std::vector<SimplexPair>& pairs) const;
  /// The hyperplanes: the points above and below each. Bit v: corner v; the tile's centre and the ends of rays follow.
  [[nodiscard]] std::span<const std::pair<std::uint32_t, std::uint32_t>> hyperplanes() const noexcept {
    return hyperplanes_;
  }
  /// True if some positions make the simplex degenerate: a triangle with its vertices on a line, and so on.
  [[nodiscard]] bool may_be_flat(const LocalSimplex& simplex, const Means& means = {}) const;

 private:
  static constexpr std::size_t kWords = 3;
  using Hyperplanes = std::array<std::uint64_t, kWords>;  ///< a set of them
  struct Sides {
    Hyperplanes above{}, below{};  ///< hyperplanes with a point of the set above, below
    void add(const Sides& other) noexcept {
      for (std::size_t k = 0; k < kWords; ++k) above[k] |= other.above[k], below[k] |= other.below[k];
    }
  };
  using Vertices = std::uint64_t;  ///< a set of local vertices
  struct Simplex {
    Vertices vertices = 0;
    std::array<Vertices, 16> faces{};       ///< by set of its vertices (bit i: vertex i): the vertices
    std::array<std::uint32_t, 16> edges{};  ///< the same: their edges
    std::array<Sides, 16> sides;            ///< the same: of their edges
  };

  using Point = std::array<int, 4>;
  void add_hyperplane(std::span<const std::size_t> through);
  [[nodiscard]] Simplex prepared(const LocalSimplex& simplex, const Means& means) const;
  [[nodiscard]] std::uint32_t edges_of(Vertices vertices, const Means& means) const;
  [[nodiscard]] Sides sides_of(std::uint32_t edges) const;
  [[nodiscard]] Sides sides_of_edge(std::uint32_t e) const;
  [[nodiscard]] bool in_one_facet(std::uint32_t edges) const;
  [[nodiscard]] static bool have_separate_interiors(const Sides& p, const Sides& q) noexcept;
  [[nodiscard]] static bool are_separate_around(const Sides& a, const Sides& b, const Sides& on) noexcept;
  [[nodiscard]] bool are_divided(const Simplex& a, const Simplex& b) const;
  [[nodiscard]] bool may_meet(const Simplex& a, const Simplex& b) const;
  [[nodiscard]] bool may_meet_inside(std::uint32_t of_p, std::uint32_t of_q) const;
  [[nodiscard]] bool decide_inside(std::uint32_t of_p, std::uint32_t of_q) const;

  const Tile* tile_;
  std::vector<Point> points_;                                         ///< corners, the centre, ends of rays; doubled
  std::vector<std::array<std::uint8_t, 2>> segments_;                 ///< edges and rays, by their ends
  std::vector<std::uint32_t> facets_;                                 ///< by face of the tile: its edges
  std::vector<std::pair<std::uint32_t, std::uint32_t>> hyperplanes_;  ///< the points above and below
  Hyperplanes existing_{};                                            ///< bits of hyperplanes_
  using SidesOfByte = std::array<Sides, 256>;
  std::vector<SidesOfByte> of_edges_;                              ///< by 8 edges: of every set of these
  std::vector<std::pair<std::uint8_t, std::uint8_t>> face_pairs_;  ///< pairs of faces of two simplices to compare

  /// Results of decide_inside for pairs of sets of edges, by a hash of the pair; a new pair replaces the one in its
  /// place. The cones of a tile's contour compare the same barycentres many times. Threads share it; 0 is no pair.
  using KnownPairs = std::vector<std::atomic<std::uint64_t>>;
  mutable KnownPairs meeting_, apart_;
};

}  // namespace tegl::gen
