// SPDX-License-Identifier: BSD-3-Clause
//
// The level sweep. Only a component that changed since the level before can lack a pick. So the sweep checks, at each
// level, the trees that become active and the ends of the links that expired.
#include "search/level_sweep.hpp"

#include <algorithm>
#include <utility>

namespace tegl::detail {

namespace {

class LevelSweep {
 public:
  LevelSweep(const SeedGraph& graph, const LevelSweepOptions& options)
      : graph_(graph), options_(options), sets_(graph.roots.size()), leaves_(1) {
    while (leaves_ < std::max(1u, graph.levels)) leaves_ *= 2;
    picks_of_node_.resize(std::size_t{2} * leaves_);
    for (std::uint32_t tree = 0; tree < sets_.size(); ++tree)
      sets_[tree] = {tree, 1, tree, may_be_picked(tree), tree, false};
    find_events();
  }

  LevelSweepResult run() {
    waiting_.reserve(2 * graph_.links.size());
    for (const SeedLink& link : graph_.links) {
      const auto [from, to] = span(link.first, link.end);
      waiting_.push_back({link.a, link.b, from, to});
    }
    if (!events_.empty()) descend(1, 0, leaves_, 0);
    std::sort(result_.picked.begin(), result_.picked.end());
    return std::move(result_);
  }

 private:
  /// A set of trees, stored at its root tree. Every tree stores its parent and its successor in the ring of its set.
  struct Set {
    std::uint32_t parent;
    std::uint32_t size;
    std::uint32_t farthest;  ///< among its trees that may be picked
    bool pickable;           ///< whether any of its trees may be picked
    std::uint32_t next;      ///< next tree of the set, in a ring
    bool picked;
  };
  struct Undo {
    std::uint32_t set;  ///< the set that was merged into another; for a pick, the set that was picked
    std::uint32_t on;   ///< the set it was merged into; kNone for a pick
    std::uint32_t farthest;
    bool pickable, picked;
  };
  static constexpr std::uint32_t kNone = ~0u;

  [[nodiscard]] bool may_be_picked(std::uint32_t tree) const {
    return options_.allowed == nullptr || (*options_.allowed)[tree];
  }
  [[nodiscard]] bool down() const noexcept { return options_.direction == SweepDirection::down; }
  /// Levels in the order of the sweep.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> span(std::uint32_t first, std::uint32_t end) const noexcept {
    return down() ? std::pair(graph_.levels - end, graph_.levels - first) : std::pair(first, end);
  }
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> tree_span(std::uint32_t tree) const noexcept {
    return span(graph_.first[tree], graph_.end[tree]);
  }

  void find_events() {
    events_.reserve(graph_.roots.size() + 2 * graph_.links.size());
    for (std::uint32_t tree = 0; tree < graph_.roots.size(); ++tree) events_.emplace_back(tree_span(tree).first, tree);
    for (const SeedLink& link : graph_.links) {
      const std::uint32_t gone = span(link.first, link.end).second;
      if (gone < tree_span(link.a).second) events_.emplace_back(gone, link.a);
      if (gone < tree_span(link.b).second) events_.emplace_back(gone, link.b);
    }
    for (const PickedElsewhere& pick : options_.elsewhere) {
      const auto [first, gone] = span(pick.first, pick.end);
      mark_levels(pick.tree, first, gone);
      if (gone < tree_span(pick.tree).second) events_.emplace_back(gone, pick.tree);
    }
    std::sort(events_.begin(), events_.end());
    events_.erase(std::unique(events_.begin(), events_.end()), events_.end());
  }

  /// Root of a tree's set. Without path compression, so that `undo_` can take joins back.
  [[nodiscard]] std::uint32_t find(std::uint32_t tree) const noexcept {
    while (sets_[tree].parent != tree) tree = sets_[tree].parent;
    return tree;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    if (sets_[a].size < sets_[b].size) std::swap(a, b);
    Set& on = sets_[a];
    const Set& set = sets_[b];
    undo_.push_back({b, a, on.farthest, on.pickable, on.picked});
    sets_[b].parent = a;
    on.size += set.size;
    std::swap(on.next, sets_[b].next);
    if (set.pickable && (!on.pickable || is_farther(set.farthest, on.farthest))) on.farthest = set.farthest;
    on.pickable = on.pickable || set.pickable;
    on.picked = on.picked || set.picked;
  }
  /// Whether a is active longer than b from here on. Ties: the tree that became active earlier, then the lower number.
  [[nodiscard]] bool is_farther(std::uint32_t a, std::uint32_t b) const noexcept {
    const auto [first_a, end_a] = tree_span(a);
    const auto [first_b, end_b] = tree_span(b);
    if (end_a != end_b) return end_a > end_b;
    if (first_a != first_b) return first_a < first_b;
    return a < b;
  }
  void mark_picked(std::uint32_t tree) {
    const std::uint32_t set = find(tree);
    if (sets_[set].picked) return;
    undo_.push_back({set, kNone, 0, false, false});
    sets_[set].picked = true;
  }
  void undo_to(std::size_t size) noexcept {
    for (; undo_.size() > size; undo_.pop_back()) {
      const Undo& undo = undo_.back();
      if (undo.on == kNone) {
        sets_[undo.set].picked = false;
        continue;
      }
      Set& on = sets_[undo.on];
      std::swap(on.next, sets_[undo.set].next);
      on.size -= sets_[undo.set].size;
      on.farthest = undo.farthest;
      on.pickable = undo.pickable;
      on.picked = undo.picked;
      sets_[undo.set].parent = undo.set;
    }
  }

