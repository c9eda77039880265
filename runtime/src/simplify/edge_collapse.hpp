// SPDX-License-Identifier: BSD-3-Clause
//
// A contour that shrinks by contracting edges: where the ends may go, whether the simplices around bear it, and what
// vertices carry along. The order of contractions is for others (simplify_orders.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "simplify/collapsible_complex.hpp"
#include "simplify/quadric.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

/// Where the ends of an edge meet.
template <int N>
struct MeetingPlace {
  PointN<N> at{};      ///< in the contour's coordinates, as its number type can show them
  double share = 0.5;  ///< of what the second end carries
  double cost = 0;     ///< the sum of squared distances from planes
};

/// What a shrinking contour starts from.
template <int N>
struct ShrinkStart {
  std::span<const std::array<Index, N>> simplices;
  std::vector<PointN<N>> points;  ///< #V, in the contour's coordinates
  std::vector<double>
      tolerance;  ///< #V: how large the root mean square of the distances from planes may be; 0: it stays
  std::array<double, N> scale{};
  std::size_t carried_width = 0;  ///< numbers that each vertex carries
  std::vector<double> carried;    ///< #V x carried_width
  bool border_fixed = true;
  bool single_precision = false;
  Progress progress = {};  ///< of getting ready
};

template <int N>
class Shrinker {
 public:
  static constexpr std::uint32_t kBorderBit = std::uint32_t{1} << 31;
  using Edge = typename ShrinkingComplex<N>::Edge;

  /// Errors: those of ShrinkingComplex, Cancelled.
  explicit Shrinker(ShrinkStart<N> start);

  [[nodiscard]] ShrinkingComplex<N>& complex() noexcept { return complex_; }
  /// v stays in the hyperplane of this number, below 31.
  void bind(Index v, unsigned hyperplane) { bound_[v] |= std::uint32_t{1} << hyperplane; }
  [[nodiscard]] const std::vector<PointN<N>>& points() const noexcept { return points_; }
  [[nodiscard]] const std::vector<PointN<N>>& scaled() const noexcept { return scaled_; }
  [[nodiscard]] const Quadric<N>& quadric(Index v) const { return quadrics_[v]; }
  [[nodiscard]] std::span<const double> carried(Index v) const {
    return std::span(carried_).subspan(v * carried_width_, carried_width_);
  }
  /// The vertex that v has become part of; itself while it is there.
  [[nodiscard]] Index survivor(Index v);
  /// Grows with everything that changes at a vertex.
  [[nodiscard]] std::uint32_t version(Index v) const { return version_[v]; }

  /// Where the ends of the edge u v meet best; nothing where borders and hyperplanes forbid it.
  [[nodiscard]] std::optional<MeetingPlace<N>> meeting_place(Index u, Index v) const;
  /// The same ends at a place that the caller has chosen.
  [[nodiscard]] MeetingPlace<N> place_at(Index u, Index v, const PointN<N>& at, double share) const;
  /// Whether v may move to where u is, for all that borders and hyperplanes say.
  [[nodiscard]] bool may_move_to(Index v, Index u) const;
  /// Where all vertices of a simplex may meet, or nothing; if that is where one of them has to stay, that is `anchor`.
  struct CommonPlace {
    PointN<N> at{};
    std::optional<Index> anchor;
  };
  [[nodiscard]] std::optional<CommonPlace> common_place(std::span<const Index> vertices) const;

  /// Contracts u v into u, at `place`, if manifold, shape and tolerance allow it.
  bool try_contract(Index u, Index v, const MeetingPlace<N>& place);
  /// To be told of a contraction that a limit forbids, such as the tolerance: if all else allows it, is_limited() is
  /// true from then on.
  void note_limit(Index u, Index v, const MeetingPlace<N>& place);
  [[nodiscard]] bool is_limited() const noexcept { return limited_; }

  /// Corners of a simplex, scaled.
  [[nodiscard]] CornersN<N> corners(Index s) const;
  /// The sum of the normals around v, weighted by measure; its star is left in `star`.
  PointN<N> mean_normal(Index v, std::vector<Index>& star);

 private:
  void add_quadrics(const Progress& progress);
  void add_border_quadrics(Index s, const CornersN<N>& corners, double weight);
  [[nodiscard]] bool within_tolerance(Index u, Index v, const MeetingPlace<N>& place) const;
  [[nodiscard]] bool keeps_shapes(const Edge& edge, const PointN<N>& scaled_place) const;
  [[nodiscard]] bool bears(Index s, Index moving, const PointN<N>& place, const Edge& edge,
                           std::optional<double>& worst) const;
  [[nodiscard]] double worst_shape(const Edge& edge) const;
  [[nodiscard]] PointN<N> normal_around(const Edge& edge) const;
  [[nodiscard]] PointN<N> to_scaled(const PointN<N>& point) const;
  [[nodiscard]] PointN<N> from_scaled(const PointN<N>& point) const;
  [[nodiscard]] PointN<N> rounded(PointN<N> point) const;
  void blend_carried(Index u, Index v, double share);

  ShrinkingComplex<N> complex_;
  std::vector<PointN<N>> points_;
  std::vector<PointN<N>> scaled_;  ///< relative to the centre, in units of the scale
  PointN<N> centre_{};
  std::array<double, N> scale_{};
  std::vector<Quadric<N>> quadrics_;
  std::vector<std::uint32_t> bound_;
  std::vector<double> tolerance_;
  std::vector<std::uint32_t> version_;
  std::vector<Index> merged_into_;
  std::size_t carried_width_;
  std::vector<double> carried_;
  bool border_fixed_;
  bool single_precision_;
  bool limited_ = false;
  Edge edge_;
};

extern template class Shrinker<2>;
extern template class Shrinker<3>;
extern template class Shrinker<4>;

}  // namespace tegl::detail
