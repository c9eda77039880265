// SPDX-License-Identifier: BSD-3-Clause
//
// Active cells of a row of samples on a lattice and their simplices, compiled for several instruction sets.
//
// 64 cells are compared at a time. A cell's signature is one bit of each of its corners' words, and the numbers of its
// vertices are sums over the words of its edges' crossings. So registers with a lane per corner or edge give them
// without branches: which edges of a cell are crossed is hard to predict.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"
#include "lattice/lattice_pattern.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The cells of one kind of a row of samples.
struct LatticeCellRow {
  static constexpr std::size_t kMostCorners = 16;
  const LatticeCell* cell;
  /// The words of the cells' samples. The word before the first one of each row and the one after its last one are 0.
  const Word* bits;
  /// By corner: the words from `bits` to the first one with the corners of 64 cells, of which LatticeCell::shifts bits
  /// belong to cells before.
  const std::ptrdiff_t* corners;
  std::size_t words;
  std::ptrdiff_t first, end;  ///< the samples that have the cell: from `first` on, before `end`
};

/// How many cells of a row are active, and how many simplices and own vertices they have.
struct LatticeCellCount {
  std::uint32_t active = 0, simplices = 0, own = 0;
};

/// The stream of bits in which the numbers of vertices on one edge of a cell are found.
struct EdgeStream {
  const Word* bits = nullptr;             ///< the crossed edges of the samples of a row
  const std::uint32_t* before = nullptr;  ///< by word: number of the first vertex, relative to the row's
  Index first = 0;                        ///< number of the row's first vertex
  std::ptrdiff_t at = 0;                  ///< of the edge's sample, relative to the cell's: -1, 0 or 1
};

/// An active cell of a row.
struct ActiveInRow {
  std::uint32_t at;  ///< along the row
  std::uint32_t signature;
};

/// Lists the active cells in order: at most 64 for each word. Returns their number.
std::size_t list_cells(const LatticeCellRow& row, ActiveInRow* out) noexcept;

/// Marks the signatures of active cells, and counts these. `occurs`: by signature.
std::uint32_t mark_signatures(const LatticeCellRow& row, std::atomic<bool>* occurs) noexcept;

/// Counts active cells, whose contours are known.
LatticeCellCount count_cells(const LatticeCellRow& row) noexcept;

/// Writes the simplices of active cells from `out` on; returns the end. `streams`: by edge. `own`: number of the first
/// own vertex; afterwards of the next one. Up to 15 numbers after the end are overwritten, but none from `end` on.
std::array<Index, 2>* write_simplices(const LatticeCellRow& row, const EdgeStream* streams, Index& own,
                                      std::array<Index, 2>* out, std::array<Index, 2>* end) noexcept;
std::array<Index, 3>* write_simplices(const LatticeCellRow& row, const EdgeStream* streams, Index& own,
                                      std::array<Index, 3>* out, std::array<Index, 3>* end) noexcept;
std::array<Index, 4>* write_simplices(const LatticeCellRow& row, const EdgeStream* streams, Index& own,
                                      std::array<Index, 4>* out, std::array<Index, 4>* end) noexcept;

}  // namespace tegl::detail
