// SPDX-License-Identifier: BSD-3-Clause
//
// Boundaries of regions, square by square, and their components.
#include "cubes/cube_sides.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <map>
#include <utility>

#include "cubes/cube_frame.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

constexpr unsigned kFirstEdge = RegionVertices::kFirstEdge, kFirstOwn = RegionVertices::kFirstOwn;

std::uint8_t edge_between(unsigned a, unsigned b) {
  const auto axis = static_cast<unsigned>(std::countr_zero(a ^ b));
  return static_cast<std::uint8_t>(kFirstEdge + detail::edge_number(3, axis, a));
}

/// Connected components of the triangles of a closed surface.
std::vector<std::vector<RegionTriangle>> components_of(const std::vector<RegionTriangle>& triangles) {
  std::map<std::pair<std::uint8_t, std::uint8_t>, std::size_t> at;  // by directed edge: its triangle
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (unsigned j = 0; j < 3; ++j) at[{triangles[i][j], triangles[i][(j + 1) % 3]}] = i;
  std::vector<bool> seen(triangles.size());
  std::vector<std::vector<RegionTriangle>> result;
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    if (seen[first]) continue;
    std::vector<std::size_t> reached{first};
    seen[first] = true;
    auto& part = result.emplace_back();
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const RegionTriangle t = triangles[reached[k]];
      part.push_back(t);
      for (unsigned j = 0; j < 3; ++j) {
        const auto next = at.find({t[(j + 1) % 3], t[j]});
        if (next == at.end() || seen[next->second]) continue;
        seen[next->second] = true;
        reached.push_back(next->second);
      }
    }
  }
  return result;
}

}  // namespace

void CubeSide::add_square(unsigned square, std::vector<RegionTriangle>& to) const {
  const unsigned axis = square / 2, b = axis == 0 ? 1 : 0, c = axis == 2 ? 1 : 2, at = (square % 2) << axis;
  std::array<unsigned, 4> ring = {at, at | 1u << b, at | 1u << b | 1u << c, at | 1u << c};
  if ((detail::face_sign(square) > 0) == is_high) std::reverse(ring.begin(), ring.end());
  std::vector<std::uint8_t> outline;
  unsigned corners = 0;
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned here = ring[i], next = ring[(i + 1) % 4];
    if (has(here)) outline.push_back(static_cast<std::uint8_t>(here)), ++corners;
    if (has(here) != has(next)) outline.push_back(edge_between(here, next));
  }
  const std::size_t n = outline.size();
  const bool apart = corners == 2 && n == 6 && ((high_squares >> square & 1u) != 0) != is_high;
  if (apart) {
    for (std::size_t i = 0; i < n; ++i)
      if (outline[i] < 8) to.push_back({outline[(i + n - 1) % n], outline[i], outline[(i + 1) % n]});
  } else if (corners != 0) {
    const auto is_apex = [&](std::size_t i) {
      return corners != 3 ? outline[i] == *std::min_element(outline.begin(), outline.end())
                          : outline[(i + n - 1) % n] < 8 && outline[i] < 8 && outline[(i + 1) % n] < 8;
    };
    std::size_t apex = 0;
    while (!is_apex(apex)) ++apex;
    std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(apex), outline.end());
    for (std::size_t i = 1; i + 1 < n; ++i) to.push_back({outline[0], outline[i], outline[i + 1]});
  }
}

std::vector<std::vector<RegionTriangle>> CubeSide::regions(std::span<const RegionTriangle> contour) const {
  std::vector<RegionTriangle> surface;
  for (unsigned q = 0; q < 6; ++q) add_square(q, surface);
  surface.insert(surface.end(), contour.begin(), contour.end());
  return components_of(surface);
}

RegionFrame region_frame(std::span<const std::uint32_t> masks, std::size_t barycentres,
                         std::span<const RegionTriangle> contour, bool is_cap) {
  RegionFrame frame;
  frame.is_cap = is_cap;
  for (std::size_t j = 0; j < masks.size(); ++j) {
    frame.points[kFirstOwn + j] = is_on_ray(masks[j]) ? RegionProof::on_ray(masks[j]) : masks[j];
    if (j < barycentres && !is_cap) frame.barycentres |= RegionFrame::Set{1} << (kFirstOwn + j);
  }
  for (const RegionTriangle& t : contour)
    for (const std::uint8_t v : t)
      if (!is_cap) frame.on_contour |= RegionFrame::Set{1} << v;
  return frame;
}

std::optional<RegionDivision> divide_side_region(const RegionProof& proof, const RegionFrame& frame,
                                                 std::vector<RegionTriangle> surface, bool is_high) {
  for (RegionTriangle& t : surface) {
    if (is_high) std::swap(t[1], t[2]);
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  std::sort(surface.begin(), surface.end());  // the same order for the complement's side
  auto division = divide_region(proof, frame, surface);
  if (division && is_high)
    for (RegionVertices::Tetrahedron& t : division->tetrahedra) std::swap(t[2], t[3]);
  return division;
}

}  // namespace tegl::gen
