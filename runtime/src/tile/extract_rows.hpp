// SPDX-License-Identifier: BSD-3-Clause
//
// The innermost loops of the extraction, compiled for several instruction sets of which the best is taken at run time.
// All of them give the same bytes.
//
// A tile's vertices get their numbers by running counters. A *stream* is a row of edges that one row of tiles touches:
// 2^(N-1) along the row, and for every other axis 2^(N-2), of which a tile has the edge at its own place and the one at
// the next. As every critical edge makes the tiles around it active, the counters move at active tiles alone, and how
// they move is known from the signature: no bit of a stream is looked at.
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

/// A resolved tile: its key, and how much more it has than the tile of its signature alone.
struct Variant {
  std::uint16_t key = 0;
  std::int8_t more_simplices = 0, more_own_vertices = 0;
};

/// Where the entries of each signature's variants begin, N = 3, if there are so many.
using VariantPlaces = std::array<std::uint16_t, 256>;

/// A tile table in the flat layout, ready for the loops.
class RowTable {
 public:
  /// Low bits of an entry: the number of simplices, then whether the tile has vertices of its own; above them, the
  /// first simplex.
  static constexpr unsigned kCountBits = 6;
  static constexpr std::uint32_t kCountMask = (1u << kCountBits) - 1;
  static constexpr std::uint32_t kOwnFlag = 1u << kCountBits;
  static constexpr unsigned kFirstShift = kCountBits + 1;

  /// Whether the loops can use a table: flat, and no larger than entries can say.
  static bool can_use(const tables::TileTable& table) noexcept;

  explicit RowTable(const tables::TileTable& table) : RowTable(table, std::size_t{1} << (1u << table.dim)) {}
  /// Of a table whose lists go by `keys` keys (variant_table.hpp). Where it says "signature", keys do as well.
  RowTable(const tables::TileTable& table, std::size_t keys);
  /// Of cubes: signature s has counts[s] keys, and entries stand one behind the other, as few of all possible keys are
  /// met. `variants`: what `variant` finds, four for each entry of tables::ResolvedTable.
  RowTable(const tables::TileTable& table, const std::array<unsigned, 256>& counts, std::vector<Variant> variants);

  /// Treats the tiles of a signature as if they had vertices of their own.
  void mark_as_own(unsigned signature) noexcept { entries_[signature] |= kOwnFlag; }
  /// Whether there are more keys than signatures.
  [[nodiscard]] bool has_variants() const noexcept { return entries_.size() > std::size_t{1} << (1u << table_->dim); }
  /// By signature; in 2D by key; in 3D, where there are variants, by variant_places()[signature] + variant.
  [[nodiscard]] const std::uint32_t* entries() const noexcept { return entries_.data(); }
  [[nodiscard]] const VariantPlaces& variant_places() const noexcept { return variant_places_; }
  [[nodiscard]] std::uint32_t entry(unsigned key) const noexcept {
    return entries_[variants_.empty() ? key : variant_places_[CubeKey(key).signature()] + CubeKey(key).variant()];
  }
  /// The cube of an entry of tables::ResolvedTable, with a choice of facets::Choice for its centre if that matters.
  [[nodiscard]] const Variant& variant(unsigned resolved, unsigned choice) const noexcept {
    return variants_[4 * resolved + choice];
  }
  /// dim local vertices each.
  [[nodiscard]] const std::uint8_t* simplices() const noexcept { return simplices_; }
  /// dim = 2: for each signature, which bytes of its edges' four vertex numbers make two segments (those of the second
  /// mean nothing where there is but one); in the order of the table, or against it.
  [[nodiscard]] const std::uint8_t* segment_bytes(unsigned signature, bool flip) const noexcept {
    return segment_bytes_[flip ? 1 : 0][signature].data();
  }
  /// dim <= 3: simplices by signature.
  [[nodiscard]] const std::uint8_t* counts() const noexcept { return counts_.data(); }
  /// Whether any tile has vertices of its own.
  [[nodiscard]] bool has_own_vertices() const noexcept { return table_->max_tile_vertices != 0; }
  /// The tile's own vertices.
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
  const std::uint16_t* at = nullptr;          ///< where they are along the row (modulo 2^16)
  std::uint32_t count = 0;
};

