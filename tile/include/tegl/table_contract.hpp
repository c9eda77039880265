// SPDX-License-Identifier: BSD-3-Clause
//
// The table contract: the layout of the tables that the generator emits and the runtime reads. Plain structs and a
// version, no dependencies.
//
// Numbering of an n-tile (n = 2, 3, 4). All numbers refer to the tile's own frame.
//   corner v        coordinate x_i = (v >> i) & 1; a signature has bit v set iff corner v is high
//   edge e          e = axis * 2^(n-1) + squeeze(base, axis): the edge along `axis` from corner `base`
//                   (whose bit `axis` is 0); squeeze removes bit `axis` from `base`
//   cube f (n = 4)  f = 2 * a + side: the 3-face x_a = side. Its own frame keeps the other axes in ascending
//                   order, so its corners and edges are numbered as in a 3-tile
//
// Local vertices of a tile's simplices, one byte each:
//   [0, E)                    the contour's point on edge e                     E = n 2^(n-1)
//   [E, E + F S)              barycentre j of cube f's facets: E + f S + j      F = 8 for n = 4, else 0
//                             (j counts the cone vertices of the cube's own entry in the 3D table of
//                             the same triangulation; S = kFaceSlots)
//   [E + F S, ...)            the tile's own vertices: first its cone vertices (barycentres), then its
//                             side vertices
//
// Positions. An edge point is interpolated along its edge. A cone vertex v is the barycentre of the facet that it
// cones. It is the first vertex of its simplices (v, t_1 ... t_{n-1}). With M the measure of t = (t_1 ... t_{n-1}) and
// B(t) its barycentre, v lies at sum M(t) B(t) / sum M(t) over these simplices. B of a segment is its midpoint. B of a
// triangle (n = 4) is the position of t_1 if t_1 is a cube's barycentre (local id >= E), else sum |side| mid(side) /
// sum |side| over its three sides (thesis, definition 10.1.4). In the compact triangulation a cone vertex is the mean
// of the other vertices of its simplices. A side vertex with mask m is the mean of the edge points in m or, with
// corners, anywhere on the ray from the tile's centre to the mean of the corners and edge points in m.
//
// Orientation. The positive side of a simplex faces the high corners: for a simplex (v_0 ... v_{n-1}) and a vector d
// towards the high side, det[v_1 - v_0, ..., v_{n-1} - v_0, d] > 0. In the plane, high is on the left of v_0 -> v_1. In
// space, the right-hand normal points to high.
//
// Alternatives. Tables hold the low-connected alternative. The high-connected alternative of signature s is the
// low-connected one of ~s with reversed orientation, for every n and triangulation.
#pragma once

#include <array>
#include <cstdint>

#include "tegl/tile/triangulation.hpp"

