// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of complexes of cells: the simplices of the compact contour in a cell are joined to polygons and polyhedra.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/disjoint_sets.hpp"
#include "complex/border_facets.hpp"
#include "complex/contour_numbers.hpp"
#include "facets/complex_facets.hpp"
#include "facets/split_facets.hpp"
#include "polytope/solid_facets.hpp"
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
  /// `ends(a, b)`: whether polygons end at the side from vertex a to b.
  template <class Ends, class Visit>
  void for_each(std::span<const std::array<Index, 3>> triangles, const Ends& ends, const Visit& visit) {
    find_parts(triangles, ends);
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
  template <class Ends>
  void find_parts(std::span<const std::array<Index, 3>> triangles, const Ends& ends) {
    std::vector<std::pair<Side, Index>> sides;  // without direction
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(triangles[i][k], triangles[i][(k + 1) % 3]);
        sides.push_back({{a, b}, static_cast<Index>(i)});
      }
    std::sort(sides.begin(), sides.end());
    parts_.reset(triangles.size());
    for (std::size_t i = 1; i < sides.size(); ++i)
      if (sides[i].first == sides[i - 1].first && !ends(sides[i].first[0], sides[i].first[1]))
        parts_.join(sides[i].second, sides[i - 1].second);
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

/// The 3D facets of a 4D cell, and which of them have vertices of the contour.
class FacetsOfCell {
 public:
  /// The arguments must outlive this object.
  FacetsOfCell(const CellGroups& cells, const VertexKeys& keys) : cells_(cells), keys_(keys) {}

  /// Of a cell, numbered by group, then of the polytopes.
  void set_cell(Index cell) {
    std::size_t g = 0;
    while (g < cells_.groups.size() && cell >= cells_.groups[g].size())
      cell -= static_cast<Index>(cells_.groups[g++].size());
    if (g < cells_.groups.size()) {
      corners_ = {cells_.groups[g].cell(cell), cells_.groups[g].corner_count};
      const auto facets = facets_of(cells_.groups[g].shape);
      clear(facets.size());
      for (std::size_t f = 0; f < facets.size(); ++f)
        for (unsigned i = 0; i < facets[f].corner_count; ++i) add(facets[f].corners[i], f);
      return;
    }
    corners_ = cells_.polytopes.points_of(cell);
    const std::vector<SolidFacet> facets = facets_of_solid(cells_.polytopes.shape(cell));
    clear(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (const std::uint8_t v : facets[f].corners) add(v, f);
  }

  /// Two facets: those at a 2D face, or equal numbers for none.
  using Face = std::array<std::uint16_t, 2>;
  /// The 2D face that has all of up to three vertices. None if one of them is neither on an edge nor at a corner: then
  /// it is inside of a facet or of the cell.
  [[nodiscard]] Face face_of(std::span<const Index> vertices) const noexcept {
    std::array<const std::uint64_t*, 6> rows;
    std::size_t count = 0;
    for (const Index vertex : vertices) {
      const std::size_t corner = vertex - keys_.before_caps;  // of caps
      if (vertex < keys_.edges.size())
        for (const Index end : keys_.edges[vertex]) rows[count++] = row_of(end);
      else if (vertex >= keys_.before_caps && corner < keys_.corners.size())
        rows[count++] = row_of(keys_.corners[corner]);
      else
        return {};
    }
    Face face{};
    std::size_t found = 0;
    for (std::size_t w = 0; w < words_; ++w) {
      std::uint64_t common = ~std::uint64_t{0};
      for (std::size_t r = 0; r < count; ++r) common &= rows[r][w];
      for (; common != 0; common &= common - 1) {
        face[found] = static_cast<std::uint16_t>(64 * w + static_cast<std::size_t>(std::countr_zero(common)));
        if (++found == 2) return face;
      }
    }
    return {};
  }
  [[nodiscard]] static bool is_face(const Face& face) noexcept { return face[0] != face[1]; }

 private:
  void clear(std::size_t facets) {
    words_ = (facets + 63) / 64;
    of_corners_.assign(corners_.size() * words_, 0);
  }
  void add(std::size_t corner, std::size_t facet) noexcept {
    of_corners_[corner * words_ + facet / 64] |= std::uint64_t{1} << (facet % 64);
  }
  [[nodiscard]] const std::uint64_t* row_of(Index point) const noexcept {
    const auto corner = std::find(corners_.begin(), corners_.end(), point) - corners_.begin();
    return of_corners_.data() + static_cast<std::size_t>(corner) * words_;
  }

  const CellGroups& cells_;
  const VertexKeys& keys_;
  std::span<const Index> corners_;
  std::size_t words_ = 0;
  std::vector<std::uint64_t> of_corners_;  ///< by corner: its facets as bits
};

/// The polyhedra of the tetrahedra in a cell, by the polygons around them.
class CellPolyhedra {
 public:
  /// Calls visit(ring, is_first) for the polygons of each polyhedron of consecutive tetrahedra, in the order of their
  /// first tetrahedra. Rings face outwards of the polyhedron. A polygon is in one 3D facet of the cell: it ends at
  /// segments in two facets. Caps also have polygons in 2D faces, which are in two facets.
  template <class Visit>
  void for_each(std::span<const std::array<Index, 4>> tetrahedra, const FacetsOfCell& cell, const Visit& visit) {
    find_border(tetrahedra);
    std::vector<bool> is_done(tetrahedra.size());
    for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
      const Index part = parts_.find(static_cast<Index>(i));
      if (is_done[part]) continue;
      is_done[part] = true;
      bool is_first = true;
      const auto visit_next = [&](std::span<const Index> ring) { visit(ring, std::exchange(is_first, false)); };
      find_faces(part, cell);
      for (std::size_t f = 0; f < faces_.size(); ++f)
        polygons_.for_each(
            faces_[f].second,
            [&](Index a, Index b) { return f == 0 && FacetsOfCell::is_face(cell.face_of(std::array{a, b})); },
            visit_next);
    }
  }

 private:
  using Triangle = std::array<Index, 3>;

  /// The border of a part: the triangles inside of 3D facets, then those in each 2D face.
  void find_faces(Index part, const FacetsOfCell& cell) {
    faces_.assign(1, {});
    for (const auto& [triangle, of] : border_) {
      if (parts_.find(of) != part) continue;
      const FacetsOfCell::Face face = cell.face_of(triangle);
      auto found = std::find_if(faces_.begin(), faces_.end(), [&](const auto& each) { return each.first == face; });
      if (found == faces_.end()) found = faces_.insert(found, {face, {}});
      found->second.push_back(triangle);
    }
  }

  /// Joins tetrahedra with a common triangle; the others are the border, in the order of the tetrahedra.
  void find_border(std::span<const std::array<Index, 4>> tetrahedra) {
    struct Use {
      Triangle sorted;
      std::uint32_t number;  ///< 4 tetrahedron + the vertex opposite to the triangle
    };
    std::vector<Use> uses;
    for (std::uint32_t i = 0; i < 4 * tetrahedra.size(); ++i) {
      Use& use = uses.emplace_back(Use{side(tetrahedra, i), i});
      std::sort(use.sorted.begin(), use.sorted.end());
    }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
      return a.sorted != b.sorted ? a.sorted < b.sorted : a.number < b.number;
    });
    parts_.reset(tetrahedra.size());
    std::vector<std::uint32_t> single;
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      for (j = i + 1; j < uses.size() && uses[j].sorted == uses[i].sorted; ++j)
        parts_.join(uses[i].number / 4, uses[j].number / 4);
      if (j == i + 1) single.push_back(uses[i].number);
    }
    std::sort(single.begin(), single.end());
    border_.clear();
    for (const std::uint32_t number : single) border_.push_back({side(tetrahedra, number), number / 4});
  }
  /// The triangle opposite to a vertex, oriented as in the boundary of the tetrahedron.
  static Triangle side(std::span<const std::array<Index, 4>> tetrahedra, std::uint32_t number) {
    const auto& t = tetrahedra[number / 4];
    constexpr std::uint8_t kSides[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    const auto& of = kSides[number % 4];
    return {t[of[0]], t[of[1]], t[of[2]]};
  }

  DisjointSets parts_;
  std::vector<std::pair<Triangle, Index>> border_;
  std::vector<std::pair<FacetsOfCell::Face, std::vector<Triangle>>> faces_;
  CellPolygons polygons_;
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

/// Segments of 2D contours, or polygons, as rings of vertices, one after the other.
struct Rings {
  std::vector<FacetPlace> places;
  std::vector<std::size_t> ends;
  std::vector<Index> vertices;

  void add(std::span<const Index> ring, const FacetPlace& place) {
    vertices.insert(vertices.end(), ring.begin(), ring.end());
    ends.push_back(vertices.size());
    places.push_back(place);
  }
  [[nodiscard]] std::span<const Index> operator[](std::size_t i) const noexcept {
    const std::size_t from = i == 0 ? 0 : ends[i - 1];
    return std::span(vertices).subspan(from, ends[i] - from);
  }
};

/// Adds the facets of dimension N - 1 in cells to `rings`. `from`: the first simplex of the cells.
template <int N, class Real>
void add_rings(const Contour<N, Real>& contour, const std::vector<CellSimplices>& cells, std::size_t from,
               bool are_caps, Rings& rings) {
  CellPolygons polygons;
  std::size_t at = from;
  for (const CellSimplices& of : cells) {
    std::uint8_t number = 0;
    const auto add = [&](std::span<const Index> ring) {
      rings.add(ring, {of.cell, of.signature, 0, number++, are_caps});
    };
    const std::span simplices(contour.simplices.data() + at, from + of.end - at);
    at = from + of.end;
    if constexpr (N == 2)
      for (const auto& segment : simplices) add(segment);
    else
      polygons.for_each(
          simplices, [](Index, Index) { return false; }, add);
  }
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

/// Gives facets of the next lower dimension the cell of their first facet. They are caps if all their facets are.
template <class Level>
void set_first_cells(const Level& of, Level& below) {
  for (FacetPlace& place : below.places) place.is_cap = true;
  for (std::size_t f = of.places.size(); f-- > 0;)
    for (Index e = of.down_first[f]; e < of.down_first[f + 1]; ++e) {
      FacetPlace& place = below.places[of.down[e]];
      place = {of.places[f].base, of.places[f].signature, 0, 0, place.is_cap && of.places[f].is_cap};
    }
}

/// Segments from the sides of polygons, and the polygons' boundaries. `number`: of points, by vertex.
template <int N, class Real>
void add_segments(const Rings& rings, const std::vector<Index>& number, FacetHierarchy<N, Real>& facets) {
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

/// A polygon in the boundary of a polyhedron.
struct PolygonUse {
  Index polygon;
  std::int8_t sign;
};

/// The polyhedra of a 4D contour, and their polygons, each once.
class Polyhedra {
 public:
  /// `active`, `caps`: the cells of the simplices, and of those of the caps.
  template <class Real>
  Polyhedra(const Contour<4, Real>& contour, const std::vector<CellSimplices>& active,
            const std::vector<CellSimplices>& caps, FacetsOfCell& facets) {
    add(contour, active, 0, false, facets);
    add(contour, caps, active.empty() ? 0 : active.back().end, true, facets);
    number_polygons();
  }

  std::vector<FacetPlace> places;
  std::vector<std::size_t> ends;  ///< by polyhedron: in `uses`
  std::vector<PolygonUse> uses;
  Rings polygons;  ///< in the order and direction of their first uses

 private:
  /// Adds the polyhedra in cells. `from`: the first simplex of the cells.
  template <class Real>
  void add(const Contour<4, Real>& contour, const std::vector<CellSimplices>& cells, std::size_t from, bool are_caps,
           FacetsOfCell& facets) {
    CellPolyhedra in_cell;
    std::size_t at = from;
    for (const CellSimplices& of : cells) {
      facets.set_cell(of.cell);
      std::uint8_t number = 0;
      in_cell.for_each(std::span(contour.simplices.data() + at, from + of.end - at), facets,
                       [&](std::span<const Index> ring, bool is_first) {
                         if (is_first) {
                           places.push_back({of.cell, of.signature, 0, number++, are_caps});
                           ends.push_back(all_.ends.size());
                         }
                         all_.add(ring, {});
                         ends.back() = all_.ends.size();
                       });
      at = from + of.end;
    }
  }

  /// Finds the rings that two polyhedra have in opposite directions.
  void number_polygons() {
    const std::size_t count = all_.ends.size();
    Rings known;  // from the smallest vertex towards its smaller neighbour
    std::vector<std::int8_t> signs(count);
    std::vector<Index> order(count);
    std::vector<Index> ring;
    for (std::size_t i = 0; i < count; ++i) {
      ring.assign(all_[i].begin(), all_[i].end());
      std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
      signs[i] = ring[1] < ring.back() ? std::int8_t{1} : std::int8_t{-1};
      if (signs[i] < 0) std::reverse(ring.begin() + 1, ring.end());
      known.add(ring, {});
      order[i] = static_cast<Index>(i);
    }
    const auto compared = [&](Index a, Index b) {
      return std::lexicographical_compare_three_way(known[a].begin(), known[a].end(), known[b].begin(), known[b].end());
    };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      const auto result = compared(a, b);
      return result != 0 ? result < 0 : a < b;
    });
    std::vector<Index> first(count);  // the first use of the same polygon
    for (std::size_t i = 0; i < count; ++i)
      first[order[i]] = i > 0 && compared(order[i - 1], order[i]) == 0 ? first[order[i - 1]] : order[i];
    std::vector<Index> numbers(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (first[i] == i) {
        numbers[i] = static_cast<Index>(polygons.ends.size());
        polygons.add(all_[i], {});
      }
      uses.push_back({numbers[first[i]], static_cast<std::int8_t>(signs[i] * signs[first[i]])});
    }
  }

  Rings all_;  ///< of all polyhedra
};

/// Adds polyhedra with their boundaries.
template <class Real>
void add_polyhedra(const Polyhedra& from, FacetHierarchy<4, Real>& facets) {
  auto& level = facets.levels[3];
  level.places.resize(from.places.size());
  std::copy(from.places.begin(), from.places.end(), level.places.begin());
  level.down_first.resize(from.ends.size() + 1);
  level.down_first[0] = 0;
  for (std::size_t f = 0; f < from.ends.size(); ++f) level.down_first[f + 1] = static_cast<Index>(from.ends[f]);
  level.down.resize(from.uses.size());
  level.down_signs.resize(from.uses.size());
  for (std::size_t i = 0; i < from.uses.size(); ++i) {
    level.down[i] = from.uses[i].polygon;
    level.down_signs[i] = from.uses[i].sign;
  }
}

/// The vertices that have a point.
std::vector<bool> vertices_of(const Rings& rings, std::size_t count) {
  std::vector<bool> used(count);
  for (const Index v : rings.vertices) used[v] = true;
  return used;
}

/// Facets of 2D and 3D contours.
template <class Real, int N>
FacetHierarchy<N, Real> facets_of_rings(const Complex<N>& complex, double isovalue, const ExtractOptions& options,
                                        Surroundings<N> around) {
  std::vector<CellSimplices> cells, caps;
  around.simplices = &cells;
  around.caps = &caps;
  const Contour<N, Real> contour = extract_in<Real, N>(complex, isovalue, options, around).contour;
  Rings rings;
  add_rings(contour, cells, 0, false, rings);
  add_rings(contour, caps, cells.empty() ? 0 : cells.back().end, true, rings);
  require_incidences(rings.vertices.size());
  FacetHierarchy<N, Real> facets;
  const std::vector<Index> number = take_points(contour, vertices_of(rings, contour.vertices.size()), facets);
  auto& top = facets.levels[N - 1];
  set_places(rings, top);
  if constexpr (N == 2) {
    for (std::size_t i = 0; i < rings.vertices.size(); ++i) {
      top.down[i] = number[rings.vertices[i]];
      top.down_signs[i] = i % 2 == 0 ? std::int8_t{-1} : std::int8_t{1};
    }
  } else {
    add_segments(rings, number, facets);
  }
  return facets;
}

/// Facets of 4D contours.
template <class Real>
FacetHierarchy<4, Real> facets_in_4d(const Complex<4>& complex, double isovalue, const ExtractOptions& options,
                                     Surroundings<4> around) {
  std::vector<CellSimplices> cells, caps;
  VertexKeys keys;
  around.simplices = &cells;
  around.caps = &caps;
  around.keys = &keys;  // so the contour is not separated beside missing values: here facets are
  const Contour<4, Real> contour = extract_in<Real, 4>(complex, isovalue, options, around).contour;
  FacetsOfCell in_cell(ComplexAccess::cells(complex), keys);
  const Polyhedra polyhedra(contour, cells, caps, in_cell);
  require_incidences(std::max(polyhedra.uses.size(), polyhedra.polygons.vertices.size()));
  FacetHierarchy<4, Real> facets;
  const auto number = take_points(contour, vertices_of(polyhedra.polygons, contour.vertices.size()), facets);
  add_polyhedra(polyhedra, facets);
  set_places(polyhedra.polygons, facets.levels[2]);
  set_first_cells(facets.levels[3], facets.levels[2]);
  add_segments(polyhedra.polygons, number, facets);
  return facets;
}

}  // namespace

