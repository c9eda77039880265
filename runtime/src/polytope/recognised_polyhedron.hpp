// SPDX-License-Identifier: BSD-3-Clause
//
// A polyhedron that is given by its faces: checked, oriented, and recognised if it is of a shape that has a table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// The shape of a polyhedron.
enum class PolyhedronShape : std::uint8_t { tetrahedron, pyramid, wedge, hexahedron, octahedron, other };

struct RecognisedPolyhedron {
  PolyhedronShape shape = PolyhedronShape::other;
  /// The points at the corners: in VTK's order, of an octahedron as pairs of opposite ones; of other shapes in the
  /// order in which the faces have them first.
  std::vector<Index> corners = {};
  std::vector<std::uint8_t> rings = {};  ///< of the faces, as numbers of corners, with one orientation for all
  std::vector<std::uint16_t> ends = {};  ///< of the faces in `rings`
};

/// A cell, or a facet of a cell, for messages.
struct CellPlace {
  CellPlace(std::size_t cell_number,
            std::optional<std::size_t> facet_number = {})  // NOLINT(google-explicit-constructor)
      : cell(cell_number), facet(facet_number) {}
  std::size_t cell;
  std::optional<std::size_t> facet;
  /// Such as "cell 3" or "cell 3, facet 1".
  [[nodiscard]] std::string name() const;
};

/// Checks the faces of a polyhedron. `faces`: the corners of each face around it, in either direction, one face after
/// the other; `ends`: the end of each face. `cell` and `points`: for messages, and the number of points. Errors:
/// InvalidArgument unless each point exists, each face has three corners or more, all different, each edge is in two
/// faces, two faces have nothing, a corner or an edge in common, the faces are one sphere, and there are at most 64
/// corners.
[[nodiscard]] RecognisedPolyhedron recognise_polyhedron(const CellPlace& cell, std::size_t points,
                                                        std::span<const Index> faces,
                                                        std::span<const std::uint64_t> ends);

}  // namespace tegl::detail
