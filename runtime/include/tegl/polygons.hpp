// SPDX-License-Identifier: BSD-3-Clause
//
// From polygons to triangles, in several ways.
//
// Based on: M. Liversage, thesis, 1994, section 8.1, whose Methods 1 to 4 these are. The names are ours.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl {

/// How a polygon becomes triangles.
enum class PolygonTriangulation {
  fan,            ///< Method 1: chords from one point to all others (8.1.4)
  zigzag,         ///< Method 2: chords to and fro across the polygon (8.1.6)
  halving_chord,  ///< Method 3: halves, by the shortest chord that halves the polygon, and so on (8.1.9, 8.1.13)
  halving_kink,   ///< Method 3, by the chord along which the polygon is bent least (8.1.9, 8.1.14)
  barycentric,    ///< Method 4: a new point, the barycentre, joined to all others; triangles stay (8.1.18, 8.1.23)
};

/// Two points of a polygon, by number.
using Chord = std::array<Index, 2>;

/// The triangles of a polygon, as rows of three numbers of its points, each oriented as the polygon. They are as many
/// as the points less two; with a barycentre, which is point number #points then, as many as the points.
///
/// `points`: one after the other around the polygon, which need not be plane. Two points may be in one place.
/// `forbidden`: chords that no triangulation may have. (Where several polygons meet, a chord that two of them draw
/// would have four triangles.)
///
/// A fan begins, and a zigzag, at the first point from which it has no forbidden chord. Halving takes parts of m points
/// in turn: of the chords that leave as many points on either side (or one more, if m is odd), the one of least weight,
/// the first of several; if all of these are forbidden, or leave a part that has only forbidden chords, of those that
/// leave one point less on one side, and so on. The weight of a kink is 1 - angle / pi, the mean of both ends of the
/// chord: there, the edges of the part that meet are projected along the chord, and the angle is between the
/// projections (0 if one of them vanishes). Where there is no fan or zigzag without forbidden chords, the polygon is
/// halved by the shortest chords; where there are no triangles at all without them, it gets a barycentre.
///
/// Errors: InvalidArgument for fewer than 3 points, or numbers in `forbidden` beyond them. O(#points) for fan and
/// zigzag, O(#points log #points) for halving; with forbidden chords a power of it that is meant for small polygons.
template <int N>
requires DimensionBetween<N, 2, 4> std::vector<std::array<Index, 3>> triangulate_polygon(
    std::span<const std::array<double, N>> points, PolygonTriangulation method, std::span<const Chord> forbidden = {});

/// The mean of the middles of a polygon's edges, weighted by their length; of points that are all in one place, that.
/// `points`: at least one.
template <int N>
requires DimensionBetween<N, 2, 4> std::array<double, N> polygon_barycentre(
    std::span<const std::array<double, N>> points);

/// The contour of a 3D image from its polygons. A manifold, as the polygons are, whatever the method: chords that join
/// two points of one square of the grid, which the cube on the other side might draw too, are forbidden.
///
/// The points of `facets` keep their numbers; barycentres come last, with the mean of their polygon's normals, if there
/// are any. Triangles come polygon by polygon. Errors: TooLarge, Cancelled. O(size).
template <class Real>
Contour<3, Real> triangulate(const FacetHierarchy<3, Real>& facets, PolygonTriangulation method,
                             const WorkOptions& options = {});

}  // namespace tegl
