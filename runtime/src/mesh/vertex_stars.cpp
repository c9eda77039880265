// SPDX-License-Identifier: BSD-3-Clause
//
// Vertex stars by counting: two passes over the simplices.
#include "mesh/vertex_stars.hpp"

#include <algorithm>
#include <numeric>

#include "base/progress.hpp"
#include "base/workers.hpp"

namespace tegl::detail {

namespace {

/// Calls visit(vertex, simplex) for the corners from `first_vertex` to `end_vertex` - 1, simplices ascending. Leaves
/// out simplices that repeat a vertex.
template <int Width, class Visit>
void for_corners(std::span<const Index> rows, Index first_vertex, Index end_vertex, LoopProgress& done,
                 const Visit& visit) {
  constexpr std::size_t kAtOnce = std::size_t{1} << 16;
  const std::size_t count = rows.size() / Width;
  const Index size = end_vertex - first_vertex;
  for (std::size_t from = 0; from < count && !done.stopped(); from += kAtOnce) {
    const std::size_t to = std::min(count, from + kAtOnce);
    for (std::size_t s = from; s < to; ++s) {
      const Index* const row = rows.data() + s * Width;
      bool is_here = false;
      for (int i = 0; i < Width; ++i) is_here = is_here || row[i] - first_vertex < size;
      if (!is_here || is_collapsed<Width>(row)) continue;
      for (int i = 0; i < Width; ++i)
        if (row[i] - first_vertex < size) visit(row[i], static_cast<Index>(s));
    }
    done.add(to - from);
  }
}

}  // namespace

template <int Width>
Stars make_stars(std::span<const Index> rows, std::size_t vertex_count, unsigned threads, const Progress& progress) {
  // Each thread reads all simplices, and writes the stars of its own vertices.
  constexpr std::size_t kMostThreads = 8;
  constexpr std::size_t kFew = std::size_t{1} << 14;
  const std::size_t parts =
      rows.size() < kFew ? 1 : std::min(kMostThreads, Workers<int>(threads, [] { return 0; }).count());
  const auto first_of = [&](std::size_t part) { return static_cast<Index>(vertex_count * part / parts); };
  const auto in_threads = [&](const Progress& of_pass, const auto& visit) {
    LoopProgress done(of_pass, parts * (rows.size() / Width));
    for_each_block(parts, 1, static_cast<unsigned>(parts), {}, [&](std::size_t part, std::size_t, std::size_t) {
      for_corners<Width>(rows, first_of(part), first_of(part + 1), done, visit);
    });
    done.finish();
  };
  Stars stars;
  stars.first.assign(vertex_count + 2, 0);  // counts are two places up, so that filling turns them into offsets
  // count by vertex
  in_threads(part_of(progress, 0.0, 0.4), [&](Index v, Index) { ++stars.first[v + std::size_t{2}]; });
  // prefix sum
  std::partial_sum(stars.first.begin(), stars.first.end(), stars.first.begin());
  stars.members.resize(stars.first.back() + Stars::kPadding);
  std::fill(stars.members.end() - Stars::kPadding, stars.members.end(), Index{0});
  // write
  in_threads(part_of(progress, 0.4, 1.0),
             [&](Index v, Index s) { stars.members[stars.first[v + std::size_t{1}]++] = s; });
  stars.first.pop_back();
  return stars;
}

template Stars make_stars<2>(std::span<const Index>, std::size_t, unsigned, const Progress&);
template Stars make_stars<3>(std::span<const Index>, std::size_t, unsigned, const Progress&);
template Stars make_stars<4>(std::span<const Index>, std::size_t, unsigned, const Progress&);
template Stars make_stars<5>(std::span<const Index>, std::size_t, unsigned, const Progress&);

}  // namespace tegl::detail
