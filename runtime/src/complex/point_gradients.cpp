// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at points of a complex.
#include "complex/point_gradients.hpp"

#include <algorithm>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "complex/complex_edges.hpp"

namespace tegl::detail {

template <int N>
void PointGradients<N>::mark_points(std::size_t points, std::span<const EdgeEnds> crossed,
                                    std::span<const Index> others) {
  bits_.resize(block_count(points, 64));
  before_.resize(bits_.size());
  const auto mark = [&](Index p) { bits_[p >> 6] |= std::uint64_t{1} << (p & 63u); };
  for (const EdgeEnds& ends : crossed)
    for (const Index p : ends) mark(p);
  for (const Index p : others) mark(p);
  std::size_t count = 0;
  for (std::size_t w = 0; w < bits_.size(); ++w) {
    before_[w] = count;
    count += static_cast<std::size_t>(std::popcount(bits_[w]));
  }
  gradients_.resize(count);
}

template <int N>
PointGradients<N>::PointGradients(const Complex<N>& complex, std::span<const EdgeEnds> crossed,
                                  std::span<const Index> others, const std::function<Gradient(Index)>& gradient,
                                  const WorkOptions& work) {
  mark_points(complex.points().size(), crossed, others);
  for_each_item(bits_.size(), work.threads, work.progress, [&](std::size_t w) {
    std::size_t next = before_[w];
    for (std::uint64_t rest = bits_[w]; rest != 0; rest &= rest - 1)
      gradients_[next++] = gradient(static_cast<Index>(64 * w + static_cast<std::size_t>(std::countr_zero(rest))));
  });
}

template <int N>
PointGradients<N>::PointGradients(const Complex<N>& complex, std::span<const EdgeEnds> crossed,
                                  std::span<const Index> others, const WorkOptions& work) {
  mark_points(complex.points().size(), crossed, others);
  const std::size_t count = gradients_.size();
  // their edges
  const CellGroups& cells = ComplexAccess::cells(complex);
  const ComplexEdges* const known = ComplexAccess::edges(complex);
  SortedEdges found;
  if (known == nullptr) {
    const std::vector<CellRange> ranges = ranges_of(cells);
    const auto visit = [&](std::size_t r, const auto& add) {
      const auto add_marked = [&](Index p, Index q) {
        if (is_marked(p) || is_marked(q)) add(p, q);
      };
      if (r >= ranges.size()) return cells.polytopes.for_each_edge(r - ranges.size(), add_marked);
      const CellGroup& group = cells.groups[ranges[r].group];
      const tables::CellTable& table = table_of(group.shape);
      for (std::size_t c = ranges[r].from; c < ranges[r].to; ++c)
        for (std::uint32_t e = 0; e < table.edge_count; ++e)
          add_marked(group.cell(c)[table.edges[2 * e]], group.cell(c)[table.edges[2 * e + 1]]);
    };
    found = SortedEdges(complex.points().size(), ranges.size() + cells.polytopes.part_count(), visit,
                        {work.threads, part_of(work.progress, 0.0, 0.7)});
  }
  // sums, in the order of the edges
  std::vector<Sums> sums(count);
  for (const auto& [p, q] : known == nullptr ? found.ends() : known->ends) {
    if (!is_marked(p) && !is_marked(q)) continue;
    const double difference = complex.values()[q] - complex.values()[p];
    if (!std::isfinite(difference)) continue;
    Gradient u;
    double length = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      u[i] = complex.points()[q][i] - complex.points()[p][i];
      length = std::hypot(length, u[i]);
    }
    if (length == 0.0) continue;
    for (double& x : u) x /= length;
    for (const Index end : {p, q}) {
      if (!is_marked(end)) continue;
      Sums& of = sums[number(end)];
      for (std::size_t i = 0, k = 0; i < N; ++i) {
        for (std::size_t j = i; j < N; ++j) of.matrix[k++] += u[i] * u[j];
        of.vector[i] += u[i] * (difference / length);
      }
    }
  }
  tell(work.progress, 0.8);
  for_each_item(count, work.threads, part_of(work.progress, 0.8, 1.0),
                [&](std::size_t i) { gradients_[i] = solve(sums[i]); });
}

template <int N>
typename PointGradients<N>::Gradient PointGradients<N>::solve(const Sums& sums) noexcept {
  // L D L^T. Without neighbours along some direction the matrix is singular: a little more on the diagonal gives the
  // solution that is 0 along that direction.
  for (const double more : {0.0, 1e-9}) {
    std::array<std::array<double, N>, N> lower{};
    std::array<double, N> diagonal{};
    bool is_regular = true;
    double largest = 0.0;
    for (std::size_t i = 0, k = 0; i < N; k += N - i, ++i) largest = std::max(largest, sums.matrix[k]);
    for (std::size_t j = 0, k = 0; j < N; ++j) {
      for (std::size_t i = j; i < N; ++i, ++k) {
        double x = sums.matrix[k] + (i == j ? more * largest : 0.0);
        for (std::size_t m = 0; m < j; ++m) x -= lower[i][m] * lower[j][m] * diagonal[m];
        if (i == j) diagonal[j] = x;
        lower[i][j] = x / diagonal[j];
      }
      is_regular = is_regular && diagonal[j] > 1e-6 * largest;
    }
    if (!is_regular && more == 0.0) continue;
    Gradient x = sums.vector;
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t m = 0; m < i; ++m) x[i] -= lower[i][m] * x[m];
    for (std::size_t i = N; i-- > 0;) {
      x[i] /= diagonal[i];
      for (std::size_t m = i + 1; m < N; ++m) x[i] -= lower[m][i] * x[m];
    }
    if (largest > 0.0) return x;
  }
  return {};
}

template class PointGradients<2>;
template class PointGradients<3>;
template class PointGradients<4>;

}  // namespace tegl::detail
