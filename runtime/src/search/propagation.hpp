// SPDX-License-Identifier: BSD-3-Clause
//
// Propagation from active tiles to their active neighbours: breadth first, each layer in parallel.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/bitplanes.hpp"
#include "search/seed_graph.hpp"
#include "tegl/seed_set.hpp"

namespace tegl::detail {

/// Which neighbours are visited.
enum class FloodRule {
  active_neighbours,  ///< all that are active
  crossed_faces,      ///< those across a face that the contour crosses: tiles of the same contour components
};

/// Reads only the samples of the tiles that it visits. The image must outlive it.
template <Value T, int N>
class TileFlood {
 public:
  TileFlood(const Image<T, N>& image, double isovalue);

  [[nodiscard]] const TileGrid<N>& grid() const noexcept { return grid_; }
  /// The tile's high corners, bit v for corner v; 0 if a corner is missing.
  [[nodiscard]] std::uint32_t signature(TileNumber tile) const noexcept;
  [[nodiscard]] static bool is_active(std::uint32_t signature) noexcept {
    return signature != 0 && signature != kAllHigh;
  }
  /// All tiles reached from the active tiles `from`, which are included; each once, in no particular order. `stopped`:
  /// whether propagation met an inactive tile of the image; with `crossed_faces` such a tile has a missing corner.
  /// Errors: Cancelled.
  [[nodiscard]] std::vector<TileNumber> run(std::vector<TileNumber> from, FloodRule rule, Neighbourhood neighbourhood,
                                            unsigned threads, const Progress& progress, bool* stopped = nullptr) const;
  /// The tiles one step away from the active tiles, each once, in no particular order.
  [[nodiscard]] std::vector<TileNumber> beside(const std::vector<TileNumber>& tiles, FloodRule rule,
                                               Neighbourhood neighbourhood) const;

 private:
  using Index = typename TileGrid<N>::GridIndex;
  struct Move {
    std::array<std::int8_t, N> along;
    std::ptrdiff_t distance;  ///< in tile numbers
    std::uint32_t face;       ///< corners of the face that the move crosses
  };
  class Seen;
  struct Found {
    std::vector<TileNumber> tiles;
    bool stopped = false;
  };

  [[nodiscard]] std::vector<Move> moves(Neighbourhood neighbourhood) const;
  /// Adds the neighbours of the tile that were not seen before.
  void visit(TileNumber tile, const std::vector<Move>& moves, FloodRule rule, Seen& seen, Found& found) const;
  [[nodiscard]] std::uint32_t signature_at(const Index& index) const noexcept;

  static constexpr std::uint32_t kAllHigh = static_cast<std::uint32_t>((std::uint64_t{1} << (1u << N)) - 1);

  Image<T, N> image_;
  TileGrid<N> grid_;
  Threshold<T> threshold_;
  std::array<std::ptrdiff_t, 1u << N> corners_;  ///< from a tile's lowest sample, in elements
};

}  // namespace tegl::detail
