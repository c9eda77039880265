// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of the contour's points on the edges of a complex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "complex/active_cells.hpp"
#include "complex/complex_edges.hpp"
#include "polytope/polytope_contours.hpp"

namespace tegl::detail {

/// Points are numbered in the order of their edges: by the smaller end, then by the larger. If the edges of the complex
/// are known, each crossed edge has a bit and its number is a count of bits; otherwise the crossed edges of each block
/// of active cells are collected, and the edges of all blocks sorted. Both give the same numbers.
class CrossingNumbers {
 public:
  /// The arguments must outlive this object. `edges`: null if not known. `polytopes`: receive the numbers of their
  /// edges. Errors: TooLarge (2^32 points or more), Cancelled.
  CrossingNumbers(const CellGroups& cells, const CellTables& tables, const std::vector<ActiveBlock>& blocks,
                  std::vector<PolytopeBlock>& polytopes, const ComplexEdges* edges, std::size_t points,
                  const WorkOptions& work);

  /// The crossed edges, by number.
  [[nodiscard]] const std::vector<EdgeEnds>& ends() const noexcept { return ends_; }

  /// The numbers of the points on the crossed edges of all cells of block `b`: one cell after the other, by edge.
  [[nodiscard]] const Buffer<Index>& of_block(std::size_t b) const noexcept { return of_blocks_[b]; }
  /// Those of a cell, by edge. `crossing`: number of crossings in the block's cells before, 0 for the first; increased
  /// by those of this cell.
  void of_cell(std::size_t b, const ActiveCell& cell, std::size_t& crossing, Index* numbers) const noexcept {
    const Index* next = of_blocks_[b].data() + crossing;
    tables_.of_group[blocks_[b].group].for_each_crossed(cell.signature, [&](unsigned e) { numbers[e] = *next++; });
    crossing = static_cast<std::size_t>(next - of_blocks_[b].data());
  }

 private:
  void sort(std::size_t points, std::vector<PolytopeBlock>& polytopes, const WorkOptions& work);
  void count_bits(std::vector<PolytopeBlock>& polytopes, const WorkOptions& work);

  const CellGroups& cells_;
  const CellTables& tables_;
  const std::vector<ActiveBlock>& blocks_;
  const ComplexEdges* edges_;
  std::vector<EdgeEnds> ends_;
  std::vector<Buffer<Index>> of_blocks_;
};

/// Throws TooLarge if there are more vertices than Index can number.
void require_numbers(std::uint64_t vertices);

/// Sums before each block of one of its sizes, and the sum of all at the end.
[[nodiscard]] std::vector<std::uint64_t> sums_before(const std::vector<ActiveBlock>& blocks,
                                                     std::uint64_t ActiveBlock::*size);

}  // namespace tegl::detail
