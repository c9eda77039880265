// SPDX-License-Identifier: BSD-3-Clause
//
// Merges vertices of a contour that coincide, drops simplices without size, and reports where the result is no longer a
// manifold.
//
// Based on: M. Liversage, thesis, 1994, remark 7.8.4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Options of `merge_vertices`.
struct MergeOptions {
  /// Vertices at most this far apart are merged, in the units of the coordinates (Euclidean); 0: only vertices with
  /// equal coordinates, and from 4D on those that `extract` keeps off a layer of the last axis by the smallest step of
  /// Real. Finite, 0 or more. Much less than the length of an edge: otherwise simplices may turn over.
  double tolerance = 0.0;
  std::size_t most_listed = 1000;  ///< maximum size of each list in the report; the counts are complete
  WorkOptions work = {};           ///< threads, progress
};

/// Counts of what `merge_vertices` did.
struct MergeCounts {
  ContourSize before = {};                ///< size of the contour
  ContourSize after = {};                 ///< size of the result
  std::uint64_t merged_vertices = 0;      ///< vertices replaced by another one
  std::uint64_t collapsed_simplices = 0;  ///< dropped: two of their vertices became one, or they repeated a vertex
  /// Dropped simplices of zero content with different vertices, one of which lies in a face of the others. The
  /// neighbours at this face are divided at this vertex, so that no gap opens.
  std::uint64_t flat_simplices = 0;
  std::uint64_t kept_flat_simplices = 0;  ///< other simplices of zero content; they stay, since they fill a gap
  std::uint64_t divided_simplices = 0;    ///< simplices that were divided beside dropped ones
  std::uint64_t turned_simplices = 0;   ///< simplices whose normal turned by more than 90 degrees; 0 if tolerance is 0
  std::int64_t euler_before = 0;        ///< Euler characteristic of the contour
  std::int64_t euler_after = 0;         ///< Euler characteristic of the result
  std::uint64_t components_before = 0;  ///< components of the contour
  std::uint64_t components_after = 0;   ///< components of the result: more if merging cut one, fewer if it joined some
  /// Components all of whose simplices were dropped: a single sample that equals the isovalue has one.
  std::uint64_t vanished_components = 0;
  /// Places where merging changed the topology, except by vanished components: vertices of the contour that stay and
  /// to which a ring or a sphere of edges shrank, or that span a face that dropped simplices shrank to and that no
  /// other simplex has. A thin tube shrinks so, and is cut, with no pinch.
  std::uint64_t shrunk_places = 0;
  /// Vertices whose link is neither a sphere nor a ball, among those that are merged or beside merged ones.
  std::uint64_t pinched_vertices = 0;
  /// (N-2)-faces in more than two simplices, at these vertices: vertices in 2D, edges in 3D, triangles in 4D.
  std::uint64_t pinched_faces = 0;
};

/// What `merge_vertices` did, and the places where its result is no manifold. Vertex numbers refer to the result.
/// Lists have the first MergeOptions::most_listed items.
template <int N>
requires DimensionBetween<N, 2, 5>
struct MergeReport {
  MergeCounts counts = {};                           ///< complete counts
  std::vector<std::array<double, N>> vanished = {};  ///< places of the vanished components
  std::vector<std::array<double, N>> shrunk = {};    ///< the places where merging changed the topology
  std::vector<Index> vertices = {};                  ///< the pinched vertices, ascending
  std::vector<std::array<Index, N - 1>> faces = {};  ///< the pinched faces, in ascending order of vertices
};

/// A contour with merged vertices.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
struct Merging {
  Contour<N, Real> contour = {};  ///< the result
  MergeReport<N> report = {};     ///< numbers of changes
};

/// Merges vertices that coincide. Each vertex is replaced by the nearest one before it that stays, if this is within
/// the tolerance (the first of equally near ones). Vertices that stay keep their positions, normals and attributes. So
/// no vertex moves by more than the tolerance. Simplices that then repeat a vertex are dropped, also simplices of zero
/// content if no gap opens, and vertices without simplices. The others keep their order and orientation.
///
/// The result has no gaps that the contour has not: each (N-2)-face lies in an even number of simplices, if it did, and
/// the orientations of these cancel. Two sheets at the same place stay, one on the other, as two simplices with the
/// same vertices. A closed manifold may become pinched: `MergeReport` has all places. The contour of an image has
/// vertices that coincide where samples equal the isovalue.
///
/// Errors: InvalidArgument (tolerance; a vertex number out of range, a coordinate that is not finite, attributes of
/// another number), UnsupportedData (a wrapped contour, tegl/periodic.hpp), Cancelled. O(#S + #V) time if few simplices
/// are flat. The result does not depend on the number of threads. Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Merging<N, Real> merge_vertices(const Contour<N, Real>& contour, const MergeOptions& options = {});

}  // namespace tegl
