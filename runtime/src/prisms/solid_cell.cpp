// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the contour of a 4D polytope: the contours in its facets, and the filling of its inside.
#include "prisms/solid_cell.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "ambiguity/face_decision.hpp"
#include "regions/facet_regions.hpp"
#include "regions/oriented_tetrahedra.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/tile/corners.hpp"
#include "tegl/tile/diagonal_edges.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

namespace {

Triangulation triangulation_of(const PolytopeRules& rules) noexcept {
  return rules.is_compact ? Triangulation::compact : Triangulation::barycentric;
}

}  // namespace

std::optional<std::size_t> fan_of_loop(const PolytopeRules& rules, const SolidFacet& facet,
                                       std::span<const std::uint8_t> loop, const Index* points) {
  if (loop.size() == 3) return 0;
  if (!rules.is_compact) return std::nullopt;
  std::size_t start = 0;
  if (facet.kind == SolidFacet::Kind::end)
    return find_fan(facet.shape, loop, start) ? std::optional(start) : std::nullopt;
  const auto ends = [&](std::size_t i) -> std::pair<Index, Index> {
    const auto& [a, b] = facet.shape.edges()[loop[i]];
    return std::minmax(points[facet.corners[a]], points[facet.corners[b]]);
  };
  std::optional<std::size_t> best;
  for (; find_fan(facet.shape, loop, start); ++start)
    if (!best || ends(start) < ends(*best)) best = start;
  return best;
}

SolidCell::SolidCell(const PolytopeRules& rules)
    : rules_(rules),
      fillings_(tables::CellShape::hexahedron, rules.joins_high),
      cubes_(ResolvedCubes::instance(triangulation_of(rules))),
      regions_of_(CubeRegions::instance(triangulation_of(rules))) {}

void SolidCell::load(const PolytopeFaces& shape) {
  shape_ = &shape;
  facets_ = facets_of_solid(shape);
  is_in_facet_.assign(facets_.size() * shape.edges().size(), false);
  for (std::size_t f = 0; f < facets_.size(); ++f)
    for (const std::uint16_t e : facets_[f].edges) is_in_facet_[f * shape.edges().size() + e] = true;
}

void SolidCell::build(const PolytopeFaces& shape, const Index* points, const double* values, EntangledSolid entangled) {
  if (&shape != shape_) load(shape);
  points_ = points;
  values_ = values;
  entangled_ = std::move(entangled);
  sigma_.clear();
  tetrahedra_.clear();
  for (auto* const inner : {&shared_, &cones_, &sides_, &collars_}) inner->clear();
  contours_.assign(facets_.size(), std::nullopt);
  tunnels_.assign(facets_.size(), std::nullopt);
  for (std::size_t f = 0; f < facets_.size(); ++f) add_contour(f);
  first_cone_ = static_cast<Local>(first_shared() + shared_.size());
  Components components = components_of(sigma_, first_cone_);
  first_corner_ = static_cast<Local>(first_cone_ + components.size());  // one cone for each at most
  if (std::any_of(components.begin(), components.end(), [](const auto& c) { return !is_sphere(c.second); }))
    copy_regions(rules_.rule.has_value() || !rules_.joins_high, components);
  for (const auto& [root, component] : components) add_sphere(component, vertices_of(component));
}

void SolidCell::add_contour(std::size_t f) {
  const SolidFacet& facet = facets_[f];
  std::array<double, 2 * kPolytopeCorners> at;
  std::size_t high = 0;
  for (std::size_t v = 0; v < facet.corners.size(); ++v) {
    at[v] = values_[facet.corners[v]];
    high += at[v] >= rules_.isovalue ? 1 : 0;
  }
  if (high == 0 || high == facet.corners.size()) return;
  if (facet.kind == SolidFacet::Kind::hexahedron && (rules_.is_compact || rules_.rule)) {
    unsigned signature = 0;
    for (unsigned v = 0; v < 8; ++v) signature |= (at[kHexahedronCorners[v]] >= rules_.isovalue ? 1u : 0u) << v;
    return rules_.rule ? add_cube(f, signature) : add_filling(f, signature);
  }
  const auto tunnel = tunnel_in(f, {at.data(), facet.corners.size()});
  loops_.for_each(facet.shape, at.data(), rules_, [&](std::span<const std::uint8_t> loop) {
    if (!tunnel)
      add_loop(f, loop);
    else if (!tunnels_[f])  // the ring begins at the first one of both loops
      add_tunnel(f, *tunnel, loop);
  });
}

/// The pair of opposite corners that a tunnel connects in an octahedron that is decided from the data.
std::optional<LonePair> SolidCell::tunnel_in(std::size_t f, std::span<const double> values) const noexcept {
  if (facets_[f].kind != SolidFacet::Kind::octahedron || !rules_.rule || rules_.rule->separates) return std::nullopt;
  unsigned signature = 0;
  for (unsigned v = 0; v < 6; ++v) signature |= (values[v] >= rules_.isovalue ? 1u : 0u) << v;
  const auto pair = lone_pair(signature, 3);
  return pair && has_tunnel_between(*pair, values, rules_.isovalue) ? pair : std::nullopt;
}

