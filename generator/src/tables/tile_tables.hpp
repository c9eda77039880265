// SPDX-License-Identifier: BSD-3-Clause
//
// Tables as plain data, the input of all emitters. Built from certified contours and regions and checked against each
// other before anything is written.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/lattice.hpp"
#include "base/tile_contour.hpp"
#include "filling/facets.hpp"
#include "filling/pairs.hpp"
#include "filling/position_search.hpp"
#include "filling/regions.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

/// Storage of lists: one per class, or one per signature.
enum class Layout { by_class, flat };
const char* layout_name(Layout l) noexcept;  ///< "class", "flat"

/// Owning counterpart of tables::TileTable, which documents the members.
struct TileTables {
  TileKind tile = TileKind::cube;                            ///< the kind of tile
  std::vector<std::array<double, 4>> corners;                ///< coordinates; only the first `dim` are used
  std::vector<std::array<std::uint8_t, 2>> edges;            ///< corners at the lower and upper end
  std::vector<std::vector<std::uint8_t>> faces;              ///< corners of each face
  std::uint32_t first_tile_vertex = 0;                       ///< first local number of a tile's own vertices
  int dim = 0;                                               ///< dimension of the tile
  Triangulation triangulation = Triangulation::barycentric;  ///< triangulation of facets
  Layout layout = Layout::flat;                              ///< storage of lists
  std::uint32_t permutation_stride = 0;                      ///< as in tables::TileTable
  std::uint32_t max_simplices = 0;                           ///< maximum over all signatures
  std::uint32_t max_tile_vertices = 0;                       ///< maximum over all signatures
  std::uint64_t total_simplices = 0;                         ///< sum over all signatures in either layout
  std::vector<std::uint16_t> list_of;                        ///< as in tables::TileTable
  std::vector<std::uint16_t> element_of;                     ///< as in tables::TileTable
  std::vector<std::uint8_t> slot_swaps;                      ///< as in tables::TileTable
  std::vector<std::uint8_t> permutations;                    ///< as in tables::TileTable
  std::vector<std::uint8_t> reverses;                        ///< as in tables::TileTable
  std::vector<tables::List> lists;                           ///< as in tables::TileTable
  std::vector<std::uint8_t> simplices;                       ///< as in tables::TileTable
  std::vector<std::uint64_t> side_masks;                     ///< as in tables::TileTable

  /// A view in the runtime's form, valid while this object lives and is not modified.
  [[nodiscard]] tables::TileTable view() const;
};

/// Owning counterpart of tables::RegionTable.
struct RegionTables {
  int dim = 0;                                               ///< dimension of the tile
  Triangulation triangulation = Triangulation::barycentric;  ///< triangulation of regions
  Alternative alternative = Alternative::low;                ///< resolution of ambiguous squares
  std::uint32_t max_own_vertices = 0;                        ///< maximum over all signatures
  std::vector<tables::RegionList> lists;                     ///< as in tables::RegionTable
  std::vector<std::uint8_t> simplices;                       ///< as in tables::RegionTable
  std::vector<std::uint32_t> masks;                          ///< as in tables::RegionTable
};

/// An entry that is not proved to be embedded, and was searched for all entries of its class.
struct SearchedEntry {
  Signature signature = 0;    ///< the smallest of the class
  std::uint64_t entries = 0;  ///< number of signatures that it stands for
  std::uint64_t pairs = 0;    ///< pairs of its simplices that are not proved to be apart
};

/// Counts made while certifying one triangulation of one alternative.
struct CertifiedFigures {
  Alternative alternative = Alternative::low;                ///< resolution of ambiguous squares
  Triangulation triangulation = Triangulation::barycentric;  ///< triangulation of facets
  std::uint64_t signatures = 0;                              ///< number of signatures; all are certified
  std::uint64_t simplices = 0;                               ///< sum over all signatures
  std::uint32_t max_simplices = 0;                           ///< maximum over all signatures
  std::uint64_t facets = 0;                                  ///< sum over all signatures
  std::uint32_t max_facets = 0;                              ///< maximum over all signatures
  std::uint64_t spheres = 0;                                 ///< spherical components of Sigma
  std::uint64_t others = 0;                                  ///< non-spherical components of Sigma
  std::uint32_t highest_genus = 0;                           ///< of a component of Sigma; n = 4
  std::uint64_t signatures_with_others = 0;                  ///< signatures with a facet that is not a ball
  std::vector<Signature> classes_with_others;                ///< representatives, ascending
  std::array<std::uint64_t, 4> by_filling{};                 ///< number of facets by Filling
  std::uint64_t embedded = 0;                                ///< signatures proved to be embedded
  std::uint64_t searched = 0;                                ///< other signatures, embedded as far as a search shows
  std::vector<SearchedEntry> searches;                       ///< one per class of these, by ascending signature
  SearchPlan plan;                                           ///< the positions that each search tried
  PairFigures pairs;                                         ///< pairs of neighbours; all 0 if pairs were not certified
};

/// Makes the contours of all signatures by `make`, thread-safe, and certifies each as a contour of `builder`.
/// `classes`: of the builder's tile. Uses all processors; the result does not depend on their number. Throws
/// Error{CertificateFailed} with the first signature that fails.
std::vector<TileContour> certified_contours(const ContourBuilder& builder,
                                            const std::function<TileContour(Signature)>& make,
                                            const Transversal& classes, CertifiedFigures& figures);

/// Counts the contours that are proved to be embedded for all positions, and searches the others
/// (filling/embedding_evidence.hpp). Of contours that a symmetry carries into each other, one is searched. Throws
/// Error{CertificateFailed} with the first signature whose simplices intersect for some positions. `classes`: of the
/// builder's tile.
void certify_embedding(const ContourBuilder& builder, const std::vector<TileContour>& contours,
                       const TileClasses& classes, CertifiedFigures& figures);

/// The numbers of proved and searched signatures and the searches, as members of a JSON object.
std::string evidence_json(const CertifiedFigures& figures);

/// Throws Error{Internal} unless, for every signature s, the contour `high[s]` is `low[~s]` with reversed orientation,
/// vertex by vertex. This property lets one table serve both alternatives.
void check_inversion(int dim, const std::vector<TileContour>& low, const std::vector<TileContour>& high);

/// Packs contours. `classes`: of the builder's tile; read for the class layout only. For the class layout, checks that
/// the symmetry group maps the representative's list to every signature's list, orientation included; throws
/// Error{Internal} if not (compact tables are not equivariant).
TileTables make_tile_tables(const ContourBuilder& builder, const std::vector<TileContour>& contours, Layout layout,
                            const TileClasses& classes);

/// Packs the regions of the k-tile that close the contours of (k+1)-dimensional images.
RegionTables make_region_tables(const RegionBuilder& builder, Triangulation triangulation, Alternative alternative);

/// FNV-1a digest (64 bit) over all entries of a table, as recorded in the manifest.
std::uint64_t digest(const TileTables& table);
/// FNV-1a digest (64 bit) over all entries of a region table.
std::uint64_t digest(const RegionTables& table);

}  // namespace tegl::gen
