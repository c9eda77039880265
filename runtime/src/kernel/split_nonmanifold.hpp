// SPDX-License-Identifier: BSD-3-Clause
//
// Contours next to missing values. Tiles without missing corners may meet in an edge or a square of the grid alone, as
// the fields of a chessboard do in a corner, and so may the holes that the others leave. A contour that passes there
// touches itself, or its border does, and is no manifold:
// - in a point, with several fans of simplices around it: the vertex is doubled, one for each fan;
// - along an edge (4D) whose ends have one fan each: it gets a midpoint in all of the fans around it but one;
// - in a point where holes meet (4D), so that the link is a sphere with several holes: each hole but one gets a vertex
// of
//   its own in the same place, with tetrahedra of no size between the two.
// The set of points stays as it is, and what held together by a face still does.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/extract_count.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The vertices that may need it, as far as an extraction has come.
class PinchList {
 public:
  /// Ascending, each once.
  [[nodiscard]] const std::vector<std::uint64_t>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] bool any_missing() const noexcept { return any_missing_; }

 protected:
  bool any_missing_ = false;
  std::vector<std::uint64_t> vertices_;
};

/// Gathers, while an extraction goes through the layers, the vertices that may need it: those on edges of the grid
/// that a valid tile shares with a tile with missing corners.
template <int N>
class PinchCandidates : public PinchList {
 public:
  PinchCandidates(const RowShape<N>& shape, const Counter<N>& counter);

  /// To be called for each slab in turn, when its valid tiles are known, before the edges at either side of it.
  void open_slab(std::size_t k, const Slab<N>& slab);
  /// The edges in layer k, between slabs k - 1 and k, whose numbers are known.
  void add_layer(std::size_t k, const Layer<N>& layer);
  /// The edges along the last axis in slab k.
  void add_slab(std::size_t k, const Slab<N>& slab);
  /// The least number that a vertex met from now on can have; the largest is below that plus 2^32.
  void set_least(std::uint64_t least) noexcept { least_ = least; }

 private:
  void add_row(const EdgePlane& plane, int axis, std::size_t row, const Slab<N>* below, const Slab<N>* above);

  const RowShape<N>& shape_;
  const Counter<N>& counter_;
  std::array<Slab<N>, 2> invalid_;  ///< of the last two slabs: "valid" has the tiles that are not
  std::size_t slabs_ = 0;           ///< opened so far
  std::vector<Word> buffer_;
  std::uint64_t least_ = 0;
};

/// Makes the contour a manifold around the candidates. New vertices and simplices come last, in an order that depends
/// on the contour alone. Throws TooLarge beyond `max_vertices`. O(S + c log c), c the simplices around candidates.
template <int N, class Real>
void separate_pinches(Contour<N, Real>& contour, const std::vector<Index>& candidates, std::uint64_t max_vertices);

}  // namespace tegl::detail
