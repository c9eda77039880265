// SPDX-License-Identifier: BSD-3-Clause
//
// Caps of contours of complexes. The high part of an edge is a segment, that of a polygon one fan or several. The high
// part of a 3D facet is divided into tetrahedra between fans in the polygons around it and the contour's triangles in
// the facet. The fans start at a corner that depends on the numbers of the polygon's corners, so both facets at a
// polygon have the same triangles, and cuts at the times of a mesh have those of the mesh; those of a grid's cubes are
// the image's.
#include "complex/complex_caps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "ambiguity/face_decision.hpp"
#include "ambiguity/lone_pair.hpp"
#include "base/progress.hpp"
#include "complex/cell_cases.hpp"
#include "complex/edge_alpha.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

void add_fan(std::vector<CapVertex> part, std::vector<std::array<CapVertex, 3>>& triangles) {
  add_fan(
      std::move(part), [](CapVertex v) { return v.is_corner() ? static_cast<Index>(v.number()) : kNoPoint; },
      triangles);
}

template <int N>
ComplexCaps<N>::ComplexCaps(const CellGroups& cells, const CellSigns& signs, const BorderFacets& border,
                            std::span<const double> values, double isovalue, const ExtractOptions& options,
                            const ContourNumbers& numbers, const Progress& progress)
    : values_(values),
      isovalue_(isovalue),
      options_(options),
      numbers_(numbers),
      divisions_(options.triangulation,
                 options.ambiguity == Ambiguity::high ? tile::Alternative::high : tile::Alternative::low) {
  const bool descends = options.direction == GradientDirection::descent;
  constexpr std::size_t kStep = std::size_t{1} << 14;  // facets between two reports
  std::vector<Index> first_cell{0};                    // by group, then of the polytopes
  for (const CellGroup& group : cells.groups)
    first_cell.push_back(first_cell.back() + static_cast<Index>(group.size()));
  for (std::size_t i = 0; i < border.size(); ++i) {
    const auto& [g, cell, number] = border[i];
    if (i % kStep == 0) tell(progress, static_cast<double>(i) / static_cast<double>(border.size()));
    is_new_facet_ = true;
    current_ = {first_cell[g] + cell, 0, 0};
    if (g == cells.groups.size()) {
      const std::span<const Index> points = cells.polytopes.points_of(cell);
      if (std::any_of(points.begin(), points.end(), [&](Index p) { return std::isnan(values[p]); })) continue;
      const bool is_inverted = (signs[g][cell >> 6] >> (cell & 63u) & 1u) != 0;
      if (N == 4) {
        const SolidFacet facet = facet_of_solid(cells.polytopes.shape(cell), number);
        const bool flip = (facet.is_inverted != is_inverted) != descends;
        facet.is_tabled() ? add_tabled(facet, points.data(), flip)
                          : add_solid(facet, points.data(), cells.polytopes.entangled_facet(cell, facet), flip);
        continue;
      }
      // seen from outside, rings are counterclockwise; edges of polygons have the polygon on their left
      add_face(facet_points(cells.polytopes, cell, number), (is_inverted != descends) != (N == 3));
      continue;
    }
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
    unsigned signature = 0;
    for (unsigned v = 0; v < group.corner_count; ++v) signature |= (values[corners[v]] >= isovalue ? 1u : 0u) << v;
    current_.signature = static_cast<std::uint16_t>(signature);
    if (const BuiltCells* const built = numbers.cases(g).built()) {
      facet.contour = built->in_facet(number, built->key(signature, corners, values), corners);
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
    static constexpr std::uint8_t kAround[] = {0, 1, 2}, kAroundSquare[] = {0, 1, 3, 2};
    std::vector<Part> parts;
    std::vector<RegionDivision::Triangle> triangles;
    facet.of.corner_count == 3 ? cut(facet, kAround, parts, nullptr) : cut(facet, kAroundSquare, parts, nullptr);
    for (Part& part : parts) add_fan_in(facet, std::move(part), triangles);
    for (const auto& [a, b, c] : triangles)
      add_simplex({vertex(facet, a), vertex(facet, b), vertex(facet, c)}, facet.flip);
  } else {
    add_regions(facet);
  }
}

template <int N>
void ComplexCaps<N>::add_face(const std::vector<Index>& points, bool flip) {
  const std::size_t count = points.size();
  const auto is_high = [&](std::size_t i) { return values_[points[i % count]] >= isovalue_; };
  for (const Index p : points)
    if (values_[p] >= isovalue_) corners_.push_back(p);
  if constexpr (N == 2) {
    const auto at = [&](std::size_t i) {
      return is_high(i) ? CapVertex::corner(points[i]) : on_edge(points[0], points[1]);
    };
    if (is_high(0) || is_high(1)) add_simplex({at(0), at(1)}, flip);
  } else if constexpr (N == 3) {
    std::vector<Simplex> triangles;
    for (auto& run : parts_around(points)) add_fan(std::move(run), triangles);
    for (const Simplex& triangle : triangles) add_simplex(triangle, flip);
  }
}

/// The high parts of a polygon, in its direction: runs of high corners with the points of the contour beside them, one
/// part for all or one for each.
template <int N>
std::vector<std::vector<CapVertex>> ComplexCaps<N>::parts_around(const std::vector<Index>& points) const {
  const std::size_t count = points.size();
  const auto is_high = [&](std::size_t i) { return values_[points[i % count]] >= isovalue_; };
  std::size_t start = 0;
  while (start < count && (is_high(start) || !is_high(start + 1))) ++start;
  std::vector<std::vector<CapVertex>> runs(start == count ? 1 : 0);  // all are high, or none
  for (std::size_t i = start % count, end = i + count; i < end; ++i) {
    if (is_high(i)) runs.back().push_back(CapVertex::corner(points[i % count]));
    if (is_high(i) == is_high(i + 1)) continue;
    if (!is_high(i)) runs.emplace_back();
    runs.back().push_back(on_edge(points[i % count], points[(i + 1) % count]));
  }
  std::vector<double> at;
  for (const Index p : points) at.push_back(values_[p]);
  if (runs.size() > 1 && is_face_high(rules_of(options_, isovalue_), at)) {
    for (std::size_t r = 1; r < runs.size(); ++r) runs[0].insert(runs[0].end(), runs[r].begin(), runs[r].end());
    runs.resize(1);
  }
  return runs;
}

/// A facet of a 4D polytope that other cells have in their tables.
template <int N>
void ComplexCaps<N>::add_tabled(const SolidFacet& facet, const Index* points, bool flip) {
  using tables::CellShape;
  static constexpr CellFacet kKnown[] = {{CellShape::tetrahedron, 4, {0, 1, 2, 3}, false},
                                         {CellShape::pyramid, 5, {0, 1, 2, 3, 4}, false},
                                         {CellShape::wedge, 6, {0, 1, 2, 3, 4, 5}, false},
                                         {CellShape::hexahedron, 8, {0, 1, 2, 3, 4, 5, 6, 7}, false},
                                         {CellShape::octahedron, 6, {0, 1, 2, 3, 4, 5}, false}};
  Facet of{kKnown[static_cast<std::size_t>(facet.kind)], {}, 0, flip};
  const bool is_hexahedron = facet.kind == SolidFacet::Kind::hexahedron;
  for (unsigned v = 0; v < of.of.corner_count; ++v) {
    of.points[v] = points[facet.corners[is_hexahedron ? unsigned{kHexahedronCorners[v]} : v]];
    if (!(values_[of.points[v]] >= isovalue_)) continue;
    of.high |= 1u << v;
    corners_.push_back(of.points[v]);
  }
  if (of.high == 0) return;
  of.contour = decide(of);
  add_facet(of);
}

template <int N>
CapVertex ComplexCaps<N>::on_edge(Index p, Index q) const {
  const std::vector<EdgeEnds>& ends = numbers_.edge_ends();
  const auto found = std::lower_bound(ends.begin(), ends.end(), EdgeEnds{std::min(p, q), std::max(p, q)});
  return CapVertex::of_contour(static_cast<Index>(found - ends.begin()));
}

template <int N>
CapVertex ComplexCaps<N>::vertex(const Facet& facet, unsigned local) const {
  if (local < ShapeVertices::kFirstEdge) return CapVertex::corner(facet.points[local]);
  const std::uint8_t* const ends = table_of(facet.of.shape).edges + 2 * (local - ShapeVertices::kFirstEdge);
  return on_edge(facet.points[ends[0]], facet.points[ends[1]]);
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
                         Segments* segments) const {
  const std::size_t count = around.size();
  const auto is_high = [&](std::size_t i) { return facet.is_high(around[i % count]); };
  const auto edge = [&](std::size_t i) {
    const unsigned e = edge_between(table_of(facet.of.shape), around[i % count], around[(i + 1) % count]);
    return static_cast<Local>(ShapeVertices::kFirstEdge + e);
  };
  const bool is_ambiguous =
      count == 4 && is_high(0) == is_high(2) && is_high(1) == is_high(3) && is_high(0) != is_high(1);
  const auto add_segment = [&](Local from, Local to) {
    if (segments != nullptr) (*segments)[to] = from;
  };
  if (is_ambiguous && !joins(facet, around)) {
    for (std::size_t i = is_high(0) ? 0 : 1; i < 4; i += 2) {
      parts.push_back({edge(i + 3), around[i], edge(i)});
      add_segment(edge(i), edge(i + 3));
    }
    return;
  }
  Part part;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_high(i)) part.push_back(around[i]);
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
void ComplexCaps<N>::add_fan_in(const Facet& facet, Part part, std::vector<RegionDivision::Triangle>& triangles) {
  add_fan(
      std::move(part), [&](Local v) { return v < ShapeVertices::kFirstEdge ? facet.points[v] : kNoPoint; }, triangles);
}

template <int N>
typename ComplexCaps<N>::Boundary ComplexCaps<N>::boundary_of(const Facet& facet) const {
  std::vector<Part> parts;
  Segments next;
  for (Local v = 0; v < next.size(); ++v) next[v] = v;
  for (const CellFacet& face : facets_of(facet.of.shape)) {
    std::array<std::uint8_t, 4> around = {face.corners[0], face.corners[1], face.corners[2], face.corners[3]};
    if (face.corner_count == 4) std::swap(around[2], around[3]);
    if (!face.is_inverted) std::reverse(around.begin(), around.begin() + face.corner_count);
    cut(facet, {around.data(), face.corner_count}, parts, &next);
  }
  Boundary boundary;
  for (Part& part : parts) add_fan_in(facet, std::move(part), boundary.triangles);
  boundary.sides = boundary.triangles.size();
  if (!facet.is_active()) return boundary;
  if (facet.contour.cube)
    add_cube(facet, next, boundary);
  else if (facet.contour.tunnel)
    add_tunnel_centres(facet, boundary);
  else if (facet.contour.is_compact)
    add_compact(facet, next, boundary);
  else
    add_polygons(facet, next, boundary);
  return boundary;
}

template <int N>
void ComplexCaps<N>::add_polygons(const Facet& facet, Segments next, Boundary& to) const {
  for (Local v = ShapeVertices::kFirstEdge; v < ShapeVertices::kFirstCentre; ++v) {
    Part loop;
    std::vector<Index> key;
    for (Local at = v; next[at] != at; at = std::exchange(next[at], at)) {
      loop.push_back(at);
      key.push_back(static_cast<Index>(vertex(facet, at).number()));
    }
    if (loop.empty()) continue;
    const Index centre = numbers_.polygon(key);
    if (centre == kNoPoint) {
      to.triangles.push_back({loop[0], loop[1], loop[2]});
      continue;
    }
    const auto number = static_cast<Local>(ShapeVertices::kFirstCentre + to.centres.size());
    to.centres.push_back(CapVertex::of_contour(centre));
    to.polygons.push_back(loop);
    for (std::size_t i = 0; i < loop.size(); ++i)
      to.triangles.push_back({number, loop[i], loop[(i + 1) % loop.size()]});
  }
}

/// One side of the contour fixes the orientation of all triangles.
template <int N>
void ComplexCaps<N>::add_oriented(const Segments& next, const std::vector<RegionDivision::Triangle>& triangles,
                                  Boundary& to) {
  const auto is_segment = [&](Local start, Local end) { return start < next.size() && next[start] == end; };
  const auto is_along = [&](const auto& t) {
    return is_segment(t[0], t[1]) || is_segment(t[1], t[2]) || is_segment(t[2], t[0]);
  };
  const auto is_reversed = [&](const auto& t) {
    return is_segment(t[1], t[0]) || is_segment(t[2], t[1]) || is_segment(t[0], t[2]);
  };
  const auto at_border =
      std::find_if(triangles.begin(), triangles.end(), [&](const auto& t) { return is_along(t) != is_reversed(t); });
  const bool reverses = at_border != triangles.end() && is_reversed(*at_border);
  for (RegionDivision::Triangle t : triangles) {
    if (reverses) std::swap(t[1], t[2]);
    to.triangles.push_back(t);
  }
}

template <int N>
void ComplexCaps<N>::add_compact(const Facet& facet, const Segments& next, Boundary& to) const {
  std::vector<RegionDivision::Triangle> triangles;
  for (const FaceFillings::Triangle& edges : facet.contour.triangles) {
    auto& t = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) t[i] = static_cast<Local>(ShapeVertices::kFirstEdge + edges[i]);
  }
  add_oriented(next, triangles, to);
}

