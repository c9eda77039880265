// SPDX-License-Identifier: BSD-3-Clause
//
// The facets of squares and cubes before triangulation, with every ambiguity resolved freely: segments, polygons, and
// the triangles of tunnels, each with its boundary. Data of the builder of facets.
//
// Based on: M. Liversage, thesis, 1994, section 7.6 (facets by recursion over dimension).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "builders/cube_lists.hpp"

namespace tegl::gen {

/// A facet in the boundary of another: facet `number` of face 2 a + side, with its incidence number. Face kInside of a
/// cube stands for the segments inside it.
struct FacetBound {
  std::uint8_t face, number;
  std::int8_t sign;
  friend bool operator==(const FacetBound&, const FacetBound&) = default;
};

/// A facet of a square (a segment: start, end) or of a cube (a polygon or a triangle: its sides, head to tail).
struct FaceFacet {
  std::vector<FacetBound> bounds;
  std::uint8_t part = 0;  ///< of a cube: number of the list's part that it belongs to
};

/// The facets of a list of the cube.
struct CubeFacets {
  static constexpr std::uint8_t kInside = 6;  ///< FacetBound::face
  std::vector<FaceFacet> facets;
  std::vector<std::uint8_t> points;                   ///< own vertices of the list that are points of tunnels
  std::vector<std::array<std::uint8_t, 2>> segments;  ///< inside: start and end; an edge, or 12 + index in `points`
};

/// The facets of a square, by signature and sign of its centre. Face 2 a + side of the square is an edge.
[[nodiscard]] std::vector<FaceFacet> square_facets(unsigned signature, bool centre_high);

/// The facets of every list. A connected part of the list with one component of Sigma is a disc, and becomes a polygon;
/// of any other part, a tunnel, each triangle becomes a facet. Errors: CertificateFailed.
[[nodiscard]] std::vector<CubeFacets> make_cube_facets(const CubeLists& lists);

/// Proves for each list: the boundary of each facet is a closed curve; each segment of Sigma bounds one facet, each
/// segment inside two, with opposite signs; facets have, part by part, the points on edges and the Euler characteristic
/// of the triangles; only lists whose centre joins polygons have tunnels. Errors: CertificateFailed, with the list.
void certify_cube_facets(const CubeLists& lists, const std::vector<CubeFacets>& facets);

/// Number of the tesseract's square (kTesseractSquares) that is square q of cube f.
[[nodiscard]] unsigned square_of_cube(unsigned f, unsigned q);

/// The definitions of the arrays of builder4_facets.cpp.
[[nodiscard]] std::string facet_arrays_text(const std::vector<CubeFacets>& facets);

}  // namespace tegl::gen
