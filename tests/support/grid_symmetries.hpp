// SPDX-License-Identifier: BSD-3-Clause
//
// The symmetries of a grid, applied to images and contours.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "fields.hpp"
#include "tegl/contour.hpp"

namespace tegl::test {

/// Maps axis a to axis `to[a]`, mirrored if `flip[a]`.
template <int N>
struct GridSymmetry {
  std::array<int, N> to{};
  std::array<bool, N> flip{};

  /// True if it reverses orientation.
  [[nodiscard]] bool reverses() const {
    bool odd = false;
    for (int a = 0; a < N; ++a) {
      odd = odd != flip[a];
      for (int b = a + 1; b < N; ++b) odd = odd != (to[a] > to[b]);
    }
    return odd;
  }
  /// The image of a point of an image of `sizes` samples.
  template <class Coordinate>
  [[nodiscard]] std::array<Coordinate, N> move(const std::array<Coordinate, N>& x,
                                               const std::array<std::size_t, N>& sizes) const {
    std::array<Coordinate, N> result{};
    for (int a = 0; a < N; ++a) result[to[a]] = flip[a] ? static_cast<Coordinate>(sizes[a] - 1) - x[a] : x[a];
    return result;
  }
};

/// All 2^N N! symmetries.
template <int N>
std::vector<GridSymmetry<N>> grid_symmetries() {
  std::vector<GridSymmetry<N>> result;
  GridSymmetry<N> symmetry;
  std::iota(symmetry.to.begin(), symmetry.to.end(), 0);
  do {
    for (unsigned flips = 0; flips < 1u << N; ++flips) {
      for (int a = 0; a < N; ++a) symmetry.flip[a] = (flips >> a & 1u) != 0;
      result.push_back(symmetry);
    }
  } while (std::next_permutation(symmetry.to.begin(), symmetry.to.end()));
  return result;
}

template <int N>
std::array<std::size_t, N> sizes_of(const Grid<N>& grid) {
  std::array<std::size_t, N> sizes;
  for (int a = 0; a < N; ++a) sizes[a] = grid.axes[a].size();
  return sizes;
}

/// The transformed image. For grids of unit steps.
template <Value T, int N>
OwnedImage<T, N> moved(const OwnedImage<T, N>& image, const GridSymmetry<N>& symmetry) {
  const auto sizes = sizes_of(image.grid);
  std::array<std::size_t, N> moved_sizes;
  for (int a = 0; a < N; ++a) moved_sizes[symmetry.to[a]] = sizes[a];
  OwnedImage<T, N> result{Grid<N>::unit(moved_sizes), std::vector<T>(image.values.size())};
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    const auto to = symmetry.move(index, sizes);
    std::size_t place = 0;
    for (int a = N - 1; a >= 0; --a) place = place * moved_sizes[a] + to[a];
    result.values[place] = image.values[i];
  });
  return result;
}

template <int N, class Real>
Contour<N, Real> moved(Contour<N, Real> contour, const GridSymmetry<N>& symmetry,
                       const std::array<std::size_t, N>& sizes) {
  for (auto& vertex : contour.vertices) vertex = symmetry.move(vertex, sizes);
  if (symmetry.reverses())
    for (auto& simplex : contour.simplices) std::swap(simplex[0], simplex[1]);
  return contour;
}

}  // namespace tegl::test
