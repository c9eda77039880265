// SPDX-License-Identifier: BSD-3-Clause
//
// Divisions by the regions of the resolved cube, with the diagonals that the faces of the hexahedron have, and of
// octahedra with tunnels.
#include "regions/decided_regions.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "regions/oriented_tetrahedra.hpp"
#include "regions/tunnel_regions.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/tile/corners.hpp"
#include "tegl/tile/diagonal_edges.hpp"
#include "tile/extract_tables.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

namespace {

using Local = std::uint8_t;
using Tetrahedron = RegionTetrahedron;
using Triangle = RegionTriangle;
using Triangles = RegionTriangles;
using Vertices = ShapeVertices;

/// Orients tetrahedra by the sides of the region.
void orient_by(const Triangles& sides, std::vector<Tetrahedron>& tetrahedra) {
  std::vector<Triangle> starts;  // as a tetrahedron induces the side opposite to its first vertex
  for (const Triangle& t : sides) starts.push_back({t[0], t[2], t[1]});
  orient(tetrahedra, std::move(starts));
}

/// Moves the regions of the resolved cube to a hexahedron, and fits them to the diagonals in its faces.
class CubeDivision {
 public:
  CubeDivision(const CubeContour& contour, Triangulation triangulation)
      : table_(tables::cell_table(tables::CellShape::hexahedron, triangulation)), frame_(contour.frame) {
    faces_ = add_tunnel_regions(
        CubeRegions::of_caps(triangulation), ResolvedCubes::instance(triangulation), contour.list, true,
        static_cast<Local>(Vertices::kFirstCentre), [&](unsigned v) { return static_cast<Local>(frame_.corner(v)); },
        [&](unsigned e) { return on_edge(e); }, [&](std::uint32_t mask) { return add_own(mask); },
        division_.tetrahedra);
  }

  /// Gives the division these sides.
  void fit(const Triangles& sides) {
    for (const auto& corners : kSquareCorners) {
      std::uint32_t square = 0;
      for (const Local v : corners) square |= 1u << v;
      for (unsigned e = 0; e < 12; ++e)
        if ((square >> table_.edges[2 * e] & square >> table_.edges[2 * e + 1] & 1u) != 0)
          square |= 1u << (Vertices::kFirstEdge + e);
      const auto is_in = [&](const Triangle& t) {
        return std::all_of(t.begin(), t.end(), [&](Local v) { return v < 32 && (square >> v & 1u) != 0; });
      };
      std::vector<Triangle> wanted, found;
      for (const Triangle& t : sides)
        if (is_in(t)) wanted.push_back(sorted(t));
      for (const auto& [t, count] : faces_)
        if (count == 1 && is_in(t)) found.push_back(t);
      std::sort(wanted.begin(), wanted.end());
      std::vector<Tetrahedron> quadrilaterals;  // whose diagonals differ
      if (found != wanted) join_fans(found, wanted, quadrilaterals);
      for (const Tetrahedron& quadrilateral : quadrilaterals) exchange(quadrilateral, wanted);
    }
    orient_by(sides, division_.tetrahedra);
  }

  [[nodiscard]] RegionDivision& division() noexcept { return division_; }

 private:
  [[nodiscard]] Local on_edge(unsigned e) const noexcept {
    const unsigned base = edge_base(3, e);
    return static_cast<Local>(Vertices::kFirstEdge +
                              edge_between(table_, frame_.corner(base), frame_.corner(base | 1u << e / 4)));
  }

  Local add_own(std::uint32_t mask) {
    std::uint32_t points = 0;
    for (unsigned v = 0; v < 8; ++v) points |= (mask >> v & 1u) << frame_.corner(v);
    for (unsigned e = 0; e < 12; ++e) points |= (mask >> (8 + e) & 1u) << on_edge(e);
    return add_mean(points);
  }

  Local add_mean(std::uint32_t points) {
    if (division_.own.size() == Vertices::kEnd - Vertices::kFirstOwn)
      throw std::length_error("division of a cube: too many vertices of its own");
    division_.own.push_back(points);
    return static_cast<Local>(Vertices::kFirstOwn + division_.own.size() - 1);
  }

