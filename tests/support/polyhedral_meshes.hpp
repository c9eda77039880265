// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes of polyhedra and polygons for tests: truncated octahedra, Voronoi cells, and cells merged with a neighbour.
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

#include "meshes.hpp"
#include "polytope/recognised_polyhedron.hpp"
#include "tegl/complex.hpp"
#include "tegl/delaunay.hpp"
#include "tegl/error.hpp"

namespace tegl::test {

using FaceRing = std::vector<Index>;       ///< the corners around a face
using CellFaces3 = std::vector<FaceRing>;  ///< the faces of a cell

/// Points and cells by their faces; a cell with a type that has fixed corners has these, too.
struct FacedMesh {
  std::vector<std::array<double, 3>> points;
  std::vector<CellFaces3> cells;
  std::vector<std::pair<CellType, std::vector<Index>>> known;  ///< by cell; polyhedron: by faces alone

  void add(CellFaces3 faces) {
    cells.push_back(std::move(faces));
    known.emplace_back(CellType::polyhedron, std::vector<Index>());
  }
  [[nodiscard]] CellLists lists() const {
    CellLists lists;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      lists.types.push_back(known[c].first);
      lists.corners.insert(lists.corners.end(), known[c].second.begin(), known[c].second.end());
      lists.ends.push_back(lists.corners.size());
      if (known[c].first == CellType::polyhedron)
        for (const FaceRing& ring : cells[c]) {
          lists.face_corners.insert(lists.face_corners.end(), ring.begin(), ring.end());
          lists.face_ends.push_back(lists.face_corners.size());
        }
      lists.face_lists_ends.push_back(lists.face_ends.size());
    }
    return lists;
  }
  [[nodiscard]] Complex<3> complex() const { return Complex<3>(points, lists()); }
};

inline FaceRing sorted(FaceRing ring) {
  std::sort(ring.begin(), ring.end());
  return ring;
}

/// The points of faces that one cell only has.
inline std::vector<bool> border_points(const FacedMesh& mesh) {
  std::map<FaceRing, int> uses;
  for (const CellFaces3& cell : mesh.cells)
    for (const FaceRing& ring : cell) ++uses[sorted(ring)];
  std::vector<bool> result(mesh.points.size());
  for (const auto& [ring, count] : uses)
    if (count == 1)
      for (const Index p : ring) result[p] = true;
  return result;
}

/// Noise in [0, 1), below 0 on the border.
inline std::vector<double> closed_noise(const FacedMesh& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const std::vector<bool> border = border_points(mesh);
  std::vector<double> values;
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const double value = static_cast<double>(random() >> 11) * 0x1p-53;
    values.push_back(border[p] ? -1.0 : value);
  }
  return values;
}

/// The faces of the convex hull of points, in the numbers of the points. Every point must be a corner.
inline CellFaces3 hull_faces(const std::vector<std::array<double, 3>>& points) {
  using Vector = std::array<double, 3>;
  const auto minus = [](const Vector& a, const Vector& b) { return Vector{a[0] - b[0], a[1] - b[1], a[2] - b[2]}; };
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const auto dot = [](const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  std::set<FaceRing> faces;
  CellFaces3 rings;
  const auto count = static_cast<Index>(points.size());
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j)
      for (Index k = j + 1; k < count; ++k) {
        if (i >= j) continue;
        const Vector normal = cross(minus(points[j], points[i]), minus(points[k], points[i]));
        FaceRing face;
        int above = 0, below = 0;
        for (Index p = 0; p < count; ++p) {
          const double side = dot(normal, minus(points[p], points[i]));
          if (std::abs(side) < 1e-9)
            face.push_back(p);
          else
            ++(side > 0 ? above : below);
        }
        if ((above > 0 && below > 0) || !faces.insert(face).second) continue;
        Vector centre{};
        for (const Index p : face)
          for (std::size_t a = 0; a < 3; ++a) centre[a] += points[p][a] / static_cast<double>(face.size());
        const Vector u = minus(points[face[0]], centre), v = cross(normal, u);
        std::sort(face.begin(), face.end(), [&](Index p, Index q) {
          const auto angle = [&](Index x) {
            const Vector d = minus(points[x], centre);
            return std::atan2(dot(d, v) / std::sqrt(dot(v, v)), dot(d, u) / std::sqrt(dot(u, u)));
          };
          return angle(p) < angle(q);
        });
        rings.push_back(face);
      }
  return rings;
}

/// One cell around points.
inline FacedMesh hull(std::vector<std::array<double, 3>> points) {
  FacedMesh mesh;
  mesh.add(hull_faces(points));
  mesh.points = std::move(points);
  return mesh;
}

inline std::vector<std::array<double, 3>> prism_points(int sides) {
  std::vector<std::array<double, 3>> points;
  for (const double z : {-1.0, 1.0})
    for (int i = 0; i < sides; ++i)
      points.push_back({std::cos(2 * 3.141592653589793 * i / sides), std::sin(2 * 3.141592653589793 * i / sides), z});
  return points;
}

