// SPDX-License-Identifier: BSD-3-Clause
#include "division/simplex_contour.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/monotone_paths.hpp"

namespace tegl::detail {
namespace {

template <int N>
using Ends = std::array<std::array<int, 2>, N>;

/// The ends of a path's edges, as numbers of vertices: high, low.
template <int N>
constexpr Ends<N> ends_of(unsigned signature, const std::array<VertexPair, N>& path) {
  std::array<std::array<int, N + 1>, 2> sides{};  // low, high
  std::array<std::size_t, 2> counts{};
  for (int i = 0; i <= N; ++i) {
    const unsigned side = signature >> i & 1u;
    sides[side][counts[side]++] = i;
  }
  Ends<N> ends{};
  for (std::size_t i = 0; i < N; ++i) ends[i] = {sides[1][path[i].first], sides[0][path[i].second]};
  return ends;
}

/// Whether the determinant of a matrix of small integers is positive. By E. H. Bareiss's elimination, 1968, which
/// divides without remainder. The matrix is used up. Arrays of the language, as compilers limit the number of calls in
/// a constant expression.
template <std::size_t N>
constexpr bool has_positive_determinant(int (&m)[N][N]) {
  int last = 1;
  for (std::size_t k = 0; k + 1 < N; ++k) {
    std::size_t pivot = k;
    while (pivot < N && m[pivot][k] == 0) ++pivot;
    if (pivot == N) return false;
    if (pivot != k) {
      for (std::size_t j = 0; j < N; ++j) {
        const int of_pivot = m[pivot][j];
        m[pivot][j] = -m[k][j];
        m[k][j] = of_pivot;
      }
    }
    for (std::size_t i = k + 1; i < N; ++i)
      for (std::size_t j = k + 1; j < N; ++j) m[i][j] = (m[i][j] * m[k][k] - m[i][k] * m[k][j]) / last;
    last = m[k][k];
  }
  return m[N - 1][N - 1] > 0;
}

/// Whether the positive side of the simplex between the midpoints of edges (high end first) faces the high vertices, in
/// the simplex of the origin and the unit vectors.
template <int N>
constexpr bool faces_high(const Ends<N>& ends) {
  const auto coordinate = [](int vertex, int axis) { return vertex == axis + 1 ? 1 : 0; };
  int frame[N][N] = {};  // by row: twice the edges from the first midpoint
  for (int axis = 0; axis < N; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    const auto twice_middle = [&](std::size_t i) {
      return coordinate(ends[i][0], axis) + coordinate(ends[i][1], axis);
    };
    for (std::size_t i = 1; i < N; ++i) frame[i - 1][at] = twice_middle(i) - twice_middle(0);
    // crosses the contour, from low to high
    frame[N - 1][at] = coordinate(ends[0][0], axis) - coordinate(ends[0][1], axis);
  }
  return has_positive_determinant(frame);
}

}  // namespace

template <int N>
constexpr SimplexContour<N>::SimplexContour() {
  std::size_t count = 0;
  for (unsigned signature = 0; signature < 1u << (N + 1); ++signature) {
    const int high = std::popcount(signature);
    if (high > 0 && high <= N)
      for_each_monotone_path<N>(high, [&](const std::array<VertexPair, N>& path) {
        auto ends = ends_of<N>(signature, path);
        if (!faces_high<N>(ends)) std::swap(ends[N - 2], ends[N - 1]);
        Simplex& simplex = simplices_[count++];
        for (std::size_t i = 0; i < N; ++i)
          simplex[i] = static_cast<std::uint8_t>(
              edge_number<N>(std::min(ends[i][0], ends[i][1]), std::max(ends[i][0], ends[i][1])));
      });
    first_[signature + 1] = static_cast<std::uint16_t>(count);
  }
}

template <int N>
const SimplexContour<N>& SimplexContour<N>::instance() noexcept {
  static constexpr SimplexContour contour;
  return contour;
}

template class SimplexContour<2>;
template class SimplexContour<3>;
template class SimplexContour<4>;
template class SimplexContour<5>;

}  // namespace tegl::detail