/// The vertex on the edge between two corners of a facet.
SolidCell::Local SolidCell::in_facet(std::size_t f, std::uint8_t a, std::uint8_t b) const noexcept {
  const std::array<std::uint8_t, 2> ends = {std::min(a, b), std::max(a, b)};
  const auto& edges = facets_[f].shape.edges();
  return facets_[f].edges[static_cast<std::size_t>(std::find(edges.begin(), edges.end(), ends) - edges.begin())];
}

/// The ring of four quadrilaterals between the loops around two opposite corners of an octahedron, each coned from its
/// barycentre. `loop`: around one of the corners.
void SolidCell::add_tunnel(std::size_t f, const LonePair& pair, std::span<const std::uint8_t> loop) {
  tunnels_[f] = {pair, static_cast<Local>(first_shared() + shared_.size())};
  const auto& edges = facets_[f].shape.edges();
  const auto is_lone = [&](std::uint8_t v) { return v / 2u == pair.pair; };
  const std::uint8_t near = is_lone(edges[loop[0]][0]) ? edges[loop[0]][0] : edges[loop[0]][1];
  const auto far = static_cast<std::uint8_t>(near ^ 1u);
  const auto beside = [&](std::size_t i) -> std::uint8_t {  // the end of an edge of the loop between both corners
    const auto& [a, b] = edges[loop[i % loop.size()]];
    return a == near ? b : a;
  };
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::uint8_t from = beside(i), to = beside(i + 1);
    const auto centre = static_cast<Local>(first_shared() + shared_.size());
    Inner& inner = shared_.emplace_back();
    inner.facet = static_cast<std::uint16_t>(f);
    inner.points = {in_facet(f, near, from), in_facet(f, near, to), in_facet(f, far, to), in_facet(f, far, from)};
    for (std::size_t k = 0; k < 4; ++k) sigma_.push_back({{centre, inner.points[k], inner.points[(k + 1) % 4]}, f});
  }
}

void SolidCell::add_loop(std::size_t f, std::span<const std::uint8_t> loop) {
  const SolidFacet& facet = facets_[f];
  const std::size_t size = loop.size();
  const auto vertex = [&](std::size_t i) { return Local{facet.edges[loop[i % size]]}; };
  const bool is_coned = entangled_.is_coned && entangled_.is_coned(facet, loop);
  if (const auto start = fan_of_loop(rules_, facet, loop, points_); start && !is_coned) {
    for (std::size_t i = 1; i + 1 < size; ++i)
      sigma_.push_back({{vertex(*start), vertex(*start + i), vertex(*start + i + 1)}, f});
    return;
  }
  const auto centre = static_cast<Local>(first_shared() + shared_.size());
  Inner& inner = shared_.emplace_back();
  inner.facet = static_cast<std::uint16_t>(f);
  for (std::size_t i = 0; i < size; ++i) {
    inner.points.push_back(vertex(i));
    sigma_.push_back({{centre, vertex(i), vertex(i + 1)}, f});
  }
}

/// The vertex on the edge between two corners of a hexahedron, as the tables number them.
SolidCell::Local SolidCell::on_edge(std::size_t f, unsigned p, unsigned q) const noexcept {
  return in_facet(f, kHexahedronCorners[p], kHexahedronCorners[q]);
}

SolidCell::Local SolidCell::corner_of(std::size_t f, unsigned v) const noexcept {
  return static_cast<Local>(first_corner_ + facets_[f].corners[kHexahedronCorners[v]]);
}

/// The compact contour in a hexahedron by a fixed rule.
void SolidCell::add_filling(std::size_t f, unsigned signature) {
  const tables::CellTable& table = tables::cell_table(tables::CellShape::hexahedron, Triangulation::compact);
  std::array<Index, 8> points;
  for (unsigned v = 0; v < 8; ++v) points[v] = points_[facets_[f].corners[kHexahedronCorners[v]]];
  const auto vertex = [&](unsigned e) { return on_edge(f, table.edges[2 * e], table.edges[2 * e + 1]); };
  for (const auto& t : fillings_.triangles(signature, fillings_.choose(signature, points.data())))
    sigma_.push_back({{vertex(t[0]), vertex(t[1]), vertex(t[2])}, f});
}

/// The corners and edges in a set of a frame's corners (bit v) and edges (bit 8 + e).
std::vector<SolidCell::Local> SolidCell::points_of(std::size_t f, const CubeFrame& frame, std::uint32_t mask) const {
  std::vector<Local> points;
  for (unsigned v = 0; v < 8; ++v)
    if ((mask >> v & 1u) != 0) points.push_back(corner_of(f, frame.corner(v)));
  for (unsigned e = 0; e < 12; ++e) {
    const unsigned base = edge_base(3, e);
    if ((mask >> (8 + e) & 1u) != 0) points.push_back(on_edge(f, frame.corner(base), frame.corner(base | 1u << e / 4)));
  }
  return points;
}

