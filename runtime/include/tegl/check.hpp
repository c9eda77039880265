// SPDX-License-Identifier: BSD-3-Clause
//
// Is it a manifold? The invariants of a simplicial complex, counted.
#pragma once

#include <cstdint>
#include <span>

#include "tegl/contour.hpp"

namespace tegl {

/// What `check` found. A closed oriented manifold without degenerate simplices has zeros in the last six.
struct MeshReport {
  int dim = 0;                             ///< dimension of the simplices (2 for triangles)
  std::uint64_t vertices = 0;              ///< vertices used by at least one simplex
  std::uint64_t unused_vertices = 0;
  std::uint64_t simplices = 0;
  std::uint64_t components = 0;            ///< connected components (vertices used)
  std::int64_t euler = 0;                  ///< Euler characteristic
  std::uint64_t boundary_simplices = 0;    ///< (dim-1)-faces in exactly one simplex
  std::uint64_t nonmanifold_simplices = 0; ///< (dim-1)-faces in more than two simplices
  std::uint64_t bad_links = 0;             ///< vertices whose link is neither a sphere nor a ball
  std::uint64_t orientation_conflicts = 0; ///< (dim-1)-faces that two simplices run through the same way
  std::uint64_t degenerate_simplices = 0;  ///< repeated vertices, or zero measure
};

/// Counts the invariants of a complex of d-simplices (d = 1, 2, 3) with d + 1 vertex numbers each in
/// `simplices` (#S x (d+1), row = simplex); coordinates #V x space_dim, row = vertex.
/// Errors: InvalidArgument (sizes, a vertex number out of range). O(S log S) time, O(S) memory.
MeshReport check(int d, std::span<const Index> simplices, int space_dim, std::span<const double> coordinates);

template <int N, class Real>
MeshReport check(const Contour<N, Real>& contour);

}  // namespace tegl
