// SPDX-License-Identifier: BSD-3-Clause
//
// Tables in the form that loops over many tiles read, and tables of squares and cubes with resolved ambiguities, by
// key (table contract: RowTable, VariantTable).
#pragma once

#include <cstdint>
#include <vector>

#include "cubes/resolved_cube.hpp"
#include "tables/tile_tables.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

/// Owning counterpart of tables::RowTable, which documents the members.
struct RowTables {
  std::vector<std::uint32_t> entries;         ///< as in tables::RowTable
  std::vector<std::uint8_t> counts;           ///< as in tables::RowTable
  std::vector<std::uint8_t> shuffles;         ///< as in tables::RowTable
  std::vector<std::uint16_t> variant_places;  ///< as in tables::RowTable
  std::vector<tables::Variant> variants;      ///< as in tables::RowTable
  bool more_keys = false;                     ///< as in tables::RowTable
};

/// Squares or cubes with resolved ambiguities.
struct VariantTables {
  TileTables tile;             ///< lists by key; its signatures are keys
  RowTables rows;              ///< by key
  std::uint64_t embedded = 0;  ///< number of lists of resolved tiles that are proved to be embedded
};

/// Whether a table has a form for loops: it must be flat, with sizes that fit in an entry.
[[nodiscard]] bool has_row_tables(const TileTables& table);

/// The plain table. Requires has_row_tables(table).
[[nodiscard]] RowTables make_row_tables(const TileTables& table);
/// The same; the tiles for which `is_estimated` holds are marked as having own vertices.
[[nodiscard]] RowTables make_estimated_rows(const TileTables& table, const std::vector<bool>& is_estimated);

/// The squares of all keys. The high-connected square is the low-connected one of the complement, reversed.
[[nodiscard]] VariantTables make_square_variants(const TileTables& plain);
/// The cubes of all keys. `plain`: of the triangulation to make; compact cubes without ambiguity are those of `cube`.
/// Certifies every disc that is coned from its barycentre, and that every list is embedded. Throws
/// Error{CertificateFailed}.
[[nodiscard]] VariantTables make_cube_variants(const TileTables& plain, const ResolvedCube& cube);

/// FNV-1a digest of all numbers.
[[nodiscard]] std::uint64_t digest(const RowTables& table);

}  // namespace tegl::gen