/// The contour in a hexahedron whose ambiguities are decided from the data.
void SolidCell::add_cube(std::size_t f, unsigned signature) {
  std::array<double, 8> at;
  std::array<Index, 8> points;
  for (unsigned v = 0; v < 8; ++v) {
    const std::uint8_t corner = facets_[f].corners[kHexahedronCorners[v]];
    at[v] = values_[corner];
    points[v] = points_[corner];
  }
  const CubeFrame frame = CubeFrame::of_number(CubeFrame::number_of(points.data()));
  unsigned squares = 0;  // those that are high, in the frame
  for (unsigned q = 0; q < 6; ++q) {
    std::array<double, 4> square;
    unsigned bits = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const unsigned v = kSquareCorners[frame.square(q)][i];
      square[i] = at[v];
      bits |= (signature >> v & 1u) << i;
    }
    if (bits == 6 || bits == 9) squares |= (is_square_high(*rules_.rule, square, rules_.isovalue) ? 1u : 0u) << q;
  }
  const tile::Choice choice = cube_key(*rules_.rule, at, rules_.isovalue, signature).choice();
  const CubeContour& of =
      contours_[f].emplace(CubeContour{frame, ResolvedCubes::list(frame.signature(signature), squares, choice),
                                       static_cast<Local>(first_shared() + shared_.size())});
  for (unsigned j = 0; j < cubes_.own_vertices(of.list); ++j) {
    const std::uint32_t mask = cubes_.mask(of.list, j);
    Inner& inner = shared_.emplace_back();
    inner.facet = static_cast<std::uint16_t>(f);
    inner.is_in_cube = j >= cubes_.summary(of.list).barycentres;
    if (!inner.is_in_cube) inner.points = points_of(f, frame, mask);
    for (unsigned e = 0; e < 12 && inner.is_in_cube; ++e) {
      const unsigned p = edge_base(3, e), q = p | 1u << e / 4;
      if (((signature >> p ^ signature >> q) & 1u) != 0) inner.points.push_back(on_edge(f, p, q));
    }
    for (unsigned v = 0; v < 8; ++v) inner.mask |= (mask >> v & 1u) << frame.corner(v);
    for (unsigned e = 0; e < 12; ++e) {
      const unsigned base = edge_base(3, e), p = frame.corner(base), q = frame.corner(base | 1u << e / 4);
      const auto axis = static_cast<unsigned>(std::countr_zero(p ^ q));
      inner.mask |= (mask >> (8 + e) & 1u) << (8 + edge_number(3, axis, p));
    }
  }
  const std::span<const std::uint8_t> triangles = cubes_.triangles_of(of.list);
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned v = triangles[i + k];
      const unsigned base = edge_base(3, v % 12);
      t[k] = v < 12 ? on_edge(f, frame.corner(base), frame.corner(base | 1u << v / 4))
                    : static_cast<Local>(of.first_own + v - 12);
    }
    if (frame.is_mirrored()) std::swap(t[1], t[2]);
    sigma_.push_back({t, f});
  }
}

bool SolidCell::is_in_facet(Local edge, std::size_t f) const noexcept {
  return is_in_facet_[f * shape_->edges().size() + edge];
}

/// The vertex of a sphere that its cone starts at; kNone: its barycentre.
SolidCell::Local SolidCell::apex_of(const Component& component, const std::vector<Local>& vertices) {
  if ((!rules_.is_compact || entangled_.is_one) && component.size() > 4) return kNone;
  around_.assign(first_cone_, 0);
  for (const Piece& piece : component)
    for (const Local v : piece.triangle) ++around_[v];
  Local apex = kNone;
  unsigned most = 0;  // triangles at the apex, which need no tetrahedra
  for (const Local v : vertices) {
    if (v >= first_shared()) break;
    if (around_[v] <= most) continue;
    const bool is_apex =
        component.size() == 4 || std::all_of(component.begin(), component.end(), [&](const Piece& piece) {
          return has_vertex(piece.triangle, v) || !is_in_facet(v, piece.facet);
        });
    if (is_apex) apex = v, most = around_[v];
  }
  return apex;
}

/// The tetrahedron between a triangle and a vertex inside the cell, with its positive side towards high.
SolidCell::Tetrahedron SolidCell::cone_of(const Piece& piece, Local apex) const noexcept {
  return detail::cone_of(piece.triangle, facets_[piece.facet].is_inverted, apex);
}

void SolidCell::add_sphere(const Component& component, const std::vector<Local>& vertices) {
  Local apex = apex_of(component, vertices);
  const bool is_inside = apex == kNone;
  if (is_inside) {
    apex = static_cast<Local>(first_cone_ + cones_.size());
    std::vector<Local>& points = cones_.emplace_back().points;
    std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(points),
                 [this](Local v) { return v < first_shared(); });
  }
  for (const Piece& piece : component)
    if (is_inside || !has_vertex(piece.triangle, apex)) tetrahedra_.push_back(cone_of(piece, apex));
}

}  // namespace tegl::detail
