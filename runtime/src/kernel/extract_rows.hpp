// SPDX-License-Identifier: BSD-3-Clause
//
// The innermost loops of the extraction. They are compiled for several instruction sets, the best of which is chosen at
// run time; all give identical bytes.
//
// Running counters number a tile's vertices. A *stream* is a row of edges that one row of tiles touches: 2^(N-1)
// streams along the row, and 2^(N-2) for each other axis. A tile has the edge of each stream at its own position and,
// for the other axes, also the one at the next position. Every critical edge makes the tiles around it active, so the
// counters advance at active tiles only. The signature determines the increments; no bits of edges are read.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/bitplanes.hpp"
#include "tegl/contour.hpp"
#include "tegl/table_contract.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/cube_key.hpp"
#include "tile/row_table.hpp"

namespace tegl::detail {

/// A row of tiles to be counted.
struct TileRow {
  std::array<const Word*, 8> corners;  ///< the 2^(N-1) rows of samples around the tiles
  std::size_t tiles;                   ///< along the row
  const Word* valid;                   ///< null: all tiles are valid
  /// N = 4: whether simplices and own vertices are counted. The entries of the table are seldom in a cache.
  bool sizes = true;
  bool own_vertices = true;  ///< with `sizes`: false if no signature has own vertices, as opposed to keys of variants
};

/// Output of counting a row of tiles.
struct TileRoom {
  Word* active;  ///< bits: ceil(samples / 64) words; bits past the last tile are 0
  // By active tile, in order. Up to 32 entries past the end are overwritten.
  std::uint16_t* signatures;
  std::uint16_t* at;  ///< positions along the row, modulo 2^16
};

/// Counts of a row of tiles.
struct TileCount {
  std::uint32_t active = 0;
  std::uint32_t own_vertices = 0;
  std::uint64_t simplices = 0;
  /// Critical edges that belong to the row, valid or not: by axis those of the upper layer except at its last sample,
  /// then those along the last axis.
  std::array<std::uint32_t, 4> edges{};
};

/// Finds and counts the active tiles of a row.
template <int N>
TileCount count_tile_row(const TileRow& row, const RowTable& table, const TileRoom& room) noexcept;

/// Active tiles of a row of at most kMostListed samples, from which its critical edges are listed.
struct TileEdges {
  const std::uint16_t* signatures;
  const std::uint16_t* at;
  std::size_t active;
  /// By axis, in the order of TileCount::edges: destination of the positions of the edges' first samples, ascending. Up
  /// to 16 entries past the end are overwritten. Not copied: vector loads of pointers that have just been stored one by
  /// one would wait for these stores.
  const std::array<std::uint32_t*, 4>& out;
};

/// Lists a row's critical edges, except those at its last sample.
template <int N>
void list_tile_edges(const TileEdges& row) noexcept;

/// A row of tiles to be written.
template <int N>
struct TileOutput {
  using Simplex = std::array<Index, N>;
  static constexpr unsigned kEdges = tables::edge_count(N);

  const std::uint16_t* signatures;  ///< or keys, if the table has variants
  std::size_t active;
  std::array<Index, kEdges> first;  ///< by local edge: first vertex of its stream
  bool flip;                        ///< orientation opposite to the table's
  Simplex* out;
};

/// Callback for a tile with own vertices. `ordinal`: its index among the row's active tiles. `ids`: vertex numbers of
/// its edges. Writes its simplices and returns the destination of the next one.
template <int N>
struct OwnTiles {
  using Simplex = std::array<Index, N>;
  Simplex* (*write)(void* self, unsigned signature, std::size_t ordinal, const Index* ids, Simplex* out);
  void* self;
};
/// In 3D, it returns the number of the tile's first own vertex.
template <>
struct OwnTiles<3> {
  static constexpr unsigned kMost = 4;  ///< own vertices of a tile
  Index (*first_own)(void* self, unsigned signature, std::size_t ordinal);
  void* self;
};

/// Writes the simplices of a row. Requires that the row's tiles and their neighbours are all valid.
template <int N>
void write_tile_row(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) noexcept;

/// Finds the critical edges of a row. Writes a ^ b to `critical` and the number of edges before each word to `prefix`.
/// If b is null, edges along the row are found, between adjacent samples. `valid` may be null. Returns the number of
/// edges.
std::uint32_t count_edge_row(const Word* a, const Word* b, std::size_t samples, const Word* valid, Word* critical,
                             std::uint32_t* prefix) noexcept;

/// Mask of the local edges at the next position of their stream: displaced along axis 0 but not parallel to it.
template <int N>
constexpr std::uint32_t next_edges() noexcept {
  std::uint32_t edges = 0;
  for (unsigned e = 0; e < tables::edge_count(N); ++e)
    if (e >> (N - 1) != 0 && (edge_base(N, e) & 1u) != 0) edges |= 1u << e;
  return edges;
}

}  // namespace tegl::detail
