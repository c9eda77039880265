// SPDX-License-Identifier: BSD-3-Clause
//
// The cells of staggered lattices by numbers of samples.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "tegl/complex.hpp"
#include "tegl/lattice.hpp"

namespace tegl::detail {

/// Cells of a lattice: their types, and the corners of all cells one after the other.
struct LatticeCells {
  std::vector<CellType> types;
  std::vector<Index> corners;
};

inline constexpr std::array<std::size_t, 2> kAllLayers = {0, std::numeric_limits<std::size_t>::max()};

/// The cells of `lattice` (not fcc_in_time) over an array of these sizes, axis 0 fastest. `margin`: samples at both
/// ends of each axis that have no cells of their own, but may be corners of others. `layers`: only cells of samples in
/// the layers from the first to the one before the second.
[[nodiscard]] LatticeCells cells_of_lattice(Lattice lattice, const std::array<std::size_t, 4>& sizes,
                                            const std::array<std::size_t, 4>& margin = {},
                                            const std::array<std::size_t, 2>& layers = kAllLayers);

/// Indices of a sample, or their differences.
using LatticePlace = std::array<std::ptrdiff_t, 4>;

/// A cell of each sample in layers of one parity.
struct PatternCell {
  CellType type;
  int parity;                         ///< of the sample's layer: 0 even, 1 odd
  bool at_ends;                       ///< only of samples in the first and last layer: pyramids of fcc
  std::vector<LatticePlace> corners;  ///< relative to the sample, in the order of the type
};

/// The cells of `lattice` (not fcc_in_time) by sample.
[[nodiscard]] std::vector<PatternCell> pattern_of_lattice(Lattice lattice);

/// The differences to the neighbours of samples in even and in odd layers: 6 (triangular), 12 (fcc), 14 (bcc), 24 (d4).
[[nodiscard]] std::array<std::vector<LatticePlace>, 2> neighbours_of_lattice(Lattice lattice);

}  // namespace tegl::detail
