// SPDX-License-Identifier: BSD-3-Clause
//
// Priority queues of contraction candidates. Candidates near a contraction get a new key. Edges have no number to be
// found by in their queue, so they are inserted again with a new stamp; entries with an old stamp are skipped. Edges
// with similar keys are taken in the order of their vertices (edge_buckets.hpp).
//
// Based on: M. Liversage, thesis, 1994, sections 8.3.8 to 8.3.14 (facets by curvature, vertices); G. Turk, Re-tiling
// polygonal surfaces, 1992 (curvature); W. Schroeder, J. Zarge and W. Lorensen, Decimation of triangle meshes, 1992
// (distance); M. Garland and P. Heckbert, Surface simplification using quadric error metrics, 1997.
#include "simplify/simplify_orders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/keyed_queue.hpp"
#include "base/workers.hpp"
#include "simplify/contour_parts.hpp"
#include "simplify/edge_buckets.hpp"
#include "simplify/few_vertices.hpp"
#include "simplify/loaded_edge.hpp"

namespace tegl::detail {
namespace {

/// Weight of the squared edge length in the key of an edge, so that flat regions begin with short edges: a thousandth
/// of the length counts as error.
constexpr double kLengthShare = 1e-6;
constexpr std::size_t kCallsPerReport = 1024;
constexpr int kMostPasses = 20;
constexpr double kLeastGain = 0.02;

/// Reports progress from time to time.
class ProgressReporter {
 public:
  ProgressReporter(const CollapseGoal& goal, std::size_t before) : goal_(goal), before_(before) {}

  /// Whether `alive` simplices are more than the goal. Throws Cancelled.
  bool continues(std::size_t alive) {
    if (alive <= goal_.count) return false;
    count_step(alive);
    return true;
  }
  /// Counts steps that remove no simplex, or have removed some. Throws Cancelled.
  void count_steps(std::size_t alive, std::size_t steps) {
    const std::size_t before = calls_;
    calls_ += steps;
    if (before == 0 || before / kCallsPerReport != calls_ / kCallsPerReport) tell(alive);
  }
  void count_step(std::size_t alive) { count_steps(alive, 1); }

 private:
  void tell(std::size_t alive) {
    if (goal_.progress == nullptr || !*goal_.progress) return;
    const double share = before_ <= goal_.count
                             ? 1.0
                             : static_cast<double>(before_ - alive) / static_cast<double>(before_ - goal_.count);
    last_ = std::max(last_, goal_.from + (goal_.to - goal_.from) * std::min(1.0, share));
    if (!(*goal_.progress)(last_))
      throw Error(ErrorCode::Cancelled, fmt::format("simplification cancelled at {} of {} simplices", alive, before_));
  }

  const CollapseGoal& goal_;
  std::size_t before_;
  std::size_t calls_ = 0;
  double last_ = 0.0;
};

// ---- edges by quadrics ----

/// Costs are computed late: for all vertices that took part in contractions since the queue loaded its entries, by all
/// threads. The queue gives no entry of theirs before it loads others, and each edge is computed only in its last
/// state. One thread computes them at once, while the surroundings of the vertex are in the cache: with the same
/// result.
///
/// Large contours have parts (contour_parts.hpp). Of the loaded entries, first the edges within each part are
/// contracted, by all threads, then the others. One thread does so in the same order, so the result does not depend on
/// the number of threads.
template <int N>
class QuadricOrder {
 public:
  QuadricOrder(EdgeCollapse<N>& collapse, const CollapseGoal& goal)
      : collapse_(collapse),
        by_mean_(goal.by_mean),
        count_(goal.count),
        least_entries_(std::min(kLeastEntries, goal.least_in_parts)),
        reporter_(goal, collapse.complex().alive()),
        workers_(goal.threads, [] { return Scratch(); }),
        waits_(collapse.points().size(), 0) {
    if (collapse.complex().alive() < goal.least_in_parts || collapse.keeps_embedded()) return;
    parts_.emplace(collapse.scaled(), [&](const auto& visit) {
      for (Index s = 0; s < collapse.complex().simplex_count(); ++s)
        if (collapse.complex().is_alive(s)) visit(collapse.complex().simplex(s));
    });
  }

