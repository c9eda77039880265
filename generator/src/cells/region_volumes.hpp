// SPDX-License-Identifier: BSD-3-Clause
//
// Signs of the volumes of tetrahedra in a 3D shape, for all positions of the contour's points on their edges.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "tegl/region_boundary.hpp"

namespace tegl::gen {

using detail::RegionTetrahedron;
using detail::RegionTriangle;
using detail::RegionTriangles;
using detail::ShapeVertices;

/// The signs that a volume can have.
struct VolumeSigns {
  bool positive = false, negative = false;
  [[nodiscard]] bool is_positive() const noexcept { return positive && !negative; }
};

/// A volume is linear in the position of each point, also if a point belongs to a barycentre: then the terms with that
/// point twice are zero. So it has its minimum and maximum where all points are at ends of their edges.
class RegionVolumes {
 public:
  /// `shape`: a 3D shape with its corners and edges; it must outlive the object.
  explicit RegionVolumes(const tables::CellTable& shape);

  [[nodiscard]] const tables::CellTable& table() const noexcept { return table_; }
  /// Sets the edges (kFirstEdge + e) whose points' mean a barycentre is.
  void set_centre(unsigned centre, std::vector<std::uint8_t> points) {
    generic_.set_centre(centre, points);
    points_[centre] = std::move(points);
  }
  /// The signs of all its terms: a volume with barycentres is a sum of volumes without. Fast; more than the volume's
  /// own signs if terms of both signs balance.
  [[nodiscard]] VolumeSigns signs(const RegionTetrahedron& t) const noexcept;
  /// The signs of the volume itself, exactly: it is computed with all points at ends of edges, in all ways.
  [[nodiscard]] VolumeSigns exact_signs(const RegionTetrahedron& t) const noexcept;
  /// One position of the points.
  [[nodiscard]] const detail::ShapePlaces& generic() const noexcept { return generic_; }

 private:
  void add_signs(const RegionTetrahedron& points, VolumeSigns& to) const noexcept;

  const tables::CellTable& table_;
  detail::ShapePlaces generic_;
  std::array<std::int8_t, 4096> corner_signs_{};                            ///< by four corners
  std::array<std::vector<std::uint8_t>, ShapeVertices::kFirstOwn> points_;  ///< corners and edges, by vertex
  std::array<std::array<std::uint8_t, 2>, ShapeVertices::kFirstCentre> ends_{};
};

}  // namespace tegl::gen
