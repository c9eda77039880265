// SPDX-License-Identifier: BSD-3-Clause
//
// The complete table of the 3D cube: every signature, every resolution of its ambiguous squares, and for each the
// polygons kept separate or joined by a low or a high centre. 656 entries, as plain data for the emitters.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tegl/table_contract.hpp"

namespace tegl::gen {

/// The table of the cube with every ambiguity resolved independently.
struct ResolvedCube {
  std::vector<std::array<std::uint8_t, 4>> squares;  ///< the corners of each of the 6 squares
  std::vector<std::uint16_t> first_entry;            ///< by signature: index of its entry for resolution 0
  std::vector<std::uint8_t> ambiguous;               ///< by signature: set of its ambiguous squares
  std::vector<tables::ResolvedEntry> entries;        ///< the lists of every resolution
  std::vector<std::uint8_t> triangles;               ///< 3 local vertices each
  std::vector<std::uint32_t> masks;  ///< per own vertex: its corners (bit v) and edge points (bit 8 + e)
};

/// Builds the table. A polygon is triangulated as a balanced fan (balanced.hpp). If a chord lies in a square, the
/// triangulation on edge points with the shortest inner edges is searched for (points at edge midpoints). If none
/// passes, the search adds one vertex. Several joined polygons bound a radial surface (cube_tunnel.hpp); so do two
/// polygons of a cube whose discs might intersect. Every filling passes the certificate, and no two triangles of a list
/// intersect, wherever the points are on their edges. Errors: CertificateFailed, with signature and resolution.
[[nodiscard]] ResolvedCube make_resolved_cube();

/// FNV-1a digest of all numbers in the table.
[[nodiscard]] std::uint64_t digest(const ResolvedCube& table);

}  // namespace tegl::gen
