// SPDX-License-Identifier: BSD-3-Clause
//
// Builds a table set in order: contours, certificates, tables, regions.
#include "tables/table_set.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "cubes/ambiguity.hpp"
#include "filling/balanced.hpp"
#include "filling/facets.hpp"
#include "filling/regions.hpp"
#include "filling/resolutions.hpp"
#include "symmetry/counting.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "symmetry/transversal.hpp"

namespace tegl::gen {

namespace {

/// Certifies every pair of neighbours; throws if one does not match.
PairFigures matching_pairs(const ContourBuilder& builder, const std::vector<TileContour>& contours) {
  const PairFigures pairs = certify_pairs(builder, contours);
  if (pairs.unmatched != 0) throw Error(ErrorCode::CertificateFailed, unmatched_text(builder.dim(), pairs));
  return pairs;
}

/// The evidence for the other alternative: its entries are the reversed ones of the complements.
void take_inverse(const CertifiedFigures& of_low, const Transversal& classes, CertifiedFigures& of_high) {
  of_high.embedded = of_low.embedded;
  of_high.searched = of_low.searched;
  of_high.searches = of_low.searches;
  of_high.plan = of_low.plan;
  for (SearchedEntry& entry : of_high.searches)
    entry.signature = classes.representatives[classes.class_of[of_low.signatures - 1 - entry.signature]];
  std::sort(of_high.searches.begin(), of_high.searches.end(),
            [](const SearchedEntry& a, const SearchedEntry& b) { return a.signature < b.signature; });
}

/// Builds and certifies both alternatives of one triangulation and checks their inversion. Returns the low-connected
/// contours.
std::vector<TileContour> certified_low(const ContourBuilder& low, const ContourBuilder& high,
                                       const TileClasses& classes, bool pairs, std::vector<CertifiedFigures>& figures) {
  CertifiedFigures of_low, of_high;
  auto contours = certified_contours(
      low, [&](Signature s) { return low.build(s); }, classes.classes, of_low);
  // Building all compact 4D contours takes most of the time. Of the high-connected ones, a share is built, to see that
  // they are the inverted ones.
  constexpr Signature kShare = 16;
  const auto make_high = [&](Signature s) {
    return low.dim() < 4 || s % kShare == 0 ? high.build(s) : inverted(contours[contours.size() - 1 - s]);
  };
  const auto high_contours = certified_contours(high, make_high, classes.classes, of_high);
  check_inversion(low.dim(), contours, high_contours);
  certify_embedding(low, contours, classes, of_low);
  take_inverse(of_low, classes.classes, of_high);
  if (pairs) {
    of_low.pairs = matching_pairs(low, contours);
    of_high.pairs = matching_pairs(high, high_contours);
  }
  figures.push_back(of_low);
  figures.push_back(of_high);
  return contours;
}

/// The compact table of estimated ambiguities.
TileTables balanced_tables(const Lattice& lattice, const TileClasses& classes) {
  const ContourBuilder builder(lattice, 4, Alternative::low, Triangulation::compact);
  return make_tile_tables(builder, make_balanced_tesseracts(lattice, ambiguous_tesseracts()).contours, Layout::flat,
                          classes);
}

/// Adds row tables, resolved squares and cubes, and the sets of ambiguous tiles.
void add_resolved_tiles(TableSet& set) {
  if (set.dim == 3) set.ambiguous = ambiguous_cubes(*set.resolved), set.joins = make_cube_joins(*set.resolved);
  if (set.dim == 4) set.ambiguous = ambiguous_tesseracts();
  if (set.balanced) set.balanced_rows = make_estimated_rows(*set.balanced, set.ambiguous);
  for (const TileTables& table : set.tiles) {
    if (!has_row_tables(table)) continue;
    const std::string name =
        table.triangulation == Triangulation::compact ? "Compact" : "Barycentric";  // in the name of the variable
    set.rows.push_back({table.triangulation, fmt::format("kTile{}{}Rows", set.dim, name), make_row_tables(table)});
    if (set.dim == 2) set.variants.push_back(make_square_variants(table));
    if (set.dim == 3) set.variants.push_back(make_cube_variants(table, *set.resolved));
    if (set.dim != 4) continue;
    set.rows.push_back({table.triangulation, "kTile4EstimatedBarycentricRows",
                        make_estimated_rows(table, std::vector<bool>(set.ambiguous.size(), true))});
  }
}

}  // namespace

Layout preferred_layout(TileKind tile, int dim, Triangulation triangulation) {
  return tile == TileKind::cube && dim == 4 && triangulation == Triangulation::barycentric ? Layout::by_class
                                                                                           : Layout::flat;
}

TableSet make_table_set(const TableRequest& request) {
  // symmetries, counted twice
  const Lattice lattice(request.tile, request.dim);
  TableSet set;
  set.tile = request.tile;
  set.dim = request.dim;
  set.command = request.command;
  const TileClasses classes = tile_classes(lattice.tile(request.dim));
  // Burnside's lemma by cycle types, independent of the group's elements.
  if (request.tile == TileKind::cube) require_burnside_count(classes.classes, request.dim, GroupKind::Full, false);
  set.group_order = classes.symmetries.size();
  set.orbits = classes.classes.representatives.size();
  // tables and regions of each triangulation
  for (const Triangulation t : request.triangulations) {
    const ContourBuilder low(lattice, request.dim, Alternative::low, t);
    const ContourBuilder high(lattice, request.dim, Alternative::high, t);
    const auto contours =
        certified_low(low, high, classes, request.pairs && request.tile == TileKind::cube, set.figures);
    set.tiles.push_back(make_tile_tables(
        low, contours, request.layout ? request.layout(t) : preferred_layout(request.tile, request.dim, t), classes));
    if (request.tile != TileKind::cube) continue;  // regions close contours of images, whose tiles are cubes
    for (const Alternative a : {Alternative::low, Alternative::high}) {
      // fans in squares: then all regions of cubes are proved, and a slice at a time step equals the 3D contour
      set.regions.push_back(make_region_tables(RegionBuilder(lattice, request.dim - 1, a, t, RegionStyle::fan), t, a));
    }
  }
  if (request.tile != TileKind::cube) return set;
  if (request.dim == 3) set.resolved = make_resolved_cube();
  if (request.dim == 4) set.balanced = balanced_tables(lattice, classes);
  add_resolved_tiles(set);
  return set;
}

std::vector<CertifiedFigures> certify_all(int dim, TileKind tile) {
  const Lattice lattice(tile, dim);
  const TileClasses classes = tile_classes(lattice.tile(dim));
  std::vector<CertifiedFigures> figures;
  for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
    certified_low(ContourBuilder(lattice, dim, Alternative::low, t), ContourBuilder(lattice, dim, Alternative::high, t),
                  classes, tile == TileKind::cube, figures);
  return figures;
}

std::vector<std::uint32_t> ambiguous_faces(const Tile& tile, const tile::FaceLattice& faces, Signature signature) {
  const auto is_diagonal = [&tile](Signature face, Signature ends) {
    if (std::popcount(ends) != 2) return false;  // the two ends, with the face's centre between them
    for (std::size_t i = 0; i < 4; ++i) {
      double between = 0, all = 0;
      for (std::uint32_t v = 0; v < tile.corner_count(); ++v) {
        if ((face >> v & 1u) != 0) all += tile.corners[v][i];
        if ((ends >> v & 1u) != 0) between += tile.corners[v][i];
      }
      if (std::abs(between * std::popcount(face) - 2 * all) > 1e-9) return false;
    }
    return true;
  };
  std::vector<std::uint32_t> result(static_cast<std::size_t>(tile.dim) + 1, 0);
  for (const tile::Face& face : faces.faces())
    if (face.dim >= 2 &&
        (is_diagonal(face.corners, signature & face.corners) || is_diagonal(face.corners, ~signature & face.corners)))
      ++result[static_cast<std::size_t>(face.dim)];
  return result;
}

std::vector<std::uint32_t> ambiguous_faces(const Lattice& lattice, int dim, Signature signature) {
  const Tile& tile = lattice.tile(dim);
  return ambiguous_faces(tile, face_lattice(tile.kind, dim), signature);
}

}  // namespace tegl::gen