  /// Exchanges the diagonal of a quadrilateral. The tetrahedra around the old diagonal become a cone from a vertex
  /// over their other sides and the two new triangles. If there are only two, with the same fourth vertex, they become
  /// two others with this vertex: it is on the same side of the face's plane, so they are positive, too. Otherwise the
  /// cone starts at a new vertex, the mean of their points.
  void exchange(const Tetrahedron& quadrilateral, const std::vector<Triangle>& wanted) {
    std::vector<Triangle> added;
    std::vector<Local> diagonal(quadrilateral.begin(), quadrilateral.end());  // the vertices in one of these only
    for (unsigned k = 0; k < 4; ++k)
      if (const Triangle side = sorted(face_of(quadrilateral, k));
          std::binary_search(wanted.begin(), wanted.end(), side))
        added.push_back(side);
    if (added.size() != 2) throw std::logic_error("the sides of a quadrilateral are not those of its other diagonal");
    std::erase_if(diagonal, [&](Local v) { return has_vertex(added[0], v) && has_vertex(added[1], v); });
    // the tetrahedra around the diagonal
    std::vector<Tetrahedron>& all = division_.tetrahedra;
    const auto is_around = [&](const Tetrahedron& t) {
      return std::all_of(diagonal.begin(), diagonal.end(),
                         [&](Local v) { return std::find(t.begin(), t.end(), v) != t.end(); });
    };
    const auto first = std::stable_partition(all.begin(), all.end(), std::not_fn(is_around));
    const std::vector<Tetrahedron> around(first, all.end());
    all.erase(first, all.end());
    std::vector<Local> others;  // the other vertices beside the quadrilateral's
    std::uint32_t points = 0;
    for (const Tetrahedron& t : around)
      for (const Local v : t) {
        if (std::find(quadrilateral.begin(), quadrilateral.end(), v) == quadrilateral.end() &&
            std::find(others.begin(), others.end(), v) == others.end())
          others.push_back(v);
        if (v < Vertices::kFirstCentre) points |= 1u << v;
      }
    const Local apex = others.size() == 1 ? others[0] : add_mean(points);
    division_.is_proved = division_.is_proved && others.size() == 1;
    for (const Triangle& t : added) all.push_back({t[0], t[1], t[2], apex});
    for (Tetrahedron t : around)
      for (unsigned k = 0; k < 4; ++k)
        if (std::find(diagonal.begin(), diagonal.end(), t[k]) != diagonal.end()) {
          const Triangle base = face_of(t, k);
          if (!has_vertex(base, apex)) all.push_back({base[0], base[1], base[2], apex});
        }
  }

  const tables::CellTable& table_;
  CubeFrame frame_;
  RegionDivision division_;
  TriangleCounts<Local> faces_;
};

}  // namespace

CubeContour::CubeContour(unsigned number, unsigned signature, unsigned squares, tile::Choice choice) noexcept
    : frame(CubeFrame::of_number(number)) {
  unsigned high = 0;
  for (unsigned q = 0; q < 6; ++q) high |= (squares >> frame.square(q) & 1u) << q;
  list = ResolvedCubes::list(frame.signature(signature), high, choice);
}

bool has_tunnel(unsigned list) noexcept {
  const ResolvedCubes& cubes = ResolvedCubes::instance();
  for (unsigned j = 0; j < cubes.own_vertices(list); ++j)
    if (is_on_ray(cubes.mask(list, j))) return true;
  return false;
}

RegionDivision divide_cube(const CubeContour& contour, Triangulation triangulation, const Triangles& sides) {
  CubeDivision result(contour, triangulation);
  result.fit(sides);
  return std::move(result.division());
}

RegionDivision divide_around_tunnel(unsigned pair, bool is_high, const Triangles& sides) {
  const tables::CellTable& table = tables::cell_table(tables::CellShape::octahedron, Triangulation::barycentric);
  const auto edge = [&](unsigned a, unsigned b) {
    return static_cast<Local>(Vertices::kFirstEdge + edge_between(table, a, b));
  };
  const auto p = static_cast<Local>(2 * pair), q = static_cast<Local>(2 * pair + 1);
  const auto around = corners_around(pair);
  RegionDivision division;
  for (unsigned i = 0; i < 4; ++i) {
    Triangles seen;  // from the barycentre, beside the contour
    for (const Local v : {around[i], around[(i + 1) % 4]}) {
      seen.push_back({is_high ? p : v, edge(p, v), edge(q, v)});
      if (is_high) seen.push_back({p, q, edge(q, v)});
    }
    const std::uint64_t sector = vertices_of(seen);
    for (const Triangle& t : sides)
      if (std::all_of(t.begin(), t.end(), [&](Local v) { return (sector >> v & 1u) != 0; })) seen.push_back(t);
    for (const Triangle& t : seen)
      division.tetrahedra.push_back({static_cast<Local>(Vertices::kFirstCentre + i), t[0], t[1], t[2]});
  }
  orient_by(sides, division.tetrahedra);
  return division;
}

}  // namespace tegl::detail
