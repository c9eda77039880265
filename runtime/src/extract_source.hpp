// SPDX-License-Identifier: BSD-3-Clause
//
// What the extraction asks of an image: rows of bits, and places on edges. Everything else in the
// kernel is independent of the value type, so it is compiled once per dimension.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "bitplanes.hpp"
#include "corners.hpp"
#include "gradient.hpp"

namespace tegl::detail {

/// The place of the isovalue on edges from values `a` to values `b`, of which one is below the isovalue and the other
/// is not: 0 at a, 1 at b (theory, section 1), kept `epsilon` away from both. Infinite samples are taken as limits: the
/// point goes to the finite end, or to the middle between two infinities. Edge i has its values at a[at[i] * stride]
/// and b[at[i] * stride].
template <Value T>
void edge_alphas(const T* a, const T* b, std::ptrdiff_t stride, const std::uint32_t* at, std::size_t count,
                 double isovalue, double epsilon, double* out) noexcept;

/// The places on the critical edges of a cell, to out[e] for local edge e of the bit mask `edges`; the cell is along
/// the axes of the bit mask `axes`, its lowest sample at base[0], and what is further along the last axis at base[1].
template <Value T, int N>
void cell_alphas(const std::array<const T*, 2>& base, const std::array<std::ptrdiff_t, N>& strides, unsigned axes,
                 std::uint32_t edges, double isovalue, double epsilon, double* out) noexcept {
  static constexpr auto kInOrder = [] {
    std::array<std::uint32_t, N << (N - 1)> result{};
    for (std::uint32_t i = 0; i < result.size(); ++i) result[i] = i;
    return result;
  }();
  std::array<T, std::size_t{1} << N> corners;
  std::array<std::ptrdiff_t, std::size_t{1} << N> offsets{};
  corners[0] = *base[0];
  unsigned dim = 0;
  for (unsigned a = 0; a < N; ++a) {
    if ((axes >> a & 1u) == 0) continue;
    const T* const from = a == N - 1 ? base[1] : base[0];
    for (std::size_t c = 0, up = std::size_t{1} << dim; c < std::size_t{1} << dim; ++c, ++up) {
      offsets[up] = offsets[c] + (a == N - 1 ? 0 : strides[a]);
      corners[up] = from[offsets[up]];
    }
    ++dim;
  }
  std::array<T, kInOrder.size()> first{};
  std::array<T, kInOrder.size()> second{};
  std::array<double, kInOrder.size()> alphas;
  std::size_t count = 0;
  for (std::uint32_t rest = edges; rest != 0; rest &= rest - 1, ++count) {
    const auto e = static_cast<unsigned>(std::countr_zero(rest));
    const unsigned at = edge_base(dim, e);
    first[count] = corners[at];
    second[count] = corners[at | 1u << (e >> (dim - 1))];
  }
  edge_alphas(first.data(), second.data(), 1, kInOrder.data(), count, isovalue, epsilon, alphas.data());
  const double* next = alphas.data();
  for (; edges != 0; edges &= edges - 1) out[std::countr_zero(edges)] = *next++;
}

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

  [[nodiscard]] virtual std::size_t sample_bytes() const noexcept = 0;

  /// The samples' gradients over `grid`; null where samples come and go.
  [[nodiscard]] virtual std::unique_ptr<const GradientField<N>> gradients(const Grid<N>& /*grid*/) const {
    return nullptr;
  }

  /// The row through `start` (start[0] = 0), as classify_row.
  virtual bool classify(const Index& start, Word* high, Word* missing) const noexcept = 0;

  /// For the edges along `axis` from the samples `at` of the row, `count` of them, all critical: the place on the edge,
  /// 0 at its first end and 1 at its second, kept `epsilon` away from both.
  virtual void edge_alphas(const Index& start, int axis, const std::uint32_t* at, std::size_t count,
                           double* out) const noexcept = 0;

  /// The same for single edges of the cell along `axes` based at `base`: local edge e of the bit mask `edges`, to
  /// out[e].
  virtual void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept = 0;
};

/// The samples must outlive it; the view need not.
template <Value T, int N>
class ImageSource final : public SampleSource<N> {
 public:
  using typename SampleSource<N>::Index;

  ImageSource(const Image<T, N>& image, double isovalue, double epsilon)
      : data_(image.data()),
        strides_(image.strides()),
        row_size_(image.size(0)),
        isovalue_(isovalue),
        epsilon_(epsilon),
        threshold_(make_threshold<T>(isovalue)) {}

  [[nodiscard]] std::size_t sample_bytes() const noexcept override { return sizeof(T); }
  [[nodiscard]] std::unique_ptr<const GradientField<N>> gradients(const Grid<N>& grid) const override {
    return std::make_unique<Gradient<T, N>>(data_, strides_, grid);
  }

  bool classify(const Index& start, Word* high, Word* missing) const noexcept override {
    return classify_row(row(start), strides_[0], row_size_, threshold_, high, missing);
  }

  void edge_alphas(const Index& start, int axis, const std::uint32_t* at, std::size_t count,
                   double* out) const noexcept override {
    const T* const samples = row(start);
    detail::edge_alphas(samples, samples + strides_[axis], strides_[0], at, count, isovalue_, epsilon_, out);
  }

  void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept override {
    const T* const first = row(base) + static_cast<std::ptrdiff_t>(base[0]) * strides_[0];
    // A cell within the last layer has nothing above.
    const T* const above = (axes >> (N - 1) & 1u) != 0 ? first + strides_[N - 1] : nullptr;
    detail::cell_alphas<T, N>({first, above}, strides_, axes, edges, isovalue_, epsilon_, out);
  }

 private:
  const T* row(const Index& start) const noexcept {
    std::ptrdiff_t at = 0;
    for (int a = 1; a < N; ++a) at += static_cast<std::ptrdiff_t>(start[a]) * strides_[a];
    return data_ + at;
  }

  const T* data_;
  typename Image<T, N>::Strides strides_;
  std::size_t row_size_;
  double isovalue_;
  double epsilon_;
  Threshold<T> threshold_;
};

}  // namespace tegl::detail
