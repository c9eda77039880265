// SPDX-License-Identifier: BSD-3-Clause
//
// The CUDA headers, compiled for the host.
#include "lookups.hpp"
#include "tile2_barycentric.cuh"
#include "tile2_compact.cuh"
#include "tile3_barycentric.cuh"
#include "tile3_compact.cuh"
#include "tile3_resolved.cuh"
#include "tile4_barycentric.cuh"
#include "tile4_compact.cuh"

namespace tegl::test {

Lookups cuda_lookups(int dim, Triangulation triangulation) {
  if (dim == 2) {
    return triangulation == Triangulation::barycentric ? TEGL_LOOKUPS_WITHOUT_SIDES(tegl_tile2_barycentric)
                                                       : TEGL_LOOKUPS_WITHOUT_SIDES(tegl_tile2_compact);
  }
  if (dim == 3) {
    return triangulation == Triangulation::barycentric ? TEGL_LOOKUPS_WITHOUT_SIDES(tegl_tile3_barycentric)
                                                       : TEGL_LOOKUPS_WITHOUT_SIDES(tegl_tile3_compact);
  }
  return triangulation == Triangulation::barycentric ? TEGL_LOOKUPS_WITH_SIDES(tegl_tile4_barycentric)
                                                     : TEGL_LOOKUPS_WITH_SIDES(tegl_tile4_compact);
}

ResolvedLookups cuda_resolved_lookups() { return TEGL_RESOLVED_LOOKUPS; }

}  // namespace tegl::test
