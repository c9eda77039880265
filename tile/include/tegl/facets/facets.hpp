// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of one tile, of any dimension up to 6 and any shape given as a face lattice, with every ambiguity
// resolved as the caller says. No tables: tiles are built one by one.
//
// Every face f of the tile, of every dimension k, has three complexes: F, the contour in it (dimension k - 1), and H
// and L, its high and low part, triangulated, with F in common. Each restricts to the same of the faces of f, and F is
// full in H and in L. Those of f follow from those of its own faces: a component of the boundary of F that is shown to
// be a sphere is coned; the others are filled with a copy of one side of the boundary, pushed inwards.
//
// Based on: M. Liversage, thesis, 1994, sections 7.6 and 10.1 (recursion over dimension, barycentres). Side filling
// and the recognition of spheres go beyond it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tegl/facets/complex.hpp"

namespace tegl::facets {

/// Set of corners of a tile: bit v = corner v.
using Signature = std::uint64_t;

/// A face of a polytope.
struct Face {
  int dim = 0;                         ///< its dimension
  Signature corners = 0;               ///< the tile's corners that it has
  std::vector<std::uint32_t> faces{};  ///< those of codimension one, by index, ascending
  std::vector<int> signs{};            ///< their incidence numbers in this face's boundary, outward normal first
};

/// The faces of a polytope, of every dimension from 0 to its own, which is the last.
/// Sorted by dimension, then by their ascending corners in lexicographic order. An embedding of a face that keeps the
/// order of corners therefore keeps the order of faces, and all that is built from it.
class FaceLattice {
 public:
  /// From the corner sets of the faces of codimension one of a polytope of dimension `dim` with up to 64 corners.
  /// Throws std::invalid_argument for a dimension above 6, and if faces are missing or too many: not every family of
  /// sets that is no polytope's is found.
  FaceLattice(int dim, std::span<const Signature> maximal_faces);
  static FaceLattice cube(int n);        ///< n = 1 ... 6; corner v has coordinate i = v >> i & 1
  static FaceLattice simplex(int n);     ///< n = 1 ... 6; n + 1 corners
  static FaceLattice octahedron(int n);  ///< n = 2 ... 6; corners 2 a and 2 a + 1 are the ends of axis a

  [[nodiscard]] int dim() const { return faces_.back().dim; }               ///< of the polytope
  [[nodiscard]] const std::vector<Face>& faces() const& { return faces_; }  ///< all of them
  [[nodiscard]] std::vector<Face> faces() const&& { return faces_; }        ///< of a temporary: a copy
  /// The polytope itself, as a face.
  [[nodiscard]] std::uint32_t tile() const { return static_cast<std::uint32_t>(faces_.size() - 1); }

 private:
  void check(const Face& face) const;
  void orient(Face& face);

  std::vector<Face> faces_;
};

/// How a face of dimension 2 or more fills its contour.
enum class Choice : std::uint8_t {
  separate,  ///< spheres are coned; what is none, and an ambiguous polygon, takes the default alternative
  low,       ///< the centre is low: copies of the high regions of the boundary, cones where one sphere bounds a region
  high,      ///< the centre is high: the same of the low regions
};

/// The sign of a centre that nothing else decides.
enum class Alternative : std::uint8_t { low, high };

/// How the ambiguities of a tile are resolved.
struct Resolution {
  std::span<const Choice> choices{};           ///< one per face of the lattice, or empty: all separate
  Alternative alternative = Alternative::low;  ///< where choices say nothing
};

/// Where a vertex comes from.
enum class VertexKind : std::uint8_t {
  corner,      ///< corner of the tile; in no contour
  edge,        ///< where the contour meets a critical edge
  barycentre,  ///< of a component of Sigma: the mean of its simplices, weighted by their measure
  side,        ///< a copy of another vertex, moved from there into the face, towards its middle
  /// Of a part of a face: the mean of the vertices of its boundary. If it copies a vertex: half-way between that one
  /// and the copy of it that the contour has. In no contour.
  centre,
};

/// A vertex. `face` and `number` depend on the face alone (its signature and choices), so that tiles share them.
struct Vertex {
  VertexKind kind = VertexKind::corner;  ///< where it comes from
  std::uint32_t face = 0;                ///< index of the smallest face that contains it
  std::uint32_t number = 0;              ///< among the face's centres, or among its other vertices
  VertexId copied = kNoVertex;           ///< side: the vertex that it is a copy of
  std::vector<Simplex> of{};             ///< barycentre: Sigma's component; centre: simplices around it
};

/// How a facet is filled: it is a simplex; a cone over its boundary; a copy of one side of it.
enum class Filling : std::uint8_t { simplex, cone, side };

/// A piece of the contour: a manifold of dimension n - 1.
struct Facet {
  Filling filling = Filling::simplex;  ///< how it was filled
  int boundary_euler = 0;              ///< Euler characteristic of the part of Sigma that it bounds
  Simplices simplices{};               ///< oriented: the simplex followed by a normal towards high is positive
};

/// The contour of one tile of dimension n.
struct TileFacets {
  std::vector<Vertex> vertices = {};  ///< all that the tile's facets and faces have
  std::vector<Facet> facets = {};     ///< simplices of n vertices
  Simplices sigma = {};               ///< simplices of n - 1 vertices
  std::vector<int> sigma_sign = {};   ///< +1 or -1 for each simplex of Sigma
  std::vector<int> sigma_euler = {};  ///< Euler characteristics of Sigma's components
  /// The contour in each face of codimension one, in the order of the tile's `faces`, vertices ascending, and for each
  /// simplex its sign: of the orientation that it has as a part of the face's own contour.
  std::vector<Simplices> in_face = {};
  std::vector<std::vector<int>> in_face_sign = {};  ///< see above
};

/// Whether it is told where vertices lie.
enum class Geometry : std::uint8_t {
  with,
  without,  ///< vertices lack `copied` and `of`: enough for topology, and faster
};

/// Builds tiles of one lattice, one after the other. What it has built in faces of dimension up to 3 it keeps, and
/// up to a limit what it has built in those of dimension 4 and more without choices. One thread at a time.
class FacetBuilder {
 public:
  /// `max_kept_bytes`: the limit. Throws std::invalid_argument for a lattice of dimension less than 2.
  explicit FacetBuilder(FaceLattice lattice, std::size_t max_kept_bytes = std::size_t{1} << 28);
  ~FacetBuilder();
  FacetBuilder(FacetBuilder&&) noexcept;             ///< moved from: good for nothing but to be assigned to
  FacetBuilder& operator=(FacetBuilder&&) noexcept;  ///< likewise

  [[nodiscard]] const FaceLattice& lattice() const&;  ///< what tiles are made of
  [[nodiscard]] FaceLattice lattice() const&&;        ///< of a temporary: a copy
  /// What is kept of faces of dimension 4 and more.
  [[nodiscard]] std::size_t kept_bytes() const;

  /// The contour of a tile, valid until the next call. Time: about linear in the simplices of all faces.
  /// Throws std::invalid_argument for a signature with bits beyond the corners or a wrong number of choices,
  /// std::length_error for a tile of more than 65 535 vertices (none is known).
  const TileFacets& build(Signature signature, const Resolution& resolution = {}, Geometry geometry = Geometry::with) &;
  /// By a temporary: the contour itself.
  TileFacets build(Signature signature, const Resolution& resolution = {}, Geometry geometry = Geometry::with) &&;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same for a single tile, with a builder of its own: of many tiles, most of the time would go to making builders.
TileFacets build_facets(const FaceLattice& lattice, Signature signature, const Resolution& resolution = {});

}  // namespace tegl::facets
