// SPDX-License-Identifier: BSD-3-Clause
//
// A spanning tree of the tetrahedra across triangles removes all tetrahedra but leaves the homotopy type of the
// manifold without a ball. Then triangles with a free edge are collapsed. If all are, a graph remains; it is a tree, as
// the Euler characteristic of a closed 3-manifold is 0.
#include "tegl/tile/three_sphere.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "tegl/tile/complex.hpp"

namespace tegl::tile {

bool ThreeSphereTest::operator()(std::span<const Tetrahedron> tetrahedra) {
  constexpr unsigned kTries = 8;
  if (tetrahedra.size() > 16384) throw std::length_error("more than 16384 tetrahedra in a component of Sigma");
  renumber(tetrahedra);
  if (tetrahedra.size() == 5 && vertex_count_ == 5) return true;  // the boundary of a 4-simplex
  find_triangles();
  for (unsigned attempt = 0; attempt < kTries; ++attempt) {
    const std::size_t left = collapse(attempt);
    if (left == 0) return true;
    if (attempt == 0 && has_homology(left)) return false;
  }
  return false;
}

void ThreeSphereTest::renumber(std::span<const Tetrahedron> tetrahedra) {
  std::uint16_t most = 0;
  for (const Tetrahedron& t : tetrahedra)
    for (const std::uint16_t v : t) most = std::max(most, v);
  number_.assign(std::size_t{most} + 1, kNone);
  tetrahedra_.assign(tetrahedra.begin(), tetrahedra.end());
  vertex_count_ = 0;
  for (Tetrahedron& t : tetrahedra_) {
    for (std::uint16_t& v : t) {
      if (number_[v] == kNone) number_[v] = static_cast<std::uint16_t>(vertex_count_++);
      v = number_[v];
    }
    sort_vertices(t);
  }
}

std::uint16_t ThreeSphereTest::edge_between(std::uint16_t a, std::uint16_t b) {
  std::uint16_t& edge = edge_of_[a * vertex_count_ + b];
  if (edge == kNone) {
    edge = static_cast<std::uint16_t>(edge_count_++);
    first_of_edge_.push_back(kNone);
  }
  return edge;
}

void ThreeSphereTest::find_triangles() {
  edge_count_ = 0;
  edge_of_.assign(vertex_count_ * vertex_count_, kNone);
  first_of_edge_.clear(), triangles_.clear(), next_.clear(), third_.clear();
  triangles_of_.resize(tetrahedra_.size());
  for (std::size_t i = 0; i < tetrahedra_.size(); ++i) {
    const auto number = static_cast<std::uint16_t>(i);
    for (unsigned omitted = 0; omitted < 4; ++omitted) {
      std::array<std::uint16_t, 3> v{};
      for (unsigned j = 0, k = 0; j < 4; ++j)
        if (j != omitted) v[k++] = tetrahedra_[i][j];
      const std::uint16_t edge = edge_between(v[0], v[1]);
      std::uint16_t at = first_of_edge_[edge];
      while (at != kNone && third_[at] != v[2]) at = next_[at];
      if (at == kNone) {
        at = static_cast<std::uint16_t>(triangles_.size());
        triangles_.push_back({{edge, edge_between(v[0], v[2]), edge_between(v[1], v[2])}, {number, kNone}, true});
        next_.push_back(first_of_edge_[edge]), third_.push_back(v[2]);
        first_of_edge_[edge] = at;
      } else if (std::uint16_t& second = triangles_[at].tetrahedra[1]; second == kNone) {
        second = number;
      } else {
        throw std::invalid_argument("a triangle in three tetrahedra");
      }
      triangles_of_[i][omitted] = at;
    }
  }
  if (triangles_.size() != 2 * tetrahedra_.size()) throw std::invalid_argument("a triangle in a single tetrahedron");
}

/// Removes the triangles that a spanning tree of the tetrahedra passes. Every attempt takes another tree.
void ThreeSphereTest::open_tree(unsigned attempt) {
  for (Triangle& t : triangles_) t.is_left = true;
  reached_.assign(tetrahedra_.size(), 0);
  const std::size_t first = attempt * std::size_t{7919} % tetrahedra_.size();
  queue_.assign(1, static_cast<std::uint16_t>(first));
  reached_[first] = 1;
  for (std::size_t at = 0; at < queue_.size(); ++at)
    for (unsigned i = 0; i < 4; ++i) {
      Triangle& t = triangles_[triangles_of_[queue_[at]][(i + attempt) % 4]];
      const std::uint16_t beyond = t.tetrahedra[0] == queue_[at] ? t.tetrahedra[1] : t.tetrahedra[0];
      if (reached_[beyond] != 0) continue;
      reached_[beyond] = 1;
      t.is_left = false;
      queue_.push_back(beyond);
    }
}

/// Collapses what one spanning tree leaves; returns the number of triangles that remain.
std::size_t ThreeSphereTest::collapse(unsigned attempt) {
  open_tree(attempt);
  std::size_t left = triangles_.size() + 1 - tetrahedra_.size();
  // by edge: the number of its triangles, and their numbers combined by exclusive or
  degree_.assign(edge_count_, 0), sum_.assign(edge_count_, 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (triangles_[t].is_left)
      for (const std::uint16_t e : triangles_[t].edges) {
        ++degree_[e];
        sum_[e] = static_cast<std::uint16_t>(sum_[e] ^ t);
      }
  queue_.clear();
  for (std::size_t e = 0; e < edge_count_; ++e)
    if (degree_[e] == 1) queue_.push_back(static_cast<std::uint16_t>(e));
  while (!queue_.empty()) {
    const std::uint16_t free = queue_.back();
    queue_.pop_back();
    if (degree_[free] != 1) continue;
    const std::uint16_t t = sum_[free];
    triangles_[t].is_left = false;
    --left;
    for (const std::uint16_t e : triangles_[t].edges) {
      sum_[e] = static_cast<std::uint16_t>(sum_[e] ^ t);
      if (--degree_[e] == 1) queue_.push_back(e);
    }
  }
  return left;
}

/// Whether the first homology modulo 2 is not 0. `left`: triangles that remain; each collapsed one took an edge along.
/// The rest is connected: its first Betti number is edges - vertices + 1 - rank of the triangles' boundaries.
bool ThreeSphereTest::has_homology(std::size_t left) {
  const std::size_t collapsed = triangles_.size() + 1 - tetrahedra_.size() - left;
  const std::size_t words = (edge_count_ + 63) / 64;
  std::vector<std::vector<std::uint64_t>*> with_pivot(edge_count_, nullptr);
  rows_.resize(std::max(rows_.size(), left));
  std::size_t rank = 0;
  for (const Triangle& t : triangles_) {
    if (!t.is_left) continue;
    std::vector<std::uint64_t>& row = rows_[rank];
    row.assign(words, 0);
    for (const std::uint16_t e : t.edges) row[e / 64] |= std::uint64_t{1} << (e % 64);
    // eliminate by the rows before; a row that does not vanish is kept
    for (std::size_t w = 0; w < words; ++w)
      while (row[w] != 0) {
        auto*& other = with_pivot[64 * w + static_cast<std::size_t>(std::countr_zero(row[w]))];
        if (other == nullptr) {
          other = &row;
          ++rank;
          w = words - 1;
          break;
        }
        for (std::size_t x = w; x < words; ++x) row[x] ^= (*other)[x];
      }
  }
  return edge_count_ - collapsed + 1 != vertex_count_ + rank;
}

}  // namespace tegl::tile
