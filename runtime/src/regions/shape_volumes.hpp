// SPDX-License-Identifier: BSD-3-Clause
//
// Signs of the volumes of tetrahedra in a 3D shape, for all positions of the contour's points on their edges.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tegl/generated/cells.hpp"

namespace tegl::detail {

/// Vertices in a 3D shape: its corners, the points on its edges, the barycentres of the contour's polygons in the
/// shape, and vertices inside its regions.
struct RegionVertices {
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
    centres_[centre - RegionVertices::kFirstCentre] = std::move(points);
  }
  [[nodiscard]] Place place(unsigned vertex) const noexcept;
  [[nodiscard]] std::array<Place, 4> places(const std::array<std::uint8_t, 4>& t) const noexcept {
    return {place(t[0]), place(t[1]), place(t[2]), place(t[3])};
  }

 private:
  const tables::CellTable& table_;
  std::array<double, 12> alphas_;
  std::array<std::vector<std::uint8_t>, RegionVertices::kFirstOwn - RegionVertices::kFirstCentre> centres_;
};

/// The signs that a volume can have.
struct VolumeSigns {
  bool positive = false, negative = false;
  [[nodiscard]] bool is_positive() const noexcept { return positive && !negative; }
};

/// A volume is linear in the position of each point, also if a point belongs to a barycentre: then the terms with that
/// point twice are zero. So its sign is known if all its terms have one sign with the points at the ends of edges.
class ShapeVolumes {
 public:
  using Tetrahedron = std::array<std::uint8_t, 4>;

  explicit ShapeVolumes(tables::CellShape shape);

  [[nodiscard]] const tables::CellTable& table() const noexcept { return table_; }
  /// Sets the edges (kFirstEdge + e) whose points' mean a barycentre is.
  void set_centre(unsigned centre, std::vector<std::uint8_t> points) {
    generic_.set_centre(centre, points);
    points_[centre] = std::move(points);
  }
  [[nodiscard]] VolumeSigns signs(const Tetrahedron& t) const noexcept;
  /// One position of the points.
  [[nodiscard]] const ShapePlaces& generic() const noexcept { return generic_; }

 private:
  void add_signs(const Tetrahedron& points, VolumeSigns& to) const noexcept;

  const tables::CellTable& table_;
  ShapePlaces generic_;
  const tables::PlaneSides<std::uint8_t>* planes_;                           ///< ShapeTable::planes_of_three
  std::array<std::vector<std::uint8_t>, RegionVertices::kFirstOwn> points_;  ///< corners and edges, by vertex
  std::array<std::array<std::uint8_t, 2>, RegionVertices::kFirstCentre> ends_{};
};

}  // namespace tegl::detail
