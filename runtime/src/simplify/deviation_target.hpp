// SPDX-License-Identifier: BSD-3-Clause
//
// Data of a contour for measurements of distances to it, prepared once for several of them.
#pragma once

#include <cstdint>
#include <utility>

#include "base/progress.hpp"
#include "simplify/boundary_faces.hpp"
#include "simplify/box_tree.hpp"
#include "simplify/facet_neighbours.hpp"
#include "simplify/scaled_simplices.hpp"
#include "simplify/simplex_gradients.hpp"
#include "tegl/deviation.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// A contour that distances are measured to. `contour` must outlive it.
template <int N>
struct DeviationTarget {
  explicit DeviationTarget(const ScaledSimplices<N>& to, unsigned threads = 1, const Progress& progress = {})
      : DeviationTarget(to, {to.simplices, to.points.size(), threads, part_of(progress, 0.0, 0.5)}, threads,
                        part_of(progress, 0.5, 1.0)) {}
  /// `next`: the neighbours of the simplices of `to`.
  DeviationTarget(const ScaledSimplices<N>& to, FacetNeighbours<N> next, unsigned threads, const Progress& progress)
      : contour(to),
        neighbours(std::move(next)),
        open(to, neighbours, threads, progress),
        tree(to.corners, threads),
        gradients(to.corners, threads, {}) {}
  DeviationTarget(const DeviationTarget&) = delete;
  DeviationTarget& operator=(const DeviationTarget&) = delete;

  const ScaledSimplices<N>& contour;
  FacetNeighbours<N> neighbours;
  BoundaryFaces<N> open;
  BoxTree<N> tree;
  SimplexGradients<N> gradients;
};

/// Results besides the bound of the whole contour.
struct DeviationValues {
  bool of_from = true, of_to = true;  ///< bounds by simplex
  /// Raised by the number of comparisons of parts of simplices with the simplices near them, which take most of the
  /// time of measurements that take long. It does not depend on the number of threads.
  std::uint64_t* comparisons = nullptr;
};

/// As `deviation`, with the scale of both contours, neither of which may be empty. `enough`: as in DeviationOptions.
/// Bounds by simplex that are not in `values` are empty.
template <int N>
Deviation deviation_to(const ScaledSimplices<N>& from, const DeviationTarget<N>& to, double enough,
                       const DeviationValues& values, const WorkOptions& work);

}  // namespace tegl::detail
