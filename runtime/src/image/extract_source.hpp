// SPDX-License-Identifier: BSD-3-Clause
//
// The interface through which the extraction reads an image: rows of bits, and positions on edges. The rest of the
// kernel is independent of the value type, so it is compiled once per dimension.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "image/bitplanes.hpp"
#include "image/gradient.hpp"

namespace tegl::detail {

/// Edges along one axis in rows of one layer. Edge i goes from starts[j] to ends[j], j = rows[i] + at[i] * stride.
template <Value T>
struct EdgeSamples {
  const T* starts;
  const T* ends;
  const std::ptrdiff_t* rows;
  const std::uint32_t* at;
  std::size_t count;
  std::ptrdiff_t stride;
};

/// Interpolation parameters of the isovalue on critical edges: 0 at the first end, 1 at the second (theory, section 1),
/// clamped to [epsilon, 1 - epsilon]. Infinite samples are treated as limits: the vertex is at the finite end, or at
/// the middle between two infinities.
template <Value T>
void edge_alphas(const EdgeSamples<T>& edges, double isovalue, double epsilon, double* out) noexcept;
/// Interpolation parameters for all 32 edges of a 4D tile, from the values at its 16 corners. Results for non-critical
/// edges are undefined.
void tile_alphas(const double* corners, double isovalue, double epsilon, double* out) noexcept;

/// Edges in rows of one layer: offset of each edge's row from the first row (SampleSource::strides), and position along
/// the row.
struct EdgesInRows {
  const std::ptrdiff_t* rows;
  const std::uint32_t* at;
  std::size_t count;
};

/// An image with an isovalue; rows run along axis 0.
template <int N>
class SampleSource {
 public:
  using Index = std::array<std::size_t, N>;
  SampleSource() = default;
  SampleSource(const SampleSource&) = delete;
  SampleSource& operator=(const SampleSource&) = delete;
  virtual ~SampleSource() = default;

  /// Sets the number of adjacent layers needed at a time. Called once, before prepare.
  virtual void keep(std::size_t /*layers*/) {}
  /// Prepares the samples of layer k of the last axis. Called for each layer in order, by the thread that started the
  /// extraction. May throw.
  virtual void prepare(std::size_t /*k*/) {}

  /// Whether all layers are available from the start without additional memory.
  [[nodiscard]] virtual bool is_at_hand() const noexcept { return false; }

  [[nodiscard]] virtual std::size_t sample_bytes() const noexcept = 0;

  /// Classifies `rows` rows along axis 1, starting with the row of `start` (start[0] = 0); see classify_rows.
  virtual Word classify(const Index& start, std::size_t rows, BitRows high, BitRows missing) const noexcept = 0;

  /// Whether one sample is high.
  [[nodiscard]] virtual bool is_high(const Index& index) const noexcept = 0;
  /// Value of a sample; double represents all value types exactly. Layers before the first, modulo 2^64, are allowed if
  /// the image has them.
  [[nodiscard]] virtual double value(const Index& index) const noexcept = 0;
  /// Values at the corners of the cell along `axes` based at `base`, in the order of the cell's own corners.
  virtual void corner_values(const Index& base, unsigned axes, double* out) const noexcept = 0;
  /// Reads `count` samples from each of the 2^(N-1) rows around the tiles that start at `base`. Rows are `pitch` apart
  /// in `out`; bit a - 1 of a row's number is its side along axis a.
  virtual void corner_rows(const Index& base, std::size_t count, double* out, std::size_t pitch) const noexcept = 0;
  [[nodiscard]] virtual double isovalue() const noexcept = 0;
  /// Number of layer 0 in the whole image.
  [[nodiscard]] virtual std::size_t first_layer() const noexcept { return 0; }
  /// Number of layers that the image has from layer 0 on, if it has more than are extracted; otherwise 0.
  [[nodiscard]] virtual std::size_t layers_at_hand() const noexcept { return 0; }

  /// Steps between samples within a layer. The entry of the last axis is undefined.
  [[nodiscard]] virtual std::array<std::ptrdiff_t, N> strides() const noexcept = 0;
  /// Interpolation parameters of critical edges along `axis` that start in layer k: 0 at the first end, 1 at the
  /// second, clamped to [epsilon, 1 - epsilon].
  virtual void edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept = 0;

  /// Interpolation parameters for the edges in the bit mask `edges` of the cell along `axes` based at `base`: local
  /// edge e to out[e]. `out` has an entry for each edge of the cell; the other entries are undefined.
  virtual void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept = 0;

  /// Whether float represents all values exactly.
  [[nodiscard]] virtual bool fits_float() const noexcept = 0;
  /// Steps along the last axis, for gradients. They may extend beyond the extracted layers of an image.
  [[nodiscard]] virtual AxisSteps last_steps(const Grid<N>& grid) const { return AxisSteps(grid.axes[N - 1]); }
  /// Reads the values around edges, at most kEdgesAtOnce of them, to kEdgeValues x kEdgesAtOnce entries. Returns as
  /// bits the edges that have an end at an end of its row. The float version requires fits_float().
  virtual std::uint64_t around_edges(const EdgeSurroundings<N>& around, const EdgesInRows& edges,
                                     float* out) const noexcept = 0;
  virtual std::uint64_t around_edges(const EdgeSurroundings<N>& around, const EdgesInRows& edges,
                                     double* out) const noexcept = 0;
  /// Gradient at a sample by differences to its neighbours along the axes.
  [[nodiscard]] virtual std::array<double, N> gradient(const Index& index,
                                                       const std::array<AxisSteps, N>& steps) const noexcept = 0;
  /// Gradient at a sample by the Sobel kernel.
  [[nodiscard]] virtual std::array<double, N> sobel(const Index& index,
                                                    const std::array<AxisSteps, N>& steps) const noexcept = 0;
};

/// Source of samples in rows of a layer; subclasses provide the layers.
template <Value T, int N>
class RowSource : public SampleSource<N> {
 public:
  using typename SampleSource<N>::Index;
  using Strides = std::array<std::ptrdiff_t, N>;

