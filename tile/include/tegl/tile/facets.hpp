// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of one tile of any dimension up to 6 and of any shape given as a face lattice. The caller resolves the
// ambiguities. Tiles are built one by one, without tables.
//
// Every face f of the tile, of dimension k, has three complexes: the contour F in it (dimension k - 1), and its high
// part H and low part L, both triangulated and both containing F. Restricted to a face of f, they equal the complexes
// of that face. F is a full subcomplex of H and of L. The complexes of f are built from the complexes of its own faces:
// a component of the boundary of F that is proved to be a sphere is coned; the others are filled with a copy of one
// side of the boundary, pushed inwards.
//
// Based on: M. Liversage, thesis, 1994, sections 7.6 and 10.1 (recursion over dimension, barycentres). Side filling and
// the recognition of spheres are additions of tegl.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tegl/tile/choices.hpp"
#include "tegl/tile/complex.hpp"
#include "tegl/tile/face_lattice.hpp"

namespace tegl::tile {

/// How the ambiguities of a tile are resolved.
struct Resolution {
  std::span<const Choice> choices{};           ///< one per face of the lattice, or empty: all `separate`
  Alternative alternative = Alternative::low;  ///< sign of the centre for `separate`
};

/// Origin of a vertex.
enum class VertexKind : std::uint8_t {
  corner,      ///< corner of the tile; never in a contour
  edge,        ///< intersection of the contour with a critical edge
  barycentre,  ///< barycentre of a component of Sigma: mean of its simplices, weighted by measure
  side,        ///< a copy of another vertex, moved into the face towards its centre
  /// Centre of a part of a face: the mean of the vertices of its boundary. If it copies a vertex: the midpoint of that
  /// vertex and the contour's copy of it. Never in a contour.
  centre,
};

/// A vertex. `face` and `number` depend on the face only (its signature and choices), so neighbouring tiles agree on
/// them.
struct Vertex {
  VertexKind kind = VertexKind::corner;  ///< its origin
  std::uint32_t face = 0;                ///< index of the smallest face that contains it
  std::uint32_t number = 0;              ///< counted within the face; centres and other vertices are counted separately
  VertexId copied = kNoVertex;           ///< side: the original vertex
  std::vector<Simplex> of{};             ///< barycentre: the component of Sigma; centre: the simplices around it
};

/// How a facet fills its component of Sigma.
enum class Filling : std::uint8_t {
  simplex,  ///< Sigma is a simplex's boundary: that simplex
  cone,     ///< a cone from an added vertex, the barycentre
  side,     ///< a copy of one side of the tile's boundary, pushed inwards
  /// Simplices on Sigma's own vertices: no vertex is added. Only in the generator's compact tables, not by
  /// FacetBuilder.
  pulled,
};

/// One facet of the contour: a manifold of dimension n - 1 with boundary on the tile's boundary.
struct Facet {
  Filling filling = Filling::simplex;  ///< how it is filled
  int boundary_euler = 0;              ///< Euler characteristic of its boundary, a part of Sigma
  Simplices simplices{};               ///< oriented: the simplex followed by a vector towards high is positive
};

/// The contour of one tile of dimension n.
struct TileFacets {
  std::vector<Vertex> vertices = {};  ///< all vertices of the tile's facets and faces
  std::vector<Facet> facets = {};     ///< their simplices have n vertices
  Simplices sigma = {};               ///< boundary of the contour; simplices of n - 1 vertices
  std::vector<int> sigma_sign = {};   ///< +1 or -1 for each simplex of Sigma
  std::vector<int> sigma_euler = {};  ///< Euler characteristics of Sigma's components
  /// The contour in each face of codimension one, in the order of the tile's `faces`, with ascending vertices.
  std::vector<Simplices> in_face = {};
  std::vector<std::vector<int>> in_face_sign = {};  ///< per simplex: +1 or -1, in the face's own contour
};

/// Whether the positions of vertices can be computed from the result.
enum class Geometry : std::uint8_t {
  with,
  without,  ///< leaves `copied` and `of` of vertices unset: sufficient for topology, and faster
};

/// Builds tiles of one lattice, one after the other. Caches the pieces of faces of dimension up to 3 and, up to a
/// memory limit, the pieces of faces of dimension 4 and more that are built without choices. Not thread-safe.
class FacetBuilder {
 public:
  /// `max_kept_bytes`: limit of the cache for faces of dimension 4 and more; the cache is emptied when a tile exceeds
  /// it. Throws std::invalid_argument for a lattice of dimension less than 2.
  explicit FacetBuilder(FaceLattice lattice, std::size_t max_kept_bytes = std::size_t{1} << 28);
  ~FacetBuilder();
  FacetBuilder(FacetBuilder&&) noexcept;             ///< a moved-from object may only be assigned to or destroyed
  FacetBuilder& operator=(FacetBuilder&&) noexcept;  ///< as the constructor

  [[nodiscard]] const FaceLattice& lattice() const&;  ///< the lattice of the tiles
  [[nodiscard]] FaceLattice lattice() const&&;        ///< for a temporary: a copy
  /// Memory of the cached pieces of faces of dimension 4 and more.
  [[nodiscard]] std::size_t kept_bytes() const;

  /// Builds the contour of a tile; the reference is valid until the next call. Time: about linear in the number of
  /// simplices of all faces. Throws std::invalid_argument for a signature with bits beyond the corners or a wrong
  /// number of choices, std::length_error for a tile with more than 65 535 vertices (no such tile is known).
  const TileFacets& build(Signature signature, const Resolution& resolution = {}, Geometry geometry = Geometry::with) &;
  /// For a temporary builder: returns the contour by value.
  TileFacets build(Signature signature, const Resolution& resolution = {}, Geometry geometry = Geometry::with) &&;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Builds a single tile with a temporary builder. For many tiles use one FacetBuilder: constructing it takes most of
/// the time.
[[nodiscard]] TileFacets build_facets(const FaceLattice& lattice, Signature signature,
                                      const Resolution& resolution = {});

}  // namespace tegl::tile
