// SPDX-License-Identifier: BSD-3-Clause
//
// The 3D facets of 4D polytopes. Those of a prism over a polyhedron are the polyhedron at both ends, and a prism over
// each face; other polytopes are given by their facets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "polytope/polytope_faces.hpp"
#include "polytope/polytope_shape.hpp"
#include "polytope/recognised_polyhedron.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// A facet of a 4D polytope. Its rings give its own orientation.
struct SolidFacet {
  /// The ends of a prism have the contours of the polyhedron at one time. Shapes with tables in other cells are named.
  enum class Kind : std::uint8_t { tetrahedron, pyramid, wedge, hexahedron, octahedron, end, other };

  PolytopeFaces shape;  ///< of an end: the prism itself, whose rings are the rings of its base
  Kind kind;
  std::vector<std::uint8_t> corners;  ///< of the cell, by corner of the facet
  std::vector<std::uint16_t> edges;   ///< of the cell, by edge of the facet
  /// Whether the facet's own orientation, followed by a direction into the cell, is opposite to the cell's orientation.
  bool is_inverted;

  [[nodiscard]] bool is_tabled() const noexcept { return kind < Kind::end; }
};

// both have the shapes with tables in one order
static_assert(static_cast<int>(SolidFacet::Kind::octahedron) == static_cast<int>(PolyhedronShape::octahedron));

/// The facets of a 4D polytope that is given by them.
struct PolytopeSolids {
  struct Solid {
    SolidFacet::Kind kind;
    bool is_inverted;
    std::uint32_t first_corner;  ///< in `corners`; they end where those of the next facet begin
    std::uint32_t first_edge;    ///< in `edges`; they end where those of the next facet begin
    std::uint32_t lattice;       ///< in `lattices`; not of facets with a table
  };
  std::vector<Solid> solids;
  std::vector<std::uint8_t> corners;
  std::vector<std::uint16_t> edges;
  std::vector<PolytopeShape> lattices;
};

/// A shape with a table: corners in the order of the tables, of wedges and hexahedra in VTK's order.
[[nodiscard]] PolytopeFaces faces_of_known(PolyhedronShape shape);
/// The place in this order of corner i in the order of RecognisedPolyhedron.
[[nodiscard]] std::size_t known_corner(PolyhedronShape shape, std::size_t i) noexcept;

/// The facets of a 4D polytope. Those of a prism: both ends, then by face of the base; a prism over a face has the
/// corners around the face at the lower end, then those at the upper end. `shape` must outlive the facets.
[[nodiscard]] std::vector<SolidFacet> facets_of_solid(const PolytopeFaces& shape);
/// One of these facets.
[[nodiscard]] SolidFacet facet_of_solid(const PolytopeFaces& shape, std::size_t facet);

/// The corners of a hexahedron in the order of the tables, as corners of a facet: bit i of the place is a coordinate.
inline constexpr std::array<std::uint8_t, 8> kHexahedronCorners = {0, 1, 3, 2, 4, 5, 7, 6};

/// Four ascending numbers of a facet that is not tabled, which no other facet of a complex has, whatever the numbering
/// of the cell: its smallest points that are not in one polygon, three of them the smallest of all. Several facets may
/// have four such points in common if their cells are entangled; these have the smallest point and their name.
/// `points`: at the cell's corners; `name`: Polytopes::entangled_facet.
[[nodiscard]] std::array<Index, 4> key_of_facet(const SolidFacet& facet, const Index* points,
                                                std::optional<Index> name);

}  // namespace tegl::detail
