// SPDX-License-Identifier: BSD-3-Clause
//
// A slow independent contour as a reference. Every tile is divided into N! simplices (Kuhn). In each of them the
// contour is the product of the simplices of its high and low corners, triangulated by staircases. It is closed,
// manifold and oriented by construction, without any table. In ambiguous tiles its topology may differ from the tile's
// contour.
//
// Based on: H. W. Kuhn, Some combinatorial lemmas in topology, 1960 (the triangulation of the cube); S. Eilenberg and
// N. Steenrod, Foundations of algebraic topology, 1952, II.8 (the triangulation of products).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "fields.hpp"
#include "tegl/contour.hpp"

namespace tegl::test {

template <int N, class Real, Value T>
class SimplicialContour {
 public:
  SimplicialContour(const Image<T, N>& image, double isovalue) : image_(image), isovalue_(isovalue) {
    Grid<N> tiles = image.grid();
    for (Axis& axis : tiles.axes) {
      if (axis.size() < 2) return;
      axis = Axis::uniform(axis.size() - 1);
    }
    for_each_sample<N>(tiles, [&](std::size_t, const std::array<std::size_t, N>& tile) { add_tile(tile); });
  }
  Contour<N, Real> contour;  ///< direction descent

 private:
  using Corner = std::array<std::size_t, N>;
  using Pair = std::pair<Corner, Corner>;

  void add_tile(const Corner& tile) {
    std::array<int, N> order;
    std::iota(order.begin(), order.end(), 0);
    do {
      std::array<Corner, N + 1> chain{tile};
      for (int i = 0; i < N; ++i) {
        chain[i + 1] = chain[i];
        ++chain[i + 1][order[i]];
      }
      add_simplex(chain);
    } while (std::next_permutation(order.begin(), order.end()));
  }

  void add_simplex(const std::array<Corner, N + 1>& chain) {
    std::vector<Corner> high;
    std::vector<Corner> low;
    for (const Corner& corner : chain) {
      const auto value = static_cast<double>(image_(corner));
      if (std::isnan(value)) return;
      (value >= isovalue_ ? high : low).push_back(corner);
    }
    if (high.empty() || low.empty()) return;
    // A staircase has N - 1 steps, high.size() - 1 of them along the high corners.
    for (unsigned steps = 0; steps < (1u << (N - 1)); ++steps) {
      if (std::popcount(steps) + 1 != static_cast<int>(high.size())) continue;
      std::array<Pair, N> path;
      std::size_t h = 0;
      std::size_t l = 0;
      path[0] = {high[0], low[0]};
      for (int i = 0; i + 1 < N; ++i) {
        ((steps >> i) & 1u) ? ++h : ++l;
        path[i + 1] = {high[h], low[l]};
      }
      add_facet(path, high, low);
    }
  }

  /// Oriented by edge midpoints, which are never degenerate.
  void add_facet(const std::array<Pair, N>& path, const std::vector<Corner>& high, const std::vector<Corner>& low) {
    Eigen::Matrix<double, N, N> frame;
    const auto midpoint = [](const Pair& p, int a) { return 0.5 * static_cast<double>(p.first[a] + p.second[a]); };
    for (int a = 0; a < N; ++a) {
      for (int j = 1; j < N; ++j) frame(a, j - 1) = midpoint(path[j], a) - midpoint(path[0], a);
      frame(a, N - 1) = 0.0;
      for (const Corner& c : low) frame(a, N - 1) += static_cast<double>(c[a]) / static_cast<double>(low.size());
      for (const Corner& c : high) frame(a, N - 1) -= static_cast<double>(c[a]) / static_cast<double>(high.size());
    }
    std::array<Index, N> simplex;
    for (int j = 0; j < N; ++j) simplex[j] = vertex(path[j]);
    if (frame.determinant() < 0) std::swap(simplex[0], simplex[1]);
    contour.simplices.push_back(simplex);
  }

  Index vertex(const Pair& pair) {
    const Corner& a = std::min(pair.first, pair.second);
    const Corner& b = std::max(pair.first, pair.second);
    const auto [at, is_new] = numbers_.try_emplace({a, b}, static_cast<Index>(contour.vertices.size()));
    if (!is_new) return at->second;
    const auto value = static_cast<double>(image_(a));
    const double alpha = (isovalue_ - value) / (static_cast<double>(image_(b)) - value);
    std::array<Real, N> position;
    for (int i = 0; i < N; ++i) {
      const double x = image_.grid().axes[i][a[i]];
      position[i] = static_cast<Real>(x + alpha * (image_.grid().axes[i][b[i]] - x));
    }
    contour.vertices.push_back(position);
    return at->second;
  }

  const Image<T, N>& image_;
  double isovalue_;
  std::map<Pair, Index> numbers_;
};

template <class Real = float, Value T, int N>
Contour<N, Real> simplicial_contour(const Image<T, N>& image, double isovalue) {
  return SimplicialContour<N, Real, T>(image, isovalue).contour;
}

/// Layer i of the last axis as an image of one dimension less. A world map must not mix the last axis with the others;
/// its other rows and columns are kept.
template <Value T, int N>
Image<T, N - 1> last_axis_layer(const Image<T, N>& image, std::size_t i) {
  Grid<N - 1> grid;
  for (int a = 0; a < N - 1; ++a) {
    grid.axes[a] = image.grid().axes[a];
    grid.offset[a] = image.grid().offset[a];
    for (int b = 0; b < N - 1; ++b) grid.linear[a][b] = image.grid().linear[a][b];
  }
  typename Image<T, N - 1>::Strides strides;
  std::copy_n(image.strides().begin(), N - 1, strides.begin());
  return Image<T, N - 1>(image.data() + static_cast<std::ptrdiff_t>(i) * image.strides()[N - 1], grid, strides);
}

/// The layer of an image across any axis, as an image of the other axes. For grids without a world map.
template <Value T, int N>
Image<T, N - 1> layer_across(const Image<T, N>& image, int axis, std::size_t i) {
  Grid<N - 1> grid;
  typename Image<T, N - 1>::Strides strides;
  for (int a = 0, b = 0; a < N; ++a) {
    if (a == axis) continue;
    grid.axes[b] = image.grid().axes[a];
    strides[b++] = image.strides()[a];
  }
  return Image<T, N - 1>(image.data() + static_cast<std::ptrdiff_t>(i) * image.strides()[axis], grid, strides);
}

}  // namespace tegl::test
