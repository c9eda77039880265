// SPDX-License-Identifier: BSD-3-Clause
//
// The shaders. There is one vertex shader for contours in 2D, 3D and 4D (DIM). All they have lies in textures, and the
// vertex's number says which corner of what is drawn it is; so of a 4D contour any range of tetrahedra can be drawn,
// each as the up to two triangles that the time cuts out of it.

/** Texels in a row of each texture. */
export const ROW = 2048;

export const VERTEX = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform usampler2D uSimplices;
uniform sampler2D uPlaces;
uniform sampler2D uNormals;
uniform sampler2D uValues;
uniform vec3 uOffset;
uniform vec3 uScale;
uniform int uSource;
uniform float uValue;
uniform sampler2D uSegments;
uniform sampler2D uAfter;
uniform float uTime;
#if DIM == 4
uniform usampler2D uKeys;
uniform uint uThreshold;
uniform uint uCases[16];
#endif
#if DIM == 2
uniform vec2 uViewport;
uniform float uWidth;
#endif
out vec3 vView;
out vec3 vNormal;
// At a pixel that a simplex covers in part, the place is one inside it: beyond its edge, clipping would leave gaps.
centroid out vec3 vPlace;
out float vValue;

ivec2 texel(int i) { return ivec2(i % ${ROW}, i / ${ROW}); }
ivec2 texel(uint i) { return texel(int(i)); }

// The part that a simplex is in now: it appears in a segment of the graph, and goes on with what that becomes.
float part(int simplex) {
  float segment = texelFetch(uValues, texel(simplex), 0).r;
  float after = texelFetch(uAfter, texel(simplex), 0).r;  // the first split that it passes
  float number = -1.0;
  for (int i = 0; i < 64 && segment >= 0.0; ++i) {
    vec4 found = texelFetch(uSegments, texel(int(segment)), 0);  // end, next, number of its track, whether it splits
    number = found.z;
    bool isSplit = found.w > 0.5 && after >= 0.0;
    segment = uTime < found.x ? -1.0 : isSplit ? after : found.y;
    if (isSplit) after = -1.0;
  }
  return number;
}

// As exact at the ends as between them: there points of neighbours must coincide.
vec4 between(vec4 a, vec4 b, float share) { return share <= 0.0 ? a : share >= 1.0 ? b : mix(a, b, share); }

void finish(vec3 place, vec3 normal, uint low, uint high, float share, int simplex) {
  vPlace = place + uOffset;
  vec4 view = modelViewMatrix * vec4(vPlace * uScale, 1.0);
  vView = view.xyz;
  // Normals are gradients: they go with the inverse of the scale.
  vNormal = mat3(modelViewMatrix) * (normal / uScale);
  vValue = uValue;
  if (uSource == 1) vValue = mix(texelFetch(uValues, texel(low), 0).r, texelFetch(uValues, texel(high), 0).r, share);
  if (uSource == 2) vValue = texelFetch(uValues, texel(simplex), 0).r;
  if (uSource >= 3 && uSource < 6) vValue = vPlace[uSource - 3];
  if (uSource == 6) vValue = part(simplex);
  gl_Position = projectionMatrix * view;
}

