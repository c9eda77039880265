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
  [[nodiscard]] const std::vector<EdgeEnds>& ends() const noexcept { return ends_; }

  /// The numbers of the points on the crossed edges of a cell, by edge. `first`: number of crossings in the cells of
  /// all blocks before this one.
  void of_cell(const ActiveBlock& block, const ActiveCell& cell, std::uint32_t crossed, std::uint64_t first,
               Index* numbers) const noexcept;

 private:
  void sort_crossings(const CellGroups& cells, const CellTables& tables, const std::vector<ActiveBlock>& blocks,
                      std::size_t points, const WorkOptions& work);
  void count_bits(const CellTables& tables, const std::vector<ActiveBlock>& blocks, const WorkOptions& work);

  const CellTables& tables_;
  const ComplexEdges* edges_;
  std::vector<EdgeEnds> ends_;
  std::vector<Index> numbers_;         ///< edges not known: by crossing, counted in each cell
  std::vector<std::uint64_t> bits_;    ///< edges known: crossed edges
  std::vector<std::uint64_t> before_;  ///< edges known: number of crossed edges before each word
};

/// Throws TooLarge if there are more vertices than Index can number.
void require_numbers(std::uint64_t vertices);

/// Sums before each block of one of its sizes, and the sum of all at the end.
[[nodiscard]] std::vector<std::uint64_t> sums_before(const std::vector<ActiveBlock>& blocks,
                                                     std::uint64_t ActiveBlock::*size);

}  // namespace tegl::detail
