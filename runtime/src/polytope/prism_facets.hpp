// SPDX-License-Identifier: BSD-3-Clause
//
// The 3D facets of prisms over polyhedra: the polyhedron at both ends, and a prism over each face.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "polytope/polytope_faces.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// A facet of a prism. Its rings give its own orientation.
struct PrismFacet {
  enum class Kind : std::uint8_t { end, wedge, hexahedron, prism };

  PolytopeFaces shape;                ///< of an end: the prism itself, whose rings are the rings of its base
  Kind kind;                          ///< wedges and hexahedra have tables in other cells; `prism` has a larger base
  std::vector<std::uint8_t> corners;  ///< of the cell, by corner of the facet
  std::vector<std::uint16_t> edges;   ///< of the cell, by edge of the facet
  /// Whether the facet's own orientation, followed by a direction into the cell, is opposite to the cell's orientation.
  bool is_inverted;

  [[nodiscard]] bool is_tabled() const noexcept { return kind == Kind::wedge || kind == Kind::hexahedron; }
};

/// The facets of a prism: both ends, then by face of the base. A prism over a face has the corners around the face at
/// the lower end, then those at the upper end. `shape` must outlive the facets.
[[nodiscard]] std::vector<PrismFacet> facets_of_prism(const PolytopeFaces& shape);
/// One of these facets.
[[nodiscard]] PrismFacet facet_of_prism(const PolytopeFaces& shape, std::size_t facet);

/// The corners of a hexahedron in the order of the tables, as corners of a facet: bit i of the place is a coordinate.
inline constexpr std::array<std::uint8_t, 8> kHexahedronCorners = {0, 1, 3, 2, 4, 5, 7, 6};

/// Four ascending numbers of a facet that is not tabled, which no other facet of a complex has, whatever the numbering
/// of the cell: its smallest points that are not in one polygon, three of them the smallest of all. Several polyhedra
/// may have four such points in common if they are entangled; their ends have the smallest point and the polyhedron.
/// `points`: at the cell's corners; `entangled`: Polytopes::entangled_base.
[[nodiscard]] std::array<Index, 4> key_of_facet(const PrismFacet& facet, const Index* points,
                                                std::optional<Index> entangled);

}  // namespace tegl::detail
