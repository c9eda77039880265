// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles are processed in the order of descending width. A tile that earlier tiles cover is given up: the parts of its
// range pass to the trees that own the covering parts. No tile depends on a later one, so each part ends at a root.
// Based on: Bajaj, Pascucci, Schikore, Fast isocontouring for improved interactivity, 1996 (responsibility passes on),
// extended by parts and links.
#include "search/seed_regions.hpp"

#include <array>
#include <bit>
#include <limits>
#include <span>
#include <utility>

#include "base/progress.hpp"
#include "search/range_sample.hpp"
#include "search/seed_links.hpp"

namespace tegl::detail {

namespace {

constexpr std::size_t kEnoughTrees = std::size_t{1} << 15;  ///< a cover of this many is found directly
constexpr std::size_t kTreesAtOnce = std::size_t{1} << 14;
constexpr std::size_t kLinksAtOnce = std::size_t{1} << 18;  ///< between two progress reports
constexpr unsigned kMostRounds = 16;
constexpr unsigned kMostRoundsOfBlocks = 3;

/// Widths of ranges, measured as the number of range ends of a sample inside, so that the order does not depend on the
/// scale of the values.
template <class Key>
class Widths {
 public:
  static constexpr std::size_t kClasses = 22;

  explicit Widths(const RangeMap<Key>& map) {
    constexpr std::size_t kSample = std::size_t{1} << 19;
    const std::vector<Place> sample = sample_places(map, kSample);
    const auto for_tiles = [&](const auto& visit) {
      for (const Place tile : sample) visit(map.least[tile], map.greatest[tile]);
    };
    Key most = 0;
    least_ = std::numeric_limits<Key>::max();
    for_tiles([&](Key least, Key greatest) {
      least_ = std::min(least_, least);
      most = std::max(most, greatest);
    });
    if (most < least_) least_ = most;
    while ((static_cast<std::uint64_t>(most - least_) >> shift_) >= kBins) ++shift_;
    last_ = static_cast<std::uint64_t>(most - least_) >> shift_;
    below_.assign(last_ + 2, 0);
    for_tiles([&](Key least, Key greatest) {
      ++below_[bin(least) + 1];
      ++below_[bin(greatest) + 1];
    });
    for (std::size_t i = 1; i < below_.size(); ++i) below_[i] += below_[i - 1];
    scale(sample, map);
  }
  /// One class per power of 2, the widest first. Finer classes would leave more tiles.
  [[nodiscard]] std::size_t class_of(Key least, Key greatest) const noexcept {
    const auto bits = static_cast<std::size_t>(std::bit_width(width(least, greatest)));
    return kClasses - 1 - std::min(bits, kClasses - 1);
  }

 private:
  static constexpr std::uint64_t kBins = std::uint64_t{1} << 16;  // the table fits in the cache
  /// Fraction of all range ends whose width is scaled to 2^19, so that classes do not depend on the sample size. Tuned
  /// on many kinds of images between 0.5 and 0.92: these values leave the fewest seeds; the larger one is for noise.
  static constexpr double kWidest = 0.66, kWidestOfNoise = 0.84;
  [[nodiscard]] std::uint32_t width(Key least, Key greatest) const noexcept {
    return below_[bin(greatest)] - below_[bin(least)];
  }
  void scale(const std::vector<Place>& sample, const RangeMap<Key>& map) {
    const std::size_t ends = 2 * sample.size();
    const auto wide = static_cast<std::size_t>(std::count_if(sample.begin(), sample.end(), [&](Place tile) {
      return std::size_t{3} * width(map.least[tile], map.greatest[tile]) > ends;
    }));
    const double widest = 4 * wide > sample.size() ? kWidestOfNoise : kWidest;
    const auto all = static_cast<std::uint64_t>((std::uint64_t{1} << 19) / widest);
    for (std::uint32_t& below : below_)
      below = static_cast<std::uint32_t>(below * all / std::max<std::size_t>(1, ends));
  }
  [[nodiscard]] std::size_t bin(Key key) const noexcept {
    if (key <= least_) return 0;
    return std::min(static_cast<std::uint64_t>(key - least_) >> shift_, last_);
  }

