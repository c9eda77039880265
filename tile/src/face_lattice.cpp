// SPDX-License-Identifier: BSD-3-Clause
//
// Builds face lattices from the corner sets of the maximal faces: intersections, dimensions, order, orientation.
#include "tegl/tile/face_lattice.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "tegl/tile/complex.hpp"
#include "tegl/tile/cube_faces.hpp"

namespace tegl::tile {

namespace {

/// True if the ascending corners of a precede those of b lexicographically.
bool corners_before(Signature a, Signature b) {
  const Signature differ = a ^ b, lowest = differ & (~differ + 1);
  const bool in_a = (a & lowest) != 0;
  // The set without the lowest differing corner comes later, unless it has no further corners.
  const Signature other = in_a ? b : a;
  const bool other_ends = (other & ~(lowest | (lowest - 1))) == 0;
  return in_a != other_ends;
}

std::vector<Signature> intersections(Signature whole, std::span<const Signature> maximal) {
  std::vector<Signature> sets = {whole};
  for (std::size_t i = 0; i < sets.size(); ++i)
    for (const Signature m : maximal)
      if (const Signature s = sets[i] & m; s != 0 && std::find(sets.begin(), sets.end(), s) == sets.end())
        sets.push_back(s);
  return sets;
}

/// Returns n if it is `least` to 6, else throws std::invalid_argument.
int checked(int n, int least) {
  if (n < least || n > 6)
    throw std::invalid_argument("dimension " + std::to_string(n) + ", expected " + std::to_string(least) + " to 6");
  return n;
}

}  // namespace

FaceLattice::FaceLattice(int dim, std::span<const Signature> maximal_faces) {
  Signature whole = 0;
  for (const Signature m : maximal_faces) whole |= m;
  // corner sets of all faces
  std::vector<Signature> sets = intersections(whole, maximal_faces);
  std::sort(sets.begin(), sets.end(), [](Signature a, Signature b) { return std::popcount(a) < std::popcount(b); });
  // dimension: one more than the largest dimension of a proper face
  for (const Signature s : sets) {
    Face face{.dim = 0, .corners = s};
    for (const Face& below : faces_)
      if (below.corners != s && (below.corners & s) == below.corners) face.dim = std::max(face.dim, below.dim + 1);
    faces_.push_back(std::move(face));
  }
  std::sort(faces_.begin(), faces_.end(), [](const Face& a, const Face& b) {
    return a.dim != b.dim ? a.dim < b.dim : a.corners != b.corners && corners_before(a.corners, b.corners);
  });
  if (faces_.empty() || faces_.back().dim != dim)
    throw std::invalid_argument("faces of a polytope of dimension " +
                                std::to_string(faces_.empty() ? 0 : faces_.back().dim) + ", expected " +
                                std::to_string(dim));
  if (dim > kMaxVertices - 1)
    throw std::invalid_argument("polytope of dimension " + std::to_string(dim) + ", expected at most " +
                                std::to_string(kMaxVertices - 1));
  // incidences and orientation
  for (Face& face : faces_) {
    for (std::uint32_t g = 0; g < faces_.size() && faces_[g].dim < face.dim; ++g)
      if (faces_[g].dim == face.dim - 1 && (faces_[g].corners & face.corners) == faces_[g].corners)
        face.faces.push_back(g);
    check(face);
    orient(face);
  }
}

/// Necessary conditions of a polytope: between a face and each face two dimensions lower there are exactly two others
/// (the diamond property), and the boundary of each face has the Euler characteristic of a sphere. They are not
/// sufficient, but they find forgotten faces.
void FaceLattice::check(const Face& face) const {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("face with corners " + std::to_string(face.corners) + ": " + what);
  };
  if (face.dim > 0 && static_cast<int>(face.faces.size()) < face.dim + 1)
    refuse(std::to_string(face.faces.size()) + " faces of codimension one, expected " + std::to_string(face.dim + 1) +
           " or more");
  int euler = 0;
  for (const Face& below : faces_) {
    if (below.dim >= face.dim || (below.corners & ~face.corners) != 0) continue;
    euler += below.dim % 2 == 0 ? 1 : -1;
    if (below.dim + 2 != face.dim) continue;
    const auto between = std::count_if(face.faces.begin(), face.faces.end(),
                                       [&](std::uint32_t g) { return (below.corners & ~faces_[g].corners) == 0; });
    if (between != 2)
      refuse(std::to_string(between) + " faces between it and corners " + std::to_string(below.corners) +
             ", expected 2");
  }
  if (const int sphere = face.dim % 2 == 1 ? 2 : 0; euler != sphere)
    refuse("a boundary of Euler characteristic " + std::to_string(euler) + ", expected " + std::to_string(sphere));
}

