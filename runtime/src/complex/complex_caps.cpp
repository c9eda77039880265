// SPDX-License-Identifier: BSD-3-Clause
//
// Caps of contours of complexes. The high part of an edge is a segment. That of a quadrilateral is triangulated by the
// table that closes contours of images. Those of triangles, and of the polygons around a 3D facet, are fans from their
// first vertex: so both facets at a polygon have the same triangles. The high regions of a 3D facet are cones over
// these fans and over the contour's polygons in the facet: each region is a ball, as every such polygon is a disc.
#include "complex/complex_caps.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ambiguity/face_decision.hpp"
#include "base/disjoint_sets.hpp"
#include "base/progress.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

template <int N>
struct ComplexCaps<N>::Facet {
  const CellFacet& of;
  std::array<Index, 8> points;
  unsigned high = 0;
  bool flip;
  /// Of compact 4D cells: the cell's corners and table, and the contour's triangles in the facet as edges of the cell.
  const Index* cell = nullptr;
  const tables::CellTable* table = nullptr;
  std::vector<FaceFillings::Triangle> triangles = {};

  [[nodiscard]] bool is_high(unsigned i) const noexcept { return (high >> i & 1u) != 0; }
};

template <int N>
ComplexCaps<N>::ComplexCaps(const CellGroups& cells, const CellSigns& signs, const BorderFacets& border,
                            std::span<const double> values, double isovalue, const ExtractOptions& options,
                            const ContourNumbers& numbers, const Progress& progress)
    : values_(values), isovalue_(isovalue), options_(options), numbers_(numbers) {
  const bool descends = options.direction == GradientDirection::descent;
  constexpr std::size_t kStep = std::size_t{1} << 14;  // facets between two reports
  for (std::size_t i = 0; i < border.size(); ++i) {
    const auto& [g, cell, number] = border[i];
    if (i % kStep == 0) tell(progress, static_cast<double>(i) / static_cast<double>(border.size()));
    const CellGroup& group = cells.groups[g];
    const Index* const corners = group.cell(cell);
    if (std::any_of(corners, corners + group.corner_count, [&](Index p) { return std::isnan(values[p]); })) continue;
    const CellFacet& of = facets_of(group.shape)[number];
    const bool is_inverted = (signs[g][cell >> 6] >> (cell & 63u) & 1u) != 0;
    Facet facet{of, {}, 0, (of.is_inverted != is_inverted) != descends};
    for (unsigned v = 0; v < of.corner_count; ++v) {
      facet.points[v] = corners[of.corners[v]];
      if (!(values[facet.points[v]] >= isovalue)) continue;
      facet.high |= 1u << v;
      corners_.push_back(facet.points[v]);
    }
    if (facet.high == 0) continue;
    if (const CellCases& cases = numbers.cases(g); cases.compact() != nullptr) {
      unsigned signature = 0;
      for (unsigned v = 0; v < group.corner_count; ++v) signature |= (values[corners[v]] >= isovalue ? 1u : 0u) << v;
      facet.cell = corners;
      facet.table = &cases.table();
      facet.triangles = cases.compact()->in_facet(number, cases.compact()->key(signature, corners, values));
    }
    add_facet(facet);
  }
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  require_numbers(numbers.size().vertices + vertex_count());
  tell(progress, 1.0);
}

template <int N>
void ComplexCaps<N>::add_facet(const Facet& facet) {
  if constexpr (N == 2) {
    const auto at = [&](unsigned v) {
      return facet.is_high(v) ? CapVertex::corner(facet.points[v]) : on_edge(facet.points[0], facet.points[1]);
    };
    add_simplex({at(0), at(1)}, facet.flip);
  } else if constexpr (N == 3) {
    if (facet.of.shape == tables::CellShape::quadrilateral) {
      static constexpr std::uint8_t kAround[] = {0, 1, 3, 2};
      const auto alternative = joins(facet, kAround) ? tile::Alternative::high : tile::Alternative::low;
      add_table(facet, tables::region_table(2, options_.triangulation, alternative));
      return;
    }
    static constexpr std::uint8_t kAround[] = {0, 1, 2};
    std::vector<Part> parts;
    cut(facet, kAround, parts, nullptr);
    for (const Part& part : parts)
      for (std::size_t i = 2; i < part.size(); ++i) add_simplex({part[0], part[i - 1], part[i]}, facet.flip);
  } else {
    add_regions(facet);
  }
}

template <int N>
CapVertex ComplexCaps<N>::on_edge(Index p, Index q) const {
  const std::vector<EdgeEnds>& ends = numbers_.edge_ends();
  const auto found = std::lower_bound(ends.begin(), ends.end(), EdgeEnds{std::min(p, q), std::max(p, q)});
  return CapVertex::of_contour(static_cast<Index>(found - ends.begin()));
}

