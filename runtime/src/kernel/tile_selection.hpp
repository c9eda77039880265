// SPDX-License-Identifier: BSD-3-Clause
//
// What an extraction looks at, where active tiles are known before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/extract_layers.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::detail {

/// Rows of samples by layer and chunk (kChunkRows), and, where it is not the image that says which tiles count, tiles.
///
/// If all active tiles are known and no sample is missing, rows of samples that no row with active tiles touches are
/// uniform: low or high all along. All of their tiles would be active otherwise. Neighbours in a layer that are both
/// untouched are alike for the same reason, so that one sample tells the state of many rows.
class TileSelection {
 public:
  /// Rows with active tiles. Precondition: the index is complete, and no value missing.
  template <int N>
  static TileSelection rows_of(const tegl::ActiveTiles<N>& active, double isovalue);
  /// The tiles that the index finds, and no others.
  template <int N>
  static TileSelection tiles_of(const tegl::ActiveTiles<N>& active, double isovalue);

  /// The rows of samples to be looked at in a chunk of a layer: bit i for its row i.
  [[nodiscard]] std::uint32_t rows(std::size_t layer, std::size_t chunk) const noexcept {
    return rows_[layer * chunks_ + chunk];
  }
  /// Whether the tiles selected are all that count: as if all others had missing corners.
  [[nodiscard]] bool only_these() const noexcept { return only_these_; }
  /// With only_these: the selected tiles in a chunk of rows of a slab, as Slab::valid.
  void write_valid(std::size_t slab, std::size_t chunk, std::size_t chunk_rows, std::size_t words,
                   std::vector<Word>& valid) const noexcept;

 private:
  template <int N>
  TileSelection(const tegl::ActiveTiles<N>& active, const TileRowSet& tile_rows);
  template <int N>
  void place_tiles(const tegl::ActiveTiles<N>& active, const std::vector<TileNumber>& tiles);

  struct Place {
    std::uint32_t row;  ///< of samples, from the chunk's first on
    std::uint32_t at;   ///< along the row
  };
  std::size_t chunks_;               ///< of a layer
  std::vector<std::uint32_t> rows_;  ///< by layer and chunk
  bool only_these_ = false;
  std::vector<std::size_t> first_;  ///< by slab and chunk, and the end: where its tiles are in places_
  std::vector<Place> places_;
};

}  // namespace tegl::detail