  void fill() {
    for (Index v = 0; v < collapse_.points().size(); ++v) let_wait(v);
    if (collapse_.complex().alive() > count_) push_waiting();
  }
  void empty() {
    while (reporter_.continues(collapse_.complex().alive())) {
      push_waiting();
      const std::span<const Entry> entries = queue_.load([&](const Entry& entry) { return is_current(entry); });
      if (entries.empty()) return;
      for (std::size_t first = 0; first < entries.size() && collapse_.complex().alive() > count_; first += kMostEntries)
        contract_all(entries.subspan(first, std::min(kMostEntries, entries.size() - first)));
    }
  }

 private:
  using Parts = ContourParts<N>;
  using Entry = EdgeBuckets::Entry;

  /// Vertices whose costs are computed before they are pushed, and those in each part of a thread's work.
  static constexpr std::size_t kChunk = 4096;
  static constexpr std::size_t kGrain = 64;
  /// Entries that are contracted in parts; progress is reported after at most kMostEntries.
  static constexpr std::size_t kLeastEntries = 128;
  static constexpr std::size_t kMostEntries = std::size_t{1} << 15;
  /// Edges are contracted one after the other if fewer simplices than this may be removed from each part.
  static constexpr std::size_t kLeastRemoved = 1024;

  struct Pushed {
    double key;
    Entry entry;
  };
  struct Scratch {
    FewVertices few;
    std::vector<Index> around;
    std::vector<typename EdgeCollapse<N>::EdgeCost> costs;
    LoadedEdge<N> loaded;
  };
  /// The loaded entries of a part.
  struct PartEntries {
    std::size_t first = 0, end = 0;  ///< in sorted_
    std::vector<Index> waiting;      ///< vertices whose costs are to be computed
  };

  /// Contracts at the best target, or else at one of the ends.
  bool contract(const Entry& entry, LoadedEdge<N>& loaded) {
    loaded.drop();
    const Index a = entry.a, b = entry.b;
    const auto target = collapse_.best_target(a, b);
    if (!target) return false;
    if (collapse_.try_contract(a, b, *target, loaded)) return true;
    auto at_a = collapse_.target_at(a, b, collapse_.points()[a], 0.0);
    auto at_b = collapse_.target_at(a, b, collapse_.points()[b], 1.0);
    if (at_b.cost < at_a.cost) std::swap(at_a, at_b);
    for (const auto& end : {at_a, at_b})
      if (end.share == 0.0 ? collapse_.may_move_to(b, a) : collapse_.may_move_to(a, b))
        if (collapse_.try_contract(a, b, end, loaded)) return true;
    return false;
  }

  /// The memory around the next entries lies apart: it arrives while others are contracted.
  using Ahead = EdgesAhead<4>;
  static Ahead ahead_of(std::span<const Entry> entries) { return Ahead(entries, {8, 6, 4, 2}); }
  void request(Ahead& ahead, std::size_t position) const {
    using Request = typename CollapsibleComplex<N>::Ahead;
    ahead.request(position, [&](std::size_t step, const Entry& entry) {
      if (step == 3) return collapse_.request_corners(entry.a, entry.b);
      collapse_.complex().request(entry.a, static_cast<Request>(step));
      collapse_.complex().request(entry.b, static_cast<Request>(step));
    });
  }
  [[nodiscard]] std::uint32_t stamp(Index a, Index b) const { return collapse_.version(a) + collapse_.version(b); }
  [[nodiscard]] bool is_current(const Entry& entry) const { return entry.stamp == stamp(entry.a, entry.b); }