template <class Real, int N>
FacetHierarchy<N, Real> facets_in(const Complex<N>& complex, double isovalue, const ExtractOptions& options,
                                  const Surroundings<N>& around) {
  ExtractOptions of_contour = options;
  of_contour.triangulation = Triangulation::compact;
  FacetHierarchy<N, Real> facets;
  if constexpr (N == 4)
    facets = facets_in_4d<Real>(complex, isovalue, of_contour, around);
  else
    facets = facets_of_rings<Real>(complex, isovalue, of_contour, around);
  facets.direction = options.direction;
  facets.cells = ComplexAccess::cells(complex).cell_count;
  facets.periods = around.periods;
  set_first_cells(facets.levels[1], facets.levels[0]);
  if (N == 4 && std::any_of(complex.values().begin(), complex.values().end(), [](double v) { return std::isnan(v); }))
    separate_facets(facets, [](const FacetPlace&) { return true; });
  return facets;
}

}  // namespace detail

template <Coordinate Real, int N>
requires DimensionBetween<N, 2, 4> FacetHierarchy<N, Real> extract_facets(const Complex<N>& complex, double isovalue,
                                                                          const ExtractOptions& options) {
  return detail::facets_in<Real, N>(complex, isovalue, options, {});
}

#define TEGL_INSTANTIATE_FACETS(N, Real)                                                                        \
  template FacetHierarchy<N, Real> extract_facets<Real, N>(const Complex<N>&, double, const ExtractOptions&);   \
  template FacetHierarchy<N, Real> detail::facets_in<Real, N>(const Complex<N>&, double, const ExtractOptions&, \
                                                              const Surroundings<N>&);
TEGL_INSTANTIATE_FACETS(2, float)
TEGL_INSTANTIATE_FACETS(2, double)
TEGL_INSTANTIATE_FACETS(3, float)
TEGL_INSTANTIATE_FACETS(3, double)
TEGL_INSTANTIATE_FACETS(4, float)
TEGL_INSTANTIATE_FACETS(4, double)
#undef TEGL_INSTANTIATE_FACETS

}  // namespace tegl