/// The number of an own vertex of the resolved cube's list in a hexahedron.
template <int N>
Index ComplexCaps<N>::own_of_cube(const Facet& facet, unsigned own) const {
  const ResolvedCubes& cubes = ResolvedCubes::instance(options_.triangulation);
  const auto& [frame, list] = *facet.contour.cube;
  const std::uint32_t mask = cubes.mask(list, own);
  const auto crossing = [&](unsigned p, unsigned q) {
    return static_cast<Index>(on_edge(facet.points[p], facet.points[q]).number());
  };
  CubePoint point{facet.points, 0, 0};
  std::vector<Index> around;
  for (unsigned v = 0; v < 8; ++v) point.mask |= (mask >> v & 1u) << frame.corner(v);
  for (unsigned e = 0; e < 12; ++e) {
    if ((mask >> (8 + e) & 1u) == 0) continue;
    const unsigned base = edge_base(3, e), p = frame.corner(base), q = frame.corner(base | 1u << e / 4);
    point.mask |= 256u << edge_number(3, static_cast<unsigned>(std::countr_zero(p ^ q)), p);
    around.push_back(crossing(p, q));
  }
  if (own < cubes.summary(list).barycentres) return numbers_.polygon(around);
  Index first = kNoPoint;
  for (unsigned e = 0; e < 12; ++e) {
    const unsigned p = edge_base(3, e), q = p | 1u << e / 4;
    if (facet.is_high(p) != facet.is_high(q)) first = std::min(first, crossing(p, q));
  }
  return numbers_.in_cube(point, first);
}

