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

#include "base/corners.hpp"
#include "image/bitplanes.hpp"
#include "tegl/contour.hpp"
#include "tegl/table_contract.hpp"
#include "tile/cube_key.hpp"

namespace tegl::detail {

/// A resolved tile: its key, and the differences in size from the unresolved tile of its signature.
struct Variant {
  std::uint16_t key = 0;
  std::int8_t more_simplices = 0, more_own_vertices = 0;
};

/// N = 3: first entry of each signature's variants.
using VariantPlaces = std::array<std::uint16_t, 256>;

/// A tile table in the flat layout, in the form that the inner loops read.
class RowTable {
 public:
  /// Layout of an entry, from low bits to high: number of simplices, flag for own vertices, first simplex.
  static constexpr unsigned kCountBits = 6;
  static constexpr std::uint32_t kCountMask = (1u << kCountBits) - 1;
  static constexpr std::uint32_t kOwnFlag = 1u << kCountBits;
  static constexpr unsigned kFirstShift = kCountBits + 1;

  /// Whether the loops can use a table: it must be flat, with sizes that fit in an entry.
  static bool can_use(const tables::TileTable& table) noexcept;

  explicit RowTable(const tables::TileTable& table) : RowTable(table, std::size_t{1} << (1u << table.dim)) {}
  /// From a table whose lists are indexed by `keys` keys (variant_table.hpp). "signature" then stands for a key.
  RowTable(const tables::TileTable& table, std::size_t keys);
  /// For cubes: signature s has counts[s] keys. Entries are stored without gaps, as only few of all possible keys
  /// occur. `variants`: returned by `variant`, four for each entry of tables::ResolvedTable.
  RowTable(const tables::TileTable& table, const std::array<unsigned, 256>& counts, std::vector<Variant> variants);

  /// Treats all tiles of a signature as if they had own vertices.
  void mark_as_own(unsigned signature) noexcept { entries_[signature] |= kOwnFlag; }
  /// Whether there are more keys than signatures.
  [[nodiscard]] bool has_variants() const noexcept { return entries_.size() > std::size_t{1} << (1u << table_->dim); }
  /// Indexed by signature; in 2D by key; in 3D with variants by variant_places()[signature] + variant.
  [[nodiscard]] const std::uint32_t* entries() const noexcept { return entries_.data(); }
  [[nodiscard]] const VariantPlaces& variant_places() const noexcept { return variant_places_; }
  [[nodiscard]] std::uint32_t entry(unsigned key) const noexcept {
    return entries_[variants_.empty() ? key : variant_places_[CubeKey(key).signature()] + CubeKey(key).variant()];
  }
  /// The cube of an entry of tables::ResolvedTable. `choice`: facets::Choice of its centre, if that matters.
  [[nodiscard]] const Variant& variant(unsigned resolved, unsigned choice) const noexcept {
    return variants_[4 * resolved + choice];
  }
  /// `dim` local vertices per simplex.
  [[nodiscard]] const std::uint8_t* simplices() const noexcept { return simplices_; }
  /// dim = 2: byte shuffle of a tile's four vertex numbers that yields two segments, by signature. If the tile has only
  /// one segment, the second is undefined. `flip`: orientation opposite to the table's.
  [[nodiscard]] const std::uint8_t* segment_bytes(unsigned signature, bool flip) const noexcept {
    return segment_bytes_[flip ? 1 : 0][signature].data();
  }
  /// dim <= 3: number of simplices by signature.
  [[nodiscard]] const std::uint8_t* counts() const noexcept { return counts_.data(); }
  /// Whether any tile has own vertices.
  [[nodiscard]] bool has_own_vertices() const noexcept { return table_->max_tile_vertices != 0; }
  /// Number of vertices that the tile owns.
  [[nodiscard]] unsigned own_vertices(unsigned signature) const noexcept {
    const tables::List& list = table_->lists[table_->list_of[signature]];
    return unsigned{list.cone_vertices} + list.side_vertices;
  }

 private:
  void choose_segment_bytes();
  [[nodiscard]] std::uint32_t entry_of_list(unsigned key) const;
  void count_simplices();

  const tables::TileTable* table_;
  std::vector<std::uint32_t> entries_;
  const std::uint8_t* simplices_;
  VariantPlaces variant_places_{};
  std::vector<Variant> variants_;
  std::array<std::uint8_t, 256> counts_{};
  std::array<std::array<std::array<std::uint8_t, 16>, 32>, 2> segment_bytes_{};
};

/// The active tiles of a row, in order.
struct RowTiles {
  const std::uint16_t* signatures = nullptr;  ///< or keys (cube_key.hpp)
  const std::uint16_t* at = nullptr;          ///< positions along the row, modulo 2^16
  std::uint32_t count = 0;
};

/// A row of tiles to be counted.
struct TileRow {
  std::array<const Word*, 8> corners;  ///< the 2^(N-1) rows of samples around the tiles
  std::size_t tiles;                   ///< along the row
  const Word* valid;                   ///< null: all tiles are valid
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
inline constexpr std::size_t kMostListed = std::size_t{1} << 16;
struct TileEdges {
  const std::uint16_t* signatures;
  const std::uint16_t* at;
  std::size_t active;
  /// By axis, in the order of TileCount::edges: destination of the positions of the edges' first samples, ascending. Up
  /// to 16 entries past the end are overwritten.
  std::array<std::uint32_t*, 4> out;
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
/// its edges. Returns the destination of the next simplex.
template <int N>
struct OwnTiles {
  using Simplex = std::array<Index, N>;
  Simplex* (*write)(void* self, unsigned signature, std::size_t ordinal, const Index* ids, Simplex* out);
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