inline std::vector<std::array<double, 3>> dodecahedron_points() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<std::array<double, 3>> points;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0}) {
      points.push_back({0, a / g, b * g});
      points.push_back({a / g, b * g, 0});
      points.push_back({b * g, 0, a / g});
      for (const double c : {-1.0, 1.0}) points.push_back({a, b, c});
    }
  return points;
}

inline std::vector<std::array<double, 3>> truncated_octahedron_points() {
  std::vector<std::array<double, 3>> points;
  for (std::size_t zero = 0; zero < 3; ++zero)
    for (const double a : {-1.0, 1.0, -2.0, 2.0})
      for (const double b : {-1.0, 1.0}) {
        std::array<double, 3> point{};
        point[(zero + 1) % 3] = a;
        point[(zero + 2) % 3] = b * (3 - std::abs(a));
        points.push_back(point);
      }
  return points;
}

/// Truncated octahedra that fill a cube of about [-1, 1]^3: the cells of a body-centred cubic lattice, `count` along
/// each axis. Points are moved by up to `jitter` edges.
inline FacedMesh truncated_octahedra(int count, double jitter, std::uint64_t seed = 1) {
  const auto corners = truncated_octahedron_points();
  const CellFaces3 faces = hull_faces(corners);
  FacedMesh mesh;
  std::map<std::array<int, 3>, Index> numbers;
  const auto number = [&](const std::array<int, 3>& at) {
    return numbers.try_emplace(at, static_cast<Index>(numbers.size())).first->second;
  };
  for (int i = 0; i < 2 * count; ++i)
    for (int j = i % 2; j < 2 * count; j += 2)
      for (int k = i % 2; k < 2 * count; k += 2) {
        CellFaces3 cell;
        for (const FaceRing& ring : faces) {
          FaceRing& of_cell = cell.emplace_back();
          for (const Index v : ring)
            of_cell.push_back(number({2 * i + static_cast<int>(corners[v][0]), 2 * j + static_cast<int>(corners[v][1]),
                                      2 * k + static_cast<int>(corners[v][2])}));
        }
        mesh.add(std::move(cell));
      }
  mesh.points.resize(numbers.size());
  std::mt19937_64 random(seed);
  const double middle = 2 * count - 1, scale = 1.0 / (2 * count + 1);
  for (const auto& [at, p] : numbers)
    for (std::size_t a = 0; a < 3; ++a) {
      const double shift = 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0;
      mesh.points[p][a] = scale * (at[a] - middle + jitter * shift);
    }
  return mesh;
}

/// The Voronoi cells of random points in a cube, of those whose cells are within the cube.
inline FacedMesh voronoi_cells(std::size_t sites, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::array<double, 3>> points(sites);
  for (auto& point : points)
    for (double& x : point) x = 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0;
  const std::vector<Index> corners = delaunay_corners<3>(points);
  FacedMesh mesh;
  std::map<std::pair<Index, Index>, std::vector<Index>> around;  // tetrahedra at each edge
  std::vector<std::vector<std::pair<Index, Index>>> edges_at(sites);
  for (Index t = 0; t < corners.size() / 4; ++t) {
    const Index* const c = corners.data() + 4 * std::size_t{t};
    // the centre x with |x - a|^2 equal for all corners
    std::array<std::array<double, 4>, 3> rows;
    for (std::size_t i = 0; i < 3; ++i) {
      rows[i][3] = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        rows[i][a] = 2 * (points[c[i + 1]][a] - points[c[0]][a]);
        rows[i][3] += points[c[i + 1]][a] * points[c[i + 1]][a] - points[c[0]][a] * points[c[0]][a];
      }
    }
    const auto det = [&](std::size_t x, std::size_t y, std::size_t z) {
      return rows[0][x] * (rows[1][y] * rows[2][z] - rows[1][z] * rows[2][y]) -
             rows[0][y] * (rows[1][x] * rows[2][z] - rows[1][z] * rows[2][x]) +
             rows[0][z] * (rows[1][x] * rows[2][y] - rows[1][y] * rows[2][x]);
    };
    mesh.points.push_back({det(3, 1, 2) / det(0, 1, 2), det(0, 3, 2) / det(0, 1, 2), det(0, 1, 3) / det(0, 1, 2)});
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) around[std::minmax(c[i], c[j])].push_back(t);
  }
  for (const auto& [edge, cells] : around) {
    edges_at[edge.first].push_back(edge);
    edges_at[edge.second].push_back(edge);
  }
  const auto are_neighbours = [&](Index t, Index u) {
    int common = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) common += corners[4 * std::size_t{t} + i] == corners[4 * std::size_t{u} + j];
    return common == 3;
  };
  for (std::size_t site = 0; site < sites; ++site) {
    CellFaces3 cell;
    bool is_inside = true;
    for (const auto& edge : edges_at[site]) {
      std::vector<Index> left = around[edge];
      FaceRing ring{left.back()};
      left.pop_back();
      while (!left.empty()) {
        const auto next =
            std::find_if(left.begin(), left.end(), [&](Index t) { return are_neighbours(ring.back(), t); });
        if (next == left.end()) break;
        ring.push_back(*next);
        left.erase(next);
      }
      is_inside = is_inside && left.empty() && ring.size() > 2 && are_neighbours(ring.back(), ring.front());
      for (const Index t : ring)
        for (const double x : mesh.points[t]) is_inside = is_inside && std::abs(x) < 1.0;
      cell.push_back(std::move(ring));
    }
    if (is_inside) mesh.add(std::move(cell));
  }
  // without points of other cells
  std::vector<Index> number(mesh.points.size(), static_cast<Index>(mesh.points.size()));
  std::vector<std::array<double, 3>> used;
  for (CellFaces3& cell : mesh.cells)
    for (FaceRing& ring : cell)
      for (Index& p : ring) {
        if (number[p] == mesh.points.size()) {
          number[p] = static_cast<Index>(used.size());
          used.push_back(mesh.points[p]);
        }
        p = number[p];
      }
  mesh.points = std::move(used);
  return mesh;
}

