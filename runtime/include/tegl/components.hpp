// SPDX-License-Identifier: BSD-3-Clause
//
// Connected components of contours: labels, measures of each component, and separate contours of components.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/incidence.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// The label of a vertex without simplices.
inline constexpr Index kNoComponent = std::numeric_limits<Index>::max();

/// The component of each vertex and each simplex: 0 … count - 1, in the order of the components' smallest vertex
/// numbers. Functions that take labels check that they fit the contour: equal numbers of vertices and simplices, labels
/// exactly for the vertices in simplices, one label for all vertices of a simplex, and a simplex in each component.
struct ComponentLabels {
  Index count = 0;               ///< number of components
  Buffer<Index> vertices = {};   ///< #V; kNoComponent for vertices without simplices
  Buffer<Index> simplices = {};  ///< #S
};

/// Labels the connected components of a contour in N = 2 to 5 dimensions. Two simplices are connected if a chain of
/// simplices that share vertices joins them. (In the manifolds that `extract` makes, this equals connectivity by shared
/// faces. Simplices that repeat a vertex connect their vertices too.)
///
/// Based on: parallel union-find, linked to the smallest number. With any number of threads the labels equal, less one,
/// those of the seed fill of Zhu, Meng and Wang (An Improved Marching Cubes Algorithm, 2008, section 3.2). Errors:
/// InvalidArgument (a vertex number out of range); Cancelled. Nearly O(#S + #V) time; 8 bytes per vertex and 4 per
/// simplex. Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] ComponentLabels label_components(const Contour<N, Real>& contour, const WorkOptions& work = {});

/// Measures of one component.
template <int N>
requires DimensionBetween<N, 2, 5>
struct Component {
  Index label = 0;              ///< its number, as in ComponentLabels
  std::uint64_t vertices = 0;   ///< number of vertices
  std::uint64_t simplices = 0;  ///< number of simplices
  /// Euclidean length (N = 2), area (3), 3-volume (4) or 4-volume (5), in the units of the coordinates.
  double size = 0.0;
  /// The enclosed area (N = 2), volume (3), 4-volume (4) …: positive if the component's inside is high, negative for a
  /// cavity; none if the component is open. A component of a wrapped contour encloses it if it does not wind round a
  /// period, so that it is closed when unrolled; one that winds, only if it does not separate the two ends of an axis
  /// that is not periodic. Contents of components sum to the content of the contour, if all have one.
  std::optional<double> content = {};
  std::array<double, N> centroid{};      ///< of its points, uniformly weighted; for size 0 the middle of the box
  std::array<double, N> lowest{};        ///< minimum corner of the bounding box
  std::array<double, N> highest{};       ///< maximum corner of the bounding box
  std::int64_t euler = 0;                ///< Euler characteristic
  std::uint64_t boundary_simplices = 0;  ///< (N-2)-faces in exactly one simplex; 0 if closed

  /// Extent along the last axis: the lifetime, for images over time.
  [[nodiscard]] double time_span() const noexcept { return highest[N - 1] - lowest[N - 1]; }
};

/// Measures every component, in the order of the labels. Sums are compensated, in an order that does not depend on the
/// number of threads. Simplices that repeat a vertex are counted only in `simplices`. Errors: InvalidArgument (a vertex
/// number out of range, a coordinate that is not finite, labels that do not fit); Cancelled. O(#S log s) time for s
/// simplices around a vertex; 4 N bytes per simplex and 8 per vertex. Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::vector<Component<N>> components(const Contour<N, Real>& contour, const ComponentLabels& labels,
                                                   const WorkOptions& work = {});
/// The same, in less time, with the contour's incidence. Errors: also InvalidArgument if it is another contour's.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::vector<Component<N>> components(const Contour<N, Real>& contour, const ComponentLabels& labels,
                                                   const Incidence<N>& incidence, const WorkOptions& work = {});

/// One contour per component, in the order of the labels. Vertices and simplices keep their order; normals, attributes,
/// names and units are kept. Vertices without simplices are left out. Errors: InvalidArgument (a vertex number out of
/// range, labels that do not fit, attributes or normals of another number); Cancelled. O(#S + #V). One thread.
/// Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::vector<Contour<N, Real>> split_components(const Contour<N, Real>& contour,
                                                             const ComponentLabels& labels,
                                                             const WorkOptions& work = {});

/// The contour of the components with keep[label], otherwise as `split_components`. Errors: as there, and
/// InvalidArgument if the size of `keep` is not the number of components.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Contour<N, Real> select_components(const Contour<N, Real>& contour, const ComponentLabels& labels,
                                                 const std::vector<bool>& keep, const WorkOptions& work = {});

/// The component nearest to a point.
struct NearestComponent {
  Index label = kNoComponent;  ///< kNoComponent for a contour without simplices
  double distance = 0.0;       ///< from the point to the nearest vertex of the component, in steps
};

/// The component with the vertex nearest to a point: of equally near vertices, the one with the smallest number.
/// Differences of coordinates are divided by `steps`, by axis, as axes may have different units; `steps` are positive.
/// A wrapped contour repeats itself by its periods: the distance is that of the nearest repetition, also for oblique
/// periods. If no vertex has a distance whose square is finite, the label is that of the first vertex in a simplex, and
/// the distance infinite. `select_components` makes the component's contour. The contour may be any;
/// `extract_component` (tegl/pick.hpp) reads only a part of an image.
/// Errors: InvalidArgument (labels that do not fit, a point that is not finite, steps that are not positive);
/// Cancelled. O(#S + #V) time. Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] NearestComponent nearest_component(const Contour<N, Real>& contour, const ComponentLabels& labels,
                                                 const std::type_identity_t<std::array<double, N>>& point,
                                                 const std::type_identity_t<std::array<double, N>>& steps,
                                                 const WorkOptions& work = {});
/// The same with steps of 1.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] NearestComponent nearest_component(const Contour<N, Real>& contour, const ComponentLabels& labels,
                                                 const std::type_identity_t<std::array<double, N>>& point) {
  std::array<double, N> ones;
  ones.fill(1.0);
  return nearest_component(contour, labels, point, ones);
}

/// Returns the contour with the labels as attribute "component" of the vertices and of the simplices; attributes of
/// this name are replaced. Vertices without simplices get -1. Move the contour in to avoid a copy. Errors: those of
/// `split_components`.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Contour<N, Real> add_component_attribute(Contour<N, Real> contour, const ComponentLabels& labels);

}  // namespace tegl
