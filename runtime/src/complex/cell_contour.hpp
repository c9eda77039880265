// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of one cell: its list in the table, moved by the symmetry of its signature.
#pragma once

#include <bit>
#include <cstdint>

#include "tegl/cell_contract.hpp"

namespace tegl::detail {

/// The list of a cell. For the high-connected alternative it is the list of the complement, reversed.
class CellContour {
 public:
  CellContour(const tables::CellTable& table, unsigned signature, bool high_connected) noexcept
      : table_(&table), reverses_(high_connected) {
    const unsigned s = high_connected ? ~signature & ((1u << table.corner_count) - 1) : signature;
    list_ = table.lists + table.list_of[s];
    if (table.element_of == nullptr) return;
    const unsigned element = table.element_of[s];
    permutation_ = table.permutations + element * table.permutation_stride;
    reverses_ = reverses_ != (table.reverses[element] != 0);
  }
  /// A list of a table without symmetries.
  CellContour(const tables::CellTable& table, const tables::CellList& list) noexcept
      : table_(&table), list_(&list), reverses_(false) {}

  [[nodiscard]] const tables::CellList& list() const noexcept { return *list_; }
  /// Whether the last two vertices of each simplex are exchanged.
  [[nodiscard]] bool reverses() const noexcept { return reverses_; }
  /// Vertex k of simplex i: an edge of the cell, or edge_count + number of an added vertex.
  [[nodiscard]] unsigned vertex(unsigned i, unsigned k) const noexcept {
    const unsigned v = table_->simplices[(list_->first_simplex + i) * table_->dim + k];
    return permutation_ == nullptr || v >= table_->edge_count ? v : permutation_[table_->corner_count + v];
  }
  /// The corners (bit v) and edges (bit corner_count + e) of an added vertex.
  [[nodiscard]] std::uint64_t mask(unsigned added) const noexcept {
    std::uint64_t mask = table_->masks[list_->first_mask + added];
    if (permutation_ == nullptr) return mask;
    std::uint64_t result = 0;
    for (; mask != 0; mask &= mask - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(mask));
      const unsigned shift = bit < table_->corner_count ? 0 : table_->corner_count;
      result |= std::uint64_t{1} << (permutation_[bit] + shift);
    }
    return result;
  }

 private:
  const tables::CellTable* table_;
  const tables::CellList* list_;
  const std::uint8_t* permutation_ = nullptr;
  bool reverses_;
};

/// The edges of a cell whose ends differ, bit e = edge e.
[[nodiscard]] inline std::uint32_t crossed_edges(const tables::CellTable& table, unsigned signature) noexcept {
  std::uint32_t result = 0;
  for (std::uint32_t e = 0; e < table.edge_count; ++e)
    result |= ((signature >> table.edges[2 * e] ^ signature >> table.edges[2 * e + 1]) & 1u) << e;
  return result;
}

}  // namespace tegl::detail
