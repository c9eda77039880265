// SPDX-License-Identifier: BSD-3-Clause
//
// Floating-point determinant for orientations of frames (private to the generator).
#pragma once

#include <array>
#include <cmath>
#include <utility>

namespace tegl::gen {

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
