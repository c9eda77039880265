// SPDX-License-Identifier: BSD-3-Clause
//
// Parallel counts of faces and sums over simplices, compiled once for both types of coordinates.
#include "mesh/measure_pieces.hpp"

#include <algorithm>
#include <utility>

#include "base/workers.hpp"

namespace tegl::detail {

template <int N>
std::vector<PieceSums<N>> sum_groups(const SimplexView<N>& contour, const Groups& groups, unsigned threads,
                                     const Progress& progress) {
  const std::size_t count = groups.first.back();
  const auto reference_of = [&](std::size_t g) { return contour.corners(groups.member(groups.first[g]))[0]; };
  std::vector<std::vector<std::pair<std::size_t, PieceSums<N>>>> parts(block_count(count, kBlock));
  for_each_block(count, kBlock, threads, progress, [&](std::size_t block, std::size_t from, std::size_t to) {
    auto g = static_cast<std::size_t>(std::upper_bound(groups.first.begin(), groups.first.end(), from) -
                                      groups.first.begin()) -
             1;
    for (std::size_t i = from; i < to; ++g) {
      PieceSums<N> sums(reference_of(g));
      const std::size_t end = std::min(to, groups.first[g + 1]);
      for (; i < end; ++i) sums.add(contour.corners(groups.member(i)));
      parts[block].emplace_back(g, sums);
    }
  });
  std::vector<PieceSums<N>> result;
  for (std::size_t g = 0; g + 1 < groups.first.size(); ++g) result.emplace_back(reference_of(g));
  for (const auto& part : parts)
    for (const auto& [g, sums] : part) result[g].add(sums);
  return result;
}

template <int N>
std::vector<FaceCounts> count_faces(
    std::span<const Index> rows, const Stars& stars, std::span<const Index> labels, std::size_t label_count,
    bool with_euler, unsigned threads, const Progress& progress,
    FunctionRef<void(std::size_t block, const typename FacesOfStars<N>::Ridge& ridge)> on_open) {
  const std::size_t vertices = stars.first.size() - 1;
  std::vector<std::vector<std::pair<Index, FaceCounts>>> parts(block_count(vertices, kBlock));
  for_each_block(
      vertices, kBlock, threads, progress, [&] { return FacesOfStars<N>(rows.data(), with_euler); },
      [&](std::size_t block, std::size_t from, std::size_t to, FacesOfStars<N>& faces) {
        auto& part = parts[block];
        for (std::size_t v = from; v < to; ++v) {
          const std::span<const Index> star = stars.of(v);
          if (star.empty()) continue;
          const Index label = labels.empty() ? 0 : labels[v];
          if (part.empty() || part.back().first != label) part.emplace_back(label, FaceCounts{});
          part.back().second +=
              faces.visit(static_cast<Index>(v), star, [&](const auto& ridge) { on_open(block, ridge); });
        }
      });
  std::vector<FaceCounts> result(label_count);
  for (const auto& part : parts)
    for (const auto& [label, counts] : part) result[label] += counts;
  return result;
}

template std::vector<FaceCounts> count_faces<2>(std::span<const Index>, const Stars&, std::span<const Index>,
                                                std::size_t, bool, unsigned, const Progress&,
                                                FunctionRef<void(std::size_t, const FacesOfStars<2>::Ridge&)>);
template std::vector<FaceCounts> count_faces<3>(std::span<const Index>, const Stars&, std::span<const Index>,
                                                std::size_t, bool, unsigned, const Progress&,
                                                FunctionRef<void(std::size_t, const FacesOfStars<3>::Ridge&)>);
template std::vector<FaceCounts> count_faces<4>(std::span<const Index>, const Stars&, std::span<const Index>,
                                                std::size_t, bool, unsigned, const Progress&,
                                                FunctionRef<void(std::size_t, const FacesOfStars<4>::Ridge&)>);
template std::vector<FaceCounts> count_faces<5>(std::span<const Index>, const Stars&, std::span<const Index>,
                                                std::size_t, bool, unsigned, const Progress&,
                                                FunctionRef<void(std::size_t, const FacesOfStars<5>::Ridge&)>);
template std::vector<PieceSums<2>> sum_groups<2>(const SimplexView<2>&, const Groups&, unsigned, const Progress&);
template std::vector<PieceSums<3>> sum_groups<3>(const SimplexView<3>&, const Groups&, unsigned, const Progress&);
template std::vector<PieceSums<4>> sum_groups<4>(const SimplexView<4>&, const Groups&, unsigned, const Progress&);
template std::vector<PieceSums<5>> sum_groups<5>(const SimplexView<5>&, const Groups&, unsigned, const Progress&);

}  // namespace tegl::detail
