// SPDX-License-Identifier: BSD-3-Clause
//
// Tunnels of cubes as an ordinary table has them: between the two polygons, by chords of least total squared length
// (H. Fuchs, Z. Kedem and S. Uselton, 1977; here also with chords of one polygon). And the width of a tunnel's waist.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::bench {

using CubeContour = Contour<3, double>;
using CubeTriangle = std::array<Index, 3>;

/// A component of a contour in one cube: its triangles, and the polygons of its boundary along its orientation.
struct CubePiece {
  std::vector<CubeTriangle> triangles;
  std::vector<std::vector<Index>> polygons;
  int euler = 0;

  /// A cylinder between two polygons.
  [[nodiscard]] bool is_tunnel() const { return euler == 0 && polygons.size() == 2; }
};

/// The polygons that the boundary of some triangles consists of.
inline std::vector<std::vector<Index>> boundary_polygons(const std::vector<CubeTriangle>& triangles) {
  std::set<std::pair<Index, Index>> edges;
  for (const CubeTriangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i)
      if (edges.erase({t[(i + 1) % 3], t[i]}) == 0) edges.insert({t[i], t[(i + 1) % 3]});
  std::map<Index, Index> next(edges.begin(), edges.end());
  std::vector<std::vector<Index>> result;
  while (!next.empty()) {
    std::vector<Index>& polygon = result.emplace_back();
    for (auto at = next.begin(); at != next.end(); at = next.find(polygon.back())) {
      polygon.push_back(at->second);
      next.erase(at);
    }
  }
  return result;
}

inline std::vector<CubePiece> pieces_of(const CubeContour& contour) {
  std::vector<CubeTriangle> left(contour.simplices.begin(), contour.simplices.end());
  std::vector<CubePiece> result;
  while (!left.empty()) {
    CubePiece& piece = result.emplace_back();
    std::set<Index> reached(left[0].begin(), left[0].end());
    for (bool has_grown = true; has_grown;) {
      has_grown = false;
      const auto kept = std::stable_partition(left.begin(), left.end(), [&](const CubeTriangle& t) {
        return std::none_of(t.begin(), t.end(), [&](Index v) { return reached.count(v) != 0; });
      });
      for (auto t = kept; t != left.end(); ++t, has_grown = true) reached.insert(t->begin(), t->end());
      piece.triangles.insert(piece.triangles.end(), kept, left.end());
      left.erase(kept, left.end());
    }
    std::set<std::pair<Index, Index>> edges;
    for (const CubeTriangle& t : piece.triangles)
      for (std::size_t i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    piece.euler =
        static_cast<int>(reached.size()) - static_cast<int>(edges.size()) + static_cast<int>(piece.triangles.size());
    piece.polygons = boundary_polygons(piece.triangles);
  }
  return result;
}

/// The squared length of a chord; infinite if it lies in a square of the cube.
inline double cost_of_chord(const CubeContour& contour, Index from, Index to) {
  const auto &p = contour.vertices[from], &q = contour.vertices[to];
  double squares = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (p[a] == q[a] && (p[a] == 0.0 || p[a] == 1.0)) return std::numeric_limits<double>::infinity();
    squares += (p[a] - q[a]) * (p[a] - q[a]);
  }
  return squares;
}

/// Triangles with the total squared length of their chords.
struct ChordTriangles {
  double cost = std::numeric_limits<double>::infinity();
  std::vector<Index> polygon;  ///< the vertices that are left
  std::vector<CubeTriangle> triangles;
};

/// All polygons that remain if vertices are cut off by triangles, each with the least cost.
inline std::vector<ChordTriangles> cut_polygons(const CubeContour& contour, const std::vector<Index>& polygon) {
  std::map<std::vector<Index>, ChordTriangles> level{{polygon, {0.0, polygon, {}}}};
  std::vector<ChordTriangles> result;
  while (!level.empty()) {
    std::map<std::vector<Index>, ChordTriangles> next;
    for (const auto& [left, cut] : level) {
      result.push_back(cut);
      for (std::size_t i = 0; i < left.size() && left.size() > 3; ++i) {
        const Index before = left[(i + left.size() - 1) % left.size()], after = left[(i + 1) % left.size()];
        ChordTriangles longer = cut;
        longer.cost += cost_of_chord(contour, before, after);
        longer.polygon.erase(longer.polygon.begin() + static_cast<std::ptrdiff_t>(i));
        longer.triangles.push_back({before, left[i], after});
        ChordTriangles& known = next[longer.polygon];
        if (longer.cost < known.cost) known = std::move(longer);
      }
    }
    std::erase_if(next, [](const auto& each) { return each.second.polygon.empty(); });
    level = std::move(next);
  }
  return result;
}