  /// Visits the levels first ... end - 1 of a node of the binary tree. `waiting_` holds, from `links` on, all links
  /// that are active in some of these levels and were not joined at an ancestor. Restores `waiting_` and the sets
  /// before it returns.
  void descend(std::size_t node, std::uint32_t first, std::uint32_t end, std::size_t links) {
    if (next_event_ == events_.size() || events_[next_event_].first >= end) return;
    const std::size_t before = undo_.size();
    const std::size_t links_end = waiting_.size();
    for (std::size_t i = links; i < links_end; ++i) {
      const SeedLink link = waiting_[i];
      if (link.first <= first && end <= link.end)
        join(link.a, link.b);
      else if (link.first < end && first < link.end)
        waiting_.push_back(link);
    }
    // Sets that are joined here stay joined in all levels of the node. So the links passed down connect sets, and a
    // link within one set is dropped.
    std::size_t kept = links_end;
    for (std::size_t i = links_end; i < waiting_.size(); ++i) {
      const SeedLink link{find(waiting_[i].a), find(waiting_[i].b), waiting_[i].first, waiting_[i].end};
      if (link.a != link.b) waiting_[kept++] = link;
    }
    waiting_.resize(kept);
    for (const std::uint32_t tree : picks_of_node_[node]) mark_picked(tree);
    if (end - first == 1) {
      visit(first);
    } else {
      const std::uint32_t middle = first + (end - first) / 2;
      descend(2 * node, first, middle, links_end);
      descend(2 * node + 1, middle, end, links_end);
    }
    waiting_.resize(links_end);
    undo_to(before);
  }

  void visit(std::uint32_t level) {
    for (; next_event_ < events_.size() && events_[next_event_].first == level; ++next_event_) {
      const std::uint32_t set = find(events_[next_event_].second);
      if (sets_[set].picked || !sets_[set].pickable) continue;
      ++result_.times;
      if (options_.pick == SweepPick::farthest) {
        result_.picked.push_back(sets_[set].farthest);
        pick(sets_[set].farthest, level);
      } else {
        std::uint32_t tree = set;
        do {
          pick(tree, level);
          tree = sets_[tree].next;
        } while (tree != set);
      }
    }
    if (level < next_report_) return;
    next_report_ = level + std::max(1u, leaves_ / 1024);
    report_progress(options_.progress, static_cast<double>(level) / static_cast<double>(leaves_));
  }

  /// Marks a tree as picked at this level and at all later levels of the tree.
  void pick(std::uint32_t tree, std::uint32_t level) {
    mark_picked(tree);
    mark_levels(tree, level + 1, tree_span(tree).second);
  }
  void mark_levels(std::uint32_t tree, std::uint32_t first, std::uint32_t end) {
    std::size_t low = std::size_t{leaves_} + first;
    std::size_t high = std::size_t{leaves_} + end;
    for (; low < high; low /= 2, high /= 2) {
      if (low % 2 == 1) picks_of_node_[low++].push_back(tree);
      if (high % 2 == 1) picks_of_node_[--high].push_back(tree);
    }
  }

  const SeedGraph& graph_;
  const LevelSweepOptions& options_;
  std::vector<Set> sets_;
  std::uint32_t leaves_;  ///< leaves of the binary tree, a power of 2; node 1 is its root, 2n and 2n + 1 are the
                          ///< children of node n
  std::vector<std::vector<std::uint32_t>> picks_of_node_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> events_;  ///< level, tree; ascending
  std::size_t next_event_ = 0;
  std::uint32_t next_report_ = 0;  ///< level
  std::vector<Undo> undo_;
  std::vector<SeedLink>
      waiting_;  ///< links of the nodes from the root to the current one, in the sweep's order of levels
  LevelSweepResult result_;
};

}  // namespace

LevelSweepResult sweep_levels(const SeedGraph& graph, const LevelSweepOptions& options) {
  return LevelSweep(graph, options).run();
}

}  // namespace tegl::detail
