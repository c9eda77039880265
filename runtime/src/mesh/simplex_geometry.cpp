// SPDX-License-Identifier: BSD-3-Clause
//
// Normal vectors of simplices, from determinants.
#include "mesh/simplex_geometry.hpp"

#include <Eigen/LU>

namespace tegl::detail {

template <int N>
PointOf<N> normal_vector_by_minors(const std::array<PointOf<N>, N>& corners) noexcept {
  using Minor = Eigen::Matrix<double, N - 1, N - 1>;
  constexpr double kFactorial = [] {
    double product = 1.0;
    for (int k = 2; k < N; ++k) product *= k;
    return product;
  }();
  PointOf<N> normal;
  for (int a = 0; a < N; ++a) {
    Minor minor;
    for (int row = 0, b = 0; b < N; ++b) {
      if (b == a) continue;
      for (int j = 0; j < N - 1; ++j) minor(row, j) = corners[j + 1][b] - corners[0][b];
      ++row;
    }
    const double cofactor = minor.determinant();
    normal[a] = ((a + N - 1) % 2 == 0 ? cofactor : -cofactor) / kFactorial;
  }
  return normal;
}

template PointOf<2> normal_vector_by_minors<2>(const std::array<PointOf<2>, 2>&) noexcept;
template PointOf<5> normal_vector_by_minors<5>(const std::array<PointOf<5>, 5>&) noexcept;

}  // namespace tegl::detail
