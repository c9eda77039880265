// SPDX-License-Identifier: BSD-3-Clause
//
// A face of a lattice as a lattice of its own: its faces, and its renumbered corners.
#pragma once

#include <cstdint>
#include <vector>

#include "tegl/tile/facets.hpp"

namespace tegl::tile {

/// All faces of a face, of every dimension, ascending; the face itself is the last.
inline std::vector<std::uint32_t> closure(const FaceLattice& lattice, std::uint32_t face) {
  std::vector<std::uint32_t> result;
  for (std::uint32_t g = 0; g <= face; ++g)
    if ((lattice.faces()[g].corners & ~lattice.faces()[face].corners) == 0) result.push_back(g);
  return result;
}

inline std::vector<int> corner_list(Signature corners) {
  std::vector<int> list;
  for (int v = 0; v < 64; ++v)
    if (((corners >> v) & 1u) != 0) list.push_back(v);
  return list;
}

/// The bits of a signature at the given corners, in their order.
inline Signature compressed(Signature signature, const std::vector<int>& corners) {
  Signature result = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) result |= ((signature >> corners[i]) & 1u) << i;
  return result;
}

}  // namespace tegl::tile
