// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes of 4D polytopes for tests: convex hulls, products of polygons, and prisms around a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "polyhedral_meshes.hpp"
#include "tegl/complex.hpp"

namespace tegl::test {

using CellFacets4 = std::vector<CellFaces3>;  ///< the facets of a cell
using Point4 = std::array<double, 4>;

/// Points and cells by their facets.
struct FacetedMesh {
  std::vector<Point4> points;
  std::vector<CellFacets4> cells;
  /// By cell: a type with its corners to be used instead; polytope: none.
  std::vector<std::pair<CellType, std::vector<Index>>> known = {};

  void add(CellFacets4 facets) {
    cells.push_back(std::move(facets));
    known.emplace_back(CellType::polytope, std::vector<Index>());
  }
  [[nodiscard]] CellLists lists() const {
    CellLists lists;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      lists.types.push_back(known[c].first);
      lists.corners.insert(lists.corners.end(), known[c].second.begin(), known[c].second.end());
      lists.ends.push_back(lists.corners.size());
      for (const CellFaces3& facet : cells[c]) {
        if (known[c].first != CellType::polytope) break;
        for (const FaceRing& ring : facet) {
          lists.face_corners.insert(lists.face_corners.end(), ring.begin(), ring.end());
          lists.face_ends.push_back(lists.face_corners.size());
        }
        lists.facet_ends.push_back(lists.face_ends.size());
      }
      lists.facet_lists_ends.push_back(lists.facet_ends.size());
    }
    return lists;
  }
  [[nodiscard]] Complex<4> complex() const { return Complex<4>(points, lists()); }
};

inline FaceRing corners_of(const CellFaces3& facet) {
  std::set<Index> corners;
  for (const FaceRing& ring : facet) corners.insert(ring.begin(), ring.end());
  return {corners.begin(), corners.end()};
}

/// The facets that one cell only has.
inline std::vector<CellFaces3> border_facets(const FacetedMesh& mesh) {
  std::map<FaceRing, std::vector<const CellFaces3*>> uses;
  for (const CellFacets4& cell : mesh.cells)
    for (const CellFaces3& facet : cell) uses[corners_of(facet)].push_back(&facet);
  std::vector<CellFaces3> border;
  for (const auto& [corners, of] : uses)
    if (of.size() == 1) border.push_back(*of[0]);
  return border;
}

/// Numbers in [0, 1).
inline std::vector<double> random_values(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> values(count);
  for (double& value : values) value = static_cast<double>(random() >> 11) * 0x1p-53;
  return values;
}

/// Noise in [0, 1), below 0 on the border.
inline std::vector<double> closed_noise(const FacetedMesh& mesh, std::uint64_t seed) {
  std::vector<double> values = random_values(mesh.points.size(), seed);
  for (const CellFaces3& facet : border_facets(mesh))
    for (const Index p : corners_of(facet)) values[p] = -1.0;
  return values;
}

/// The facets of the convex hull of points as sorted corners. Every point must be a corner.
inline std::vector<FaceRing> hull_corners(const std::vector<Point4>& points) {
  const auto count = static_cast<Index>(points.size());
  std::set<FaceRing> facets;
  const auto at = [&](Index p) { return Eigen::Vector4d(points[p][0], points[p][1], points[p][2], points[p][3]); };
  for (Index i = 0; i < count; ++i)
    for (Index j = i + 1; j < count; ++j)
      for (Index k = j + 1; k < count; ++k)
        for (Index l = k + 1; l < count; ++l) {
          const Eigen::Vector4d u = at(j) - at(i), v = at(k) - at(i), w = at(l) - at(i);
          Eigen::Vector4d normal;
          for (int a = 0; a < 4; ++a) {
            Eigen::Matrix3d rest;
            for (int b = 0, row = 0; b < 4; ++b)
              if (b != a) rest.row(row++) << u[b], v[b], w[b];
            normal[a] = (a % 2 == 0 ? 1 : -1) * rest.determinant();
          }
          if (normal.norm() < 1e-9) continue;
          normal.normalize();
          FaceRing facet;
          bool above = false, below = false;
          for (Index p = 0; p < count && !(above && below); ++p) {
            const double side = normal.dot(at(p) - at(i));
            if (std::abs(side) < 1e-9)
              facet.push_back(p);
            else
              (side > 0 ? above : below) = true;
          }
          if (!(above && below)) facets.insert(facet);
        }
  return {facets.begin(), facets.end()};
}

