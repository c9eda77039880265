// SPDX-License-Identifier: BSD-3-Clause
//
// Measured and simulated images for tests: parts of files, isovalues for them, and properties of the contour computed
// from the samples only.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <vector>

#include "fields.hpp"
#include "tegl/image.hpp"

namespace tegl::test {

/// The middle of an image, with at most `most[a]` samples along axis a, to limit the time of tests.
template <Value T, int N>
Image<T, N> middle(Image<T, N> image, const std::type_identity_t<std::array<std::size_t, N>>& most) {
  for (int a = 0; a < N; ++a) {
    const std::size_t size = std::min(image.size(a), most[a]);
    image = image.part(a, (image.size(a) - size) / 2, size);
  }
  return image;
}

/// A value at the given quantile of the samples that few samples equal.
template <Value T, int N>
double isovalue_at(const Image<T, N>& image, double quantile) {
  std::vector<double> values;
  for_each_sample<N>(image.grid(), [&](std::size_t, const std::array<std::size_t, N>& index) {
    const auto value = static_cast<double>(image(index));
    if (!std::isnan(value)) values.push_back(value);
  });
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(quantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return std::is_floating_point_v<T> ? *at * (1 + 1e-4) + 1e-7 : *at + 0.5;
}

/// The samples on a grid of unit steps from 0.
template <Value T, int N>
OwnedImage<T, N> on_unit_grid(const Image<T, N>& image) {
  OwnedImage<T, N> result;
  for (int a = 0; a < N; ++a) result.grid.axes[a] = Axis::uniform(image.size(a));
  for_each_sample<N>(result.grid, [&](std::size_t, const std::array<std::size_t, N>& index) {
    result.values.push_back(image(index));
  });
  return result;
}

/// Disjoint sets with a count (union-find).
class Pieces {
 public:
  explicit Pieces(std::size_t count) : parents_(count), count_(count) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a != b) --count_;
    parents_[std::max(a, b)] = std::min(a, b);
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::size_t root(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  std::vector<std::size_t> parents_;
  std::size_t count_;
};

/// Number of surfaces that separate high from low samples of an image without missing values, closed at its border;
/// computed from the samples only. High samples are connected along edges of the grid. Low samples are also connected
/// across diagonals of its squares (Ambiguity::low), and at the border with the outside. Space is simply connected, so
/// each surface separates two regions, and the regions form a tree with the surfaces as edges.
template <Value T, int N>
std::size_t surfaces_by_samples(const Image<T, N>& image, double isovalue) {
  const auto is_high = [&](const std::array<std::size_t, N>& index) {
    return static_cast<double>(image(index)) >= isovalue;
  };
  std::array<std::size_t, N> strides;
  for (int a = 0; a < N; ++a) strides[a] = a == 0 ? 1 : strides[a - 1] * image.size(a - 1);
  const std::size_t outside = sample_count(image.grid());
  Pieces pieces(outside + 1);
  for_each_sample<N>(image.grid(), [&](std::size_t i, const std::array<std::size_t, N>& index) {
    const bool high = is_high(index);
    for (int a = 0; a < N; ++a) {
      if (!high && (index[a] == 0 || index[a] + 1 == image.size(a))) pieces.join(i, outside);
      if (index[a] + 1 == image.size(a)) continue;
      auto next = index;
      ++next[a];
      if (is_high(next) == high) pieces.join(i, i + strides[a]);
      for (int b = 0; !high && b < N; ++b)
        for (const bool up : {false, true}) {
          if (b == a || (up ? index[b] + 1 == image.size(b) : index[b] == 0)) continue;
          auto across = next;
          across[b] = up ? index[b] + 1 : index[b] - 1;
          if (!is_high(across)) pieces.join(i, up ? i + strides[a] + strides[b] : i + strides[a] - strides[b]);
        }
    }
  });
  return pieces.count() - 1;
}

/// Number of components of a grid face's high corners (bit v of `high`: corner v), connected along its edges.
inline int high_pieces(unsigned high, int dim) {
  Pieces pieces(std::size_t{1} << dim);
  for (unsigned v = 0; v < 1u << dim; ++v)
    for (int j = 0; j < dim; ++j)
      if ((high >> v & 1u) != 0 && (high >> (v | 1u << j) & 1u) != 0) pieces.join(v, v | 1u << j);
  return static_cast<int>(pieces.count()) - ((1 << dim) - std::popcount(high));
}

/// The Euler characteristic of the contour of a 3D image, closed at its border, computed from the samples only: twice
/// that of the high set. In each face of the grid the high set consists of one ball per component of the face's high
/// corners; these count with the sign of the face's codimension. Samples outside the image are low.
template <Value T>
std::int64_t euler_by_samples(const Image<T, 3>& image, double isovalue) {
  std::int64_t euler = 0;
  std::array<std::ptrdiff_t, 3> base;
  const auto high_at = [&](const std::array<std::ptrdiff_t, 3>& index) {
    for (int a = 0; a < 3; ++a)
      if (index[a] < 0 || index[a] >= static_cast<std::ptrdiff_t>(image.size(a))) return false;
    return static_cast<double>(image({static_cast<std::size_t>(index[0]), static_cast<std::size_t>(index[1]),
                                      static_cast<std::size_t>(index[2])})) >= isovalue;
  };
  const auto count_faces_at = [&] {
    for (unsigned axes = 0; axes < 8; ++axes) {
      const int dim = std::popcount(axes);
      unsigned high = 0;
      for (unsigned v = 0; v < 1u << dim; ++v) {
        auto corner = base;
        for (int a = 0, j = 0; a < 3; ++a)
          if ((axes >> a & 1u) != 0) corner[a] += v >> j++ & 1u;
        if (high_at(corner)) high |= 1u << v;
      }
      euler += ((3 - dim) % 2 == 0 ? 1 : -1) * high_pieces(high, dim);
    }
  };
  for (base[2] = -1; base[2] < static_cast<std::ptrdiff_t>(image.size(2)); ++base[2])
    for (base[1] = -1; base[1] < static_cast<std::ptrdiff_t>(image.size(1)); ++base[1])
      for (base[0] = -1; base[0] < static_cast<std::ptrdiff_t>(image.size(0)); ++base[0]) count_faces_at();
  return 2 * euler;
}

}  // namespace tegl::test