  Key least_;
  unsigned shift_ = 0;
  std::uint64_t last_ = 0;            ///< bin
  std::vector<std::uint32_t> below_;  ///< number of range ends of the sample in lower bins; scaled
};

/// Owners of tiles or trees, by part of their ranges. Owners are trees that stay.
template <class Key>
class Ownership {
 public:
  explicit Ownership(std::size_t count) : parts_of_(count, kNone) {}

  [[nodiscard]] bool has(std::uint32_t i) const noexcept { return parts_of_[i] != kNone; }

  /// Offers i as a cover of the next tile between `least` and `greatest`; i has at least this range.
  void offer(std::uint32_t i, Key least, Key greatest) {
    lowest_ = std::min(lowest_, least);
    highest_ = std::max(highest_, greatest);
    offers_.push_back({least, greatest, parts_of_[i]});
  }
  /// If the offers cover i, i passes to their owners; otherwise i owns itself. Clears the offers. Returns whether i was
  /// given up.
  bool give_up(std::uint32_t i, Key least, Key greatest) {
    const std::uint64_t first = parts_.size();
    parts_of_[i] = first;
    // Most uncovered ranges are uncovered at an end.
    const bool covered = lowest_ <= least && greatest <= highest_ && divide(least, greatest, first);
    if (!covered) {
      parts_.resize(first);
      parts_.push_back({greatest, i});
    }
    forget_offers();
    return covered;
  }
  /// Sets one owner of the whole range of i: i itself if it is not given up.
  void set_one(std::uint32_t i, std::uint32_t owner, Key greatest) {
    parts_of_[i] = parts_.size();
    parts_.push_back({greatest, owner});
  }
  /// Gives i up to a single owner if one owner of `other`, whose range contains the range of i, has all of it; then
  /// clears the offers. Returns false otherwise.
  bool give_up_to_one(std::uint32_t i, std::uint32_t other, Key least, Key greatest) {
    const Part* part = &parts_[parts_of_[other]];
    while (part->end <= least) ++part;
    if (part->end < greatest) return false;
    set_one(i, std::uint32_t{part->owner}, greatest);
    forget_offers();
    return true;
  }
  /// Calls visit(owner, end) for the owners of i between `level` and `end`, in ascending order of levels.
  template <class Visit>
  void for_owners(std::uint32_t i, Key level, Key end, const Visit& visit) const {
    for (const Part* part = &parts_[parts_of_[i]]; level < end;) {
      while (part->end <= level) ++part;
      level = std::min(part->end, end);
      visit(part->owner, level);
    }
  }
  /// Adds links between the owners of a and b, by their new numbers, from `level` to `end`.
  template <class Number>
  void add_links(std::uint32_t a, std::uint32_t b, Key level, Key end, const Number& number,
                 LinkCollector<Key>& collector) const {
    const Part* of_a = &parts_[parts_of_[a]];
    const Part* of_b = &parts_[parts_of_[b]];
    while (level < end) {
      while (of_a->end <= level) ++of_a;
      while (of_b->end <= level) ++of_b;
      const Key both = std::min({of_a->end, of_b->end, end});
      if (of_a->owner != of_b->owner) {
        const std::uint32_t p = number(of_a->owner);
        const std::uint32_t q = number(of_b->owner);
        collector.add({std::min(p, q), std::max(p, q), level, both});
      }
      level = both;
    }
  }

  /// A position to which `back_to` truncates the parts; `set` may then give the tiles new parts.
  [[nodiscard]] std::uint64_t mark() const noexcept { return parts_.size(); }
  [[nodiscard]] bool since(std::uint64_t mark, std::uint32_t i) const noexcept { return parts_of_[i] >= mark; }
  void back_to(std::uint64_t mark) { parts_.resize(mark); }
  /// Sets the parts of i, as owner and end, in ascending order.
  void set(std::uint32_t i, std::span<const std::pair<std::uint32_t, Key>> parts) {
    parts_of_[i] = parts_.size();
    for (const auto& [owner, end] : parts) parts_.push_back({end, owner});
  }

