// SPDX-License-Identifier: BSD-3-Clause
//
// Sources of samples that lie in rows of a layer in memory: the implementation of sample_source.hpp by value type, and
// the source for an image in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "image/edge_alphas.hpp"
#include "image/sample_source.hpp"
#include "tegl/image.hpp"

namespace tegl::detail {

/// Source of samples in rows of a layer; subclasses provide the layers.
template <Value T, int N>
class RowSource : public SampleSource<N> {
 public:
  using Index = SampleIndex<N>;
  using Strides = typename EdgeCrossings<N>::Strides;

  Word classify(const Index& start, std::size_t rows, BitRows high, BitRows missing) const noexcept final;
  [[nodiscard]] bool is_high(const Index& index) const noexcept final {
    return !threshold_.never && row(index)[offset_in_row(index)] >= threshold_.value;
  }
  [[nodiscard]] double value(const Index& index) const noexcept final {
    return static_cast<double>(row(index)[offset_in_row(index)]);
  }
  void corner_values(const Index& base, unsigned axes, double* out) const noexcept final;
  void corner_rows(const Index& base, std::size_t count, double* out, std::size_t pitch) const noexcept final;
  [[nodiscard]] LayerInMemory layer_in_memory(std::size_t k) const noexcept final {
    return {reinterpret_cast<const std::byte*>(layer(k)), sizeof(T), strides()[0] * std::ptrdiff_t{sizeof(T)}};
  }
  void edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept final;
  /// edge_alphas from the samples at both ends of each edge.
  template <class U>  // a template, so that it is not instantiated with the class
  void alphas_between(const U* from, const U* to, std::size_t count, double* out) const noexcept
      requires(std::is_same_v<T, float>&& std::is_same_v<U, float>) {
    detail::alphas_between(from, to, count, this->isovalue(), epsilon_, out);
  }
  void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept final;
  void cells_alphas(const CellsWithEdges<N, 3>& cubes,
                    typename CellsWithEdges<N, 3>::Alphas& out) const noexcept final {
    alphas_together(cubes, out);
  }
  void cells_alphas(const CellsWithEdges<N, 4>& tesseracts,
                    typename CellsWithEdges<N, 4>::Alphas& out) const noexcept final {
    alphas_together(tesseracts, out);
  }
  [[nodiscard]] AroundEdges<N, double> around_edges() const noexcept final;
  [[nodiscard]] AroundEdges<N, float> around_edges_in_float() const noexcept final;
  [[nodiscard]] std::array<double, N> gradient(const Index& index,
                                               const std::array<AxisSteps, N>& steps) const noexcept final;
  [[nodiscard]] ValuesAround<N> values_around(const Index& index,
                                              const std::array<AxisSteps, N>& steps) const noexcept final;

 protected:
  /// `steps`: strides of all axes except the last. Rows have `row_size` samples. `last_axis`, `first_layer` and
  /// `are_in_memory`: as for SampleSource and SampleLayers.
  RowSource(const Strides& steps, std::size_t row_size, double isovalue, double epsilon, const Axis& last_axis,
            std::size_t first_layer, bool are_in_memory)
      : SampleSource<N>(steps, isovalue, last_axis, first_layer, are_in_memory, sizeof(T)),
        row_size_(row_size),
        epsilon_(epsilon),
        threshold_(make_threshold<T>(isovalue)) {}

  /// First sample of layer k modulo 2^64: gradients may read layers before the first.
  [[nodiscard]] virtual const T* layer(std::size_t k) const noexcept = 0;

 private:
  using EdgeCrossings<N>::strides;

  double corner_heights(const Index& base, unsigned axes, double* out) const noexcept final;
  template <int K>
  void alphas_together(const CellsWithEdges<N, K>& cells, typename CellsWithEdges<N, K>::Alphas& out) const noexcept;

  [[nodiscard]] const T* row(const Index& start) const noexcept {
    const T* at = layer(start[N - 1]);
    for (int a = 1; a < N - 1; ++a) at += static_cast<std::ptrdiff_t>(start[a]) * strides()[a];
    return at;
  }
  /// The row one step along `axis` > 0 from the row of `start`.
  [[nodiscard]] const T* next_row(Index start, int axis, std::size_t step) const noexcept {
    start[axis] += step;
    return row(start);
  }
  /// Offset of a sample from the start of its row.
  [[nodiscard]] std::ptrdiff_t offset_in_row(const Index& index) const noexcept {
    return static_cast<std::ptrdiff_t>(index[0]) * strides()[0];
  }
  using Corners = std::array<T, std::size_t{1} << N>;
  /// Reads the values at a cell's corners. Returns the cell's dimension.
  unsigned gather_corners(const Index& base, unsigned axes, Corners& corners) const noexcept;
  /// An AroundEdges for samples that are a RowSource<T, N>.
  template <class Calc>
  static std::uint64_t gather_around(const SampleGradients<N>& samples, const EdgeSurroundings<N>& around,
                                     const EdgesInRows& edges, Calc* out) noexcept;
  template <bool kAlongRow, class Calc>
  std::uint64_t gather(const EdgeSurroundings<N>& around, const EdgesInRows& edges, Calc* out) const noexcept;

  std::size_t row_size_;
  double epsilon_;
  Threshold<T> threshold_;
};

/// Source for an image in memory. The samples must outlive it; the image view need not.
template <Value T, int N>
class ImageSource final : public RowSource<T, N> {
 public:
  /// Extracts the layers from `first` on. Gradients also read the layers before and after.
  ImageSource(const Image<T, N>& image, double isovalue, double epsilon, std::size_t first = 0)
      : RowSource<T, N>(image.strides(), image.size(0), isovalue, epsilon, image.grid().axes[N - 1], first, true),
        data_(image.data() + static_cast<std::ptrdiff_t>(first) * image.strides()[N - 1]),
        stride_(image.strides()[N - 1]) {}

 private:
  [[nodiscard]] const T* layer(std::size_t k) const noexcept override {
    return data_ + static_cast<std::ptrdiff_t>(k) * stride_;
  }

  const T* data_;
  std::ptrdiff_t stride_;
};

// compiled in row_source.cpp
#define TEGL_INSTANTIATE_DIMENSIONS(T, N) \
  extern template class RowSource<T, N>;  \
  extern template class ImageSource<T, N>;
#include "base/instantiate.hpp"

}  // namespace tegl::detail
