// SPDX-License-Identifier: BSD-3-Clause
//
// Incidence of a contour's simplices: which simplices are around a vertex, and which simplex is across a face. Computed
// once, it serves several operations on the same contour.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>

#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl {

namespace detail {
template <int N>
struct IncidenceData;
}  // namespace detail

/// In place of a simplex across a face: there is none, the face is in the boundary.
inline constexpr Index kNoSimplex = std::numeric_limits<Index>::max();
/// In place of a simplex across a face: the face is in more than two simplices.
inline constexpr Index kSeveralSimplices = kNoSimplex - 1;

/// The incidence of the simplices of one contour in N = 2 to 5 dimensions, only from its vertex numbers. Immutable;
/// copies share their memory. `check`, `components`, `measure`, `track` and `outline` accept it after the contour and
/// then give the same result in less time. They throw InvalidArgument if the contour has other simplices than the one
/// that it was made of. The coordinates, normals and attributes of the contour may differ.
///
///     const tegl::Incidence<4> incidence(contour);
///     const auto report = tegl::check(contour, incidence);
///     const auto measures = tegl::measure(contour, incidence);
///
/// Simplices that repeat a vertex are left out: they are around no vertex, and across no face.
template <int N>
requires DimensionBetween<N, 2, 5>
class Incidence {
 public:
  /// Errors: InvalidArgument (a vertex number out of range); TooLarge; Cancelled. O(#S log s) time for s simplices
  /// around a vertex; memory of 8 N bytes per simplex and 20 per vertex. The result does not depend on the number of
  /// threads.
  template <Coordinate Real>
  explicit Incidence(const Contour<N, Real>& contour, const WorkOptions& work = {});

  [[nodiscard]] std::size_t vertex_count() const noexcept;   ///< of the contour
  [[nodiscard]] std::size_t simplex_count() const noexcept;  ///< of the contour
  /// The simplices around a vertex, ascending.
  [[nodiscard]] std::span<const Index> around(Index vertex) const noexcept;
  /// By position i in a simplex: the other simplex with the face opposite to its vertex i; kNoSimplex or
  /// kSeveralSimplices if there is not exactly one.
  [[nodiscard]] const std::array<Index, N>& across(Index simplex) const noexcept;
  /// Whether it was made of a contour with these simplices and this number of vertices. O(#S).
  template <Coordinate Real>
  [[nodiscard]] bool fits(const Contour<N, Real>& contour) const noexcept;

  /// For the library.
  [[nodiscard]] const detail::IncidenceData<N>& data() const noexcept { return *data_; }

 private:
  std::shared_ptr<const detail::IncidenceData<N>> data_;
};

}  // namespace tegl