  /// Contracts until the goal is reached.
  void contract_all(std::span<const Entry> entries) {
    if (const std::size_t most = most_removed_from_part(entries.size()); most > 0)
      entries = contract_in_parts(entries, most);
    contract_in_turn(entries);
  }
  void contract_in_turn(std::span<const Entry> entries) {
    Ahead ahead = ahead_of(entries);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Entry& entry = entries[i];
      if (!is_current(entry)) continue;
      if (!reporter_.continues(collapse_.complex().alive())) return;
      request(ahead, i);
      if (!contract(entry, loaded_)) continue;
      if (parts_) parts_->merge(entry.a, entry.b);
      let_wait(entry.a);
      if (workers_.count() == 1) push_waiting();
    }
  }

  /// The number of simplices that may be removed from each part at the same time: all parts together remove at most
  /// about half of those above the goal. 0: edges are contracted one after the other.
  [[nodiscard]] std::size_t most_removed_from_part(std::size_t entries) const {
    if (!parts_ || entries < least_entries_) return 0;
    const std::size_t most = (collapse_.complex().alive() - count_) / (2 * Parts::kCount);
    return most < kLeastRemoved ? 0 : most;
  }

  /// Contracts the edges within each part. Returns the entries of other edges.
  std::span<const Entry> contract_in_parts(std::span<const Entry> entries, std::size_t most_removed) {
    sort_by_part(entries);
    workers_.for_range(Parts::kCount, 1, [&](std::size_t from, std::size_t to, Scratch& scratch) {
      const std::size_t first = entries_of_[from].first;
      Ahead ahead = ahead_of(std::span<const Entry>(sorted_).subspan(first, entries_of_[to - 1].end - first));
      for (std::size_t part = from; part < to; ++part)
        contract_part(entries_of_[part], most_removed, scratch.loaded, ahead, first);
    });
    std::size_t left = 0, tried = entries_of_[Parts::kCount].first;
    for (PartEntries& part : entries_of_) {
      for (const Index v : part.waiting) let_wait(v);
      part.waiting.clear();
      for (std::size_t i = part.first; i < part.end; ++i) sorted_[left++] = sorted_[i];
    }
    reporter_.count_steps(collapse_.complex().alive(), tried);
    return std::span<const Entry>(sorted_).first(left);
  }

  /// Sorts the entries by part; within each, they keep their order.
  void sort_by_part(std::span<const Entry> entries) {
    const auto part_of = [&](const Entry& entry) { return parts_->of(entry.a, entry.b); };
    std::array<std::size_t, Parts::kCount + 2> next{};
    for (const Entry& entry : entries) ++next[part_of(entry) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::size_t part = 0; part <= Parts::kCount; ++part) {
      entries_of_[part].first = next[part];
      entries_of_[part].end = next[part + 1];
    }
    sorted_.resize(entries.size());
    for (const Entry& entry : entries) sorted_[next[part_of(entry)]++] = entry;
  }

  /// Contracts edges within a part, and removes them from its entries. `first`: the entry that `ahead` begins with.
  void contract_part(PartEntries& part, std::size_t most_removed, LoadedEdge<N>& loaded, Ahead& ahead,
                     std::size_t first) {
    for (std::size_t removed = 0; part.first < part.end && removed < most_removed; ++part.first) {
      const Entry& entry = sorted_[part.first];
      if (!is_current(entry)) continue;
      request(ahead, part.first - first);
      if (!contract(entry, loaded)) continue;
      removed += loaded.edge().both.size();
      if (workers_.count() == 1) {
        let_wait(entry.a);
        push_waiting();
      } else {
        part.waiting.push_back(entry.a);
      }
    }
  }

  void let_wait(Index v) {
    if (waits_[v] != 0) return;
    waits_[v] = 1;
    waiting_.push_back(v);
  }

  /// Pushes the edges of all vertices that wait. A vertex that was merged into another one has none.
  void push_waiting() {
    if (pushed_.size() < std::min(kChunk, waiting_.size())) pushed_.resize(std::min(kChunk, waiting_.size()));
    for (std::size_t first = 0; first < waiting_.size(); first += kChunk) {
      const std::size_t count = std::min(kChunk, waiting_.size() - first);
      workers_.for_range(count, kGrain, [&](std::size_t from, std::size_t to, Scratch& scratch) {
        for (std::size_t i = from; i < to; ++i) find_edges(waiting_[first + i], scratch, pushed_[i]);
      });
      for (std::size_t i = 0; i < count; ++i) {
        if (count > 1) reporter_.count_step(collapse_.complex().alive());
        for (const Pushed& edge : pushed_[i]) queue_.push(edge.key, edge.entry);
      }
    }
    for (const Index v : waiting_) waits_[v] = 0;
    waiting_.clear();
  }

