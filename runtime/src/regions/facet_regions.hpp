// SPDX-License-Identifier: BSD-3-Clause
//
// Tetrahedra in the regions of one side of a facet of a 4D cell, for any numbering of the cell's vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"

namespace tegl::detail {

template <class Local>
bool has_vertex(const std::array<Local, 3>& t, Local v) noexcept {
  return std::find(t.begin(), t.end(), v) != t.end();
}

/// The boundary of the regions of one side of a facet in which all polygons of the contour are discs.
template <class Local>
struct RegionSides {
  std::vector<std::vector<Local>> parts;        ///< the side's parts of the facet's polygons, by their vertices
  std::vector<std::array<Local, 3>> triangles;  ///< of the parts
  std::vector<std::array<Local, 3>> of_contour;
};

/// Adds the parts of a polygon on one side, of which all corners are joined, except that two opposite corners of a
/// quadrilateral are separate parts if they are `is_apart`. By corner: `is_in(i)`, whether it is on the side; its
/// vertex `corner(i)`; the vertex `edge(i)` on the edge to the next corner.
template <class Local, class IsIn, class Corner, class Edge>
void add_polygon_parts(std::size_t count, bool is_apart, const IsIn& is_in, const Corner& corner, const Edge& edge,
                       std::vector<std::vector<Local>>& parts) {
  if (is_apart && is_in(0) == is_in(2) && is_in(1) == is_in(3) && is_in(0) != is_in(1)) {
    for (std::size_t i = is_in(0) ? 0 : 1; i < 4; i += 2) parts.push_back({edge(i + 3), corner(i), edge(i)});
    return;
  }
  std::vector<Local> part;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_in(i)) part.push_back(corner(i));
    if (is_in(i) != is_in(i + 1)) part.push_back(edge(i));
  }
  if (!part.empty()) parts.push_back(std::move(part));
}

/// Divides the parts from `first` on into triangles, from their corner of the largest number. Each triangle has a
/// corner then, so that it is moved into the cell.
template <class Local>
void add_part_triangles(std::size_t first, RegionSides<Local>& sides) {
  for (std::size_t p = first; p < sides.parts.size(); ++p) {
    auto& part = sides.parts[p];
    std::rotate(part.begin(), std::max_element(part.begin(), part.end()), part.end());
    for (std::size_t i = 2; i < part.size(); ++i) sides.triangles.push_back({part[0], part[i - 1], part[i]});
  }
}

/// Cones each region: from the one corner, if it has only one, else from a centre. Appends tetrahedra to `to`. Numbers
/// below `first_corner` are on edges, those from there on are corners, all below `end`. `add_centre(vertices)`: numbers
/// a vertex in the middle of the corners and edges of a region, ascending.
template <class Local, class AddCentre>
void cone_regions(const RegionSides<Local>& sides, Local first_corner, Local end, const AddCentre& add_centre,
                  std::vector<std::array<Local, 4>>& to) {
  DisjointSets sets(end);
  for (const auto& part : sides.parts)
    for (const Local v : part) sets.join(part[0], v);
  for (const auto& t : sides.of_contour) sets.join(t[0], t[1]), sets.join(t[0], t[2]);
  std::map<Index, std::vector<Local>> regions;  // by set: corners and edges
  for (const auto& part : sides.parts)
    for (const Local v : part) regions[sets.find(v)].push_back(v);
  for (auto& [root, vertices] : regions) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const bool is_tip = vertices.size() < 2 || vertices[vertices.size() - 2] < first_corner;  // one corner
    const Local apex = is_tip ? vertices.back() : add_centre(vertices);
    for (const auto* const of : {&sides.triangles, &sides.of_contour})
      for (const auto& t : *of)
        if (sets.find(t[0]) == root && !has_vertex(t, apex)) to.push_back({t[0], t[1], t[2], apex});
  }
}

/// Cones a sector of the region around a tunnel from `apex`: its walls to both neighbours, the triangles of the sides'
/// parts whose vertices are all in the sector, `is_in(v)`, and those of the contour around `centre`. Appends to `to`.
template <class Local, class IsIn>
void cone_sector(const RegionSides<Local>& sides, const std::vector<std::array<Local, 3>>& walls, Local centre,
                 const IsIn& is_in, Local apex, std::vector<std::array<Local, 4>>& to) {
  const auto add = [&](const std::array<Local, 3>& t) { to.push_back({t[0], t[1], t[2], apex}); };
  for (const auto& t : walls) add(t);
  for (const auto& t : sides.triangles)
    if (std::all_of(t.begin(), t.end(), is_in)) add(t);
  for (const auto& t : sides.of_contour)
    if (has_vertex(t, centre)) add(t);
}

/// Fills the space between two triangulations of the same polygons. Each is a fan from a corner, the middle one of
/// three, so they differ in single diagonals of four vertices, which are the corners of a tetrahedron. It lies in the
/// hyperplane between the copies of both facets, whichever diagonal is nearer to the centre. `a`, `b`: ascending.
template <class Local>
void join_fans(const std::vector<std::array<Local, 3>>& a, const std::vector<std::array<Local, 3>>& b,
               std::vector<std::array<Local, 4>>& to) {
  std::vector<std::array<Local, 3>> of_a, of_b;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(of_a));
  std::set_difference(b.begin(), b.end(), a.begin(), a.end(), std::back_inserter(of_b));
  for (std::size_t i = 0; i < of_a.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const auto &t = of_a[i], &u = of_a[k];
      const Local* const fourth = std::find_if(u.begin(), u.end(), [&](Local v) { return !has_vertex(t, v); });
      const auto is_face = [&](const std::array<Local, 3>& face) {
        return std::all_of(face.begin(), face.end(), [&](Local v) { return v == *fourth || has_vertex(t, v); });
      };
      if (is_face(u) && std::count_if(of_b.begin(), of_b.end(), is_face) == 2)
        to.push_back({t[0], t[1], t[2], *fourth});
    }
}

}  // namespace tegl::detail
