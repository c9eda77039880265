// SPDX-License-Identifier: BSD-3-Clause
//
// Emitters: plain data in, text out. The text depends on the arguments alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tegl/gen/resolved_cube.hpp"
#include "tegl/gen/tile_tables.hpp"

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

/// A file to be written.
struct EmittedFile {
  std::string name;  ///< relative to the output folder
  std::string text;  ///< bytes, for files of packed words
};

/// What the tables are written in.
enum class Language { cpp, json, glsl, wgsl, cuda };
/// All of them.
inline constexpr Language kLanguages[] = {Language::cpp, Language::json, Language::glsl, Language::wgsl,
                                          Language::cuda};

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

const char* triangulation_name(Triangulation t) noexcept;  ///< "barycentric", "compact"
const char* alternative_name(Alternative a) noexcept;      ///< "low", "high"
const char* layout_name(Layout l) noexcept;                ///< "class", "flat"
const char* language_name(Language l) noexcept;            ///< "cpp", "json", "glsl", "wgsl", "cuda"

}  // namespace tegl::gen