template <int N>
bool ComplexCaps<N>::joins(const Facet& facet, std::span<const std::uint8_t> around) const {
  if (!is_estimated(options_.ambiguity)) return options_.ambiguity == Ambiguity::high;
  if (around.size() < 4 || facet.is_high(around[0]) != facet.is_high(around[2]) ||
      facet.is_high(around[1]) != facet.is_high(around[3]) || facet.is_high(around[0]) == facet.is_high(around[1]))
    return false;
  std::array<double, 4> values;  // in the order of a square's corners
  for (unsigned i = 0; i < 4; ++i) values[i ^ (i >> 1)] = values_[facet.points[around[i]]];
  return is_square_high(face_rule(options_.ambiguity), values, isovalue_);
}

template <int N>
void ComplexCaps<N>::cut(const Facet& facet, std::span<const std::uint8_t> around, std::vector<Part>& parts,
                         std::vector<std::array<CapVertex, 2>>* segments) const {
  const std::size_t count = around.size();
  const auto is_high = [&](std::size_t i) { return facet.is_high(around[i % count]); };
  const auto edge = [&](std::size_t i) {
    return on_edge(facet.points[around[i % count]], facet.points[around[(i + 1) % count]]);
  };
  const bool is_ambiguous =
      count == 4 && is_high(0) == is_high(2) && is_high(1) == is_high(3) && is_high(0) != is_high(1);
  const auto add_segment = [&](CapVertex from, CapVertex to) {
    if (segments != nullptr) segments->push_back({to, from});
  };
  if (is_ambiguous && !joins(facet, around)) {
    for (std::size_t i = is_high(0) ? 0 : 1; i < 4; i += 2) {
      parts.push_back({edge(i + 3), CapVertex::corner(facet.points[around[i]]), edge(i)});
      add_segment(edge(i), edge(i + 3));
    }
    return;
  }
  Part part;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_high(i)) part.push_back(CapVertex::corner(facet.points[around[i]]));
    if (is_high(i) == is_high(i + 1)) continue;
    part.push_back(edge(i));
    if (!is_high(i)) continue;
    std::size_t last = i + 1;  // the segment ends where the next high corner begins
    while (!is_high(last + 1)) ++last;
    add_segment(edge(i), edge(last));
  }
  if (!part.empty()) parts.push_back(std::move(part));
}

template <int N>
void ComplexCaps<N>::add_table(const Facet& facet, const tables::RegionTable& table) {
  const tables::RegionList& list = table.lists[facet.high];
  const auto shared = [&](unsigned v) {
    if (v < 4) return CapVertex::corner(facet.points[v]);
    const unsigned base = edge_base(2, v - 4);
    return on_edge(facet.points[base], facet.points[base | 1u << (v - 4) / 2]);
  };
  const std::uint64_t first = first_point_.size() - 1;
  for (unsigned j = 0; j < list.own_vertices; ++j) {
    Part points;
    for (std::uint32_t mask = table.masks[list.first_mask + j]; mask != 0; mask &= mask - 1)
      points.push_back(shared(static_cast<unsigned>(std::countr_zero(mask))));
    (void)add_mean(points);
  }
  const std::uint8_t* stored = table.simplices + std::size_t{list.first_simplex} * N;
  for (unsigned q = 0; q < list.simplex_count; ++q, stored += N) {
    Simplex simplex;
    for (int j = 0; j < N; ++j)
      simplex[j] = stored[j] < tables::first_region_vertex(2)
                       ? shared(stored[j])
                       : CapVertex::added(first + stored[j] - tables::first_region_vertex(2));
    add_simplex(simplex, facet.flip);
  }
}

