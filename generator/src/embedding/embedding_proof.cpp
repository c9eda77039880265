// SPDX-License-Identifier: BSD-3-Clause
//
// Separation of sets of corners by the hyperplanes that corners span.
#include "embedding/embedding_proof.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "base/determinant.hpp"

namespace tegl::gen {

namespace {

using IntPoint = std::array<int, 4>;

constexpr int kKnownBits = 14;  // 2^14 known pairs of sets of edges in four dimensions; fewer dimensions need none

/// Calls visit(chosen) for all ascending sequences of `count` numbers below `end`.
template <class Visit>
void for_each_choice(std::size_t count, std::size_t end, std::vector<std::size_t>& chosen, const Visit& visit) {
  if (chosen.size() == count) return visit();
  for (std::size_t v = chosen.empty() ? 0 : chosen.back() + 1; v < end; ++v) {
    chosen.push_back(v);
    for_each_choice(count, end, chosen, visit);
    chosen.pop_back();
  }
}

}  // namespace

EmbeddingProof::EmbeddingProof(const Tile& tile, std::span<const Ray> rays)
    : tile_(&tile), meeting_(tile.dim == 4 ? std::size_t{1} << kKnownBits : 0), apart_(meeting_.size()) {
  points_.resize(tile.corner_count());
  for (std::size_t v = 0; v < tile.corner_count(); ++v)
    for (int i = 0; i < tile.dim; ++i) points_[v][i] = 2 * static_cast<int>(tile.corners[v][i]);
  for (const auto& edge : tile.edges) segments_.push_back({edge[0], edge[1]});
  if (!rays.empty()) {
    const auto centre = static_cast<std::uint8_t>(points_.size());
    points_.push_back({1, 1, 1, tile.dim == 4 ? 1 : 0});
    for (const Ray& ray : rays) {
      segments_.push_back({centre, static_cast<std::uint8_t>(points_.size())});
      Point& end = points_.emplace_back(points_[centre]);
      for (int i = 0; i < tile.dim; ++i) end[i] += ray[i];
    }
  }
  constexpr std::size_t kMostInMask = 32;  // sets of points and of segments are masks of 32 bits
  if (points_.size() > kMostInMask || segments_.size() > kMostInMask)
    throw std::logic_error("a tile with more corners, edges and rays than a mask has bits");
  std::vector<std::size_t> chosen;
  for_each_choice(static_cast<std::size_t>(tile.dim), points_.size(), chosen, [&] { add_hyperplane(chosen); });
  if (hyperplanes_.size() > kWords * 64) throw std::logic_error("a tile with more hyperplanes than expected");
  for (std::size_t k = 0; k < hyperplanes_.size(); ++k) existing_[k / 64] |= std::uint64_t{1} << k % 64;
  of_edges_.resize((segments_.size() + 7) / 8);
  for (std::uint32_t e = 0; e < segments_.size(); ++e) {
    const Sides sides = sides_of_edge(e);
    for (unsigned byte = 0; byte < 256; ++byte)
      if ((byte >> e % 8 & 1u) != 0) of_edges_[e / 8][byte].add(sides);
  }
  for (unsigned p = 1; p < 1u << tile.dim; ++p)
    for (unsigned q = 1; q < 1u << tile.dim; ++q)
      if (std::popcount(p) + std::popcount(q) <= tile.dim + 2) face_pairs_.emplace_back(p, q);
  for (const SubTile& face : tile.faces) {
    std::uint32_t edges = 0;
    for (const std::uint8_t e : face.edge) edges |= 1u << e;
    facets_.push_back(edges);
  }
}

EmbeddingProof::Sides EmbeddingProof::sides_of_edge(std::uint32_t e) const {
  const std::uint32_t ends = 1u << segments_[e][0] | 1u << segments_[e][1];
  Sides sides;
  for (std::size_t k = 0; k < hyperplanes_.size(); ++k) {
    const auto& [above, below] = hyperplanes_[k];
    if ((ends & above) != 0) sides.above[k / 64] |= std::uint64_t{1} << k % 64;
    if ((ends & below) != 0) sides.below[k / 64] |= std::uint64_t{1} << k % 64;
  }
  return sides;
}

void EmbeddingProof::add_hyperplane(std::span<const std::size_t> through) {
  const IntPoint base = points_[through[0]];
  std::array<IntPoint, 3> directions{};
  for (std::size_t r = 1; r < through.size(); ++r) {
    const IntPoint& point = points_[through[r]];
    for (int i = 0; i < tile_->dim; ++i) directions[r - 1][i] = point[i] - base[i];
  }
  const IntPoint normal = cross_product(directions, static_cast<std::size_t>(tile_->dim));
  std::uint32_t above = 0, below = 0;
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    const IntPoint& point = points_[v];
    int height = 0;
    for (int i = 0; i < tile_->dim; ++i) height += normal[i] * (point[i] - base[i]);
    if (height > 0) above |= 1u << v;
    if (height < 0) below |= 1u << v;
  }
  if ((above | below) == 0) return;  // the corners span less than a hyperplane
  const std::pair hyperplane{std::max(above, below), std::min(above, below)};
  if (std::find(hyperplanes_.begin(), hyperplanes_.end(), hyperplane) == hyperplanes_.end())
    hyperplanes_.push_back(hyperplane);
}