/// Corners of a plane face in the order around it.
inline FaceRing ring_around(const std::vector<Point4>& points, FaceRing face) {
  const auto at = [&](Index p) { return Eigen::Vector4d(points[p][0], points[p][1], points[p][2], points[p][3]); };
  Eigen::Vector4d centre = Eigen::Vector4d::Zero();
  for (const Index p : face) centre += at(p) / static_cast<double>(face.size());
  const Eigen::Vector4d u = (at(face[0]) - centre).normalized();
  Eigen::Vector4d v = Eigen::Vector4d::Zero();
  for (const Index p : face) {
    const Eigen::Vector4d across = at(p) - centre - u.dot(at(p) - centre) * u;
    if (across.norm() > v.norm()) v = across;
  }
  v.normalize();
  std::sort(face.begin(), face.end(), [&](Index p, Index q) {
    const auto angle = [&](Index x) { return std::atan2(v.dot(at(x) - centre), u.dot(at(x) - centre)); };
    return angle(p) < angle(q);
  });
  return face;
}

/// The facets of a convex hull: two facets have three points or more in common in a face only.
inline CellFacets4 hull_facets(const std::vector<Point4>& points) {
  const std::vector<FaceRing> corners = hull_corners(points);
  CellFacets4 facets(corners.size());
  for (std::size_t f = 0; f < corners.size(); ++f)
    for (std::size_t g = 0; g < corners.size(); ++g) {
      FaceRing both;
      std::set_intersection(corners[f].begin(), corners[f].end(), corners[g].begin(), corners[g].end(),
                            std::back_inserter(both));
      if (f != g && both.size() > 2) facets[f].push_back(ring_around(points, both));
    }
  return facets;
}

/// One cell around points.
inline FacetedMesh hull(std::vector<Point4> points) {
  FacetedMesh mesh;
  mesh.add(hull_facets(points));
  mesh.points = std::move(points);
  return mesh;
}

inline CellFacets4 renumbered(CellFacets4 facets, const std::vector<Index>& number) {
  for (CellFaces3& facet : facets)
    for (FaceRing& ring : facet)
      for (Index& p : ring) p = number[p];
  return facets;
}

/// The product of two polygons: corner (a, b) has the number number(a, b).
template <class Number>
CellFacets4 product_facets(const FaceRing& first, const FaceRing& second, const Number& number) {
  CellFacets4 facets;
  for (const bool swapped : {false, true}) {
    const FaceRing &along = swapped ? second : first, &across = swapped ? first : second;
    const auto at = [&](Index a, Index b) { return swapped ? number(b, a) : number(a, b); };
    for (std::size_t i = 0; i < along.size(); ++i) {  // the prism over `across` between two corners of `along`
      CellFaces3& facet = facets.emplace_back(2);
      const Index p = along[i], q = along[(i + 1) % along.size()];
      for (std::size_t k = 0; k < across.size(); ++k) {
        const Index a = across[k], b = across[(k + 1) % across.size()];
        facet[0].push_back(at(p, a));
        facet[1].push_back(at(q, a));
        facet.push_back({at(p, a), at(p, b), at(q, b), at(q, a)});
      }
    }
  }
  return facets;
}

/// A polygonal mesh for products.
struct PolygonMesh {
  std::vector<std::array<double, 2>> points;
  std::vector<FaceRing> cells;
};

/// A regular polygon.
inline PolygonMesh regular_polygon(int corners) {
  PolygonMesh mesh;
  mesh.cells.emplace_back();
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * 3.141592653589793 * i / corners;
    mesh.points.push_back({std::cos(angle), std::sin(angle)});
    mesh.cells[0].push_back(static_cast<Index>(i));
  }
  return mesh;
}