  /// The edges of u. Those between two vertices that wait belong to the one with the smaller number. Threads may call
  /// it at the same time, for different vertices.
  void find_edges(Index u, Scratch& scratch, std::vector<Pushed>& edges) {
    edges.clear();
    scratch.around.clear();
    collapse_.complex().visit_neighbours(u, scratch.few, [&](Index a) {
      if (a < u && waits_[a] != 0) return;
      collapse_.request_cost(a);
      scratch.around.push_back(a);
    });
    collapse_.costs_around(u, scratch.around, scratch.costs);
    for (const auto& [a, cost, square] : scratch.costs) {
      const double weight = collapse_.quadric(u).weight() + collapse_.quadric(a).weight();
      const double sum = cost + kLengthShare * weight * square;
      edges.push_back({by_mean_ && weight > 0.0 ? sum / weight : sum, {std::min(u, a), std::max(u, a), stamp(u, a)}});
    }
  }

  EdgeCollapse<N>& collapse_;
  bool by_mean_;
  std::size_t count_;
  std::size_t least_entries_;  ///< that are contracted in parts
  ProgressReporter reporter_;
  Workers<Scratch> workers_;
  EdgeBuckets queue_;
  LoadedEdge<N> loaded_;
  std::optional<Parts> parts_;
  std::vector<Entry> sorted_;                              ///< the loaded entries, by part
  std::array<PartEntries, Parts::kCount + 1> entries_of_;  ///< by part; those of no part last
  std::vector<Index> waiting_;
  std::vector<std::uint8_t> waits_;          ///< by vertex: whether it is in waiting_
  std::vector<std::vector<Pushed>> pushed_;  ///< by vertex of a chunk
};

// ---- facets by curvature ----

template <int N>
class CurvatureOrder {
 public:
  CurvatureOrder(EdgeCollapse<N>& collapse, const CollapseGoal& goal)
      : collapse_(collapse),
        max_curvature_(goal.max_curvature),
        reporter_(goal, collapse.complex().alive()),
        queue_(collapse.complex().simplex_count()),
        curvature_(collapse.points().size()) {}

  void fill() {
    for (Index v = 0; v < curvature_.size(); ++v) {
      reporter_.count_step(collapse_.complex().alive());
      curvature_[v] = curvature(v);
    }
    for (Index s = 0; s < collapse_.complex().simplex_count(); ++s) {
      reporter_.count_step(collapse_.complex().alive());
      if (collapse_.complex().is_alive(s)) push(s);
    }
  }
  void empty() {
    while (reporter_.continues(collapse_.complex().alive()) && !queue_.empty()) {
      const Index next = queue_.pop();
      if (!collapse_.complex().is_alive(next)) continue;
      if (curvature_of(next) > max_curvature_) {
        note_limit(collapse_.complex().simplex(next));
        continue;
      }
      const Index left = remove(collapse_.complex().simplex(next));
      if (left != CollapsibleComplex<N>::kNone) update(left);
    }
  }

 private:
  /// Maximum, over the edges at v, of the curvature of the circle that touches the edge and its mirror image about the
  /// normal in their middles (thesis, 8.3.12): 2 cot(angle) / length.
  double curvature(Index v) {
    const PointN<N> normal = collapse_.mean_normal(v, star_);
    const double length = norm(normal);
    if (!(length > 0.0)) return std::numeric_limits<double>::infinity();
    double largest = 0.0;  // of the curvature: a quarter of the square
    for (const Index s : star_)
      for (const Index a : collapse_.complex().simplex(s)) {
        if (a == v) continue;
        const PointN<N> edge = minus(collapse_.scaled()[a], collapse_.scaled()[v]);
        const double square = dot(edge, edge);
        if (!(square > 0.0)) continue;
        const double way = dot(edge, normal) / length, along = way * way;
        largest = std::max(largest, along / (std::max(0.0, square - along) * square));
      }
    return 2.0 * std::sqrt(largest);
  }

