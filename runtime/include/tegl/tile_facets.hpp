// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of a single tile, in 2D to 6D, with every ambiguity resolved as the caller says. Built, not looked up:
// what tables hold for some dimensions and one way to resolve is here for all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tegl/dimensions.hpp"
#include "tegl/facets/facets.hpp"

namespace tegl {

/// The number of a face of the N-cube, in the order that `signs` and facets::Vertex::face have: by dimension, then by
/// the ascending numbers of the corners. Corner v has coordinate v >> a & 1 on axis a; the face has the corners
/// `base | s` for all subsets s of the bits of `axes` (theory's numbering). It has as many dimensions as `axes` bits.
/// Throws InvalidArgument unless base and axes are disjoint sets of the axes 0 ... N - 1. O(1), after the first call.
template <int N>
requires DimensionBetween<N, 2, 6> std::size_t face_number(unsigned base, unsigned axes);

/// How many faces the N-cube has, itself and its corners included: 3^N.
template <int N>
inline constexpr std::size_t kFaceCount = 3 * kFaceCount<N - 1>;
/// A point is its own one face.
template <>
inline constexpr std::size_t kFaceCount<0> = 1;

/// The contour of the tile whose high corners are the bits of `signature` (bit v: corner v), in the frame of the tile.
///
/// `signs` has a sign for each of the 3^N faces, by face_number, or is empty: all `separate`. It says how a face of
/// dimension 2 or more that the contour passes in several ways is filled:
/// - separate: what can be cut off is: every part of the contour's boundary that is a sphere gets its own cone. What
///   can not be (in a square with two high corners across, where there is no centre to decide; in 4D and more, a part
///   that is no sphere) is filled as `otherwise` says;
/// - low, high: the sign of the face's centre. The contour is a copy of the other sign's regions of the boundary of
///   the face, moved inwards, so that all of the centre's sign hangs together in the face: in a square with two high
///   corners across, `low` cuts them off and `high` joins them; in a cube with two high corners across and a high
///   centre, a tunnel joins these.
/// Signs of corners, of edges, and of faces that the contour does not pass mean nothing. Tiles that share a face agree
/// in it, corner by corner and simplex by simplex, if they have the same signs for it and for its own faces.
///
/// The result's vertices name the face that they lie in and their number there; its simplices have N vertices each and
/// are oriented so that the simplex followed by a normal towards the high side is positive.
///
/// Throws InvalidArgument for a signature with bits beyond the 2^N corners, and for a number of signs other than 0 and
/// 3^N; TooLarge for a tile of more than 65 535 vertices (none is known). No state of its own, thread safe. N = 2
/// ... 6.
///
/// Time: microseconds in 2D, about 0.1 ms in 3D and 4D, up to 10 ms in 5D and seconds in 6D; docs/cost.md has measured
/// times of 5D. Up to 4D most of it goes to setting up a builder.
///
/// For many tiles use one facets::FacetBuilder of facets::FaceLattice::cube(N) per thread: it keeps what tiles have in
/// common.
template <int N>
requires DimensionBetween<N, 2, 6> facets::TileFacets tile_facets(
    std::uint64_t signature, std::span<const facets::Choice> signs = {},
    facets::Alternative otherwise = facets::Alternative::low);

}  // namespace tegl
