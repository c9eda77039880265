// SPDX-License-Identifier: BSD-3-Clause
//
// An index of a contour by time, for cuts at any time without looking at the whole contour: to wind a 4D contour
// forwards and backwards as one would a film, but a continuous one.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/hyperplane.hpp"

namespace tegl {

/// Cuts of an N-dimensional contour (N = 3, 4) by parallel hyperplanes, those of constant time if nothing else is said.
///
/// Each cut is what `slice` makes, bit by bit, in time that depends on the cut's size and not on the contour's: an
/// interval tree holds the range of heights of every simplex. O(s log s) time to build for s simplices, 16 bytes for
/// each and up to 12 for each node of the tree (mostly far fewer nodes than simplices; `memory` says how much in all).
///
/// The contour is not copied: it has to outlive the scrubber, unchanged. Cuts may be asked for by several threads at a
/// time.
///
/// Based on: H. Edelsbrunner, Dynamic data structures for orthogonal intersection queries, 1980 (interval trees);
/// P. Cignoni et al., Speeding up isosurface extraction using interval trees, 1997; M. Liversage, thesis, 1994,
/// 10.2.11.
template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 4>
class Scrubber {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;  ///< components by axis

  /// `normal`: of the hyperplanes. Throws InvalidArgument if it is 0 or not finite, or a coordinate of the contour is
  /// not finite, a vertex number out of range, or attributes or normals are of another number; Cancelled.
  explicit Scrubber(const Contour<N, Real>& contour, const Vector& normal = Vector::Unit(N - 1),
                    const WorkOptions& options = {});
  explicit Scrubber(const Contour<N, Real>&&, const Vector& = Vector::Unit(N - 1), const WorkOptions& = {}) = delete;

  /// slice(contour, Hyperplane<N>{normal, offset}). O(c + log s) for c simplices that touch the hyperplane, of which
  /// there are few more than the cut has; where vertices lie on it, O(c log c).
  /// Throws InvalidArgument if the offset is not finite.
  [[nodiscard]] Contour<N - 1, Real> cut(double offset) const;

  /// The simplices that have vertices at or on both sides of the hyperplane, ascending. O(c + log s).
  [[nodiscard]] std::vector<Index> touching(double offset) const;

  /// The least and the largest offset of hyperplanes that meet the contour; {0, 0} for an empty one.
  [[nodiscard]] std::pair<double, double> range() const noexcept { return range_; }

  /// Bytes that the index takes, beside the contour.
  [[nodiscard]] std::size_t memory() const noexcept;

 private:
  /// A simplex at a node, by one end of its range.
  struct Entry {
    std::uint32_t end;
    Index simplex;
  };
  struct Node {
    std::uint32_t middle;  ///< that all ranges of the node contain
    std::uint64_t first;   ///< entry
  };

  [[nodiscard]] std::uint32_t place(double height) const noexcept;
  void visit(std::uint32_t middle, std::uint32_t at, std::vector<Index>& found) const;

  const Contour<N, Real>* contour_;
  Vector normal_;
  double lowest_ = 0.0;
  std::pair<double, double> range_{0.0, 0.0};
  std::vector<Node> nodes_;      ///< by middle, and one more for the end
  std::vector<Entry> by_least_;  ///< by node, ascending from there
  std::vector<Entry> by_most_;   ///< by node, descending from there
};

}  // namespace tegl
