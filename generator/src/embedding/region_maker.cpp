// SPDX-License-Identifier: BSD-3-Clause
//
// Depth-first search: takes tetrahedra away from the surface inwards, each at the triangle that has the fewest
// admissible ones, until nothing is left, or until the rest is visible from a centre. Points of one position of the
// contour's vertices show early that tetrahedra overlap; they only make the search faster.
#include "embedding/region_maker.hpp"

#include <algorithm>
#include <bit>
#include <bitset>
#include <set>

#include "base/determinant.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

using Vertex = std::uint8_t;
using Triangle = std::array<Vertex, 3>;
using Set = RegionFrame::Set;
using Position = std::array<double, 3>;

constexpr Set one(unsigned v) { return Set{1} << v; }

/// Points spread over the cube, for one position of the contour's vertices.
class Samples {
 public:
  static constexpr std::size_t kCount = 192;
  using Bits = std::bitset<kCount>;

  Samples(const RegionFrame& frame, std::span<const Triangle> surface) {
    for (unsigned v = 0; v < RegionFrame::kEnd; ++v) place_[v] = mean(frame.points[v]);
    for (std::size_t i = 0; i < kCount; ++i)  // a lattice of rank 1
      for (std::size_t a = 0; a < 3; ++a) {
        const double x = static_cast<double>(i + 1) * kSteps[a];
        samples_[i][a] = x - static_cast<double>(static_cast<int>(x));
      }
    std::array<int, kCount> sum{};
    for (const Triangle& t : surface) {
      const Position origin{0.31, 0.27, 0.43};
      const double volume = six_volumes(origin, place_[t[0]], place_[t[1]], place_[t[2]]);
      const Bits inside = in_simplex({origin, place_[t[0]], place_[t[1]], place_[t[2]]});
      for (std::size_t i = 0; i < kCount; ++i)
        if (inside[i]) sum[i] += volume > 0 ? 1 : -1;
    }
    for (std::size_t i = 0; i < kCount; ++i) region[i] = sum[i] != 0;
  }

  Bits region;  ///< the samples in the region

  [[nodiscard]] Bits in(Vertex a, Vertex b, Vertex c, Vertex d) const {
    return in_simplex({place_[a], place_[b], place_[c], place_[d]});
  }

 private:
  static constexpr std::array<double, 3> kSteps = {0.8191725134, 0.6710436067, 0.5497004779};

  static Position mean(RegionProof::Points points) {
    Position sum{};
    double count = 0;
    for (; points != 0; points &= points - 1, ++count) {
      const auto v = static_cast<unsigned>(std::countr_zero(points));
      if (v >= RegionProof::kFirstRay) {
        unsigned digits = v - RegionProof::kFirstRay;
        for (unsigned a = 0; a < 3; ++a, digits /= 3) sum[a] += 0.5 + 0.25 * (static_cast<double>(digits % 3) - 1.0);
        continue;
      }
      const unsigned corner = v < 8 ? v : detail::edge_base(3, v - 8);
      for (unsigned a = 0; a < 3; ++a) sum[a] += static_cast<double>(corner >> a & 1u);
      if (v >= 8) sum[(v - 8) / 4] += 0.35 + 0.025 * (v - 8);
    }
    for (double& x : sum) x /= std::max(count, 1.0);
    return sum;
  }

  [[nodiscard]] Bits in_simplex(const std::array<Position, 4>& p) const {
    // the planes through three corners, with the fourth on the positive side
    std::array<std::array<double, 4>, 4> planes{};
    for (std::size_t i = 0; i < 4; ++i) {
      const Position &a = p[(i + 1) % 4], &b = p[(i + 2) % 4], &c = p[(i + 3) % 4];
      Position u{}, v{};
      for (std::size_t k = 0; k < 3; ++k) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
      const Position n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
      double height = 0, at = 0;
      for (std::size_t k = 0; k < 3; ++k) at += n[k] * a[k], height += n[k] * p[i][k];
      const double sign = height >= at ? 1.0 : -1.0;
      for (std::size_t k = 0; k < 3; ++k) planes[i][k] = sign * n[k];
      planes[i][3] = -sign * at;
    }
    Bits result;
    for (std::size_t i = 0; i < kCount; ++i) {
      bool inside = true;
      for (const auto& plane : planes)
        inside = inside &&
                 plane[0] * samples_[i][0] + plane[1] * samples_[i][1] + plane[2] * samples_[i][2] + plane[3] > 1e-9;
      result[i] = inside;
    }
    return result;
  }

