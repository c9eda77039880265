// SPDX-License-Identifier: BSD-3-Clause
//
// Selection of rows or tiles that an extraction processes, if active tiles are known from an index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/extract_layers.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::detail {

/// Selected rows of samples by layer and chunk (kChunkRows); optionally the selected tiles themselves.
///
/// If the index is complete and no sample is missing, a row of samples that no active tile touches is uniform (all low
/// or all high), because otherwise one of its tiles would be active. For the same reason two untouched adjacent rows of
/// a layer have the same state. One sample therefore determines the state of many rows.
class TileSelection {
 public:
  /// Selects the rows with active tiles. Requires a complete index and no missing value.
  template <int N>
  static TileSelection rows_of(const tegl::ActiveTiles<N>& active, double isovalue);
  /// Selects exactly the tiles that the index finds.
  template <int N>
  static TileSelection tiles_of(const tegl::ActiveTiles<N>& active, double isovalue);

  /// Selected rows of samples in a chunk of a layer: bit i for row i of the chunk.
  [[nodiscard]] std::uint32_t rows(std::size_t layer, std::size_t chunk) const noexcept {
    return rows_[layer * chunks_ + chunk];
  }
  /// Whether only the selected tiles count, as if all others had missing corners.
  [[nodiscard]] bool only_these() const noexcept { return only_these_; }
  /// Writes the selected tiles in a chunk of rows of a slab, in the format of Slab::valid. Requires only_these().
  void write_valid(std::size_t slab, std::size_t chunk, std::size_t chunk_rows, std::size_t words,
                   std::vector<Word>& valid) const noexcept;

 private:
  template <int N>
  TileSelection(const tegl::ActiveTiles<N>& active, const TileRowSet& tile_rows);
  template <int N>
  void place_tiles(const tegl::ActiveTiles<N>& active, const std::vector<TileNumber>& tiles);

  struct Place {
    std::uint32_t row;  ///< row of samples, relative to the chunk's first
    std::uint32_t at;   ///< position along the row
  };
  std::size_t chunks_;               ///< chunks per layer
  std::vector<std::uint32_t> rows_;  ///< by layer and chunk
  bool only_these_ = false;
  std::vector<std::size_t> first_;  ///< by slab and chunk, with an end: first of its tiles in places_
  std::vector<Place> places_;
};

}  // namespace tegl::detail