/// Squares in [-1, 1]^2, some divided into triangles, some merged with a neighbour or with half of it: polygons of
/// three to six corners.
inline PolygonMesh mixed_polygons(Index along) {
  PolygonMesh mesh;
  const auto number = [&](Index i, Index j) { return i + (along + 1) * j; };
  for (Index j = 0; j <= along; ++j)
    for (Index i = 0; i <= along; ++i) mesh.points.push_back({2.0 * i / along - 1.0, 2.0 * j / along - 1.0});
  for (Index j = 0; j < along; ++j)
    for (Index i = 0; i < along;) {
      const Index a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
      const Index kind = (i + 2 * j) % 4;
      if (kind == 0 && i + 1 < along) {
        const Index e = number(i + 2, j), f = number(i + 2, j + 1);
        if (j % 2 == 0) {
          mesh.cells.push_back({a, b, e, f, c, d});
        } else {
          mesh.cells.push_back({a, b, e, c, d});
          mesh.cells.push_back({e, f, c});
        }
        i += 2;
        continue;
      }
      if (kind == 3) {
        mesh.cells.push_back({a, b, c});
        mesh.cells.push_back({a, c, d});
      } else {
        mesh.cells.push_back({a, b, c, d});
      }
      ++i;
    }
  return mesh;
}

/// The products of all cells of two polygonal meshes. Points are moved by up to `jitter`.
inline FacetedMesh products(const PolygonMesh& first, const PolygonMesh& second, double jitter = 0.0) {
  FacetedMesh mesh;
  const auto number = [&](Index a, Index b) { return a * static_cast<Index>(second.points.size()) + b; };
  std::mt19937_64 random(3);
  for (const auto& p : first.points)
    for (const auto& q : second.points) {
      Point4& point = mesh.points.emplace_back(Point4{p[0], p[1], q[0], q[1]});
      for (double& x : point) x += jitter * (static_cast<double>(random() >> 11) * 0x1p-52 - 1.0);
    }
  for (const FaceRing& p : first.cells)
    for (const FaceRing& q : second.cells) mesh.add(product_facets(p, q, number));
  return mesh;
}

/// The mesh with prisms over the facets of its border, out to copies of its points that are `factor` times as far from
/// the origin. Prisms over facets with a type have the type of the prism.
inline FacetedMesh with_prisms(FacetedMesh mesh, double factor = 1.5) {
  const std::vector<CellFaces3> border = border_facets(mesh);
  std::map<Index, Index> above;
  for (const CellFaces3& facet : border)
    for (const Index p : corners_of(facet))
      if (above.try_emplace(p, static_cast<Index>(mesh.points.size())).second) {
        Point4 point = mesh.points[p];
        for (double& x : point) x *= factor;
        mesh.points.push_back(point);
      }
  for (const CellFaces3& facet : border) {
    CellFacets4 prism = {facet, facet};
    for (FaceRing& ring : prism[1])
      for (Index& p : ring) p = above[p];
    for (const FaceRing& ring : facet) {
      CellFaces3& side = prism.emplace_back(2);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Index a = ring[i], b = ring[(i + 1) % ring.size()];
        side[0].push_back(a);
        side[1].push_back(above[a]);
        side.push_back({a, b, above[b], above[a]});
      }
    }
    std::vector<Index> all;
    std::vector<std::uint64_t> ends;
    for (const FaceRing& ring : facet) {
      all.insert(all.end(), ring.begin(), ring.end());
      ends.push_back(all.size());
    }
    const auto found = detail::recognise_polyhedron(0, mesh.points.size(), all, ends);
    static constexpr CellType kTypes[] = {CellType::tetrahedron_prism, CellType::pyramid_prism, CellType::wedge_prism,
                                          CellType::hexahedron_prism, CellType::octahedron_prism};
    mesh.add(std::move(prism));
    if (found.shape == detail::PolyhedronShape::other) continue;
    auto& [type, corners] = mesh.known.back();
    type = kTypes[static_cast<std::size_t>(found.shape)];
    corners = found.corners;
    for (const Index p : found.corners) corners.push_back(above[p]);
  }
  return mesh;
}

}  // namespace tegl::test
