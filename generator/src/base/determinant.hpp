// SPDX-License-Identifier: BSD-3-Clause
//
// Determinants (private to the generator): by cofactors, exact for integers, and by elimination in floating point.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tegl::gen {

/// Determinant of `count` rows from `first` on, in the columns of the set `columns` (bit c: column c), by expansion
/// along the first of them. Exact for integers if the products of `count` entries, and their sums, fit.
template <class T, std::size_t Rows, std::size_t Columns>
constexpr T minor_of(const std::array<std::array<T, Columns>, Rows>& rows, std::size_t first, std::size_t count,
                     unsigned columns) {
  if (count == 0) return T{1};
  T sum{};
  bool plus = true;
  for (std::size_t c = 0; c < Columns; ++c) {
    if ((columns >> c & 1u) == 0) continue;
    if (count == 1) return rows[first][c];
    const T part = rows[first][c] * minor_of(rows, first + 1, count - 1, columns & ~(1u << c));
    sum = plus ? sum + part : sum - part;
    plus = !plus;
  }
  return sum;
}

/// Determinant of the leading n x n submatrix, by cofactors.
template <class T, std::size_t N>
constexpr T cofactor_determinant(const std::array<std::array<T, N>, N>& m, std::size_t n = N) {
  return minor_of(m, 0, n, (1u << n) - 1);
}

/// The generalized cross product of n - 1 vectors with n entries: the vector whose product with any x is the
/// determinant of x, followed by the vectors. It is zero if they are linearly dependent.
template <class T, std::size_t Rows, std::size_t Columns>
constexpr std::array<T, Columns> cross_product(const std::array<std::array<T, Columns>, Rows>& rows, std::size_t n) {
  std::array<T, Columns> result{};
  for (std::size_t c = 0; c < n; ++c) {
    const T minor = minor_of(rows, 0, n - 1, ((1u << n) - 1) & ~(1u << c));
    result[c] = c % 2 == 0 ? minor : -minor;
  }
  return result;
}

/// Six times the volume of the tetrahedron (a, b, c, d).
template <class T>
constexpr T six_volumes(const std::array<T, 3>& a, const std::array<T, 3>& b, const std::array<T, 3>& c,
                        const std::array<T, 3>& d) {
  std::array<std::array<T, 3>, 3> m{};
  for (std::size_t i = 0; i < 3; ++i) m[0][i] = b[i] - a[i], m[1][i] = c[i] - a[i], m[2][i] = d[i] - a[i];
  return cofactor_determinant(m);
}

/// Determinant of the leading n x n submatrix, by Gaussian elimination with pivoting.
inline double determinant(std::array<std::array<double, 4>, 4> m, int n) {
  double det = 1;
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int r = c + 1; r < n; ++r)
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    if (m[pivot][c] == 0) return 0;
    if (pivot != c) {
      std::swap(m[pivot], m[c]);
      det = -det;
    }
    det *= m[c][c];
    for (int r = c + 1; r < n; ++r) {
      const double factor = m[r][c] / m[c][c];
      for (int k = c; k < n; ++k) m[r][k] -= factor * m[c][k];
    }
  }
  return det;
}

}  // namespace tegl::gen