 private:
  /// From the end of the part before (or the minimum of the range) up to `end`.
  struct Part {
    Key end;
    std::uint32_t owner;
  };
  struct Offer {
    Key least, greatest;
    std::uint64_t part;  ///< the first part that may still matter
  };
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  void forget_offers() noexcept {
    offers_.clear();
    lowest_ = std::numeric_limits<Key>::max();
    highest_ = 0;
  }
  /// Appends parts in ascending order, each as long as possible. Returns false at a gap.
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

  std::vector<std::uint64_t> parts_of_;  ///< first part of each tile; the last part ends with the range
  std::vector<Part> parts_;
  std::vector<Offer> offers_;
  Key lowest_ = std::numeric_limits<Key>::max();  ///< of the offers
  Key highest_ = 0;
};

/// Counting sort of numbers by class, stable. `for_each(visit)` calls visit(number, class) for all.
template <class ForEach>
std::vector<std::uint32_t> sort_by_class(std::size_t classes, const ForEach& for_each) {
  std::vector<std::size_t> next(classes + 1);
  for_each([&](std::uint32_t, std::size_t of_class) { ++next[of_class + 1]; });
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  std::vector<std::uint32_t> order(next.back());
  for_each([&](std::uint32_t number, std::size_t of_class) { order[next[of_class]++] = number; });
  return order;
}

/// One of eight pseudorandom subclasses, different in every round: it breaks ties between neighbours of equal width.
unsigned turn_of(std::uint32_t number, unsigned round) noexcept {
  std::uint32_t bits = (number + round * 0x632be5abu) * 0x9e3779b1u;
  bits = (bits ^ bits >> 15) * 0x85ebca6bu;
  return bits >> 29;
}

/// One round of coarsening: trees are given up to linked trees, and links are kept between the trees that stay.
template <class Key>
class Coarsening {
 public:
  /// Trees with numbers from `loose` on are fixed.
  Coarsening(const RangeMap<Key>& map, const Widths<Key>& widths, const Regions<Key>& fine, std::size_t loose,
             unsigned round, const Progress& progress)
      : owners_(fine.roots.size()), number_(fine.roots.size()) {
    for (std::size_t i = loose; i < fine.roots.size(); ++i)
      owners_.set_one(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i), map.greatest[fine.roots[i]]);
    give_up(map, widths, fine, loose, round, part_of(progress, 0.0, 0.6));
    for (std::uint32_t tree = 0; tree < fine.roots.size(); ++tree) {
      if (tree < loose && given_up_[tree] != 0) continue;
      number_[tree] = static_cast<std::uint32_t>(coarse_.roots.size());
      coarse_.roots.push_back(fine.roots[tree]);
      if (tree < loose) ++loose_;
    }
    LinkCollector<Key> collector(fine.links.size() / 2);
    const auto number = [&](std::uint32_t tree) { return number_[tree]; };
    for (std::size_t i = 0; i < fine.links.size(); ++i) {
      if (i % kLinksAtOnce == 0)
        report_progress(progress, 0.6 + 0.4 * static_cast<double>(i) / static_cast<double>(fine.links.size()));
      const KeyLink<Key>& link = fine.links[i];
      owners_.add_links(link.a, link.b, link.least, link.greatest, number, collector);
    }
    coarse_.links = collector.take();
  }
  [[nodiscard]] const Regions<Key>& coarse() const noexcept { return coarse_; }
  /// Number of trees that may still be given up; they come first.
  [[nodiscard]] std::size_t loose() const noexcept { return loose_; }
  Regions<Key> take() { return std::move(coarse_); }
  /// Calls visit(number, end) for the coarse trees that own a fine tree.
  template <class Visit>
  void for_owners(std::uint32_t tree, Key level, Key end, const Visit& visit) const {
    owners_.for_owners(tree, level, end, [&](std::uint32_t owner, Key to) { visit(number_[owner], to); });
  }

 private:
  /// A link, seen from one of its ends.
  struct Neighbour {
    std::uint32_t tree;
    Key least, greatest;
  };

