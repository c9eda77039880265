// SPDX-License-Identifier: BSD-3-Clause
//
// Tables as plain data: what the emitters write, whatever the language. Built from contours and regions,
// certified, and checked against each other before anything is written.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/lattice.hpp"
#include "filling/facets.hpp"
#include "filling/pairs.hpp"
#include "filling/regions.hpp"
#include "filling/tile_contour.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

/// How lists are stored: one for each class, or one for each signature.
enum class Layout { by_class, flat };
const char* layout_name(Layout l) noexcept;  ///< "class", "flat"

/// The owning form of tables::TileTable; see there for every member's meaning.
struct TileTables {
  TileKind tile = TileKind::cube;                            ///< the kind of tile
  std::vector<std::array<double, 4>> corners;                ///< coordinates; the first `dim` count
  std::vector<std::array<std::uint8_t, 2>> edges;            ///< corners at the lower and upper end
  std::vector<std::vector<std::uint8_t>> faces;              ///< corners of each face
  std::uint32_t first_tile_vertex = 0;                       ///< first local number of a tile's own vertices
  int dim = 0;                                               ///< of the tile
  Triangulation triangulation = Triangulation::barycentric;  ///< how facets become simplices
  Layout layout = Layout::flat;                              ///< how lists are stored
  std::uint32_t permutation_stride = 0;                      ///< as in tables::TileTable
  std::uint32_t max_simplices = 0;                           ///< of a tile
  std::uint32_t max_tile_vertices = 0;                       ///< of a tile
  std::uint64_t total_simplices = 0;                         ///< over all signatures, whatever the layout
  std::vector<std::uint16_t> list_of;                        ///< as in tables::TileTable
  std::vector<std::uint16_t> element_of;                     ///< likewise
  std::vector<std::uint8_t> slot_swaps;                      ///< likewise
  std::vector<std::uint8_t> permutations;                    ///< likewise
  std::vector<std::uint8_t> reverses;                        ///< likewise
  std::vector<tables::List> lists;                           ///< likewise
  std::vector<std::uint8_t> simplices;                       ///< likewise
  std::vector<std::uint64_t> side_masks;                     ///< likewise

  /// The same as the runtime's tables are; valid while this one lives.
  [[nodiscard]] tables::TileTable view() const;
};

/// The owning form of tables::RegionTable.
struct RegionTables {
  int dim = 0;                                               ///< of the tile whose regions these are
  Triangulation triangulation = Triangulation::barycentric;  ///< how regions become simplices
  Alternative alternative = Alternative::low;                ///< where squares are ambiguous
  std::uint32_t max_own_vertices = 0;                        ///< of a tile
  std::vector<tables::RegionList> lists;                     ///< as in tables::RegionTable
  std::vector<std::uint8_t> simplices;                       ///< likewise
  std::vector<std::uint32_t> masks;                          ///< likewise
};

/// What was counted while certifying one triangulation of one alternative.
struct CertifiedFigures {
  Alternative alternative = Alternative::low;                ///< where squares are ambiguous
  Triangulation triangulation = Triangulation::barycentric;  ///< how facets become simplices
  std::uint64_t signatures = 0;                              ///< certified, all of them
  std::uint64_t simplices = 0;                               ///< over all signatures
  std::uint32_t max_simplices = 0;                           ///< of a signature
  std::uint64_t facets = 0;                                  ///< over all signatures
  std::uint32_t max_facets = 0;                              ///< of a signature
  std::uint64_t spheres = 0;                                 ///< components of Sigma
  std::uint64_t others = 0;                                  ///< components of Sigma that are no spheres
  std::uint32_t highest_genus = 0;                           ///< n = 4
  std::uint64_t signatures_with_others = 0;                  ///< signatures with a facet that is no ball
  std::vector<Signature> classes_with_others;                ///< representatives, ascending
  std::uint64_t by_filling[5] = {};                          ///< facets by Filling
  PairFigures pairs;                                         ///< of neighbours; all 0 where pairs were not looked at
};

/// The contours of all signatures of one builder, each with its certificate. Uses all processors; the result does
/// not depend on their number. Throws Error{CertificateFailed} naming the first signature that fails.
std::vector<TileContour> certified_contours(const ContourBuilder& builder, CertifiedFigures& figures);

/// Throws Error{Internal} unless, for every signature s, the contour `high[s]` is `low[~s]` with the orientation
/// reversed, vertex by vertex: what lets one table serve both alternatives.
void check_inversion(int dim, const std::vector<TileContour>& low, const std::vector<TileContour>& high);

/// Packs contours. By class: checks that the symmetry group carries the representative's list to every signature's,
/// orientation included, and throws Error{Internal} if not (compact tables are not equivariant).
TileTables make_tile_tables(const ContourBuilder& builder, const std::vector<TileContour>& contours, Layout layout);

/// Regions of the k-tile for closing the contours of (k+1)-dimensional images.
RegionTables make_region_tables(const RegionBuilder& builder, Triangulation triangulation, Alternative alternative);

/// FNV-1a (64 bit) over all entries of a table: what MANIFEST.json records.
std::uint64_t digest(const TileTables& table);
/// Likewise.
std::uint64_t digest(const RegionTables& table);

}  // namespace tegl::gen
