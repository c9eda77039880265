// SPDX-License-Identifier: BSD-3-Clause
//
// Lists and chooses the compact contours of 3D faces.
#include "complex/face_fillings.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "complex/border_facets.hpp"
#include "complex/cell_contour.hpp"
#include "regions/cube_frame.hpp"
#include "regions/shape_volumes.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::detail {

namespace {

using tables::CellShape;
using Cycle = std::vector<std::uint8_t>;

/// Triangles in an order that does not depend on how they were listed; each starts at its smallest edge.
std::vector<FaceFillings::Triangle> sorted(std::vector<FaceFillings::Triangle> triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// The number of a filling among those found so far; adds it if it is new.
std::uint8_t number_of(std::vector<FaceFillings::Triangle> filling,
                       std::vector<std::vector<FaceFillings::Triangle>>& fillings) {
  filling = sorted(std::move(filling));
  const auto at = std::find(fillings.begin(), fillings.end(), filling);
  const auto number = static_cast<std::uint8_t>(at - fillings.begin());
  if (at == fillings.end()) fillings.push_back(std::move(filling));
  return number;
}

/// The outlines of discs of triangles, along their orientation.
std::vector<Cycle> outlines_of(const std::vector<FaceFillings::Triangle>& triangles) {
  std::map<std::uint8_t, std::uint8_t> next;
  const auto has_side = [&](std::uint8_t from, std::uint8_t to) {
    return std::any_of(triangles.begin(), triangles.end(), [&](const auto& t) {
      return (t[0] == from && t[1] == to) || (t[1] == from && t[2] == to) || (t[2] == from && t[0] == to);
    });
  };
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i)
      if (!has_side(t[(i + 1) % 3], t[i])) next[t[i]] = t[(i + 1) % 3];
  std::vector<Cycle> cycles;
  while (!next.empty()) {
    Cycle& cycle = cycles.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      cycle.push_back(at->first);
      const std::uint8_t to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  }
  return cycles;
}

/// The ends of an edge as numbers, the smaller one first.
std::pair<Index, Index> ends_of(const tables::CellTable& table, unsigned edge, const Index* corners) noexcept {
  return std::minmax(Index{corners[table.edges[2 * edge]]}, Index{corners[table.edges[2 * edge + 1]]});
}

}  // namespace

FaceFillings::FaceFillings(CellShape shape, bool high_connected)
    : shape_(shape), table_(tables::cell_table(shape, Triangulation::compact)) {
  for (const CellFacet& facet : facets_of(shape)) {
    std::uint8_t& corners = polygons_.emplace_back();
    for (unsigned v = 0; v < facet.corner_count; ++v)
      corners = static_cast<std::uint8_t>(corners | 1u << facet.corners[v]);
  }
  cases_.resize(std::size_t{1} << table_.corner_count);
  for (unsigned s = 0; s < cases_.size(); ++s) {
    const Triangles table = of_table(s, high_connected);
    if (shape == CellShape::hexahedron)
      add_frames(s, high_connected, cases_[s]);
    else
      add_fans(table, cases_[s]);
    cases_[s].own = number_of(table, cases_[s].fillings);
  }
}

FaceFillings::Triangles FaceFillings::of_table(unsigned signature, bool high_connected) const {
  const CellContour contour(table_, signature, high_connected);
  Triangles triangles;
  for (unsigned i = 0; i < contour.list().simplex_count; ++i) {
    Triangle& t = triangles.emplace_back();
    for (unsigned k = 0; k < 3; ++k) t[k] = static_cast<std::uint8_t>(contour.vertex(i, k));
    if (contour.reverses()) std::swap(t[1], t[2]);
  }
  return triangles;
}

bool FaceFillings::share_a_polygon(unsigned edge, unsigned other) const noexcept {
  unsigned corners = 0;
  for (const unsigned e : {edge, other}) corners |= 1u << table_.edges[2 * e] | 1u << table_.edges[2 * e + 1];
  return std::any_of(polygons_.begin(), polygons_.end(), [&](unsigned polygon) { return (corners & ~polygon) == 0; });
}

void FaceFillings::add_fans(const Triangles& table, Case& to) const {
  to.fillings = {{}};
  for (const Cycle& cycle : outlines_of(table)) {
    Polygon polygon{{}, {}, static_cast<std::uint8_t>(to.fillings.size())};
    std::vector<Triangles> fans;
    const std::size_t size = cycle.size();
    for (std::size_t a = 0; a < size; ++a) {
      bool is_allowed = true;
      Triangles fan;
      for (std::size_t i = 1; i + 1 < size; ++i) {
        fan.push_back({cycle[a], cycle[(a + i) % size], cycle[(a + i + 1) % size]});
        is_allowed = is_allowed && (i == 1 || !share_a_polygon(cycle[a], cycle[(a + i) % size]));
      }
      if (!is_allowed) continue;
      polygon.apexes.push_back(cycle[a]);
      polygon.choices.push_back(number_of(std::move(fan), fans));
    }
    std::vector<Triangles> all;
    for (const Triangles& fan : fans)
      for (const Triangles& before : to.fillings) {
        Triangles& both = all.emplace_back(before);
        both.insert(both.end(), fan.begin(), fan.end());
      }
    to.fillings = std::move(all);
    if (fans.size() > 1) to.polygons.push_back(std::move(polygon));
  }
  for (Triangles& filling : to.fillings) filling = sorted(std::move(filling));
}

void FaceFillings::add_frames(unsigned signature, bool high_connected, Case& to) const {
  for (unsigned f = 0; f < CubeFrame::kCount; ++f) {
    const CubeFrame frame = CubeFrame::of_number(f);
    Triangles triangles = of_table(frame.signature(signature), high_connected);
    for (Triangle& t : triangles) {
      for (std::uint8_t& e : t)
        e = edge_between(table_, frame.corner(table_.edges[2 * e]), frame.corner(table_.edges[2 * e + 1]));
      if (frame.is_mirrored()) std::swap(t[1], t[2]);
    }
    to.of_frames.push_back(number_of(std::move(triangles), to.fillings));
  }
}

std::uint8_t FaceFillings::choose(unsigned signature, const Index* corners) const noexcept {
  const Case& of = cases_[signature];
  if (of.fillings.size() == 1) return 0;
  if (shape_ == CellShape::hexahedron) return of.of_frames[CubeFrame::number_of(corners)];
  unsigned number = 0;
  for (const Polygon& polygon : of.polygons) {
    const auto smallest = std::min_element(polygon.apexes.begin(), polygon.apexes.end(), [&](unsigned a, unsigned b) {
      return ends_of(table_, a, corners) < ends_of(table_, b, corners);
    });
    number += unsigned{polygon.weight} * polygon.choices[static_cast<std::size_t>(smallest - polygon.apexes.begin())];
  }
  return static_cast<std::uint8_t>(number);
}

}  // namespace tegl::detail