  std::array<Position, RegionFrame::kEnd> place_{};
  std::array<Position, kCount> samples_{};
};

class Search {
 public:
  Search(const RegionProof& proof, const RegionFrame& frame, std::span<const Triangle> surface)
      : proof_(proof),
        frame_(frame),
        samples_(frame, surface),
        state_(kMost * kMost * kMost, kUnused),
        visible_(2 * state_.size()) {
    Set all = 0;
    for (const Triangle& t : surface) all |= set_of(t);
    for (; all != 0; all &= all - 1) vertices_.push_back(static_cast<Vertex>(std::countr_zero(all)));
    if (vertices_.size() > kMost) return;
    for (std::size_t i = 0; i < vertices_.size(); ++i) local_[vertices_[i]] = i;
    for (const Triangle& t : surface) {
      triangles_.insert(set_of(t));
      for (unsigned i = 0; i < 3; ++i) edges_.insert(one(t[i]) | one(t[(i + 1) % 3]));
      put(t);
    }
    left_ = samples_.region;
    for (const Vertex v : vertices_) points_ |= frame_.points[v];
  }

  /// `most`: tetrahedra taken away before the centre; without a centre, any number.
  std::optional<RegionDivision> run(bool has_centre, unsigned most) {
    if (vertices_.size() > kMost) return std::nullopt;
    has_centre_ = has_centre, most_ = most, nodes_ = 0;
    seen_.clear();
    if (!advance()) return std::nullopt;
    return result_;
  }

 private:
  static constexpr std::size_t kMost = 32;  ///< vertices
  static constexpr unsigned kMostNodes = 400;
  static constexpr std::uint8_t kUnused = 0, kOpen = 1, kOpenReversed = 2, kClosed = 3;

  static Set set_of(const Triangle& t) { return one(t[0]) | one(t[1]) | one(t[2]); }
  [[nodiscard]] RegionProof::Sign sign(RegionProof::Points apex, const Triangle& t) const {
    return proof_.sign(apex, frame_.points[t[0]], frame_.points[t[1]], frame_.points[t[2]]);
  }

  /// Number of a triangle's set, and whether its order is an odd permutation of the ascending one.
  [[nodiscard]] std::pair<std::size_t, bool> number(const Triangle& t) const {
    std::array<std::size_t, 3> v = {local_[t[0]], local_[t[1]], local_[t[2]]};
    bool odd = false;
    const auto order = [&](std::size_t i, std::size_t j) {
      if (v[i] > v[j]) std::swap(v[i], v[j]), odd = !odd;
    };
    order(0, 1), order(1, 2), order(0, 1);
    return {(v[0] * kMost + v[1]) * kMost + v[2], odd};
  }

  void put(const Triangle& t) {
    const auto [n, odd] = number(t);
    state_[n] = odd ? kOpenReversed : kOpen;
    front_.push_back(t);
  }

  [[nodiscard]] bool may_have(Set simplex) const {
    if (std::popcount(simplex) == 2 && edges_.contains(simplex)) return true;
    if (std::popcount(simplex) == 3 && triangles_.contains(simplex)) return true;
    if ((simplex & ~frame_.on_contour) == 0) return false;
    return std::none_of(frame_.squares.begin(), frame_.squares.end(), [&](Set q) { return (simplex & ~q) == 0; });
  }

  /// Whether the tetrahedron inside of an outward triangle is positive and allowed.
  [[nodiscard]] bool is_allowed(const Triangle& t, Vertex apex) const {
    const Set all = set_of(t) | one(apex);
    if ((one(apex) & set_of(t)) != 0 || (all & ~frame_.on_contour) == 0) return false;
    if (sign(frame_.points[apex], t) != RegionProof::Sign::positive) return false;
    for (unsigned i = 0; i < 3; ++i)
      if (!may_have(one(apex) | one(t[i])) || !may_have(one(apex) | one(t[i]) | one(t[(i + 1) % 3]))) return false;
    return true;
  }

  static std::array<Triangle, 3> other_faces(const Triangle& t, Vertex apex) {
    return {Triangle{t[1], t[0], apex}, Triangle{t[2], t[1], apex}, Triangle{t[0], t[2], apex}};
  }

