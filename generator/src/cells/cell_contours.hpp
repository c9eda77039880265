// SPDX-License-Identifier: BSD-3-Clause
//
// The contours of mesh cells, by tile::FacetBuilder. In the compact triangulation of 3-cells, polygons are fans from
// one of their own vertices; hexahedra have the contours of the cube's own table. Compact 4-cells have no tables: the
// chords of polygons in 3-faces depend on the mesh's numbering of points, so the runtime builds them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/tile_contour.hpp"
#include "cells/cell.hpp"
#include "filling/facets.hpp"
#include "tegl/tile/local_contour.hpp"

namespace tegl::gen {

/// The contour of one signature by local vertices as in the contract.
struct CellContour {
  std::vector<LocalSimplex> simplices = {};      ///< oriented; the first n vertices count
  std::vector<std::uint64_t> masks = {};         ///< of added vertices
  std::array<std::uint8_t, 3> added_count = {};  ///< shared, barycentres, side vertices
};

/// Builds the low-connected contours of a cell. Not thread-safe.
class CellContours {
 public:
  /// `cell` must outlive this object. Throws std::invalid_argument for compact 4-cells.
  CellContours(const Cell& cell, Triangulation triangulation);

  /// The facets of a signature, for the certificate; valid until the next call. Throws Error{Internal} if no fan of a
  /// polygon has its chords inside the cell.
  const tile::TileFacets& build(Signature signature);
  /// The facets of the last call of `build` as local vertices. Throws Error{Internal} for a vertex of a kind that the
  /// contract does not have.
  [[nodiscard]] CellContour local() const;

 private:
  void make_compact(Signature signature);
  void take_from_cube(Signature signature);
  void cut_into_fan(tile::Facet& facet) const;
  void find_orientation();
  [[nodiscard]] std::uint8_t edge_of(const tile::Vertex& vertex) const;
  [[nodiscard]] tile::LocalContour as_local(bool reversed) const;

  const Cell& cell_;
  Triangulation triangulation_;
  tile::FacetBuilder builder_;
  std::unique_ptr<CubeLattice> cubes_;      ///< for compact hexahedra
  std::unique_ptr<ContourBuilder> cube_;    ///< for compact hexahedra
  std::vector<std::uint8_t> edge_of_;       ///< by face of the lattice
  std::vector<std::uint8_t> edge_of_cube_;  ///< edge of the cube -> edge of the cell
  std::vector<std::uint32_t> polygons_of_;  ///< by edge: the set of 2-faces that contain it
  bool reversed_ = false;                   ///< whether the lattice is oriented against the coordinates
  tile::TileFacets facets_;
};

}  // namespace tegl::gen
