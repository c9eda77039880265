// SPDX-License-Identifier: BSD-3-Clause
//
// Emitters: plain data in, text out. The text depends on the arguments alone.
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

/// The reviewable face of the tables: counts, facet statistics, the certificate's figures and a digest of each table.
EmittedFile emit_manifest(const TableSet& set);

/// One JSON file per tile table and one for the regions, as docs/tables.md describes: the contract's arrays by name.
std::vector<EmittedFile> emit_json(const TableSet& set);

/// Tile tables for GPUs (packed_table.hpp) with the functions that look them up. `language` is glsl, wgsl or cuda. In
/// shaders only 2D and 3D tables are text, as constants; the words of 4D ones are a file (`.u32`) for a storage buffer.
/// Errors: InvalidArgument for tiles other than cubes.
std::vector<EmittedFile> emit_packed(const TableSet& set, Language language);

}  // namespace tegl::gen
