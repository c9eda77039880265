// SPDX-License-Identifier: BSD-3-Clause
//
// Numbering of corners, edges and faces of n-cubes (table_contract.hpp). Face f = 2 a + side of an n-cube has dimension
// n - 1 and lies at x_a = side. Its own frame keeps the other axes in ascending order.
#pragma once

#include <array>
#include <cstdint>

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

/// Number of the edge of a k-cube along `axis` at the corner `base` (at either end).
constexpr unsigned edge_number(unsigned k, unsigned axis, unsigned base) noexcept {
  return axis << (k - 1) | squeeze(base, axis);
}

/// Axis of the cube for an axis of its face.
constexpr unsigned lifted_axis(unsigned face, unsigned axis) noexcept { return axis < face / 2 ? axis : axis + 1; }

/// Corner of the cube for a corner of its face.
constexpr unsigned lifted_corner(unsigned face, unsigned corner) noexcept {
  return unsqueeze(corner, face / 2) | (face % 2) << (face / 2);
}

/// Edge of the k-cube for an edge of its face.
constexpr unsigned lifted_edge(unsigned k, unsigned face, unsigned e) noexcept {
  return edge_number(k, lifted_axis(face, e >> (k - 2)), lifted_corner(face, edge_base(k - 1, e)));
}

/// Corners of a k-cube in a face, bit v for corner v; k <= 6.
constexpr std::uint64_t face_corners(unsigned k, unsigned face) noexcept {
  std::uint64_t corners = 0;
  for (unsigned v = 0; v < 1u << (k - 1); ++v) corners |= std::uint64_t{1} << lifted_corner(face, v);
  return corners;
}

/// Edges of a k-cube in a face, bit e for edge e; k = 2, 3, 4.
constexpr std::uint32_t face_edges(unsigned k, unsigned face) noexcept {
  std::uint32_t edges = 0;
  for (unsigned e = 0; e < (k - 1) << (k - 2); ++e) edges |= std::uint32_t{1} << lifted_edge(k, face, e);
  return edges;
}

/// Incidence number of a face in the cube's boundary: outward normal first, axes ascending.
constexpr int face_sign(unsigned face) noexcept { return (face / 2 % 2 == 0) == (face % 2 == 1) ? 1 : -1; }

/// From a set of corners of a k-cube, those at the lower end of `axis`, as corners of the face there; k <= 4.
constexpr unsigned squeezed_corners(unsigned k, unsigned corners, unsigned axis) noexcept {
  constexpr std::array<unsigned, 4> kLower{0x5555, 0x3333, 0x0f0f, 0x00ff};  // corners at the lower end of each axis
  corners &= kLower[axis] & ((1u << (1u << k)) - 1);
  for (; axis + 1 < k; ++axis) corners = (corners | corners >> (1u << axis)) & kLower[axis + 1];
  return corners;
}

/// Signature of a face of a k-cube; k <= 4.
constexpr unsigned face_signature(unsigned k, unsigned signature, unsigned face) noexcept {
  return squeezed_corners(k, signature >> (face % 2 << face / 2), face / 2);
}

/// A set of corners of the tesseract and their neighbours along edges.
constexpr std::uint32_t with_neighbours(std::uint32_t corners) noexcept {
  constexpr std::array<std::uint32_t, 4> kLower{0x5555, 0x3333, 0x0f0f, 0x00ff};
  std::uint32_t result = corners;
  for (unsigned a = 0; a < 4; ++a) result |= (corners & kLower[a]) << (1u << a) | (corners >> (1u << a) & kLower[a]);
  return result;
}

/// Critical edges of an N-cube, bit e for local edge e, from its signature.
template <int N>
constexpr std::uint32_t critical_edges(unsigned signature) noexcept {
  std::uint32_t edges = 0;
  for (unsigned axis = 0; axis < N; ++axis)
    edges |= squeezed_corners(N, signature ^ signature >> (1u << axis), axis) << (axis << (N - 1));
  return edges;
}

}  // namespace tegl::detail
