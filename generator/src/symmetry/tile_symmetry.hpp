// SPDX-License-Identifier: BSD-3-Clause
//
// The symmetries of any tile by definition: the permutations of its corners that map faces to faces. Counts and
// enumerates classes under them. symmetry.hpp derives the same group for cubes of every dimension from its structure;
// tests compare the two.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/lattice.hpp"
#include "base/wide_uint.hpp"
#include "symmetry/symmetry.hpp"
#include "symmetry/transversal.hpp"

namespace tegl::gen {

/// A symmetry of a tile, as a permutation of corners.
struct TileSymmetry {
  std::vector<std::uint32_t> corner;  ///< the images of the corners
  int det = 1;                        ///< -1 if it reverses the orientation of space
  bool inverts = false;               ///< also exchanges high and low

  /// True if it reverses the orientation of facets: it is either a reflection or an inversion, not both.
  [[nodiscard]] bool reverses_orientation() const noexcept { return (det < 0) != inverts; }
};

/// All symmetries in ascending order of (inverts, images); the identity is the first. A backtracking search pruned by
/// edges: immediate for every tile of up to four dimensions.
[[nodiscard]] std::vector<TileSymmetry> symmetries(const Tile& tile, GroupKind kind, bool inversion);

/// The number of orbits by Burnside's lemma, from the cycles of each permutation.
[[nodiscard]] WideUint burnside_orbits(std::span<const TileSymmetry> group);

/// The orbits of the 2^corners signatures of a tile. Errors: InvalidArgument for more than 16 corners; Internal as
/// orbits().
[[nodiscard]] Transversal transversal(const Tile& tile, std::span<const TileSymmetry> group);

/// Counts the classes again by Burnside's lemma. Errors: CountMismatch if the numbers differ.
void require_burnside_count(const Transversal& classes, std::span<const TileSymmetry> group);

/// The classes of a tile's signatures under its symmetries without inversion, computed once and passed on.
struct TileClasses {
  std::vector<TileSymmetry> symmetries;  ///< of cubes in the order of group(), as the tables number them
  Transversal classes;                   ///< `element_of`: indices into `symmetries`
};

/// Computes the classes and counts them again by Burnside's lemma. Errors: as transversal() and
/// require_burnside_count().
[[nodiscard]] TileClasses tile_classes(const Tile& tile, GroupKind kind = GroupKind::Full);

/// Every signature as a class of its own: the classes under the identity.
[[nodiscard]] TileClasses single_signatures(const Tile& tile);

}  // namespace tegl::gen