  /// Neighbours of the trees before `loose`, grouped by tree, and the first neighbour of each tree.
  static std::pair<std::vector<Neighbour>, std::vector<std::size_t>> find_neighbours(const Regions<Key>& fine,
                                                                                     std::size_t loose) {
    std::vector<std::size_t> first_of(loose + 2);
    for (const KeyLink<Key>& link : fine.links) {
      if (link.a < loose) ++first_of[link.a + 2];
      if (link.b < loose) ++first_of[link.b + 2];
    }
    for (std::size_t i = 2; i < first_of.size(); ++i) first_of[i] += first_of[i - 1];
    std::vector<Neighbour> neighbours(first_of.back());
    for (const KeyLink<Key>& link : fine.links) {
      if (link.a < loose) neighbours[first_of[link.a + 1]++] = {link.b, link.least, link.greatest};
      if (link.b < loose) neighbours[first_of[link.b + 1]++] = {link.a, link.least, link.greatest};
    }
    return {std::move(neighbours), std::move(first_of)};
  }

  void give_up(const RangeMap<Key>& map, const Widths<Key>& widths, const Regions<Key>& fine, std::size_t loose,
               unsigned round, const Progress& progress) {
    const auto [neighbours, first_of] = find_neighbours(fine, loose);
    given_up_.resize(loose);
    std::vector<std::uint8_t> classes;
    for (std::size_t first = 0; first < loose; first += kTreesAtOnce) {
      const std::size_t end = std::min(loose, first + kTreesAtOnce);
      report_progress(progress, static_cast<double>(first) / static_cast<double>(loose));
      classes.clear();
      for (std::size_t i = first; i < end; ++i) {
        const Place root = fine.roots[i];
        const std::size_t of_width = widths.class_of(map.least[root], map.greatest[root]);
        classes.push_back(static_cast<std::uint8_t>(8 * of_width + turn_of(static_cast<std::uint32_t>(i), round)));
      }
      const auto order = sort_by_class(8 * Widths<Key>::kClasses, [&](const auto& visit) {
        for (std::size_t i = first; i < end; ++i) visit(static_cast<std::uint32_t>(i), classes[i - first]);
      });
      for (const std::uint32_t tree : order) {
        for (std::size_t i = first_of[tree]; i < first_of[tree + 1]; ++i) {
          const Neighbour& other = neighbours[i];
          if (owners_.has(other.tree)) owners_.offer(other.tree, other.least, other.greatest);
        }
        const Place root = fine.roots[tree];
        given_up_[tree] = owners_.give_up(tree, map.least[root], map.greatest[root]) ? 1 : 0;
      }
    }
  }

  Ownership<Key> owners_;
  std::vector<std::uint32_t> number_;  ///< by fine tree that stays: its coarse number
  std::vector<std::uint8_t> given_up_;
  std::size_t loose_ = 0;
  Regions<Key> coarse_;
};

/// Builds trees from tiles in blocks that fit in the cache. The tiles of a block are given up to one another and to
/// trees of earlier blocks, and its trees are coarsened at once. Afterwards only tiles at the border of the block are
/// read again, by adjacent blocks.
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
        number_(map.tiles.room()) {
    for (const std::ptrdiff_t distance : neighbours_)
      if (distance > 0) ahead_.push_back(distance);
  }

  Regions<Key> make() {
    for_blocks([&](const Block& block) { add(block); });
    for (std::uint32_t tree = 0; tree < regions_.roots.size(); ++tree) number_[regions_.roots[tree]] = tree;
    for (KeyLink<Key>& link : regions_.links) {
      const std::uint32_t a = number_[link.a];
      const std::uint32_t b = number_[link.b];
      link.a = std::min(a, b);
      link.b = std::max(a, b);
    }
    return std::move(regions_);
  }

 private:
  /// Its tiles that are not constant, and which of them have neighbours in other blocks.
  struct Block {
    std::vector<Place> tiles;
    std::vector<std::uint32_t> border;  ///< indexes into `tiles`
  };
  static constexpr std::uint32_t kNoNumber = 0;         ///< other numbers are 1 + the number in the block
  static constexpr std::uint32_t kKept = 1, kGone = 2;  ///< state of the block's tiles before trees are numbered

