// SPDX-License-Identifier: BSD-3-Clause
//
// Emitters: plain data to text. The text depends only on the arguments.
#pragma once

#include <vector>

#include "tables/language.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

/// The files of one language: emit_cpp and emit_manifest, emit_json or emit_packed.
std::vector<EmittedFile> emit(const TableSet& set, Language language);

/// C++ sources that define the tables kTileN... and kRegionK..., by triangulation and alternative, in
/// tegl::tables (declared in tegl/generated/tables.hpp), one file per tile table and one for the regions.
std::vector<EmittedFile> emit_cpp(const TableSet& set);

/// The manifest of the tables: counts, facet statistics, the certificate's figures and a digest of each table.
EmittedFile emit_manifest(const TableSet& set);

/// One JSON file per tile table and one per region table, as described in docs/tables.md: the contract's arrays by
/// name.
std::vector<EmittedFile> emit_json(const TableSet& set);

/// Tile tables for GPUs (packed_table.hpp) with their look-up functions. `language` is glsl, wgsl or cuda. Shaders
/// contain 2D and 3D tables as constants; the words of 4D tables are a file (`.u32`) for a storage buffer. Errors:
/// InvalidArgument for tiles other than cubes.
std::vector<EmittedFile> emit_packed(const TableSet& set, Language language);

}  // namespace tegl::gen
