// SPDX-License-Identifier: BSD-3-Clause
//
// Fills components of Sigma with copies of the regions beside them. A region of a facet is a cone, as each of its
// polygons is a disc; in a hexahedron with a tunnel it is the table's (CubeRegions), around a tunnel in an octahedron a
// ring of cones.
#include <algorithm>
#include <iterator>
#include <utility>

#include "prisms/solid_cell.hpp"
#include "regions/decided_regions.hpp"
#include "regions/facet_regions.hpp"
#include "regions/oriented_tetrahedra.hpp"
#include "regions/region_parts.hpp"
#include "regions/tunnel_regions.hpp"
#include "tegl/tile/diagonal_edges.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

bool SolidCell::has_tunnel(std::size_t f) const noexcept {
  return contours_[f] && detail::has_tunnel(contours_[f]->list);
}

/// Fills components with copies of the regions beside them on one side, and removes them: those that are no spheres.
void SolidCell::copy_regions(bool high, Components& components) {
  centres_.clear();
  is_high_.clear();
  for (std::size_t v = 0; v < shape_->corner_count(); ++v) is_high_.push_back(values_[v] >= rules_.isovalue);
  DisjointSets sets = find_regions(high);
  const auto region_of = [&](const Component& component) { return sets.find(first_of(component)); };
  std::vector<bool> is_copied(regions_end());
  std::vector<Index> passing;  // regions whose copies pass spheres beside them
  for (const auto& [root, component] : components)
    if (!is_sphere(component)) is_copied[region_of(component)] = true;
  for (const auto& [root, component] : components)
    if (is_copied[region_of(component)] && is_sphere(component)) passing.push_back(region_of(component));
  std::sort(passing.begin(), passing.end());
  passing.erase(std::unique(passing.begin(), passing.end()), passing.end());
  for (std::size_t f = 0; f < facets_.size() && !passing.empty(); ++f)  // its regions cannot be divided otherwise
    if (has_tunnel(f) && components_in(f, components) > 1) passing.clear();
  if (!passing.empty()) pass_spheres(high, sets, passing, components);
  for (const Index region : passing) is_copied[region] = false;
  const Component boundary =
      take_components(components, [&](const Component& component) { return is_copied[region_of(component)]; });
  std::vector<Tetrahedron> copied;
  std::copy_if(regions_.begin(), regions_.end(), std::back_inserter(copied),
               [&](const Tetrahedron& t) { return is_copied[sets.find(t[0])]; });
  add_copies(std::move(copied), boundary, false);
}

/// Fills the components beside regions whose copies pass spheres, and removes them. A sphere that is alone beside the
/// region behind it is filled with a copy of that region, nearer to the boundary, otherwise coned.
void SolidCell::pass_spheres(bool high, DisjointSets& sets, const std::vector<Index>& passing, Components& components) {
  const std::vector<Tetrahedron> regions = std::move(regions_);
  DisjointSets behind = find_regions(!high);
  std::map<Index, unsigned> around;  // components by region
  for (const auto& [root, component] : components) ++around[behind.find(first_of(component))];
  const auto is_done = [&](const Component& component) {
    return std::binary_search(passing.begin(), passing.end(), sets.find(first_of(component)));
  };
  for (const auto& [root, sphere] : components) {
    if (!is_done(sphere) || !is_sphere(sphere)) continue;
    const Index region = behind.find(first_of(sphere));
    if (around[region] > 1)
      add_sphere(sphere, vertices_of(sphere));
    else
      add_copies(tetrahedra_in(region, behind, regions_), sphere, true);
  }
  for (const Index region : passing) copy_past_spheres(high, region, sets, behind, components);
  std::erase_if(components, [&](const auto& component) { return is_done(component.second); });
  regions_ = regions;
}