EmbeddingProof::Simplex EmbeddingProof::prepared(const LocalSimplex& simplex, const Means& means) const {
  Simplex result;
  for (unsigned set = 1; set < result.faces.size(); ++set) {
    for (int i = 0; i < tile_->dim; ++i)
      if ((set >> i & 1u) != 0) result.faces[set] |= Vertices{1} << simplex[i];
    result.edges[set] = edges_of(result.faces[set], means);
    const unsigned rest = set & (set - 1);
    if (rest == 0) {
      result.sides[set] = sides_of(result.edges[set]);
    } else {
      result.sides[set] = result.sides[rest];
      result.sides[set].add(result.sides[set ^ rest]);
    }
  }
  return result;
}

/// The edges of whose points the vertices are positive combinations.
std::uint32_t EmbeddingProof::edges_of(Vertices vertices, const Means& means) const {
  const std::size_t count = segments_.size();
  auto edges = static_cast<std::uint32_t>(vertices & ((Vertices{1} << count) - 1));
  for (Vertices rest = vertices >> count; rest != 0; rest &= rest - 1)
    edges |= means[static_cast<std::size_t>(std::countr_zero(rest))];
  return edges;
}

EmbeddingProof::Sides EmbeddingProof::sides_of(std::uint32_t edges) const {
  Sides sides;
  for (const SidesOfByte& of_byte : of_edges_) {
    sides.add(of_byte[edges & 0xffu]);
    edges >>= 8;
  }
  return sides;
}

bool EmbeddingProof::in_one_facet(std::uint32_t edges) const {
  return std::any_of(facets_.begin(), facets_.end(), [&](std::uint32_t facet) { return (edges & ~facet) == 0; });
}

/// True if a hyperplane separates the two sets properly.
bool EmbeddingProof::have_separate_interiors(const Sides& p, const Sides& q) noexcept {
  std::uint64_t separating = 0;
  for (std::size_t k = 0; k < kWords; ++k) {
    separating |= ~p.below[k] & ~q.above[k] & (p.above[k] | q.below[k]);
    separating |= ~p.above[k] & ~q.below[k] & (p.below[k] | q.above[k]);
  }
  return separating != 0;
}

/// A sufficient condition, faster than may_meet: one hyperplane has a on one side, b on the other, and on itself no
/// vertices but common ones of either a or b. So they meet in the simplex of these vertices.
bool EmbeddingProof::are_divided(const Simplex& a, const Simplex& b) const {
  const Vertices common = a.faces.back() & b.faces.back();
  for (std::size_t k = 0; k < kWords; ++k) {
    const auto through = [&](const Simplex& simplex) {  // hyperplanes with a vertex that is not common
      std::uint64_t result = 0;
      for (unsigned one = 1; one < 1u << tile_->dim; one *= 2)
        if ((simplex.faces[one] & common) == 0) result |= ~(simplex.sides[one].above[k] | simplex.sides[one].below[k]);
      return result;
    };
    const Sides &all_a = a.sides.back(), &all_b = b.sides.back();
    const std::uint64_t between = (~all_a.below[k] & ~all_b.above[k]) | (~all_a.above[k] & ~all_b.below[k]);
    if ((between & ~(through(a) & through(b)) & existing_[k]) != 0) return true;
  }
  return false;
}

/// True if a hyperplane contains the edges with the sides `on` and separates a and b properly.
bool EmbeddingProof::are_separate_around(const Sides& a, const Sides& b, const Sides& on) noexcept {
  std::uint64_t separating = 0;
  for (std::size_t k = 0; k < kWords; ++k) {
    const std::uint64_t through = ~on.above[k] & ~on.below[k];
    separating |= through & ~a.below[k] & ~b.above[k] & (a.above[k] | b.below[k]);
    separating |= through & ~a.above[k] & ~b.below[k] & (a.below[k] | b.above[k]);
  }
  return separating != 0;
}

