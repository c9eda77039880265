// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of complexes of cells: the simplices of the compact contour in a cell are joined to polygons.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/disjoint_sets.hpp"
#include "complex/contour_numbers.hpp"
#include "complex/point_gradients.hpp"
#include "tegl/error.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl {

namespace detail {

namespace {

using Side = std::array<Index, 2>;

/// The polygons of the triangles in a cell, as rings of vertices.
class CellPolygons {
 public:
  /// Calls visit(ring) for each polygon of consecutive triangles, in the order of their first triangles. Triangles that
  /// are connected and form a disc are one polygon, without the vertices inside; others are polygons by themselves.
  template <class Visit>
  void for_each(std::span<const std::array<Index, 3>> triangles, const Visit& visit) {
    find_parts(triangles);
    std::vector<bool> is_done(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (is_done[i]) continue;
      part_.clear();
      for (std::size_t k = i; k < triangles.size(); ++k)
        if (parts_.find(static_cast<Index>(k)) == parts_.find(static_cast<Index>(i))) {
          part_.push_back(triangles[k]);
          is_done[k] = true;
        }
      if (find_ring()) {
        visit(std::span<const Index>(ring_));
        continue;
      }
      for (const auto& t : part_) visit(std::span<const Index>(t));
    }
  }

 private:
  void find_parts(std::span<const std::array<Index, 3>> triangles) {
    std::vector<std::pair<Side, Index>> sides;  // without direction
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(triangles[i][k], triangles[i][(k + 1) % 3]);
        sides.push_back({{a, b}, static_cast<Index>(i)});
      }
    std::sort(sides.begin(), sides.end());
    parts_.reset(triangles.size());
    for (std::size_t i = 1; i < sides.size(); ++i)
      if (sides[i].first == sides[i - 1].first) parts_.join(sides[i].second, sides[i - 1].second);
  }

  /// The boundary of a part, from the end of its first triangle's first side; false if the part is no disc.
  bool find_ring() {
    std::vector<Side> sides, border;
    std::vector<Index> vertices;
    for (const auto& t : part_)
      for (std::size_t k = 0; k < 3; ++k) {
        sides.push_back({t[k], t[(k + 1) % 3]});
        vertices.push_back(t[k]);
      }
    std::sort(sides.begin(), sides.end());
    for (const auto& [a, b] : sides)
      if (!std::binary_search(sides.begin(), sides.end(), Side{b, a})) border.push_back({a, b});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    // V - E + F = 1, each inner side in two triangles
    const std::size_t edges = (sides.size() + border.size()) / 2;
    if (border.empty() || vertices.size() + part_.size() != edges + 1) return false;
    ring_.assign(1, border[0][0]);
    for (Index at = border[0][1]; at != ring_[0];) {
      ring_.push_back(at);
      const auto next = std::lower_bound(border.begin(), border.end(), Side{at, 0});
      if (next == border.end() || (*next)[0] != at || ring_.size() > border.size()) return false;
      at = (*next)[1];
    }
    return ring_.size() == border.size();
  }

  DisjointSets parts_;
  std::vector<std::array<Index, 3>> part_;
  std::vector<Index> ring_;
};

/// Sets the points of a hierarchy, and numbers the vertices that have one. `used`: by vertex of the contour.
template <int N, class Real>
std::vector<Index> take_points(const Contour<N, Real>& contour, const std::vector<bool>& used,
                               FacetHierarchy<N, Real>& facets) {
  std::vector<Index> number(used.size());
  Index count = 0;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) number[v] = count++;
  facets.vertices.resize(count);
  facets.normals.resize(contour.normals.empty() ? 0 : count);
  facets.levels[0].places.resize(count);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    facets.vertices[number[v]] = contour.vertices[v];
    if (!contour.normals.empty()) facets.normals[number[v]] = contour.normals[v];
  }
  return number;
}

void require_incidences(std::size_t count) {
  if (count >= std::numeric_limits<Index>::max())
    throw Error(ErrorCode::TooLarge,
                fmt::format("{} incidences of facets; expected at most {}", count, std::numeric_limits<Index>::max()));
}

/// The facets of dimension N - 1 of a contour, as rings of its vertices, one after the other.
struct Rings {
  std::vector<FacetPlace> places;
  std::vector<std::size_t> ends;
  std::vector<Index> vertices;
};

template <int N, class Real>
Rings rings_of(const Contour<N, Real>& contour, const std::vector<CellSimplices>& cells) {
  Rings rings;
  CellPolygons polygons;
  std::size_t from = 0;
  for (const auto& [cell, signature, end] : cells) {
    std::uint8_t number = 0;
    const auto add = [&](std::span<const Index> ring) {
      rings.vertices.insert(rings.vertices.end(), ring.begin(), ring.end());
      rings.ends.push_back(rings.vertices.size());
      rings.places.push_back({cell, signature, 0, number++, false});
    };
    const std::span simplices(contour.simplices.data() + from, end - from);
    from = end;
    if constexpr (N == 2)
      for (const auto& segment : simplices) add(segment);
    else
      polygons.for_each(simplices, add);
  }
  return rings;
}