/// Fills the components beside a region that are no spheres: with a copy of the region as it were if everything behind
/// the spheres was on its side.
void SolidCell::copy_past_spheres(bool high, Index region, DisjointSets& sets, DisjointSets& behind,
                                  const Components& components) {
  RegionParts parts(sets, behind, regions_end(), region);
  auto [sigma, boundary] = parts.pass_spheres(components);
  const std::vector<bool> is_high = is_high_;
  for (Index v = 0; v < is_high.size(); ++v)
    if (is_high[v] != high && parts.is_passed(first_corner_ + v)) is_high_[v] = high;
  auto contours = contours_;
  auto tunnels = tunnels_;
  for (std::size_t f = 0; f < contours.size(); ++f)
    if (std::none_of(sigma.begin(), sigma.end(), [&](const Piece& piece) { return piece.facet == f; })) {
      contours[f].reset();
      tunnels[f].reset();
    }
  sigma_.swap(sigma);
  contours_.swap(contours);
  tunnels_.swap(tunnels);
  DisjointSets joined = find_regions(high);
  add_copies(tetrahedra_in(joined.find(first_of(boundary)), joined, regions_), boundary, false);
  is_high_ = is_high;
  sigma_.swap(sigma);
  contours_.swap(contours);
  tunnels_.swap(tunnels);
}

/// Adds copies of tetrahedra, which keep the vertices of their boundary. `collars`: half as far from there as others.
void SolidCell::add_copies(std::vector<Tetrahedron> copies, const Component& boundary, bool collars) {
  std::vector<bool> is_kept(regions_end());
  std::vector<Triangle> starts;
  for (const Piece& piece : boundary) {
    starts.push_back(face_of(cone_of(piece, kNone), 3));
    for (const Local v : piece.triangle) is_kept[v] = true;
  }
  std::vector<Local> copy_of(regions_end());  // 0: no copy yet
  std::vector<Inner>& inner = collars ? collars_ : sides_;
  for (Tetrahedron& t : copies)
    for (Local& v : t) {
      if (is_kept[v]) continue;
      if (copy_of[v] == 0) {
        copy_of[v] = static_cast<Local>((collars ? kCollars : kSides) + inner.size());
        inner.emplace_back().points = v < first_centre() ? std::vector<Local>{v} : centres_[v - first_centre()];
      }
      v = copy_of[v];
    }
  orient(copies, std::move(starts));
  tetrahedra_.insert(tetrahedra_.end(), copies.begin(), copies.end());
}

SolidCell::Local SolidCell::add_centre(std::vector<Local> points) {
  centres_.push_back(std::move(points));
  return static_cast<Local>(regions_end() - 1);
}

/// Divides the regions of one side into tetrahedra, and returns those that are connected, by vertices.
DisjointSets SolidCell::find_regions(bool high) {
  regions_.clear();
  fans_.clear();
  for (const bool tunnels : {true, false})  // the triangles in quadrilaterals are those beside tunnels
    for (std::size_t f = 0; f < facets_.size(); ++f)
      if (has_tunnel(f) == tunnels) tunnels ? add_cube_regions(f, high) : add_regions(f, high);
  DisjointSets sets(regions_end());
  for (const Tetrahedron& t : regions_)
    for (std::size_t k = 1; k < 4; ++k) sets.join(t[0], t[k]);
  return sets;
}

/// The regions of a facet in which all polygons are discs, or of an octahedron.
void SolidCell::add_regions(std::size_t f, bool high) {
  RegionSides<Local> sides;
  for (std::size_t face = 0; face < facets_[f].shape.face_count(); ++face) add_parts(f, face, high, sides);
  for (const Piece& piece : sigma_)
    if (piece.facet == f) sides.of_contour.push_back(piece.triangle);
  if (tunnels_[f] && tunnels_[f]->pair.is_high != high) return add_ring(f, sides);
  cone_regions(
      sides, first_corner_, first_centre(), [&](const std::vector<Local>& vertices) { return add_centre(vertices); },
      regions_);
}

/// The region of an octahedron around a tunnel: between its four quadrilaterals and the boundary, in as many sectors.
void SolidCell::add_ring(std::size_t f, const RegionSides<Local>& sides) {
  for (std::size_t j = 0; j < 4; ++j) {
    const auto centre = static_cast<Local>(tunnels_[f]->first_own + j);  // of the quadrilateral
    const std::vector<Local> around = shared_[centre - std::size_t{first_shared()}].points;
    // a sector has two of the corners between both ends of the tunnel, and walls to both neighbours
    const auto corner = [&](Local edge) {
      const auto& [a, b] = shape_->edges()[edge];
      return static_cast<Local>(first_corner_ + (is_high_[a] == tunnels_[f]->pair.is_high ? b : a));
    };
    const Local from = corner(around[0]), to = corner(around[1]);
    std::vector<Local> sector = around;
    sector.insert(sector.end(), {from, to});
    const std::vector<Triangle> walls = {{from, around[0], around[3]}, {to, around[1], around[2]}};
    const auto is_in = [&](Local v) { return std::find(sector.begin(), sector.end(), v) != sector.end(); };
    cone_sector(sides, walls, centre, is_in, add_centre(sector), regions_);
  }
}

