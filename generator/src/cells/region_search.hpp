// SPDX-License-Identifier: BSD-3-Clause
//
// Divides the regions of 3D shapes, which close 4D contours, into tetrahedra that do not overlap.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cells/region_volumes.hpp"

namespace tegl::gen {

/// The high part of a shape, divided.
struct CapDivision {
  /// The first vertex sees the others as the boundary's triangles are seen from inside.
  std::vector<RegionTetrahedron> tetrahedra;
  /// The corners (bit v) and points (bit kFirstEdge + e) whose mean a vertex from kFirstOwn on is.
  std::vector<std::uint32_t> own;
  /// A vertex from kFirstOwn on that is not a mean, but lies between a corner and the mean, so near to the corner that
  /// it sees all of these triangles.
  struct Near {
    std::uint8_t own, corner;
    RegionTriangles seen;
  };
  std::vector<Near> near;
};

/// Whether volumes below a boundary's triangles are positive.
[[nodiscard]] bool is_outwards(const RegionVolumes& volumes, const RegionTriangles& boundary);
/// The volumes with the barycentres of a boundary's polygons.
[[nodiscard]] RegionVolumes volumes_with(const tables::CellTable& shape, const RegionTriangles& boundary);

/// Divides one region with a sorted boundary. No value if no division is found that is proved. The result depends only
/// on the boundary.
[[nodiscard]] std::optional<CapDivision> divide_region(const tables::CellTable& shape, const RegionTriangles& boundary);

}  // namespace tegl::gen
