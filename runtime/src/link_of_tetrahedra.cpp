// SPDX-License-Identifier: BSD-3-Clause
//
// Spheres and balls of dimension 3, shown by collapse: a manifold that collapses to a point is a ball, a closed one
// that does so without one of its tetrahedra is a sphere. Tetrahedra go first, each through a triangle that it shares
// with none any more, then triangles through edges; what remains is a graph, and a tree by its Euler characteristic.
// Whether the triangles go depends on the order of the tetrahedra alone.
//
// Based on: J. H. C. Whitehead, Simplicial spaces, nuclei and m-groups, 1939 (collapse); B. Benedetti and F. H. Lutz,
// Random discrete Morse theory and a new library of triangulations, 2014 (in practice random orders do).
#include "link_of_tetrahedra.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace tegl::detail {
namespace {

constexpr std::array<std::array<unsigned, 2>, 6> kEdges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// The edges of the triangle opposite of a corner.
constexpr std::array<std::array<unsigned, 3>, 4> kEdgesOpposite = {{{3, 4, 5}, {1, 2, 5}, {0, 2, 4}, {0, 1, 3}}};

std::uint32_t find(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Whether the two were apart.
bool join(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
  a = find(parent, a);
  b = find(parent, b);
  parent[b] = a;
  return a != b;
}

}  // namespace

void LinkOfTetrahedra::load(std::span<const Piece> pieces) {
  number_vertices(pieces);
  number_edges();
  number_triangles();
}

void LinkOfTetrahedra::number_vertices(std::span<const Piece> pieces) {
  vertices_.clear();
  for (const Piece& piece : pieces) vertices_.insert(vertices_.end(), piece.begin(), piece.end());
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  corners_.resize(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (unsigned i = 0; i < 4; ++i)
      corners_[p][i] = static_cast<std::uint32_t>(std::lower_bound(vertices_.begin(), vertices_.end(), pieces[p][i]) -
                                                  vertices_.begin());
    std::sort(corners_[p].begin(), corners_[p].end());
  }
}

void LinkOfTetrahedra::number_edges() {
  keys_.clear();
  for (std::size_t p = 0; p < corners_.size(); ++p)
    for (std::size_t e = 0; e < 6; ++e)
      keys_.push_back({std::uint64_t{corners_[p][kEdges[e][0]]} << 32 | corners_[p][kEdges[e][1]], 6 * p + e});
  std::sort(keys_.begin(), keys_.end());
  edges_.resize(corners_.size());
  ends_.clear();
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const auto [key, slot] = keys_[i];
    if (i == 0 || keys_[i - 1][0] != key)
      ends_.push_back({static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)});
    edges_[slot / 6][slot % 6] = static_cast<std::uint32_t>(ends_.size() - 1);
  }
}

/// A triangle is known by its first edge and its third vertex.
void LinkOfTetrahedra::number_triangles() {
  keys_.clear();
  for (std::size_t p = 0; p < corners_.size(); ++p)
    for (std::size_t i = 0; i < 4; ++i)
      keys_.push_back({std::uint64_t{edges_[p][kEdgesOpposite[i][0]]} << 32 | corners_[p][i == 3 ? 2 : 3], 4 * p + i});
  std::sort(keys_.begin(), keys_.end());
  triangles_.resize(corners_.size());
  faces_.clear();
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const auto [key, slot] = keys_[k];
    const std::size_t p = slot / 4, i = slot % 4;
    if (k == 0 || keys_[k - 1][0] != key) {
      faces_.emplace_back();
      for (std::size_t j = 0; j < 3; ++j) faces_.back().edges[j] = edges_[p][kEdgesOpposite[i][j]];
    }
    Triangle& face = faces_.back();
    if (face.of < 2) face.pieces[face.of] = static_cast<std::uint32_t>(p);
    ++face.of;
    triangles_[p][i] = static_cast<std::uint32_t>(faces_.size() - 1);
  }
}

std::uint64_t LinkOfTetrahedra::edges_above(Index v) const {
  return static_cast<std::uint64_t>(
      std::count_if(ends_.begin(), ends_.end(), [&](const auto& ends) { return vertices_[ends[0]] > v; }));
}

