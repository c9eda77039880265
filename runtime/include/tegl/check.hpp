// SPDX-License-Identifier: BSD-3-Clause
//
// Checks whether a simplicial complex is a manifold, by counting its invariants.
#pragma once

#include <cstdint>
#include <span>

#include "tegl/contour.hpp"
#include "tegl/incidence.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// The result of `check`. An oriented manifold without degenerate simplices has 0 in `unused_vertices`,
/// `nonmanifold_simplices`, `bad_links`, `orientation_conflicts`, `degenerate_simplices` and `nonfinite_vertices`; a
/// closed one also in `boundary_simplices`. Simplices that repeat a vertex ("collapsed") are counted only in
/// `simplices` and `degenerate_simplices`.
struct MeshReport {
  int dim = 0;                              ///< dimension d of the simplices (2 for triangles)
  std::uint64_t vertices = 0;               ///< vertices used by at least one simplex that is not collapsed
  std::uint64_t unused_vertices = 0;        ///< vertices of no simplex, or of collapsed simplices only
  std::uint64_t simplices = 0;              ///< number of simplices; one listed twice counts twice, here and in `euler`
  std::uint64_t components = 0;             ///< connected components of the used vertices
  std::int64_t euler = 0;                   ///< Euler characteristic: the alternating sum of the numbers of k-faces
  std::uint64_t boundary_simplices = 0;     ///< (d-1)-faces in exactly one simplex
  std::uint64_t nonmanifold_simplices = 0;  ///< (d-1)-faces in more than two simplices
  std::uint64_t bad_links = 0;              ///< vertices whose link is neither a (d-1)-sphere nor a (d-1)-ball
  std::uint64_t orientation_conflicts = 0;  ///< (d-1)-faces that their two simplices induce the same orientation on
  std::uint64_t degenerate_simplices = 0;   ///< collapsed, of measure zero, or with a non-finite coordinate
  std::uint64_t nonfinite_vertices = 0;     ///< vertices with an infinite or NaN coordinate, used or not
};

/// Counts the invariants of a complex of d-simplices, d = 1, 2, 3, 4. `simplices`: #S x (d+1) vertex numbers, row =
/// simplex. `coordinates`: #V x space_dim, row = vertex, in any unit.
///
/// A link is tested as a whole: no face in more than two of its simplices, no pinched vertex, connected, and the Euler
/// characteristic of a sphere (closed) or a ball. For d = 3 this decides between sphere and disc by the classification
/// of surfaces. For d = 4 the link is shown to be a sphere or ball by a shelling, else by collapsing it
/// (tile::shape_of); a link for which both fail counts as bad, and so does one of 65 535 vertices or more. A simplex
/// has measure zero if one of its heights is at most 1e-14 of its longest edge: differences of coordinates and the
/// orthogonalisation carry a rounding error of a few 1e-16 of that edge, and simplices that are merely thin are thicker
/// by orders of magnitude if coordinates have float precision.
///
/// Errors: InvalidArgument (d, space_dim, array sizes; a vertex number out of range, named with its limit), Cancelled.
/// An empty complex gives zeros. O(S log S) time, O(S + V) memory beside the input, O(V) for each thread. Thread-safe.
[[nodiscard]] MeshReport check(int d, std::span<const Index> simplices, int space_dim,
                               std::span<const double> coordinates, const WorkOptions& work = {});

/// Checks a contour: d = N - 1, space_dim = N; N = 2 to 5. Real: float or double.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] MeshReport check(const Contour<N, Real>& contour, const WorkOptions& work = {});
/// The same with the contour's incidence, which only depends on the vertex numbers. Saves time if N = 4.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] MeshReport check(const Contour<N, Real>& contour, const Incidence<N>& incidence,
                               const WorkOptions& work = {});

}  // namespace tegl
