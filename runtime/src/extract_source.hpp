// SPDX-License-Identifier: BSD-3-Clause
//
// What the extraction asks of an image: rows of bits, and places on edges. Everything else in the
// kernel is independent of the value type, so it is compiled once per dimension.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "bitplanes.hpp"

namespace tegl::detail {

/// What the kernel keeps of a vertex for its neighbours: the place alpha on its edge in [0]; of a cube's
/// barycentre (N = 4) its coordinates in the cube.
template <int N>
using LocalPoint = std::array<double, N == 4 ? 3 : 1>;

/// The place of the isovalue on an edge from a value `a` to a value `b`, of which one is below the
/// isovalue and the other is not: 0 at a, 1 at b (theory, section 1). Infinite samples are taken as
/// limits: the point goes to the finite end, or to the middle between two infinities.
inline double edge_alpha(double a, double b, double isovalue) noexcept {
  const double difference = b - a;
  if (std::isfinite(difference)) return (isovalue - a) / difference;
  if (std::isinf(a)) return std::isinf(b) ? 0.5 : 1.0;
  if (std::isinf(b)) return 0.0;
  return (0.5 * isovalue - 0.5 * a) / (0.5 * b - 0.5 * a);
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

  /// The row through `start` (start[0] = 0), as classify_row.
  virtual bool classify(const Index& start, Word* high, Word* missing) const noexcept = 0;

  /// For each bit set in `edges`, in order: the place on the edge along `axis` from that sample of the
  /// row, kept `epsilon` away from the ends. All edges are critical.
  virtual void edge_alphas(const Index& start, int axis, const Word* edges, std::size_t words,
                           LocalPoint<N>* out) const noexcept = 0;
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

  bool classify(const Index& start, Word* high, Word* missing) const noexcept override {
    return classify_row(row(start), strides_[0], row_size_, threshold_, high, missing);
  }

  void edge_alphas(const Index& start, int axis, const Word* edges, std::size_t words,
                   LocalPoint<N>* out) const noexcept override {
    const T* const samples = row(start);
    const std::ptrdiff_t along = strides_[0];
    const std::ptrdiff_t across = strides_[axis];
    for (std::size_t w = 0; w < words; ++w)
      for (Word rest = edges[w]; rest != 0; rest &= rest - 1) {
        const std::size_t i = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
        const T* const a = samples + static_cast<std::ptrdiff_t>(i) * along;
        const double alpha = edge_alpha(static_cast<double>(a[0]), static_cast<double>(a[across]), isovalue_);
        (*out++)[0] = std::clamp(alpha, epsilon_, 1.0 - epsilon_);
      }
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
