// SPDX-License-Identifier: BSD-3-Clause
//
// A 4D polytope that is given by its facets: checked, oriented, and recognised if it is of a shape that has a table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "polytope/recognised_polyhedron.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The shape of a 4D polytope.
enum class PolytopeKind : std::uint8_t {
  tetrahedron_prism,
  pyramid_prism,
  wedge_prism,
  hexahedron_prism,
  octahedron_prism,
  simplex4,
  cell16,
  other
};

struct RecognisedPolytope {
  PolytopeKind kind = PolytopeKind::other;
  /// The points at the corners: in the order of CellType; of other shapes in the order in which the facets have them
  /// first.
  std::vector<Index> corners = {};
  struct Facet {
    PolyhedronShape shape = PolyhedronShape::other;
    /// Whether the facet's own orientation, followed by a direction into the cell, is opposite to the cell's
    /// orientation, for which facet 0 is not inverted.
    bool is_inverted = false;
    std::vector<std::uint8_t> corners = {};  ///< of the cell; of known shapes in the order of faces_of_known
    std::vector<std::uint8_t> rings = {};    ///< of other shapes, as in RecognisedPolyhedron
    std::vector<std::uint16_t> ends = {};
  };
  std::vector<Facet> facets = {};  ///< of other shapes
};

/// The lists of a polytope. A face has its corners around it, in either direction; both facets at a face list it.
struct PolytopeLists {
  std::span<const Index> corners;             ///< of all faces, one after the other
  std::span<const std::uint64_t> face_ends;   ///< the end of each face in `corners`
  std::span<const std::uint64_t> facet_ends;  ///< the end of each facet in `face_ends`
};

/// Checks the facets of a 4D polytope. `cell` and `points`: for messages, and the number of points. Errors:
/// InvalidArgument unless each facet is a polyhedron (recognise_polyhedron), each face is in two facets, two facets
/// have nothing, a corner, an edge or a face in common, there are at most 64 corners, and the facets are a connected,
/// orientable 3D manifold in which each closed curve of edges bounds faces (modulo 2): all that spheres are known by,
/// except homology spheres.
[[nodiscard]] RecognisedPolytope recognise_polytope(std::size_t cell, std::size_t points, const PolytopeLists& lists);

}  // namespace tegl::detail
