// SPDX-License-Identifier: BSD-3-Clause
//
// Propagation from active tiles to their active neighbours: breadth first, each layer in parallel.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "image/bitplanes.hpp"
#include "search/seed_graph.hpp"
#include "tegl/seed_set.hpp"

namespace tegl::detail {

/// Which neighbours are visited.
enum class PropagationRule {
  active_neighbours,  ///< all that are active
  crossed_faces,      ///< those across a face that the contour crosses: tiles of the same contour components
};

/// Reads only the samples of the tiles that it visits. The image must outlive it.
class TilePropagation {
 public:
  template <Value T>
  TilePropagation(const SampleView<T>& samples, double isovalue);

  [[nodiscard]] const TileShape& grid() const noexcept { return grid_; }
  /// The tile's high corners, bit v for corner v; 0 if a corner is missing.
  [[nodiscard]] std::uint32_t signature(TileNumber tile) const noexcept;
  [[nodiscard]] bool is_active(std::uint32_t signature) const noexcept {
    return signature != 0 && signature != all_high_;
  }
  /// All tiles reached from the active tiles `from`, which are included; each once, in no particular order. `stopped`:
  /// whether propagation met an inactive tile of the image; with `crossed_faces` such a tile has a missing corner.
  /// Errors: Cancelled.
  [[nodiscard]] std::vector<TileNumber> run(std::vector<TileNumber> from, PropagationRule rule,
                                            Neighbourhood neighbourhood, unsigned threads, const Progress& progress,
                                            bool* stopped = nullptr) const;
  /// The tiles one step away from the active tiles, each once, in no particular order.
  [[nodiscard]] std::vector<TileNumber> beside(const std::vector<TileNumber>& tiles, PropagationRule rule,
                                               Neighbourhood neighbourhood) const;

 private:
  using Index = TileShape::Index;
  struct Move {
    Step along;
    std::ptrdiff_t distance;  ///< in tile numbers
    std::ptrdiff_t samples;   ///< distance in elements of the image
    std::uint32_t face;       ///< corners of the face that the move crosses
  };
  class Seen;
  struct Found {
    std::vector<TileNumber> tiles;
    bool stopped = false;
  };

  [[nodiscard]] std::vector<Move> moves(Neighbourhood neighbourhood) const;
  /// Adds the neighbours of the tile that were not seen before.
  void visit(TileNumber tile, const std::vector<Move>& moves, PropagationRule rule, Seen& seen, Found& found) const;
  /// Offset of the lowest sample of a tile, in elements of the image.
  [[nodiscard]] std::ptrdiff_t lowest(const Index& index) const noexcept;

  std::array<std::ptrdiff_t, kMostAxes> strides_;
  TileShape grid_;
  std::uint32_t all_high_;
  std::function<std::uint32_t(std::ptrdiff_t)> signature_at_;  ///< of the tile whose lowest sample has this offset
};

}  // namespace tegl::detail
