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

#include "tegl/tile/complex.hpp"

namespace tegl::facets {

/// Set of corners of a tile: bit v = corner v.
using Signature = std::uint64_t;

/// A face of a polytope.
struct Face {
  int dim = 0;                         ///< dimension
  Signature corners = 0;               ///< the tile's corners in this face
  std::vector<std::uint32_t> faces{};  ///< indices of the faces of codimension one, ascending
  std::vector<int> signs{};            ///< incidence numbers of `faces` in this face's boundary, outward normal first
};

/// The faces of a polytope, of every dimension; the polytope itself is the last. Faces are sorted by dimension, then by
/// their ascending corners in lexicographic order. Consequence: an embedding of a face that keeps the order of corners
/// keeps the order of faces, and of everything built from them.
class FaceLattice {
 public:
  /// Builds the lattice from the corner sets of the faces of codimension one of a polytope of dimension `dim` with up
  /// to 64 corners. Throws std::invalid_argument for a dimension above 6 and if faces are missing or too many. The
  /// checks are necessary conditions only: some families of sets that belong to no polytope pass.
  FaceLattice(int dim, std::span<const Signature> maximal_faces);
  static FaceLattice cube(int n);        ///< n = 1 ... 6; corner v has coordinate i = v >> i & 1
  static FaceLattice simplex(int n);     ///< n = 1 ... 6; n + 1 corners
  static FaceLattice octahedron(int n);  ///< n = 2 ... 6; corners 2 a and 2 a + 1 are the ends of axis a

  [[nodiscard]] int dim() const { return faces_.back().dim; }               ///< dimension of the polytope
  [[nodiscard]] const std::vector<Face>& faces() const& { return faces_; }  ///< all faces, ascending by dimension
  [[nodiscard]] std::vector<Face> faces() const&& { return faces_; }        ///< for a temporary: a copy
  /// Index of the polytope itself.
  [[nodiscard]] std::uint32_t tile() const { return static_cast<std::uint32_t>(faces_.size() - 1); }

 private:
  void check(const Face& face) const;
  void orient(Face& face);

  std::vector<Face> faces_;
};

/// How a face of dimension 2 or more fills its contour.
enum class Choice : std::uint8_t {
  separate,  ///< spheres are coned; other components and ambiguous polygons follow the default alternative
  low,       ///< the centre is low: high regions of the boundary are copied, or coned if one sphere bounds them
  high,      ///< the centre is high: low regions of the boundary are copied, or coned if one sphere bounds them
};

/// The sign of a centre that `Choice` leaves open.
enum class Alternative : std::uint8_t { low, high };

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

/// How a facet is filled: a single simplex, a cone over its boundary, or a copy of one side of its boundary.
enum class Filling : std::uint8_t { simplex, cone, side };

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
TileFacets build_facets(const FaceLattice& lattice, Signature signature, const Resolution& resolution = {});

}  // namespace tegl::facets
