// SPDX-License-Identifier: BSD-3-Clause
//
// The cube by recursion over its squares, as its builder is emitted: polygons on the boundary, polygons that are
// joined, and the filling of each facet as a function of its polygons.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cubes/cube_frame.hpp"
#include "cubes/resolved_cube.hpp"
#include "tegl/tile/choices.hpp"

namespace tegl::gen {

/// Order in which a builder visits the squares (numbers 2 axis + side): the order of tile::FaceLattice, so facets are
/// in the order of tile::FacetBuilder.
inline constexpr std::array<std::uint8_t, 6> kSquareOrder = {4, 2, 0, 1, 3, 5};

/// How the ambiguous squares of a cube are resolved, and what depends on that, as a bit of a set.
enum Squares : std::uint8_t {
  kNoneHigh = 1,  ///< all are low, or there is none
  kMixed = 2,     ///< some low, some high
  kAllHigh = 4,   ///< all are high
  kHexagons = 8,  ///< some low, some high, and the facets are two hexagons, whose discs might intersect
};

/// The polygons, each from its smallest edge on, in the order in which the squares, visited in kSquareOrder, have their
/// first segments.
[[nodiscard]] std::vector<CubePolygon> cube_polygons(unsigned signature, unsigned high_squares);

/// The polygons of each facet, by index. Low centre: polygons around the same high region are joined; high centre:
/// those around the same low region. Facets of one polygon come first.
[[nodiscard]] std::vector<std::vector<std::size_t>> cube_facets(unsigned signature, unsigned high_squares,
                                                                tile::Choice centre,
                                                                const std::vector<CubePolygon>& polygons);

/// A facet's filling. Vertices below 12 are edge points; 12 + j is own vertex j, with mask j as in ResolvedTable.
struct CubeFilling {
  std::vector<CubeTriangle> triangles;
  std::vector<std::uint32_t> masks;
  friend bool operator==(const CubeFilling&, const CubeFilling&) = default;
};

/// The filling of the facets with these polygons, if the ambiguous squares are resolved as one of `squares`.
struct FillingRow {
  std::uint64_t key;                  ///< polygon_key of the facet
  unsigned squares;                   ///< set of Squares
  std::vector<CubePolygon> polygons;  ///< for comments
  CubeFilling filling;
};

/// The polygons as a number: bits 4 e to 4 e + 3 hold 1 + the edge after edge e, or 0 if no polygon has edge e.
[[nodiscard]] std::uint64_t polygon_key(const std::vector<CubePolygon>& polygons);

/// The filling as a function of polygons and resolution, ascending by key. Proves that the recursion with this function
/// gives every list of the table, triangle by triangle. Errors: CertificateFailed.
[[nodiscard]] std::vector<FillingRow> make_filling_rule(const ResolvedCube& table);

/// The table in the barycentric triangulation: every facet of one polygon with more than three edges is coned from its
/// barycentre, whose mask has kBarycentreBit and the polygon's edges. Joined polygons, and polygons with own vertices
/// on rays, are filled as in the table.
[[nodiscard]] ResolvedCube coned(const ResolvedCube& table);
inline constexpr unsigned kBarycentreBit = 20;

/// Certifies the contour of every list of the table in its cube, with all facets. Errors: CertificateFailed.
void certify_lists(const ResolvedCube& table);

/// The fillings of a list of the table, one per facet.
[[nodiscard]] std::vector<CubeFilling> fillings_of(const ResolvedCube& table, const tables::ResolvedList& list);

/// Calls `visit(signature, high_squares, entry)` for every entry of the table.
template <class Visit>
void for_each_resolution(const ResolvedCube& table, const Visit& visit) {
  for (unsigned signature = 0; signature < 256; ++signature) {
    const unsigned ambiguous = table.ambiguous[signature];
    std::size_t entry = table.first_entry[signature];
    unsigned high = 0;
    do {
      visit(signature, high, table.entries[entry++]);
      high = (high - ambiguous) & ambiguous;
    } while (high != 0);
  }
}

}  // namespace tegl::gen
