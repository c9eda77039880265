// SPDX-License-Identifier: BSD-3-Clause
//
// The names of alternatives and triangulations, and the inversion of contours.
#include "base/tile_contour.hpp"

#include <utility>

namespace tegl::gen {

const char* alternative_name(Alternative a) noexcept { return a == Alternative::low ? "low" : "high"; }
const char* triangulation_name(Triangulation t) noexcept {
  return t == Triangulation::barycentric ? "barycentric" : "compact";
}

TileContour inverted(const TileContour& contour) {
  TileContour result = contour;
  for (LocalFacet& facet : result.facets)
    for (LocalSimplex& s : facet.simplices) std::swap(s[3], s[2]);
  for (LocalSimplex& s : result.boundary) std::swap(s[2], s[1]);
  return result;
}

}  // namespace tegl::gen