template <int N>
void ComplexCaps<N>::add_cube(const Facet& facet, const Segments& next, Boundary& to) const {
  const ResolvedCubes& cubes = ResolvedCubes::instance(options_.triangulation);
  const auto& [frame, list] = *facet.contour.cube;
  for (unsigned j = 0; j < cubes.own_vertices(list); ++j)
    to.centres.push_back(CapVertex::of_contour(own_of_cube(facet, j)));
  std::vector<RegionDivision::Triangle> triangles;
  const std::span<const std::uint8_t> of = cubes.triangles_of(list);
  for (std::size_t i = 0; i < of.size(); i += 3) {
    auto& t = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned v = of[i + k];
      if (v >= 12) {
        t[k] = static_cast<Local>(ShapeVertices::kFirstCentre + v - 12);
        continue;
      }
      const unsigned base = edge_base(3, v), p = frame.corner(base), q = frame.corner(base | 1u << v / 4);
      t[k] = static_cast<Local>(ShapeVertices::kFirstEdge + edge_between(table_of(facet.of.shape), p, q));
    }
  }
  add_oriented(next, triangles, to);
}

template <int N>
void ComplexCaps<N>::add_tunnel_centres(const Facet& facet, Boundary& to) const {
  const unsigned p = 2 * facet.contour.tunnel->pair;
  const auto around = corners_around(facet.contour.tunnel->pair);
  for (unsigned i = 0; i < 4; ++i) {
    std::vector<Index> quadrilateral;
    for (const unsigned v : {around[i], around[(i + 1) % 4]})
      for (const unsigned end : {p, p + 1})
        quadrilateral.push_back(static_cast<Index>(on_edge(facet.points[end], facet.points[v]).number()));
    to.centres.push_back(CapVertex::of_contour(numbers_.polygon(quadrilateral)));
  }
}

