// SPDX-License-Identifier: BSD-3-Clause
//
// The table contract: the one thing that the generator and the runtime share. Plain structs and a
// version; no functions of substance, no dependencies.
//
// Numbering of an n-tile (n = 2, 3, 4). Everything below is in the tile's own frame.
//   corner v        coordinate x_i = (v >> i) & 1; a signature has bit v set iff corner v is high
//   edge e          e = axis * 2^(n-1) + squeeze(base, axis): the edge along `axis` from corner `base`
//                   (whose bit `axis` is 0); squeeze removes bit `axis` from `base`
//   cube f (n = 4)  f = 2 * a + side: the 3-face that leaves out axis a, at x_a = side. Its own frame
//                   keeps the other axes in ascending order, so its corners and edges are numbered
//                   as those of a 3-tile
//
// Local vertices of a tile's simplices, by one byte:
//   [0, E)                    the contour's point on edge e                     E = n 2^(n-1)
//   [E, E + F S)              barycentre j of cube f's facets: E + f S + j      F = 8 for n = 4, else 0
//                             (j counts the cone vertices of the cube's own entry in the 3D table of
//                             the same triangulation; S = kFaceSlots)
//   [E + F S, ...)            the tile's own vertices: first its cone vertices (barycentres), then its
//                             side vertices
//
// Positions. An edge point is interpolated. A cone vertex is the barycentre of the facet that it
// cones: it always stands first in its simplices (v, t_1 ... t_{n-1}); with M the measure of
// t = (t_1 ... t_{n-1}) and B(t) its barycentre, it lies at sum M(t) B(t) / sum M(t) over those
// simplices. B of a segment is its midpoint. B of a triangle (n = 4) is the position of t_1 if that is
// a cube's barycentre (local id >= E), else sum |side| mid(side) / sum |side| over its three sides
// (thesis, definition 10.1.4). In the compact triangulation a cone vertex is the mean of the points that its
// simplices have beside it. A side vertex with mask m lies half way from the tile's centre to the
// mean of the corners and edge points in m.
//
// Orientation. Simplices are stored for the positive side facing the high corners: for a simplex
// (v_0 ... v_{n-1}) and a vector d towards the high side, det[v_1 - v_0, ..., v_{n-1} - v_0, d] > 0.
// In the plane: high on the left of v_0 -> v_1. In space: the right-hand normal points to high.
//
// Alternatives. Tables hold the low-connected alternative. The high-connected one of signature s is
// the low-connected one of ~s with the orientation reversed, for every n and triangulation.
#pragma once

#include <cstdint>

