// SPDX-License-Identifier: BSD-3-Clause
//
// Small simplicial complexes, and whether one is a ball or a sphere. From dimension 3 on this is shown, not guessed:
// by a shelling, or else links are recognised by recursion, and a combinatorial manifold that collapses to a point is a
// PL ball (J. H. C. Whitehead, Simplicial spaces, nuclei and m-groups, 1939). What cannot be shown is `other`.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tegl::facets {

/// Number of a vertex within one tile.
using VertexId = std::uint16_t;
/// No vertex.
inline constexpr VertexId kNoVertex = 0xffff;
/// Of a simplex.
inline constexpr int kMaxVertices = 7;

/// The vertices of a simplex; what is not used is kNoVertex, at the end.
using Simplex = std::array<VertexId, kMaxVertices>;
/// A simplex without vertices.
inline constexpr Simplex kNoSimplex = {kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex};
/// A complex, by its simplices of the highest dimension.
using Simplices = std::vector<Simplex>;

/// Number of vertices.
constexpr int size(const Simplex& simplex) noexcept {
  int n = 0;
  while (n < kMaxVertices && simplex[n] != kNoVertex) ++n;
  return n;
}

/// Without vertex i, the others in their order.
constexpr Simplex without(const Simplex& simplex, int i) noexcept {
  Simplex rest = simplex;
  for (; i + 1 < kMaxVertices; ++i) rest[i] = rest[i + 1];
  rest[kMaxVertices - 1] = kNoVertex;
  return rest;
}

/// With `vertex` in front. At most 6 vertices before.
constexpr Simplex with_apex(VertexId vertex, const Simplex& simplex) noexcept {
  Simplex result = kNoSimplex;
  result[0] = vertex;
  for (int i = 1; i < kMaxVertices; ++i) result[i] = simplex[i - 1];
  return result;
}

/// Sorts the vertices; the sign of the permutation.
constexpr int sort_vertices(Simplex& simplex) noexcept {
  int sign = 1;
  for (int i = 1; i < kMaxVertices; ++i)
    for (int j = i; j > 0 && simplex[j] < simplex[j - 1]; --j) {
      const VertexId larger = simplex[j - 1];
      simplex[j - 1] = simplex[j], simplex[j] = larger;
      sign = -sign;
    }
  return sign;
}

/// What a complex is shown to be.
enum class Shape { other, ball, sphere };

/// The shape of the pure complex of some simplices of equal size, 1 to 6, their vertices sorted, none twice.
/// `ball` and `sphere` are proved; a sphere of dimension 3 or more that resists some tries to collapse is `other`.
Shape shape_of(const Simplices& simplices);

/// Does the complex collapse to a circle, in one of some tries? An orientable 3-manifold that does is a solid torus:
/// the regular neighbourhood of that circle.
bool collapses_to_a_circle(const Simplices& simplices);

/// Euler characteristic of the complex.
int euler_characteristic(const Simplices& simplices);

}  // namespace tegl::facets