void main() {
#if DIM == 4
  int simplex = gl_VertexID / 6;
  int corner = gl_VertexID - 6 * simplex;
  uvec4 v = texelFetch(uSimplices, texel(simplex), 0);
  uint high = 0u;
  for (int k = 0; k < 4; ++k) high |= texelFetch(uKeys, texel(v[k]), 0).r >= uThreshold ? 1u << k : 0u;
  uint found = uCases[high];
  if (corner >= int(found >> 24)) {
    vView = vNormal = vPlace = vec3(0.0);
    vValue = 0.0;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // beyond what is seen, all corners of the triangle alike
    return;
  }
  uint edge = found >> uint(4 * corner);
  uint low = v[edge & 3u];
  uint up = v[(edge >> 2) & 3u];
  vec4 a = texelFetch(uPlaces, texel(low), 0);
  vec4 b = texelFetch(uPlaces, texel(up), 0);
  float share = b.w > a.w ? clamp((uTime - a.w) / (b.w - a.w), 0.0, 1.0) : 0.0;
  vec4 normal = between(texelFetch(uNormals, texel(low), 0), texelFetch(uNormals, texel(up), 0), share);
  finish(between(a, b, share).xyz, normal.xyz, low, up, share, simplex);
#elif DIM == 3
  int triangle = gl_VertexID / 3;
  uvec4 corners = texelFetch(uSimplices, texel(triangle), 0);  // and the simplex whose values it has
  uint v = corners[gl_VertexID - 3 * triangle];
  finish(texelFetch(uPlaces, texel(v), 0).xyz, texelFetch(uNormals, texel(v), 0).xyz, v, v, 0.0, int(corners.w));
#else
  // A segment as a rectangle of a certain width on the screen.
  int simplex = gl_VertexID / 6;
  int corner = gl_VertexID - 6 * simplex;
  uvec4 v = texelFetch(uSimplices, texel(simplex), 0);
  bool isEnd = corner == 1 || corner == 2 || corner == 4;
  bool isLeft = corner == 0 || corner == 1 || corner == 3;
  uint here = isEnd ? v[1] : v[0];
  uint there = isEnd ? v[0] : v[1];
  finish(texelFetch(uPlaces, texel(here), 0).xyz, vec3(0.0), here, here, 0.0, simplex);
  vec4 other = projectionMatrix * modelViewMatrix * vec4((texelFetch(uPlaces, texel(there), 0).xyz + uOffset) * uScale, 1.0);
  vec2 along = (gl_Position.xy / gl_Position.w - other.xy / other.w) * uViewport;
  along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  vec2 across = (isEnd ? 1.0 : -1.0) * vec2(-along.y, along.x) * (isLeft ? 1.0 : -1.0);
  gl_Position.xy += (0.35 * along + across) * uWidth / uViewport * gl_Position.w;
#endif
}`;

export const FRAGMENT = `
precision highp float;
precision highp int;
uniform sampler2D uColors;
uniform vec3 uLower;
uniform vec3 uUpper;
uniform vec2 uRange;
uniform int uPalette;
uniform vec3 uColor;
uniform bool uSmooth;
uniform float uFront;
in vec3 vView;
in vec3 vNormal;
centroid in vec3 vPlace;
in float vValue;
out vec4 color;

vec3 base() {
  if (uPalette == 0) return uColor;
  if (isnan(vValue) || isinf(vValue)) return vec3(0.55);
  if (uPalette == 1) {
    float share = (vValue - uRange.x) / max(uRange.y - uRange.x, 1e-30);
    return texture(uColors, vec2((clamp(share, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.25)).rgb;
  }
  if (vValue < -0.5) return vec3(0.55);
  return texelFetch(uColors, ivec2(int(vValue + 0.5) % 64, 1), 0).rgb;
}

void main() {
  if (any(lessThan(vPlace, uLower)) || any(greaterThan(vPlace, uUpper))) discard;
  vec3 albedo = base();
#if DIM == 2
  color = vec4(albedo, 1.0);
#else
  vec3 face = cross(dFdx(vView), dFdy(vView));
  face = length(face) > 0.0 ? normalize(face) : vec3(0.0, 0.0, 1.0);
  if (dot(face, vView) > 0.0) face = -face;
  vec3 n = face;
  if (uSmooth && dot(vNormal, vNormal) > 0.0) {
    n = normalize(vNormal);
    if (dot(n, face) < 0.0) n = -n;
  }
  bool isFront = gl_FrontFacing == (uFront > 0.0);
  vec3 toEye = normalize(-vView);
  vec3 light = normalize(vec3(-0.35, 0.55, 0.75));
  float diffuse = 0.5 + 0.5 * dot(n, light);
  float rim = pow(1.0 - max(dot(n, toEye), 0.0), 3.0);
  float shine = pow(max(dot(n, normalize(light + toEye)), 0.0), 48.0);
  albedo = pow(albedo, vec3(2.2));
  if (!isFront) albedo = mix(albedo, vec3(dot(albedo, vec3(0.3, 0.6, 0.1))), 0.35) * 0.6;
  vec3 lit = albedo * (0.16 + 1.0 * diffuse * diffuse) + (isFront ? 0.10 : 0.02) * shine + 0.06 * rim;
  color = vec4(pow(lit, vec3(1.0 / 2.2)), 1.0);
#endif
}`;
