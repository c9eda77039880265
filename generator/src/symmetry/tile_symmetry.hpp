// SPDX-License-Identifier: BSD-3-Clause
//
// The symmetries of any tile from their definition: the permutations of its corners that carry faces to faces. Counting
// and enumeration of classes for them. For cubes symmetry.hpp knows the same group by its structure, for every
// dimension; the two are held against each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/lattice.hpp"
#include "base/wide_uint.hpp"
#include "symmetry/symmetry.hpp"
#include "symmetry/transversal.hpp"

namespace tegl::gen {

/// A symmetry of a tile, by what it does to the corners.
struct TileSymmetry {
  std::vector<std::uint32_t> corner;  ///< the images of the corners
  int det = 1;                        ///< -1 for one that reverses the orientation of space
  bool inverts = false;               ///< also exchanges high and low
};

/// All of them, in ascending order of (inverts, images): the identity is the first. A search with the edges to cut it
/// short: immediate for every tile of up to four dimensions.
[[nodiscard]] std::vector<TileSymmetry> symmetries(const Tile& tile, GroupKind kind, bool inversion);

/// The number of orbits by Burnside's lemma, from the cycles of each permutation.
[[nodiscard]] WideUint burnside_orbits(std::span<const TileSymmetry> group);

/// The orbits of the 2^corners signatures of a tile of at most 16 corners. Errors: as transversal(n, group).
[[nodiscard]] Transversal transversal(const Tile& tile, std::span<const TileSymmetry> group);

/// Counts the classes a second time, by Burnside's lemma. Errors: CountMismatch if the two numbers differ.
void require_burnside_count(const Transversal& classes, std::span<const TileSymmetry> group);

}  // namespace tegl::gen
