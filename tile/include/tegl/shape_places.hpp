// SPDX-License-Identifier: BSD-3-Clause
//
// Places of vertices in a 3D shape of mesh cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tegl/cell_contract.hpp"

namespace tegl::detail {

/// Vertices in a 3D shape: its corners, the points on its edges, the barycentres of the contour's polygons in the
/// shape, and vertices inside its regions.
struct ShapeVertices {
  static constexpr unsigned kFirstEdge = 8, kFirstCentre = kFirstEdge + 12, kFirstOwn = kFirstCentre + 8, kEnd = 40;
};

/// Six times the volume of a tetrahedron.
template <class Number>
Number six_volumes(const std::array<std::array<Number, 3>, 4>& p) noexcept {
  std::array<std::array<Number, 3>, 3> d;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) d[i][k] = p[i + 1][k] - p[0][k];
  return d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) - d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
         d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
}

/// The edge of a shape between two corners.
[[nodiscard]] std::uint8_t edge_between(const tables::CellTable& table, unsigned p, unsigned q) noexcept;

/// Where vertices are in the shape of the table.
class ShapePlaces {
 public:
  using Place = std::array<double, 3>;

  /// The points are at places of their own on all edges.
  explicit ShapePlaces(const tables::CellTable& table);

  /// Sets where the point on an edge is, from the edge's first end (0) to the other (1).
  void set_alpha(unsigned edge, double alpha) noexcept { alphas_[edge] = alpha; }
  /// Sets the edges (kFirstEdge + e) whose points' mean a barycentre is.
  void set_centre(unsigned centre, std::vector<std::uint8_t> points) {
    centres_[centre - ShapeVertices::kFirstCentre] = std::move(points);
  }
  [[nodiscard]] Place place(unsigned vertex) const noexcept;
  [[nodiscard]] std::array<Place, 4> places(const std::array<std::uint8_t, 4>& t) const noexcept {
    return {place(t[0]), place(t[1]), place(t[2]), place(t[3])};
  }

 private:
  const tables::CellTable& table_;
  std::array<double, 12> alphas_;
  std::array<std::vector<std::uint8_t>, ShapeVertices::kFirstOwn - ShapeVertices::kFirstCentre> centres_;
};

}  // namespace tegl::detail
