// SPDX-License-Identifier: BSD-3-Clause
//
// Connected components of contours: labels, what each component is, and contours of some of them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"

namespace tegl {

/// The label of a vertex that no simplex has.
inline constexpr Index kNoComponent = std::numeric_limits<Index>::max();

/// Which component each vertex and each simplex belongs to: 0 … count - 1, in the order of the components' smallest
/// vertex numbers. Functions that take labels refuse those that do not fit the contour: of other numbers of vertices or
/// simplices, with a label for a vertex in no simplex or none for one in a simplex, with a simplex whose vertices have
/// other labels, or with a component without simplices.
struct ComponentLabels {
  Index count = 0;               ///< how many components
  Buffer<Index> vertices = {};   ///< #V; kNoComponent for vertices in no simplex
  Buffer<Index> simplices = {};  ///< #S
};

/// Labels the components of a contour in N = 2 to 5 dimensions. Two simplices are in one component if a chain of
/// simplices that share vertices joins them. (What `extract` gives is a manifold, where sharing vertices is sharing
/// faces. A simplex that repeats a vertex connects its vertices all the same.)
///
/// Based on: parallel union-find, linked to the smallest number. For any number of threads the labels are those that
/// the seed fill of Zhu, Meng and Wang gives (An Improved Marching Cubes Algorithm, 2008, section 3.2), less one.
/// Errors: InvalidArgument (a vertex number out of range); Cancelled. O(#S + #V) time nearly, 8 bytes per vertex and 4
/// per simplex. Thread-safe.
template <int N, class Real>
ComponentLabels label_components(const Contour<N, Real>& contour, const WorkOptions& options = {});

/// What is known of one component.
template <int N>
requires DimensionBetween<N, 2, 5>
struct Component {
  Index label = 0;              ///< its number, as in ComponentLabels
  std::uint64_t vertices = 0;   ///< how many
  std::uint64_t simplices = 0;  ///< how many
  /// Length (N = 2), area (3), 3-volume (4) or 4-volume (5), in the units of the coordinates, as Euclid has it.
  double size = 0.0;
  /// The enclosed area (N = 2), volume (3), 4-volume (4) …: positive where the component's inside is high, negative for
  /// a cavity in it; none where it is open. The sum over the components is that of the whole.
  std::optional<double> content = {};
  std::array<double, N> centroid{};      ///< of its points, each as much as any other; of size 0: the middle of the box
  std::array<double, N> lowest{};        ///< bounding box
  std::array<double, N> highest{};       ///< the other corner
  std::int64_t euler = 0;                ///< Euler characteristic
  std::uint64_t boundary_simplices = 0;  ///< (N-2)-faces in exactly one simplex; 0: closed

  /// How long it is along the last axis: for images with time its life.
  [[nodiscard]] double time_span() const noexcept { return highest[N - 1] - lowest[N - 1]; }
};

/// Describes every component, in the order of the labels. Sums are compensated and in an order that does not depend on
/// the threads. Simplices that repeat a vertex are counted in `simplices` alone.
/// Errors: InvalidArgument (a vertex number out of range, a coordinate that is not finite, labels that do not fit);
/// Cancelled. O(#S log s) time for s simplices around a vertex; 4 N bytes per simplex and 8 per vertex of memory.
/// Thread-safe.
template <int N, class Real>
std::vector<Component<N>> components(const Contour<N, Real>& contour, const ComponentLabels& labels,
                                     const WorkOptions& options = {});

/// A contour for each component, in the order of the labels, with vertices and simplices in the order that they have
/// in the whole, and with its normals, attributes, names and units. Vertices in no simplex are left out.
/// Errors: InvalidArgument (a vertex number out of range, labels that do not fit, attributes or normals of another
/// number); Cancelled. O(#S + #V). Thread-safe.
template <int N, class Real>
std::vector<Contour<N, Real>> split_components(const Contour<N, Real>& contour, const ComponentLabels& labels,
                                               const Progress& progress = {});

/// The contour of the components with keep[label], otherwise as `split_components`. Errors: its own, and
/// InvalidArgument if `keep` has another size than there are components.
template <int N, class Real>
Contour<N, Real> select_components(const Contour<N, Real>& contour, const ComponentLabels& labels,
                                   const std::vector<bool>& keep, const Progress& progress = {});

/// Adds the labels as the attribute "component" of the vertices and of the simplices (replacing attributes of this
/// name); vertices in no simplex get -1. Errors: those of `split_components`.
template <int N, class Real>
void add_component_attribute(Contour<N, Real>& contour, const ComponentLabels& labels);

}  // namespace tegl