  /// Mean curvature of the vertices of a facet.
  [[nodiscard]] double curvature_of(Index s) const {
    double sum = 0.0;
    for (const Index v : collapse_.complex().simplex(s)) sum += curvature_[v];
    return sum / N;
  }

  /// The key is the curvature times the square of the longest edge, that is 8 times the rise of an arc of this
  /// curvature over the facet. For facets of similar size, as extraction generates them, this is the order of the
  /// thesis. With the curvature only, large facets in flat regions would grow at any cost.
  void push(Index s) {
    const double edge = longest_edge<N>(collapse_.corners(s));
    queue_.set(s, curvature_of(s) * edge * edge);
  }

  /// Contracts the facet to one point, edge by edge. Returns the remaining vertex; kNone if no edge could be
  /// contracted.
  Index remove(std::array<Index, N> facet) {
    const auto target = collapse_.common_target(facet);
    if (!target) return CollapsibleComplex<N>::kNone;
    if (target->anchor) std::iter_swap(facet.begin(), std::find(facet.begin(), facet.end(), *target->anchor));
    const auto try_pair = [&](Index u, Index v, double share) {
      return collapse_.try_contract(u, v, collapse_.target_at(u, v, target->at, target->anchor ? 0.0 : share), loaded_);
    };
    for (int i = 0; i < (target->anchor ? 1 : N - 1); ++i)
      for (int j = i + 1; j < N; ++j) {
        if (!try_pair(facet[i], facet[j], 0.5)) continue;
        double met = 2.0;
        for (int k = 0; k < N; ++k)
          if (k != i && k != j && try_pair(facet[i], facet[k], 1.0 / (met + 1.0))) met += 1.0;
        return facet[i];
      }
    return CollapsibleComplex<N>::kNone;
  }

  /// Notes a limit if only the maximum curvature keeps the facet.
  void note_limit(const std::array<Index, N>& facet) {
    if (collapse_.is_limited()) return;
    const auto target = collapse_.common_target(facet);
    if (!target) return;
    const Index u = target->anchor.value_or(facet[0]);
    for (const Index v : facet)
      if (v != u)
        collapse_.note_limit(u, v, collapse_.target_at(u, v, target->at, target->anchor ? 0.0 : 0.5), loaded_);
  }

  /// Updates the curvatures of the vertices around `left` and the keys of the facets at `left`.
  void update(Index left) {
    collapse_.complex().neighbours(left, around_);
    for (const Index v : around_) curvature_[v] = curvature(v);
    curvature_[left] = curvature(left);  // stores the star in star_
    for (const Index s : star_) push(s);
  }

  EdgeCollapse<N>& collapse_;
  double max_curvature_;
  ProgressReporter reporter_;
  KeyedQueue queue_;
  std::vector<double> curvature_;
  std::vector<Index> star_, around_;
  LoadedEdge<N> loaded_;
};

// ---- vertices by distance ----

template <int N>
class DistanceOrder {
 public:
  DistanceOrder(EdgeCollapse<N>& collapse, const CollapseGoal& goal)
      : collapse_(collapse), reporter_(goal, collapse.complex().alive()), queue_(collapse.points().size()) {}

  void fill() {
    for (Index v = 0; v < collapse_.points().size(); ++v) {
      reporter_.count_step(collapse_.complex().alive());
      push(v);
    }
  }
  void empty() {
    while (reporter_.continues(collapse_.complex().alive()) && !queue_.empty()) {
      const Index left = remove(queue_.pop());
      if (left == CollapsibleComplex<N>::kNone) continue;
      collapse_.complex().neighbours(left, around_);
      around_.push_back(left);
      for (const Index v : around_) push(v);
    }
  }

