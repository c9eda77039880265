// SPDX-License-Identifier: BSD-3-Clause
//
// Row tables and resolved squares and cubes as C++ text (private to the generator).
#pragma once

#include <string>

#include "tables/emit_text.hpp"

namespace tegl::gen {

/// Appends the arrays of a row table. `suffix`: distinguishes their names.
void row_arrays(std::string& text, const RowTables& rows, const std::string& suffix);

/// The initialiser of a row table. `table`: address of its TileTable; `simplices`: of its simplices.
std::string row_initialiser(const RowTables& rows, const std::string& suffix, const std::string& table,
                            const std::string& simplices);

/// The file of a dimension's resolved squares or cubes, ambiguous tiles and joins.
EmittedFile emit_variants(const TableSet& set);

}  // namespace tegl::gen