/// The parts of a polygon on one side, with their triangles.
void SolidCell::add_parts(std::size_t f, std::size_t face, bool high, RegionSides<Local>& sides) const {
  std::vector<std::vector<Local>>& parts = sides.parts;
  const SolidFacet& facet = facets_[f];
  const std::span<const std::uint8_t> ring = facet.shape.ring(face), edges = facet.shape.ring_edges(face);
  const std::size_t count = ring.size(), first = parts.size();
  const auto corner = [&](std::size_t i) { return static_cast<Local>(first_corner_ + facet.corners[ring[i % count]]); };
  const auto edge = [&](std::size_t i) { return Local{facet.edges[edges[i % count]]}; };
  const auto value = [&](std::size_t i) { return values_[facet.corners[ring[i % count]]]; };
  const auto is_in = [&](std::size_t i) { return is_high_[facet.corners[ring[i % count]]] == high; };
  std::size_t runs = 0, start = 0;  // a run begins after `start`, if there is one
  for (std::size_t i = 0; i < count; ++i)
    if (!is_in(i) && is_in(i + 1)) ++runs, start = i;
  std::vector<double> around;
  for (std::size_t i = 0; i < count; ++i) around.push_back(value(i));
  const bool joins = runs > 1 && is_face_high(rules_, around) == high;
  if (runs == 0 && is_in(0)) parts.emplace_back();
  for (std::size_t i = start + 1; i <= start + count; ++i) {
    if (is_in(i) && !is_in(i + count - 1) && (parts.size() == first || !joins)) parts.emplace_back();
    if (is_in(i) && !is_in(i + count - 1)) parts.back().push_back(edge(i + count - 1));
    if (is_in(i)) parts.back().push_back(corner(i));
    if (is_in(i) && !is_in(i + 1)) parts.back().push_back(edge(i));
  }
  if (count == 4) {
    Square square = {corner(0), corner(1), corner(2), corner(3)};
    std::sort(square.begin(), square.end());
    if (const auto fan = fans_.find(square); fan != fans_.end()) {
      sides.triangles.insert(sides.triangles.end(), fan->second.begin(), fan->second.end());
      return;
    }
  }
  add_part_triangles(first, sides);
}

bool SolidCell::is_in_square(Local v, const Square& square) const noexcept {
  const auto has_corner = [&](std::size_t corner) {
    return std::find(square.begin(), square.end(), first_corner_ + corner) != square.end();
  };
  if (v < first_shared()) return has_corner(shape_->edges()[v][0]) && has_corner(shape_->edges()[v][1]);
  return v >= first_corner_ && v < first_centre() && has_corner(v - std::size_t{first_corner_});
}

/// The regions of a hexahedron with a tunnel.
void SolidCell::add_cube_regions(std::size_t f, bool high) {
  const CubeContour& contour = *contours_[f];
  const CubeFrame& frame = contour.frame;
  const auto corner = [&](unsigned v) { return corner_of(f, frame.corner(v)); };
  const auto edge = [&](unsigned e) {
    const unsigned base = edge_base(3, e);
    return on_edge(f, frame.corner(base), frame.corner(base | 1u << e / 4));
  };
  const auto centre = [&](std::uint32_t mask) { return add_centre(points_of(f, frame, mask)); };
  auto faces =
      add_tunnel_regions(regions_of_, cubes_, contour.list, high, contour.first_own, corner, edge, centre, regions_);
  for (const Piece& piece : sigma_)
    if (piece.facet == f) faces.erase(sorted(piece.triangle));
  for (const auto& corners : kSquareCorners) {
    Square square;
    for (std::size_t i = 0; i < 4; ++i) square[i] = corner_of(f, corners[i]);
    std::sort(square.begin(), square.end());
    add_square_fan(
        faces, square, [&](Local v) { return is_in_square(v, square); }, fans_, regions_);
  }
}

}  // namespace tegl::detail
