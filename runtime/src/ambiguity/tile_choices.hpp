// SPDX-License-Identifier: BSD-3-Clause
//
// What the data say about the faces of a tile that is built (built_tile.hpp): a choice for each face in which there is
// something to choose.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "tile/built_tile.hpp"
#include "tile/grid_cells.hpp"

namespace tegl::detail {

/// Thread safe, as the estimator is.
template <int N>
class TileChoices {
 public:
  using Index = std::array<std::size_t, N>;

  /// Both must outlive it.
  TileChoices(const CubeFaces& cube, const FaceEstimator<N>& estimator);

  /// The key of a cell based at `base`, with choices for its faces but, from three dimensions on, none for itself.
  /// What a cap has outside of the image is not ambiguous.
  [[nodiscard]] TileKey of_faces(CellKind<N> kind, const Index& base, std::uint64_t signature) const noexcept;
  /// With a choice for the tile itself.
  void choose_own(TileKey& key, const Index& base) const noexcept;

 private:
  struct Face {
    std::uint8_t base, axes, dim;
    std::array<std::uint8_t, 16> corners{};
    std::array<std::uint16_t, 6> squares{};  ///< of a cube, in the order of tables::ResolvedTable
  };
  [[nodiscard]] bool is_open(const Face& face, unsigned signature, const TileKey& key) const noexcept;
  [[nodiscard]] facets::Choice ask(CellKind<N> kind, const Index& base, unsigned face_base,
                                   unsigned axes) const noexcept;

  const FaceEstimator<N>& estimator_;
  std::vector<Face> faces_;  ///< those that there are choices for, but the tile
};

}  // namespace tegl::detail
