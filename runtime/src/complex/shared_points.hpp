// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of the barycentres in 3-faces of 4D cells, which the cells on both sides of a face share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "complex/crossings.hpp"

namespace tegl::detail {

/// A barycentre by the vertices of its polygon: ascending numbers, unused entries at the end kNoPoint. The polygons of
/// a complex have different vertices, whatever the numbering of the cells that they are in.
using PolygonKey = std::array<Index, 12>;
inline constexpr Index kNoPoint = ~Index{0};

/// The shared barycentres of a contour, ordered by their keys.
struct SharedPoints {
  std::vector<PolygonKey> keys;
  std::vector<Index> numbers;  ///< into `keys`, by shared vertex, counted in each cell
};

/// Numbers the shared barycentres of all active cells. Errors: TooLarge, Cancelled.
[[nodiscard]] SharedPoints number_shared_points(const CellTables& tables, const std::vector<ActiveBlock>& blocks,
                                                const CrossingNumbers& crossings, const WorkOptions& work);

}  // namespace tegl::detail
