// SPDX-License-Identifier: BSD-3-Clause
//
// Vertex stars: for each vertex of a complex, the simplices around it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Whether a simplex repeats a vertex and is therefore degenerate.
template <int Width>
bool is_collapsed(const Index* row) noexcept {
  for (int i = 0; i + 1 < Width; ++i)
    for (int j = i + 1; j < Width; ++j)
      if (row[i] == row[j]) return true;
  return false;
}

/// The simplices around each vertex: members[first[v] … first[v + 1]), ascending. Simplices that repeat a vertex are
/// omitted. kPadding members, 0, follow the last star, so that whole registers of members can be loaded.
struct Stars {
  static constexpr std::size_t kPadding = 128;

  std::vector<std::size_t> first;  ///< #V + 1
  Buffer<Index> members;

  [[nodiscard]] std::span<const Index> of(std::size_t v) const noexcept {
    return std::span(members).subspan(first[v], first[v + 1] - first[v]);
  }
};

/// Stars of a complex of simplices with Width vertices each. All vertex numbers must be below `vertex_count`. `rows`:
/// #S x Width, row = simplex. Threads: 0 for all of the machine; the result does not depend on them.
template <int Width>
Stars make_stars(std::span<const Index> rows, std::size_t vertex_count, unsigned threads,
                 const Progress& progress = {});

}  // namespace tegl::detail
