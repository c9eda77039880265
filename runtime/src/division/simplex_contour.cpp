// SPDX-License-Identifier: BSD-3-Clause
#include "division/simplex_contour.hpp"

#include <bit>
#include <utility>

#include <Eigen/Dense>

#include "base/monotone_paths.hpp"

namespace tegl::detail {
namespace {

/// The ends of a path's edges, as numbers of vertices.
template <int N>
std::array<std::array<int, 2>, N> ends_of(unsigned signature, const std::array<VertexPair, N>& path) {
  std::array<std::vector<int>, 2> sides;  // low, high
  for (int i = 0; i <= N; ++i) sides[(signature >> i) & 1u].push_back(i);
  std::array<std::array<int, 2>, N> ends;
  for (std::size_t i = 0; i < N; ++i) ends[i] = {sides[1][path[i].first], sides[0][path[i].second]};
  return ends;
}

/// Whether the positive side of the simplex between the midpoints of edges (high end first) faces the high vertices, in
/// the simplex of the origin and the unit vectors.
template <int N>
bool faces_high(const std::array<std::array<int, 2>, N>& ends) {
  using Vector = Eigen::Matrix<double, N, 1>;
  const auto vertex = [](int i) { return i == 0 ? Vector(Vector::Zero()) : Vector(Vector::Unit(i - 1)); };
  const auto middle = [&](int i) { return Vector(0.5 * (vertex(ends[i][0]) + vertex(ends[i][1]))); };
  Eigen::Matrix<double, N, N> frame;
  for (int i = 1; i < N; ++i) frame.col(i - 1) = middle(i) - middle(0);
  frame.col(N - 1) = vertex(ends[0][0]) - vertex(ends[0][1]);  // crosses the contour, from low to high
  return frame.determinant() > 0;
}

}  // namespace

template <int N>
SimplexContour<N>::SimplexContour() {
  for (unsigned signature = 0; signature < 1u << (N + 1); ++signature) {
    const int high = std::popcount(signature);
    if (high > 0 && high <= N)
      for_each_monotone_path<N>(high, [&](const std::array<VertexPair, N>& path) {
        auto ends = ends_of<N>(signature, path);
        if (!faces_high<N>(ends)) std::swap(ends[N - 2], ends[N - 1]);
        Simplex& simplex = simplices_.emplace_back();
        for (std::size_t i = 0; i < N; ++i)
          simplex[i] = static_cast<std::uint8_t>(
              edge_number<N>(std::min(ends[i][0], ends[i][1]), std::max(ends[i][0], ends[i][1])));
      });
    first_[signature + 1] = static_cast<std::uint16_t>(simplices_.size());
  }
}

template <int N>
const SimplexContour<N>& SimplexContour<N>::instance() {
  static const SimplexContour contour;
  return contour;
}

template class SimplexContour<2>;
template class SimplexContour<3>;
template class SimplexContour<4>;
template class SimplexContour<5>;

}  // namespace tegl::detail
