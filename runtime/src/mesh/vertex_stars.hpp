// SPDX-License-Identifier: BSD-3-Clause
//
// Vertex stars: for each vertex of a complex, the simplices around it.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "tegl/contour.hpp"

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
/// omitted.
struct Stars {
  std::vector<std::size_t> first;  ///< #V + 1
  Buffer<Index> members;

  [[nodiscard]] std::span<const Index> of(std::size_t v) const noexcept {
    return std::span(members).subspan(first[v], first[v + 1] - first[v]);
  }
};

/// Stars of a complex of simplices with Width vertices each. All vertex numbers must be below `vertex_count`. `rows`:
/// #S x Width, row = simplex.
template <int Width>
Stars make_stars(std::span<const Index> rows, std::size_t vertex_count, const Progress& progress = {}) {
  const std::size_t count = rows.size() / Width;
  Stars stars;
  stars.first.assign(vertex_count + 2, 0);  // counts are two places up, so that filling turns them into offsets
  // count by vertex
  in_parts(count, part_of(progress, 0.0, 0.4), [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s) {
      const Index* const row = rows.data() + s * Width;
      if (is_collapsed<Width>(row)) continue;
      for (int i = 0; i < Width; ++i) ++stars.first[row[i] + std::size_t{2}];
    }
  });
  // prefix sum
  std::partial_sum(stars.first.begin(), stars.first.end(), stars.first.begin());
  stars.members.resize(stars.first.back());
  // write
  in_parts(count, part_of(progress, 0.4, 1.0), [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s) {
      const Index* const row = rows.data() + s * Width;
      if (is_collapsed<Width>(row)) continue;
      for (int i = 0; i < Width; ++i) stars.members[stars.first[row[i] + std::size_t{1}]++] = static_cast<Index>(s);
    }
  });
  stars.first.pop_back();
  return stars;
}

}  // namespace tegl::detail
