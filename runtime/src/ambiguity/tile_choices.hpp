// SPDX-License-Identifier: BSD-3-Clause
//
// Choices from the data for the faces of a built tile (built_tile.hpp): one for each face that is ambiguous.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "tile/built_tile.hpp"
#include "tile/grid_cells.hpp"

namespace tegl::detail {

/// Determines the choices by an estimator. Thread safe.
template <int N>
class TileChoices {
 public:
  using Index = std::array<std::size_t, N>;

  /// Both arguments must outlive it.
  TileChoices(const CubeFaces& cube, const FaceEstimator<N>& estimator);

  /// Key of a cell based at `base`, with choices for its faces. From three dimensions on, it has no choice for the cell
  /// itself. The part of a cap outside the image is not ambiguous.
  [[nodiscard]] TileKey of_faces(CellKind<N> kind, const Index& base, std::uint64_t signature) const noexcept;
  /// Adds the choice for the tile itself.
  void choose_own(TileKey& key, const Index& base) const noexcept;

 private:
  struct Face {
    std::uint8_t base, axes, dim;
    std::array<std::uint8_t, 16> corners{};
    std::array<std::uint16_t, 6> squares{};  ///< of a cube, in the order of tables::ResolvedTable
  };
  [[nodiscard]] bool is_open(const Face& face, unsigned signature, const TileKey& key) const noexcept;
  [[nodiscard]] tile::Choice ask(CellKind<N> kind, const Index& base, unsigned face_base, unsigned axes) const noexcept;

  const FaceEstimator<N>& estimator_;
  std::vector<Face> faces_;  ///< faces that have choices, except the tile
};

}  // namespace tegl::detail
