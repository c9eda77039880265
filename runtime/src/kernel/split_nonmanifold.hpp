// SPDX-License-Identifier: BSD-3-Clause
//
// Splits non-manifold vertices and edges of contours beside missing values. Tiles without missing corners may meet in
// only an edge or a square of the grid, as equal fields of a chessboard meet in a corner; so may tiles with missing
// corners. A contour that passes there, or its boundary, touches itself and is not a manifold:
// - Vertex with several fans of simplices: one copy of the vertex per fan.
// - Edge (4D) with several fans, whose ends have one fan each: a midpoint is inserted in all fans except one.
// - Vertex where holes meet (4D), with a sphere with several holes as its link: each hole except one gets a copy of the
// vertex, and zero-size tetrahedra connect the two.
// The point set does not change, and up to 4D simplices that shared a face still share it.
// In 5D also:
// - Triangle with several fans: a centroid is inserted in all fans except one.
// - Edge where holes meet: each hole except one gets a midpoint, and 4-simplices of no size fill the gap.
// - Vertex whose link is still neither a sphere nor a ball, as where three holes meet: the link is divided into balls,
// each of which gets a copy of the vertex (tile/link_balls.hpp). Then some simplices no longer share a face.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/extract_count.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Candidates for non-manifold vertices, as far as the extraction has come.
class NonmanifoldCandidates {
 public:
  /// Ascending, without duplicates.
  [[nodiscard]] const std::vector<std::uint64_t>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] bool any_missing() const noexcept { return any_missing_; }

 protected:
  bool any_missing_ = false;
  std::vector<std::uint64_t> vertices_;
};

/// Gathers candidates during an extraction: vertices on grid edges that belong to both a valid tile and a tile with
/// missing corners.
template <int N>
class NonmanifoldCollector : public NonmanifoldCandidates {
 public:
  NonmanifoldCollector(const RowShape<N>& shape, const Counter<N>& counter);

  /// Call for each slab in order, after its valid tiles are known and before adding edges in or beside it.
  void open_slab(std::size_t k, const Slab<N>& slab);
  /// Adds the edges in layer k, between slabs k - 1 and k. Requires their vertex numbers.
  void add_layer(std::size_t k, const Layer<N>& layer);
  /// Adds the edges along the last axis in slab k.
  void add_slab(std::size_t k, const Slab<N>& slab);
  /// Sets the smallest number that vertices met from now on can have; all are below `least` + 2^32.
  void set_least(std::uint64_t least) noexcept { least_ = least; }

 private:
  void add_row(const EdgePlane& plane, int axis, std::size_t row, const Slab<N>* below, const Slab<N>* above);

  const RowShape<N>& shape_;
  const Counter<N>& counter_;
  std::array<Slab<N>, 2> invalid_;  ///< last two slabs; their "valid" bits mark tiles that are not valid
  std::size_t slabs_ = 0;           ///< number of slabs opened
  std::vector<Word> buffer_;
  std::uint64_t least_ = 0;
};

/// Makes the contour a manifold around the candidates. New vertices and simplices are appended in an order that depends
/// on the contour only. Throws TooLarge beyond `max_vertices`. O(S + c log c), with S simplices in all and c simplices
/// around candidates; in 5D for each round of copies, and the links of the candidates are tested. `work`: threads for
/// these tests, on which the result does not depend; progress after each round, which approaches 1, as the number of
/// rounds is not known. Errors: Cancelled; the contour is then in an unknown state.
template <int N, class Real>
void split_nonmanifold(Contour<N, Real>& contour, const std::vector<Index>& candidates, std::uint64_t max_vertices,
                       const WorkOptions& work = {1, {}});

}  // namespace tegl::detail
