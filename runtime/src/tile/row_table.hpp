// SPDX-License-Identifier: BSD-3-Clause
//
// A tile table in the form that the inner loops of the extraction read, and the active tiles of a row.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegl/table_contract.hpp"
#include "tile/cube_key.hpp"

namespace tegl::detail {

/// Limit on the samples of a row whose active tiles are listed by 16-bit positions.
inline constexpr std::size_t kMostListed = std::size_t{1} << 16;

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
  /// Indexed by signature; in 2D by key; in 3D with variants by place_of(key).
  [[nodiscard]] const std::uint32_t* entries() const noexcept { return entries_.data(); }
  [[nodiscard]] std::uint32_t place_of(CubeKey key) const noexcept {
    return variant_places_[key.signature()] + key.variant();
  }
  [[nodiscard]] std::uint32_t entry(unsigned key) const noexcept {
    return entries_[variants_.empty() ? key : place_of(CubeKey(key))];
  }
  /// The cube of an entry of tables::ResolvedTable. `choice`: tile::Choice of its centre, if that matters.
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

}  // namespace tegl::detail
