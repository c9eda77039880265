// SPDX-License-Identifier: BSD-3-Clause
//
// Decodes a signature's contour from a table. Written from the text of the table contract only, independently of the
// runtime and the emitters.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "filling/facets.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

struct Decoded {
  std::vector<LocalSimplex> simplices;
  std::uint32_t cones = 0;
  std::vector<std::uint64_t> masks;

  friend bool operator==(const Decoded&, const Decoded&) = default;
};

inline Decoded decode(const tables::TileTable& table, Signature s) {
  const std::uint32_t n = table.dim, corners = 1u << n, edges = tables::edge_count(n);
  const tables::List& list = table.lists[table.list_of[s]];
  const std::uint8_t* row =
      table.element_of ? table.permutations + std::size_t{table.element_of[s]} * table.permutation_stride : nullptr;
  Decoded result;
  result.cones = list.cone_vertices;
  for (std::uint32_t i = 0; i < list.simplex_count; ++i) {
    LocalSimplex simplex{};
    for (std::uint32_t k = 0; k < n; ++k) {
      std::uint8_t v = table.simplices[(std::size_t{list.first_simplex} + i) * n + k];
      if (row && v < tables::first_tile_vertex(n)) {
        v = row[corners + v];
        if (v >= edges && ((table.slot_swaps[s] >> ((v - edges) / tables::kFaceSlots)) & 1u) != 0)
          v = static_cast<std::uint8_t>(edges + ((v - edges) ^ 1u));
      }
      simplex[k] = v;
    }
    if (row && table.reverses[table.element_of[s]] != 0) std::swap(simplex[n - 1], simplex[n - 2]);
    result.simplices.push_back(simplex);
  }
  for (std::uint32_t k = 0; k < list.side_vertices; ++k) {
    const std::uint64_t mask = table.side_masks[list.first_side + k];
    std::uint64_t image = 0;
    for (std::uint32_t b = 0; b < corners + edges; ++b)
      if (((mask >> b) & 1u) != 0) {
        const std::uint32_t to = !row ? b : b < corners ? row[b] : corners + row[b];
        image |= std::uint64_t{1} << to;
      }
    result.masks.push_back(image);
  }
  return result;
}

}  // namespace tegl::gen