  template <class Visit>
  void for_blocks(const Visit& visit) const {
    constexpr std::array<std::size_t, kMostAxes + 1> kWidth = {1, 4096, 64, 16, 8, 6};
    const int dim = map_.tiles.dim();
    const std::size_t width = kWidth[static_cast<std::size_t>(dim)];
    std::array<std::size_t, kMostAxes> first{};
    Block block;
    std::size_t done = 0;
    for (int axis = 0; axis < dim && map_.tiles.rows() > 0;) {
      report_progress(progress_, static_cast<double>(done) / static_cast<double>(map_.tiles.room()));
      block.tiles.clear();
      block.border.clear();
      add_tiles(dim - 1, static_cast<std::ptrdiff_t>(map_.tiles.row_place(0)), first, width, false, block);
      visit(block);
      done += block.tiles.size();
      for (axis = 0; axis < dim; ++axis) {
        first[axis] += width;
        if (first[axis] < map_.tiles.size(axis)) break;
        first[axis] = 0;
      }
    }
  }
  void add_tiles(int axis, std::ptrdiff_t at, const std::array<std::size_t, kMostAxes>& first, std::size_t width,
                 bool outside, Block& block) const {
    const std::size_t end = std::min(first[axis] + width, map_.tiles.size(axis));
    for (std::size_t i = first[axis]; i < end; ++i) {
      const std::ptrdiff_t place = at + static_cast<std::ptrdiff_t>(i) * map_.tiles.step(axis);
      const bool at_border = outside || (i == first[axis] && i > 0) || (i + 1 == end && end < map_.tiles.size(axis));
      if (axis > 0) {
        add_tiles(axis - 1, place, first, width, at_border, block);
      } else if (!map_.constant(static_cast<Place>(place))) {
        if (at_border) block.border.push_back(static_cast<std::uint32_t>(block.tiles.size()));
        block.tiles.push_back(static_cast<Place>(place));
      }
    }
  }

  void add(const Block& block) {
    const std::uint64_t mark = owners_.mark();
    Regions<Key> trees;  // trees of the block first
    give_up_tiles(block, trees);
    std::size_t loose = trees.roots.size();
    link(block, mark, trees);
    const std::vector<Place> numbered = trees.roots;
    std::vector<Coarsening<Key>> rounds;
    rounds.reserve(kMostRoundsOfBlocks);
    for (unsigned round = 0; round < kMostRoundsOfBlocks && loose > 0; ++round) {
      const Regions<Key>& fine = rounds.empty() ? trees : rounds.back().coarse();
      const std::size_t before = loose;
      rounds.emplace_back(map_, widths_, fine, loose, round, Progress());
      loose = rounds.back().loose();
      if (loose > before - before / 8) break;
    }
    const Regions<Key>& last = rounds.empty() ? trees : rounds.back().coarse();
    regions_.roots.insert(regions_.roots.end(), last.roots.begin(),
                          last.roots.begin() + static_cast<std::ptrdiff_t>(loose));
    for (const KeyLink<Key>& link : last.links)
      regions_.links.push_back({last.roots[link.a], last.roots[link.b], link.least, link.greatest});
    keep_border(block, mark, rounds, last.roots);
    for (const Place root : numbered) number_[root] = kNoNumber;
  }

