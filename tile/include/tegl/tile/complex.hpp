// SPDX-License-Identifier: BSD-3-Clause
//
// Small simplicial complexes and the recognition of balls and spheres. From dimension 3 on the result is proved: by a
// shelling; otherwise by recursion over links and a collapse, since a combinatorial manifold that collapses to a point
// is a PL ball (J. H. C. Whitehead, Simplicial spaces, nuclei and m-groups, 1939). `other` means: not proved.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tegl::tile {

/// Vertex number within one tile.
using VertexId = std::uint16_t;
/// Marks an unused vertex entry.
inline constexpr VertexId kNoVertex = 0xffff;
/// Maximum number of vertices of a simplex.
inline constexpr int kMaxVertices = 7;

/// The vertices of a simplex; unused entries at the end are kNoVertex.
using Simplex = std::array<VertexId, kMaxVertices>;
/// The simplex without vertices.
inline constexpr Simplex kNoSimplex = {kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex};
/// A complex, given by its simplices of the highest dimension.
using Simplices = std::vector<Simplex>;

/// Number of vertices of the simplex.
[[nodiscard]] constexpr int size(const Simplex& simplex) noexcept {
  unsigned n = 0;
  while (n < simplex.size() && simplex[n] != kNoVertex) ++n;
  return static_cast<int>(n);
}

/// The simplex without vertex i; the other vertices keep their order.
[[nodiscard]] constexpr Simplex without(const Simplex& simplex, int i) noexcept {
  Simplex rest = simplex;
  for (auto at = static_cast<unsigned>(i); at + 1 < rest.size(); ++at) rest[at] = rest[at + 1];
  rest[kMaxVertices - 1] = kNoVertex;
  return rest;
}

/// The simplex with `vertex` added in front. `simplex` has at most 6 vertices.
[[nodiscard]] constexpr Simplex with_apex(VertexId vertex, const Simplex& simplex) noexcept {
  Simplex result = kNoSimplex;
  result[0] = vertex;
  for (unsigned i = 1; i < result.size(); ++i) result[i] = simplex[i - 1];
  return result;
}

/// Sorts the first `count` vertices; returns the sign of the permutation. For simplices of any vertex type.
template <class Vertex, std::size_t Size>
constexpr int sort_vertices(std::array<Vertex, Size>& simplex, int count = static_cast<int>(Size)) noexcept {
  int sign = 1;
  for (unsigned i = 1; i < static_cast<unsigned>(count); ++i)
    for (unsigned j = i; j > 0 && simplex[j] < simplex[j - 1]; --j) {
      const Vertex larger = simplex[j - 1];
      simplex[j - 1] = simplex[j], simplex[j] = larger;
      sign = -sign;
    }
  return sign;
}

/// Proved shape of a complex; `other` if neither is proved.
enum class Shape { other, ball, sphere };

/// Shape of a pure complex. All simplices have the same number of vertices, 1 to 6, sorted, and are distinct. `ball`
/// and `sphere` are proved. A sphere of dimension 3 or more is reported as `other` if no seeded try finds a shelling or
/// a collapse.
[[nodiscard]] Shape shape_of(const Simplices& simplices);

/// True if one of a few seeded tries collapses the complex to a circle. An orientable 3-manifold that collapses to a
/// circle is a solid torus, the regular neighbourhood of that circle.
[[nodiscard]] bool collapses_to_a_circle(const Simplices& simplices);

/// Euler characteristic of the complex.
[[nodiscard]] int euler_characteristic(const Simplices& simplices);

}  // namespace tegl::tile
