// SPDX-License-Identifier: BSD-3-Clause
//
// What the emitters of several languages share: names and the banner (private to the generator).
#pragma once

#include <cctype>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "base/lattice.hpp"
#include "filling/resolved_cube.hpp"
#include "tables/language.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

using Out = std::back_insert_iterator<std::string>;

inline std::string upper_camel(const std::string& name) {
  std::string result(name);
  result[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(result[0])));
  return result;
}

/// What a tile's tables are called: "tile3", "simplex3", "octahedron3".
inline std::string tile_name(TileKind kind, int dim) {
  return fmt::format("{}{}", kind == TileKind::cube ? "tile" : tile_kind_name(kind), dim);
}

/// The generated-file banner in `//` comments: command, licence, `what`, and the certificate.
std::string banner(const TableSet& set, Language language, const std::string& what);

/// What was proved of the complete table of the cube, for banners.
std::string resolved_certificate(const ResolvedCube& table);

/// The command that writes this language, for banners: the C++ one is the command's default.
std::string command_for(const TableSet& set, Language language);

}  // namespace tegl::gen
