// SPDX-License-Identifier: BSD-3-Clause
//
// Single 4D polytopes, and the Voronoi cells of the lattices D4 and A4, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <random>
#include <vector>

#include "polytopal_meshes.hpp"

namespace tegl::test {

/// The corners of a 24-cell, doubled: the Voronoi cell of the lattice D4 of integers with an even sum.
inline std::vector<std::array<int, 4>> cell24_corners() {
  std::vector<std::array<int, 4>> corners;
  for (unsigned s = 0; s < 16; ++s) {
    std::array<int, 4> corner{};
    for (unsigned a = 0; a < 4; ++a) corner[a] = (s >> a & 1u) != 0 ? 1 : -1;
    corners.push_back(corner);
  }
  for (unsigned a = 0; a < 4; ++a)
    for (const int x : {-2, 2}) {
      std::array<int, 4> corner{};
      corner[a] = x;
      corners.push_back(corner);
    }
  return corners;
}

inline std::vector<Point4> cell24_points() {
  std::vector<Point4> points;
  for (const auto& c : cell24_corners()) points.push_back({0.5 * c[0], 0.5 * c[1], 0.5 * c[2], 0.5 * c[3]});
  return points;
}

/// Copies of a cell around centres, with integer places that tell which corners are equal. `place(centre, v)`: of
/// corner v; `point(place)`: its coordinates, moved by up to `jitter`. The numbers of the points are shuffled.
template <class Place, class Centre, class PlaceOf, class PointOf>
FacetedMesh cells_around(const std::vector<Centre>& centres, const CellFacets4& facets, std::size_t corners,
                         const PlaceOf& place, const PointOf& point, double jitter) {
  std::map<Place, Index> numbers;
  for (const Centre& centre : centres)
    for (std::size_t v = 0; v < corners; ++v) numbers.try_emplace(place(centre, v), static_cast<Index>(numbers.size()));
  std::mt19937_64 random(7);
  std::vector<Index> order(numbers.size());
  for (std::size_t p = 0; p < order.size(); ++p) order[p] = static_cast<Index>(p);
  std::shuffle(order.begin(), order.end(), random);
  FacetedMesh mesh;
  mesh.points.resize(numbers.size());
  for (auto& [at, p] : numbers) {
    p = order[p];
    mesh.points[p] = point(at);
    for (double& x : mesh.points[p]) x += jitter * (static_cast<double>(random() >> 11) * 0x1p-52 - 1.0);
  }
  for (const Centre& centre : centres) {
    std::vector<Index> number;
    for (std::size_t v = 0; v < corners; ++v) number.push_back(numbers.at(place(centre, v)));
    mesh.add(renumbered(facets, number));
  }
  return mesh;
}

/// 24-cells around the points of D4 in a cube of `along` integers along each axis; about [-1, 1]^4.
inline FacetedMesh cells24(int along, double jitter = 0.0) {
  std::vector<std::array<int, 4>> centres;
  for (int n = 0; n < along * along * along * along; ++n) {
    const std::array<int, 4> centre = {n % along, n / along % along, n / along / along % along,
                                       n / along / along / along};
    if ((centre[0] + centre[1] + centre[2] + centre[3]) % 2 == 0) centres.push_back(centre);
  }
  const auto corners = cell24_corners();
  const double scale = 1.0 / (along + 1), middle = 0.5 * (along - 1);
  return cells_around<std::array<int, 4>>(
      centres, hull_facets(cell24_points()), corners.size(),
      [&](const std::array<int, 4>& centre, std::size_t v) {
        std::array<int, 4> at{};
        for (std::size_t a = 0; a < 4; ++a) at[a] = 2 * centre[a] + corners[v][a];
        return at;
      },
      [&](const std::array<int, 4>& at) {
        Point4 point{};
        for (std::size_t a = 0; a < 4; ++a) point[a] = 2.0 * scale * (0.5 * at[a] - middle);
        return point;
      },
      jitter);
}

/// A point of the hyperplane with the sum 0 in 5D, in orthonormal coordinates.
inline Point4 in_hyperplane(const std::array<double, 5>& x) {
  Point4 point{};
  for (std::size_t a = 0; a < 4; ++a) {  // (1, ..., 1, -a-1, 0, ...) / length
    const double n = static_cast<double>(a) + 1.0;
    double sum = -n * x[a + 1];
    for (std::size_t i = 0; i <= a; ++i) sum += x[i];
    point[a] = sum / std::sqrt(n * (n + 1.0));
  }
  return point;
}

/// The Voronoi cells of the lattice A4, each with 30 corners and 20 rhombohedra as facets: around lattice points with
/// coordinates of at most `most`.
inline FacetedMesh rhombic_cells(int most, double jitter = 0.0) {
  using Place = std::array<int, 5>;
  std::vector<std::array<int, 5>> corners;  // the cube's corners, projected
  for (unsigned s = 1; s < 31; ++s) {
    std::array<int, 5>& corner = corners.emplace_back();
    for (unsigned a = 0; a < 5; ++a) corner[a] = static_cast<int>(s >> a & 1u);
  }
  const auto point = [](const Place& at) {
    return in_hyperplane({double(at[0]), double(at[1]), double(at[2]), double(at[3]), double(at[4])});
  };
  std::vector<Point4> points;
  for (const auto& corner : corners) points.push_back(point(corner));
  std::vector<Place> centres;
  const int side = 2 * most + 1;
  for (int n = 0; n < side * side * side * side; ++n) {
    Place centre = {n % side - most, n / side % side - most, n / side / side % side - most,
                    n / side / side / side - most, 0};
    centre[4] = -centre[0] - centre[1] - centre[2] - centre[3];
    if (std::abs(centre[4]) <= most) centres.push_back(centre);
  }
  return cells_around<Place>(
      centres, hull_facets(points), corners.size(),
      [&](const Place& centre, std::size_t v) {
        Place at{};
        for (std::size_t a = 0; a < 5; ++a) at[a] = centre[a] + corners[v][a] - centre[4] - corners[v][4];
        return at;
      },
      point, jitter);
}

/// The rectified 4-simplex: 10 corners, five octahedra and five tetrahedra.
inline std::vector<Point4> rectified_simplex_points() {
  std::vector<Point4> points;
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      std::array<double, 5> x{};
      x[i] = x[j] = 1;
      points.push_back(in_hyperplane(x));
    }
  return points;
}

