// SPDX-License-Identifier: BSD-3-Clause
//
// Contours as facets of every dimension, with their connectivity up and down, and without triangulation.
//
// Based on: M. Liversage, thesis, 1994, section 7.7 (the complete representation of a contour).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// The face of the grid that a facet lies in.
struct FacetPlace {
  std::uint64_t base;       ///< the face's lowest sample: i_0 + size_0 (i_1 + size_1 (i_2 + ...))
  std::uint16_t signature;  ///< the face's high corners: bit v: the corner that is v >> j & 1 along its j-th axis
  std::uint8_t axes;        ///< bit a: the face reaches from its lowest sample to the next one along axis a
  std::uint8_t number;      ///< of the facet, among those in this face
  /// The facet is a part of the border of the image, added by ExtractOptions::close: what is high of a face there. It
  /// then has as many dimensions as the face; others have one less.
  bool is_cap;
};

/// The contour of an N-dimensional image, N = 2, 3, 4, as a complex of facets. A k-facet is a connected piece of the
/// contour in a (k+1)-face of the grid: a point on an edge, a segment in a square, a polygon (not plane, as a rule) in
/// a cube, a polyhedron in a tesseract. Points, segments and polygons are balls, polyhedra too, but for those that are
/// solid tori (facet_euler tells).
///
/// Where the data decide (Ambiguity::mean, saddle, custom), a cube's contour may have a tunnel, which is no ball: its
/// triangles are the polygons there, and the points and segments between them are 0- and 1-facets that lie in a cube.
/// Polyhedra may be balls with any number of handles, and have a boundary of several parts.
///
/// Facets of each dimension are numbered from 0 on, in the order of layers of the image along its last axis: first what
/// lies in the layer, then what lies between it and the next; row by row, for rows along axis 0; in a row by the bits
/// of `axes`; and then along the row. Caps come last. Points on edges and in squares come in the order of the vertices
/// of `extract` (which has others between them, where it needs more); those in cubes of 4D are in another order there.
///
/// Orientation: k-facets with k < N - 1 followed by a normal towards high are positive in their face, its axes
/// ascending; (N-1)-facets are oriented as the simplices of `extract`, by ExtractOptions::direction. Points have no
/// orientation; nor have segments inside of cubes but that of their start and end. The incidence number of a facet in
/// the boundary of another is +1 or -1; the boundary of a boundary is zero.
template <int N, Coordinate Real = float>
requires DimensionBetween<N, 2, 4>
struct FacetHierarchy {
  using Vertex = std::array<Real, N>;  ///< a point, N coordinates

  /// Facets of one dimension.
  struct Level {
    Buffer<FacetPlace> places = {};  ///< #F
    Buffer<Index> down_first = {};   ///< #F + 1; of points none
    Buffer<Index> down = {};         ///< facets of the next lower dimension, those of facet f from down_first[f] on
    Buffer<std::int8_t> down_signs = {};  ///< their incidence numbers
    Buffer<Index> up_first = {};          ///< after connect_up: #F + 1; of (N-1)-facets none
    Buffer<Index> up = {};                ///< facets of the next higher dimension, ascending
    Buffer<std::int8_t> up_signs = {};    ///< the incidence numbers of this facet in them
  };

  std::array<Level, N> levels = {};                          ///< by dimension k
  Buffer<Vertex> vertices = {};                              ///< #0-facets x N world coordinates, row = 0-facet
  Buffer<Vertex> normals = {};                               ///< as many, of length 1 or 0, if asked for; else empty
  std::array<std::size_t, N> sizes{};                        ///< of the image
  std::array<std::string, N> axis_names = {};                ///< taken from the grid
  std::array<std::string, N> axis_units = {};                ///< likewise
  GradientDirection direction = GradientDirection::descent;  ///< which side facets face

  /// Facets of dimension k.
  [[nodiscard]] std::size_t count(int k) const noexcept { return levels[k].places.size(); }

