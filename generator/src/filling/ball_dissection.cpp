// SPDX-License-Identifier: BSD-3-Clause
//
// Search for a short sequence of tetrahedra that dismantles a ball.
#include "filling/ball_dissection.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cstdint>
#include <set>

namespace tegl::gen {

namespace {

constexpr std::size_t kMost = 32;  // maximum number of vertices of a component
constexpr std::uint8_t kNoThird = 0xff;

/// Random numbers that are equal on all platforms (G. Marsaglia, Xorshift RNGs, 2003).
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : state_(seed) {}
  std::uint32_t below(std::uint32_t n) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return state_ % n;
  }

 private:
  std::uint32_t state_;
};

/// The boundary sphere of the remaining ball.
class Front {
 public:
  Front(const std::vector<std::uint8_t>& vertices, const std::vector<std::array<std::uint8_t, 3>>& triangles,
        const SigmaComplex& sigma)
      : vertices_(vertices), sigma_(&sigma), left_(vertices.size()) {
    for (auto& row : third_) row.fill(kNoThird);
    for (const auto& t : triangles) add(t[0], t[1], t[2]);
  }

  [[nodiscard]] std::size_t vertices_left() const { return left_; }
  [[nodiscard]] unsigned degree(std::uint8_t v) const { return degree_[v]; }
  [[nodiscard]] const std::vector<LocalSimplex>& tetrahedra() const { return tetrahedra_; }

  /// The third vertex of the triangle at each directed edge, or kNoThird.
  using Thirds = std::array<std::array<std::uint8_t, kMost>, kMost>;
  [[nodiscard]] const Thirds& thirds() const { return third_; }

  /// Removes the tetrahedron around a vertex of degree 3. If 4 vertices are left, the rest is one tetrahedron.
  bool remove(std::uint8_t v) {
    const std::uint8_t a = neighbour(v), b = third_[v][a], c = third_[v][b];
    if (left_ == 4) return take(v, a, b, c);
    if (used_triangles_.test(triangle_key(a, b, c)) || !take(v, a, b, c)) return false;
    drop(v, a, b);
    drop(v, b, c);
    drop(v, c, a);
    add(a, b, c);
    --left_;
    return true;
  }

  /// Removes the tetrahedron at the edge v-w: replaces the edge by the other diagonal of its two triangles.
  bool flip(std::uint8_t v, std::uint8_t w) {
    const std::uint8_t a = third_[v][w], b = third_[w][v];
    if (a == b || used_edges_.test(a * kMost + b) || !take(v, w, a, b)) return false;
    drop(v, w, a);
    drop(w, v, b);
    add(v, b, a);
    add(w, a, b);
    return true;
  }

  /// Writes the vertices around v, in cyclic order, and returns their number.
  std::uint32_t ring(std::uint8_t v, std::array<std::uint8_t, kMost>& out) const {
    const std::uint8_t first = neighbour(v);
    std::uint8_t at = first;
    std::uint32_t count = 0;
    do {
      out[count++] = at;
      at = third_[v][at];
    } while (at != first);
    return count;
  }

  /// The triangles of `thirds`, each with ascending vertices.
  [[nodiscard]] std::vector<LocalSimplex> triangles_of(const Thirds& thirds) const {
    std::vector<LocalSimplex> result;
    for (std::uint8_t a = 0; a < vertices_.size(); ++a)
      for (std::uint8_t b = 0; b < vertices_.size(); ++b)
        if (const std::uint8_t c = thirds[a][b]; c != kNoThird && a < b && a < c) {
          LocalSimplex t{vertices_[a], vertices_[b], vertices_[c], 0};
          std::sort(t.begin(), t.begin() + 3);
          if (std::find(result.begin(), result.end(), t) == result.end()) result.push_back(t);
        }
    return result;
  }

  /// Removes the last tetrahedron, of which only the boundary is left.
  bool take_last() {
    for (std::uint8_t v = 0; v < vertices_.size(); ++v)
      if (degree_[v] == 3) return remove(v);
    return false;
  }

 private:
  static std::size_t triangle_key(std::uint8_t a, std::uint8_t b, std::uint8_t c) {
    std::array<std::uint8_t, 3> t{a, b, c};
    std::sort(t.begin(), t.end());
    return (t[0] * kMost + t[1]) * kMost + t[2];
  }
  [[nodiscard]] std::uint8_t neighbour(std::uint8_t v) const {
    std::uint8_t w = 0;
    while (third_[v][w] == kNoThird) ++w;
    return w;
  }
  void add(std::uint8_t a, std::uint8_t b, std::uint8_t c) {
    third_[a][b] = c, third_[b][c] = a, third_[c][a] = b;
    ++degree_[a], ++degree_[b], ++degree_[c];
    for (const auto& [x, y] : {std::pair{a, b}, {b, c}, {c, a}}) {
      used_edges_.set(x * kMost + y);
      used_edges_.set(y * kMost + x);
    }
    used_triangles_.set(triangle_key(a, b, c));
  }
  void drop(std::uint8_t a, std::uint8_t b, std::uint8_t c) {
    third_[a][b] = third_[b][c] = third_[c][a] = kNoThird;
    --degree_[a], --degree_[b], --degree_[c];
  }
  bool take(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
    LocalSimplex t{vertices_[a], vertices_[b], vertices_[c], vertices_[d]};
    std::sort(t.begin(), t.end());
    if (!sigma_->allows(t)) return false;
    tetrahedra_.push_back(t);
    return true;
  }