/// The truncated 4-simplex: 20 corners, five truncated tetrahedra and five tetrahedra.
inline std::vector<Point4> truncated_simplex_points() {
  std::vector<Point4> points;
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j) {
      std::array<double, 5> x{};
      x[i] += 2;
      x[j] += 1;
      if (i != j) points.push_back(in_hyperplane(x));
    }
  return points;
}

/// A cyclic polytope, with an edge between any two corners: points of the curve (cos t, sin t, cos 2 t, sin 2 t).
inline std::vector<Point4> cyclic_points(int corners) {
  std::vector<Point4> points;
  for (int i = 0; i < corners; ++i) {
    const double t = 2 * 3.141592653589793 * i / corners;
    points.push_back({std::cos(t), std::sin(t), std::cos(2 * t), std::sin(2 * t)});
  }
  return points;
}

/// Pyramids with one apex (or two) over a polyhedron in the hyperplane w = 0.
inline std::vector<Point4> pyramid_points(const std::vector<std::array<double, 3>>& base, bool is_double) {
  std::vector<Point4> points;
  for (const auto& p : base) points.push_back({p[0], p[1], p[2], 0.0});
  points.push_back({0, 0, 0, 1});
  if (is_double) points.push_back({0, 0, 0, -1});
  return points;
}

}  // namespace tegl::test
