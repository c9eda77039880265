// SPDX-License-Identifier: BSD-3-Clause
//
// Signs of volumes from the signs of tetrahedra between corners.
#include "cells/region_volumes.hpp"

#include <numeric>

namespace tegl::gen {

RegionVolumes::RegionVolumes(const tables::CellTable& shape) : table_(shape), generic_(shape) {
  const unsigned count = shape.corner_count;
  for (unsigned i = 0; i < 4096; ++i) {
    const std::array<unsigned, 4> v = {i >> 9, i >> 6 & 7u, i >> 3 & 7u, i & 7u};
    if (v[0] >= count || v[1] >= count || v[2] >= count || v[3] >= count) continue;
    std::array<std::array<int, 3>, 4> p{};
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t a = 0; a < 3; ++a) p[k][a] = shape.corners[3 * v[k] + a];
    const int volume = detail::six_volumes(p);
    corner_signs_[i] = static_cast<std::int8_t>(volume > 0 ? 1 : (volume < 0 ? -1 : 0));
  }
  for (std::uint8_t v = 0; v < ShapeVertices::kFirstCentre; ++v) {
    points_[v] = {v};
    ends_[v] = {v, v};
  }
  for (unsigned e = 0; e < shape.edge_count; ++e)
    ends_[ShapeVertices::kFirstEdge + e] = {shape.edges[2 * e], shape.edges[2 * e + 1]};
}

void RegionVolumes::add_signs(const RegionTetrahedron& points, VolumeSigns& to) const noexcept {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (points[i] == points[k]) return;
  for (unsigned choice = 0; choice < 16; ++choice) {
    RegionTetrahedron corners{};
    bool repeats = false;
    for (unsigned i = 0; i < 4; ++i) {
      const auto& ends = ends_[points[i]];
      repeats = repeats || ((choice >> i & 1u) != 0 && ends[0] == ends[1]);
      corners[i] = ends[choice >> i & 1u];
    }
    if (repeats) continue;
    const int sign = corner_signs_[((corners[0] * 8u + corners[1]) * 8u + corners[2]) * 8u + corners[3]];
    to.positive = to.positive || sign > 0;
    to.negative = to.negative || sign < 0;
  }
}

VolumeSigns RegionVolumes::signs(const RegionTetrahedron& t) const noexcept {
  VolumeSigns signs;
  for (const std::uint8_t a : points_[t[0]])
    for (const std::uint8_t b : points_[t[1]])
      for (const std::uint8_t c : points_[t[2]])
        for (const std::uint8_t d : points_[t[3]]) add_signs({a, b, c, d}, signs);
  return signs;
}

VolumeSigns RegionVolumes::exact_signs(const RegionTetrahedron& t) const noexcept {
  std::uint32_t moving = 0;  // edges whose points it depends on
  std::int64_t scale = 1;    // makes the coordinates of all means integers
  for (const std::uint8_t v : t) {
    scale = std::lcm(scale, static_cast<std::int64_t>(points_[v].size()));
    for (const std::uint8_t p : points_[v])
      if (p >= ShapeVertices::kFirstEdge) moving |= 1u << (p - ShapeVertices::kFirstEdge);
  }
  VolumeSigns signs;
  for (std::uint32_t ends = moving;; ends = (ends - 1) & moving) {  // bit e: the second end of edge e
    std::array<std::array<std::int64_t, 3>, 4> at{};
    for (std::size_t k = 0; k < 4; ++k)
      for (const std::uint8_t p : points_[t[k]]) {
        const bool is_second = p >= ShapeVertices::kFirstEdge && (ends >> (p - ShapeVertices::kFirstEdge) & 1u) != 0;
        const std::size_t corner = ends_[p][is_second ? 1 : 0];
        for (std::size_t a = 0; a < 3; ++a)
          at[k][a] += scale / static_cast<std::int64_t>(points_[t[k]].size()) * table_.corners[3 * corner + a];
      }
    const std::int64_t volume = detail::six_volumes(at);
    signs.positive = signs.positive || volume > 0;
    signs.negative = signs.negative || volume < 0;
    if (ends == 0) return signs;
  }
}

}  // namespace tegl::gen
