// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of a cell of a mesh by the general engine, which knows the cell's faces and nothing else, to compare
// contours of complexes with.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "complex/cell_groups.hpp"
#include "tegl/complex.hpp"
#include "tegl/saddle.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::test {

/// The facets of a shape's convex hull as sets of corners, found by trying all hyperplanes through corners.
template <int N>
std::vector<tile::Signature> hull_facets(const tables::CellTable& table) {
  using Vector = Eigen::Matrix<double, N, 1>;
  const auto corner = [&](unsigned v) {
    return Vector(Eigen::Map<const Eigen::Matrix<std::int8_t, N, 1>>(table.corners + N * v).template cast<double>());
  };
  std::set<tile::Signature> facets;
  for (unsigned chosen = 0; chosen < 1u << table.corner_count; ++chosen) {
    if (std::popcount(chosen) != N) continue;
    const auto first = static_cast<unsigned>(std::countr_zero(chosen));
    Eigen::Matrix<double, N - 1, N> across;
    int row = 0;
    for (unsigned rest = chosen & (chosen - 1); rest != 0; rest &= rest - 1)
      across.row(row++) = corner(static_cast<unsigned>(std::countr_zero(rest))) - corner(first);
    const Eigen::FullPivLU<Eigen::Matrix<double, N - 1, N>> lu(across);
    if (lu.rank() < N - 1) continue;
    const Vector normal = lu.kernel().col(0).normalized();
    tile::Signature on = 0;
    bool above = false, below = false;
    for (unsigned v = 0; v < table.corner_count; ++v) {
      const double height = normal.dot(corner(v) - corner(first));
      if (std::abs(height) < 1e-9) on |= tile::Signature{1} << v;
      above = above || height > 1e-9;
      below = below || height < -1e-9;
    }
    if (!(above && below)) facets.insert(on);
  }
  return {facets.begin(), facets.end()};
}

/// The contour of a cell: simplices by any numbers of their vertices, and for each number the edge (as a set of two
/// corners) that the vertex is on, or 0.
template <int N>
struct CellPieces {
  std::vector<std::array<std::size_t, N>> simplices = {};
  std::map<std::size_t, tile::Signature> edge_of = {};

  /// The simplices by the edges of their vertices, ascending; the last number is 1 for an odd order of the vertices, if
  /// all are on edges. `flip`: 1 for the other orientation.
  [[nodiscard]] std::multiset<std::array<tile::Signature, N + 1>> by_edges(unsigned flip) const {
    std::multiset<std::array<tile::Signature, N + 1>> result;
    for (const auto& simplex : simplices) {
      std::array<tile::Signature, N + 1> edges{};
      unsigned inversions = flip;
      for (int i = 0; i < N; ++i) {
        edges[i] = edge_of.at(simplex[i]);
        for (int j = 0; j < i; ++j) inversions += edges[j] > edges[i] ? 1 : 0;
      }
      std::sort(edges.begin(), edges.end() - 1);
      edges[N] = edges[0] == 0 ? 0 : inversions % 2;
      result.insert(edges);
    }
    return result;
  }
  /// The boundary's simplices by the edges of their vertices, ascending, and the Euler characteristic.
  [[nodiscard]] std::pair<std::multiset<std::vector<tile::Signature>>, int> boundary_and_euler() const {
    std::map<std::vector<std::size_t>, int> faces;
    for (const auto& simplex : simplices)
      for (unsigned subset = 1; subset < 1u << N; ++subset) {
        std::vector<std::size_t> face;
        for (unsigned i = 0; i < N; ++i)
          if ((subset >> i & 1u) != 0) face.push_back(simplex[i]);
        std::sort(face.begin(), face.end());
        ++faces[face];
      }
    std::pair<std::multiset<std::vector<tile::Signature>>, int> result;
    for (const auto& [face, times] : faces) {
      result.second += face.size() % 2 == 1 ? 1 : -1;
      if (face.size() != N - 1 || times != 1) continue;
      std::vector<tile::Signature> edges;
      for (const std::size_t v : face) edges.push_back(edge_of.at(v));
      std::sort(edges.begin(), edges.end());
      result.first.insert(edges);
    }
    return result;
  }
};

/// The contour of a cell by the general engine.
template <int N>
CellPieces<N> pieces_of(const tile::TileFacets& built, const std::vector<tile::Face>& faces) {
  CellPieces<N> pieces;
  for (std::size_t v = 0; v < built.vertices.size(); ++v)
    pieces.edge_of[v] = built.vertices[v].kind == tile::VertexKind::edge ? faces[built.vertices[v].face].corners : 0;
  for (const tile::Facet& facet : built.facets)
    for (const auto& simplex : facet.simplices) {
      pieces.simplices.emplace_back();
      std::copy_n(simplex.begin(), N, pieces.simplices.back().begin());
    }
  return pieces;
}

