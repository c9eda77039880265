// SPDX-License-Identifier: BSD-3-Clause
//
// Triangulation of polygons, by several methods.
//
// Based on: M. Liversage, thesis, 1994, section 8.1, Methods 1 to 4. The names are ours.
#pragma once

#include <array>
#include <cstddef>
#include <ranges>
#include <span>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// How a polygon is triangulated.
enum class PolygonTriangulation {
  fan,            ///< Method 1: chords from one point to all others (8.1.4)
  zigzag,         ///< Method 2: alternating chords across the polygon (8.1.6)
  halving_chord,  ///< Method 3: recursive halving by the shortest halving chord (8.1.9, 8.1.13)
  halving_kink,   ///< Method 3: recursive halving by the chord with the smallest bend (8.1.9, 8.1.14)
  barycentric,    ///< Method 4: the barycentre is joined to all points; triangles stay (8.1.18, 8.1.23)
};

namespace detail {
/// The number of coordinates of the points of a container; 0 if these are no std::array<double, N>.
template <class Point>
inline constexpr int kCoordinates = 0;
template <std::size_t N>
inline constexpr int kCoordinates<std::array<double, N>> = static_cast<int>(N);
template <class Points>
inline constexpr int kPointDim = kCoordinates<std::ranges::range_value_t<Points>>;
}  // namespace detail

/// Two points of a polygon, by number.
using Chord = std::array<Index, 2>;

/// The triangles of a polygon, as rows of three point numbers, each oriented as the polygon. There are #points - 2
/// triangles; with a barycentre, which gets number #points, there are #points triangles.
///
/// `points`: in order around the polygon, which need not be planar; points may coincide. `forbidden`: chords that no
/// triangulation may use. (If two polygons that share both ends of a chord used it, four triangles would meet in it.)
///
/// A fan or a zigzag starts at the first point from which it has no forbidden chord. Halving splits each part of m
/// points recursively. Candidates are the chords with equally many points on both sides (one more on one side if m is
/// odd); the one of smallest weight is taken, the first of several. If all candidates are forbidden, or leave a part
/// that has only forbidden chords, the chords with one point less on one side are tried, and so on. The weight of
/// halving_kink is 1 - angle / pi, averaged over both ends of the chord: at each end, the part's edges that meet there
/// are projected along the chord, and the angle is between the projections (0 if one is zero). If every fan or zigzag
/// has a forbidden chord, the polygon is halved by the shortest chords; if no triangulation avoids forbidden chords, it
/// gets a barycentre.
///
/// Errors: InvalidArgument for fewer than 3 points, or for numbers in `forbidden` out of range. O(#points) for fan and
/// zigzag, O(#points log #points) for halving; with forbidden chords a higher power, intended for small polygons.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] std::vector<std::array<Index, 3>> triangulate_polygon(std::span<const std::array<double, N>> points,
                                                                    PolygonTriangulation method,
                                                                    std::span<const Chord> forbidden = {});

/// The same for a container of points, which gives N: `triangulate_polygon(points, PolygonTriangulation::fan)`.
template <std::ranges::contiguous_range Points>
requires DimensionBetween < detail::kPointDim<Points>,
2, 4 > [[nodiscard]] std::vector<std::array<Index, 3>> triangulate_polygon(const Points& points,
                                                                           PolygonTriangulation method,
                                                                           std::span<const Chord> forbidden = {}) {
  constexpr int kDim = detail::kPointDim<Points>;
  return triangulate_polygon<kDim>(std::span<const std::array<double, kDim>>(points), method, forbidden);
}

/// The mean of the midpoints of a polygon's edges, weighted by edge length; if all points coincide, that point.
/// `points`: at least one.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] std::array<double, N> polygon_barycentre(std::span<const std::array<double, N>> points);

/// The same for a container of points, which gives N.
template <std::ranges::contiguous_range Points>
requires DimensionBetween < detail::kPointDim<Points>,
2, 4 > [[nodiscard]] std::array<double, detail::kPointDim<Points>> polygon_barycentre(const Points& points) {
  constexpr int kDim = detail::kPointDim<Points>;
  return polygon_barycentre<kDim>(std::span<const std::array<double, kDim>>(points));
}

/// Triangulates the polygons of a 3D contour of an image. The result is a manifold with every method: chords between
/// two points of one square of the grid are forbidden, as the cube on the other side might use them too.
///
/// The points of `facets` keep their numbers. Barycentres come last, with the mean of their polygon's normals if there
/// are normals. Triangles come polygon by polygon. Errors: TooLarge, Cancelled, UnsupportedData for facets with
/// periods and for those of a complex. O(size).
template <Coordinate Real>
[[nodiscard]] Contour<3, Real> triangulate(const FacetHierarchy<3, Real>& facets, PolygonTriangulation method,
                                           const WorkOptions& work = {});

}  // namespace tegl
