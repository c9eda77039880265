// SPDX-License-Identifier: BSD-3-Clause
//
// Orients tetrahedra that have common faces alike.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <utility>
#include <vector>

namespace tegl::detail {

template <class Vertex, std::size_t Count>
std::array<Vertex, Count> sorted(std::array<Vertex, Count> vertices) noexcept {
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

/// A face of a tetrahedron, in the order that the tetrahedron induces.
template <class Vertex>
std::array<Vertex, 3> face_of(const std::array<Vertex, 4>& t, unsigned opposite) noexcept {
  constexpr unsigned char kFaces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  const auto& of = kFaces[opposite];
  return {t[of[0]], t[of[1]], t[of[2]]};
}

/// Whether two orders of the same vertices are rotations of each other.
template <class Vertex>
bool same_turn(const std::array<Vertex, 3>& a, const std::array<Vertex, 3>& b) noexcept {
  using Triangle = std::array<Vertex, 3>;
  return b == a || b == Triangle{a[1], a[2], a[0]} || b == Triangle{a[2], a[0], a[1]};
}

/// Orients tetrahedra so that they induce the triangles `starts`, and neighbours are oriented alike. Each connected
/// part has one of the triangles.
template <class Vertex>
void orient(std::vector<std::array<Vertex, 4>>& tetrahedra, std::vector<std::array<Vertex, 3>> starts) {
  using Triangle = std::array<Vertex, 3>;
  std::map<Triangle, std::vector<std::size_t>> at_face;
  for (std::size_t i = 0; i < tetrahedra.size(); ++i)
    for (unsigned k = 0; k < 4; ++k) at_face[sorted(face_of(tetrahedra[i], k))].push_back(i);
  std::vector<bool> is_known(tetrahedra.size());
  std::deque<std::size_t> open;
  const auto take = [&](std::size_t i, const Triangle& face, bool same) {
    if (is_known[i]) return;
    is_known[i] = true;
    auto& t = tetrahedra[i];
    for (unsigned k = 0; k < 4; ++k)
      if (const Triangle own = face_of(t, k); sorted(own) == sorted(face)) {
        if (same_turn(own, face) != same) std::swap(t[2], t[3]);
        break;
      }
    open.push_back(i);
  };
  std::sort(starts.begin(), starts.end(), [](const Triangle& a, const Triangle& b) { return sorted(a) < sorted(b); });
  for (const Triangle& start : starts) {
    take(at_face.at(sorted(start)).front(), start, true);
    for (; !open.empty(); open.pop_front()) {
      const auto t = tetrahedra[open.front()];
      for (unsigned k = 0; k < 4; ++k)
        for (const std::size_t other : at_face.at(sorted(face_of(t, k)))) take(other, face_of(t, k), false);
    }
  }
}

}  // namespace tegl::detail
