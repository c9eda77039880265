// SPDX-License-Identifier: BSD-3-Clause
//
// Fills components of Sigma with copies of the regions beside them. A region of a facet is a cone, as each of its
// polygons is a disc; in a hexahedron with a tunnel it is the table's (CubeRegions).
#include <algorithm>
#include <utility>

#include "prisms/prism_cell.hpp"
#include "regions/decided_regions.hpp"
#include "regions/facet_regions.hpp"
#include "regions/oriented_tetrahedra.hpp"
#include "regions/tunnel_regions.hpp"
#include "tegl/tile/diagonal_edges.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

bool PrismCell::has_tunnel(std::size_t f) const noexcept {
  return contours_[f] && detail::has_tunnel(contours_[f]->list);
}

/// Fills components with copies of the regions beside them on one side, and removes them: those that are no spheres,
/// and spheres beside the same region.
void PrismCell::copy_regions(bool high, Components& components) {
  find_regions(high);
  DisjointSets sets(kLocals);
  for (const Tetrahedron& t : regions_)
    for (std::size_t k = 1; k < 4; ++k) sets.join(t[0], t[k]);
  const auto region_of = [&](const Component& component) { return sets.find(component.front().triangle[0]); };
  std::vector<bool> is_copied(kLocals), is_sigma(kLocals);
  for (const auto& [root, component] : components)
    if (2 * vertices_of(component).size() != component.size() + 4) is_copied[region_of(component)] = true;
  std::vector<Triangle> starts;
  for (auto at = components.begin(); at != components.end();) {
    if (!is_copied[region_of(at->second)]) {
      ++at;
      continue;
    }
    for (const Piece& piece : at->second) starts.push_back(face_of(cone_of(piece, kLocals), 3));
    at = components.erase(at);
  }
  for (const Piece& piece : sigma_)
    for (const Local v : piece.triangle) is_sigma[v] = true;
  side_of_.assign(kSides, 0);
  std::vector<Tetrahedron> copies;
  for (Tetrahedron t : regions_) {
    if (!is_copied[sets.find(t[0])]) continue;
    for (Local& v : t)
      if (!is_sigma[v]) v = copy_of(v);
    copies.push_back(t);
  }
  orient(copies, std::move(starts));
  tetrahedra_.insert(tetrahedra_.end(), copies.begin(), copies.end());
}

PrismCell::Local PrismCell::copy_of(Local v) {
  if (side_of_[v] == 0) {
    side_of_[v] = static_cast<Local>(kSides + sides_.size());
    sides_.emplace_back().points = v < kCentres ? std::vector<Local>{v} : centres_[v - kCentres];
  }
  return side_of_[v];
}

PrismCell::Local PrismCell::add_centre(std::vector<Local> points) {
  centres_.push_back(std::move(points));
  return static_cast<Local>(kCentres + centres_.size() - 1);
}

/// Divides the regions of one side into tetrahedra.
void PrismCell::find_regions(bool high) {
  regions_.clear();
  fans_.clear();
  centres_.clear();
  for (const bool tunnels : {true, false})  // the triangles in quadrilaterals are those beside tunnels
    for (std::size_t f = 0; f < facets_.size(); ++f)
      if (has_tunnel(f) == tunnels) tunnels ? add_cube_regions(f, high) : add_regions(f, high);
}

/// The regions of a facet in which all polygons are discs.
void PrismCell::add_regions(std::size_t f, bool high) {
  RegionSides<Local> sides;
  for (std::size_t face = 0; face < facets_[f].shape.face_count(); ++face)
    add_parts(f, face, high, sides.parts, sides.triangles);
  for (const Piece& piece : sigma_)
    if (piece.facet == f) sides.of_contour.push_back(piece.triangle);
  cone_regions(
      sides, kCorners, kCentres, [&](const std::vector<Local>& vertices) { return add_centre(vertices); }, regions_);
}

/// The parts of a polygon on one side, with their triangles.
void PrismCell::add_parts(std::size_t f, std::size_t face, bool high, std::vector<std::vector<Local>>& parts,
                          std::vector<Triangle>& triangles) const {
  const PrismFacet& facet = facets_[f];
  const std::span<const std::uint8_t> ring = facet.shape.ring(face), edges = facet.shape.ring_edges(face);
  const std::size_t count = ring.size(), first = parts.size();
  const auto corner = [&](std::size_t i) { return static_cast<Local>(kCorners + facet.corners[ring[i % count]]); };
  const auto edge = [&](std::size_t i) { return Local{facet.edges[edges[i % count]]}; };
  const auto value = [&](std::size_t i) { return values_[facet.corners[ring[i % count]]]; };
  const auto is_in = [&](std::size_t i) { return (value(i) >= rules_.isovalue) == high; };
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
      triangles.insert(triangles.end(), fan->second.begin(), fan->second.end());
      return;
    }
  }
  for (std::size_t p = first; p < parts.size(); ++p) {
    auto& part = parts[p];  // corners have the largest numbers; each triangle has one, so it is moved into the cell
    std::rotate(part.begin(), std::max_element(part.begin(), part.end()), part.end());
    for (std::size_t i = 2; i < part.size(); ++i) triangles.push_back({part[0], part[i - 1], part[i]});
  }
}

bool PrismCell::is_in_square(Local v, const Square& square) const noexcept {
  const auto has_corner = [&](std::size_t corner) {
    return std::find(square.begin(), square.end(), kCorners + corner) != square.end();
  };
  if (v < kShared) return has_corner(shape_->edges()[v][0]) && has_corner(shape_->edges()[v][1]);
  return v >= kCorners && v < kCentres && has_corner(v - std::size_t{kCorners});
}

/// The regions of a hexahedron with a tunnel.
void PrismCell::add_cube_regions(std::size_t f, bool high) {
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
