// SPDX-License-Identifier: BSD-3-Clause
//
// A source of samples whose contour has other positions on the edges of the grid. Everything else, signatures above
// all, is as in the source that it wraps.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/function_ref.hpp"
#include "image/sample_source.hpp"
#include "tegl/grid.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

/// The rows of a layer of samples.
template <int N>
class LayerRows {
 public:
  /// `strides`: steps between the samples of a layer.
  LayerRows(const Grid<N>& grid, const typename EdgeCrossings<N>::Strides& strides) : row_size_(grid.axes[0].size()) {
    std::size_t rows = 1;
    for (int a = 1; a + 1 < N; ++a) {
      numbers_[a] = static_cast<std::ptrdiff_t>(rows);
      rows *= grid.axes[a].size();
    }
    starts_.resize(rows);
    offsets_.resize(rows);
    for (std::size_t row = 0; row < rows; ++row)
      for (int a = 1; a + 1 < N; ++a) {
        starts_[row][a] = row / static_cast<std::size_t>(numbers_[a]) % grid.axes[a].size();
        offsets_[row] += static_cast<std::ptrdiff_t>(starts_[row][a]) * strides[a];
      }
  }

  [[nodiscard]] std::size_t size() const noexcept { return starts_.size(); }
  [[nodiscard]] std::size_t row_size() const noexcept { return row_size_; }
  /// Rows between neighbours along the axes between the first and the last.
  [[nodiscard]] const typename EdgeCrossings<N>::Strides& numbers() const noexcept { return numbers_; }
  /// Offset of a row's first sample in its layer.
  [[nodiscard]] std::ptrdiff_t offset(std::size_t row) const noexcept { return offsets_[row]; }
  /// Index of a row's first sample along the axes between the first and the last; 0 along these.
  [[nodiscard]] const SampleIndex<N>& start(std::size_t row) const noexcept { return starts_[row]; }
  /// Index of sample i of a row of layer k.
  [[nodiscard]] SampleIndex<N> index(std::size_t k, std::size_t row, std::size_t i) const noexcept {
    SampleIndex<N> index = starts_[row];
    index[0] = i;
    index[N - 1] = k;
    return index;
  }

 private:
  std::size_t row_size_;
  typename EdgeCrossings<N>::Strides numbers_{};
  std::vector<SampleIndex<N>> starts_;  ///< by row: the index of its first sample in layer 0
  std::vector<std::ptrdiff_t> offsets_;
};

/// Critical edges along one axis that start in layer k, at most kMost.
template <int N>
struct LayerEdges {
  static constexpr std::size_t kMost = 64;
  const LayerRows<N>& rows;
  std::size_t k;
  int axis;
  const std::ptrdiff_t* row;  ///< by edge: the number of its row in the layer
  EdgesInRows edges;          ///< the same edges as the image's own source addresses them

  /// Index of the lower end.
  [[nodiscard]] SampleIndex<N> start(std::size_t i) const noexcept {
    return rows.index(k, static_cast<std::size_t>(row[i]), edges.at[i]);
  }
  /// Number of the row among the rows of all layers.
  [[nodiscard]] std::size_t row_of_all(std::size_t i) const noexcept {
    return k * rows.size() + static_cast<std::size_t>(row[i]);
  }
};

/// For at most kWordBits edges in rows of layer k: whether their first ends are high, as bits.
using StartsHigh = FunctionRef<Word(std::size_t k, const EdgesInRows& edges)>;

/// The text of the error of a custom rule that returns NaN.
inline std::string nan_position(double first, double second, double isovalue) {
  return fmt::format(
      "the function for custom positions returned NaN for samples {} and {} and the isovalue {}; expected a number "
      "from 0 to 1",
      first, second, isovalue);
}

/// A rule for positions on critical edges.
template <int N>
class PositionsOnEdges {
 public:
  /// The interpolation parameters of critical edges: 0 at the start, 1 at the other end. Called by several threads.
  virtual void find(const LayerEdges<N>& edges, double* out) const noexcept = 0;
  /// Where the values of layer k are that `find` reads, as of EdgeCrossings, with offsets in numbers of rows.
  [[nodiscard]] virtual LayerInMemory layer_in_memory(std::size_t /*k*/) const noexcept { return {}; }

 protected:
  ~PositionsOnEdges() = default;
};

