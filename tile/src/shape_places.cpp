// SPDX-License-Identifier: BSD-3-Clause
//
// Places of corners, points on edges, and barycentres.
#include "tegl/shape_places.hpp"

namespace tegl::detail {

std::uint8_t edge_between(const tables::CellTable& table, unsigned p, unsigned q) noexcept {
  std::uint8_t e = 0;
  while ((1u << table.edges[2 * e] | 1u << table.edges[2 * e + 1]) != (1u << p | 1u << q)) ++e;
  return e;
}

ShapePlaces::ShapePlaces(const tables::CellTable& table) : table_(table) {
  for (std::size_t e = 0; e < alphas_.size(); ++e) alphas_[e] = 0.4 + 0.02 * static_cast<double>(e);
}

ShapePlaces::Place ShapePlaces::place(unsigned vertex) const noexcept {
  Place place{};
  const auto add = [&](unsigned corner, double weight) {
    for (std::size_t a = 0; a < 3; ++a) place[a] += weight * table_.corners[3 * corner + a];
  };
  const auto add_edge = [&](unsigned e, double weight) {
    add(table_.edges[2 * e], weight * (1 - alphas_[e]));
    add(table_.edges[2 * e + 1], weight * alphas_[e]);
  };
  if (vertex < ShapeVertices::kFirstEdge) {
    add(vertex, 1.0);
  } else if (vertex < ShapeVertices::kFirstCentre) {
    add_edge(vertex - ShapeVertices::kFirstEdge, 1.0);
  } else {
    const auto& points = centres_[vertex - ShapeVertices::kFirstCentre];
    for (const std::uint8_t point : points)
      add_edge(point - ShapeVertices::kFirstEdge, 1.0 / static_cast<double>(points.size()));
  }
  return place;
}

}  // namespace tegl::detail
