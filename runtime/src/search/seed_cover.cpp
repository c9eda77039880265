// SPDX-License-Identifier: BSD-3-Clause
//
// Seeds as a cover of components by trees, and the method Whole2, which covers tree by tree.
#include <algorithm>
#include <tuple>

#include "base/disjoint_sets.hpp"
#include "base/progress.hpp"
#include "search/level_sweep.hpp"
#include "search/seed_methods.hpp"

namespace tegl::detail {

namespace {

constexpr int kMostSparing = 8;  ///< sweeps; the last ones remove least

/// Repeats the sweep with only the trees in `picked`, alternately up and down, until two sweeps remove none.
std::vector<std::uint32_t> spare(const SeedGraph& graph, std::vector<std::uint32_t> picked, SweepDirection last,
                                 const Progress& progress) {
  std::vector<bool> allowed(graph.roots.size());
  for (int sweep = 0, in_vain = 0; in_vain < 2 && sweep < kMostSparing; ++sweep) {
    std::fill(allowed.begin(), allowed.end(), false);
    for (const std::uint32_t tree : picked) allowed[tree] = true;
    last = opposite(last);
    auto fewer = sweep_levels(
        graph, {.direction = last,
                .pick = SweepPick::farthest,
                .allowed = &allowed,
                .elsewhere = {},
                .progress = part_of(progress, sweep / double{kMostSparing}, (sweep + 1) / double{kMostSparing})});
    in_vain = fewer.picked.size() < picked.size() ? 0 : in_vain + 1;
    if (fewer.picked.size() < picked.size()) picked = std::move(fewer.picked);
  }
  return picked;
}

/// Whole2: keeps the roots that their neighbouring trees do not cover, and records which trees cover the removed roots.
class Whole2 {
 public:
  Whole2(const SeedGraph& graph, Dependence dependence)
      : graph_(graph),
        dependence_(dependence),
        sets_(graph.roots.size()),
        users_(graph.roots.size()),
        asked_(graph.roots.size(), kNever) {}

  std::vector<std::uint32_t> run(const Progress& progress) {
    std::vector<std::uint32_t> kept;
    std::size_t link = 0;
    for (std::uint32_t root = 0; root < graph_.roots.size(); ++root) {
      if (root % 4096 == 0) report_progress(progress, static_cast<double>(root) / static_cast<double>(sets_.size()));
      ask(root);
      std::vector<SeedLink> around;
      for (; link < graph_.links.size() && graph_.links[link].a == root; ++link)
        if (!depends(graph_.links[link].b, root)) around.push_back(graph_.links[link]);
      if (!cover(root, around)) kept.push_back(root);
    }
    return kept;
  }

 private:
  static constexpr std::uint32_t kNever = ~0u;

  /// Marks, in `asked_`, all roots that depend on this root.
  void ask(std::uint32_t root) {
    if (dependence_ == Dependence::sets) return;
    std::vector<std::uint32_t> open{root};
    asked_[root] = root;
    while (!open.empty()) {
      const std::uint32_t next = open.back();
      open.pop_back();
      for (const std::uint32_t user : users_[next]) {
        if (asked_[user] == root) continue;
        asked_[user] = root;
        open.push_back(user);
      }
    }
  }
  [[nodiscard]] bool depends(std::uint32_t tree, std::uint32_t on) {
    return dependence_ == Dependence::sets ? sets_.find(tree) == sets_.find(on) : asked_[tree] == on;
  }

  /// Whether `around` covers the root. If so, records the smallest set of covering trees (greedy interval cover).
  bool cover(std::uint32_t root, std::vector<SeedLink>& around) {
    std::sort(around.begin(), around.end(),
              [](const SeedLink& p, const SeedLink& q) { return std::tie(p.first, p.b) < std::tie(q.first, q.b); });
    std::vector<std::uint32_t> chosen;
    std::uint32_t level = graph_.first[root];
    for (std::size_t i = 0; level < graph_.end[root];) {
      std::uint32_t farthest = level;
      std::uint32_t by = 0;
      for (; i < around.size() && around[i].first <= level; ++i)
        if (around[i].end > farthest) {
          farthest = around[i].end;
          by = around[i].b;
        }
      if (farthest == level) return false;
      chosen.push_back(by);
      level = farthest;
    }
    if (dependence_ == Dependence::ancestors) {
      for (const std::uint32_t tree : chosen) users_[tree].push_back(root);
    } else {
      for (const std::uint32_t tree : chosen) {
        const std::uint32_t set = sets_.find(root);
        const std::uint32_t other = sets_.find(tree);
        if (set != other) sets_.join_under(set, other);
      }
    }
    return true;
  }

  const SeedGraph& graph_;
  Dependence dependence_;
  DisjointSets sets_;
  std::vector<std::vector<std::uint32_t>> users_;  ///< by tree: the removed roots that it helps to cover
  std::vector<std::uint32_t> asked_;               ///< by tree: the last root that it was found to depend on
};

}  // namespace

SeedCover cover_components(const SeedGraph& graph, const Progress& progress) {
  const auto sweep = [&](SweepDirection direction, SweepPick pick, double done) {
    return sweep_levels(graph, {.direction = direction,
                                .pick = pick,
                                .allowed = nullptr,
                                .elsewhere = {},
                                .progress = part_of(progress, done, done + 0.2)});
  };
  SeedCover cover;
  // A cover as small as the lower bound is minimum; often the first one is.
  auto up = sweep(SweepDirection::up, SweepPick::farthest, 0.0);
  cover.trees = std::move(up.picked);
  cover.bound = sweep(SweepDirection::down, SweepPick::all, 0.2).times;
  if (cover.trees.size() == cover.bound) return cover;
  cover.bound = std::max(cover.bound, sweep(SweepDirection::up, SweepPick::all, 0.4).times);
  if (cover.trees.size() == cover.bound) return cover;
  auto other = sweep(SweepDirection::down, SweepPick::farthest, 0.6).picked;
  const bool fewer = other.size() < cover.trees.size();
  if (fewer) cover.trees.swap(other);
  if (cover.trees.size() == cover.bound) return cover;
  cover.trees = spare(graph, std::move(cover.trees), fewer ? SweepDirection::down : SweepDirection::up,
                      part_of(progress, 0.8, 1.0));
  return cover;
}

std::uint64_t pack_components(const SeedGraph& graph, const Progress& progress) {
  std::uint64_t most = 0;
  double done = 0;
  for (const SweepDirection direction : {SweepDirection::up, SweepDirection::down}) {
    const auto part = part_of(progress, done, done + 0.5);
    most = std::max(
        most,
        sweep_levels(
            graph,
            {.direction = direction, .pick = SweepPick::all, .allowed = nullptr, .elsewhere = {}, .progress = part})
            .times);
    done += 0.5;
  }
  return most;
}

std::vector<std::uint32_t> whole2(const SeedGraph& graph, Dependence dependence, const Progress& progress) {
  return Whole2(graph, dependence).run(progress);
}

}  // namespace tegl::detail