template <int N>
DecidedFacet ComplexCaps<N>::decide(const Facet& facet) const {
  using tables::CellShape;
  DecidedFacet result;
  const bool is_compact = options_.triangulation == Triangulation::compact;
  unsigned variant = options_.ambiguity == Ambiguity::high ? 1 : 0;
  if (is_estimated(options_.ambiguity)) {
    std::array<double, 8> at{};
    for (unsigned v = 0; v < facet.of.corner_count; ++v) at[v] = values_[facet.points[v]];
    const FaceRule rule = face_rule(options_.ambiguity);
    unsigned ambiguous = 0, high = 0;
    const auto quadrilaterals = quadrilaterals_of(facet.of.shape);
    for (unsigned q = 0; q < quadrilaterals.size(); ++q) {
      const auto& [a, b, c, d] = quadrilaterals[q];
      if (!is_ambiguous_square(facet.high, quadrilaterals[q])) continue;
      ambiguous |= 1u << q;
      const std::array<double, 4> square = {at[a], at[b], at[c], at[d]};
      high |= (is_square_high(rule, square, isovalue_) ? 1u : 0u) << q;
    }
    if (facet.of.shape == CellShape::hexahedron) {
      result.cube.emplace(CubeFrame::number_of(facet.points.data()), facet.high, high,
                          cube_key(rule, at, isovalue_, facet.high).choice());
      return result;
    }
    if (const auto pair = lone_pair(facet.high, 3); facet.of.shape == CellShape::octahedron && pair &&
                                                    !rule.separates &&
                                                    has_tunnel_between(*pair, std::span(at).first(6), isovalue_)) {
      result.tunnel = pair;
      return result;
    }
    variant = ResolvedCells::variant(facet.high, ambiguous, high);
  }
  result.is_compact = is_compact && variant < 2;
  if (result.is_compact && facet.is_active()) {
    const FaceFillings fillings(facet.of.shape, variant == 1);
    result.triangles = fillings.triangles(facet.high, fillings.choose(facet.high, facet.points.data()));
  }
  return result;
}

