// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the edges of polytopes by their faces.
#include "polytope/polytope_shape.hpp"

#include <algorithm>
#include <utility>

namespace tegl::detail {

PolytopeShape::PolytopeShape(std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends)
    : PolytopeShape(arrays_of(std::move(rings), std::move(ends))) {}

PolytopeShape::PolytopeShape(Arrays arrays) : arrays_(std::make_shared<const Arrays>(std::move(arrays))) {
  const Arrays& a = *arrays_;
  PolytopeFaces& faces = *this;
  if (a.solids != nullptr)
    faces = {a.corner_count, a.edges, *a.solids};
  else
    faces = {a.corner_count, a.rings, a.ring_edges, a.ends, a.edges, a.faces_of, a.is_prism};
}

PolytopeShape::Arrays PolytopeShape::arrays_of(std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends) {
  Arrays a{std::move(rings), {}, std::move(ends), {}, {}, 0, false};
  a.ring_edges.resize(a.rings.size());
  a.edges.resize(a.rings.size());
  a.faces_of.resize(a.rings.size());
  const std::size_t count = number_edges(a.rings, a.ends, a.ring_edges, a.edges, a.faces_of);
  a.edges.resize(count);
  a.faces_of.resize(count);
  for (const std::uint8_t corner : a.rings) a.corner_count = std::max(a.corner_count, std::size_t{corner} + 1);
  return a;
}

PolytopeShape PolytopeShape::prism_over(const PolytopeShape& base) {
  Arrays prism = *base.arrays_;
  const auto count = static_cast<std::uint8_t>(prism.corner_count);
  const std::size_t edges = prism.edges.size();
  for (std::size_t e = 0; e < edges; ++e)
    prism.edges.push_back(
        {static_cast<std::uint8_t>(prism.edges[e][0] + count), static_cast<std::uint8_t>(prism.edges[e][1] + count)});
  for (std::uint8_t v = 0; v < count; ++v) prism.edges.push_back({v, static_cast<std::uint8_t>(v + count)});
  prism.is_prism = true;
  return PolytopeShape(std::move(prism));
}

PolytopeShape PolytopeShape::of_solids(std::size_t corners, std::vector<Pair> edges,
                                       std::shared_ptr<const PolytopeSolids> solids) {
  return PolytopeShape(Arrays{{}, {}, {}, std::move(edges), {}, corners, false, std::move(solids)});
}

}  // namespace tegl::detail