/// The faces of a cell of VTK.
inline CellFaces3 faces_of(CellType type, const Index* c) {
  const auto all = [&](std::initializer_list<std::initializer_list<int>> rings) {
    CellFaces3 faces;
    for (const auto& ring : rings) {
      FaceRing& face = faces.emplace_back();
      for (const int v : ring) face.push_back(c[v]);
    }
    return faces;
  };
  if (type == CellType::tetrahedron) return all({{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}});
  if (type == CellType::pyramid) return all({{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  if (type == CellType::wedge) return all({{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
  if (type == CellType::octahedron)
    return all({{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {0, 2, 5}, {2, 1, 5}, {1, 3, 5}, {3, 0, 5}});
  return all({{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

/// A mesh of other cells by faces.
inline FacedMesh faced(const MeshData<3>& from) {
  FacedMesh mesh;
  mesh.points = from.points;
  const Index* corners = from.corners.data();
  for (const CellType type : from.types) {
    mesh.cells.push_back(faces_of(type, corners));
    mesh.known.emplace_back(type, std::vector<Index>(corners, corners + corner_count(type)));
    corners += corner_count(type);
  }
  return mesh;
}

/// Merges cells with a neighbour, where the result is a polyhedron without a table and no third cell has faces of both:
/// cells with tables may share one face with another cell. Each cell with this probability.
inline FacedMesh merged(const FacedMesh& from, double probability, std::uint64_t seed) {
  std::map<FaceRing, std::vector<std::size_t>> cells_at;
  for (std::size_t c = 0; c < from.cells.size(); ++c)
    for (const FaceRing& ring : from.cells[c]) cells_at[sorted(ring)].push_back(c);
  FacedMesh mesh;
  mesh.points = from.points;
  std::mt19937_64 random(seed);
  std::vector<bool> is_done(from.cells.size());
  const auto neighbours = [&](std::size_t c) {
    std::set<std::size_t> found;
    for (const FaceRing& ring : from.cells[c])
      for (const std::size_t other : cells_at[sorted(ring)]) found.insert(other);
    return found;
  };
  const auto have_common_neighbour = [&](std::size_t c, std::size_t other) {
    const auto of_other = neighbours(other);
    const auto of_cell = neighbours(c);
    return std::any_of(of_cell.begin(), of_cell.end(),
                       [&](std::size_t n) { return n != c && n != other && of_other.count(n) != 0; });
  };
  const auto merge = [&](std::size_t c) -> std::optional<CellFaces3> {
    for (const FaceRing& common : from.cells[c]) {
      const auto& cells = cells_at[sorted(common)];
      if (cells.size() != 2) continue;
      const std::size_t other = cells[0] == c ? cells[1] : cells[0];
      if (is_done[other] || have_common_neighbour(c, other)) continue;
      CellFaces3 faces;
      for (const std::size_t cell : {c, other})
        for (const FaceRing& ring : from.cells[cell])
          if (sorted(ring) != sorted(common)) faces.push_back(ring);
      std::vector<Index> all;
      std::vector<std::uint64_t> ends;
      for (const FaceRing& ring : faces) {
        all.insert(all.end(), ring.begin(), ring.end());
        ends.push_back(all.size());
      }
      try {
        if (detail::recognise_polyhedron(c, from.points.size(), all, ends).shape != detail::PolyhedronShape::other)
          continue;
      } catch (const Error&) {
        continue;
      }
      is_done[c] = is_done[other] = true;
      return faces;
    }
    return std::nullopt;
  };
  for (std::size_t c = 0; c < from.cells.size(); ++c) {
    if (is_done[c]) continue;
    if (static_cast<double>(random() >> 11) * 0x1p-53 < probability)
      if (auto faces = merge(c)) {
        mesh.add(std::move(*faces));
        continue;
      }
    mesh.cells.push_back(from.cells[c]);
    mesh.known.push_back(from.known[c]);
    is_done[c] = true;
  }
  return mesh;
}

}  // namespace tegl::test