template <int N>
ShapePlaces ComplexCaps<N>::places_of(const Facet& facet, const Boundary& boundary) const {
  const tables::CellTable& table = table_of(facet.of.shape);
  ShapePlaces places(table);
  for (unsigned e = 0; e < table.edge_count; ++e) {
    const Index p = facet.points[table.edges[2 * e]], q = facet.points[table.edges[2 * e + 1]];
    if ((values_[p] >= isovalue_) == (values_[q] >= isovalue_)) continue;
    const double alpha = alpha_of(values_[std::min(p, q)], values_[std::max(p, q)], isovalue_, options_.epsilon);
    places.set_alpha(e, p < q ? alpha : 1 - alpha);
  }
  for (std::size_t i = 0; i < boundary.polygons.size(); ++i)
    places.set_centre(static_cast<unsigned>(ShapeVertices::kFirstCentre + i), boundary.polygons[i]);
  return places;
}

/// Decided hexahedra have the regions of the resolved cube, as images have, if the diagonals in their faces are the
/// same or can be exchanged; others without a tunnel have emitted divisions of their boundary, if these are proved.
template <int N>
const RegionDivision& ComplexCaps<N>::division_of(const Facet& facet, Boundary& boundary) {
  const auto sides = std::span(boundary.triangles).first(boundary.sides);
  const RegionTriangles in_faces(sides.begin(), sides.end());
  const auto& [is_compact, triangles, cube, tunnel] = facet.contour;
  if (tunnel && facet.is_active()) return decided_ = divide_around_tunnel(tunnel->pair, tunnel->is_high, in_faces);
  if (!cube) return divisions_.of(facet.of.shape, std::move(boundary.triangles));
  decided_ = divide_cube(*cube, options_.triangulation, in_faces);
  if (decided_.is_proved || has_tunnel(cube->list)) return decided_;
  const RegionDivision& listed = divisions_.of(facet.of.shape, std::move(boundary.triangles));
  return listed.is_proved ? listed : decided_;
}