  void give_up_tiles(const Block& block, Regions<Key>& trees) {
    // Within a class, even places come first: in a row of tiles with slowly increasing values, each odd tile then lies
    // between two processed ones.
    classes_.clear();
    for (const Place tile : block.tiles)
      classes_.push_back(
          static_cast<std::uint8_t>(2 * widths_.class_of(map_.least[tile], map_.greatest[tile]) + tile % 2));
    const auto order = sort_by_class(2 * Widths<Key>::kClasses, [&](const auto& visit) {
      for (std::size_t i = 0; i < block.tiles.size(); ++i) visit(block.tiles[i], classes_[i]);
    });
    for (const Place tile : order)
      if (!is_given_up(tile)) number_[tile] = kKept;
    give_up_again(order);
    for (const Place tile : block.tiles) {
      if (number_[tile] != kKept) {
        number_[tile] = kNoNumber;
        continue;
      }
      trees.roots.push_back(tile);
      number_[tile] = static_cast<std::uint32_t>(trees.roots.size());
    }
  }
  /// Calls visit(root, end) for the current owners of a tile in ascending order, resolving owners that were given up
  /// since.
  template <class Visit>
  void for_roots(Place tile, Key level, Key end, const Visit& visit) const {
    owners_.for_owners(tile, level, end, [&](Place owner, Key to) {
      if (number_[owner] == kGone)
        for_roots(owner, level, to, visit);
      else
        visit(owner, to);
      level = to;
    });
  }
  /// Second pass, narrow tiles first: gives up kept tiles that tiles processed later now cover together.
  void give_up_again(const std::vector<Place>& order) {
    bool any = false;
    for (auto tile = order.rbegin(); tile != order.rend(); ++tile) {
      if (number_[*tile] != kKept || !is_covered_by_others(*tile)) continue;
      owners_.set(*tile, parts_);
      number_[*tile] = kGone;
      any = true;
    }
    if (!any) return;
    for (const Place tile : order) {
      bool stays = true;
      owners_.for_owners(tile, map_.least[tile], map_.greatest[tile],
                         [&](Place owner, Key) { stays = stays && number_[owner] != kGone; });
      if (stays) continue;
      parts_.clear();
      for_roots(tile, map_.least[tile], map_.greatest[tile], [&](Place root, Key end) {
        if (!parts_.empty() && parts_.back().first == root)
          parts_.back().second = end;
        else
          parts_.emplace_back(root, end);
      });
      owners_.set(tile, parts_);
    }
  }
  /// Whether other trees cover the tile; `parts_` are then their parts.
  bool is_covered_by_others(Place tile) {
    const Key least = map_.least[tile];
    const Key greatest = map_.greatest[tile];
    // collect the parts that other roots offer
    offered_.clear();
    Key lowest = greatest, highest = least;
    for (const std::ptrdiff_t distance : neighbours_) {
      const auto other = static_cast<Place>(tile + distance);
      if (!owners_.has(other) || !map_.overlap(tile, other)) continue;
      Key from = std::max(least, map_.least[other]);
      for_roots(other, from, std::min(greatest, map_.greatest[other]), [&](Place root, Key to) {
        if (root != tile) {
          offered_.push_back({root, 0, from, to});
          lowest = std::min(lowest, from);
          highest = std::max(highest, to);
        }
        from = to;
      });
    }
    if (lowest > least || highest < greatest) return false;
    // greedy interval cover
    parts_.clear();
    for (Key level = least; level < greatest;) {
      Key farthest = level;
      Place by = tile;
      for (const KeyLink<Key>& offer : offered_)
        if (offer.least <= level && offer.greatest > farthest) {
          farthest = offer.greatest;
          by = offer.a;
        }
      if (by == tile) return false;
      parts_.emplace_back(by, farthest);
      level = farthest;
    }
    return true;
  }
  bool is_given_up(Place tile) {
    const Key least = map_.least[tile];
    const Key greatest = map_.greatest[tile];
    for (const std::ptrdiff_t distance : neighbours_) {
      const auto other = static_cast<Place>(tile + distance);
      if (!owners_.has(other) || !map_.overlap(tile, other)) continue;
      // A tile that contains the range with room at both ends is as good as any. In noise most tiles lie in one.
      if (map_.least[other] < least && greatest < map_.greatest[other] &&
          owners_.give_up_to_one(tile, other, least, greatest))
        return true;
      owners_.offer(other, map_.least[other], map_.greatest[other]);
    }
    return owners_.give_up(tile, least, greatest);
  }

  /// Collects the links among the tiles of the block and to earlier blocks, and numbers the trees of the latter.
  void link(const Block& block, std::uint64_t mark, Regions<Key>& trees) {
    LinkCollector<Key> collector(block.tiles.size() / 2);
    const auto number = [&](Place root) {
      if (number_[root] == kNoNumber) {
        trees.roots.push_back(root);
        number_[root] = static_cast<std::uint32_t>(trees.roots.size());
      }
      return number_[root] - 1;
    };
    for (const std::uint32_t i : block.border) {
      const Place tile = block.tiles[i];
      owners_.for_owners(tile, map_.least[tile], map_.greatest[tile], [&](Place root, Key) { number(root); });
    }
    const auto add_links = [&](Place tile, Place other) {
      if (map_.overlap(tile, other))
        owners_.add_links(tile, other, std::max(map_.least[tile], map_.least[other]),
                          std::min(map_.greatest[tile], map_.greatest[other]), number, collector);
    };
    for (const Place tile : block.tiles)
      for (const std::ptrdiff_t distance : ahead_)
        if (const auto other = static_cast<Place>(tile + distance); owners_.has(other)) add_links(tile, other);
    for (const std::uint32_t i : block.border)
      for (const std::ptrdiff_t distance : ahead_) {
        const auto other = static_cast<Place>(block.tiles[i] - distance);
        if (owners_.has(other) && !owners_.since(mark, other)) add_links(block.tiles[i], other);
      }
    trees.links = collector.take();
  }

