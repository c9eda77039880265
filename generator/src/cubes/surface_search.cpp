// SPDX-License-Identifier: BSD-3-Clause
//
// The search advances a front: for an open edge of the front, every vertex is tried as the third one of its triangle,
// until no edge is open. The number of triangles determines the surface: a disc, or a sphere with holes.
#include "cubes/surface_search.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace tegl::gen {

SurfaceSearch::SurfaceSearch(const CubeFrame& frame, const std::vector<CubePolygon>& boundary,
                             std::span<const Point> own) {
  for (const CubePolygon& polygon : boundary)
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::uint8_t a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      open_[a][b] = used_[a][b] = used_[b][a] = true;
      vertices_.push_back(a);
      position_[a] = frame.midpoint(a);
      squares_of_[a] = frame.squares_of[a];
    }
  // Number of triangles from Euler's formula, V - E + F = 2 - holes.
  triangles_ = vertices_.size() + 2 * own.size() + 2 * boundary.size() - 4;
  for (std::size_t j = 0; j < own.size(); ++j) {
    vertices_.push_back(static_cast<std::uint8_t>(CubeFrame::kEdges + j));
    position_[CubeFrame::kEdges + j] = own[j];
  }
}

std::optional<CubeTriangles> SurfaceSearch::run(double bound) {
  best_cost_ = bound;
  advance(0);
  return std::exchange(best_, std::nullopt);
}

double SurfaceSearch::length(std::size_t a, std::size_t b) const {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = position_[a][i] - position_[b][i];
    sum += d * d;
  }
  return sum;
}

/// True if the edge closes an open one, or is new and does not lie in a square.
bool SurfaceSearch::possible(std::size_t from, std::size_t to) const {
  return open_[from][to] || (!used_[from][to] && (squares_of_[from] & squares_of_[to]) == 0);
}

/// Adds an edge of a triangle. Returns true if it closed an open edge; take_back() needs that value.
bool SurfaceSearch::put(std::size_t from, std::size_t to, double& cost) {
  if (open_[from][to]) return open_[from][to] = false, true;
  open_[to][from] = used_[from][to] = used_[to][from] = true;
  cost += length(from, to);
  return false;
}

void SurfaceSearch::take_back(std::size_t from, std::size_t to, bool closed) {
  if (closed)
    open_[from][to] = true;
  else
    open_[to][from] = used_[from][to] = used_[to][from] = false;
}

/// The vertices that complete a triangle with an open edge, as a set.
unsigned SurfaceSearch::completions(std::size_t a, std::size_t b) const {
  unsigned set = 0;
  for (const std::uint8_t c : vertices_) {
    if (c == a || c == b || !possible(b, c) || !possible(c, a)) continue;
    if (!may_add || may_add({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), c}, filling_)) set |= 1u << c;
  }
  return set;
}

/// Extends the front at an open edge: with own vertices, where the fewest triangles are possible, else at the first.
/// Prunes by cost.
void SurfaceSearch::advance(double cost) {
  constexpr double kEqual = 1e-9;
  if (cost > best_cost_ - kEqual) return;
  std::size_t a = kMost, b = kMost;
  unsigned third = ~0u;
  const bool all = vertices_.back() >= CubeFrame::kEdges;
  for (std::size_t from = 0; from < kMost && (all || a == kMost); ++from)
    for (std::size_t to = 0; to < kMost && (all || a == kMost); ++to) {
      if (!open_[from][to]) continue;
      const unsigned set = completions(from, to);
      if (a != kMost && std::popcount(set) >= std::popcount(third)) continue;
      if (set == 0) return;
      a = from, b = to, third = set;
    }
  if (a == kMost) {
    if (filling_.size() == triangles_ && connected() && accepts(filling_)) best_ = filling_, best_cost_ = cost;
    return;
  }
  if (filling_.size() == triangles_) return;
  for (const std::uint8_t c : vertices_) {
    if ((third >> c & 1u) == 0) continue;
    double sum = cost;
    open_[a][b] = false;
    const bool second_closed = put(b, c, sum), third_closed = put(c, a, sum);
    filling_.push_back({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), c});
    advance(sum);
    filling_.pop_back();
    take_back(c, a, third_closed), take_back(b, c, second_closed);
    open_[a][b] = true;
  }
}

bool SurfaceSearch::connected() const {
  unsigned reached = 1u << filling_[0][0], before = 0;
  while (reached != std::exchange(before, reached))
    for (const CubeTriangle& t : filling_) {
      const unsigned own = 1u << t[0] | 1u << t[1] | 1u << t[2];
      if ((own & reached) != 0) reached |= own;
    }
  return std::all_of(vertices_.begin(), vertices_.end(), [&](unsigned v) { return ((reached >> v) & 1u) != 0; });
}

}  // namespace tegl::gen