  [[nodiscard]] std::size_t sample_bytes() const noexcept final { return sizeof(T); }
  Word classify(const Index& start, std::size_t rows, BitRows high, BitRows missing) const noexcept final;
  [[nodiscard]] bool is_high(const Index& index) const noexcept final {
    return !threshold_.never && row(index)[static_cast<std::ptrdiff_t>(index[0]) * strides_[0]] >= threshold_.value;
  }
  [[nodiscard]] double value(const Index& index) const noexcept final {
    return static_cast<double>(row(index)[static_cast<std::ptrdiff_t>(index[0]) * strides_[0]]);
  }
  void corner_values(const Index& base, unsigned axes, double* out) const noexcept final;
  void corner_rows(const Index& base, std::size_t count, double* out, std::size_t pitch) const noexcept final;
  [[nodiscard]] double isovalue() const noexcept final { return isovalue_; }
  [[nodiscard]] Strides strides() const noexcept final { return strides_; }
  void edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept final;
  void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept final;
  [[nodiscard]] bool fits_float() const noexcept final {
    return std::numeric_limits<T>::digits <= std::numeric_limits<float>::digits;
  }
  std::uint64_t around_edges(const EdgeSurroundings<N>& around, const EdgesInRows& edges,
                             float* out) const noexcept final;
  std::uint64_t around_edges(const EdgeSurroundings<N>& around, const EdgesInRows& edges,
                             double* out) const noexcept final;
  [[nodiscard]] std::array<double, N> gradient(const Index& index,
                                               const std::array<AxisSteps, N>& steps) const noexcept final;
  [[nodiscard]] std::array<double, N> sobel(const Index& index,
                                            const std::array<AxisSteps, N>& steps) const noexcept final;

 protected:
  /// `strides`: of all axes except the last. Rows have `row_size` samples.
  RowSource(const Strides& strides, std::size_t row_size, double isovalue, double epsilon)
      : strides_(strides),
        row_size_(row_size),
        isovalue_(isovalue),
        epsilon_(epsilon),
        threshold_(make_threshold<T>(isovalue)) {}

  /// First sample of layer k modulo 2^64: gradients may read layers before the first.
  [[nodiscard]] virtual const T* layer(std::size_t k) const noexcept = 0;

 private:
  [[nodiscard]] const T* row(const Index& start) const noexcept {
    const T* at = layer(start[N - 1]);
    for (int a = 1; a < N - 1; ++a) at += static_cast<std::ptrdiff_t>(start[a]) * strides_[a];
    return at;
  }
  /// The row one step along `axis` > 0 from the row of `start`.
  [[nodiscard]] const T* next_row(Index start, int axis, std::size_t step) const noexcept {
    start[axis] += step;
    return row(start);
  }
  using Corners = std::array<T, std::size_t{1} << N>;
  /// Reads the values at a cell's corners. Returns the cell's dimension.
  unsigned gather_corners(const Index& base, unsigned axes, Corners& corners) const noexcept;
  template <bool kAlongRow, class Calc>
  std::uint64_t gather(const EdgeSurroundings<N>& around, const EdgesInRows& edges, Calc* out) const noexcept;

  Strides strides_;
  std::size_t row_size_;
  double isovalue_;
  double epsilon_;
  Threshold<T> threshold_;
};

/// Source for an image in memory. The samples must outlive it; the image view need not.
template <Value T, int N>
class ImageSource final : public RowSource<T, N> {
 public:
  /// Extracts the layers from `first` on. Gradients also read the layers before and after.
  ImageSource(const Image<T, N>& image, double isovalue, double epsilon, std::size_t first = 0)
      : RowSource<T, N>(image.strides(), image.size(0), isovalue, epsilon),
        data_(image.data() + static_cast<std::ptrdiff_t>(first) * image.strides()[N - 1]),
        stride_(image.strides()[N - 1]),
        last_axis_(image.grid().axes[N - 1]),
        first_(first) {}

  [[nodiscard]] bool is_at_hand() const noexcept override { return true; }
  [[nodiscard]] std::size_t first_layer() const noexcept override { return first_; }
  [[nodiscard]] std::size_t layers_at_hand() const noexcept override { return last_axis_.size() - first_; }
  [[nodiscard]] AxisSteps last_steps(const Grid<N>& /*grid*/) const override { return AxisSteps(last_axis_, first_); }

 private:
  [[nodiscard]] const T* layer(std::size_t k) const noexcept override {
    return data_ + static_cast<std::ptrdiff_t>(k) * stride_;
  }

  const T* data_;
  std::ptrdiff_t stride_;
  Axis last_axis_;
  std::size_t first_;
};

}  // namespace tegl::detail