/// The first face gets the sign that the outward-normal-first rule gives for cubes and simplices. Two faces induce
/// opposite orientations on their common face; a breadth-first traversal propagates the signs.
void FaceLattice::orient(Face& face) {
  if (face.dim == 0) return;
  face.signs.assign(face.faces.size(), 0);
  std::vector<std::size_t> reached = {0};
  face.signs[0] = face.dim % 2 == 0 ? 1 : -1;
  if (face.dim == 1 && face.faces.size() == 2) face.signs[1] = 1, reached.push_back(1);
  for (std::size_t r = 0; face.dim > 1 && r < reached.size(); ++r) {
    const Face& g = faces_[face.faces[reached[r]]];
    for (std::size_t j = 0; j < face.faces.size(); ++j) {
      if (face.signs[j] != 0) continue;
      const Face& h = faces_[face.faces[j]];
      for (std::size_t a = 0; a < g.faces.size(); ++a)
        for (std::size_t b = 0; b < h.faces.size(); ++b)
          if (g.faces[a] == h.faces[b] && face.signs[j] == 0) {
            face.signs[j] = -face.signs[reached[r]] * g.signs[a] * h.signs[b];
            reached.push_back(j);
          }
    }
  }
  if (reached.size() != face.faces.size())
    throw std::invalid_argument("a face's boundary that is not connected: no polytope");
}

std::optional<std::uint32_t> FaceLattice::find(Signature corners) const {
  const auto at = std::find_if(faces_.begin(), faces_.end(), [&](const Face& f) { return f.corners == corners; });
  if (at == faces_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(at - faces_.begin());
}

FaceLattice FaceLattice::cube(int n) {
  const detail::CubeFaces cube(checked(n, 1));
  std::vector<Face> faces;
  faces.reserve(cube.cells().size());
  for (const auto& [base, axes, dim] : cube.cells()) {
    Face& face = faces.emplace_back(Face{.dim = dim});
    for (unsigned v = axes;; v = (v - 1) & axes) {
      face.corners |= Signature{1} << (base | v);
      if (v == 0) break;
    }
    // incidence numbers: outward normal first, axes ascending
    std::array<std::pair<std::uint32_t, int>, 12> below;
    std::size_t count = 0;
    int sign = -1;  // at the lower end of an axis
    for (unsigned rest = axes; rest != 0; rest &= rest - 1, sign = -sign) {
      const unsigned axis = rest & (0 - rest);
      below[count++] = {cube.number(base, axes & ~axis), sign};
      below[count++] = {cube.number(base | axis, axes & ~axis), -sign};
    }
    std::sort(below.begin(), below.begin() + static_cast<std::ptrdiff_t>(count));
    face.faces.reserve(count);
    face.signs.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      face.faces.push_back(below[i].first);
      face.signs.push_back(below[i].second);
    }
  }
  FaceLattice lattice(1, std::array<Signature, 2>{1, 2});  // replaced: nothing here needs to be found or checked
  lattice.faces_ = std::move(faces);
  return lattice;
}

FaceLattice FaceLattice::simplex(int n) {
  checked(n, 1);
  std::vector<Signature> maximal;
  for (int v = 0; v <= n; ++v) maximal.push_back(((Signature{2} << n) - 1) & ~(Signature{1} << v));
  return {n, maximal};
}

FaceLattice FaceLattice::octahedron(int n) {
  checked(n, 2);
  std::vector<Signature> maximal;
  for (int sides = 0; sides < 1 << n; ++sides) {
    Signature corners = 0;
    for (int axis = 0; axis < n; ++axis) corners |= Signature{1} << (2 * axis + ((sides >> axis) & 1));
    maximal.push_back(corners);
  }
  return {n, maximal};
}

}  // namespace tegl::tile
