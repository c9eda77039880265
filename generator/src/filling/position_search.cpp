// SPDX-License-Identifier: BSD-3-Clause
//
// Random positions, and descents: moves of single points are kept if the pair misses by less.
#include "filling/position_search.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace tegl::gen {

namespace {

constexpr std::int64_t kEdge = std::int64_t{1} << kGridBits;

}  // namespace

/// The generator splitmix64 (G. Steele, D. Lea and C. Flood, Fast splittable pseudorandom number generators, 2014).
class PositionSearch::Random {
 public:
  Random(std::uint64_t seed, Signature signature) : state_(seed * 0x9e3779b97f4a7c15u + signature) {}

  std::uint64_t operator()() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
  }
  /// Below `end`; the bias is below end / 2^64.
  std::uint64_t below(std::uint64_t end) { return (*this)() % end; }

  /// A position: uniform, or in a random octave of the distances from a random end.
  std::int64_t position(bool near_ends) {
    if (!near_ends) return 1 + static_cast<std::int64_t>(below(kEdge - 1));
    const auto least = kEdge >> 2 >> below(20);
    const auto distance = least + static_cast<std::int64_t>(below(static_cast<std::uint64_t>(least)));
    return ((*this)() & 1u) != 0 ? distance : kEdge - distance;
  }

 private:
  std::uint64_t state_;
};

PositionSearch::PositionSearch(const FaceContours& faces, const TileContour& contour,
                               std::span<const SimplexPair> pairs)
    : PositionSearch(faces.tile(), std::make_unique<VertexPlaces>(faces, contour), pairs) {}

PositionSearch::PositionSearch(const Tile& tile, std::unique_ptr<ContourPlaces> places,
                               std::span<const SimplexPair> pairs)
    : vertices_(std::move(places)), at_(tile.edge_count(), kEdge / 2), places_(256) {
  for (const auto& [a, b] : pairs) {
    const SimplexMeeting& pair = pairs_.emplace_back(tile.dim, a, b);
    std::uint32_t edges = 0;
    for (const std::uint8_t v : pair.vertices()) edges |= vertices_->edges_of(v);
    auto& list = edges_of_pair_.emplace_back();
    for (; edges != 0; edges &= edges - 1) list.push_back(static_cast<std::uint8_t>(std::countr_zero(edges)));
  }
}

void PositionSearch::draw(Random& random, bool near_ends) {
  for (const std::uint8_t e : vertices_->edges()) at_[e] = random.position(near_ends);
}

double PositionSearch::miss_of(std::size_t pair) { return pairs_[pair].miss(places_); }

bool PositionSearch::any_meets() {
  vertices_->compute(at_, places_);
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (!pairs_[i].are_clearly_apart(places_) && miss_of(i) == 0) return true;
  return false;
}

bool PositionSearch::descend(Random& random, std::uint32_t steps) {
  constexpr std::size_t kMostCompared = 64;  // pairs at the start
  draw(random, (random() & 1u) != 0);
  vertices_->compute(at_, places_);
  std::size_t pair = 0;
  double least = 2;
  for (std::size_t i = 0; i < std::min(pairs_.size(), kMostCompared); ++i) {
    const std::size_t other = pairs_.size() <= kMostCompared ? i : random.below(pairs_.size());
    if (const double miss = miss_of(other); miss < least) least = miss, pair = other;
  }
  const std::vector<std::uint8_t>& edges = edges_of_pair_[pair];
  for (std::uint32_t step = 0; step < steps && least > 0; ++step) {
    std::int64_t& moved = at_[edges[random.below(edges.size())]];
    const std::int64_t before = moved;
    const std::uint64_t kind = random.below(4);
    if (kind < 2) {
      moved = random.position(kind == 1);
    } else {  // to a near place: half or twice as far from the nearer end
      const bool is_low = moved < kEdge / 2;
      const std::int64_t distance = is_low ? moved : kEdge - moved;
      const std::int64_t changed = std::clamp(kind == 2 ? distance / 2 : distance * 2, std::int64_t{1}, kEdge - 1);
      moved = is_low ? changed : kEdge - changed;
    }
    vertices_->compute(at_, places_);
    const double miss = miss_of(pair);
    if (miss <= least)
      least = miss;
    else
      moved = before;
  }
  return any_meets();
}

std::optional<std::vector<std::int64_t>> PositionSearch::find(const SearchPlan& plan, Signature signature) {
  Random random(plan.seed, signature);
  std::fill(at_.begin(), at_.end(), kEdge / 2);
  bool found = any_meets();
  for (std::uint32_t i = 0; i < plan.uniform + plan.near_ends && !found; ++i) {
    draw(random, i >= plan.uniform);
    found = any_meets();
  }
  for (std::uint32_t i = 0; i < plan.descents && !found; ++i) found = descend(random, plan.steps);
  if (!found) return std::nullopt;
  return at_;
}

}  // namespace tegl::gen