namespace tegl::tables {

/// Version of the layout below. Emitted tables carry it; the runtime checks it at compile time.
inline constexpr std::uint32_t kContractVersion = 1;

/// Number of barycentre slots per cube of a 4-tile in the local vertex numbering.
inline constexpr std::uint32_t kFaceSlots = 2;

/// Number of edges of an n-tile.
constexpr std::uint32_t edge_count(std::uint32_t n) { return n << (n - 1); }

/// First local vertex number of the tile's own vertices.
constexpr std::uint32_t first_tile_vertex(std::uint32_t n) { return edge_count(n) + (n == 4 ? 8 * kFaceSlots : 0); }

/// One triangulated list of facets.
struct List {
  std::uint32_t first_simplex;  ///< index into TileTable::simplices, in simplices (not bytes)
  std::uint16_t simplex_count;  ///< number of simplices
  std::uint8_t cone_vertices;   ///< number of the tile's own vertices that are barycentres
  std::uint8_t side_vertices;   ///< number of the tile's own vertices of side fillings; numbered after the barycentres
  std::uint32_t first_side;     ///< index into TileTable::side_masks
};

/// All facets of all 2^(2^n) signatures in the low-connected alternative, for one triangulation.
///
/// Flat layout: list_of[s] is the list of signature s itself, and element_of is null.
/// Class layout: list_of[s] is the list of the class's representative r, and element_of[s] is the group element g with
/// s = g(r). A stored vertex v < first_tile_vertex(n) then maps to permutations[g * permutation_stride + 2^n + v]. If
/// that vertex is in a cube f with bit f set in slot_swaps[s] (f: the cube after g), slots 0 and 1 are exchanged.
/// Corners v of side masks map to permutations[g * permutation_stride + v]. If reverses[g] is 1, the last two vertices
/// of each simplex are exchanged. The tile's own vertices keep their numbers.
struct TileTable {
  std::uint32_t version;             ///< kContractVersion
  std::uint32_t dim;                 ///< n
  std::uint32_t list_count;          ///< number of lists
  std::uint32_t simplex_count;       ///< number of simplices in all lists
  std::uint32_t element_count;       ///< number of group elements, 0 in the flat layout
  std::uint32_t permutation_stride;  ///< 2^n + first_tile_vertex(n), or 0
  std::uint32_t max_simplices;       ///< maximum over all signatures
  std::uint32_t max_tile_vertices;   ///< maximum over all signatures
  const std::uint16_t* list_of;      ///< 2^(2^n) list indices
  const std::uint16_t* element_of;   ///< 2^(2^n) group elements, or null
  const std::uint8_t* slot_swaps;    ///< 2^(2^n) masks of cubes, or null
  const std::uint8_t* permutations;  ///< element_count x permutation_stride, or null
  const std::uint8_t* reverses;      ///< element_count, or null
  const List* lists;                 ///< list_count
  const std::uint8_t* simplices;     ///< simplex_count x dim local vertices
  const std::uint64_t* side_masks;   ///< bit v: corner v; bit 2^n + e: edge e
};

/// The high part of every 2^(2^k) signature of a k-tile, k = 1, 2, 3, triangulated by k-simplices. It closes a contour
/// at the image border. There is one table per dimension, triangulation and alternative. Vertices are local bytes:
///   [0, 2^k)              corner v
///   [2^k, 2^k + E)        edge point e
///   k = 3: next kFaceSlots  barycentre j of the cube's own facets, as in the 3D tile table
///   k = 3: next 6         not used in these tables (the barycentres of squares, while cubes are filled
///                         in the barycentric way)
///   [own_base, ...)       the tile's own vertices: barycentres of its regions
/// The position of a region's barycentre is the mean of the corners (bit v) and edge points
/// (bit 2^k + e) in its mask. Simplices are oriented by det[v_1 - v_0, ..., v_k - v_0] > 0.
struct RegionList {
  std::uint32_t first_simplex;  ///< index into RegionTable::simplices, in simplices
  std::uint16_t simplex_count;  ///< number of simplices
  std::uint16_t own_vertices;   ///< number of the tile's own vertices
  std::uint32_t first_mask;     ///< index into RegionTable::masks
};

/// First local vertex number of a k-tile's own region vertices.
constexpr std::uint32_t first_region_vertex(std::uint32_t k) {
  return (1u << k) + edge_count(k) + (k == 3 ? kFaceSlots + 6 : 0);
}

/// The regions of all signatures of a k-tile.
struct RegionTable {
  std::uint32_t version;           ///< kContractVersion
  std::uint32_t dim;               ///< k
  std::uint32_t max_own_vertices;  ///< maximum over all signatures
  const RegionList* lists;         ///< one per signature: 2^(2^k)
  const std::uint8_t* simplices;   ///< x (k + 1) local vertices
  const std::uint32_t* masks;      ///< bit v: corner v; bit 2^k + e: edge e
};

/// The cube with every ambiguous square resolved independently: one entry for each signature and each resolution of its
/// ambiguous squares, 656 in all. Square q = 2 a + side has x_a = side. If bit q is set in ambiguous_squares[s], square
/// q is ambiguous: its centre may be high or low. Compress the bits of the ambiguous squares (lowest square first, 1 =
/// the centre is high) to a number r. The entry is first_entry[s] + r.
///
/// An entry has three lists. In `separate`, each polygon is a facet of its own. In `low`, the cube's centre is low and
/// each high region around it is cut off by one facet. In `high`, the cube's centre is high and each low region is cut
/// off. A region bounded by two polygons gives a tunnel between them; a region bounded by three or four gives a sphere
/// with as many holes. In most entries two of the three lists are identical. A local vertex below 12 is an edge point;
/// 12 + j is own vertex j of the list. Its mask has bit v for corner v and bit 8 + e for the point of edge e. If it has
/// edges, the vertex is the mean of their points. If it has corners, they are those of a corner, an edge or a square of
/// the cube, and the vertex is on the ray from the cube's centre to their mean, anywhere between the two; the library
/// chooses the point where the trilinear interpolant has the isovalue. Vertices of tunnels are on rays. Wherever they
/// and the edge points are, no two triangles of a list intersect. The segments in a square are equal in all entries
/// that resolve the square equally. Orientation as above. Single polygons are fans whose first edge does not depend on
/// which side is high, so `separate` can have other diagonals than the list of the compact tables.
struct ResolvedList {
  std::uint16_t first_triangle;  ///< index into ResolvedTable::triangles, in triangles
  std::uint8_t triangle_count;   ///< number of triangles
  std::uint8_t own_vertices;     ///< number of the list's own vertices
  std::uint16_t first_mask;      ///< index into ResolvedTable::masks
};

/// One resolution of the squares of one signature.
struct ResolvedEntry {
  ResolvedList separate;    ///< one facet per polygon
  ResolvedList low;         ///< the cube's centre is low
  ResolvedList high;        ///< the cube's centre is high
  std::uint8_t components;  ///< number of polygons
};

/// All resolutions of all signatures of the cube.
struct ResolvedTable {
  std::uint32_t version;                  ///< kContractVersion
  std::uint32_t entry_count;              ///< 656
  const std::uint16_t* first_entry;       ///< one per signature: 256
  const std::uint8_t* ambiguous_squares;  ///< masks of squares, one per signature: 256
  const ResolvedEntry* entries;           ///< entry_count
  const std::uint8_t* triangles;          ///< x 3 local vertices
  const std::uint32_t* masks;             ///< own vertex: bit v: corner v; bit 8 + e: edge e
};

/// A resolved cube: its key (VariantTable), and the differences in size from the unresolved cube of its signature.
struct Variant {
  std::uint16_t key;              ///< key of the cube
  std::int8_t more_simplices;     ///< number of simplices, less that of the unresolved cube
  std::int8_t more_own_vertices;  ///< number of own vertices, less that of the unresolved cube
};

/// A tile table in the flat layout, in the form that loops over many tiles read.
struct RowTable {
  /// Layout of an entry, from low bits to high: number of simplices, flag for own vertices, first simplex.
  static constexpr unsigned kCountBits = 6;
  static constexpr std::uint32_t kCountMask = (1u << kCountBits) - 1;  ///< bits of the number of simplices
  static constexpr std::uint32_t kOwnFlag = 1u << kCountBits;          ///< set if the tile has own vertices
  static constexpr unsigned kFirstShift = kCountBits + 1;              ///< lowest bit of the first simplex

