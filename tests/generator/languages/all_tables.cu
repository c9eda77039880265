// SPDX-License-Identifier: BSD-3-Clause
//
// A kernel that uses the emitted CUDA tables: nvcc must accept it where there is one.
#include "tile2_compact.cuh"
#include "tile3_barycentric.cuh"
#include "tile3_compact.cuh"
#include "tile3_resolved.cuh"
#include "tile4_barycentric.cuh"

__global__ void use_tables(uint32_t* result) {
  const uint32_t s = threadIdx.x + blockIdx.x * blockDim.x;
  result[s] = tegl_tile2_compact_vertex(s & 15u, 0, 1) + tegl_tile3_barycentric_vertex(s & 255u, 0, 2) +
              tegl_tile3_compact_edge_corner(s & 7u, 1) +
              tegl_tile3_resolved_vertex(tegl_tile3_resolved_entry(s & 255u, 0), 1, 0, 2) + tegl_tile4_barycentric_vertex(s, 0, 3) +
              tegl_tile4_barycentric_side_mask(s, 0, 1) + tegl_tile4_barycentric_MAX_SIMPLICES;
}
