// SPDX-License-Identifier: BSD-3-Clause
//
// The linear systems of quadrics.
#include "simplify/quadric.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace tegl::detail {

template <int N>
PointN<N> solve_positive(const std::array<double, N * N>& a, const PointN<N>& b) {
  const Eigen::Matrix<double, N, N> matrix = Eigen::Map<const Eigen::Matrix<double, N, N>>(a.data());
  const Eigen::Matrix<double, N, 1> x = matrix.llt().solve(Eigen::Map<const Eigen::Matrix<double, N, 1>>(b.data()));
  PointN<N> result;
  for (int i = 0; i < N; ++i) result[i] = x(i);
  return result;
}

template PointN<2> solve_positive<2>(const std::array<double, 4>&, const PointN<2>&);
template PointN<3> solve_positive<3>(const std::array<double, 9>&, const PointN<3>&);
template PointN<4> solve_positive<4>(const std::array<double, 16>&, const PointN<4>&);

}  // namespace tegl::detail