  struct Candidate {
    Vertex apex;
    unsigned closed;
    Samples::Bits inside;
  };

  void find_candidates(const Triangle& t, std::vector<Candidate>& result) {
    result.clear();
    for (const Vertex apex : vertices_) {
      if (!is_allowed(t, apex)) continue;
      unsigned closed = 0;
      bool fits = true;
      for (const Triangle& face : other_faces(t, apex)) {
        const auto [n, odd] = number(face);
        if (state_[n] == kUnused) continue;
        fits = fits && state_[n] == (odd ? kOpenReversed : kOpen);
        ++closed;
      }
      if (!fits) continue;
      const Samples::Bits inside = samples_.in(t[0], t[1], t[2], apex);
      if ((inside & ~left_).any()) continue;
      result.push_back({apex, closed, inside});
    }
  }

  /// The points on the positive side of an outward triangle for all positions, and those never on its negative side.
  struct Visibility {
    RegionProof::Points positive = 0, not_negative = 0;
    bool is_known = false;
  };
  const Visibility& visibility(const Triangle& t) {
    const auto [n, odd] = number(t);
    Visibility& result = visible_[2 * n + (odd ? 1 : 0)];
    if (result.is_known) return result;
    constexpr RegionProof::Points kCentre = RegionProof::Points{1} << RegionProof::kCentre;
    for (RegionProof::Points rest = (points_ & RegionProof::kShared) | kCentre; rest != 0; rest &= rest - 1) {
      const RegionProof::Points point = rest & (0 - rest);
      const auto of_point = sign(point, t);
      if (of_point == RegionProof::Sign::positive) result.positive |= point;
      if (of_point == RegionProof::Sign::positive || of_point == RegionProof::Sign::zero) result.not_negative |= point;
    }
    result.is_known = true;
    return result;
  }

  /// The points from whose mean all of the front is visible, as in CubeRegions::centres; 0 if there are none. That is
  /// the cube's centre, which is the mean of all corners, or one of them is a corner: the copy of such a mean lies half
  /// way to the centre of the tesseract. Caps are not copied. Or it lies on a barycentre's ray.
  [[nodiscard]] std::uint32_t kernel() {
    constexpr RegionProof::Points kCorners = 0xff, kCentre = RegionProof::Points{1} << RegionProof::kCentre;
    RegionProof::Points all = ~RegionProof::Points{0};
    for (const Triangle& t : front_) all &= visibility(t).not_negative;
    const auto is_kernel = [&](RegionProof::Points points) {
      return std::all_of(front_.begin(), front_.end(),
                         [&](const Triangle& t) { return (points & visibility(t).positive) != 0; });
    };
    if ((all & kCentre) != 0 && is_kernel(kCentre)) return kCorners;
    all &= RegionProof::kShared;
    const bool has_place = frame_.is_cap || ((all & kCorners) != 0 && all != kCorners);
    if (has_place && is_kernel(all)) return static_cast<std::uint32_t>(all);
    for (Set rest = frame_.barycentres; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<unsigned>(std::countr_zero(rest));
      if (is_seen_from(v)) return RegionVertices::kFirstDouble << (v - RegionVertices::kFirstOwn);
    }
    return 0;
  }
  /// Whether the triangles of the front that do not contain a vertex are visible from it.
  [[nodiscard]] bool is_seen_from(unsigned v) const {
    return std::all_of(front_.begin(), front_.end(), [&](const Triangle& t) {
      return (set_of(t) & one(v)) != 0 || sign(frame_.points[v], t) == RegionProof::Sign::positive;
    });
  }

  bool take_rest() {
    const std::uint32_t centre = kernel();
    if (centre == 0) return false;
    result_.tetrahedra = taken_;
    result_.centres = {centre};
    for (const Triangle& t : front_)
      result_.tetrahedra.push_back({static_cast<Vertex>(RegionVertices::kFirstCentre), t[0], t[1], t[2]});
    return true;
  }

