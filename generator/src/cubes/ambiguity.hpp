// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles that depend on the data beyond their signature, and the pairs of diagonal edges of a cube that decide whether
// regions are joined inside it.
#pragma once

#include <array>
#include <vector>

#include "cubes/resolved_cube.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

/// Whether a cube has an ambiguous square or may have several facets. By signature.
[[nodiscard]] std::vector<bool> ambiguous_cubes(const ResolvedCube& cube);

/// Whether a tesseract has an ambiguous square, a cube with several polygons, or a Sigma that is neither empty nor one
/// sphere. By signature. Computed from the tile's edges, squares and cubes, without tables.
[[nodiscard]] std::vector<bool> ambiguous_tesseracts();

/// By entry of the resolved cube.
[[nodiscard]] std::vector<tables::CubeJoin> make_cube_joins(const ResolvedCube& cube);

}  // namespace tegl::gen