template <int N>
class PlacedSource : public SampleSource<N> {
 public:
  using Index = SampleIndex<N>;

  /// `samples` must have all layers in memory. All arguments must outlive this object.
  PlacedSource(SampleSource<N>& samples, const LayerRows<N>& rows, const Axis& last_axis,
               const PositionsOnEdges<N>& positions, double epsilon)
      : SampleSource<N>(rows.numbers(), samples.isovalue(), last_axis, 0, true, samples.sample_bytes()),
        samples_(samples),
        rows_(rows),
        positions_(positions),
        epsilon_(epsilon) {}

  [[nodiscard]] LayerInMemory layer_in_memory(std::size_t k) const noexcept override {
    return positions_.layer_in_memory(k);
  }
  /// The steps of this source are numbers of rows, so that the offset of a row is its number in its layer.
  void edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept override {
    for (std::size_t first = 0; first < edges.count; first += kAtOnce)
      find(k, axis, {edges.rows + first, edges.at + first, std::min(kAtOnce, edges.count - first)}, out + first);
  }
  void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept override {
    const auto dim = static_cast<unsigned>(std::popcount(axes));
    std::array<int, N> axis_of{};
    for (unsigned rest = axes, j = 0; rest != 0; rest &= rest - 1, ++j) axis_of[j] = std::countr_zero(rest);
    std::ptrdiff_t base_row = 0;
    for (int a = 1; a + 1 < N; ++a) base_row += static_cast<std::ptrdiff_t>(base[a]) * this->strides()[a];
    std::array<std::ptrdiff_t, kAtOnce> rows;
    std::array<std::uint32_t, kAtOnce> at;
    std::array<double, kAtOnce> found;
    while (edges != 0) {
      // the edges along one axis in one layer
      const auto first = static_cast<unsigned>(std::countr_zero(edges));
      const int axis = axis_of[first >> (dim - 1)];
      std::size_t count = 0, layer = 0;
      std::uint32_t rest = edges;
      for (; rest != 0; rest &= rest - 1, ++count) {
        const auto e = static_cast<unsigned>(std::countr_zero(rest));
        const unsigned corner = edge_base(dim, e);
        std::array<std::size_t, N> up{};
        for (unsigned j = 0; j < dim; ++j) up[axis_of[j]] = corner >> j & 1u;
        if (count == 0) layer = up[N - 1];
        if (axis_of[e >> (dim - 1)] != axis || up[N - 1] != layer) break;
        at[count] = static_cast<std::uint32_t>(base[0] + up[0]);
        rows[count] = base_row;
        for (int a = 1; a + 1 < N; ++a)
          if (up[a] != 0) rows[count] += this->strides()[a];
      }
      find(base[N - 1] + layer, axis, {rows.data(), at.data(), count}, found.data());
      for (const double* next = found.data(); edges != rest; edges &= edges - 1) out[std::countr_zero(edges)] = *next++;
    }
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

 protected:
  static constexpr std::size_t kAtOnce = LayerEdges<N>::kMost;

  using Offsets = std::array<std::ptrdiff_t, kAtOnce>;

  /// Addresses edges as the wrapped source does.
  [[nodiscard]] EdgesInRows inner(const EdgesInRows& edges, Offsets& offsets) const noexcept {
    for (std::size_t i = 0; i < edges.count; ++i) offsets[i] = rows_.offset(static_cast<std::size_t>(edges.rows[i]));
    return {offsets.data(), edges.at, edges.count};
  }
  [[nodiscard]] const LayerRows<N>& rows() const noexcept { return rows_; }

 private:
  void find(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept {
    Offsets offsets;
    positions_.find({rows_, k, axis, edges.rows, inner(edges, offsets)}, out);
    for (std::size_t i = 0; i < edges.count; ++i) out[i] = std::clamp(out[i], epsilon_, 1.0 - epsilon_);
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
    Offsets offsets;
    const EdgesInRows inner = placed.inner(edges, offsets);
    if constexpr (std::is_same_v<Calc, float>)
      return placed.samples_.around_edges_in_float()(placed.samples_, around, inner, out);
    else
      return placed.samples_.around_edges()(placed.samples_, around, inner, out);
  }

  SampleSource<N>& samples_;
  const LayerRows<N>& rows_;
  const PositionsOnEdges<N>& positions_;
  double epsilon_;
};

}  // namespace tegl::detail
