// SPDX-License-Identifier: BSD-3-Clause
//
// Based on: H. Bruggesser and P. Mani, "Shellable decompositions of cells and spheres", Mathematica Scandinavica 29,
// 1971: a ball stays a ball if a simplex is added whose intersection with it is a ball of one dimension less.
#include "tile/link_balls.hpp"

#include <array>
#include <cstddef>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "tegl/tile/disjoint_sets.hpp"

namespace tegl::detail {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class LinkDivision {
 public:
  explicit LinkDivision(const tile::Simplices& link)
      : link_(link), corners_(tile::size(link.front())), across_(link.size()), ball_(link.size(), kNone) {
    std::map<tile::Simplex, std::pair<std::uint32_t, int>> open;
    for (std::uint32_t s = 0; s < link.size(); ++s) {
      across_[s].fill(kNone);
      for (int i = 0; i < corners_; ++i) {
        const auto [at, is_new] = open.try_emplace(tile::without(link[s], i), s, i);
        if (is_new) continue;
        const auto [other, corner] = at->second;
        across_[s][static_cast<std::size_t>(i)] = other;
        across_[other][static_cast<std::size_t>(corner)] = s;
      }
    }
  }

  std::vector<std::uint32_t> run() {
    for (const std::vector<std::uint32_t>& part : parts()) {
      if (is_sphere_or_ball(part)) {
        for (const std::uint32_t s : part) ball_[s] = balls_;
        ++balls_;
        continue;
      }
      for (const std::uint32_t s : part)
        if (ball_[s] == kNone) grow(s);
    }
    return number_by_first();
  }

 private:
  /// Parts that are connected by common faces.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> parts() const {
    BasicDisjointSets<std::uint32_t> sets(link_.size());
    for (std::uint32_t s = 0; s < link_.size(); ++s)
      for (const std::uint32_t other : across_[s])
        if (other != kNone) sets.join(s, other);
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_leader;
    for (std::uint32_t s = 0; s < link_.size(); ++s) by_leader[sets.find(s)].push_back(s);
    std::vector<std::vector<std::uint32_t>> parts;
    for (auto& [leader, part] : by_leader) parts.push_back(std::move(part));
    return parts;
  }

  /// The Euler characteristic is tested first: it is soon known, and excludes most of the others.
  [[nodiscard]] bool is_sphere_or_ball(const std::vector<std::uint32_t>& part) const {
    tile::Simplices simplices;
    bool is_closed = true;
    for (const std::uint32_t s : part) {
      simplices.push_back(link_[s]);
      for (int i = 0; i < corners_; ++i) is_closed = is_closed && across_[s][static_cast<std::size_t>(i)] != kNone;
    }
    const int euler = !is_closed ? 1 : corners_ % 2 == 0 ? 0 : 2;
    return tile::euler_characteristic(simplices) == euler && tile::shape_of(simplices) != tile::Shape::other;
  }

  /// Makes a ball that begins with a simplex.
  void grow(std::uint32_t first) {
    faces_.clear();
    boundary_ = 0;
    add(first, 0);
    std::deque<std::uint32_t> next = neighbours(first);
    for (; !next.empty(); next.pop_front()) {
      const std::uint32_t s = next.front();
      if (ball_[s] != kNone) continue;
      // the corners opposite of the faces that are in the ball: the ball has none of the faces that contain all of them
      tile::Simplex opposite = tile::kNoSimplex;
      int shared = 0;
      for (int i = 0; i < corners_; ++i)
        if (const std::uint32_t other = across_[s][static_cast<std::size_t>(i)];
            other != kNone && ball_[other] == balls_)
          opposite[static_cast<std::size_t>(shared++)] = link_[s][static_cast<std::size_t>(i)];
      const bool fits = shared == corners_ ? boundary_ == corners_ : !faces_.contains(opposite);
      if (!fits) continue;  // comes again, if a neighbour is added
      add(s, shared);
      const std::deque<std::uint32_t> more = neighbours(s);
      next.insert(next.end(), more.begin(), more.end());
    }
    ++balls_;
  }

  /// Adds a simplex to the ball that grows. `shared`: how many of its faces are in the ball.
  void add(std::uint32_t s, int shared) {
    ball_[s] = balls_;
    boundary_ += corners_ - 2 * shared;
    for (unsigned mask = 1; mask < 1u << corners_; ++mask) {
      tile::Simplex face = tile::kNoSimplex;
      for (int i = 0, n = 0; i < corners_; ++i)
        if ((mask >> i & 1u) != 0) face[static_cast<std::size_t>(n++)] = link_[s][static_cast<std::size_t>(i)];
      faces_.insert(face);
    }
  }

  [[nodiscard]] std::deque<std::uint32_t> neighbours(std::uint32_t s) const {
    std::deque<std::uint32_t> result;
    for (const std::uint32_t other : across_[s])
      if (other != kNone && ball_[other] == kNone) result.push_back(other);
    return result;
  }

  [[nodiscard]] std::vector<std::uint32_t> number_by_first() {
    std::vector<std::uint32_t> number(balls_, kNone);
    std::uint32_t count = 0;
    for (std::uint32_t& ball : ball_) {
      if (number[ball] == kNone) number[ball] = count++;
      ball = number[ball];
    }
    return std::move(ball_);
  }

  const tile::Simplices& link_;
  int corners_;                                                        ///< of each simplex
  std::vector<std::array<std::uint32_t, tile::kMaxVertices>> across_;  ///< by corner: the simplex at the opposite face
  std::vector<std::uint32_t> ball_;
  std::uint32_t balls_ = 0;
  std::set<tile::Simplex> faces_;  ///< of the ball that grows, of all dimensions
  int boundary_ = 0;               ///< number of the faces of its boundary
};

}  // namespace

std::vector<std::uint32_t> balls_of_link(const tile::Simplices& link) {
  if (link.size() < 2) return std::vector<std::uint32_t>(link.size(), 0);
  return LinkDivision(link).run();
}

}  // namespace tegl::detail
