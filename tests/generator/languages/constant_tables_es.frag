#version 300 es
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: BSD-3-Clause
// The tables of 2D and 3D tiles in a fragment shader of OpenGL ES 3.0 (WebGL 2): glslang must accept them.
precision highp float;
precision highp int;
#include "tile2_compact.glsl"
#include "tile3_barycentric.glsl"
#include "tile3_compact.glsl"
#include "tile3_resolved.glsl"
out vec4 colour;

void main() {
  uint s = uint(gl_FragCoord.x) & 255u;
  uint v = tegl_tile3_compact_vertex(s, 0u, 2u) + tegl_tile3_barycentric_vertex(s, 0u, 2u) +
           tegl_tile3_resolved_vertex(tegl_tile3_resolved_entry(s, 0u), 0u, 0u, 1u);
  colour = vec4(float(v), float(tegl_tile2_compact_vertex(s & 15u, 0u, 1u)), 0.0, 1.0);
}
