// SPDX-License-Identifier: BSD-3-Clause
//
// Simplices of a row's active cells, compiled for several instruction sets: without the processor's instruction,
// counting bits takes most of the time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "lattice/lattice_rows.hpp"

namespace tegl::detail {

/// The streams of bits in which the numbers of vertices on one edge of a cell are found.
struct EdgeStream {
  LatticeRows::Crossed crossed{};
  Index first = 0;        ///< number of the row's first vertex
  std::ptrdiff_t at = 0;  ///< of the edge's sample, relative to the cell's
};

/// An active cell of a row.
struct ActiveInRow {
  std::uint32_t at;  ///< along the row
  std::uint32_t signature;
};

/// Writes the simplices of active cells without own vertices; returns the end.
std::array<Index, 2>* write_simplices(const LatticeCell& cell, const EdgeStream* streams,
                                      std::span<const ActiveInRow> active, std::array<Index, 2>* simplices) noexcept;
std::array<Index, 3>* write_simplices(const LatticeCell& cell, const EdgeStream* streams,
                                      std::span<const ActiveInRow> active, std::array<Index, 3>* simplices) noexcept;

}  // namespace tegl::detail
