// SPDX-License-Identifier: BSD-3-Clause
//
// An edge that may be contracted, with the shapes of the simplices around it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "simplify/collapsible_complex.hpp"
#include "simplify/edge_lanes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Use one per thread and complex: it holds memory of the complex.
template <int N>
class LoadedEdge {
 public:
  using Edge = typename CollapsibleComplex<N>::Edge;

  /// Loads the edge, unless it is loaded already. `scaled`: the places of the vertices. Both must not change until the
  /// edge is dropped.
  void load(CollapsibleComplex<N>& complex, const Buffer<PointN<N>>& scaled, Index u, Index v);
  void drop() { complex_ = nullptr; }
  [[nodiscard]] const Edge& edge() const noexcept { return edge_; }

  /// Whether the topology and the shapes allow the contraction to this place; the slowest test last.
  [[nodiscard]] bool is_contractible(const PointN<N>& place);
  /// Contracts it. Precondition: is_contractible.
  void contract();

 private:
  [[nodiscard]] bool keeps_shapes(const PointN<N>& place);
  [[nodiscard]] bool keeps_shape(std::size_t number, const ShapeLanes<N>& after);
  /// Simplices around the edge before the contraction, kEdgeLanes in each group: only_u, only_v, both.
  const SimplexLanes<N>& around(std::size_t group);
  [[nodiscard]] std::size_t size_around() const {
    return edge_.only_u.size() + edge_.only_v.size() + edge_.both.size();
  }
  [[nodiscard]] double worst_shape();
  [[nodiscard]] PointN<N> normal_around();

  CollapsibleComplex<N>* complex_ = nullptr;  ///< null: no edge is loaded
  const PointN<N>* scaled_ = nullptr;
  Edge edge_;
  std::optional<bool> keeps_topology_;  ///< once known
  std::vector<SimplexLanes<N>> around_;
  std::vector<std::uint8_t> is_measured_;  ///< by group: whether around_ is set
  std::optional<double> worst_shape_;
  typename CollapsibleComplex<N>::Scratch scratch_;
};

extern template class LoadedEdge<2>;
extern template class LoadedEdge<3>;
extern template class LoadedEdge<4>;

}  // namespace tegl::detail
