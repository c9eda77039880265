// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of a single tile in 2D to 6D, with a choice for every ambiguous face. It is constructed, not looked up:
// tables exist only for some dimensions and rules, this function covers all of them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tegl/dimensions.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl {

/// The number of a face of the N-cube, as used by tile::Resolution and tile::Vertex::face: faces are ordered by
/// dimension, then by the ascending numbers of their corners. Corner v has coordinate v >> a & 1 on axis a. The face
/// has the corners `base | s` for all subsets s of the bits of `axes` (theory's numbering), and as many dimensions as
/// `axes` has bits. Throws InvalidArgument unless base and axes are disjoint sets of the axes 0 ... N - 1. O(1).
template <int N>
requires DimensionBetween<N, 2, 6>
[[nodiscard]] std::size_t face_number(unsigned base, unsigned axes);

/// Number of faces of the N-cube, including itself and its corners: 3^N.
template <int N>
requires(N >= 0) inline constexpr std::size_t kFaceCount = 3 * kFaceCount<N - 1>;
/// A point has one face: itself.
template <>
inline constexpr std::size_t kFaceCount<0> = 1;

/// Constructs the contour of the tile whose high corners are the bits of `signature` (bit v: corner v), in the tile's
/// frame.
///
/// `resolution.choices` has an entry for each of the 3^N faces, by face_number, or is empty: all `separate`. It selects
/// how a face of two or more dimensions is filled if that is ambiguous:
/// - separate: every part of the contour on the face's boundary that is a sphere gets its own cone. Other cases are
///   filled as `resolution.alternative` says: a square with two diagonally opposite high corners, which has no centre
///   to decide, and in 4D and higher a part that is not a sphere.
/// - low, high: the sign of the face's centre. The contour is a copy of the boundary regions of the other sign, moved
///   inwards, so all regions of the centre's sign are connected in the face. In a square with two diagonally opposite
///   high corners, `low` separates them and `high` joins them; in a cube with two opposite high corners and a high
///   centre, a tunnel joins them.
///
/// Entries for corners, edges, and faces that the contour does not pass are ignored. Tiles that share a face agree in
/// it, corner by corner and simplex by simplex, if they have the same choices for it and for its own faces.
///
/// Vertices of the result are identified by the face that they lie in and their number there. Simplices have N vertices
/// and are oriented so that the simplex followed by a normal towards the high side is positive.
///
/// Throws InvalidArgument for a signature with bits beyond the 2^N corners, and for a number of choices other than 0
/// and 3^N; TooLarge for a tile of more than 65 535 vertices (none is known). Thread-safe. N = 2 ... 6.
///
/// Time: microseconds in 2D, about 0.1 ms in 3D and 4D, up to 10 ms in 5D, seconds in 6D; docs/cost.md has measured
/// times of 5D. Up to 4D most of it is the setup of a builder.
///
/// For many tiles use one tile::FacetBuilder of tile::FaceLattice::cube(N) per thread: it keeps the data that tiles
/// share.
template <int N>
requires DimensionBetween<N, 2, 6>
[[nodiscard]] tile::TileFacets tile_facets(std::uint64_t signature, const tile::Resolution& resolution = {});

}  // namespace tegl
