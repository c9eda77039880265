// SPDX-License-Identifier: BSD-3-Clause
//
// Inverse of the map from the grid to the world.
#include "image/locate.hpp"

#include <Eigen/LU>

#include "tegl/eigen.hpp"

namespace tegl::detail {

template <int N>
Matrix<N> inverse_of(const Matrix<N>& matrix) {
  const Eigen::Matrix<double, N, N> linear = as_eigen(matrix);
  const Eigen::Matrix<double, N, N> inverse = linear.inverse();
  return to_matrix(inverse);
}

template Matrix<2> inverse_of<2>(const Matrix<2>&);
template Matrix<3> inverse_of<3>(const Matrix<3>&);
template Matrix<4> inverse_of<4>(const Matrix<4>&);
template Matrix<5> inverse_of<5>(const Matrix<5>&);

}  // namespace tegl::detail
