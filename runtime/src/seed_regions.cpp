// SPDX-License-Identifier: BSD-3-Clause
//
// Wide tiles come first: a tile that those before it cover is given up, part by part, to the trees that these belong
// to. None depends on one that comes later, and so each part ends at a root. Based on: Bajaj, Pascucci, Schikore, Fast
// isocontouring for improved interactivity, 1996 (responsibility handed on), with parts and links kept.
#include "seed_regions.hpp"

#include <array>
#include <bit>
#include <limits>
#include <numeric>

#include "progress.hpp"
#include "seed_links.hpp"

namespace tegl::detail {

namespace {

constexpr std::size_t kEnoughTrees = std::size_t{1} << 13;  ///< a cover of so many is found at once
constexpr std::size_t kTreesAtOnce = std::size_t{1} << 14;
constexpr unsigned kMostRounds = 16;

/// How wide ranges are, counted in ends of ranges: so the order does not depend on the scale of the values.
template <class Key>
class Widths {
 public:
  static constexpr std::size_t kClasses = 34;

  explicit Widths(const RangeMap<Key>& map) {
    Key most = 0;
    least_ = std::numeric_limits<Key>::max();
    const auto for_tiles = [&](const auto& visit) {
      map.tiles.scan(default_order(map.tiles.dim()), [&](Place tile) {
        if (!map.constant(tile)) visit(tile);
      });
    };
    for_tiles([&](Place tile) {
      least_ = std::min(least_, map.least[tile]);
      most = std::max(most, map.greatest[tile]);
    });
    if (most < least_) least_ = most;
    while ((static_cast<std::uint64_t>(most - least_) >> shift_) >= kBins) ++shift_;
    below_.assign((static_cast<std::uint64_t>(most - least_) >> shift_) + 2, 0);
    for_tiles([&](Place tile) {
      ++below_[bin(map.least[tile]) + 1];
      ++below_[bin(map.greatest[tile]) + 1];
    });
    for (std::size_t i = 1; i < below_.size(); ++i) below_[i] += below_[i - 1];
  }
  /// A power of 2 each, the widest first: finer ones would leave more tiles.
  [[nodiscard]] std::size_t class_of(Key least, Key greatest) const noexcept {
    const std::uint64_t width = below_[bin(greatest)] - below_[bin(least)];
    const auto bits = static_cast<std::size_t>(std::bit_width(width));
    return kClasses - 1 - std::min(bits, kClasses - 1);
  }

 private:
  static constexpr std::uint64_t kBins = std::uint64_t{1} << 20;
  [[nodiscard]] std::size_t bin(Key key) const noexcept { return static_cast<std::uint64_t>(key - least_) >> shift_; }

  Key least_;
  unsigned shift_ = 0;
  std::vector<std::uint64_t> below_;  ///< ends of ranges in bins before
};

/// Whom tiles, or trees, belong to, from part to part of their ranges: to trees that are kept.
template <class Key>
class Ownership {
 public:
  explicit Ownership(std::size_t count) : parts_of_(count, kNone) {}

  [[nodiscard]] bool has(std::uint32_t i) const noexcept { return parts_of_[i] != kNone; }

  /// What is asked next may be covered by i from `least` to `greatest`, in which it has that range at least.
  void offer(std::uint32_t i, Key least, Key greatest) { offers_.push_back({least, greatest, parts_of_[i]}); }
  /// Whether the offers cover i: then it belongs to whom these belong to; otherwise to itself. Forgets the offers.
  bool give_up(std::uint32_t i, Key least, Key greatest) {
    const std::uint64_t first = parts_.size();
    parts_of_[i] = first;
    const bool covered = divide(least, greatest, first);
    if (!covered) {
      parts_.resize(first);
      parts_.push_back({greatest, i});
    }
    offers_.clear();
    return covered;
  }
  /// Links between those whom a and b belong to, by their new numbers, from `level` to `end`.
  void add_links(std::uint32_t a, std::uint32_t b, Key level, Key end, const std::vector<std::uint32_t>& number,
                 LinkCollector<Key>& collector) const {
    const Part* of_a = &parts_[parts_of_[a]];
    const Part* of_b = &parts_[parts_of_[b]];
    while (level < end) {
      while (of_a->end <= level) ++of_a;
      while (of_b->end <= level) ++of_b;
      const Key both = std::min({of_a->end, of_b->end, end});
      if (of_a->owner != of_b->owner) {
        const std::uint32_t p = number[of_a->owner];
        const std::uint32_t q = number[of_b->owner];
        collector.add({std::min(p, q), std::max(p, q), level, both});
      }
      level = both;
    }
  }

