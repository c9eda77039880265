// SPDX-License-Identifier: BSD-3-Clause
//
// Which of the trees of seed_regions.hpp are seeds: sweeps over the levels of a few thousand trees at a time, as a
// sweep over all takes longer than its share for each of many, and hardly finds fewer.
#include <algorithm>

#include "level_sweep.hpp"
#include "progress.hpp"
#include "seed_links.hpp"
#include "seed_regions.hpp"

namespace tegl::detail {

namespace {

constexpr std::uint32_t kTreesOfPart = std::uint32_t{1} << 15;  ///< a sweep of so many stays near the processor
constexpr int kMostPasses = 6;

/// Spares trees part by part: all that are picked meet every component, and go on to do so when those of a part are
/// chosen anew such that each component of the part has one, or a link to one that is picked elsewhere.
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
      // Borders between parts lie elsewhere in every pass.
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
  /// Trees first ... end - 1.
  void choose(std::uint32_t first, std::uint32_t end, SweepDirection direction, const Progress& progress) {
    std::vector<KeyLink<Key>> links;      // of two trees of the part
    std::vector<KeyLink<Key>> elsewhere;  // a: of the part
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
    const std::vector<bool> allowed(picked_.begin() + first, picked_.begin() + end);
    const auto before = static_cast<std::size_t>(std::count(allowed.begin(), allowed.end(), true));
    const auto chosen = cover(first, end, links, elsewhere, allowed, direction, progress);
    if (chosen.size() >= before) return;
    std::fill(picked_.begin() + first, picked_.begin() + end, false);
    for (const std::uint32_t tree : chosen) picked_[first + tree] = true;
    count_ -= before - chosen.size();
  }
  [[nodiscard]] std::vector<std::uint32_t> cover(std::uint32_t first, std::uint32_t end,
                                                 const std::vector<KeyLink<Key>>& links,
                                                 const std::vector<KeyLink<Key>>& elsewhere,
                                                 const std::vector<bool>& allowed, SweepDirection direction,
                                                 const Progress& progress) const {
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
  std::vector<std::size_t> first_of_;  ///< of a tree's links in links_of_
  std::vector<std::size_t> links_of_;
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
