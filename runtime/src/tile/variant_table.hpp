// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of squares and cubes with resolved ambiguities, by key (cube_key.hpp), in the form of the other tables.
#pragma once

#include <array>
#include <cstddef>

#include "tegl/generated/tables.hpp"
#include "tile/cube_key.hpp"
#include "tile/row_table.hpp"

namespace tegl::detail {

/// The table of all keys, N = 2 or 3.
template <int N>
const tables::VariantTable& variant_table(Triangulation triangulation) noexcept {
  static_assert(N == 2 || N == 3);
  return tables::variant_table(N, triangulation);
}

/// Whether a tile depends on the data beyond its signature: a square is ambiguous, or it may have several facets. By
/// signature.
template <int N>
const auto& ambiguous_signatures() noexcept {
  if constexpr (N == 2) {
    static constexpr std::array<bool, 16> kAmbiguous2 = {0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    return kAmbiguous2;
  } else if constexpr (N == 3) {
    return tables::kAmbiguous3;
  } else {
    static_assert(N == 4);
    return tables::kAmbiguous4;
  }
}

/// Number of vertices that a cube owns, by key.
inline unsigned cube_vertices(Triangulation triangulation, CubeKey key) {
  return variant_table<3>(triangulation).rows.own_vertices(key.bits());
}

}  // namespace tegl::detail
