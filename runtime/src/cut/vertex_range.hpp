// SPDX-License-Identifier: BSD-3-Clause
//
// The range of the vertex numbers of some simplices. Extraction numbers neighbouring vertices and simplices one after
// the other, so that a range says where a block of simplices lies.
#pragma once

#include <limits>
#include <span>

#include "tegl/contour.hpp"

namespace tegl::detail {

struct VertexRange {
  Index least = std::numeric_limits<Index>::max();
  Index most = 0;
};
/// The range of these vertex numbers.
[[nodiscard]] VertexRange vertex_range(std::span<const Index> numbers);

}  // namespace tegl::detail