template <class Level>
void set_places(const Rings& rings, Level& level) {
  level.places.resize(rings.places.size());
  std::copy(rings.places.begin(), rings.places.end(), level.places.begin());
  level.down_first.resize(rings.ends.size() + 1);
  level.down_first[0] = 0;
  for (std::size_t f = 0; f < rings.ends.size(); ++f) level.down_first[f + 1] = static_cast<Index>(rings.ends[f]);
  level.down.resize(rings.vertices.size());
  level.down_signs.resize(rings.vertices.size());
}

/// Gives facets of the next lower dimension the cell of their first facet.
template <class Level>
void set_first_cells(const Level& of, Level& below) {
  for (std::size_t f = of.places.size(); f-- > 0;)
    for (Index e = of.down_first[f]; e < of.down_first[f + 1]; ++e)
      below.places[of.down[e]] = {of.places[f].base, of.places[f].signature, 0, 0, false};
}

/// Segments from the sides of polygons, and the polygons' boundaries. `number`: of points, by vertex.
template <class Real>
void add_segments(const Rings& rings, const std::vector<Index>& number, FacetHierarchy<3, Real>& facets) {
  std::vector<Side> sides;
  const auto for_each_side = [&](const auto& visit) {
    std::size_t from = 0;
    for (const std::size_t end : rings.ends) {
      for (std::size_t i = from; i < end; ++i)
        visit(i, number[rings.vertices[i]], number[rings.vertices[i + 1 < end ? i + 1 : from]]);
      from = end;
    }
  };
  for_each_side([&](std::size_t, Index a, Index b) { sides.push_back({std::min(a, b), std::max(a, b)}); });
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  require_incidences(2 * sides.size());
  auto& segments = facets.levels[1];
  auto& polygons = facets.levels[2];
  segments.places.resize(sides.size());
  segments.down_first.resize(sides.size() + 1);
  segments.down.resize(2 * sides.size());
  segments.down_signs.resize(2 * sides.size());
  for (std::size_t s = 0; s <= sides.size(); ++s) segments.down_first[s] = static_cast<Index>(2 * s);
  for (std::size_t s = 0; s < sides.size(); ++s)
    for (std::size_t k = 0; k < 2; ++k) {
      segments.down[2 * s + k] = sides[s][k];
      segments.down_signs[2 * s + k] = k == 0 ? std::int8_t{-1} : std::int8_t{1};
    }
  for_each_side([&](std::size_t i, Index a, Index b) {
    const auto found = std::lower_bound(sides.begin(), sides.end(), Side{std::min(a, b), std::max(a, b)});
    polygons.down[i] = static_cast<Index>(found - sides.begin());
    polygons.down_signs[i] = a < b ? std::int8_t{1} : std::int8_t{-1};
  });
  set_first_cells(polygons, segments);
}

}  // namespace

}  // namespace detail

template <Coordinate Real, int N>
requires DimensionBetween<N, 2, 3> FacetHierarchy<N, Real> extract_facets(const Complex<N>& complex, double isovalue,
                                                                          const ExtractOptions& options) {
  if (options.close)
    throw Error(ErrorCode::InvalidArgument,
                "close of facets in cells of a mesh; expected a contour that is not closed");
  ExtractOptions of_contour = options;
  of_contour.triangulation = Triangulation::compact;
  std::vector<detail::CellSimplices> cells;
  detail::Surroundings<N> around;
  around.simplices = &cells;
  const Contour<N, Real> contour = detail::extract_in<Real, N>(complex, isovalue, of_contour, around).contour;
  const detail::Rings rings = detail::rings_of(contour, cells);
  detail::require_incidences(rings.vertices.size());
  FacetHierarchy<N, Real> facets;
  facets.direction = contour.direction;
  facets.cells = detail::ComplexAccess::cells(complex).cell_count;
  std::vector<bool> used(contour.vertices.size());
  for (const Index v : rings.vertices) used[v] = true;
  const std::vector<Index> number = detail::take_points(contour, used, facets);
  auto& top = facets.levels[N - 1];
  detail::set_places(rings, top);
  if constexpr (N == 2) {
    for (std::size_t i = 0; i < rings.vertices.size(); ++i) {
      top.down[i] = number[rings.vertices[i]];
      top.down_signs[i] = i % 2 == 0 ? std::int8_t{-1} : std::int8_t{1};
    }
  } else {
    detail::add_segments(rings, number, facets);
  }
  detail::set_first_cells(facets.levels[1], facets.levels[0]);
  return facets;
}

#define TEGL_INSTANTIATE_FACETS(N, Real) \
  template FacetHierarchy<N, Real> extract_facets<Real, N>(const Complex<N>&, double, const ExtractOptions&);
TEGL_INSTANTIATE_FACETS(2, float)
TEGL_INSTANTIATE_FACETS(2, double)
TEGL_INSTANTIATE_FACETS(3, float)
TEGL_INSTANTIATE_FACETS(3, double)
#undef TEGL_INSTANTIATE_FACETS

}  // namespace tegl
