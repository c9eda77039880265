// SPDX-License-Identifier: BSD-3-Clause
//
// A source of samples whose contour has other positions on the edges of the grid. Everything else, signatures above
// all, is as in the source that it wraps.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <vector>

#include "image/sample_source.hpp"
#include "tegl/grid.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

/// An edge of the grid.
template <int N>
struct GridEdge {
  SampleIndex<N> start;  ///< its lower end
  int axis;
};

/// A rule for positions on critical edges.
template <int N>
class PositionsOnEdges {
 public:
  /// The interpolation parameters of critical edges: 0 at the start, 1 at the other end. Called by several threads.
  virtual void find(const GridEdge<N>* edges, std::size_t count, double* out) const noexcept = 0;

 protected:
  ~PositionsOnEdges() = default;
};

template <int N>
class PlacedSource final : public SampleSource<N> {
 public:
  using Index = SampleIndex<N>;

  /// `samples` must have all layers in memory. All arguments must outlive this object.
  PlacedSource(SampleSource<N>& samples, const Grid<N>& grid, const PositionsOnEdges<N>& positions, double epsilon)
      : SampleSource<N>(row_numbers(grid), samples.isovalue(), grid.axes[N - 1], 0, true, samples.sample_bytes()),
        samples_(samples),
        positions_(positions),
        epsilon_(epsilon) {
    std::size_t rows = 1;
    for (int a = 1; a + 1 < N; ++a) rows *= grid.axes[a].size();
    starts_.resize(rows);
    inner_rows_.resize(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      for (int a = 1; a + 1 < N; ++a) {
        starts_[row][a] = row / static_cast<std::size_t>(this->strides()[a]) % grid.axes[a].size();
        inner_rows_[row] += static_cast<std::ptrdiff_t>(starts_[row][a]) * samples.strides()[a];
      }
    }
  }

  void edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept override {
    std::array<GridEdge<N>, kAtOnce> block;
    for (std::size_t first = 0; first < edges.count; first += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, edges.count - first);
      for (std::size_t i = 0; i < count; ++i) {
        block[i] = {starts_[static_cast<std::size_t>(edges.rows[first + i])], axis};
        block[i].start[0] = edges.at[first + i];
        block[i].start[N - 1] = k;
      }
      find(block.data(), count, out + first);
    }
  }

  void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept override {
    if (edges == 0) return;
    const auto dim = static_cast<unsigned>(std::popcount(axes));
    std::array<int, N> axis_of{};
    for (unsigned rest = axes, j = 0; rest != 0; rest &= rest - 1, ++j) axis_of[j] = std::countr_zero(rest);
    // gather
    std::array<GridEdge<N>, N << (N - 1)> block;
    std::array<double, N << (N - 1)> found;
    std::size_t count = 0;
    for (std::uint32_t rest = edges; rest != 0; rest &= rest - 1, ++count) {
      const auto e = static_cast<unsigned>(std::countr_zero(rest));
      const unsigned corner = edge_base(dim, e);
      block[count] = {base, axis_of[e >> (dim - 1)]};
      for (unsigned j = 0; j < dim; ++j) block[count].start[axis_of[j]] += corner >> j & 1u;
    }
    find(block.data(), count, found.data());
    // scatter
    const double* next = found.data();
    for (std::uint32_t rest = edges; rest != 0; rest &= rest - 1) out[std::countr_zero(rest)] = *next++;
  }

  [[nodiscard]] double value(const Index& index) const noexcept override { return samples_.value(index); }
  void corner_values(const Index& base, unsigned axes, double* out) const noexcept override {
    samples_.corner_values(base, axes, out);
  }
  void corner_rows(const Index& base, std::size_t count, double* out, std::size_t pitch) const noexcept override {
    samples_.corner_rows(base, count, out, pitch);
  }
  Word classify(const Index& start, std::size_t rows, BitRows high, BitRows missing) const noexcept override {
    return samples_.classify(start, rows, high, missing);
  }
  [[nodiscard]] bool is_high(const Index& index) const noexcept override { return samples_.is_high(index); }

  [[nodiscard]] AroundEdges<N, double> around_edges() const noexcept override { return &gather_around<double>; }
  [[nodiscard]] AroundEdges<N, float> around_edges_in_float() const noexcept override {
    return samples_.around_edges_in_float() == nullptr ? nullptr : &gather_around<float>;
  }
  [[nodiscard]] std::array<double, N> gradient(const Index& index,
                                               const std::array<AxisSteps, N>& steps) const noexcept override {
    return samples_.gradient(index, steps);
  }
  [[nodiscard]] ValuesAround<N> values_around(const Index& index,
                                              const std::array<AxisSteps, N>& steps) const noexcept override {
    return samples_.values_around(index, steps);
  }

 private:
  static constexpr std::size_t kAtOnce = 64;

  /// The steps of this source along an axis are numbers of rows, so that an offset is the number of a row in its layer.
  static typename EdgeCrossings<N>::Strides row_numbers(const Grid<N>& grid) {
    typename EdgeCrossings<N>::Strides strides{};
    std::ptrdiff_t stride = 1;
    for (int a = 1; a + 1 < N; ++a) {
      strides[a] = stride;
      stride *= static_cast<std::ptrdiff_t>(grid.axes[a].size());
    }
    return strides;
  }

  void find(const GridEdge<N>* edges, std::size_t count, double* out) const noexcept {
    positions_.find(edges, count, out);
    for (std::size_t i = 0; i < count; ++i) out[i] = std::clamp(out[i], epsilon_, 1.0 - epsilon_);
  }

  double corner_heights(const Index& base, unsigned axes, double* out) const noexcept override {
    samples_.corner_values(base, axes, out);
    const std::size_t corners = std::size_t{1} << std::popcount(axes);
    for (std::size_t v = 0; v < corners; ++v) out[v] -= this->isovalue();
    return epsilon_;
  }

  template <class Calc>
  static std::uint64_t gather_around(const SampleGradients<N>& samples, const EdgeSurroundings<N>& around,
                                     const EdgesInRows& edges, Calc* out) noexcept {
    const auto& placed = static_cast<const PlacedSource&>(samples);
    std::array<std::ptrdiff_t, kEdgesAtOnce> rows;
    for (std::size_t i = 0; i < edges.count; ++i) rows[i] = placed.inner_rows_[static_cast<std::size_t>(edges.rows[i])];
    const EdgesInRows inner{rows.data(), edges.at, edges.count};
    if constexpr (std::is_same_v<Calc, float>)
      return placed.samples_.around_edges_in_float()(placed.samples_, around, inner, out);
    else
      return placed.samples_.around_edges()(placed.samples_, around, inner, out);
  }

  SampleSource<N>& samples_;
  const PositionsOnEdges<N>& positions_;
  double epsilon_;
  std::vector<Index> starts_;               ///< by row of a layer: its first sample
  std::vector<std::ptrdiff_t> inner_rows_;  ///< by row of a layer: its offset in the wrapped source
};

}  // namespace tegl::detail
