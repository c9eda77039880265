// SPDX-License-Identifier: BSD-3-Clause
//
// All output for one dimension: certified contours of both alternatives in both triangulations, packed tables, and
// regions.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/lattice.hpp"
#include "cubes/resolved_cube.hpp"
#include "tables/tile_tables.hpp"
#include "tables/variant_tables.hpp"

namespace tegl::gen {

/// A row table and the table that it belongs to.
struct NamedRows {
  Triangulation of = Triangulation::compact;  ///< triangulation of the TileTables with its lists
  std::string name;                           ///< of the variable
  RowTables rows;                             ///< the entries
};

/// The data that one run of `gen --dim N --out DIR` writes.
struct TableSet {
  TileKind tile = TileKind::cube;          ///< the kind of tile
  int dim = 0;                             ///< dimension
  std::string command;                     ///< the command line, for the banner
  std::uint64_t group_order = 0;           ///< number of symmetries of the tile
  std::uint64_t orbits = 0;                ///< number of classes of signatures under them
  std::vector<CertifiedFigures> figures;   ///< one per certified alternative and triangulation
  std::vector<TileTables> tiles;           ///< one per triangulation
  std::optional<TileTables> balanced{};    ///< for 4D cubes: the tiles that do not depend on the data, balanced
  std::vector<RegionTables> regions;       ///< regions of the (dim - 1)-tile
  std::optional<ResolvedCube> resolved{};  ///< for 3D cubes
  std::vector<NamedRows> rows;             ///< for cubes
  RowTables balanced_rows;                 ///< of `balanced`; tiles that depend on the data have no simplices
  std::vector<VariantTables> variants;     ///< for 2D and 3D cubes
  std::vector<bool> ambiguous;             ///< for 3D and 4D cubes: by signature, whether the data affect the tile
  std::vector<tables::CubeJoin> joins;     ///< for 3D cubes, by entry of `resolved`
};

/// The layout that measured faster for a dimension and triangulation: by class if the triangulation is equivariant and
/// flat tables would exceed the cache (4D barycentric), else flat.
Layout preferred_layout(TileKind tile, int dim, Triangulation triangulation);

/// Arguments of make_table_set.
struct TableRequest {
  TileKind tile = TileKind::cube;                                                                 ///< the kind of tile
  int dim = 0;                                                                                    ///< dimension
  std::vector<Triangulation> triangulations{Triangulation::barycentric, Triangulation::compact};  ///< all to make
  std::function<Layout(Triangulation)> layout;  ///< empty: preferred_layout
  std::string command;                          ///< for the banner
  bool pairs = false;                           ///< also certify every pair of neighbouring cubes
};

/// Builds and certifies the tables. Throws Error{CertificateFailed} or Error{Internal}; writes no files.
TableSet make_table_set(const TableRequest& request);

/// Certifies every signature of both alternatives in both triangulations and, for cubes, every pair of neighbours.
/// Throws Error{CertificateFailed} for a tile that fails or a pair that does not match.
std::vector<CertifiedFigures> certify_all(int dim, TileKind tile = TileKind::cube);

/// The number of m-ambiguous m-faces of a tile, by m (index 2 to dim). A face is m-ambiguous if its high corners, or
/// its low corners, are the two ends of one m-diagonal (thesis, definition 7.3.7).
std::vector<std::uint32_t> ambiguous_faces(const Tile& tile, const tile::FaceLattice& faces, Signature signature);
std::vector<std::uint32_t> ambiguous_faces(const Lattice& lattice, int dim, Signature signature);

}  // namespace tegl::gen