/// The triangles between two polygons of opposite orientations, by chords from one to the other.
inline ChordTriangles triangles_between(const CubeContour& contour, const std::vector<Index>& first,
                                        const std::vector<Index>& reversed_second) {
  const std::vector<Index> second(reversed_second.rbegin(), reversed_second.rend());
  const std::size_t rows = first.size(), columns = second.size();
  constexpr double kForbidden = std::numeric_limits<double>::infinity();
  ChordTriangles best;
  for (std::size_t start = 0; start < columns; ++start) {
    // cost[i][j]: of the chords up to the one from vertex i to vertex start + j
    std::vector<std::vector<double>> cost(rows + 1, std::vector<double>(columns + 1, 0.0));
    for (std::size_t i = 0; i <= rows; ++i)
      for (std::size_t j = 0; j <= columns; ++j) {
        const double before = std::min(i > 0 ? cost[i - 1][j] : kForbidden, j > 0 ? cost[i][j - 1] : kForbidden);
        cost[i][j] = i + j > 0 ? before : 0.0;
        cost[i][j] += cost_of_chord(contour, first[i % rows], second[(start + j) % columns]);
      }
    if (!(cost[rows][columns] < best.cost)) continue;
    best = {cost[rows][columns], {}, {}};
    for (std::size_t i = rows, j = columns; i + j > 0;) {
      const Index p = first[i % rows], q = second[(start + j) % columns];
      if (j == 0 || (i > 0 && cost[i - 1][j] <= cost[i][j - 1]))
        best.triangles.push_back({first[--i % rows], p, q});
      else
        best.triangles.push_back({p, q, second[(start + --j) % columns]});
    }
  }
  return best;
}

/// The triangles between two polygons with the least squares, by chords that do not lie in the cube's squares. None if
/// there are none.
inline std::optional<std::vector<CubeTriangle>> triangles_by_chords(const CubeContour& contour,
                                                                    const std::vector<std::vector<Index>>& polygons) {
  ChordTriangles best;
  const auto seconds = cut_polygons(contour, polygons[1]);
  for (const ChordTriangles& first : cut_polygons(contour, polygons[0]))
    for (const ChordTriangles& second : seconds) {
      if (!(first.cost + second.cost < best.cost)) continue;
      ChordTriangles found = triangles_between(contour, first.polygon, second.polygon);
      found.cost += first.cost + second.cost;
      if (!(found.cost < best.cost)) continue;
      for (const ChordTriangles* cut : {&first, &second})
        found.triangles.insert(found.triangles.end(), cut->triangles.begin(), cut->triangles.end());
      best = std::move(found);
    }
  if (best.triangles.empty()) return std::nullopt;
  return best.triangles;
}

/// The contour with its tunnels by chords. None if it has no tunnel, or one that has no such triangles.
inline std::optional<CubeContour> with_chords(const CubeContour& contour) {
  CubeContour result;
  result.vertices = contour.vertices;
  bool has_tunnel = false;
  for (const CubePiece& piece : pieces_of(contour)) {
    std::vector<CubeTriangle> triangles = piece.triangles;
    if (piece.is_tunnel()) {
      auto chords = triangles_by_chords(contour, piece.polygons);
      if (!chords) return std::nullopt;
      triangles = *std::move(chords);
      has_tunnel = true;
    }
    result.simplices.insert(result.simplices.end(), triangles.begin(), triangles.end());
  }
  if (!has_tunnel) return std::nullopt;
  return result;
}

/// A direction and the range of heights between two polygons, if there is one.
struct TunnelAxis {
  std::array<double, 3> direction{};
  double from = 0, to = 0;
};
inline std::optional<TunnelAxis> axis_between(const CubeContour& contour,
                                              const std::vector<std::vector<Index>>& polygons) {
  TunnelAxis axis;
  for (std::size_t k = 0; k < 2; ++k)
    for (const Index v : polygons[k])
      for (std::size_t a = 0; a < 3; ++a)
        axis.direction[a] += (k == 0 ? -1.0 : 1.0) * contour.vertices[v][a] / static_cast<double>(polygons[k].size());
  const double length = std::hypot(axis.direction[0], axis.direction[1], axis.direction[2]);
  for (double& x : axis.direction) x /= length;
  axis.from = -10, axis.to = 10;
  for (std::size_t k = 0; k < 2; ++k)
    for (const Index v : polygons[k]) {
      double height = 0;
      for (std::size_t a = 0; a < 3; ++a) height += axis.direction[a] * contour.vertices[v][a];
      k == 0 ? axis.from = std::max(axis.from, height) : axis.to = std::min(axis.to, height);
    }
  if (!(axis.to - axis.from > 1e-3)) return std::nullopt;
  return axis;
}

/// The least perimeter of sections of a contour across an axis, between its heights, divided by pi: the diameter of a
/// circle of that perimeter.
inline double waist_of(const CubeContour& contour, const TunnelAxis& axis) {
  constexpr int kSections = 64;
  constexpr double kPi = 3.14159265358979323846;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kSections; ++k) {
    const double at = axis.from + (k + 0.5) / kSections * (axis.to - axis.from);
    double perimeter = 0;
    for (const CubeTriangle& t : contour.simplices) {
      std::array<std::array<double, 3>, 2> ends{};
      std::size_t count = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto &p = contour.vertices[t[i]], &q = contour.vertices[t[(i + 1) % 3]];
        double of_p = -at, of_q = -at;
        for (std::size_t a = 0; a < 3; ++a) of_p += axis.direction[a] * p[a], of_q += axis.direction[a] * q[a];
        if ((of_p < 0) == (of_q < 0)) continue;
        for (std::size_t a = 0; a < 3; ++a) ends[count][a] = p[a] + of_p / (of_p - of_q) * (q[a] - p[a]);
        ++count;
      }
      if (count == 2)
        perimeter += std::hypot(ends[0][0] - ends[1][0], ends[0][1] - ends[1][1], ends[0][2] - ends[1][2]);
    }
    least = std::min(least, perimeter);
  }
  return least / kPi;
}

}  // namespace tegl::bench
