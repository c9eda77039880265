// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the border of a complex by sorting all facets.
#include "complex/border_facets.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "base/progress.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"
#include "polytope/solid_facets.hpp"

namespace tegl::detail {

namespace {

/// A facet by its corners in ascending order, followed by the largest number.
template <std::size_t kCorners>
struct FacetUse {
  std::array<Index, kCorners> key;
  std::uint64_t place;
};

/// The points that name a facet of a polytope.
std::vector<Index> points_known_by(const Polytopes& polytopes, std::size_t cell, std::size_t number) {
  if (polytopes.shape(cell).dim() != 4) return facet_points(polytopes, cell, number);
  const SolidFacet facet = facet_of_solid(polytopes.shape(cell), number);
  std::vector<Index> points;
  if (facet.is_tabled()) {
    for (const std::uint8_t v : facet.corners) points.push_back(polytopes.cell(cell)[v]);
  } else {
    const auto key = key_of_facet(facet, polytopes.cell(cell), polytopes.entangled_facet(cell, facet));
    points.assign(key.begin(), key.end());
  }
  return points;
}

template <std::size_t kCorners>
BorderFacets find_border_of(std::size_t points, const CellGroups& cells, const WorkOptions& work) {
  std::vector<std::uint64_t> first{0};  // by group
  for (const CellGroup& group : cells.groups)
    first.push_back(first.back() + std::uint64_t{group.size()} * facets_of(group.shape).size());
  // list
  std::vector<FacetUse<kCorners>> uses(first.back());
  const auto set_key = [](FacetUse<kCorners>& use, const auto& point_of, std::size_t count) {
    use.key.fill(std::numeric_limits<Index>::max());
    for (std::size_t i = 0; i < count; ++i) use.key[i] = point_of(i);
    std::sort(use.key.begin(), use.key.end());
  };
  const std::vector<CellRange> ranges = ranges_of(cells);
  for_each_item(ranges.size(), work.threads, part_of(work.progress, 0.0, 0.3), [&](std::size_t r) {
    const auto [g, from, to] = ranges[r];
    const auto facets = facets_of(cells.groups[g].shape);
    std::uint64_t place = first[g] + from * facets.size();
    for (std::size_t c = from; c < to; ++c)
      for (const CellFacet& facet : facets) {
        FacetUse<kCorners>& use = uses[place];
        const Index* const corners = cells.groups[g].cell(c);
        set_key(
            use, [&](std::size_t i) { return corners[facet.corners[i]]; }, facet.corner_count);
        use.place = place++;
      }
  });
  // The four smallest corners of a polyhedron's face: different faces share two at most. The key of a 4D polytope's
  // facet has four corners, too (key_of_facet).
  std::vector<std::uint64_t> first_of{first.back()};  // by polytope
  for (std::size_t c = 0; c < cells.polytopes.size(); ++c)
    first_of.push_back(first_of.back() + cells.polytopes.shape(c).facet_count());
  uses.resize(first_of.back());
  for_each_item(cells.polytopes.size(), work.threads, nullptr, [&](std::size_t c) {
    for (std::size_t f = 0; f < cells.polytopes.shape(c).facet_count(); ++f) {
      std::vector<Index> points_of = points_known_by(cells.polytopes, c, f);
      std::sort(points_of.begin(), points_of.end());
      FacetUse<kCorners>& use = uses[first_of[c] + f];
      set_key(
          use, [&](std::size_t i) { return points_of[i]; }, std::min(points_of.size(), kCorners));
      use.place = first_of[c] + f;
    }
  });
  // sort by the first corner, then the facets with the same first corner
  const auto bits = static_cast<unsigned>(std::bit_width(points));
  sort_by_bits(
      uses, bits, [](const auto& use) { return std::uint64_t{use.key[0]}; }, work.threads);
  tell(work.progress, 0.7);
  std::vector<std::uint64_t> single;
  for (auto at = uses.begin(); at != uses.end();) {
    const auto end = std::find_if(at, uses.end(), [&](const auto& use) { return use.key[0] != at->key[0]; });
    std::sort(at, end, [](const auto& a, const auto& b) { return a.key < b.key; });
    while (at != end) {
      const auto next = std::find_if(at, end, [&](const auto& use) { return use.key != at->key; });
      if (next - at == 1) single.push_back(at->place);
      at = next;
    }
  }
  std::sort(single.begin(), single.end());
  tell(work.progress, 1.0);
  BorderFacets border;
  std::uint32_t g = 0;
  const auto groups = static_cast<std::uint32_t>(cells.groups.size());
  std::size_t c = 0;
  for (const std::uint64_t place : single) {
    while (g < groups && place >= first[g + 1]) ++g;
    if (g == groups) {
      while (place >= first_of[c + 1]) ++c;
      border.push_back({g, static_cast<Index>(c), static_cast<std::uint16_t>(place - first_of[c])});
      continue;
    }
    const std::size_t count = facets_of(cells.groups[g].shape).size();
    border.push_back(
        {g, static_cast<Index>((place - first[g]) / count), static_cast<std::uint16_t>((place - first[g]) % count)});
  }
  return border;
}

}  // namespace

std::vector<Index> facet_points(const Polytopes& polytopes, std::size_t cell, std::size_t facet) {
  const PolytopeShape& shape = polytopes.shape(cell);
  const Index* const corners = polytopes.cell(cell);
  if (shape.face_count() == 1) return {corners[facet], corners[(facet + 1) % shape.corner_count()]};
  std::vector<Index> points;
  for (const std::uint8_t v : shape.ring(facet)) points.push_back(corners[v]);
  return points;
}

BorderFacets find_border(std::size_t points, const CellGroups& cells, const WorkOptions& work) {
  const bool is_empty = cells.groups.empty();
  if (is_empty && cells.polytopes.size() == 0) return {};
  switch (is_empty ? static_cast<unsigned>(cells.polytopes.dim()) : table_of(cells.groups.front().shape).dim) {
    case 2:
      return find_border_of<2>(points, cells, work);
    case 3:
      return find_border_of<4>(points, cells, work);
    default:
      return find_border_of<8>(points, cells, work);
  }
}

}  // namespace tegl::detail
