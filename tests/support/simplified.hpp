// SPDX-License-Identifier: BSD-3-Clause
//
// Properties that simplification must preserve.
#pragma once

#include <array>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "compare.hpp"
#include "invariants.hpp"
#include "tegl/simplify.hpp"

namespace tegl::test {

/// The methods that preserve the manifold.
inline constexpr std::array kMethods = {SimplifyMethod::quadric, SimplifyMethod::facets, SimplifyMethod::vertices};

inline std::string name(SimplifyMethod method) {
  constexpr std::array kNames = {"quadric", "facets", "vertices", "fast"};
  return kNames[static_cast<std::size_t>(method)];
}

/// Expects equal components and Euler characteristic, an oriented manifold, and a boundary if and only if there was
/// one.
inline void expect_same_topology(const MeshReport& before, const MeshReport& after) {
  EXPECT_TRUE(is_oriented_manifold(after));
  EXPECT_EQ(after.components, before.components);
  EXPECT_EQ(after.euler, before.euler);
  EXPECT_LE(after.degenerate_simplices, before.degenerate_simplices);
  EXPECT_EQ(after.boundary_simplices == 0, before.boundary_simplices == 0);
}

/// The border as sets of points, independent of numbering.
template <int N, class Real>
auto border_points(const Contour<N, Real>& contour) {
  std::set<std::set<std::array<Real, N>>> result;
  for (const auto& face : boundary_faces(contour)) {
    std::set<std::array<Real, N>> points;
    for (const Index v : face) points.insert(contour.vertices[v]);
    result.insert(points);
  }
  return result;
}

}  // namespace tegl::test
