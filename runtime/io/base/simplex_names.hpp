// SPDX-License-Identifier: BSD-3-Clause
//
// Names of simplices, for messages and reports of the library and of the program.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace tegl::io_detail {

/// The name of simplices of one dimension: "triangle", "triangles".
struct SimplexName {
  std::string_view singular;
  std::string_view plural;
};

/// The name of simplices of dimension `dim`, 0 to 4. Errors: std::out_of_range.
constexpr SimplexName simplex_name(int dim) {
  constexpr std::array<SimplexName, 5> kNames = {{{"point", "points"},
                                                  {"segment", "segments"},
                                                  {"triangle", "triangles"},
                                                  {"tetrahedron", "tetrahedra"},
                                                  {"4-simplex", "4-simplices"}}};
  return kNames.at(static_cast<std::size_t>(dim));
}

}  // namespace tegl::io_detail
