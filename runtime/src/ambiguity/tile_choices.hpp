// SPDX-License-Identifier: BSD-3-Clause
//
// Choices from the data for the faces of a built tile (built_tile.hpp): one for each face that is ambiguous.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ambiguity/face_estimator.hpp"
#include "tile/built_tile.hpp"
#include "tile/grid_cells.hpp"

namespace tegl::detail {

/// Determines the choices by an estimator. Thread safe.
template <int N>
class TileChoices {
 public:
  using Index = std::array<std::size_t, N>;

  /// `estimator` must outlive it.
  explicit TileChoices(const FaceEstimator<N>& estimator) : estimator_(estimator) {}

  /// Key of a cell based at `base`, with choices for its faces. From three dimensions on, it has no choice for the cell
  /// itself. The part of a cap outside the image is not ambiguous.
  [[nodiscard]] TileKey of_faces(CellKind<N> kind, const Index& base, std::uint64_t signature) const noexcept;
  /// Adds the choice for the tile itself.
  void choose_own(TileKey& key, const Index& base) const noexcept;

 private:
  [[nodiscard]] tile::Choice ask(CellKind<N> kind, const Index& base, unsigned face_base, unsigned axes) const noexcept;

  const FaceEstimator<N>& estimator_;
};

}  // namespace tegl::detail
