#version 450
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: BSD-3-Clause
// A compute shader that uses the emitted builders: glslang must accept it.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Samples { float samples[]; };
layout(std430, binding = 1) writeonly buffer Result { uint result[]; };
#include "builder2.glsl"
#include "builder3.glsl"

void main() {
  uint first = 8u * gl_GlobalInvocationID.x;
  float square[4];
  for (uint v = 0u; v < 4u; ++v) square[v] = samples[first + v];
  tegl_builder2_contour segments = tegl_builder2_build_values(square, 0.5, tegl_builder2_MEAN);
  float cube[8];
  for (uint v = 0u; v < 8u; ++v) cube[v] = samples[first + v];
  tegl_builder3_contour triangles = tegl_builder3_build_values(cube, 0.5, tegl_builder3_DECIDER);
  tegl_builder3_contour tunnel = tegl_builder3_build(129u, 0u, tegl_builder3_CENTRE_HIGH);
  result[first] = segments.segments + segments.vertices[0];
  result[first + 1u] = triangles.triangles + triangles.vertices[0];
  result[first + 2u] = tunnel.own_vertices + tunnel.masks[0];
}