/// A row of tiles, to be counted.
struct TileRow {
  std::array<const Word*, 8> corners;  ///< the rows of samples around it, 2^(N-1) of them
  std::size_t tiles;                   ///< along the row
  const Word* valid;                   ///< null: all are
};

/// What is written of a row of tiles that is counted.
struct TileRoom {
  Word* active;  ///< bits: ceil(samples / 64) words, those past the end 0
  // Of active tiles, in order; up to 32 more are written behind.
  std::uint16_t* signatures;
  std::uint16_t* at;  ///< where they are along the row, modulo 2^16
};

/// What a row of tiles comes to.
struct TileCount {
  std::uint32_t active = 0;
  std::uint32_t own_vertices = 0;
  std::uint64_t simplices = 0;
  /// Critical edges that belong to the row, whatever is valid: by axis, but for the last of the samples of the upper
  /// layer; then along the last axis.
  std::array<std::uint32_t, 4> edges{};
};

/// Finds the active tiles of a row.
template <int N>
TileCount count_tile_row(const TileRow& row, const RowTable& table, const TileRoom& room) noexcept;

/// The active tiles of a row of at most kMostListed samples, from which its critical edges are to be listed.
inline constexpr std::size_t kMostListed = std::size_t{1} << 16;
struct TileEdges {
  const std::uint16_t* signatures;
  const std::uint16_t* at;
  std::size_t active;
  /// By axis, in the order of TileCount::edges: where the edges' first samples along the row go, ascending. Up to 16
  /// more are written behind.
  std::array<std::uint32_t*, 4> out;
};

/// Lists a row's critical edges, but for those at its last sample.
template <int N>
void list_tile_edges(const TileEdges& row) noexcept;

/// A row of tiles, to be written.
template <int N>
struct TileOutput {
  using Simplex = std::array<Index, N>;
  static constexpr unsigned kEdges = tables::edge_count(N);

  const std::uint16_t* signatures;  ///< or keys, if the table has them
  std::size_t active;
  std::array<Index, kEdges> first;  ///< by local edge: the first vertex of its stream
  bool flip;                        ///< against the orientation of the table
  Simplex* out;
};

/// What to do for a tile with vertices of its own: `ordinal` counts the active tiles of the row; `ids` are the numbers
/// of its edges' vertices. Returns where the next simplex goes.
template <int N>
struct OwnTiles {
  using Simplex = std::array<Index, N>;
  Simplex* (*write)(void* self, unsigned signature, std::size_t ordinal, const Index* ids, Simplex* out);
  void* self;
};

/// Writes the simplices of a row whose tiles are all valid, and whose neighbours are.
template <int N>
void write_tile_row(const TileOutput<N>& row, const RowTable& table, const OwnTiles<N>& own) noexcept;

/// Critical edges of a row: a ^ b, in `critical`, with the number of them before each word in `prefix`. b null: the
/// edges along the row, between a sample and the next. `valid` may be null. Returns how many there are.
std::uint32_t count_edge_row(const Word* a, const Word* b, std::size_t samples, const Word* valid, Word* critical,
                             std::uint32_t* prefix) noexcept;

/// The local edges at the next place of their stream: displaced along axis 0 and not along it.
template <int N>
constexpr std::uint32_t next_edges() noexcept {
  std::uint32_t edges = 0;
  for (unsigned e = 0; e < tables::edge_count(N); ++e)
    if (e >> (N - 1) != 0 && (edge_base(N, e) & 1u) != 0) edges |= 1u << e;
  return edges;
}

}  // namespace tegl::detail