bool LinkOfTetrahedra::hangs_together() {
  // Sets of pieces; of pieces around each of their corners; of pieces around each of their edges.
  const auto pieces = static_cast<std::uint32_t>(corners_.size());
  parent_.resize(std::size_t{11} * pieces);
  std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  std::size_t parts = pieces, corner_fans = std::size_t{4} * pieces, edge_fans = std::size_t{6} * pieces;
  for (const Triangle& face : faces_) {
    if (face.of > 2) return false;
    if (face.of < 2) continue;
    const auto [p, q] = face.pieces;
    if (join(parent_, p, q)) --parts;
    for (std::uint32_t i = 0; i < 4; ++i)
      for (std::uint32_t j = 0; j < 4; ++j)
        if (corners_[p][i] == corners_[q][j] && join(parent_, pieces + 4 * p + i, pieces + 4 * q + j)) --corner_fans;
    for (const std::uint32_t e : face.edges) {
      const auto slot = [&](std::uint32_t of) {
        return 5 * pieces + 6 * of +
               static_cast<std::uint32_t>(std::find(edges_[of].begin(), edges_[of].end(), e) - edges_[of].begin());
      };
      if (join(parent_, slot(p), slot(q))) --edge_fans;
    }
  }
  return parts == 1 && corner_fans == vertices_.size() && edge_fans == ends_.size();
}

bool LinkOfTetrahedra::has_right_counts() const {
  std::vector<std::int64_t> euler(vertices_.size());  // of the links
  std::vector<bool> on_boundary(vertices_.size());
  bool closed = true;
  for (const auto& ends : ends_)
    for (const std::uint32_t v : ends) ++euler[v];
  for (const Triangle& face : faces_) {
    closed = closed && face.of == 2;
    const std::array<std::uint32_t, 3> corners = {ends_[face.edges[0]][0], ends_[face.edges[0]][1],
                                                  ends_[face.edges[2]][1]};
    for (const std::uint32_t v : corners) {
      --euler[v];
      if (face.of == 1) on_boundary[v] = true;
    }
  }
  for (const auto& corners : corners_)
    for (const std::uint32_t v : corners) ++euler[v];
  for (std::size_t v = 0; v < euler.size(); ++v)
    if (euler[v] != (on_boundary[v] ? 1 : 2)) return false;
  const auto whole = static_cast<std::int64_t>(vertices_.size()) - static_cast<std::int64_t>(ends_.size()) +
                     static_cast<std::int64_t>(faces_.size()) - static_cast<std::int64_t>(corners_.size());
  return whole == (closed ? 0 : 1);
}

bool LinkOfTetrahedra::collapses(unsigned seed) {
  std::mt19937 random(seed);
  gone_.assign(corners_.size(), false);
  open_.assign(faces_.size(), true);  // still there
  free_.clear();
  const auto remove = [&](std::uint32_t piece) {
    gone_[piece] = true;
    free_.insert(free_.end(), triangles_[piece].begin(), triangles_[piece].end());
  };
  for (std::uint32_t f = 0; f < faces_.size(); ++f)
    if (faces_[f].of == 1) free_.push_back(f);
  if (free_.empty()) remove(0);
  while (!free_.empty()) {
    std::swap(free_[random() % free_.size()], free_.back());
    const std::uint32_t f = free_.back();
    free_.pop_back();
    for (const std::uint32_t piece : faces_[f].pieces) {
      if (piece == kNone || gone_[piece] || !open_[f]) continue;
      open_[f] = false;
      remove(piece);
    }
  }
  // Triangles through edges. The sum of the triangles around an edge tells which one is the last.
  around_.assign(2 * ends_.size(), 0);
  std::size_t left = 0;
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    if (!open_[f]) continue;
    ++left;
    for (const std::uint32_t e : faces_[f].edges) ++around_[2 * e], around_[2 * e + 1] += f;
  }
  for (std::uint32_t e = 0; e < ends_.size(); ++e)
    if (around_[2 * e] == 1) free_.push_back(e);
  for (; !free_.empty();) {
    const std::uint32_t e = free_.back();
    free_.pop_back();
    if (around_[2 * e] != 1) continue;
    const std::uint32_t f = around_[2 * e + 1];
    --left;
    for (const std::uint32_t g : faces_[f].edges) {
      around_[2 * g + 1] -= f;
      if (--around_[2 * g] == 1) free_.push_back(g);
    }
  }
  return left == 0;
}

bool LinkOfTetrahedra::is_sphere_or_ball() {
  constexpr unsigned kTries = 32;
  if (corners_.empty() || !hangs_together() || !has_right_counts()) return false;
  for (unsigned seed = 0; seed < kTries; ++seed)
    if (collapses(seed)) return true;
  return false;
}

}  // namespace tegl::detail
