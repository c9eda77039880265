// SPDX-License-Identifier: BSD-3-Clause
//
// Signs of volumes from those of the tetrahedra between corners.
#include "regions/shape_volumes.hpp"

namespace tegl::detail {

std::uint8_t edge_between(const tables::CellTable& table, unsigned p, unsigned q) noexcept {
  std::uint8_t e = 0;
  while ((1u << table.edges[2 * e] | 1u << table.edges[2 * e + 1]) != (1u << p | 1u << q)) ++e;
  return e;
}

ShapePlaces::ShapePlaces(const tables::CellTable& table) : table_(table) {
  for (std::size_t e = 0; e < alphas_.size(); ++e) alphas_[e] = 0.4 + 0.02 * static_cast<double>(e);
}

ShapePlaces::Place ShapePlaces::place(unsigned vertex) const noexcept {
  Place place{};
  const auto add = [&](unsigned corner, double weight) {
    for (std::size_t a = 0; a < 3; ++a) place[a] += weight * table_.corners[3 * corner + a];
  };
  const auto add_edge = [&](unsigned e, double weight) {
    add(table_.edges[2 * e], weight * (1 - alphas_[e]));
    add(table_.edges[2 * e + 1], weight * alphas_[e]);
  };
  if (vertex < RegionVertices::kFirstEdge) {
    add(vertex, 1.0);
  } else if (vertex < RegionVertices::kFirstCentre) {
    add_edge(vertex - RegionVertices::kFirstEdge, 1.0);
  } else {
    const auto& points = centres_[vertex - RegionVertices::kFirstCentre];
    for (const std::uint8_t point : points)
      add_edge(point - RegionVertices::kFirstEdge, 1.0 / static_cast<double>(points.size()));
  }
  return place;
}

ShapeVolumes::ShapeVolumes(tables::CellShape shape)
    : table_(tables::cell_table(shape, Triangulation::barycentric)),
      generic_(table_),
      planes_(tables::shape_table(shape).planes_of_three) {
  for (std::uint8_t v = 0; v < RegionVertices::kFirstCentre; ++v) {
    points_[v] = {v};
    ends_[v] = {v, v};
  }
  for (unsigned e = 0; e < table_.edge_count; ++e)
    ends_[RegionVertices::kFirstEdge + e] = {table_.edges[2 * e], table_.edges[2 * e + 1]};
}

void ShapeVolumes::add_signs(const Tetrahedron& points, VolumeSigns& to) const noexcept {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (points[i] == points[k]) return;
  for (unsigned choice = 0; choice < 16; ++choice) {
    Tetrahedron corners;
    bool repeats = false;
    for (unsigned i = 0; i < 4; ++i) {
      const auto& ends = ends_[points[i]];
      repeats = repeats || ((choice >> i & 1u) != 0 && ends[0] == ends[1]);
      corners[i] = ends[choice >> i & 1u];
    }
    if (repeats) continue;
    constexpr unsigned kBase = tables::kMostCornersIn3D;
    const auto& [above, below] = planes_[(corners[0] * kBase + corners[1]) * kBase + corners[2]];
    to.positive = to.positive || (above >> corners[3] & 1u) != 0;
    to.negative = to.negative || (below >> corners[3] & 1u) != 0;
  }
}

VolumeSigns ShapeVolumes::signs(const Tetrahedron& t) const noexcept {
  VolumeSigns signs;
  for (const std::uint8_t a : points_[t[0]])
    for (const std::uint8_t b : points_[t[1]])
      for (const std::uint8_t c : points_[t[2]])
        for (const std::uint8_t d : points_[t[3]]) add_signs({a, b, c, d}, signs);
  return signs;
}

}  // namespace tegl::detail
