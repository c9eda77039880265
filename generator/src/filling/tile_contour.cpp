// SPDX-License-Identifier: BSD-3-Clause
//
// The names of alternatives and triangulations.
#include "filling/tile_contour.hpp"

namespace tegl::gen {

const char* alternative_name(Alternative a) noexcept { return a == Alternative::low ? "low" : "high"; }
const char* triangulation_name(Triangulation t) noexcept {
  return t == Triangulation::barycentric ? "barycentric" : "compact";
}

}  // namespace tegl::gen