template <int N>
typename ComplexCaps<N>::Boundary ComplexCaps<N>::boundary_of(const Facet& facet) const {
  Boundary boundary;
  std::vector<std::array<CapVertex, 2>> segments;
  for (const CellFacet& face : facets_of(facet.of.shape)) {
    std::array<std::uint8_t, 4> around = {face.corners[0], face.corners[1], face.corners[2], face.corners[3]};
    if (face.corner_count == 4) std::swap(around[2], around[3]);
    if (!face.is_inverted) std::reverse(around.begin(), around.begin() + face.corner_count);
    cut(facet, {around.data(), face.corner_count}, boundary.parts, &segments);
  }
  for (Part& part : boundary.parts) {
    std::rotate(part.begin(), std::min_element(part.begin(), part.end()), part.end());
    for (std::size_t i = 2; i < part.size(); ++i) boundary.triangles.push_back({part[0], part[i - 1], part[i]});
  }
  // the contour's polygons: their segments, one after the other
  std::map<CapVertex, CapVertex> next;
  for (const auto& [from, to] : segments) next[from] = to;
  add_compact(facet, next, boundary.triangles);
  while (!next.empty()) {
    Part loop;
    for (auto at = next.begin(); at != next.end();) {
      loop.push_back(at->first);
      const CapVertex to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    boundary.parts.push_back(loop);
    if (facet.table != nullptr) continue;
    std::vector<Index> key;
    for (const CapVertex v : loop) key.push_back(static_cast<Index>(v.number()));
    if (const Index centre = numbers_.polygon(key); centre == kNoPoint)
      boundary.triangles.push_back({loop[0], loop[1], loop[2]});
    else
      for (std::size_t i = 0; i < loop.size(); ++i)
        boundary.triangles.push_back({CapVertex::of_contour(centre), loop[i], loop[(i + 1) % loop.size()]});
  }
  return boundary;
}

/// All triangles have the same orientation in the facet, so one side of the contour fixes it.
template <int N>
void ComplexCaps<N>::add_compact(const Facet& facet, const std::map<CapVertex, CapVertex>& next,
                                 std::vector<Triangle>& triangles) const {
  const std::size_t first = triangles.size();
  for (const FaceFillings::Triangle& edges : facet.triangles) {
    Triangle& t = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
      t[i] = on_edge(facet.cell[facet.table->edges[2 * edges[i]]], facet.cell[facet.table->edges[2 * edges[i] + 1]]);
  }
  const auto is_side = [&](CapVertex from, CapVertex to) { return next.at(from) == to; };
  const auto is_reversed = [&](const Triangle& t) {
    return is_side(t[1], t[0]) || is_side(t[2], t[1]) || is_side(t[0], t[2]);
  };
  const auto is_along = [&](const Triangle& t) {
    return is_side(t[0], t[1]) || is_side(t[1], t[2]) || is_side(t[2], t[0]);
  };
  const std::span<Triangle> added = std::span(triangles).subspan(first);
  const auto at_border =
      std::find_if(added.begin(), added.end(), [&](const Triangle& t) { return is_along(t) != is_reversed(t); });
  if (at_border == added.end() || !is_reversed(*at_border)) return;
  for (Triangle& t : added) std::swap(t[1], t[2]);
}

template <int N>
void ComplexCaps<N>::add_regions(const Facet& facet) {
  const Boundary boundary = boundary_of(facet);
  // regions: parts that have vertices in common
  std::map<CapVertex, Index> numbers;
  for (const Part& part : boundary.parts)
    for (const CapVertex v : part) numbers.emplace(v, static_cast<Index>(numbers.size()));
  DisjointSets sets(numbers.size());
  for (const Part& part : boundary.parts)
    for (const CapVertex v : part) sets.join(numbers[part[0]], numbers[v]);
  std::map<Index, Part> regions;
  for (const auto& [v, number] : numbers) regions[sets.find(number)].push_back(v);
  std::map<Index, CapVertex> centres;
  for (const auto& [root, points] : regions) centres[root] = add_mean(points);
  for (const Triangle& triangle : boundary.triangles) {
    // the first vertex may be a polygon's barycentre, which is not in `numbers`
    const CapVertex centre = centres[sets.find(numbers[triangle[1]])];
    if constexpr (N == 4) add_simplex({centre, triangle[0], triangle[1], triangle[2]}, facet.flip);
  }
}

template <int N>
CapVertex ComplexCaps<N>::add_mean(const Part& points) {
  points_.insert(points_.end(), points.begin(), points.end());
  first_point_.push_back(points_.size());
  return CapVertex::added(first_point_.size() - 2);
}

template <int N>
void ComplexCaps<N>::add_simplex(Simplex simplex, bool flip) {
  if (flip) std::swap(simplex[N - 2], simplex[N - 1]);
  simplices_.push_back(simplex);
}

template <int N>
Index ComplexCaps<N>::number(CapVertex vertex) const noexcept {
  if (vertex.is_of_contour()) return static_cast<Index>(vertex.number());
  std::uint64_t number = numbers_.size().vertices;
  if (vertex.is_corner())
    number += static_cast<std::uint64_t>(
        std::lower_bound(corners_.begin(), corners_.end(), static_cast<Index>(vertex.number())) - corners_.begin());
  else
    number += corners_.size() + vertex.number();
  return static_cast<Index>(number);
}

template class ComplexCaps<2>;
template class ComplexCaps<3>;
template class ComplexCaps<4>;

}  // namespace tegl::detail