/// True if the relative interiors of p and q meet for some positions and weights. A mean was replaced by its points. A
/// point on both sides counts on either or, if its weights are equal, on none.
bool EmbeddingProof::decide_inside(std::uint32_t of_p, std::uint32_t of_q) const {
  const std::uint32_t both = of_p & of_q;
  const std::uint32_t only_p = of_p & ~both, only_q = of_q & ~both;
  const Sides p = sides_of(only_p), q = sides_of(only_q);
  if (are_separate_around(p, q, sides_of(both))) return false;
  for (std::uint32_t to_p = both;; to_p = (to_p - 1) & both) {
    const std::uint32_t rest = both & ~to_p;
    Sides left = sides_of(to_p);
    left.add(p);
    for (std::uint32_t to_q = rest;; to_q = (to_q - 1) & rest) {
      if ((only_p | to_p) != 0 && (only_q | to_q) != 0) {
        Sides right = sides_of(to_q);
        right.add(q);
        if (!have_separate_interiors(left, right)) return true;
      }
      if (to_q == 0) break;
    }
    if (to_p == 0) break;
  }
  return false;
}

/// The same, known from an earlier pair or decided now.
bool EmbeddingProof::may_meet_inside(std::uint32_t of_p, std::uint32_t of_q) const {
  if (meeting_.empty()) return decide_inside(of_p, of_q);
  const std::uint64_t pair = std::uint64_t{of_p} << 32 | of_q;
  const std::size_t place = pair * 0x9e3779b97f4a7c15u >> (64 - kKnownBits);
  if (meeting_[place].load(std::memory_order_relaxed) == pair) return true;
  if (apart_[place].load(std::memory_order_relaxed) == pair) return false;
  const bool meet = decide_inside(of_p, of_q);
  (meet ? meeting_ : apart_)[place].store(pair, std::memory_order_relaxed);
  return meet;
}

/// True if simplices a and b may meet outside of the simplex of their common vertices. Then the relative interiors of
/// two disjoint faces meet; by Kirchberger's theorem, faces with at most n + 2 vertices in total are enough.
bool EmbeddingProof::may_meet(const Simplex& a, const Simplex& b) const {
  if (are_divided(a, b)) return false;
  for (const auto& [p, q] : face_pairs_) {
    if ((a.faces[p] & b.faces[q]) != 0) continue;
    const bool meet = (a.edges[p] & b.edges[q]) == 0 ? !have_separate_interiors(a.sides[p], b.sides[q])
                                                     : may_meet_inside(a.edges[p], b.edges[q]);
    if (meet && !in_one_facet(a.edges[p] | b.edges[q])) return true;
  }
  return false;
}

/// Points are affinely dependent if and only if the relative interiors of the convex hulls of two disjoint sets of them
/// meet (Radon's theorem).
bool EmbeddingProof::may_be_flat(const LocalSimplex& simplex, const Means& means) const {
  const Simplex all = prepared(simplex, means);
  for (unsigned p = 1; p < 1u << tile_->dim; ++p)
    for (unsigned q = 1; q < p; ++q) {
      if ((p & q) != 0) continue;
      const bool meet = (all.edges[p] & all.edges[q]) == 0 ? !have_separate_interiors(all.sides[p], all.sides[q])
                                                           : may_meet_inside(all.edges[p], all.edges[q]);
      if (meet) return true;
    }
  return false;
}

bool EmbeddingProof::holds(std::span<const LocalSimplex> simplices, const Means& means) const {
  std::vector<Simplex> all;
  for (const LocalSimplex& s : simplices) {
    const Simplex& last = all.emplace_back(prepared(s, means));
    if (std::any_of(all.begin(), all.end() - 1, [&](const Simplex& t) { return may_meet(last, t); })) return false;
  }
  return true;
}

void EmbeddingProof::add_meeting(std::span<const LocalSimplex> simplices, const Means& means,
                                 std::vector<SimplexPair>& pairs) const {
  std::vector<Simplex> all;
  for (std::size_t i = 0; i < simplices.size(); ++i) {
    all.push_back(prepared(simplices[i], means));
    for (std::size_t j = 0; j < i; ++j)
      if (may_meet(all[i], all[j])) pairs.emplace_back(simplices[i], simplices[j]);
  }
}

bool EmbeddingProof::holds_between(std::span<const LocalSimplex> first, std::span<const LocalSimplex> second,
                                   const Means& means) const {
  std::vector<Simplex> others;
  for (const LocalSimplex& s : second) others.push_back(prepared(s, means));
  return std::none_of(first.begin(), first.end(), [&](const LocalSimplex& s) {
    const Simplex one = prepared(s, means);
    return std::any_of(others.begin(), others.end(), [&](const Simplex& t) { return may_meet(one, t); });
  });
}

void EmbeddingProof::add_meeting(std::span<const LocalSimplex> first, std::span<const LocalSimplex> second,
                                 const Means& means, std::vector<SimplexPair>& pairs) const {
  std::vector<Simplex> others;
  for (const LocalSimplex& s : second) others.push_back(prepared(s, means));
  for (const LocalSimplex& s : first) {
    const Simplex one = prepared(s, means);
    for (std::size_t j = 0; j < others.size(); ++j)
      if (may_meet(one, others[j])) pairs.emplace_back(s, second[j]);
  }
}

}  // namespace tegl::gen
