// SPDX-License-Identifier: BSD-3-Clause
//
// What the extraction asks of an image: rows of bits, and places on edges. Everything else in the
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

/// The place of the isovalue on edges, of whose ends one is below the isovalue and the other is not: 0 at the first, 1
/// at the second (theory, section 1), kept `epsilon` away from both. Infinite samples are taken as limits: the point
/// goes to the finite end, or to the middle between two infinities.
template <Value T>
void edge_alphas(const EdgeSamples<T>& edges, double isovalue, double epsilon, double* out) noexcept;
/// The same of all 32 edges of a tile of four dimensions, from the values at its 16 corners; what is written for edges
/// that are not critical means nothing.
void tile_alphas(const double* corners, double isovalue, double epsilon, double* out) noexcept;

/// Edges in rows of one layer, by how far their rows are from the first (SampleSource::strides), and where they are
/// along the row.
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

  /// From now on, `layers` adjacent layers are needed at a time. Called once, before prepare.
  virtual void keep(std::size_t /*layers*/) {}
  /// Makes the samples of layer k of the last axis ready; called for each layer, in order, by the thread that called
  /// for the extraction. May throw.
  virtual void prepare(std::size_t /*k*/) {}

  /// Whether all layers are ready from the start, and need no memory.
  [[nodiscard]] virtual bool is_at_hand() const noexcept { return false; }

  [[nodiscard]] virtual std::size_t sample_bytes() const noexcept = 0;

  /// `rows` rows from the one through `start` (start[0] = 0) on along axis 1, as classify_rows.
  virtual Word classify(const Index& start, std::size_t rows, BitRows high, BitRows missing) const noexcept = 0;

  /// One sample.
  [[nodiscard]] virtual bool is_high(const Index& index) const noexcept = 0;
  /// Its value, which double holds whatever the type; layers before the first may be asked for, modulo 2^64, if there
  /// are any.
  [[nodiscard]] virtual double value(const Index& index) const noexcept = 0;
  /// The values at the corners of the cell along `axes` based at `base`, in the order of the cell's own corners.
  virtual void corner_values(const Index& base, unsigned axes, double* out) const noexcept = 0;
  /// `count` samples of each of the 2^(N-1) rows around the tiles from `base` on, `pitch` apart: bit a - 1 of a row's
  /// number is its side along axis a.
  virtual void corner_rows(const Index& base, std::size_t count, double* out, std::size_t pitch) const noexcept = 0;
  [[nodiscard]] virtual double isovalue() const noexcept = 0;
  /// The layer of the image that layer 0 is.
  [[nodiscard]] virtual std::size_t first_layer() const noexcept { return 0; }
  /// How many layers the image has from there on, if they are more than what is worked on; else 0.
  [[nodiscard]] virtual std::size_t layers_at_hand() const noexcept { return 0; }

  /// From sample to sample within a layer; of the last axis nothing.
  [[nodiscard]] virtual std::array<std::ptrdiff_t, N> strides() const noexcept = 0;
  /// For edges along `axis` from samples of layer k on, all critical: the place on the edge, 0 at its first end and 1
  /// at its second, kept `epsilon` away from both.
  virtual void edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept = 0;

  /// The same for single edges of the cell along `axes` based at `base`: local edge e of the bit mask `edges`, to
  /// out[e]. What other places of `out`, which has one for each edge of the cell, are given means nothing.
  virtual void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept = 0;

  /// Whether float holds all values.
  [[nodiscard]] virtual bool fits_float() const noexcept = 0;
  /// Steps along the last axis, for gradients: they may reach beyond layers that are a part of an image.
  [[nodiscard]] virtual AxisSteps last_steps(const Grid<N>& grid) const { return AxisSteps(grid.axes[N - 1]); }
  /// Values around edges, at most kEdgesAtOnce of them: kEdgeValues x kEdgesAtOnce. Returns, as bits, those with an end
  /// at an end of its row. Values that float does not hold are asked for as double alone.
  virtual std::uint64_t around_edges(const EdgeSurroundings<N>& around, const EdgesInRows& edges,
                                     float* out) const noexcept = 0;
  virtual std::uint64_t around_edges(const EdgeSurroundings<N>& around, const EdgesInRows& edges,
                                     double* out) const noexcept = 0;
  /// The gradient at a sample, by differences to its neighbours along the axes.
  [[nodiscard]] virtual std::array<double, N> gradient(const Index& index,
                                                       const std::array<AxisSteps, N>& steps) const noexcept = 0;
  /// The same by the Sobel kernel.
  [[nodiscard]] virtual std::array<double, N> sobel(const Index& index,
                                                    const std::array<AxisSteps, N>& steps) const noexcept = 0;
};

/// Samples in rows, wherever the layers are.
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
  /// `strides`: of the axes but the last; rows have `row_size` samples.
  RowSource(const Strides& strides, std::size_t row_size, double isovalue, double epsilon)
      : strides_(strides),
        row_size_(row_size),
        isovalue_(isovalue),
        epsilon_(epsilon),
        threshold_(make_threshold<T>(isovalue)) {}

  /// The first sample of layer k, a number modulo 2^64: layers before the first may be asked for by gradients.
  [[nodiscard]] virtual const T* layer(std::size_t k) const noexcept = 0;

 private:
  [[nodiscard]] const T* row(const Index& start) const noexcept {
    const T* at = layer(start[N - 1]);
    for (int a = 1; a < N - 1; ++a) at += static_cast<std::ptrdiff_t>(start[a]) * strides_[a];
    return at;
  }
  /// The row, one step along `axis` > 0 from that through `start`.
  [[nodiscard]] const T* next_row(Index start, int axis, std::size_t step) const noexcept {
    start[axis] += step;
    return row(start);
  }
  using Corners = std::array<T, std::size_t{1} << N>;
  /// The values at a cell's corners; returns its dimension.
  unsigned gather_corners(const Index& base, unsigned axes, Corners& corners) const noexcept;
  template <bool kAlongRow, class Calc>
  std::uint64_t gather(const EdgeSurroundings<N>& around, const EdgesInRows& edges, Calc* out) const noexcept;

  Strides strides_;
  std::size_t row_size_;
  double isovalue_;
  double epsilon_;
  Threshold<T> threshold_;
};

/// The samples must outlive it; the view need not.
template <Value T, int N>
class ImageSource final : public RowSource<T, N> {
 public:
  /// `first`: the layers from there on are what is worked on; gradients know of those before, and of those after.
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