  /// Fixes the owners of the border tiles. The owners of interior tiles are discarded: no later block reads them.
  void keep_border(const Block& block, std::uint64_t mark, const std::vector<Coarsening<Key>>& rounds,
                   const std::vector<Place>& roots) {
    using Parts = std::vector<std::pair<std::uint32_t, Key>>;
    std::vector<std::size_t> end_of;
    Parts kept, parts, finer;
    // find the owners after all rounds of coarsening
    for (const std::uint32_t i : block.border) {
      const Place tile = block.tiles[i];
      const Key least = map_.least[tile];
      const auto add = [&](std::uint32_t owner, Key end) {
        if (!parts.empty() && parts.back().first == owner)
          parts.back().second = end;
        else
          parts.emplace_back(owner, end);
      };
      parts.clear();
      owners_.for_owners(tile, least, map_.greatest[tile],
                         [&](std::uint32_t root, Key end) { add(number_[root] - 1, end); });
      for (const Coarsening<Key>& round : rounds) {
        std::swap(parts, finer);
        parts.clear();
        Key from = least;
        for (const auto& [tree, end] : finer) {
          round.for_owners(tree, from, end, add);
          from = end;
        }
      }
      for (const auto& [tree, end] : parts) kept.emplace_back(roots[tree], end);
      end_of.push_back(kept.size());
    }
    // replace the parts of the block by those of the border
    owners_.back_to(mark);
    std::size_t from = 0;
    for (std::size_t i = 0; i < block.border.size(); ++i) {
      owners_.set(block.tiles[block.border[i]], std::span(kept).subspan(from, end_of[i] - from));
      from = end_of[i];
    }
  }

  const RangeMap<Key>& map_;
  const Widths<Key>& widths_;
  const Progress& progress_;
  std::vector<std::ptrdiff_t> neighbours_;
  std::vector<std::ptrdiff_t> ahead_;  ///< one of each pair of opposite neighbours
  Ownership<Key> owners_;
  std::vector<std::uint32_t> number_;  ///< by root: number of its tree in the current block
  std::vector<std::uint8_t> classes_;
  std::vector<KeyLink<Key>> offered_;  ///< a: the offering root
  std::vector<std::pair<Place, Key>> parts_;
  Regions<Key> regions_;
};

}  // namespace

template <class Key>
Regions<Key> make_regions(const RangeMap<Key>& map, Neighbourhood neighbourhood, const Progress& progress) {
  const Widths<Key> widths(map);
  report_progress(progress, 0.1);
  const Progress of_tiles = part_of(progress, 0.1, 0.7);
  Regions<Key> regions = RegionMaker<Key>(map, widths, neighbourhood, of_tiles).make();
  double done = 0.7;
  for (unsigned round = 0; round < kMostRounds && regions.roots.size() > kEnoughTrees; ++round) {
    const std::size_t before = regions.roots.size();
    const double end = done + (1.0 - done) / 2;  // each round takes less time than the one before
    regions = Coarsening<Key>(map, widths, regions, before, round, part_of(progress, done, end)).take();
    done = end;
    if (regions.roots.size() > before - before / 32) break;
  }
  report_progress(progress, 1.0);
  return regions;
}

template Regions<std::uint8_t> make_regions(const RangeMap<std::uint8_t>&, Neighbourhood, const Progress&);
template Regions<std::uint16_t> make_regions(const RangeMap<std::uint16_t>&, Neighbourhood, const Progress&);
template Regions<std::uint32_t> make_regions(const RangeMap<std::uint32_t>&, Neighbourhood, const Progress&);
template Regions<std::uint64_t> make_regions(const RangeMap<std::uint64_t>&, Neighbourhood, const Progress&);

}  // namespace tegl::detail
