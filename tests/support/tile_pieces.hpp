// SPDX-License-Identifier: BSD-3-Clause
//
// A contour tile by tile, without its triangulation: per tile and component, the critical edges that it meets and its
// Euler characteristic. Contours with equal pieces differ at most in the triangulation of facets. So contours can be
// compared if their triangulations cannot be equal, such as those of an image and its mirror image, or a slice of a 4D
// contour and the 3D contour.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "multilinear.hpp"
#include "tegl/check.hpp"
#include "tegl/contour.hpp"

namespace tegl::test {

template <int N>
struct TilePiece {
  std::array<std::int64_t, N> tile{};                ///< index of its lowest sample
  std::vector<std::array<std::int64_t, N>> edges{};  ///< points on the grid's edges, in units of 2^-20, sorted
  std::int64_t euler = 0;

  auto operator<=>(const TilePiece&) const = default;
};

/// Rounds to units of 2^-20. Rounding errors are smaller and change the result for at most one coordinate in 10^9.
template <int N, class Real>
std::array<std::int64_t, N> in_small_units(const std::array<Real, N>& place) {
  std::array<std::int64_t, N> result;
  for (int a = 0; a < N; ++a) result[a] = std::llround(static_cast<double>(place[a]) * 0x1p20);
  return result;
}

/// The simplices of each tile, assigned by centroid.
template <int N, class Real>
std::map<std::array<std::int64_t, N>, std::vector<std::size_t>> simplices_by_tile(const Contour<N, Real>& contour) {
  std::map<std::array<std::int64_t, N>, std::vector<std::size_t>> result;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
    std::array<std::int64_t, N> tile;
    for (int a = 0; a < N; ++a) {
      double sum = 0;
      for (const Index v : contour.simplices[s]) sum += static_cast<double>(contour.vertices[v][a]);
      tile[a] = static_cast<std::int64_t>(std::floor(sum / N));
    }
    result[tile].push_back(s);
  }
  return result;
}

/// The pieces of a contour, sorted. For images on grids of unit steps without vertices at samples.
template <int N, class Real>
std::vector<TilePiece<N>> tile_pieces(const Contour<N, Real>& contour) {
  std::vector<TilePiece<N>> result;
  for (const auto& [tile, simplices] : simplices_by_tile(contour)) {
    std::map<Index, Index> local;
    for (const std::size_t s : simplices)
      for (const Index v : contour.simplices[s]) local.emplace(v, static_cast<Index>(local.size()));
    Pieces pieces(local.size());
    for (const std::size_t s : simplices)
      for (const Index v : contour.simplices[s]) pieces.join(local[v], local[contour.simplices[s][0]]);
    std::map<std::size_t, std::vector<Index>> listed;  // local numbers of the simplices' vertices, by piece
    for (const std::size_t s : simplices)
      for (const Index v : contour.simplices[s]) listed[pieces.find(local[v])].push_back(local[v]);
    std::map<std::size_t, TilePiece<N>> found;
    const std::vector<double> nowhere(local.size() * N);
    for (const auto& [root, vertices] : listed) found[root] = {tile, {}, check(N - 1, vertices, N, nowhere).euler};
    for (const auto& [v, number] : local)
      if (std::count_if(contour.vertices[v].begin(), contour.vertices[v].end(),
                        [](Real x) { return x != std::floor(x); }) == 1)
        found[pieces.find(number)].edges.push_back(in_small_units<N>(contour.vertices[v]));
    for (auto& [root, piece] : found) {
      std::sort(piece.edges.begin(), piece.edges.end());
      result.push_back(std::move(piece));
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace tegl::test
