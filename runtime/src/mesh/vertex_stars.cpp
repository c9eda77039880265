// SPDX-License-Identifier: BSD-3-Clause
//
// Vertex stars by counting: two passes over the simplices.
#include "mesh/vertex_stars.hpp"

#include <numeric>

#include "base/progress.hpp"

namespace tegl::detail {

template <int Width>
Stars make_stars(std::span<const Index> rows, std::size_t vertex_count, const Progress& progress) {
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

template Stars make_stars<2>(std::span<const Index>, std::size_t, const Progress&);
template Stars make_stars<3>(std::span<const Index>, std::size_t, const Progress&);
template Stars make_stars<4>(std::span<const Index>, std::size_t, const Progress&);
template Stars make_stars<5>(std::span<const Index>, std::size_t, const Progress&);

}  // namespace tegl::detail
