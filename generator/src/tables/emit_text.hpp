// SPDX-License-Identifier: BSD-3-Clause
//
// Names and the banner, common to the emitters (private to the generator).
#pragma once

#include <cctype>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "base/lattice.hpp"
#include "cubes/resolved_cube.hpp"
#include "tables/language.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

using Appender = std::back_insert_iterator<std::string>;

inline std::string upper_camel(const std::string& name) {
  std::string result(name);
  result[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(result[0])));
  return result;
}

/// Name of a tile's tables: "tile3", "simplex3", "octahedron3".
inline std::string tile_name(TileKind kind, int dim) {
  return fmt::format("{}{}", kind == TileKind::cube ? "tile" : tile_kind_name(kind), dim);
}

/// The banner of a generated file in `//` comments: command, licence, `what`, and the certificate.
std::string banner(const TableSet& set, Language language, const std::string& what);

/// One line on the certificate of the complete table of the cube, for banners.
std::string resolved_certificate(const ResolvedCube& table);

/// The command that writes `language`, for banners. C++ is the default of --language.
std::string command_for(const TableSet& set, Language language);

}  // namespace tegl::gen
