// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces between polygons on a cube's boundary that do not intersect themselves, wherever the contour meets the
// cube's edges: a tunnel between two polygons, a sphere with a hole for each of three or four.
//
// Theory: radial filling. The polygons bound a region of the cube's boundary. In coordinates (s, r), s on the boundary
// and r the distance from the cube's centre, the surface is a graph over this region. So it is embedded if its
// projection from the centre is, whatever the distances of its own vertices are.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "cubes/cube_frame.hpp"

namespace tegl::gen {

/// A surface in the cube. The masks of its own vertices hold corners: they lie on rays (is_on_ray).
struct CubeSurface {
  CubeTriangles triangles;
  std::vector<std::uint32_t> masks;
};

/// Makes radial surfaces. Those of a signature and of its complement have the same triangles, reversed.
class RadialFilling {
 public:
  /// `frame` must outlive this object.
  explicit RadialFilling(const CubeFrame& frame);

  /// The surface with shortest inner edges, of three own vertices or, if there is none, of four; for a single polygon,
  /// of one. `is_high`: sign of the region that it is parallel to. Nothing if no such surface is proved to be embedded.
  [[nodiscard]] std::optional<CubeSurface> fill(unsigned signature, const std::vector<CubePolygon>& polygons,
                                                bool is_high);

 private:
  /// A region of the boundary: its corners and the polygons around it, which have it on their left seen from outside.
  struct Region {
    unsigned corners = 0;
    std::vector<CubePolygon> polygons;
    friend auto operator<=>(const Region&, const Region&) = default;
  };
  /// An isometry of the cube.
  struct Isometry {
    std::array<std::uint8_t, 8> corner;
    std::array<std::uint8_t, CubeFrame::kEdges> edge;
    bool reverses;
  };

  [[nodiscard]] Region region_of(unsigned signature, const std::vector<CubePolygon>& polygons, bool is_high) const;
  [[nodiscard]] static Region image_of(const Region& region, const Isometry& map);
  [[nodiscard]] std::vector<std::uint32_t> masks_in(const Region& region) const;
  [[nodiscard]] bool always_contains(const Region& region, unsigned corners) const;
  [[nodiscard]] std::optional<CubeSurface> search(const Region& region) const;

  const CubeFrame& frame_;
  std::vector<Isometry> isometries_;
  std::map<Region, std::optional<CubeSurface>> known_;  ///< by representative
};

}  // namespace tegl::gen
