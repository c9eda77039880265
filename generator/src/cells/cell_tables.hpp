// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of mesh cells as plain data: certified, classes counted twice.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/tile_contour.hpp"
#include "cells/cell.hpp"
#include "tables/language.hpp"
#include "tegl/cell_contract.hpp"

namespace tegl::gen {

/// Owning counterpart of tables::CellTable, which documents the arrays, with counts.
struct CellTables {
  std::string name;             ///< of the cell
  Triangulation triangulation;  ///< barycentric only for 4-cells
  Tile tile;                    ///< corners and edges
  std::vector<std::uint16_t> list_of = {};
  std::vector<std::uint16_t> element_of = {};
  std::vector<std::uint8_t> permutations = {};
  std::vector<std::uint8_t> reverses = {};
  std::vector<tables::CellList> lists = {};
  std::vector<std::uint8_t> simplices = {};
  std::vector<std::uint64_t> masks = {};
  std::uint32_t max_simplices = 0;    ///< maximum over all signatures
  std::uint32_t max_added = 0;        ///< maximum over all signatures
  std::uint64_t group_order = 0;      ///< symmetries, without inversion
  std::uint64_t classes = 0;          ///< of signatures, by enumeration and by Burnside's lemma
  std::uint64_t certified = 0;        ///< signatures that passed the certificate; for 4-cells one of each class
  std::uint64_t total_simplices = 0;  ///< sum over all signatures
  std::uint64_t others = 0;           ///< signatures with a component of Sigma that is no sphere

  /// A list that is not proved to be embedded, but searched.
  struct Searched {
    Signature signature;           ///< of the list
    std::uint64_t entries, pairs;  ///< signatures that have it; unproved pairs of simplices
    std::uint32_t random;          ///< random positions of each of the two kinds (SearchPlan)
  };
  std::uint64_t proved = 0;             ///< signatures whose contour is proved to be embedded
  std::vector<Searched> searched = {};  ///< the others
};

/// Makes and certifies the table of a cell. The certificate (tile::TileCertifier): every contour is an oriented
/// manifold with the boundary Sigma, and Sigma is in each face the contour that depends on that face alone, so cells
/// that share the face match. Barycentric contours of 3-cells are also compared under all symmetries of the cell, so
/// their polygons in a face of a 4-cell do not depend on the face's numbering either. Every contour is proved to be
/// embedded, or searched (CellEmbedding). Errors: CountMismatch, CertificateFailed.
[[nodiscard]] CellTables make_cell_tables(const Cell& cell, Triangulation triangulation);

/// The tables of all cells in the order of tables::CellShape; for each, barycentric, then compact (2D and 3D).
[[nodiscard]] std::vector<CellTables> make_all_cell_tables();

/// `cells.cpp`, which defines tables::cell_table and tables::face_filling_table (face_fillings.hpp), and
/// `cells_manifest.json` with counts and digests.
[[nodiscard]] std::vector<EmittedFile> emit_cells(const std::vector<CellTables>& tables);

/// The tables of one cell: for `cpp` `cell_NAME.cpp`, which defines a tables::CellTable for each, as
/// `kWedgeCompact`, and `cell_NAME_manifest.json`; for `json` `cell_NAME_TRIANGULATION.json` with the same arrays.
/// Other languages have no tables of cells. `command`: for the banners.
[[nodiscard]] std::vector<EmittedFile> emit_cell(const std::vector<CellTables>& tables,
                                                 std::span<const Language> languages, const std::string& command);

}  // namespace tegl::gen
