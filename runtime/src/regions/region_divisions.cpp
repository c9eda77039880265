// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the division of a region: in hexahedra by the cube's table, if its boundary fits; otherwise the division that
// the generator lists for the region that a symmetry of the shape maps it to.
#include "regions/region_divisions.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "regions/cube_frame.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

namespace {

using Tetrahedron = RegionTetrahedron;
using Triangle = RegionTriangle;
using Triangles = RegionTriangles;
using Vertices = ShapeVertices;

/// Vertices are numbers below kEnd. No region with nearly as many own ones is known.
void require_room(const RegionDivision& division) {
  if (division.own.size() > Vertices::kEnd - Vertices::kFirstOwn)
    throw std::length_error("division of a region: too many vertices of its own");
}

/// The division by the cube's table in a frame, if it has the given boundary. `centres`: by their edges.
std::optional<RegionDivision> in_frame(const tables::RegionTable& cube, const CubeFrame& frame,
                                       const tables::CellTable& table, const Triangles& boundary, unsigned signature,
                                       const std::map<std::vector<std::uint8_t>, std::uint8_t>& centres) {
  constexpr unsigned kFirstSlot = 8 + 12, kFirstOwn = tables::first_region_vertex(3);
  const tables::RegionList& list = cube.lists[frame.signature(signature)];
  std::array<std::uint8_t, Vertices::kFirstCentre> shared{};
  for (unsigned v = 0; v < 8; ++v) shared[v] = static_cast<std::uint8_t>(frame.corner(v));
  for (unsigned e = 0; e < 12; ++e) {
    const unsigned base = edge_base(3, e);
    shared[Vertices::kFirstEdge + e] = static_cast<std::uint8_t>(
        Vertices::kFirstEdge + edge_between(table, frame.corner(base), frame.corner(base | 1u << e / 4)));
  }
  RegionDivision division;
  Triangles surface;
  for (unsigned i = 0; i < list.simplex_count; ++i) {
    Tetrahedron& t = division.tetrahedra.emplace_back();
    for (unsigned k = 0; k < 4; ++k) {
      const unsigned v = cube.simplices[(list.first_simplex + i) * 4 + k];
      // barycentres are named by their order in the table, until their edges are known
      t[k] = v < kFirstSlot  ? shared[v]
             : v < kFirstOwn ? static_cast<std::uint8_t>(Vertices::kFirstCentre + (v - kFirstSlot))
                             : static_cast<std::uint8_t>(Vertices::kFirstOwn + (v - kFirstOwn));
    }
    if (frame.is_mirrored()) std::swap(t[2], t[3]);
    for (const Triangle& face : faces_of(t)) add_to_boundary(surface, face);
  }
  std::array<std::uint8_t, Vertices::kEnd> renamed{};
  for (std::uint8_t v = 0; v < Vertices::kEnd; ++v) renamed[v] = v;
  for (std::uint8_t v = Vertices::kFirstCentre; v < Vertices::kFirstOwn; ++v) {
    const auto edges = edges_around(surface, v);
    if (edges.empty()) continue;
    const auto found = centres.find(edges);
    if (found == centres.end()) return std::nullopt;
    renamed[v] = found->second;
  }
  for (Triangle& t : surface) {
    for (std::uint8_t& v : t) v = renamed[v];
  }
  for (Tetrahedron& t : division.tetrahedra)
    for (std::uint8_t& v : t) v = renamed[v];
  sort_boundary(surface);
  if (surface != boundary) return std::nullopt;
  for (unsigned j = 0; j < list.own_vertices; ++j) {
    std::uint32_t points = 0;
    for (std::uint32_t mask = cube.masks[list.first_mask + j]; mask != 0; mask &= mask - 1)
      points |= 1u << shared[static_cast<std::size_t>(std::countr_zero(mask))];
    division.own.push_back(points);
  }
  return division;
}

/// A boundary with its barycentres.
struct Surface {
  const tables::CellTable& table;
  std::map<std::vector<std::uint8_t>, std::uint8_t> centres;  ///< by their edges
  bool outwards;                                              ///< whether volumes below the triangles are positive

