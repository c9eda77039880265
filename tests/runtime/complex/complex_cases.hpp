// SPDX-License-Identifier: BSD-3-Clause
//
// What tests of complexes of images have in common.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "complex/cell_groups.hpp"
#include "meshes.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {

/// All rules for ambiguous faces that complexes take.
inline constexpr std::array kAllRules = {Ambiguity::low,    Ambiguity::high,    Ambiguity::mean,
                                         Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider};

/// A ball of radius 0.7 around the origin.
template <int N>
double ball(const std::array<double, N>& x) {
  double square = 0.0;
  for (const double each : x) square += each * each;
  return 0.7 - std::sqrt(square);
}

/// The image with the values of a grid's points in [-1, 1].
template <int N>
OwnedImage<double, N> image_of(const MeshData<N>& mesh, const std::vector<double>& values) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) {
    const double step = 2.0 / static_cast<double>(mesh.sizes[a] - 1);
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < mesh.sizes[a]; ++i) coordinates.push_back(-1.0 + step * static_cast<double>(i));
    grid.axes[a] = Axis::rectilinear(coordinates);
  }
  return {grid, Values<double>(values)};
}

/// Both triangulations with both fixed rules for ambiguous faces.
inline std::vector<ExtractOptions> fixed_rules() {
  std::vector<ExtractOptions> rules;
  for (const Triangulation triangulation : {Triangulation::barycentric, Triangulation::compact})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
      ExtractOptions& options = rules.emplace_back();
      options.triangulation = triangulation;
      options.ambiguity = ambiguity;
    }
  return rules;
}

/// Adds a cell with the reference corners of its shape, numbered at random. Returns the number of each corner.
template <int N>
std::vector<Index> add_corners(const detail::CellKind& kind, std::mt19937_64& random,
                               std::vector<std::array<double, N>>& points, std::vector<Index>& cells) {
  const tables::CellTable& table = detail::table_of(kind.shape);
  std::vector<Index> number(table.corner_count);
  std::iota(number.begin(), number.end(), static_cast<Index>(points.size()));
  std::shuffle(number.begin(), number.end(), random);
  points.resize(points.size() + number.size());
  for (std::size_t v = 0; v < number.size(); ++v)
    for (std::size_t a = 0; a < N; ++a) points[number[v]][a] = table.corners[N * v + a];
  for (std::size_t i = 0; i < number.size(); ++i) cells.push_back(number[detail::table_corner(kind, i)]);
  return number;
}

}  // namespace tegl::test