 private:
  /// Distance of v from the hyperplane that is orthogonal to the mean normal and passes through the weighted mean of
  /// the centroids of the faces opposite to v; weights are the measures.
  double distance(Index v) {
    collapse_.complex().star(v, star_);
    PointN<N> normal{}, middle{};
    double weight = 0.0;
    for (const Index s : star_) {
      const CornersN<N> corners = collapse_.corners(s);
      const PointN<N> of_simplex = normal_of<N>(corners);
      const double measure = norm(of_simplex);
      weight += measure;
      for (int a = 0; a < N; ++a) {
        normal[a] += of_simplex[a];
        double sum = -N * collapse_.scaled()[v][a];  // v is one of the corners
        for (const PointN<N>& corner : corners) sum += corner[a];
        middle[a] += measure * sum / (N - 1);
      }
    }
    const double length = norm(normal);
    if (!(length > 0.0)) return std::numeric_limits<double>::infinity();
    return std::abs(dot(normal, middle) / (weight * length));
  }

  void push(Index v) {
    const double key = distance(v);
    if (!star_.empty()) queue_.set(v, key);
  }

  /// Removes v by contracting it to a neighbour: the one with the lowest quadric cost that is possible. Returns that
  /// neighbour, or kNone.
  Index remove(Index v) {
    collapse_.complex().neighbours(v, around_);
    targets_.clear();
    for (const Index u : around_)
      if (collapse_.may_move_to(v, u))
        targets_.emplace_back(collapse_.target_at(u, v, collapse_.points()[u], 0.0).cost, u);
    std::sort(targets_.begin(), targets_.end());
    for (const auto& [cost, u] : targets_)
      if (collapse_.try_contract(u, v, {collapse_.points()[u], 0.0, cost}, loaded_)) return u;
    return CollapsibleComplex<N>::kNone;
  }

  EdgeCollapse<N>& collapse_;
  ProgressReporter reporter_;
  KeyedQueue queue_;
  std::vector<Index> star_, around_;
  LoadedEdge<N> loaded_;
  std::vector<std::pair<double, Index>> targets_;
};

/// Repeats passes while they remove at least kLeastGain of the simplices: a contraction that was impossible may become
/// possible after its surroundings have changed.
template <class Order, int N>
void collapse_in_passes(EdgeCollapse<N>& collapse, const CollapseGoal& goal) {
  Order order(collapse, goal);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const std::size_t before = collapse.complex().alive();
    order.fill();
    if (pass == 0 && goal.ready) goal.ready();
    order.empty();
    const std::size_t after = collapse.complex().alive();
    if (after <= goal.count || static_cast<double>(before - after) < kLeastGain * static_cast<double>(before)) return;
  }
}

}  // namespace

template <int N>
void collapse_by_quadrics(EdgeCollapse<N>& collapse, const CollapseGoal& goal) {
  collapse_in_passes<QuadricOrder<N>>(collapse, goal);
}
template <int N>
void collapse_by_curvature(EdgeCollapse<N>& collapse, const CollapseGoal& goal) {
  collapse_in_passes<CurvatureOrder<N>>(collapse, goal);
}
template <int N>
void collapse_by_distance(EdgeCollapse<N>& collapse, const CollapseGoal& goal) {
  collapse_in_passes<DistanceOrder<N>>(collapse, goal);
}

template void collapse_by_quadrics(EdgeCollapse<2>&, const CollapseGoal&);
template void collapse_by_quadrics(EdgeCollapse<3>&, const CollapseGoal&);
template void collapse_by_quadrics(EdgeCollapse<4>&, const CollapseGoal&);
template void collapse_by_curvature(EdgeCollapse<2>&, const CollapseGoal&);
template void collapse_by_curvature(EdgeCollapse<3>&, const CollapseGoal&);
template void collapse_by_curvature(EdgeCollapse<4>&, const CollapseGoal&);
template void collapse_by_distance(EdgeCollapse<2>&, const CollapseGoal&);
template void collapse_by_distance(EdgeCollapse<3>&, const CollapseGoal&);
template void collapse_by_distance(EdgeCollapse<4>&, const CollapseGoal&);

}  // namespace tegl::detail
