// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at the points of a complex, by least squares: the linear function that fits the differences to all points
// at the other ends of a point's edges best, weighted by the inverse squares of their distances. Linear functions have
// their exact gradient. At the points of a grid it is the mean of the forward and the backward difference quotients,
// as Normals::differences of images. Points with a missing value are left out.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "complex/cell_groups.hpp"
#include "complex/sorted_edges.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

struct CellSimplices;
struct VertexKeys;

/// What is known beside a complex, for the positions and normals of its contour.
template <int N>
struct Surroundings {
  /// The gradient at a point; empty: by least squares on the complex. Called by several threads.
  std::function<std::array<double, N>(Index)> gradient = {};
  /// Corners of a cell are at the places nearest to each other modulo these; the contour is wrapped.
  std::vector<Period<N>> periods = {};
  /// Numbers of the cells that may be active; null: any.
  const std::vector<Index>* active = nullptr;
  /// The facets at which ExtractOptions::close closes the contour; null: the border of the complex.
  const std::vector<BorderFacet>* border = nullptr;
  /// Receives the keys of the contour's vertices (shared_points.hpp), and the contour may touch itself beside missing
  /// values, as it is part of another one; null: not needed.
  VertexKeys* keys = nullptr;
  /// Receives the active cells in the order of their simplices; null: not needed.
  std::vector<CellSimplices>* simplices = nullptr;
  /// Receives the cells of the caps in the order of their simplices (ComplexCaps::by_facet); null: not needed.
  std::vector<CellSimplices>* caps = nullptr;
};

/// As `extract_with_stats` of a complex with surroundings.
template <class Real, int N>
[[nodiscard]] Extraction<N, Real> extract_in(const Complex<N>& complex, double isovalue, const ExtractOptions& options,
                                             const Surroundings<N>& around);

/// A vector of length 1, or 0 if it is zero or not finite.
template <class Real, std::size_t Size>
[[nodiscard]] std::array<Real, Size> unit_of(const std::array<double, Size>& vector) noexcept {
  double length = 0.0;
  for (const double x : vector) length = std::hypot(length, x);
  std::array<Real, Size> result{};
  if (length > 0.0 && std::isfinite(length))
    for (std::size_t i = 0; i < Size; ++i) result[i] = static_cast<Real>(vector[i] / length);
  return result;
}

template <int N>
class PointGradients {
 public:
  using Gradient = std::array<double, N>;

  /// For the ends of `crossed` and the points `others`. O(P + C + E log e) time for E edges at these points, at most e
  /// at one. Errors: Cancelled.
  PointGradients(const Complex<N>& complex, std::span<const EdgeEnds> crossed, std::span<const Index> others,
                 const WorkOptions& work);
  /// The same points with other gradients. Errors: Cancelled.
  PointGradients(const Complex<N>& complex, std::span<const EdgeEnds> crossed, std::span<const Index> others,
                 const std::function<Gradient(Index)>& gradient, const WorkOptions& work);

  /// The gradient at one of the points; 0 along directions in which there are no neighbours.
  [[nodiscard]] const Gradient& at(Index p) const noexcept { return gradients_[number(p)]; }

  /// As `unit_of`.
  template <class Real>
  [[nodiscard]] static std::array<Real, N> unit(const Gradient& vector) noexcept {
    return unit_of<Real>(vector);
  }

 private:
  /// Sums over the edges at a point: of u u^T, row by row above the diagonal, and of u times the difference quotient,
  /// with u the edge's direction of length 1.
  struct Sums {
    std::array<double, N*(N + 1) / 2> matrix{};
    Gradient vector{};
  };

  [[nodiscard]] bool is_marked(Index p) const noexcept { return (bits_[p >> 6] >> (p & 63u) & 1u) != 0; }
  [[nodiscard]] std::size_t number(Index p) const noexcept {
    const std::uint64_t below = bits_[p >> 6] & ((std::uint64_t{1} << (p & 63u)) - 1);
    return before_[p >> 6] + static_cast<std::size_t>(std::popcount(below));
  }
  [[nodiscard]] static Gradient solve(const Sums& sums) noexcept;
  void mark_points(std::size_t points, std::span<const EdgeEnds> crossed, std::span<const Index> others);

  std::vector<std::uint64_t> bits_;  ///< which points
  std::vector<std::size_t> before_;  ///< points before each word of bits_
  std::vector<Gradient> gradients_;
};

}  // namespace tegl::detail
