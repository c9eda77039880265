// SPDX-License-Identifier: BSD-3-Clause
//
// Vectors and square matrices of double, as plain arrays. tegl/eigen.hpp has views of them for Eigen.
#pragma once

#include <array>
#include <cstddef>

namespace tegl {

/// N numbers, one for each axis.
template <int N>
using Vector = std::array<double, N>;

/// An N x N matrix, row first: the element in row r and column c is matrix[r][c].
template <int N>
using Matrix = std::array<Vector<N>, N>;

/// The N x N matrix with 1 on the diagonal and 0 elsewhere.
template <int N>
[[nodiscard]] constexpr Matrix<N> identity() noexcept {
  Matrix<N> matrix{};
  for (std::size_t a = 0; a < N; ++a) matrix[a][a] = 1.0;
  return matrix;
}

/// The vector with 1 at `axis` and 0 elsewhere; 0 <= axis < N.
template <int N>
[[nodiscard]] constexpr Vector<N> unit_vector(int axis) noexcept {
  Vector<N> vector{};
  vector[static_cast<std::size_t>(axis)] = 1.0;
  return vector;
}

}  // namespace tegl