  Surface(tables::CellShape shape, const Triangles& boundary)
      : table(tables::cell_table(shape, Triangulation::barycentric)) {
    ShapePlaces places(table);
    for (std::uint8_t v = Vertices::kFirstCentre; v < Vertices::kFirstOwn; ++v)
      if (auto edges = edges_around(boundary, v); !edges.empty()) {
        centres[edges] = v;
        places.set_centre(v, std::move(edges));
      }
    double volume = 0;
    for (const Triangle& t : boundary) volume += six_volumes(places.places({0, t[0], t[1], t[2]}));
    outwards = volume > 0;
  }
};

/// The division of a hexahedron by the cube's table in one of the first `frames` frames.
std::optional<RegionDivision> by_table(const tables::RegionTable& cube, const Surface& surface,
                                       const Triangles& boundary, unsigned frames) {
  const auto signature = static_cast<unsigned>(vertices_of(boundary)) & 0xffu;
  Triangles faced = boundary;  // as the table has it
  for (Triangle& t : faced)
    if (!surface.outwards) std::swap(t[0], t[1]);
  sort_boundary(faced);
  for (unsigned f = 0; f < frames; ++f) {
    auto found = in_frame(cube, CubeFrame::of_number(f), surface.table, faced, signature, surface.centres);
    if (!found) continue;
    if (!surface.outwards)
      for (Tetrahedron& t : found->tetrahedra) std::swap(t[2], t[3]);
    return found;
  }
  return std::nullopt;
}

/// The emitted division of a region with this boundary, if there is one.
std::optional<RegionDivision> listed(tables::CellShape shape, const Triangles& boundary) {
  const tables::RegionDivisionTable& table = *tables::region_division_table(shape);
  const auto triangles = [&](std::uint32_t first, std::size_t count) {
    Triangles result(count);
    for (std::size_t i = 0; i < count; ++i) std::copy_n(table.triangles + 3 * (first + i), 3, result[i].begin());
    return result;
  };
  const auto of = [&](const tables::RegionRecord& record) {
    return triangles(record.first_triangle, record.triangles);
  };
  const tables::RegionRecord* const end = table.records + table.count;
  const auto* const found = std::lower_bound(table.records, end, boundary,
                                             [&](const auto& record, const Triangles& b) { return of(record) < b; });
  if (found == end || of(*found) != boundary) return std::nullopt;
  RegionDivision division;
  division.tetrahedra.resize(found->tetrahedra);
  for (std::size_t i = 0; i < division.tetrahedra.size(); ++i)
    std::copy_n(table.tetrahedra + 4 * (found->first_tetrahedron + i), 4, division.tetrahedra[i].begin());
  division.own.assign(table.own + found->first_own, table.own + found->first_own + found->own);
  for (unsigned i = 0; i < found->near; ++i) {
    const tables::NearVertex& near = table.near[found->first_near + i];
    division.near.push_back({near.own, near.corner, triangles(near.first_seen, near.seen)});
  }
  return division;
}

/// A cone from the mean of all points, which is not proved.
RegionDivision cone_from_mean(const Triangles& boundary) {
  RegionDivision division;
  division.is_proved = false;
  division.own.push_back(static_cast<std::uint32_t>(vertices_of(boundary) & ((1u << Vertices::kFirstCentre) - 1)));
  for (const Triangle& t : boundary)
    division.tetrahedra.push_back({static_cast<std::uint8_t>(Vertices::kFirstOwn), t[0], t[1], t[2]});
  return division;
}

/// `boundary`: of one region, sorted.
RegionDivision divide(tables::CellShape shape, const tables::RegionTable& cube, const Triangles& boundary) {
  if (shape == tables::CellShape::hexahedron)
    if (auto found = by_table(cube, Surface(shape, boundary), boundary, CubeFrame::kCount)) return std::move(*found);
  if (auto found = listed(shape, boundary)) return std::move(*found);
  return cone_from_mean(boundary);
}

/// The division of the region that a symmetry maps to the one of `of`.
RegionDivision moved_back(RegionDivision of, const RegionMap& symmetry) {
  RegionMap back{};
  for (std::uint8_t v = 0; v < Vertices::kEnd; ++v) back[symmetry[v]] = v;
  for (Tetrahedron& t : of.tetrahedra)
    for (std::uint8_t& v : t) v = back[v];
  for (std::uint32_t& mask : of.own) {
    std::uint32_t points = 0;
    for (; mask != 0; mask &= mask - 1) points |= 1u << back[static_cast<std::size_t>(std::countr_zero(mask))];
    mask = points;
  }
  for (RegionDivision::Near& near : of.near) {
    near.corner = back[near.corner];
    for (Triangle& t : near.seen)
      for (std::uint8_t& v : t) v = back[v];
  }
  return of;
}

}  // namespace

