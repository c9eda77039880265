// SPDX-License-Identifier: BSD-3-Clause
//
// Selects the seeds among the trees of seed_regions.hpp: level sweeps over groups of 32 768 trees. One sweep over all
// trees takes longer per tree and finds hardly fewer seeds.
#include <algorithm>
#include <utility>

#include "base/progress.hpp"
#include "search/level_sweep.hpp"
#include "search/seed_links.hpp"
#include "search/seed_regions.hpp"

namespace tegl::detail {

namespace {

constexpr std::uint32_t kTreesOfPart = std::uint32_t{1} << 15;  ///< a sweep over this many fits in the cache
constexpr int kMostPasses = 6;
constexpr std::size_t kFewParts = 2;  ///< up to this many groups are always swept
/// A sweep pays off if it leaves fewer trees than `spare_one_by_one`, by at least one in this many.
constexpr std::size_t kWorthSweeping = 64;

/// Removes superfluous picks group by group. Invariant: the picked trees meet every component. It holds after a group
/// is selected again, because every component of the group then has a pick or a link to a tree picked in another group.
template <class Key>
class PartwiseCover {
 public:
  PartwiseCover(const RangeMap<Key>& map, const Regions<Key>& regions)
      : map_(map),
        regions_(regions),
        picked_(regions.roots.size(), true),
        count_(regions.roots.size()),
        first_of_(regions.roots.size() + 2) {
    for (const KeyLink<Key>& link : regions.links) {
      ++first_of_[link.a + 2];
      ++first_of_[link.b + 2];
    }
    for (std::size_t i = 2; i < first_of_.size(); ++i) first_of_[i] += first_of_[i - 1];
    links_of_.resize(first_of_.back());
    for (std::size_t i = 0; i < regions.links.size(); ++i) {
      links_of_[first_of_[regions.links[i].a + 1]++] = i;
      links_of_[first_of_[regions.links[i].b + 1]++] = i;
    }
  }

  std::vector<Place> run(const Progress& progress) {
    const auto trees = static_cast<std::uint32_t>(regions_.roots.size());
    SweepDirection direction = SweepDirection::up;
    for (int pass = 0; pass < kMostPasses; ++pass, direction = opposite(direction)) {
      const std::size_t before = count_;
      gain_ = {};
      // Shift the borders between groups in every pass.
      const std::uint32_t shift = kTreesOfPart * static_cast<std::uint32_t>(pass % 3) / 3;
      for (std::uint32_t first = 0; first < trees;) {
        const std::uint32_t end = std::min(trees, first == 0 ? kTreesOfPart - shift : first + kTreesOfPart);
        const auto done = [&](std::uint32_t tree) { return (pass + tree / static_cast<double>(trees)) / kMostPasses; };
        choose(first, end, direction, part_of(progress, done(first), done(end)));
        first = end;
      }
      if (count_ > before - before / 8) break;
    }
    std::vector<Place> picked;
    for (std::uint32_t tree = 0; tree < trees; ++tree)
      if (picked_[tree]) picked.push_back(regions_.roots[tree]);
    return picked;
  }

 private:
  /// Picks left in the groups that were swept, and the number left without the sweep.
  struct Gain {
    std::size_t swept = 0, spared = 0;
    [[nodiscard]] bool is_small() const noexcept { return spared - swept < spared / kWorthSweeping; }
  };

  /// Selects among the trees first ... end - 1 by two methods and keeps the smaller result. A sweep takes ten times as
  /// long as `spare_one_by_one`. In noise, where consecutive trees lie in different components, it finds hardly any
  /// more to remove.
  void choose(std::uint32_t first, std::uint32_t end, SweepDirection direction, const Progress& progress) {
    const std::vector<bool> allowed(picked_.begin() + first, picked_.begin() + end);
    std::size_t spared = count_of(first, end);
    if (regions_.roots.size() > kFewParts * kTreesOfPart) {
      spare_one_by_one(first, end);
      spared = count_of(first, end);
      if (gain_.spared > 0 && gain_.is_small()) {
        report_progress(progress, 1.0);
        return;
      }
    }
    const auto chosen = sweep(first, end, allowed, direction, progress);
    gain_.spared += spared;
    gain_.swept += std::min(spared, chosen.size());
    if (chosen.size() < spared) {
      std::fill(picked_.begin() + first, picked_.begin() + end, false);
      for (const std::uint32_t tree : chosen) picked_[first + tree] = true;
      count_ = count_ - spared + chosen.size();
    }
  }

