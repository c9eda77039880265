// SPDX-License-Identifier: BSD-3-Clause
//
// Iteration along a row of cells: tiles, or (for the barycentres of a 4D contour) cubes of tiles. Compiled for each set
// of axes that a cell may span, so all loops over corners and edges unroll.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "kernel/extract_layers.hpp"
#include "tegl/table_contract.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

/// Local frame of a cell that spans the axes of the bit mask `Axes` of N-space. Local axis j is the j-th axis of the
/// mask.
template <int N, unsigned Axes>
struct CellFrame {
  static constexpr int kDim = std::popcount(Axes);
  static constexpr bool kAlongRow = (Axes & 1u) != 0;
  static constexpr unsigned kRows = 1u << (kDim - (kAlongRow ? 1 : 0));
  static constexpr unsigned kEdges = tables::edge_count(kDim);

  /// Axis of N-space for each local axis.
  static constexpr std::array<int, kDim> axes() noexcept {
    std::array<int, kDim> result{};
    std::size_t j = 0;
    for (int a = 0; a < N; ++a)
      if ((Axes >> a & 1u) != 0) result[j++] = a;
    return result;
  }
  /// Maps a local corner number to the mask of axes of N-space along which it is displaced.
  static constexpr unsigned spread(unsigned corner) noexcept {
    constexpr auto kAxes = axes();
    unsigned mask = 0;
    for (std::size_t j = 0; j < kAxes.size(); ++j) mask |= (corner >> j & 1u) << kAxes[j];
    return mask;
  }
  /// First corner of the r-th row of corners.
  static constexpr unsigned row_corner(unsigned r) noexcept { return kAlongRow ? 2 * r : r; }
};

/// Population count of a word that usually has at most one set bit. Faster than std::popcount if the processor has no
/// such instruction.
[[gnu::always_inline]] inline Index few_bits(Word word) noexcept {
  Index count = 0;
  for (; word != 0; word &= word - 1) ++count;
  return count;
}

/// Corner bits of 64 cells of a row at a time.
template <int N, unsigned Axes>
class CellBits {
 public:
  using Frame = CellFrame<N, Axes>;

  CellBits(const SlabView<N>& view, std::size_t row) noexcept { rows(view, row, rows_.data()); }

  /// Writes the rows of corner bits of a row of cells to `out`.
  static void rows(const SlabView<N>& view, std::size_t row, const Word** out) noexcept {
    for (unsigned r = 0; r < Frame::kRows; ++r) {
      const unsigned mask = Frame::spread(Frame::row_corner(r));
      const Layer<N>& layer = *view.layers[mask >> (N - 1) & 1u];
      out[r] = layer.high.data() + view.shape->shifted(row, mask) * view.shape->pitch();
    }
  }

  void load(std::size_t w) noexcept {
    for (unsigned r = 0; r < Frame::kRows; ++r) {
      low_[r] = rows_[r][w];
      if constexpr (Frame::kAlongRow) high_[r] = rows_[r][w] >> 1 | rows_[r][w + 1] << (kWordBits - 1);
    }
  }
  /// Cells with both high and low corners.
  [[nodiscard]] Word mixed() const noexcept {
    Word any = 0;
    Word all = ~Word{0};
    for (unsigned r = 0; r < Frame::kRows; ++r) {
      any |= low_[r];
      all &= low_[r];
      if constexpr (Frame::kAlongRow) {
        any |= high_[r];
        all &= high_[r];
      }
    }
    return any & ~all;
  }
  [[nodiscard]] unsigned signature(unsigned bit) const noexcept {
    unsigned signature = 0;
    for (unsigned r = 0; r < Frame::kRows; ++r) {
      if constexpr (Frame::kAlongRow) {
        signature |= static_cast<unsigned>(low_[r] >> bit & 1u) << (2 * r);
        signature |= static_cast<unsigned>(high_[r] >> bit & 1u) << (2 * r + 1);
      } else {
        signature |= static_cast<unsigned>(low_[r] >> bit & 1u) << r;
      }
    }
    return signature;
  }

 private:
  std::array<const Word*, Frame::kRows> rows_;
  std::array<Word, Frame::kRows> low_;
  std::array<Word, Frame::kRows> high_;
};

/// Vertex numbers on the edges of 64 cells of a row at a time.
template <int N, unsigned Axes>
class CellEdges {
 public:
  using Frame = CellFrame<N, Axes>;

