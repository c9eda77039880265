// SPDX-License-Identifier: BSD-3-Clause
//
// Tetrahedra in the regions of one side of a cube with a tunnel, for any numbering of a cell's vertices.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <vector>

#include "regions/facet_regions.hpp"
#include "regions/oriented_tetrahedra.hpp"

namespace tegl::detail {

/// Triangles with sorted vertices, and the number of tetrahedra at each.
template <class Local>
using TriangleCounts = std::map<std::array<Local, 3>, unsigned>;

/// Appends the tetrahedra of the table's regions on one side of a cube, and returns their triangles. `regions`,
/// `cubes`: the tables of the cube (builders::CubeRegions and ResolvedCubes). Vertices of the cell: `corner(v)`;
/// `edge(e)`, on an edge; the contour's own in the cube, from `first_own` on; `add_centre(mask)` numbers a new
/// one, the mean of corners and points of the cube.
template <class Local, class Regions, class Cubes, class Corner, class Edge, class AddCentre>
TriangleCounts<Local> add_tunnel_regions(const Regions& regions, const Cubes& cubes, std::uint16_t list, bool high,
                                         Local first_own, const Corner& corner, const Edge& edge,
                                         const AddCentre& add_centre, std::vector<std::array<Local, 4>>& to) {
  TriangleCounts<Local> faces;
  std::vector<Local> centres;
  for (const auto& region : regions.regions(list, high)) {
    centres.clear();
    for (const std::uint32_t mask : regions.centres(region)) {
      const std::uint32_t doubled = mask / Regions::kFirstDouble;
      centres.push_back(
          add_centre(doubled != 0 ? cubes.mask(list, static_cast<unsigned>(std::countr_zero(doubled))) : mask));
    }
    const auto local = [&](unsigned v) {
      if (v < Regions::kFirstEdge) return corner(v);
      if (v < Regions::kFirstOwn) return edge(v - Regions::kFirstEdge);
      if (v < Regions::kFirstCentre) return static_cast<Local>(first_own + v - Regions::kFirstOwn);
      return centres[v - Regions::kFirstCentre];
    };
    for (const auto& [a, b, c, d] : regions.tetrahedra(region)) {
      const auto& t = to.emplace_back(std::array<Local, 4>{local(a), local(b), local(c), local(d)});
      for (unsigned k = 0; k < 4; ++k) ++faces[sorted(face_of(t, k))];
    }
  }
  return faces;
}

/// The triangles in a square of the cube become its division, or the space to an earlier division is filled.
/// `is_in(v)`: whether a vertex is in the square; `fans`: divisions by square.
template <class Local, class Square, class IsIn>
void add_square_fan(const TriangleCounts<Local>& faces, const Square& square, const IsIn& is_in,
                    std::map<Square, std::vector<std::array<Local, 3>>>& fans, std::vector<std::array<Local, 4>>& to) {
  std::vector<std::array<Local, 3>> fan;
  for (const auto& [t, count] : faces)
    if (count == 1 && std::all_of(t.begin(), t.end(), is_in)) fan.push_back(t);
  const auto [at, is_new] = fans.try_emplace(square, fan);
  if (!is_new && at->second != fan) join_fans(at->second, fan, to);
}

}  // namespace tegl::detail
