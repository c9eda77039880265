// SPDX-License-Identifier: BSD-3-Clause
//
// The vertices of an extraction that are on the seam of periodic axes, in pairs: one in the last layer along an axis,
// which repeats the first layer, and the vertex of the same cell in the first layer. They are paired by their cells, so
// equal or rounded coordinates do not matter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernel/contour_output.hpp"
#include "kernel/extract_layers.hpp"

namespace tegl::detail {

template <int N>
class SeamCells {
 public:
  /// Bit a of `axes`: axis a is periodic.
  explicit SeamCells(unsigned axes) noexcept : axes_(axes) {}

  [[nodiscard]] RankReaders rank_readers() const noexcept {
    return is_periodic(N - 1) ? RankReaders::last_layer : RankReaders::none;
  }
  /// Call in order: layer 0, then each slab and the layer above it, when vertices are numbered.
  void add_layer(std::size_t k, const RowShape<N>& shape, const Layer<N>& layer, NumberedBy by);
  void add_slab(const SlabView<N>& view, NumberedBy by);

  /// Pairs (vertex in a last layer, the same vertex in the first layer); the first number is the larger one.
  [[nodiscard]] std::vector<std::pair<Index, Index>>& pairs() noexcept { return pairs_; }
  /// Number of the last pairs that connect the last layer along the last axis with layer 0.
  [[nodiscard]] std::size_t pairs_with_layer_0() const noexcept { return pairs_with_layer_0_; }

 private:
  /// A cell with vertices.
  struct Cell {
    std::uint64_t place;  ///< where it is in its layer or row
    Index first;
    unsigned count;
  };
  using Cells = std::vector<Cell>;

  template <class Plane>
  static void list_row(const Plane& plane, std::size_t row, const RowShape<N>& shape, bool lists, Cells& cells);
  /// Pairs the vertices of a plane of cells along `axes`.
  template <class Plane>
  void add_plane(const Plane& plane, unsigned axes, const RowShape<N>& shape, bool lists);
  /// The same for edges without bits. Rows that repeat each other then have as many edges, in the same order. The edge
  /// at a row's sample i is between bit i of its words at `from` and at `to`.
  void add_edges(const EdgePlane& plane, int axis, const RowShape<N>& shape, const Word* from, const Word* to);
  /// Whether cells along `axes` repeat across periodic axis a.
  [[nodiscard]] bool repeats(unsigned axes, int a) const noexcept { return is_periodic(a) && (axes >> a & 1u) == 0; }
  void pair(Index last, Index first, std::size_t count) {
    for (Index i = 0; i < count; ++i) pairs_.emplace_back(last + i, first + i);
  }
  template <class Plane>
  void list_layer(const Plane& plane, const RowShape<N>& shape, bool lists, Cells& cells) const;
  /// Pairs the vertices of cells at equal places. Both lists ascend.
  void pair(const Cells& last, const Cells& first);
  [[nodiscard]] bool is_periodic(int axis) const noexcept { return (axes_ >> axis & 1u) != 0; }

  unsigned axes_;
  Cells lower_, upper_;            ///< of one row each
  std::array<Cells, N> of_first_;  ///< of layer 0, by kind, if the last axis is periodic
  std::vector<std::pair<Index, Index>> pairs_;
  std::size_t pairs_with_layer_0_ = 0;
};

}  // namespace tegl::detail