  /// Bytes of `simplices` that may be read from the first byte of any simplex on, also of the last one.
  static constexpr std::size_t kReadAtOnce = 16;

  const TileTable* table;               ///< the lists; by key if there are variants
  const std::uint32_t* entries;         ///< by signature; n = 2: by key; n = 3 with variants: by place_of(key)
  const std::uint8_t* simplices;        ///< as TileTable::simplices, then kReadAtOnce bytes
  const std::uint8_t* counts;           ///< n = 2, 3: number of simplices by signature, 256; n = 4: null
  const std::uint8_t* shuffles;         ///< n = 2: 2 x 32 x 16 bytes (see segment_bytes); else null
  const std::uint16_t* variant_places;  ///< n = 3 with variants: first entry of each signature's variants; else null
  const tables::Variant* variants;      ///< with variant_places: four for each entry of ResolvedTable; else null
  bool more_keys;                       ///< whether there are more keys than signatures

  /// n = 3 with variants: index of a key's entry. Entries have no gaps, as only few of all possible keys occur.
  [[nodiscard]] constexpr std::uint32_t place_of(unsigned key) const noexcept {
    return variant_places[key & 255u] + (key >> 8);
  }
  /// Entry of a signature or key.
  [[nodiscard]] constexpr std::uint32_t entry(unsigned key) const noexcept {
    return entries[variants == nullptr ? key : place_of(key)];
  }
  /// The cube of an entry of ResolvedTable. `choice`: tile::Choice of its centre, if that matters.
  [[nodiscard]] constexpr const tables::Variant& variant(unsigned resolved, unsigned choice) const noexcept {
    return variants[4 * resolved + choice];
  }
  /// n = 2: byte shuffle of a tile's four vertex numbers that yields two segments, by signature. If the tile has only
  /// one segment, the second is undefined. `flip`: orientation opposite to the table's.
  [[nodiscard]] constexpr const std::uint8_t* segment_bytes(unsigned signature, bool flip) const noexcept {
    return shuffles + 16 * (signature + (flip ? 32u : 0u));
  }
  /// Whether any tile has own vertices.
  [[nodiscard]] constexpr bool has_own_vertices() const noexcept { return table->max_tile_vertices != 0; }
  /// Number of vertices that the tile of a signature or key owns.
  [[nodiscard]] constexpr unsigned own_vertices(unsigned key) const noexcept {
    const List& list = table->lists[table->list_of[key]];
    return unsigned{list.cone_vertices} + list.side_vertices;
  }
};

/// Squares and cubes with resolved ambiguities, n = 2 or 3, in the form of the other tables.
///
/// Keys of squares: `signature | 16` if the square is ambiguous and its centre high. Keys of cubes: `signature |
/// variant << 8`. Variant 0 is the unresolved cube of the plain table. Variant 1 + 3 r + choice has resolution r of the
/// ambiguous squares (ResolvedTable) and the choice of the cube's centre (tile::Choice). In the barycentric
/// triangulation, discs of more than one triangle are coned from their barycentres; tunnels are not.
struct VariantTable {
  TileTable tile;  ///< by key
  RowTable rows;   ///< by key
};

/// The diagonal edges through which regions of a cube with resolved squares may be joined inside it.
struct CubeJoin {
  /// If `pairs` is 1: the lower and the upper end of each of the edges A, C, B, D.
  std::array<std::uint8_t, 8> corners;
  std::uint8_t pairs;      ///< number of pairs that may join
  bool high;               ///< if `pairs` is 1: whether it may join high regions
  std::uint8_t high_pair;  ///< 1 + the pair that may join high regions; 0: none
  std::uint8_t low_pair;   ///< 1 + the pair that may join low regions; 0: none
};

}  // namespace tegl::tables
