// SPDX-License-Identifier: BSD-3-Clause
//
// Numbering of corners and edges of squares, cubes and tesseracts (table contract).
#pragma once

#include <array>
#include <cstdint>

#include "tegl/table_contract.hpp"

namespace tegl::detail {

/// Removes bit `axis` from a corner (the contract's squeeze).
constexpr unsigned squeeze(unsigned corner, unsigned axis) noexcept {
  const unsigned low = (1u << axis) - 1;
  return (corner & low) | (corner >> 1 & ~low);
}

/// Inserts a 0 bit `axis` into a corner. Inverse of squeeze.
constexpr unsigned unsqueeze(unsigned corner, unsigned axis) noexcept {
  const unsigned low = (1u << axis) - 1;
  return (corner & low) | (corner & ~low) << 1;
}

/// Base corner of edge `e` of a k-cube.
constexpr unsigned edge_base(unsigned k, unsigned e) noexcept {
  return unsqueeze(e & ((1u << (k - 1)) - 1), e >> (k - 1));
}

/// From a set of corners of an N-cube, those at the lower end of `axis`, as corners of the facet there.
template <int N>
constexpr unsigned squeezed_corners(unsigned corners, unsigned axis) noexcept {
  constexpr std::array<unsigned, 4> kLower{0x5555, 0x3333, 0x0f0f, 0x00ff};  // corners at the lower end of each axis
  corners &= kLower[axis] & ((1u << (1u << N)) - 1);
  for (; axis + 1 < N; ++axis) corners = (corners | corners >> (1u << axis)) & kLower[axis + 1];
  return corners;
}

/// Critical edges of an N-cube, bit e for local edge e, from its signature.
template <int N>
constexpr std::uint32_t critical_edges(unsigned signature) noexcept {
  std::uint32_t edges = 0;
  for (unsigned axis = 0; axis < N; ++axis)
    edges |= squeezed_corners<N>(signature ^ signature >> (1u << axis), axis) << (axis << (N - 1));
  return edges;
}

}  // namespace tegl::detail
