// SPDX-License-Identifier: BSD-3-Clause
//
// The complete table of the 3D cube: every signature, every resolution of its ambiguous squares, and in the cube every
// way: its polygons kept apart, or joined as a low or a high centre joins them. 656 entries, as plain data that the
// emitters write.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tegl/table_contract.hpp"

namespace tegl::gen {

/// The table of the cube with every ambiguity resolved freely.
struct ResolvedCube {
  std::vector<std::array<std::uint8_t, 4>> squares;  ///< the corners of each of the 6 squares
  std::vector<std::uint16_t> first_entry;            ///< by signature: its entry of resolution 0
  std::vector<std::uint8_t> ambiguous;               ///< by signature: set of its ambiguous squares
  std::vector<tables::ResolvedEntry> entries;        ///< the lists of every resolution
  std::vector<std::uint8_t> triangles;               ///< 3 local vertices each
  std::vector<std::uint16_t> masks;                  ///< own vertex: set of the edges whose points it is the mean of
};

/// A polygon that the compact table has for the signature is triangulated as there. Else searches, for every entry and
/// every way, the triangulation with no vertex but edge points whose inner edges are shortest (points halfway along
/// their edges); where the certificate allows none, with one more vertex; where it allows none of these either, a copy
/// of the region between the polygons. Each passes the certificate. Errors: CertificateFailed, naming signature and
/// resolution.
[[nodiscard]] ResolvedCube make_resolved_cube();

/// Digest (FNV-1a) of all numbers.
[[nodiscard]] std::uint64_t digest(const ResolvedCube& table);

}  // namespace tegl::gen