  CellEdges(const SlabView<N>& view, std::size_t row) noexcept {
    constexpr auto kStreams = streams();
    for (unsigned s = 0; s < kStreamCount; ++s) {
      const unsigned mask = kStreams[s].mask;
      const EdgePlane& plane = view.edges(kStreams[s].axis, mask >> (N - 1) & 1u);
      const std::size_t at = view.shape->shifted(row, mask);
      base_[s] = plane.first(at);
      prefix_[s] = plane.prefix.data() + at * view.shape->words();
      bits_[s] = plane.bits[0].data() + at * view.shape->words();
    }
  }

  void load(std::size_t w) noexcept {
    passed_ = 0;
    for (unsigned s = 0; s < kStreamCount; ++s) {
      rank_[s] = base_[s] + prefix_[s][w];
      word_[s] = bits_[s][w];
    }
  }
  /// For each local edge: first vertex of its stream in this row.
  static void firsts(const SlabView<N>& view, std::size_t row, Index* out) noexcept {
    constexpr auto kStreams = streams();
    // Forced unrolling: each stream's row is then computed with one or two additions. And no array in between: vector
    // loads of numbers that have just been stored one by one would wait for these stores.
    [&]<std::size_t... S>(std::index_sequence<S...>) {
      (store_first<S>(view.edges(kStreams[S].axis, kStreams[S].mask >> (N - 1) & 1u)
                          .first(view.shape->shifted(row, kStreams[S].mask)),
                      out),
       ...);
    }
    (std::make_index_sequence<kStreamCount>{});
  }
  /// Vertex numbers of all edges of cell `bit`. Successive calls need ascending bits. Entries of non-critical edges are
  /// undefined.
  void ids(unsigned bit, Index* out) noexcept {
    constexpr auto kPlaces = places();
    const Word below = (Word{1} << bit) - 1;
    for (unsigned s = 0; s < kStreamCount; ++s) rank_[s] += few_bits(word_[s] & below & ~passed_);
    passed_ = below;
    for (unsigned e = 0; e < Frame::kEdges; ++e) {
      const unsigned s = kPlaces[e].stream;
      out[e] = rank_[s] + (kPlaces[e].next ? static_cast<Index>(word_[s] >> bit & 1u) : 0);
    }
  }

 private:
  struct Stream {
    int axis = 0;       ///< axis of N-space
    unsigned mask = 0;  ///< displacement of its row
  };
  struct Place {
    unsigned stream = 0;
    bool next = false;  ///< the edge is at the next sample of the row
  };
  static constexpr bool is_stream(unsigned e) noexcept {
    const unsigned axis = e >> (Frame::kDim - 1);
    return !Frame::kAlongRow || axis == 0 || (edge_base(Frame::kDim, e) & 1u) == 0;
  }
  static constexpr unsigned kStreamCount = [] {
    unsigned count = 0;
    for (unsigned e = 0; e < Frame::kEdges; ++e) count += is_stream(e) ? 1 : 0;
    return count;
  }();
  static constexpr std::array<Stream, kStreamCount> streams() noexcept {
    std::array<Stream, kStreamCount> result{};
    unsigned count = 0;
    for (unsigned e = 0; e < Frame::kEdges; ++e)
      if (is_stream(e))
        result[count++] = {Frame::axes()[e >> (Frame::kDim - 1)], Frame::spread(edge_base(Frame::kDim, e)) & ~1u};
    return result;
  }
  static constexpr std::array<Place, Frame::kEdges> places() noexcept {
    constexpr auto kStreams = streams();
    constexpr auto kAxes = Frame::axes();
    std::array<Place, Frame::kEdges> result{};
    for (unsigned e = 0; e < Frame::kEdges; ++e) {
      const unsigned mask = Frame::spread(edge_base(Frame::kDim, e));
      for (unsigned s = 0; s < kStreamCount; ++s)
        if (kStreams[s].axis == kAxes[e >> (Frame::kDim - 1)] && kStreams[s].mask == (mask & ~1u))
          result[e] = {s, (mask & 1u) != 0};
    }
    return result;
  }

  template <unsigned Stream>
  [[gnu::always_inline]] static void store_first(Index first, Index* out) noexcept {
    constexpr auto kPlaces = places();
    [&]<std::size_t... E>(std::index_sequence<E...>) {
      ((kPlaces[E].stream == Stream ? static_cast<void>(out[E] = first) : static_cast<void>(0)), ...);
    }
    (std::make_index_sequence<Frame::kEdges>{});
  }

  std::array<Index, kStreamCount> base_;
  std::array<const std::uint32_t*, kStreamCount> prefix_;
  std::array<const Word*, kStreamCount> bits_;
  std::array<Index, kStreamCount> rank_;  ///< vertices of the row before the first cell not passed
  std::array<Word, kStreamCount> word_;
  Word passed_ = 0;
};