  /// The facets that bound facet f of dimension k >= 1. Of a segment: its start and its end. Of a polygon: its segments
  /// in turn, along its orientation, each beginning where the one before ends. Of a polyhedron: its polygons.
  [[nodiscard]] std::span<const Index> down(int k, std::size_t f) const& noexcept {
    return part(levels[k].down, levels[k].down_first, f);
  }
  /// Deleted: the numbers of a temporary would be gone.
  std::span<const Index> down(int k, std::size_t f) const&& = delete;
  /// As many incidence numbers. A segment of a polygon with -1 is gone along from its end to its start.
  [[nodiscard]] std::span<const std::int8_t> down_signs(int k, std::size_t f) const& noexcept {
    return part(levels[k].down_signs, levels[k].down_first, f);
  }
  /// Deleted: the numbers of a temporary would be gone.
  std::span<const std::int8_t> down_signs(int k, std::size_t f) const&& = delete;
  /// The facets of dimension k + 1 that facet f of dimension k < N - 1 bounds; empty before connect_up.
  [[nodiscard]] std::span<const Index> up(int k, std::size_t f) const& noexcept {
    return part(levels[k].up, levels[k].up_first, f);
  }
  /// Deleted: the numbers of a temporary would be gone.
  std::span<const Index> up(int k, std::size_t f) const&& = delete;
  /// As many incidence numbers: the sign that f has in the boundary of each.
  [[nodiscard]] std::span<const std::int8_t> up_signs(int k, std::size_t f) const& noexcept {
    return part(levels[k].up_signs, levels[k].up_first, f);
  }
  /// Deleted: the numbers of a temporary would be gone.
  std::span<const std::int8_t> up_signs(int k, std::size_t f) const&& = delete;

  /// Makes what `up` tells. O(size). Call it again after changes.
  void connect_up();

  /// The points of facet f of dimension k, each once. Of a segment: start, end. Of a polygon: in turn, along its
  /// orientation. Of a polyhedron: ascending.
  [[nodiscard]] std::vector<Index> points_of(int k, std::size_t f) const;

  /// The index of a sample along each axis.
  [[nodiscard]] std::array<std::size_t, N> index_of(std::uint64_t sample) const noexcept {
    std::array<std::size_t, N> index;
    for (int a = 0; a < N; ++a) {
      index[a] = static_cast<std::size_t>(sample % sizes[a]);
      sample /= sizes[a];
    }
    return index;
  }

 private:
  template <class T>
  static std::span<const T> part(const Buffer<T>& all, const Buffer<Index>& first, std::size_t f) noexcept {
    if (first.empty()) return {};
    return {all.data() + first[f], first[f + 1] - first[f]};
  }
};

/// The facets of the contour {value = isovalue} of an image. `options` as for `extract`, but that `triangulation` means
/// nothing. Every triangulation that `extract` makes is a subdivision of the result: same points on edges, same
/// components, same Euler characteristic. A caller's estimator is asked once for each ambiguous cube and tesseract, and
/// for an ambiguous square once and once more for each such cube around it.
///
/// Next to missing values, points and segments where facets touch that do not hang together are doubled. (In 4D the
/// border of a contour may still touch itself in a point or along a segment there, which `extract` parts by simplices
/// of zero size.)
///
/// Errors: those of `extract`, TooLarge as well for 2^32 incidences of one dimension. O(samples + output), on
/// options.threads threads; the same bytes for any number. Memory beside the result, in 4D: 3 bytes per sample, 240 per
/// row along axis 0 and 4 per facet; half of that in 3D, a fifth in 2D; twice as much for closed contours. Where the
/// data decide, 100 more per row and 2 per face of two dimensions or more.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4> FacetHierarchy<N, Real> extract_facets(const Image<T, N>& image, double isovalue,
                                                                          const ExtractOptions& options = {});

/// The Euler characteristic of facet f of dimension k with its boundary: 1, or 0 for a solid torus; of a polyhedron
/// half of that of its boundary: 1 less for each handle, 1 more for each part of the boundary beside the first.
template <int N, class Real>
int facet_euler(const FacetHierarchy<N, Real>& facets, int k, std::size_t f);

/// What is true of a hierarchy.
struct FacetReport {
  std::array<std::uint64_t, 4> facets{};  ///< by dimension
  std::int64_t euler = 0;                 ///< sum over all facets of (-1)^k facet_euler
  std::uint64_t components = 0;           ///< of facets that share others
  std::uint64_t tori = 0;                 ///< polyhedra of Euler characteristic 0; with low and high: solid tori
  std::uint64_t below_zero = 0;           ///< polyhedra of Euler characteristic < 0: of several handles
  std::uint64_t above_one = 0;            ///< polyhedra of Euler characteristic > 1: with cavities
  std::uint64_t border = 0;               ///< (N-2)-facets in one (N-1)-facet
  std::uint64_t branching = 0;            ///< fault: (N-2)-facets in no or more than two (N-1)-facets
  std::uint64_t conflicts = 0;            ///< fault: (N-2)-facets twice with the same sign
  std::uint64_t open_boundaries = 0;      ///< fault: facets the boundary of whose boundary is not zero
  bool operator==(const FacetReport&) const = default;  ///< member by member
};

/// Looks at all facets. O(size).
template <int N, class Real>
FacetReport check(const FacetHierarchy<N, Real>& facets);

}  // namespace tegl