 private:
  /// Up to `end`, from the part before (or the least value) on.
  struct Part {
    Key end;
    std::uint32_t owner;
  };
  struct Offer {
    Key least, greatest;
    std::uint64_t part;  ///< the first that may matter
  };
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  /// Appends parts, from below, each as long as there is one; false where there is none.
  bool divide(Key level, Key end, std::uint64_t first) {
    while (level < end) {
      Part best{level, 0};
      for (Offer& offer : offers_) {
        if (offer.least > level || offer.greatest <= level) continue;
        while (parts_[offer.part].end <= level) ++offer.part;
        const Key to = std::min(parts_[offer.part].end, offer.greatest);
        if (to > best.end) best = {to, parts_[offer.part].owner};
      }
      if (best.end == level) return false;
      level = best.end;
      best.end = std::min(best.end, end);
      if (parts_.size() > first && parts_.back().owner == best.owner)
        parts_.back().end = best.end;
      else
        parts_.push_back(best);
    }
    return true;
  }

  std::vector<std::uint64_t> parts_of_;  ///< where they start; the last one ends with the range
  std::vector<Part> parts_;
  std::vector<Offer> offers_;
};

/// Trees, in the order of their numbers, and links between them, which may overlap.
template <class Key>
struct Regions {
  std::vector<Place> roots;
  std::vector<KeyLink<Key>> links;
};

/// Numbers in the order of their classes, those of a class in the order in which they come: a counting sort.
/// `for_each(visit)` calls visit(number, class) for all.
template <class ForEach>
std::vector<std::uint32_t> sort_by_class(std::size_t classes, const ForEach& for_each) {
  std::vector<std::size_t> next(classes + 1);
  for_each([&](std::uint32_t, std::size_t of_class) { ++next[of_class + 1]; });
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  std::vector<std::uint32_t> order(next.back());
  for_each([&](std::uint32_t number, std::size_t of_class) { order[next[of_class]++] = number; });
  return order;
}

/// Two halves of all numbers, another two for every round.
unsigned half_of(std::uint32_t number, unsigned round) noexcept {
  std::uint32_t bits = (number + round * 0x632be5abu) * 0x9e3779b1u;
  bits = (bits ^ bits >> 15) * 0x85ebca6bu;
  return bits >> 29;
}

/// From tiles to trees.
template <class Key>
class RegionMaker {
 public:
  RegionMaker(const RangeMap<Key>& map, const Widths<Key>& widths, Neighbourhood neighbourhood,
              const Progress& progress)
      : map_(map),
        widths_(widths),
        progress_(progress),
        neighbours_(map.tiles.neighbours(neighbourhood)),
        owners_(map.tiles.room()),
        number_(map.tiles.room()) {}

  Regions<Key> make() {
    for_blocks(0.0, 0.4, [&](const std::vector<Place>& block) {
      // Every other tile comes first: of tiles in a row, each of which has a little more than the one before, the
      // others then lie between two that are done.
      const auto order = sort_by_class(2 * Widths<Key>::kClasses, [&](const auto& visit) {
        for (const Place tile : block)
          visit(tile, 2 * widths_.class_of(map_.least[tile], map_.greatest[tile]) + tile % 2);
      });
      for (const Place tile : order) number_[tile] = is_given_up(tile) ? 0 : 1;
      for (const Place tile : block) {
        if (number_[tile] == 0) continue;
        number_[tile] = static_cast<std::uint32_t>(regions_.roots.size());
        regions_.roots.push_back(tile);
      }
    });
    collect_links();
    return std::move(regions_);
  }

 private:
  /// All tiles that are ever active, in blocks that are small enough to stay near the processor.
  template <class Visit>
  void for_blocks(double from, double to, const Visit& visit) const {
    constexpr std::array<std::size_t, kMostAxes + 1> kWidth = {1, 1 << 15, 181, 32, 13, 8};
    const int dim = map_.tiles.dim();
    const std::size_t width = kWidth[static_cast<std::size_t>(dim)];
    std::array<std::size_t, kMostAxes> first{};
    std::vector<Place> block;
    std::size_t done = 0;
    for (int axis = 0; axis < dim && map_.tiles.rows() > 0;) {
      report_progress(progress_,
                      from + (to - from) * static_cast<double>(done) / static_cast<double>(map_.tiles.room()));
      block.clear();
      add_tiles(dim - 1, static_cast<std::ptrdiff_t>(map_.tiles.row_place(0)), first, width, block);
      visit(block);
      done += block.size();
      for (axis = 0; axis < dim; ++axis) {
        first[axis] += width;
        if (first[axis] < map_.tiles.size(axis)) break;
        first[axis] = 0;
      }
    }
  }
  void add_tiles(int axis, std::ptrdiff_t at, const std::array<std::size_t, kMostAxes>& first, std::size_t width,
                 std::vector<Place>& block) const {
    const std::size_t end = std::min(first[axis] + width, map_.tiles.size(axis));
    for (std::size_t i = first[axis]; i < end; ++i) {
      const std::ptrdiff_t place = at + static_cast<std::ptrdiff_t>(i) * map_.tiles.step(axis);
      if (axis > 0)
        add_tiles(axis - 1, place, first, width, block);
      else if (!map_.constant(static_cast<Place>(place)))
        block.push_back(static_cast<Place>(place));
    }
  }

  bool is_given_up(Place tile) {
    for (const std::ptrdiff_t distance : neighbours_) {
      const auto other = static_cast<Place>(tile + distance);
      if (owners_.has(other) && map_.overlap(tile, other))
        owners_.offer(other, map_.least[other], map_.greatest[other]);
    }
    return owners_.give_up(tile, map_.least[tile], map_.greatest[tile]);
  }

