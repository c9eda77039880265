// SPDX-License-Identifier: BSD-3-Clause
//
// An index of a contour by time: cuts at any time without a pass over the whole contour, for instance for a time
// slider.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/vector.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Cuts of an N-dimensional contour (N = 3, 4, 5) by parallel hyperplanes; by default at constant time.
///
/// Each cut equals the result of `slice` bit by bit, in time that depends on the size of the cut and not of the
/// contour: an interval tree holds the height range of every simplex. Building takes O(s log s) time for s simplices.
/// Memory: 16 bytes per simplex and up to 12 for each node of the tree (usually far fewer nodes than simplices; see
/// `memory`).
///
/// The contour is not copied: it must outlive the scrubber, unchanged. Thread-safe: several threads may cut at the same
/// time.
///
/// Based on: H. Edelsbrunner, Dynamic data structures for orthogonal intersection queries, 1980 (interval trees);
/// P. Cignoni et al., Speeding up isosurface extraction using interval trees, 1997; M. Liversage, thesis, 1994,
/// 10.2.11.
template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5>
class Scrubber {
 public:
  /// All cuts are parallel to `hyperplane`: they have its normal, and `cut` takes their offset. Throws InvalidArgument
  /// if the normal is 0 or not finite, the offset or a coordinate of the contour is not finite, a vertex number is out
  /// of range, or attributes or normals are of another number; Cancelled.
  explicit Scrubber(const Contour<N, Real>& contour, const Hyperplane<N>& hyperplane = {},
                    const WorkOptions& work = {});
  explicit Scrubber(const Contour<N, Real>&&, const Hyperplane<N>& = {}, const WorkOptions& = {}) = delete;

  /// Returns slice(contour, {hyperplane.normal, offset}). O(c + log s) for c simplices that touch the hyperplane, few
  /// more than the cut has; O(c log c) if vertices lie on it. Throws InvalidArgument if the offset is not finite.
  [[nodiscard]] Contour<N - 1, Real> cut(double offset) const;

  /// The simplices with vertices on the hyperplane or on both sides of it, in ascending order. O(c + log s).
  [[nodiscard]] std::vector<Index> touching(double offset) const;

  /// Minimum and maximum offset of the hyperplanes that meet the contour; {0, 0} for an empty contour.
  [[nodiscard]] std::pair<double, double> range() const noexcept { return range_; }

  /// Size of the index in bytes, without the contour.
  [[nodiscard]] std::size_t memory() const noexcept;

 private:
  /// A simplex of a node, with one end of its range.
  struct Entry {
    std::uint32_t end;
    Index simplex;
  };
  struct Node {
    std::uint32_t middle;  ///< contained in all ranges of the node
    std::uint64_t first;   ///< index of the node's first entry
  };

  [[nodiscard]] std::uint32_t place(double height) const noexcept;
  void visit(std::uint32_t middle, std::uint32_t at, std::vector<Index>& found) const;

  const Contour<N, Real>* contour_;
  Vector<N> normal_;
  double lowest_ = 0.0;
  std::pair<double, double> range_{0.0, 0.0};
  std::vector<Node> nodes_;      ///< by `middle`, plus a sentinel
  std::vector<Entry> by_least_;  ///< by node, in ascending order of the lower ends
  std::vector<Entry> by_most_;   ///< by node, in descending order of the upper ends
};

}  // namespace tegl