  bool advance() {
    if (front_.empty()) {
      result_.tetrahedra = taken_;
      return true;
    }
    if (++nodes_ > kMostNodes || (has_centre_ && !seen_.insert(hash_).second)) return false;
    if (has_centre_ && take_rest()) return true;
    if (has_centre_ && taken_.size() == most_) return false;
    if (has_centre_) return advance_everywhere();
    std::vector<Candidate> best, candidates;
    std::size_t at = front_.size();
    for (std::size_t i = 0; i < front_.size(); ++i) {
      find_candidates(front_[i], candidates);
      if (at != front_.size() && candidates.size() >= best.size()) continue;
      best.swap(candidates);
      at = i;
      if (best.empty()) return false;
      if (best.size() == 1) break;
    }
    std::stable_sort(best.begin(), best.end(), [](auto& a, auto& b) { return a.closed > b.closed; });
    const Triangle t = front_[at];
    return std::any_of(best.begin(), best.end(), [&](const Candidate& c) { return take(t, c); });
  }

  /// Tries all tetrahedra at the front, those that close most triangles first.
  bool advance_everywhere() {
    std::vector<std::pair<Triangle, Candidate>> all;
    std::vector<Candidate> candidates;
    for (const Triangle& t : front_) {
      find_candidates(t, candidates);
      for (const Candidate& c : candidates)
        if (c.closed > 0) all.emplace_back(t, c);
    }
    std::stable_sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.second.closed > b.second.closed; });
    return std::any_of(all.begin(), all.end(), [&](auto& each) { return take(each.first, each.second); });
  }

  static std::uint64_t hash_of(Set tetrahedron) {
    std::uint64_t x = tetrahedron * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 32) * 0xd6e8feb86659fd93u;
    return x ^ x >> 32;
  }

  /// Takes a tetrahedron away and goes on; puts it back if that fails.
  bool take(const Triangle& t, const Candidate& candidate) {
    const std::vector<Triangle> front = front_;
    const Samples::Bits left = left_;
    std::vector<std::pair<std::size_t, std::uint8_t>> changed;
    const auto close = [&](const Triangle& face) {
      const auto n = number(face).first;
      changed.emplace_back(n, state_[n]);
      state_[n] = kClosed;
      std::erase_if(front_, [&](const Triangle& other) { return number(other).first == n; });
    };
    close(t);
    for (const Triangle& face : other_faces(t, candidate.apex)) {
      const auto n = number(face).first;
      if (state_[n] != kUnused) {
        close(face);
      } else {
        changed.emplace_back(n, kUnused);
        put({face[1], face[0], face[2]});
      }
    }
    left_ &= ~candidate.inside;
    taken_.push_back({candidate.apex, t[0], t[1], t[2]});
    const std::uint64_t hash = hash_of(set_of(t) | one(candidate.apex));
    hash_ += hash;
    if (advance()) return true;
    hash_ -= hash;
    taken_.pop_back();
    left_ = left;
    front_ = front;
    for (auto at = changed.rbegin(); at != changed.rend(); ++at) state_[at->first] = at->second;
    return false;
  }

  const RegionProof& proof_;
  const RegionFrame& frame_;
  Samples samples_;
  std::vector<Vertex> vertices_;
  std::array<std::size_t, RegionFrame::kEnd> local_{};
  std::set<Set> triangles_, edges_;  ///< of the surface
  std::vector<std::uint8_t> state_;  ///< by triangle
  std::vector<Visibility> visible_;  ///< by triangle and orientation
  RegionProof::Points points_ = 0;   ///< of all vertices
  std::vector<Triangle> front_;
  Samples::Bits left_;
  std::vector<RegionVertices::Tetrahedron> taken_;
  std::uint64_t hash_ = 0;        ///< of the set taken_
  std::set<std::uint64_t> seen_;  ///< hashes of sets from which the search failed
  RegionDivision result_;
  bool has_centre_ = false;
  unsigned most_ = 0, nodes_ = 0;
};

}  // namespace

RegionFrame::RegionFrame() {
  for (unsigned v = 0; v < RegionVertices::kFirstOwn; ++v) points[v] = RegionProof::Points{1} << v;
  for (unsigned q = 0; q < 6; ++q)
    squares[q] = detail::face_corners(3, q) | Set{detail::face_edges(3, q)} << RegionVertices::kFirstEdge;
}

std::optional<RegionDivision> divide_region(const RegionProof& proof, const RegionFrame& frame,
                                            std::span<const Triangle> surface) {
  Search search(proof, frame, surface);
  if (auto found = search.run(false, 0)) return found;
  constexpr unsigned kMostBefore = 4;
  for (unsigned most = 0; most <= kMostBefore; ++most)
    if (auto found = search.run(true, most)) return found;
  return std::nullopt;
}

}  // namespace tegl::gen
