// SPDX-License-Identifier: BSD-3-Clause
//
// 4D contours seen in 3-space: as all of their points, and by the outline that these have.
#pragma once

#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/hyperplane.hpp"

namespace tegl {

/// How 4-space is seen in 3-space.
struct Projection {
  /// Along which to look; across the hyperplane of the result's coordinates, those of `frame_of`. Along t: x, y, z.
  Eigen::Vector4d direction = Eigen::Vector4d::UnitW();
  /// 0: parallel. Else how far an eye is before the contour's least height along the direction: what lies there keeps
  /// its size, what is as far behind it as the eye is before it is half as large, drawn towards the middle of the
  /// contour's bounding box.
  double eye_distance = 0.0;
};

/// The projected tetrahedra of a contour. They overlap.
template <Coordinate Real>
struct ProjectedContour {
  Buffer<std::array<Real, 3>> vertices = {};      ///< #V x 3, row = vertex, numbered as in the contour
  Buffer<std::array<Index, 4>> tetrahedra = {};   ///< #S x 4, as in the contour
  std::array<std::string, 3> axis_names = {};     ///< where an axis of the result is one of the contour's
  std::array<std::string, 3> axis_units = {};     ///< likewise
  std::vector<Attribute> vertex_attributes = {};  ///< the contour's, and the height along the direction (see `project`)
  std::vector<Attribute> simplex_attributes =
      {};  ///< the contour's, and "side": -1 for the near side, 1 for the far side
};

/// Projects a 4D contour (M. Liversage, thesis, 1994, 10.2.5, down to space instead of the screen).
///
/// The direction's height <d, x> / |d| of each vertex, along t the time, becomes the vertex attribute by the name of
/// the axis that is looked along, or "height" for an oblique direction ("t" for an axis without a name): colour by it.
/// "side" tells the tetrahedra that the line of sight enters the contour's high part through (-1) from those where it
/// leaves it, or that are seen edge-on (1): along t, where something arrives, and where it leaves. If the contour has
/// an attribute of that name already, it is replaced. Throws InvalidArgument if the direction is 0 or not finite,
/// the distance below 0 or not finite, a coordinate not finite, a vertex number out of range, or attributes or normals
/// are of another number. O(#V + #S).
template <class Real>
ProjectedContour<Real> project(const Contour<4, Real>& contour, const Projection& projection = {});

/// The outline of the projection: where the line of sight touches the contour. Along t, of the contour of something
/// that moves, the surface that it sweeps: the envelope of all its positions, inner folds included, with the time when
/// each place was touched.
///
/// It is made by the contour's normals, the mean at each vertex of those around it, interpolated: smooth, with an error
/// of second order in the size of tiles. The result is an oriented manifold in 3-space (parts of which may cross each
/// other, as folds do), closed if the contour is. For a sweep with its ends close the contour (ExtractOptions::close):
/// then the first and the last position belong to it, to within a time step. Its positive side faces away from the
/// swept region, to low, for a `descent` contour. What stands still is seen edge-on, has no outline, and counts as far
/// side.
///
/// Vertices have the contour's attributes and the height, as `project` makes them; triangles have those of the
/// tetrahedron that they lie in. Errors: those of `project`; Cancelled. O(#V + #S) time and memory. One thread.
template <class Real>
Contour<3, Real> outline(const Contour<4, Real>& contour, const Projection& projection = {},
                         const WorkOptions& options = {});

}  // namespace tegl