using LocalIds = std::array<Index, 256>;  ///< vertex numbers by local vertex

/// Writes a tile's simplices. In the class layout, vertex numbers are permuted once per tile instead of once per use,
/// which makes it as fast as the flat layout. `flip`: reverses the table's orientation. `own`: number of the tile's
/// first own vertex. Returns the destination of the next simplex.
template <int N>
std::array<Index, N>* write_simplices(const SimplexList<N>& list, bool flip, LocalIds& ids, Index own,
                                      std::array<Index, N>* out) noexcept {
  LocalIds permuted;
  LocalIds& of_stored = list.is_permuted() ? permuted : ids;
  if (list.is_permuted())
    for (unsigned v = 0; v < tables::first_tile_vertex(N); ++v) of_stored[v] = ids[list.mapped(v)];
  for (unsigned j = 0; j < list.own_vertices(); ++j) of_stored[tables::first_tile_vertex(N) + j] = own + j;
  const unsigned last = flip != list.reversed() ? N - 2 : N - 1;
  const unsigned before = (N - 2) + (N - 1) - last;
  for (unsigned q = 0; q < list.size(); ++q, ++out) {
    for (unsigned j = 0; j + 2 < N; ++j) (*out)[j] = of_stored[list.stored(q, j)];
    (*out)[before] = of_stored[list.stored(q, N - 2)];
    (*out)[last] = of_stored[list.stored(q, N - 1)];
  }
  return out;
}

/// First vertex of each of the eight cubes of a tile (N = 4), for 64 tiles of a row at a time.
class TileCubes {
 public:
  static constexpr unsigned kCubes = 8;

  TileCubes(const SlabView<4>& view, std::size_t row) noexcept {
    for (unsigned s = 0; s < kStreamCount; ++s) {
      const CubePlane& plane = view.cubes(omitted(s), omitted(s) == 3 ? side(s) : 0);
      const std::size_t at = view.shape->shifted(row, side(s) << omitted(s));
      base_[s] = plane.first(at);
      prefix_[s] = plane.prefix.data() + at * view.shape->words();
      for (unsigned slot = 0; slot < tables::kFaceSlots; ++slot)
        bits_[s][slot] = plane.bits[slot].data() + at * view.shape->words();
    }
  }

  void load(std::size_t w) noexcept {
    passed_ = 0;
    for (unsigned s = 0; s < kStreamCount; ++s) {
      rank_[s] = base_[s] + prefix_[s][w];
      for (unsigned slot = 0; slot < tables::kFaceSlots; ++slot) word_[s][slot] = bits_[s][slot][w];
    }
  }
  /// First vertex of each cube of tile `bit`. Successive calls need ascending bits. Entries of cubes without vertices
  /// are undefined.
  void ids(unsigned bit, std::array<Index, kCubes>& out) noexcept {
    const Word below = (Word{1} << bit) - 1;
    for (unsigned s = 0; s < kStreamCount; ++s)
      for (const Word word : word_[s]) rank_[s] += few_bits(word & below & ~passed_);
    passed_ = below;
    out[0] = rank_[0];
    out[1] = rank_[0];
    for (const Word word : word_[0]) out[1] += static_cast<Index>(word >> bit & 1u);
    for (unsigned s = 1; s < kStreamCount; ++s) out[s + 1] = rank_[s];
  }
  /// Numbers of all vertices that the tile's cubes own. Calls as above.
  void ids(unsigned bit, LocalIds& out) noexcept {
    std::array<Index, kCubes> first;
    ids(bit, first);
    for (unsigned cube = 0; cube < kCubes; ++cube)
      for (unsigned slot = 0; slot < tables::kFaceSlots; ++slot)
        out[tables::edge_count(4) + tables::kFaceSlots * cube + slot] = first[cube] + slot;
  }

 private:
  // Both cubes across axis 0 share one stream; every other cube has its own.
  static constexpr unsigned kStreamCount = kCubes - 1;
  static constexpr int omitted(unsigned stream) noexcept { return static_cast<int>((stream + 1) / 2); }
  static constexpr unsigned side(unsigned stream) noexcept { return stream == 0 ? 0 : (stream + 1) % 2; }

  std::array<Index, kStreamCount> base_;
  std::array<const std::uint32_t*, kStreamCount> prefix_;
  std::array<std::array<const Word*, tables::kFaceSlots>, kStreamCount> bits_;
  std::array<Index, kStreamCount> rank_;
  std::array<std::array<Word, tables::kFaceSlots>, kStreamCount> word_;
  Word passed_ = 0;
};

}  // namespace tegl::detail