template <int N>
void ComplexCaps<N>::add_regions(const Facet& facet) {
  Boundary boundary = boundary_of(facet);
  const RegionDivision& division = division_of(facet, boundary);
  std::array<CapVertex, ShapeVertices::kEnd> vertices;
  for (std::size_t i = 0; i < boundary.centres.size(); ++i)
    vertices[ShapeVertices::kFirstCentre + i] = boundary.centres[i];
  std::uint64_t known = 0;
  const auto at = [&](unsigned v) {
    if (v < ShapeVertices::kFirstCentre && (known >> v & 1u) == 0) vertices[v] = vertex(facet, v);
    known |= std::uint64_t{1} << v;
    return vertices[v];
  };
  for (std::size_t j = 0; j < division.own.size(); ++j) {
    std::vector<CapVertex> points;
    for (std::uint32_t rest = division.own[j]; rest != 0; rest &= rest - 1)
      points.push_back(at(static_cast<unsigned>(std::countr_zero(rest))));
    std::sort(points.begin(), points.end());
    vertices[ShapeVertices::kFirstOwn + j] = add_mean(points);
  }
  for (const RegionDivision::Near& near : division.near)
    between_.push_back({static_cast<std::size_t>(vertices[near.own].number()), facet.points[near.corner],
                        division.weight(near, places_of(facet, boundary))});
  if constexpr (N == 4)
    for (const auto& [a, b, c, d] : division.tetrahedra) add_simplex({at(a), at(b), at(c), at(d)}, facet.flip);
}

template <int N>
CapVertex ComplexCaps<N>::add_mean(std::span<const CapVertex> points) {
  points_.insert(points_.end(), points.begin(), points.end());
  first_point_.push_back(points_.size());
  return CapVertex::added(first_point_.size() - 2);
}

template <int N>
void ComplexCaps<N>::add_simplex(Simplex simplex, bool flip) {
  if (flip) std::swap(simplex[N - 2], simplex[N - 1]);
  simplices_.push_back(simplex);
  if (std::exchange(is_new_facet_, false)) by_facet_.push_back(current_);
  by_facet_.back().end = static_cast<std::uint32_t>(simplices_.size());
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

template <int N>
std::optional<ComplexCaps<N>> find_caps(const Complex<N>& complex, const ContourNumbers& numbers,
                                        const BorderFacets* border, double isovalue, const ExtractOptions& options,
                                        const Progress& progress) {
  if (!options.close) return std::nullopt;
  const CellGroups& cells = ComplexAccess::cells(complex);
  BorderFacets found;
  if (border == nullptr) border = ComplexAccess::border(complex);
  if (border == nullptr) {
    found = find_border(complex.points().size(), cells, {options.work.threads, part_of(progress, 0.0, 0.8)});
    border = &found;
  }
  return std::optional<ComplexCaps<N>>(std::in_place, cells, ComplexAccess::signs(complex), *border, complex.values(),
                                       isovalue, options, numbers, part_of(progress, 0.8, 1.0));
}
template std::optional<ComplexCaps<2>> find_caps<2>(const Complex<2>&, const ContourNumbers&, const BorderFacets*,
                                                    double, const ExtractOptions&, const Progress&);
template std::optional<ComplexCaps<3>> find_caps<3>(const Complex<3>&, const ContourNumbers&, const BorderFacets*,
                                                    double, const ExtractOptions&, const Progress&);
template std::optional<ComplexCaps<4>> find_caps<4>(const Complex<4>&, const ContourNumbers&, const BorderFacets*,
                                                    double, const ExtractOptions&, const Progress&);

template class ComplexCaps<2>;
template class ComplexCaps<3>;
template class ComplexCaps<4>;

}  // namespace tegl::detail