  const std::vector<std::uint8_t>& vertices_;
  const SigmaComplex* sigma_;
  std::size_t left_;
  Thirds third_;
  std::array<std::uint8_t, kMost> degree_{};
  std::bitset<kMost * kMost> used_edges_;  ///< edges of the front, now or earlier
  std::bitset<kMost * kMost * kMost> used_triangles_;
  std::vector<LocalSimplex> tetrahedra_;
};

/// One step at a vertex of minimum degree (in one of four steps: up to one more): removes it or one of its edges.
/// Returns false at a dead end.
bool step(Front& front, std::size_t vertices, Dice& dice) {
  unsigned least = kMost;
  const unsigned slack = dice.below(4) == 0 ? 1 : 0;
  for (std::uint8_t v = 0; v < vertices; ++v)
    if (front.degree(v) >= 3) least = std::min(least, front.degree(v));
  std::array<std::uint8_t, kMost> ties{}, ring;
  std::uint32_t tie_count = 0;
  for (std::uint8_t v = 0; v < vertices; ++v)
    if (front.degree(v) >= 3 && front.degree(v) <= least + slack) ties[tie_count++] = v;
  for (std::size_t tries = 0; tries < 2 * tie_count; ++tries) {
    const std::uint8_t v = ties[dice.below(tie_count)];
    if (front.degree(v) == 3) {
      if (front.remove(v)) return true;
      continue;
    }
    const std::uint32_t count = front.ring(v, ring);
    const std::uint32_t start = dice.below(count);
    for (std::uint32_t i = 0; i < count; ++i)
      if (front.flip(v, ring[(start + i) % count])) return true;
  }
  return false;
}

/// The triangles with consistent orientation, in an order and with a sign that do not depend on the input order.
std::vector<std::array<std::uint8_t, 3>> canonical(const std::vector<LocalSimplex>& sphere,
                                                   const std::vector<std::uint8_t>& vertices) {
  const auto number = [&](std::uint8_t v) {
    return static_cast<std::uint8_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  };
  std::vector<std::array<std::uint8_t, 3>> triangles;
  for (const LocalSimplex& s : sphere) {
    std::array<std::uint8_t, 3> t{number(s[0]), number(s[1]), number(s[2])};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }
  std::sort(triangles.begin(), triangles.end());
  // Of the two orientations, take the one in which the smallest triangle (by its vertex set) has ascending vertices.
  const auto first = *std::min_element(triangles.begin(), triangles.end(), [](auto a, auto b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a < b;
  });
  if (first[1] > first[2])
    for (auto& t : triangles) std::swap(t[1], t[2]);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace

BallDissection dissect_ball(const std::vector<LocalSimplex>& sphere, const SigmaComplex& sigma, std::size_t limit,
                            const std::function<bool(const BallDissection&)>& accepts) {
  std::set<std::uint8_t> seen;
  for (const LocalSimplex& s : sphere) seen.insert(s.begin(), s.begin() + 3);
  const std::vector<std::uint8_t> vertices(seen.begin(), seen.end());
  if (vertices.size() < 5 || vertices.size() > kMost) return {};
  const Front start(vertices, canonical(sphere, vertices), sigma);
  constexpr int kTries = 40;
  Dice dice(0x9e3779b9u);
  BallDissection best;
  // Random descents; a new best result lowers the limit. `accepts` is slow, so each descent shows it only its smallest
  // dissection.
  for (int i = 0; i < kTries && limit + 3 >= vertices.size(); ++i) {
    Front front = start;
    std::size_t count = 0, most = limit;  // tetrahedra of the smallest dissection, which cones the rest
    Front::Thirds rest;
    bool rest_is_empty = true;
    while (front.tetrahedra().size() + front.vertices_left() <= most + 3) {
      const bool is_last = front.vertices_left() == 4;
      if (is_last ? !front.take_last() : !step(front, vertices.size(), dice)) break;
      const std::size_t coned = is_last ? 0 : 2 * front.vertices_left() - 4;
      if ((is_last || front.vertices_left() > 4) && front.tetrahedra().size() + coned <= most) {
        count = front.tetrahedra().size();
        if (!is_last) rest = front.thirds();
        rest_is_empty = is_last;
        most = count + coned - 1;
      }
      if (is_last) break;
    }
    if (most == limit) continue;  // no dissection is small enough
    BallDissection smallest;
    smallest.tetrahedra.assign(front.tetrahedra().begin(), front.tetrahedra().begin() + std::ptrdiff_t(count));
    if (!rest_is_empty) smallest.rest = front.triangles_of(rest);
    if (accepts && !accepts(smallest)) continue;
    best = std::move(smallest);
    limit = most;
  }
  std::sort(best.tetrahedra.begin(), best.tetrahedra.end());
  return best;
}

}  // namespace tegl::gen