  void collect_links() {
    LinkCollector<Key> collector;
    std::vector<std::ptrdiff_t> ahead;
    for (const std::ptrdiff_t distance : neighbours_)
      if (distance > 0) ahead.push_back(distance);
    for_blocks(0.4, 1.0, [&](const std::vector<Place>& block) {
      for (const Place tile : block)
        for (const std::ptrdiff_t distance : ahead) {
          const auto other = static_cast<Place>(tile + distance);
          if (map_.overlap(tile, other))
            owners_.add_links(tile, other, std::max(map_.least[tile], map_.least[other]),
                              std::min(map_.greatest[tile], map_.greatest[other]), number_, collector);
        }
    });
    regions_.links = collector.take();
  }

  const RangeMap<Key>& map_;
  const Widths<Key>& widths_;
  const Progress& progress_;
  std::vector<std::ptrdiff_t> neighbours_;
  Ownership<Key> owners_;
  std::vector<std::uint32_t> number_;  ///< of a root's tree
  Regions<Key> regions_;
};

/// The same with trees instead of tiles, and links instead of neighbours.
template <class Key>
Regions<Key> coarsen(const RangeMap<Key>& map, const Widths<Key>& widths, const Regions<Key>& fine, unsigned round) {
  const std::size_t count = fine.roots.size();
  const auto both_ends = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < fine.links.size(); ++i) {
      visit(i, fine.links[i].a);
      visit(i, fine.links[i].b);
    }
  };
  const std::vector<std::uint32_t> links_of = sort_by_class(count, both_ends);
  std::vector<std::size_t> first_of(count + 1);
  both_ends([&](std::uint32_t, std::uint32_t tree) { ++first_of[tree + 1]; });
  for (std::size_t i = 0; i < count; ++i) first_of[i + 1] += first_of[i];
  Ownership<Key> owners(count);
  std::vector<std::uint32_t> number(count);
  for (std::size_t first = 0; first < count; first += kTreesAtOnce) {
    const auto order = sort_by_class(8 * Widths<Key>::kClasses, [&](const auto& visit) {
      for (std::size_t i = first; i < std::min(count, first + kTreesAtOnce); ++i) {
        const Place root = fine.roots[i];
        const auto tree = static_cast<std::uint32_t>(i);
        visit(tree, 8 * widths.class_of(map.least[root], map.greatest[root]) + half_of(tree, round));
      }
    });
    for (const std::uint32_t tree : order) {
      for (std::size_t i = first_of[tree]; i < first_of[tree + 1]; ++i) {
        const KeyLink<Key>& link = fine.links[links_of[i]];
        const std::uint32_t other = link.a == tree ? link.b : link.a;
        if (owners.has(other)) owners.offer(other, link.least, link.greatest);
      }
      const Place root = fine.roots[tree];
      number[tree] = owners.give_up(tree, map.least[root], map.greatest[root]) ? 0 : 1;
    }
  }
  Regions<Key> coarse;
  for (std::uint32_t tree = 0; tree < count; ++tree) {
    if (number[tree] == 0) continue;
    number[tree] = static_cast<std::uint32_t>(coarse.roots.size());
    coarse.roots.push_back(fine.roots[tree]);
  }
  LinkCollector<Key> collector;
  for (const KeyLink<Key>& link : fine.links)
    owners.add_links(link.a, link.b, link.least, link.greatest, number, collector);
  coarse.links = collector.take();
  return coarse;
}

}  // namespace

template <class Key>
SeedGraph make_region_graph(const RangeMap<Key>& map, Neighbourhood neighbourhood, std::size_t most_links,
                            const Progress& progress) {
  const Widths<Key> widths(map);
  report_progress(progress, 0.1);
  const Progress of_tiles = part_of(progress, 0.1, 0.7);
  Regions<Key> regions = RegionMaker<Key>(map, widths, neighbourhood, of_tiles).make();
  for (unsigned round = 0; round < kMostRounds && regions.roots.size() > kEnoughTrees; ++round) {
    report_progress(progress, 0.7 + 0.2 * round / kMostRounds);
    const std::size_t before = regions.roots.size();
    regions = coarsen(map, widths, regions, round);
    if (regions.roots.size() > before - before / 32) break;
  }
  report_progress(progress, 0.9);
  SeedGraph graph;
  graph.roots = std::move(regions.roots);
  if (regions.links.size() <= most_links) put_in_levels(map, regions.links, graph);
  return graph;
}

template SeedGraph make_region_graph(const RangeMap<std::uint8_t>&, Neighbourhood, std::size_t, const Progress&);
template SeedGraph make_region_graph(const RangeMap<std::uint16_t>&, Neighbourhood, std::size_t, const Progress&);
template SeedGraph make_region_graph(const RangeMap<std::uint32_t>&, Neighbourhood, std::size_t, const Progress&);
template SeedGraph make_region_graph(const RangeMap<std::uint64_t>&, Neighbourhood, std::size_t, const Progress&);

}  // namespace tegl::detail
