// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts the contour of one 4-tile at a time, for the pictures.
#include "pictures/tile_cut.hpp"

#include <fmt/format.h>

#include "base/determinant.hpp"
#include "base/error.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

namespace {

using Point = std::array<double, 4>;

Point mean_of(const std::vector<Point>& points) {
  Point sum{};
  for (const Point& p : points)
    for (std::size_t i = 0; i < 4; ++i) sum[i] += p[i] / static_cast<double>(points.size());
  return sum;
}

/// Positions of local vertices; barycentres are approximated by the means of their facets' edge points.
class Places {
 public:
  Places(const ContourBuilder& builder, Signature signature, const TileContour& contour)
      : builder_(builder), signature_(signature), contour_(contour) {}

  [[nodiscard]] Point of(const LocalFacet& facet, std::uint8_t v) const {
    const Tile& tile = builder_.tile();
    if (v < tile.edge_count()) return on_edge(v);
    if (v < builder_.own_base()) return of_slot(v - tile.edge_count());
    const std::uint32_t own = v - builder_.own_base();
    if (own < contour_.cone_vertices) return of_points(facet.points);
    std::vector<Point> parts;
    for (std::uint32_t b = 0; b < tile.corner_count() + tile.edge_count(); ++b)
      if (((contour_.side_masks[own - contour_.cone_vertices] >> b) & 1u) != 0)
        parts.push_back(b < tile.corner_count() ? tile.corners[b]
                                                : on_edge(static_cast<std::uint8_t>(b - tile.corner_count())));
    return mean_of({mean_of(parts), mean_of(tile.corners)});
  }

 private:
  [[nodiscard]] Point on_edge(std::uint8_t e) const {
    const Tile& tile = builder_.tile();
    return mean_of({tile.corners[tile.edges[e][0]], tile.corners[tile.edges[e][1]]});
  }
  [[nodiscard]] Point of_points(const std::vector<std::uint8_t>& edges) const {
    std::vector<Point> points;
    for (const std::uint8_t e : edges) points.push_back(on_edge(e));
    return mean_of(points);
  }
  /// The barycentre of a cube's facet; slot j belongs to the j-th coned facet of the cube.
  [[nodiscard]] Point of_slot(std::uint32_t slot) const {
    const std::uint32_t f = slot / tables::kFaceSlots;
    std::uint32_t cones = 0;
    for (const LocalFacet& facet : builder_.face_contour(f, signature_).facets) {
      if (facet.filling != Filling::cone || cones++ != slot % tables::kFaceSlots) continue;
      std::vector<std::uint8_t> lifted;
      for (const std::uint8_t e : facet.points) lifted.push_back(builder_.lift(f, e));
      return of_points(lifted);
    }
    throw Error(ErrorCode::Internal, fmt::format("cube {} has no barycentre for slot {}", f, slot));
  }

  const ContourBuilder& builder_;
  Signature signature_;
  const TileContour& contour_;
};

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]}; }

/// The spatial part of the normal that faces high.
Place normal_of(const std::array<Point, 4>& t) {
  std::array<Point, 4> rows{minus(t[1], t[0]), minus(t[2], t[0]), minus(t[3], t[0]), Point{}};
  Place normal{};
  for (std::size_t i = 0; i < 3; ++i) {
    rows[3] = Point{};
    rows[3][i] = 1;
    normal[i] = determinant(rows, 4);
  }
  return normal;
}

Place crossing(const Point& below, const Point& above, double time) {
  const double along = (time - below[3]) / (above[3] - below[3]);
  Place p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = below[i] + along * (above[i] - below[i]);
  return p;
}

/// Adds a triangle, oriented along the normal.
void add(std::array<Place, 3> t, const Place& normal, std::vector<std::array<Place, 3>>& result) {
  const Place u{t[1][0] - t[0][0], t[1][1] - t[0][1], t[1][2] - t[0][2]};
  const Place v{t[2][0] - t[0][0], t[2][1] - t[0][1], t[2][2] - t[0][2]};
  const double facing = (u[1] * v[2] - u[2] * v[1]) * normal[0] + (u[2] * v[0] - u[0] * v[2]) * normal[1] +
                        (u[0] * v[1] - u[1] * v[0]) * normal[2];
  if (facing < 0) std::swap(t[1], t[2]);
  result.push_back(t);
}

void cut_tetrahedron(const std::array<Point, 4>& t, double time, std::vector<std::array<Place, 3>>& result) {
  std::vector<Point> below, above;
  for (const Point& p : t) (p[3] < time ? below : above).push_back(p);
  if (below.empty() || above.empty()) return;
  const Place normal = normal_of(t);
  if (below.size() == 2) {  // a quadrilateral
    const Place a = crossing(below[0], above[0], time), b = crossing(below[0], above[1], time),
                c = crossing(below[1], above[1], time), d = crossing(below[1], above[0], time);
    add({a, b, c}, normal, result);
    add({a, c, d}, normal, result);
    return;
  }
  std::array<Place, 3> triangle;
  for (std::size_t i = 0; i < 3; ++i)
    triangle[i] = below.size() == 1 ? crossing(below[0], above[i], time) : crossing(below[i], above[0], time);
  add(triangle, normal, result);
}

}  // namespace

std::vector<std::array<Place, 3>> cut(const ContourBuilder& builder, Signature signature, const TileContour& contour,
                                      double time) {
  const Places places(builder, signature, contour);
  std::vector<std::array<Place, 3>> result;
  for (const LocalFacet& facet : contour.facets)
    for (const LocalSimplex& s : facet.simplices)
      cut_tetrahedron({places.of(facet, s[0]), places.of(facet, s[1]), places.of(facet, s[2]), places.of(facet, s[3])},
                      time, result);
  return result;
}

}  // namespace tegl::gen
