// SPDX-License-Identifier: BSD-3-Clause
//
// The edges of a complex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "complex/cell_groups.hpp"
#include "complex/sorted_edges.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// The points of 64 consecutive cells of a group, as bits of the words of PointBits: if all of them are high, or none,
/// no cell is active. Meshes number near points alike, so that these are a few words.
struct CellBlocks {
  static constexpr std::size_t kCells = 64;
  struct Word {
    Index word;          ///< points 32 word ... 32 word + 31
    std::uint32_t mask;  ///< those that are corners
  };
  std::vector<std::size_t> first = {0};  ///< by block, and the end
  std::vector<Word> words;

  /// Whether all points of a block have equal bits.
  [[nodiscard]] bool is_uniform(std::size_t block, const std::uint32_t* bits) const noexcept {
    std::uint32_t any_set = 0, any_clear = 0;
    for (std::size_t i = first[block]; i < first[block + 1]; ++i) {
      any_set |= bits[words[i].word] & words[i].mask;
      any_clear |= ~bits[words[i].word] & words[i].mask;
    }
    return any_set == 0 || any_clear == 0;
  }
};

/// All edges of a complex, and the edges of each cell.
struct ComplexEdges {
  std::vector<EdgeEnds> ends;                ///< ascending, without duplicates
  std::vector<std::vector<Index>> of_cells;  ///< by group: #cells x (edges of the shape), numbers of edges
  std::vector<CellBlocks> blocks;            ///< by group
};

/// Finds the edges. Errors: TooLarge (2^32 edges or more), Cancelled.
[[nodiscard]] ComplexEdges find_complex_edges(std::size_t points, const CellGroups& cells, const WorkOptions& work);

}  // namespace tegl::detail
