// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of one tile, by recursion over dimension: the facets of a tile's faces close up to a manifold
// on the tile's boundary (Sigma); each of its components is filled by one facet.
//
// Based on: M. Liversage, thesis, 1994, sections 7.6 and 10.1 (recursion, barycentres); the filling of
// components that are no spheres, the compact triangulation and the certificate go beyond it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "tegl/gen/lattice.hpp"

namespace tegl::gen {

/// How ambiguous squares are resolved: the high corners apart (low), or joined (high).
enum class Alternative { low, high };
/// How facets become simplices: coned from barycentres, or with few vertices more.
enum class Triangulation { barycentric, compact };

/// How a facet fills its component of Sigma.
enum class Filling {
  point,    ///< dimension 1: the point on an edge
  simplex,  ///< Sigma is a simplex's boundary: that simplex
  cone,     ///< a cone from the barycentre
  pulled,   ///< a cone from one of Sigma's own vertices, or a polygon cut by chords: no vertex is added
  side,     ///< a copy of one side of the tile's boundary, pushed inwards
};

/// An oriented simplex by local vertices as in the table contract; the first n count for an n-tile.
using Simplex = std::array<std::uint8_t, 4>;

/// A piece of the contour: a manifold of dimension n - 1.
struct Facet {
  Filling filling = Filling::simplex;  ///< how it was filled
  int sign = 1;                        ///< dimension 1 only: +1 if the edge's second end is high
  int boundary_euler = 0;              ///< Euler characteristic of its component of Sigma
  std::vector<std::uint8_t> points;    ///< its edge points; n = 3: in cyclic order, n = 2: from, to; else ascending
  std::vector<Simplex> simplices{};    ///< its triangulation, by local vertices
  std::uint32_t boundary_facets = 0;   ///< number of (n-2)-facets around it
};

/// All facets of a tile, the positive side facing the high corners.
struct TileContour {
  std::vector<Facet> facets;               ///< the pieces
  std::vector<Simplex> boundary;           ///< Sigma: oriented (n-2)-simplices, n - 1 vertices each
  std::vector<std::int8_t> boundary_sign;  ///< n = 2 only (0-simplices): +1 or -1
  std::uint32_t cone_vertices = 0;         ///< vertices of its own that are barycentres
  std::vector<std::uint64_t> side_masks;   ///< one per side vertex: corners and edges to average
};

class HullContours;
class RegionBuilder;

/// Builds the contour of any signature of a lattice's n-tile, n = 1 ... 4, by one rule.
/// The result depends on the signature alone, and in each face on the face's own signature alone.
class ContourBuilder {
 public:
  /// For n-tiles of a lattice, n at most its dimension. The lattice must outlive it.
  ContourBuilder(const Lattice& lattice, int n, Alternative alternative, Triangulation triangulation);
  ~ContourBuilder();
  ContourBuilder(const ContourBuilder&) = delete;
  ContourBuilder& operator=(const ContourBuilder&) = delete;

  /// Thread safe. Throws std::logic_error where a component could not be filled (never for n <= 4).
  [[nodiscard]] TileContour build(Signature signature) const;

  [[nodiscard]] const Tile& tile() const { return *tile_; }                     ///< what is built
  [[nodiscard]] int dim() const { return tile_->dim; }                          ///< of the tile
  [[nodiscard]] Alternative alternative() const { return alternative_; }        ///< where squares are ambiguous
  [[nodiscard]] Triangulation triangulation() const { return triangulation_; }  ///< how facets become simplices
  /// Sign between the boundary of the contour and the lifted, signed contours of the faces.
  [[nodiscard]] int orientation() const { return orientation_; }
  /// First local id of the tile's own vertices.
  [[nodiscard]] std::uint32_t own_base() const;
  /// The contour of face f's own tile with the signature that it has under `signature`.
  [[nodiscard]] const TileContour& face_contour(std::uint32_t f, Signature signature) const;
  /// A local vertex of face f as a local vertex of the tile.
  [[nodiscard]] std::uint8_t lift(std::uint32_t f, std::uint8_t vertex) const;
  /// The faces (bit f) that contain a local vertex; 0 for the tile's own vertices.
  [[nodiscard]] std::uint32_t faces_of(std::uint8_t vertex) const { return faces_of_[vertex]; }
  /// n = 4: the regions of the cubes that side filling copies.
  [[nodiscard]] const RegionBuilder& side_regions() const { return *side_regions_; }
  /// compact, n >= 3: the hulls that facets are taken from.
  [[nodiscard]] const HullContours& hulls() const { return *hulls_; }

 private:
  void find_orientation();
  [[nodiscard]] TileContour sigma(Signature signature) const;

  const Tile* tile_;
  Alternative alternative_;
  Triangulation triangulation_;
  int orientation_ = 1;                           ///< sign that makes the positive side face high
  std::unique_ptr<ContourBuilder> face_builder_;  ///< one dimension lower
  std::unique_ptr<RegionBuilder> side_regions_;   ///< n = 4
  std::unique_ptr<HullContours> hulls_;           ///< compact, n >= 3
  std::vector<TileContour> face_contours_;        ///< of every signature one dimension lower
  std::array<std::uint32_t, 256> faces_of_{};
};

}  // namespace tegl::gen
