// SPDX-License-Identifier: BSD-3-Clause
//
// Equality of two contours as surfaces: up to the numbering of vertices and simplices and the choice of each simplex's
// first vertex. Coordinates are compared bitwise, orientations by the parity of the vertex order.
#pragma once

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tegl/contour.hpp"

namespace tegl::test {

/// A simplex as its corners' coordinates in lexicographic order and the parity of the sorting permutation. A simplex
/// with two equal corners has no orientation: parity 0.
template <int N, class Real>
struct CanonicalSimplex {
  std::array<std::array<Real, N>, N> corners;
  int parity = 0;

  auto operator<=>(const CanonicalSimplex&) const = default;
};

template <int N, class Real>
CanonicalSimplex<N, Real> canonical_simplex(const Contour<N, Real>& contour, std::size_t s) {
  CanonicalSimplex<N, Real> result;
  for (int j = 0; j < N; ++j) {
    result.corners[j] = contour.vertices[contour.simplices[s][j]];
    for (Real& x : result.corners[j]) x += Real{0};  // -0 and +0 are one place
  }
  result.parity = 1;
  for (int i = 0; i < N; ++i)  // insertion sort, as it counts exchanges
    for (int j = i; j > 0 && result.corners[j] < result.corners[j - 1]; --j) {
      std::swap(result.corners[j], result.corners[j - 1]);
      result.parity = -result.parity;
    }
  if (std::adjacent_find(result.corners.begin(), result.corners.end()) != result.corners.end()) result.parity = 0;
  return result;
}

/// The whole contour in canonical form, sorted.
template <int N, class Real>
std::vector<CanonicalSimplex<N, Real>> canonical_simplices(const Contour<N, Real>& contour) {
  std::vector<CanonicalSimplex<N, Real>> result(contour.simplices.size());
  for (std::size_t s = 0; s < result.size(); ++s) result[s] = canonical_simplex(contour, s);
  std::sort(result.begin(), result.end());
  return result;
}

/// The coordinates of all vertices, sorted; coinciding vertices are all kept.
template <int N, class Real>
std::vector<std::array<Real, N>> sorted_vertices(const Contour<N, Real>& contour) {
  std::vector<std::array<Real, N>> result(contour.vertices.begin(), contour.vertices.end());
  for (auto& vertex : result)
    for (Real& x : vertex) x += Real{0};
  std::sort(result.begin(), result.end());
  return result;
}

template <int N, class Real>
std::string describe(const CanonicalSimplex<N, Real>& simplex) {
  std::ostringstream text;
  text.precision(17);
  for (const auto& corner : simplex.corners) {
    text << '(';
    for (int a = 0; a < N; ++a) text << (a ? " " : "") << corner[a];
    text << ") ";
  }
  text << "parity " << simplex.parity;
  return text.str();
}

/// EXPECT_TRUE(same_surface(a, b)): equal vertices and equal oriented simplices. The failure message names the first
/// difference.
template <int N, class Real>
::testing::AssertionResult same_surface(const Contour<N, Real>& a, const Contour<N, Real>& b) {
  if (a.vertices.size() != b.vertices.size() || a.simplices.size() != b.simplices.size())
    return ::testing::AssertionFailure() << a.vertices.size() << " vertices and " << a.simplices.size()
                                         << " simplices against " << b.vertices.size() << " and " << b.simplices.size();
  if (sorted_vertices(a) != sorted_vertices(b)) return ::testing::AssertionFailure() << "the vertices differ";
  const auto first = canonical_simplices(a);
  const auto second = canonical_simplices(b);
  const auto differ = std::mismatch(first.begin(), first.end(), second.begin());
  if (differ.first == first.end()) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "simplex " << describe(*differ.first) << " against "
                                       << describe(*differ.second);
}

}  // namespace tegl::test