  /// Removes every pick whose links to other picked trees cover its whole range, narrow ones first.
  void spare_one_by_one(std::uint32_t first, std::uint32_t end) {
    const auto width = [&](std::uint32_t tree) { return map_.width(regions_.roots[tree]); };
    std::vector<std::uint32_t> order;
    for (std::uint32_t tree = first; tree < end; ++tree)
      if (picked_[tree]) order.push_back(tree);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(width(a), a) < std::pair(width(b), b); });
    for (const std::uint32_t tree : order) {
      if (!is_spare(tree)) continue;
      picked_[tree] = false;
      --count_;
    }
  }
  [[nodiscard]] bool is_spare(std::uint32_t tree) {
    Key level = map_.least[regions_.roots[tree]];
    const Key greatest = map_.greatest[regions_.roots[tree]];
    spans_.clear();
    Key lowest = greatest, highest = level;
    for (std::size_t i = first_of_[tree]; i < first_of_[tree + 1]; ++i) {
      const KeyLink<Key>& link = regions_.links[links_of_[i]];
      if (!picked_[link.a == tree ? link.b : link.a]) continue;
      spans_.emplace_back(link.least, link.greatest);
      lowest = std::min(lowest, link.least);
      highest = std::max(highest, link.greatest);
    }
    if (lowest > level || highest < greatest) return false;  // the reason for most trees that stay
    std::sort(spans_.begin(), spans_.end());
    for (const auto& [least, end] : spans_) {
      if (least > level) return false;
      level = std::max(level, end);
      if (level >= greatest) return true;
    }
    return false;
  }
  [[nodiscard]] std::size_t count_of(std::uint32_t first, std::uint32_t end) const {
    return static_cast<std::size_t>(std::count(picked_.begin() + first, picked_.begin() + end, true));
  }

  /// The trees, counted from `first`, that a sweep over the levels of the group picks.
  [[nodiscard]] std::vector<std::uint32_t> sweep(std::uint32_t first, std::uint32_t end,
                                                 const std::vector<bool>& allowed, SweepDirection direction,
                                                 const Progress& progress) const {
    std::vector<KeyLink<Key>> links;      // between two trees of the group
    std::vector<KeyLink<Key>> elsewhere;  // a: tree of the group; b: picked tree of another group
    for (std::uint32_t tree = first; tree < end; ++tree)
      for (std::size_t i = first_of_[tree]; i < first_of_[tree + 1]; ++i) {
        const KeyLink<Key>& link = regions_.links[links_of_[i]];
        const std::uint32_t to = link.a == tree ? link.b : link.a;
        if (to < first || end <= to) {
          if (picked_[to]) elsewhere.push_back({tree - first, to, link.least, link.greatest});
        } else if (to > tree) {
          links.push_back({tree - first, to - first, link.least, link.greatest});
        }
      }
    SeedGraph part;
    part.roots.assign(regions_.roots.begin() + first, regions_.roots.begin() + end);
    const auto levels = put_in_levels(map_, links, elsewhere, part);
    std::vector<PickedElsewhere> picked;
    for (const KeyLink<Key>& link : elsewhere) picked.push_back({link.a, levels[link.least], levels[link.greatest]});
    return sweep_levels(part, {.direction = direction,
                               .pick = SweepPick::farthest,
                               .allowed = &allowed,
                               .elsewhere = picked,
                               .progress = progress})
        .picked;
  }

  const RangeMap<Key>& map_;
  const Regions<Key>& regions_;
  std::vector<bool> picked_;
  std::size_t count_;
  std::vector<std::size_t> first_of_;  ///< by tree: its first link in links_of_
  std::vector<std::size_t> links_of_;
  std::vector<std::pair<Key, Key>> spans_;
  Gain gain_;
};

}  // namespace

template <class Key>
std::vector<Place> cover_regions(const RangeMap<Key>& map, const Regions<Key>& regions, const Progress& progress) {
  return PartwiseCover<Key>(map, regions).run(progress);
}

template std::vector<Place> cover_regions(const RangeMap<std::uint8_t>&, const Regions<std::uint8_t>&, const Progress&);
template std::vector<Place> cover_regions(const RangeMap<std::uint16_t>&, const Regions<std::uint16_t>&,
                                          const Progress&);
template std::vector<Place> cover_regions(const RangeMap<std::uint32_t>&, const Regions<std::uint32_t>&,
                                          const Progress&);
template std::vector<Place> cover_regions(const RangeMap<std::uint64_t>&, const Regions<std::uint64_t>&,
                                          const Progress&);

}  // namespace tegl::detail
