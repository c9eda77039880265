// SPDX-License-Identifier: BSD-3-Clause
//
// A contour of a tile against the oracle by definition (definition_oracle.hpp).
//
// The contour of an entry meets the boundary of its tile in closed curves or surfaces. Each of them separates one
// component of the high part from one of the low part; and these numbers are the same by the oracle and by the entry:
// - components: curves or surfaces = components of the high part + components of the low part - 1, as the boundary is a
//   sphere;
// - Euler characteristic of a component of a part: 2 - its curves in 3D, half of its surfaces' in 4D;
// - the contour in the tile: as many components as curves or surfaces, each filled by a disc or half of its Euler
//   characteristic. In a cube with a choice, one component for each component of the part that is cut off, with its
//   Euler characteristic.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "definition_oracle.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::test {

/// The corners of an edge of an n-cube, the one whose coordinate is 0 first (table contract).
inline std::array<unsigned, 2> corners_of_edge(int n, unsigned edge) {
  const unsigned axis = edge >> (n - 1), rest = edge & ((1u << (n - 1)) - 1);
  const unsigned base = (rest >> axis << (axis + 1)) | (rest & ((1u << axis) - 1));
  return {base, base | 1u << axis};
}

/// The two parts of a tile's boundary.
struct Parts {
  int n;
  std::vector<std::array<unsigned, 2>> edges;  ///< the corners of each
  Corners high_corners;
  BoundaryPart high, low;

  /// `is_high`: the centres of ambiguous squares.
  Parts(int dim, Corners signature, const BoundaryPart::HasCentre& is_high)
      : n(dim),
        high_corners(signature),
        high(dim, signature, is_high),
        low(dim, ~signature & ((Corners{1} << (1u << dim)) - 1),
            [&](unsigned base, unsigned axes) { return !is_high(base, axes); }) {
    for (unsigned e = 0; e < tables::edge_count(static_cast<std::uint32_t>(dim)); ++e)
      edges.push_back(corners_of_edge(dim, e));
  }
  /// A tile with these faces, which must outlive this object, and edges.
  Parts(const std::vector<PolytopeFace>& faces, std::vector<std::array<unsigned, 2>> of_edges, Corners signature,
        const BoundaryPart::HasCentreOf& is_high)
      : n(faces.back().dim),
        edges(std::move(of_edges)),
        high_corners(signature),
        high(faces, signature, is_high),
        low(faces, ~signature & faces.back().corners, [&](const PolytopeFace& polygon) { return !is_high(polygon); }) {}
};

/// What is wrong; empty: nothing.
inline std::string fault_of_boundary(const Parts& parts, const std::vector<Piece>& separators) {
  std::vector<long> high(parts.high.components()), low(parts.low.components());
  std::set<unsigned> met;
  for (const Piece& separator : separators) {
    std::optional<std::array<std::size_t, 2>> between;
    for (const std::uint8_t v : separator.vertices) {
      if (v >= parts.edges.size()) continue;
      met.insert(v);
      auto [inside, outside] = parts.edges[v];
      if ((parts.high_corners >> inside & 1u) == 0) std::swap(inside, outside);
      if ((parts.high_corners >> inside & 1u) == 0 || (parts.high_corners >> outside & 1u) != 0)
        return "a point on an edge that is not critical";
      const std::array<std::size_t, 2> here = {parts.high.of_corner(inside), parts.low.of_corner(outside)};
      if (between && *between != here) return "a separator of several components";
      between = here;
    }
    if (!between) return "a separator without a point on an edge";
    // In 2D a part is an arc, between two points.
    const long share = parts.n == 4 ? separator.euler : 1;
    high[(*between)[0]] += share;
    low[(*between)[1]] += share;
  }
  unsigned critical = 0;
  for (const auto& [a, b] : parts.edges)
    critical += (parts.high_corners >> a & 1u) != (parts.high_corners >> b & 1u) ? 1 : 0;
  if (met.size() != critical) return "critical edges without a point";
  const std::size_t expected = parts.n == 2 ? 2 * high.size() : high.size() + low.size() - 1;
  if (separators.size() != expected) return "another number of separators";
  for (const auto& [part, sums] : {std::pair(&parts.high, &high), std::pair(&parts.low, &low)})
    for (std::size_t c = 0; c < sums->size(); ++c) {
      const long sum = (*sums)[c];
      const bool agrees = parts.n == 2   ? sum == 2 && part->euler(c) == 1
                          : parts.n == 3 ? part->euler(c) == 2 - sum
                                         : 2 * part->euler(c) == sum;
      if (!agrees) return "a part with another Euler characteristic";
    }
  return "";
}

/// A contour that fills each separator by itself.
inline std::string fault_of_separate(const Parts& parts, const std::vector<VertexSet>& simplices) {
  const auto n = static_cast<unsigned>(parts.n);
  const std::vector<Piece> separators = pieces_of(boundary_of(simplices, n), n - 1);
  std::string fault = fault_of_boundary(parts, separators);
  if (!fault.empty()) return fault;
  const std::vector<Piece> contour = pieces_of(simplices, n);
  if (contour.size() != (n == 2 ? separators.size() / 2 : separators.size())) return "another number of components";
  for (const Piece& piece : contour) {
    if (n < 4 && piece.euler != 1) return "a component that is no disc";
    if (n < 4) continue;
    for (const Piece& separator : separators)
      if (std::binary_search(piece.vertices.begin(), piece.vertices.end(), separator.vertices[0]) &&
          2 * piece.euler != separator.euler)
        return "a component with another Euler characteristic";
  }
  return "";
}

}  // namespace tegl::test
