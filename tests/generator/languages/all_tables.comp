#version 450
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: BSD-3-Clause
// A compute shader that uses every emitted GLSL table: glslang must accept it.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Barycentric { uint tegl_tile4_barycentric_words[]; };
layout(std430, binding = 1) readonly buffer Compact { uint tegl_tile4_compact_words[]; };
layout(std430, binding = 2) writeonly buffer Result { uint result[]; };
#include "tile2_barycentric.glsl"
#include "tile2_compact.glsl"
#include "tile3_barycentric.glsl"
#include "tile3_compact.glsl"
#include "tile3_resolved.glsl"
#include "tile4_barycentric.glsl"
#include "tile4_compact.glsl"

void main() {
  uint s = gl_GlobalInvocationID.x;
  result[8u * s] = tegl_tile2_barycentric_vertex(s & 15u, 0u, 0u) + tegl_tile2_barycentric_simplex_count(s & 15u);
  result[8u * s + 1u] = tegl_tile2_compact_vertex(s & 15u, 0u, 1u) + tegl_tile2_compact_edge_corner(s & 3u, 1u);
  result[8u * s + 2u] = tegl_tile3_barycentric_vertex(s & 255u, 0u, 2u) + tegl_tile3_barycentric_cone_vertices(s & 255u);
  uint e = tegl_tile3_resolved_entry(s & 255u, tegl_tile3_resolved_ambiguous_squares(s & 255u));
  result[8u * s + 3u] = tegl_tile3_compact_vertex(s & 255u, 0u, 2u) + tegl_tile3_resolved_vertex(e, 2u, 0u, 1u) +
                        tegl_tile3_resolved_triangle_count(e, 1u) + tegl_tile3_resolved_own_vertices(e, 0u);
  result[8u * s + 4u] = tegl_tile4_barycentric_vertex(s, 0u, 3u) + tegl_tile4_barycentric_simplex_count(s);
  result[8u * s + 5u] = tegl_tile4_barycentric_side_mask(s, 0u, 1u) + tegl_tile4_barycentric_side_vertices(s);
  result[8u * s + 6u] = tegl_tile4_compact_vertex(s, 0u, 3u) + tegl_tile4_compact_cone_vertices(s);
  result[8u * s + 7u] = tegl_tile4_compact_side_mask(s, 0u, 0u);
}