double RegionDivision::weight(const Near& of, const ShapePlaces& places) const noexcept {
  const auto corner = places.place(of.corner);
  ShapePlaces::Place mean{};
  const std::uint32_t points = own[of.own - Vertices::kFirstOwn];
  for (std::uint32_t rest = points; rest != 0; rest &= rest - 1) {
    const auto place = places.place(static_cast<unsigned>(std::countr_zero(rest)));
    for (std::size_t a = 0; a < 3; ++a) mean[a] += place[a] / std::popcount(points);
  }
  // volumes are linear along the way; those at the corner have one sign or are zero
  std::vector<std::array<double, 2>> volumes;
  double sum = 0;
  for (const Triangle& t : of.seen) {
    std::array<ShapePlaces::Place, 4> from = {corner, places.place(t[0]), places.place(t[1]), places.place(t[2])};
    const double at_corner = six_volumes(from);
    from[0] = mean;
    volumes.push_back({at_corner, six_volumes(from)});
    sum += at_corner;
  }
  double most = 1.0;
  for (const auto& [at_corner, at_mean] : volumes)
    if (at_corner * sum > 0 && at_mean * sum < 0) most = std::min(most, at_corner / (at_corner - at_mean));
  return 0.5 * most;
}

const RegionDivision& RegionDivisions::of_region(tables::CellShape shape, const Boundary& boundary) {
  const auto [at, is_new] = regions_.try_emplace({shape, boundary});
  if (!is_new) return at->second;
  const tables::ShapeTable& of = tables::shape_table(shape);
  const tables::CellTable& table = tables::cell_table(shape, Triangulation::barycentric);
  const std::span symmetries(of.symmetries, std::size_t{of.symmetry_count} * (table.corner_count + table.edge_count));
  RegionMap map{};
  at->second = moved_back(divide(shape, cube_, representative_of(boundary, table, symmetries, map)), map);
  return at->second;
}

const RegionDivision& RegionDivisions::of(tables::CellShape shape, Triangles boundary) {
  sort_boundary(boundary);
  const auto [at, is_new] = known_.try_emplace({shape, std::move(boundary)});
  if (!is_new) return at->second;
  const Triangles& all = at->first.second;
  RegionDivision& division = at->second;
  if (shape == tables::CellShape::hexahedron)  // in their own frame, a grid's cubes have the division of an image's
    if (auto found = by_table(cube_, Surface(shape, all), all, 1)) {
      division = std::move(*found);
      return division;
    }
  for (const Triangles& region : split_regions(all)) {
    const auto shift = static_cast<std::uint8_t>(division.own.size());
    const auto shifted = [&](std::uint8_t v) {
      return v < Vertices::kFirstOwn ? v : static_cast<std::uint8_t>(v + shift);
    };
    const RegionDivision& part = of_region(shape, region);
    for (Tetrahedron t : part.tetrahedra) {
      for (std::uint8_t& v : t) v = shifted(v);
      division.tetrahedra.push_back(t);
    }
    division.own.insert(division.own.end(), part.own.begin(), part.own.end());
    for (RegionDivision::Near near : part.near) {
      near.own = shifted(near.own);
      division.near.push_back(std::move(near));
    }
    require_room(division);
    division.is_proved = division.is_proved && part.is_proved;
  }
  return division;
}

}  // namespace tegl::detail
