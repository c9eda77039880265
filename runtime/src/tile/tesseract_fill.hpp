// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of a 4D tile whose ambiguous faces are resolved one by one: names of the emitted builder and of its data,
// the lists of cubes with every ambiguity resolved freely. The code that fills a tile is in the emitted builder4.cpp,
// from generator/templates/builder4.cpp.in; the emitted builder4.hpp documents it.
#pragma once

#include <bit>
#include <cstdint>

#include "builder4.hpp"
#include "tegl/generated/tables.hpp"
#include "tile/cube_key.hpp"
#include "tile/local_simplices.hpp"

namespace tegl::detail {

using builders::CubeList;
using builders::CubeRegions;
using builders::kTesseractSquares;
using builders::ResolvedCubes;
using builders::ResolvedKey;
using builders::ResolvedSize;
using builders::ResolvedTesseract;
using builders::ResolvedView;

/// A builder that maps tetrahedra and cones by the processor's vector instructions.
inline ResolvedTesseract make_resolved_tesseract(Triangulation triangulation) {
  static_assert(CubeRegions::kMoreTetrahedra >= kMoreSimplices, "map_simplices reads so many behind them");
  static_assert(ResolvedCubes::kWordsBehind > kMoreSimplices, "add_cones reads so many behind them");
  const SimplexFunctions functions = simplex_functions();
  return ResolvedTesseract(triangulation, functions.map, functions.cones);
}

/// Number of the list (ResolvedCubes) for a cube's key; kNone for a cube without a contour.
inline unsigned list_of_key(CubeKey cube) noexcept {
  return ResolvedCubes::list_of_entry(tables::kTile3Resolved.first_entry[cube.signature()] + cube.resolution(),
                                      cube.choice());
}

}  // namespace tegl::detail
