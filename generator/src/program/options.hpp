// SPDX-License-Identifier: BSD-3-Clause
//
// The options of `gen` as plain data. parse() (cli.hpp) fills and checks them; the commands (commands.hpp) read them.
// The parser refuses an option that the command does not use, so a command may rely on every option it gets.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/lattice.hpp"
#include "base/tile_contour.hpp"
#include "builders/builder_request.hpp"
#include "cells/cell_names.hpp"
#include "symmetry/symmetry.hpp"
#include "tables/language.hpp"

namespace tegl::gen {

/// The command; at most one per command line.
enum class Command {
  Help,         ///< --help
  Summary,      ///< no command, dim 2 ... 4
  Version,      ///< --version
  Count,        ///< --count, dim 1 ... 8
  Transversal,  ///< --transversal, dim 2 ... 5
  Symmetries,   ///< --symmetries, dim 2 ... 4
  Classes,      ///< --classes, dim 2 ... 4
  Certify,      ///< --certify, dim 2 ... 4, with --sample 2 ... 6
  Out,          ///< --out DIR, dim 2 ... 4
  Cases,        ///< --cases DIR, dim 2 ... 4
  Builder,      ///< --builder, dim 2 ... 5
  Cells,        ///< --cells, without dim
};

/// How emitted tables are stored.
enum class LayoutChoice {
  Class,  ///< one list per symmetry class and a group element per signature
  Flat,   ///< one list per signature
  Auto,   ///< the layout that measured faster for the dimension
};

/// Which triangulations are emitted.
enum class TriangulationChoice { Barycentric, Compact, All };

/// A checked command line, with the same defaults.
struct Options {
  Command command = Command::Help;             ///< the command
  int dim = 0;                                 ///< --dim; 0 for --help and --version
  TileKind tile = TileKind::cube;              ///< --tile; not for --transversal, --symmetries
  const CellName* cell = nullptr;              ///< --tile, if it is a mesh cell; then `tile` is `other`
  GroupKind group = GroupKind::Full;           ///< --group; with four commands
  bool inversion = false;                      ///< --inversion; --count, --symmetries, table_by_class
  bool table_by_class = false;                 ///< --table-by-class; --certify, dim 2 and 3
  bool all_resolutions = false;                ///< --all; --certify only
  std::uint64_t sample = 0;                    ///< --sample; --certify only, not with --all; 0: none
  std::uint64_t seed = 1;                      ///< --seed; with --sample
  unsigned threads = 0;                        ///< --threads; with --all or --sample; 0: all
  bool keeps_same = false;                     ///< --keep; with --out
  bool list = false;                           ///< --list; --transversal only
  bool json = false;                           ///< --json; not for --out and --cases, not with --list
  Alternative alternative = Alternative::low;  ///< --alternative; --classes only
  std::string out;                             ///< DIR of --out and --cases; of --builder, --cells, or empty
  LayoutChoice layout = LayoutChoice::Auto;    ///< --layout; --out only
  TriangulationChoice triangulation = TriangulationChoice::All;  ///< --triangulation; --out; --builder: All is compact
  std::vector<Language> languages{Language::cpp};                ///< --language, as given; --out, --builder
  Leaf leaf = Leaf::table;                                       ///< --leaf; --builder only
};

/// The tile as on the command line.
[[nodiscard]] inline std::string_view tile_text(const Options& options) {
  return options.cell == nullptr ? std::string_view(tile_kind_name(options.tile)) : options.cell->given;
}

}  // namespace tegl::gen