/// Euler characteristic and number of connected components.
template <int N>
std::pair<int, std::size_t> topology_of(const CellPieces<N>& pieces) {
  std::map<std::size_t, std::size_t> parent;
  const auto root = [&](std::size_t v) {
    while (parent.at(v) != v) v = parent.at(v);
    return v;
  };
  for (const auto& simplex : pieces.simplices)
    for (const std::size_t v : simplex) {
      parent.try_emplace(v, v);
      parent[root(v)] = root(simplex[0]);
    }
  const auto is_root = [](const auto& each) { return each.first == each.second; };
  std::set<std::vector<std::size_t>> faces;
  for (const auto& simplex : pieces.simplices)
    for (unsigned subset = 1; subset < 1u << N; ++subset) {
      std::vector<std::size_t> face;
      for (unsigned i = 0; i < N; ++i)
        if ((subset >> i & 1u) != 0) face.push_back(simplex[i]);
      std::sort(face.begin(), face.end());
      faces.insert(std::move(face));
    }
  int euler = 0;
  for (const auto& face : faces) euler += face.size() % 2 == 1 ? 1 : -1;
  return {euler, static_cast<std::size_t>(std::count_if(parent.begin(), parent.end(), is_root))};
}

/// The values at the corners of a cube in a cell, corner v at coordinate v >> a & 1 of axis a.
template <int N>
std::array<double, 8> values_of_cube(const tables::CellTable& table, tile::Signature cube,
                                     const std::vector<double>& values, const std::vector<tile::Face>& faces) {
  const auto first = static_cast<unsigned>(std::countr_zero(cube));
  std::vector<unsigned> next;  // the other ends of the edges at the first corner
  for (const tile::Face& edge : faces)
    if (edge.dim == 1 && (edge.corners & ~cube) == 0 && (edge.corners >> first & 1u) != 0)
      next.push_back(static_cast<unsigned>(std::countr_zero(edge.corners ^ tile::Signature{1} << first)));
  std::array<double, 8> result{};
  for (unsigned v = 0; v < 8; ++v) {
    std::array<int, N> place{};
    for (unsigned a = 0; a < N; ++a) {
      place[a] = table.corners[N * first + a];
      for (unsigned k = 0; k < 3; ++k)
        place[a] += (v >> k & 1u) != 0 ? table.corners[N * next.at(k) + a] - table.corners[N * first + a] : 0;
    }
    for (tile::Signature rest = cube; rest != 0; rest &= rest - 1) {
      const auto corner = static_cast<unsigned>(std::countr_zero(rest));
      if (std::equal(place.begin(), place.end(), table.corners + N * corner)) result[v] = values[corner];
    }
  }
  return result;
}

/// Whether a face is a cube, or an octahedron or 16-cell: by its corners and edges.
inline bool is_cube_or_cross(const tile::Face& face, const std::vector<tile::Face>& faces) {
  const auto corners = static_cast<std::ptrdiff_t>(std::popcount(face.corners));
  const auto edges = std::count_if(faces.begin(), faces.end(), [&](const tile::Face& edge) {
    return edge.dim == 1 && (edge.corners & ~face.corners) == 0;
  });
  const std::ptrdiff_t n = face.dim;
  return (corners == 1 << n && edges == n << (n - 1)) || (n > 2 && corners == 2 * n && edges == 2 * n * (n - 1));
}

/// The resolution of a cell by a rule that reads the data. Ambiguous quadrilaterals by the mean of their corners or by
/// the value at their saddle. By `mean` and `saddle` the insides of cubes by the mean or by the trilinear interpolant,
/// and those of tesseracts, octahedra and 16-cells by the mean; all others separate.
template <int N>
std::vector<tile::Choice> choices_of(const tables::CellTable& table, const std::vector<tile::Face>& faces,
                                     const std::vector<double>& values, Ambiguity rule) {
  const bool is_mean = rule == Ambiguity::mean || rule == Ambiguity::squares;
  const bool joins = rule == Ambiguity::mean || rule == Ambiguity::saddle;
  std::vector<tile::Choice> choices(faces.size(), tile::Choice::separate);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].dim < 2 || !is_cube_or_cross(faces[f], faces) || (faces[f].dim > 2 && !joins)) continue;
    double sum = 0, high = 1, low = 1;
    for (std::size_t v = 0; v < values.size(); ++v) {
      if ((faces[f].corners >> v & 1u) == 0) continue;
      sum += values[v];
      (values[v] >= 0 ? high : low) *= values[v];
    }
    const bool is_high = faces[f].dim > 2 || is_mean ? sum >= 0 : high >= low;
    choices[f] = is_high ? tile::Choice::high : tile::Choice::low;
    if constexpr (N > 2)
      if (faces[f].dim == 3 && std::popcount(faces[f].corners) == 8 && rule == Ambiguity::saddle)
        choices[f] = cube_choice<double>(values_of_cube<N>(table, faces[f].corners, values, faces), 0.0);
  }
  return choices;
}

/// The resolution of a cell by any rule. `choices` has its choices.
template <int N>
tile::Resolution resolution_of(const tables::CellTable& table, const std::vector<tile::Face>& faces,
                               const std::vector<double>& values, Ambiguity rule, std::vector<tile::Choice>& choices) {
  const bool is_fixed = rule == Ambiguity::low || rule == Ambiguity::high;
  choices = is_fixed ? std::vector<tile::Choice>() : choices_of<N>(table, faces, values, rule);
  return {choices, rule == Ambiguity::high ? tile::Alternative::high : tile::Alternative::low};
}

}  // namespace tegl::test
