// SPDX-License-Identifier: BSD-3-Clause
//
// Projections of 4D contours to 3-space: all of their simplices, or only the outline.
#pragma once

#include "tegl/contour.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/incidence.hpp"
#include "tegl/vector.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// How 4-space is projected to 3-space.
struct Projection {
  /// The line of sight. The result has the coordinates of `frame_of` for the hyperplane across it; along t: x, y, z.
  Vector<4> direction = unit_vector<4>(3);
  /// 0: parallel projection. Else the distance of the eye before the contour's minimum height along the direction.
  /// Objects at the minimum height keep their size; at this distance behind it they are half as large, scaled towards
  /// the centre of the contour's bounding box.
  double eye_distance = 0.0;
};

/// The projected tetrahedra of a contour. They overlap each other.
template <Coordinate Real>
struct ProjectedContour {
  Buffer<std::array<Real, 3>> vertices = {};      ///< #V x 3, row = vertex, numbered as in the contour
  Buffer<std::array<Index, 4>> tetrahedra = {};   ///< #S x 4, as in the contour
  std::array<std::string, 3> axis_names = {};     ///< names of frame axes that are axes of the contour; else empty
  std::array<std::string, 3> axis_units = {};     ///< their units
  std::vector<Attribute> vertex_attributes = {};  ///< the contour's, and the height along the direction (see `project`)
  std::vector<Attribute> simplex_attributes = {};  ///< the contour's, and "side": -1 near, 1 far
};

/// Projects all simplices of a 4D contour (M. Liversage, thesis, 1994, 10.2.5, but to space instead of the screen).
///
/// The height <d, x> / |d| of each vertex along the direction d becomes a vertex attribute, for colours; along t it is
/// the time. It has the name of the axis along d, or "height" for an oblique direction ("t" for an axis without a
/// name). The simplex attribute "side" is -1 if the line of sight enters the contour's high part through the
/// tetrahedron, and 1 if it leaves it or is tangent: along t, -1 means arriving and 1 leaving. Attributes of the
/// contour with these names are replaced. Throws InvalidArgument if the direction is 0 or not finite, the distance is
/// negative or not finite, a coordinate is not finite, a vertex number is out of range, or attributes or normals are of
/// another number; Cancelled. O(#V + #S). The result does not depend on the number of threads.
template <Coordinate Real>
[[nodiscard]] ProjectedContour<Real> project(const Contour<4, Real>& contour, const Projection& projection = {},
                                             const WorkOptions& work = {});

/// The outline (silhouette) of the projection: where the line of sight is tangent to the contour. For the contour of a
/// moving object along t, this is the surface swept by it: the envelope of all positions, inner folds included, with
/// the time of contact at each point.
///
/// Computed from the contour's normals: the mean at each vertex of the surrounding ones, interpolated. The outline is
/// smooth, with an error of second order in the tile size. It is an oriented manifold in 3-space, closed if the contour
/// is closed; its parts may intersect each other, as folds do. To include both ends of a sweep, close the contour
/// (ExtractOptions::close): the first and the last position then belong to the outline, to within a time step. For a
/// `descent` contour its positive side faces away from the swept region, to low. Parts that do not move are seen
/// edge-on, have no outline, and count as far side.
///
/// Vertices get the contour's attributes and the height, as in `project`; triangles get the attributes of their
/// tetrahedron. Errors: those of `project`; Cancelled. O(#V + #S) time and memory. The result
/// does not depend on the number of threads.
template <Coordinate Real>
[[nodiscard]] Contour<3, Real> outline(const Contour<4, Real>& contour, const Projection& projection = {},
                                       const WorkOptions& work = {});

/// The same, in less time, with the contour's incidence. Errors: also InvalidArgument if it is another contour's.
template <Coordinate Real>
[[nodiscard]] Contour<3, Real> outline(const Contour<4, Real>& contour, const Incidence<4>& incidence,
                                       const Projection& projection = {}, const WorkOptions& work = {});

}  // namespace tegl
