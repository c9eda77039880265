// SPDX-License-Identifier: BSD-3-Clause
//
// A contour that shrinks by edge collapse: placement of the merged vertex, tolerances, and attributes of vertices.
// Tests of the simplices around it are in loaded_edge.hpp. The order of contractions is in simplify_orders.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "intersect/moving_simplices.hpp"
#include "mesh/simplex_shapes.hpp"
#include "simplify/collapsible_complex.hpp"
#include "simplify/loaded_edge.hpp"
#include "simplify/quadric.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Position of the vertex that replaces the ends of an edge.
template <int N>
struct CollapseTarget {
  PointN<N> at{};      ///< in the contour's coordinates, rounded to its number type
  double share = 0.5;  ///< weight of the second end's attributes
  double cost = 0;     ///< sum of squared distances from the planes
};

/// Input of an EdgeCollapse.
template <int N>
struct CollapseInput {
  std::span<const std::array<Index, N>> simplices;
  std::vector<PointN<N>> points;  ///< #V, in the contour's coordinates
  std::vector<double> tolerance;  ///< #V: largest root mean square distance from the planes; 0: the vertex is fixed
  std::array<double, N> scale{};
  std::size_t carried_width = 0;  ///< attribute values per vertex
  std::vector<double> carried;    ///< #V x carried_width
  bool border_fixed = true;
  bool single_precision = false;
  bool keep_embedded = false;  ///< refuses contractions that make simplices intersect
  std::shared_ptr<const FacetNeighbours<N>> neighbours = nullptr;  ///< of the simplices, if they are known
  unsigned threads = 1;                                            ///< of the constructor
  Progress progress = {};                                          ///< of the constructor
};

template <int N>
class EdgeCollapse {
 public:
  static constexpr std::uint32_t kBorderBit = std::uint32_t{1} << 31;
  using Edge = typename CollapsibleComplex<N>::Edge;

  /// Errors: those of CollapsibleComplex, Cancelled.
  explicit EdgeCollapse(CollapseInput<N> input);

  [[nodiscard]] CollapsibleComplex<N>& complex() noexcept { return complex_; }
  /// Binds v to the hyperplane of this number, below 31.
  void bind(Index v, unsigned hyperplane) { bound_[v] |= std::uint32_t{1} << hyperplane; }
  [[nodiscard]] const std::vector<PointN<N>>& points() const noexcept { return points_; }
  [[nodiscard]] const Buffer<PointN<N>>& scaled() const noexcept { return scaled_; }
  [[nodiscard]] const Quadric<N>& quadric(Index v) const { return quadrics_[v]; }
  [[nodiscard]] std::span<const double> carried(Index v) const {
    return std::span(carried_).subspan(v * carried_width_, carried_width_);
  }
  /// The vertex that v was merged into; v itself if it still exists.
  [[nodiscard]] Index survivor(Index v);
  /// Increases with every contraction at the vertex.
  [[nodiscard]] std::uint32_t version(Index v) const { return version_[v]; }

  /// The best target for contracting the edge u v; empty if borders and hyperplanes forbid it.
  [[nodiscard]] std::optional<CollapseTarget<N>> best_target(Index u, Index v) const;
  /// Edges of one vertex, and the costs of their best targets.
  struct EdgeCost {
    Index other;
    double cost;
    double square;  ///< of the length
  };
  /// The edges of u to these vertices, without those that borders and hyperplanes keep. The edges are between the
  /// vertices with the smaller and with the larger number.
  void costs_around(Index u, std::span<const Index> others, std::vector<EdgeCost>& result) const;
  /// The target of u and v at a position chosen by the caller.
  [[nodiscard]] CollapseTarget<N> target_at(Index u, Index v, const PointN<N>& at, double share) const;
  /// Whether borders and hyperplanes allow moving v to the place of u.
  [[nodiscard]] bool may_move_to(Index v, Index u) const;
  /// A position at which all vertices of a simplex may be merged. `anchor`: the vertex that has to stay there, if any.
  struct CommonTarget {
    PointN<N> at{};
    std::optional<Index> anchor;
  };
  [[nodiscard]] std::optional<CommonTarget> common_target(std::span<const Index> vertices) const;

  /// Requests the corners of the simplices at u and v, which are read to contract them.
  void request_corners(Index u, Index v) const;
  /// Requests what costs_around reads of a vertex.
  void request_cost(Index v) const;
  /// Contracts u v into u, at `target`, if manifold, shape, tolerance and (if requested) the other simplices allow it.
  /// Threads may call it at the same time, each with its own `loaded`, for edges in different ContourParts, unless
  /// intersections are refused. `loaded` must not hold an edge from before the last contraction by another object.
  bool try_contract(Index u, Index v, const CollapseTarget<N>& target, LoadedEdge<N>& loaded);
  /// Call it for a contraction that a limit forbids, such as the tolerance. If everything else allows the contraction,
  /// is_limited() is true from then on. Threads: as try_contract.
  void note_limit(Index u, Index v, const CollapseTarget<N>& target, LoadedEdge<N>& loaded);
  [[nodiscard]] bool is_limited() const noexcept { return limited_; }
  /// Whether contractions that would make simplices intersect are refused.
  [[nodiscard]] bool keeps_embedded() const noexcept { return embedded_ != nullptr; }

  /// Scaled corners of a simplex.
  [[nodiscard]] CornersN<N> corners(Index s) const;
  /// Sum of the normals around v, weighted by measure. Stores the star of v in `star`.
  PointN<N> mean_normal(Index v, std::vector<Index>& star);

 private:
  void add_quadrics(const Progress& progress);
  void add_border_quadrics(Index s, const CornersN<N>& corners, double weight);
  [[nodiscard]] bool is_possible(const CollapseTarget<N>& target, LoadedEdge<N>& loaded);
  [[nodiscard]] static typename MovingSimplices<N>::Contraction contraction(const Edge& edge, const PointN<N>& at);
  [[nodiscard]] bool within_tolerance(Index u, Index v, const CollapseTarget<N>& target) const;
  [[nodiscard]] PointN<N> to_scaled(const PointN<N>& point) const;
  [[nodiscard]] PointN<N> from_scaled(const PointN<N>& point) const;
  [[nodiscard]] PointN<N> rounded(PointN<N> point) const;
  void blend_carried(Index u, Index v, double share);

  CollapsibleComplex<N> complex_;
  std::vector<PointN<N>> points_;
  Buffer<PointN<N>> scaled_;  ///< relative to the centre, in units of the scale
  PointN<N> centre_{};
  std::array<double, N> scale_{};
  Buffer<Quadric<N>> quadrics_;
  std::vector<std::uint32_t> bound_;
  std::vector<double> tolerance_;
  std::vector<std::uint32_t> version_;
  std::vector<Index> merged_into_;
  std::size_t carried_width_;
  std::vector<double> carried_;
  bool border_fixed_;
  bool single_precision_;
  bool limited_ = false;
  std::unique_ptr<MovingSimplices<N>> embedded_;  ///< in the contour's coordinates; null if intersections are allowed
};

extern template class EdgeCollapse<2>;
extern template class EdgeCollapse<3>;
extern template class EdgeCollapse<4>;

}  // namespace tegl::detail
