// SPDX-License-Identifier: BSD-3-Clause
//
// Sigma, the contour in the boundary of a 4D cell, as triangles in the cell's facets.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "base/disjoint_sets.hpp"

namespace tegl::detail {

/// A triangle of Sigma, the contour in a cell's boundary, and its facet.
template <class Local>
struct SigmaPiece {
  std::array<Local, 3> triangle;
  std::size_t facet;
};
/// The connected components of Sigma, by a vertex. `end`: above all vertices.
template <class Local>
std::map<Index, std::vector<SigmaPiece<Local>>> components_of(const std::vector<SigmaPiece<Local>>& sigma, Index end) {
  DisjointSets sets(end);
  for (const auto& [t, facet] : sigma) sets.join(t[0], t[1]), sets.join(t[0], t[2]);
  std::map<Index, std::vector<SigmaPiece<Local>>> components;
  for (const SigmaPiece<Local>& piece : sigma) components[sets.find(piece.triangle[0])].push_back(piece);
  return components;
}
/// The vertices of a component, ascending.
template <class Local>
std::vector<Local> vertices_of(const std::vector<SigmaPiece<Local>>& component) {
  std::vector<Local> vertices;
  vertices.reserve(3 * component.size());
  for (const auto& [t, facet] : component) vertices.insert(vertices.end(), t.begin(), t.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}
/// Whether a component is a sphere, by the Euler characteristic of a closed surface.
template <class Local>
bool is_sphere(const std::vector<SigmaPiece<Local>>& component) {
  return 2 * vertices_of(component).size() == component.size() + 4;
}
/// A vertex of a component.
template <class Local>
Local first_of(const std::vector<SigmaPiece<Local>>& component) noexcept {
  return component.front().triangle[0];
}
/// The tetrahedron between a triangle and a vertex inside the cell, with its positive side towards high.
template <class Local>
std::array<Local, 4> cone_of(const std::array<Local, 3>& t, bool is_inverted, Local apex) noexcept {
  return {t[0], is_inverted ? t[1] : t[2], is_inverted ? t[2] : t[1], apex};
}

}  // namespace tegl::detail
