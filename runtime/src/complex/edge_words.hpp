// SPDX-License-Identifier: BSD-3-Clause
//
// Edges as bits, compiled for several instruction sets: without the processor's instructions, counting bits and picking
// crossed edges is slow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "complex/active_cells.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// 64 edges: which are crossed, and how many before them are. Together, so that a look-up meets one cache line.
struct EdgeWord {
  std::uint64_t crossed = 0;
  std::uint64_t before = 0;
};

/// How far list_crossed writes behind the last edge that it lists.
inline constexpr std::size_t kListedBeyond = 8;

/// Lists the crossed edges of active cells, one cell after the other, ascending in each. `cases`: of their shape.
/// `edges`: of all cells of the shape, one cell after the other.
void list_crossed(const CellCases& cases, std::span<const Index> edges, std::span<const ActiveCell> cells,
                  Index* listed) noexcept;

/// Sets the bits of edges. Other threads must not use the words meanwhile.
void set_crossed(EdgeWord* words, const Index* edges, std::size_t count) noexcept;

/// Counts the crossed edges before each word. Returns their number.
std::uint64_t count_before(std::vector<EdgeWord>& words) noexcept;

/// Replaces each of `count` edges, all crossed, by the number of crossed edges before it.
void number_edges(const EdgeWord* words, Index* edges, std::size_t count) noexcept;

}  // namespace tegl::detail