namespace tegl::tables {

/// Version of the layout below. Emitted tables carry it; the runtime checks it at compile time.
inline constexpr std::uint32_t kContractVersion = 1;

/// Number of barycentre slots that each cube of a 4-tile has in the local vertex numbering.
inline constexpr std::uint32_t kFaceSlots = 2;

/// Number of edges of an n-tile.
constexpr std::uint32_t edge_count(std::uint32_t n) { return n << (n - 1); }

/// First local id of the tile's own vertices.
constexpr std::uint32_t first_tile_vertex(std::uint32_t n) { return edge_count(n) + (n == 4 ? 8 * kFaceSlots : 0); }

/// One triangulated list of facets.
struct List {
  std::uint32_t first_simplex;  ///< index into TileTable::simplices, in simplices (not bytes)
  std::uint16_t simplex_count;  ///< how many
  std::uint8_t cone_vertices;   ///< the tile's own vertices that are barycentres
  std::uint8_t side_vertices;   ///< the tile's own vertices of side fillings, numbered after them
  std::uint32_t first_side;     ///< index into TileTable::side_masks
};

/// All facets of all 2^(2^n) signatures, low-connected alternative, one triangulation.
///
/// Flat layout: list_of[s] is the list of signature s itself and element_of is null.
/// Class layout: list_of[s] is the list of the class's representative r, and element_of[s] the group
/// element g with s = g(r). A stored vertex v < first_tile_vertex(n) then stands for
/// permutations[g * permutation_stride + 2^n + v], followed, for cubes in slot_swaps[s] (bit f, f the
/// cube after g), by exchanging slots 0 and 1. Corners of side masks map by permutations[g * stride + v].
/// Where reverses[g] is 1, the last two vertices of each simplex are to be exchanged. The tile's own
/// vertices keep their numbers.
struct TileTable {
  std::uint32_t version;             ///< kContractVersion
  std::uint32_t dim;                 ///< n
  std::uint32_t list_count;          ///< how many
  std::uint32_t simplex_count;       ///< how many, over all lists
  std::uint32_t element_count;       ///< number of group elements, 0 in the flat layout
  std::uint32_t permutation_stride;  ///< 2^n + first_tile_vertex(n), or 0
  std::uint32_t max_simplices;       ///< over all signatures
  std::uint32_t max_tile_vertices;   ///< over all signatures
  const std::uint16_t* list_of;      ///< 2^(2^n)
  const std::uint16_t* element_of;   ///< 2^(2^n), or null
  const std::uint8_t* slot_swaps;    ///< 2^(2^n), or null
  const std::uint8_t* permutations;  ///< element_count x permutation_stride, or null
  const std::uint8_t* reverses;      ///< element_count, or null
  const List* lists;                 ///< list_count
  const std::uint8_t* simplices;     ///< simplex_count x dim local vertices
  const std::uint64_t* side_masks;   ///< bit v: corner v; bit 2^n + e: edge e
};

/// The high part of every 2^(2^k) signature of a k-tile, k = 1, 2, 3, triangulated by k-simplices: what
/// closes a contour at the image's border. One table per dimension, triangulation and alternative.
/// Vertices are local bytes:
///   [0, 2^k)              corner v
///   [2^k, 2^k + E)        edge point e
///   k = 3: next kFaceSlots  barycentre j of the cube's own facets, as in the 3D tile table
///   k = 3: next 6         square q = 2 a + side: the barycentre of its high region, in the cubes' squares
///                         whose region has one in the k = 2 table
///   [own_base, ...)       the tile's own vertices: barycentres of its regions
/// The position of a region's barycentre is the mean of the corners (bit v) and edge points
/// (bit 2^k + e) in its mask. Simplices are oriented by det[v_1 - v_0, ..., v_k - v_0] > 0.
struct RegionList {
  std::uint32_t first_simplex;  ///< index into RegionTable::simplices, in simplices
  std::uint16_t simplex_count;  ///< how many
  std::uint16_t own_vertices;   ///< the tile's own vertices
  std::uint32_t first_mask;     ///< index into RegionTable::masks
};

/// First local id of a k-tile's own region vertices.
constexpr std::uint32_t first_region_vertex(std::uint32_t k) {
  return (1u << k) + edge_count(k) + (k == 3 ? kFaceSlots + 6 : 0);
}

/// The regions of all signatures of a k-tile.
struct RegionTable {
  std::uint32_t version;           ///< kContractVersion
  std::uint32_t dim;               ///< k
  std::uint32_t max_own_vertices;  ///< over all signatures
  const RegionList* lists;         ///< 2^(2^k)
  const std::uint8_t* simplices;   ///< x (k + 1) local vertices
  const std::uint32_t* masks;      ///< bit v: corner v; bit 2^k + e: edge e
};

/// The cube with every ambiguity resolved freely: an entry for each signature and each resolution of its ambiguous
/// squares, 656 in all. Square q = 2 a + side has x_a = side. Where bit q is set in ambiguous_squares[s], square q is
/// ambiguous: its centre may be high or low. With the bits of these squares pushed together (the lowest square first,
/// set = the centre is high) as the number r, the entry is first_entry[s] + r.
///
/// In the cube the polygons stay apart (`separate`), or the cube's centre is `low` and what is high around it is cut
/// off, region by region, or it is `high` and what is low is. A region between several polygons is a tunnel between
/// them, or a sphere with three or four holes. Of most entries two of the three lists are the same one. A local vertex
/// below 12 is an edge's point; 12 + j is own vertex j of the list: with a mask of edges alone (bit 8 + e) the mean of
/// their points, with a corner in it (bit v) half way from the cube's centre to the mean of its corners and points. In
/// a square, the segments are the same in all entries that resolve it the same way. Orientation as above. With no
/// square or all ambiguous ones high, `separate` is what the compact table has for that alternative; with none
/// ambiguous, for low.
struct ResolvedList {
  std::uint16_t first_triangle;  ///< index into ResolvedTable::triangles, in triangles
  std::uint8_t triangle_count;   ///< how many
  std::uint8_t own_vertices;     ///< the list's own vertices
  std::uint16_t first_mask;      ///< index into ResolvedTable::masks
};

/// One resolution of the squares of one signature.
struct ResolvedEntry {
  ResolvedList separate;    ///< the polygons apart
  ResolvedList low;         ///< the cube's centre is low
  ResolvedList high;        ///< the cube's centre is high
  std::uint8_t components;  ///< polygons
};

/// All resolutions of all signatures of the cube.
struct ResolvedTable {
  std::uint32_t version;                  ///< kContractVersion
  std::uint32_t entry_count;              ///< 656
  const std::uint16_t* first_entry;       ///< 256
  const std::uint8_t* ambiguous_squares;  ///< 256
  const ResolvedEntry* entries;           ///< entry_count
  const std::uint8_t* triangles;          ///< x 3 local vertices
  const std::uint32_t* masks;             ///< own vertex: bit v: corner v; bit 8 + e: edge e
};

}  // namespace tegl::tables
