// SPDX-License-Identifier: BSD-3-Clause
//
// Implements find_lifts by union-find.
#include "mesh/lifts.hpp"

#include <cmath>
#include <numeric>
#include <utility>

namespace tegl::detail {

namespace {

template <int N>
using Times = std::array<std::int32_t, N>;

template <int N>
Times<N> sum_of(Times<N> a, const Times<N>& b, std::int32_t factor = 1) noexcept {
  for (int p = 0; p < N; ++p) a[p] += factor * b[p];
  return a;
}

/// Sets of vertices, with the difference between the multiples of each vertex and of its root.
template <int N>
class MovedSets {
 public:
  explicit MovedSets(std::size_t vertices) : parents_(vertices), times_(vertices) {
    std::iota(parents_.begin(), parents_.end(), Index{0});
  }

  /// Returns the root; then times(v) are relative to it.
  Index find(Index v) noexcept {
    Index root = v;
    Times<N> total{};
    while (parents_[root] != root) {
      total = sum_of<N>(total, times_[root]);
      root = parents_[root];
    }
    while (parents_[v] != root && v != root) {  // path compression
      const Times<N> own = times_[v];
      const Index next = std::exchange(parents_[v], root);
      times_[v] = total;
      total = sum_of<N>(total, own, -1);
      v = next;
    }
    return root;
  }
  [[nodiscard]] const Times<N>& times(Index v) const noexcept { return times_[v]; }
  /// Sets the multiples of w to the multiples of v plus `more`. Returns whether that agrees with all joins before.
  bool join(Index v, Index w, const Times<N>& more) noexcept {
    const Index a = find(v), b = find(w);
    const Times<N> apart = sum_of<N>(sum_of<N>(times_[v], more), times_[w], -1);
    if (a == b) return apart == Times<N>{};
    parents_[b] = a;
    times_[b] = apart;
    return true;
  }

 private:
  std::vector<Index> parents_;
  std::vector<Times<N>> times_;
};

/// The multiples that move `x` to the place nearest to `to`.
template <int N>
Times<N> times_towards(std::span<const Period<N>> periods, const PointOf<N>& to, const PointOf<N>& x) noexcept {
  Times<N> times{};
  for (std::size_t p = 0; p < periods.size(); ++p)
    times[p] = static_cast<std::int32_t>(std::round(share_of(periods[p], to) - share_of(periods[p], x)));
  return times;
}

}  // namespace

template <int N>
Lifts<N> find_lifts(const SimplexView<N>& contour, std::span<const Index> simplex_labels,
                    std::span<const PointOf<N>> references) {
  Lifts<N> lifts;
  const std::span<const Period<N>> periods = contour.periods();
  lifts.winds.assign(references.size(), false);
  if (periods.empty()) return lifts;
  const std::size_t simplices = contour.simplices().size();
  const auto label_of = [&](std::size_t s) { return simplex_labels.empty() ? 0 : simplex_labels[s]; };
  MovedSets<N> sets(contour.vertex_count());
  for (std::size_t s = 0; s < simplices; ++s) {
    if (label_of(s) >= references.size()) continue;
    const std::array<Index, N>& simplex = contour.simplices()[s];
    const PointOf<N> first = contour.point(simplex[0]);
    for (int j = 1; j < N; ++j)
      if (!sets.join(simplex[0], simplex[j], times_towards<N>(periods, first, contour.point(simplex[j]))))
        lifts.winds[label_of(s)] = true;
  }
  // place each component
  lifts.times.resize(contour.vertex_count());
  std::vector<bool> is_placed(contour.vertex_count(), false);
  for (std::size_t s = 0; s < simplices; ++s) {
    if (label_of(s) >= references.size()) continue;
    const Index v = contour.simplices()[s][0], root = sets.find(v);
    if (is_placed[root]) continue;
    is_placed[root] = true;
    lifts.times[root] =
        sum_of<N>(times_towards<N>(periods, references[label_of(s)], contour.point(v)), sets.times(v), -1);
  }
  for (std::size_t v = 0; v < lifts.times.size(); ++v)
    if (const Index root = sets.find(static_cast<Index>(v)); root != v)
      lifts.times[v] = sum_of<N>(lifts.times[root], sets.times(static_cast<Index>(v)));
  return lifts;
}

template Lifts<2> find_lifts<2>(const SimplexView<2>&, std::span<const Index>, std::span<const PointOf<2>>);
template Lifts<3> find_lifts<3>(const SimplexView<3>&, std::span<const Index>, std::span<const PointOf<3>>);
template Lifts<4> find_lifts<4>(const SimplexView<4>&, std::span<const Index>, std::span<const PointOf<4>>);
template Lifts<5> find_lifts<5>(const SimplexView<5>&, std::span<const Index>, std::span<const PointOf<5>>);

}  // namespace tegl::detail
