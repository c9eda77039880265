// SPDX-License-Identifier: BSD-3-Clause
//
// From a dimension to everything that is emitted for it: contours of both alternatives in both triangulations,
// certified; tables packed; regions.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/lattice.hpp"
#include "filling/resolved_cube.hpp"
#include "tables/tile_tables.hpp"

namespace tegl::gen {

/// Everything that one run of `gen --dim N --out DIR` writes.
struct TableSet {
  TileKind tile = TileKind::cube;          ///< the kind of tile
  int dim = 0;                             ///< its dimension
  std::string command;                     ///< the command line, for the banner
  std::uint64_t group_order = 0;           ///< symmetries of the tile
  std::uint64_t orbits = 0;                ///< classes of signatures under them
  std::vector<CertifiedFigures> figures;   ///< one per certified alternative and triangulation
  std::vector<TileTables> tiles;           ///< one for each triangulation
  std::vector<RegionTables> regions;       ///< of the (dim - 1)-tile
  std::optional<ResolvedCube> resolved{};  ///< 3D cubes
};

/// The layout that measured faster for a dimension and triangulation: by class where the triangulation is
/// equivariant and flat tables would not fit the cache (4D barycentric), else flat.
Layout preferred_layout(TileKind tile, int dim, Triangulation triangulation);

/// What to make.
struct TableRequest {
  TileKind tile = TileKind::cube;                                                                 ///< the kind of tile
  int dim = 0;                                                                                    ///< its dimension
  std::vector<Triangulation> triangulations{Triangulation::barycentric, Triangulation::compact};  ///< which to make
  std::function<Layout(Triangulation)> layout;  ///< empty: preferred_layout
  std::string command;                          ///< for the banner
};

/// Builds and certifies; throws Error{CertificateFailed} or Error{Internal} before anything could be written.
TableSet make_table_set(const TableRequest& request);

/// The certificate of every signature of both alternatives in both triangulations, and, for cubes, of every pair of
/// neighbours.
/// Throws Error{CertificateFailed} for a tile that fails, and for a pair that does not match.
std::vector<CertifiedFigures> certify_all(int dim, TileKind tile = TileKind::cube);

/// How many of a tile's m-faces are m-ambiguous, by m (index 2 ... dim): their high corners, or their low ones, are
/// the two ends of one m-diagonal (thesis, definition 7.3.7).
std::vector<std::uint32_t> ambiguous_faces(const Lattice& lattice, int dim, Signature signature);

}  // namespace tegl::gen
