// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of the contour's points on the edges of a complex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "complex/active_cells.hpp"
#include "complex/complex_edges.hpp"

namespace tegl::detail {

/// Points are numbered in the order of their edges: by the smaller end, then by the larger. If the edges of the complex
/// are known, each crossed edge has a bit and its number is a count of bits; otherwise the crossed edges of all active
/// cells are sorted. Both give the same numbers.
class CrossingNumbers {
 public:
  /// The arguments must outlive this object. `edges`: null if not known. Errors: TooLarge (2^32 points or more),
  /// Cancelled.
  CrossingNumbers(const CellGroups& cells, const CellTables& tables, const std::vector<ActiveBlock>& blocks,
                  const ComplexEdges* edges, std::size_t points, const WorkOptions& work);

  /// The crossed edges, by number.
  [[nodiscard]] const std::vector<EdgeEnds>& ends() const noexcept {
    return edges_ == nullptr ? sorted_.ends() : ends_;
  }

  /// The numbers of the points on the crossed edges of a cell of block `b`, by edge. `crossing`: number of crossings in
  /// the block's cells before, 0 for the first; increased by those of this cell.
  void of_cell(std::size_t b, const ActiveCell& cell, std::size_t& crossing, Index* numbers) const noexcept;

 private:
  /// 64 edges: which are crossed, and how many before them are. Together, so that a look-up meets one cache line.
  struct EdgeWord {
    std::uint64_t crossed = 0;
    std::uint64_t before = 0;
  };

  void count_bits(const WorkOptions& work);

  const CellGroups& cells_;
  const CellTables& tables_;
  const std::vector<ActiveBlock>& blocks_;
  const ComplexEdges* edges_;
  SortedEdges sorted_;          ///< edges not known: the crossed ones
  std::vector<EdgeEnds> ends_;  ///< edges known: the crossed ones
  /// edges known: the crossed ones of each block's cells, so that the numbers of all edges are read once only
  std::vector<std::vector<Index>> of_blocks_;
  std::vector<EdgeWord> words_;  ///< edges known: which are crossed
};

/// Throws TooLarge if there are more vertices than Index can number.
void require_numbers(std::uint64_t vertices);

/// Sums before each block of one of its sizes, and the sum of all at the end.
[[nodiscard]] std::vector<std::uint64_t> sums_before(const std::vector<ActiveBlock>& blocks,
                                                     std::uint64_t ActiveBlock::*size);

}  // namespace tegl::detail
