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
#include <optional>
#include <span>
#include <utility>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "levels/block_components.hpp"
#include "search/range_sample.hpp"
#include "search/seed_links.hpp"
#include "search/seed_ownership.hpp"
#include "search/tile_blocks.hpp"
#include "search/wanted_links.hpp"

namespace tegl::detail {

namespace {

constexpr std::size_t kEnoughTrees = std::size_t{1} << 15;  ///< a cover of this many is found directly
constexpr std::size_t kTreesAtOnce = std::size_t{1} << 14;
constexpr std::size_t kLinksAtOnce = std::size_t{1} << 18;  ///< between two progress reports
constexpr unsigned kMostRounds = 16;
constexpr unsigned kMostRoundsOfBlocks = 3;
constexpr unsigned kMostRoundsOfComponents = 1;  ///< their roots are few; more rounds would leave more seeds

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
  /// Whether many tiles have wide ranges.
  [[nodiscard]] bool are_of_noise() const noexcept { return are_of_noise_; }
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
    are_of_noise_ = 4 * wide > sample.size();
    const double widest = are_of_noise_ ? kWidestOfNoise : kWidest;
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
  bool are_of_noise_ = false;
  std::uint64_t last_ = 0;            ///< bin
  std::vector<std::uint32_t> below_;  ///< number of range ends of the sample in lower bins; scaled
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

/// Result of a block: its trees, links by roots, and the owners of its border tiles.
template <class Key>
struct FinishedBlock {
  std::vector<Place> roots;
  std::vector<KeyLink<Key>> links;            ///< a, b: roots
  std::vector<std::pair<Place, Key>> owners;  ///< of its tiles beside later blocks, one after the other: root, end
};

/// Builds the trees of one block at a time. The tiles of a block are given up to one another and to trees of earlier
/// blocks, and its trees are coarsened at once. Works on copies of the ranges, which are close together in memory.
template <class Key>
class BlockTrees {
 public:
  /// `first_owner`: by place of a border tile, the position of its first owner in its block.
  BlockTrees(const RangeMap<Key>& map, const Widths<Key>& widths, const BlockGrid& grid,
             const std::vector<FinishedBlock<Key>>& finished, std::vector<std::uint32_t>& first_owner)
      : map_(map),
        widths_(widths),
        grid_(grid),
        finished_(finished),
        first_owner_(first_owner),
        neighbours_(grid.neighbours()),
        near_(neighbours_.size()),
        least_(grid.room() + kReadBeyond),
        greatest_(grid.room() + kReadBeyond),
        is_earlier_(grid.room()),
        owners_(grid.room()),
        outside_(grid.room()),
        wanted_(grid.ahead().size()),
        low_(grid.ahead().size() * kMostOfRow),
        high_(low_.size()) {
    // In noise most tiles divide or join components, and giving tiles up leaves fewer seeds.
    if (grid.dim() <= 3 && !widths.are_of_noise())
      components_.emplace(grid.room(), grid.steps(), grid.neighbourhood(), grid.neighbours());
    for (const BlockGrid::Earlier& earlier : grid.earlier()) is_earlier_[earlier.tile] = true;
  }

  FinishedBlock<Key> make(std::size_t number) {
    load(number);
    FinishedBlock<Key> result;
    Regions<Key> trees;  // trees of the block first
    LinkCollector<Key> collector(tiles_.size() / 2);
    const bool by_components = take_components(trees, collector);
    if (!by_components) give_up_tiles(trees);
    std::size_t loose = trees.roots.size();
    link(trees, !by_components, collector);
    std::vector<Coarsening<Key>> rounds;
    rounds.reserve(kMostRoundsOfBlocks);
    const unsigned most_rounds = by_components ? kMostRoundsOfComponents : kMostRoundsOfBlocks;
    for (unsigned round = 0; round < most_rounds && loose > 0; ++round) {
      const Regions<Key>& fine = rounds.empty() ? trees : rounds.back().coarse();
      const std::size_t before = loose;
      rounds.emplace_back(map_, widths_, fine, loose, round, Progress());
      loose = rounds.back().loose();
      if (loose > before - before / 8) break;
    }
    const Regions<Key>& last = rounds.empty() ? trees : rounds.back().coarse();
    result.roots.assign(last.roots.begin(), last.roots.begin() + static_cast<std::ptrdiff_t>(loose));
    result.links.reserve(last.links.size());
    for (const KeyLink<Key>& link : last.links)
      result.links.push_back({last.roots[link.a], last.roots[link.b], link.least, link.greatest});
    keep_border(rounds, last.roots, result);
    return result;
  }

 private:
  static constexpr std::uint32_t kNoNumber = 0;         ///< other numbers are 1 + the number in the block
  static constexpr std::uint32_t kKept = 1, kGone = 2;  ///< state of the block's tiles before trees are numbered

  /// Copies the ranges of the box, lists the tiles of the block, and gives the tiles of earlier blocks their owners.
  void load(std::size_t number) {
    const BlockGrid::Coordinates first = grid_.first(number);
    origin_ = grid_.origin(first);
    if (!grid_.is_whole(first)) {
      std::fill(least_.begin(), least_.end(), Key{0});
      std::fill(greatest_.begin(), greatest_.end(), Key{0});
    }
    grid_.for_lines(first, [&](std::size_t tile, Place place, std::size_t length) {
      std::copy_n(&map_.least[place], length, &least_[tile]);
      std::copy_n(&map_.greatest[place], length, &greatest_[tile]);
    });
    tiles_.clear();
    rows_.clear();
    low_border_.clear();
    high_border_.clear();
    add_tiles(grid_.dim() - 1, 0, first, {});
    owners_.clear();
    outside_.clear();
    for (const BlockGrid::Earlier& earlier : grid_.earlier()) {
      if (constant(earlier.tile)) continue;
      const FinishedBlock<Key>& block = finished_[number - earlier.blocks_back];
      parts_.clear();
      for (std::size_t i = first_owner_[place_of_tile(earlier.tile)];; ++i) {
        const auto& [root, end] = block.owners[i];
        parts_.emplace_back(outside_(root), end);
        if (end >= greatest_[earlier.tile]) break;
      }
      owners_.set(earlier.tile, parts_);
    }
    number_.assign(grid_.room() + outside_.size(), kNoNumber);
  }
  /// Whether a tile lies beside earlier blocks, and beside later ones.
  struct AtBorder {
    bool low = false, high = false;
  };
  void add_tiles(int axis, std::size_t at, const BlockGrid::Coordinates& first, AtBorder so_far) {
    const std::size_t count = std::min(grid_.width(), grid_.size(axis) - first[axis]);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t tile = at + (i + 1) * grid_.step(axis);
      const AtBorder border{so_far.low || (i == 0 && first[axis] > 0),
                            so_far.high || (i + 1 == count && first[axis] + count < grid_.size(axis))};
      if (axis == 0 && i == 0) rows_.emplace_back(static_cast<std::uint32_t>(tile), static_cast<std::uint32_t>(count));
      if (axis > 0) {
        add_tiles(axis - 1, tile, first, border);
      } else if (!constant(static_cast<std::uint32_t>(tile))) {
        if (border.low) low_border_.push_back(static_cast<std::uint32_t>(tile));
        if (border.high) high_border_.push_back(static_cast<std::uint32_t>(tile));
        tiles_.push_back(static_cast<std::uint32_t>(tile));
      }
    }
  }
  [[nodiscard]] bool constant(std::uint32_t tile) const noexcept { return least_[tile] == greatest_[tile]; }
  [[nodiscard]] bool overlap(std::uint32_t a, std::uint32_t b) const noexcept {
    return std::max(least_[a], least_[b]) < std::min(greatest_[a], greatest_[b]);
  }
  [[nodiscard]] Place place_of(std::uint32_t root) const noexcept {
    return root < grid_.room() ? place_of_tile(root) : outside_.place(root);
  }
  [[nodiscard]] Place place_of_tile(std::uint32_t tile) const noexcept {
    return static_cast<Place>(origin_ + grid_.places()[tile]);
  }

  void give_up_tiles(Regions<Key>& trees) {
    // Within a class, even places come first: in a row of tiles with slowly increasing values, each odd tile then lies
    // between two processed ones.
    classes_.clear();
    for (const std::uint32_t tile : tiles_)
      classes_.push_back(
          static_cast<std::uint8_t>(2 * widths_.class_of(least_[tile], greatest_[tile]) + place_of_tile(tile) % 2));
    const auto order = sort_by_class(2 * Widths<Key>::kClasses, [&](const auto& visit) {
      for (std::size_t i = 0; i < tiles_.size(); ++i) visit(tiles_[i], classes_[i]);
    });
    for (const std::uint32_t tile : order)
      if (!is_given_up(tile)) number_[tile] = kKept;
    give_up_again(order);
    for (const std::uint32_t tile : tiles_) {
      if (number_[tile] != kKept) {
        number_[tile] = kNoNumber;
        continue;
      }
      trees.roots.push_back(place_of_tile(tile));
      number_[tile] = static_cast<std::uint32_t>(trees.roots.size());
    }
  }
  /// Calls visit(root, end) for the current owners of a tile in ascending order, resolving owners that were given up
  /// since.
  template <class Visit>
  void for_roots(std::uint32_t tile, Key level, Key end, const Visit& visit) const {
    owners_.for_owners(tile, level, end, [&](std::uint32_t owner, Key to) {
      if (number_[owner] == kGone)
        for_roots(owner, level, to, visit);
      else
        visit(owner, to);
      level = to;
    });
  }
  /// Second pass, narrow tiles first: gives up kept tiles that tiles processed later now cover together.
  void give_up_again(const std::vector<std::uint32_t>& order) {
    bool any = false;
    for (auto tile = order.rbegin(); tile != order.rend(); ++tile) {
      if (number_[*tile] != kKept || !is_covered_by_others(*tile)) continue;
      owners_.set(*tile, parts_);
      number_[*tile] = kGone;
      any = true;
    }
    if (!any) return;
    // Tiles that were given up pass to tiles that stay, or that come before them in the order and are resolved.
    const auto is_gone = [&](std::uint32_t owner) { return number_[owner] == kGone; };
    const auto resolve = [&](std::uint32_t tile) { owners_.resolve(tile, least_[tile], greatest_[tile], is_gone); };
    for (const std::uint32_t tile : order)
      if (is_gone(tile)) resolve(tile);
    for (const std::uint32_t tile : tiles_) resolve(tile);  // `link` reads the parts in this order
  }
  /// Whether other trees cover the tile; `parts_` are then their parts. Neighbours across faces nearly always do, so
  /// they are tried first.
  bool is_covered_by_others(std::uint32_t tile) {
    const Key least = least_[tile];
    const Key greatest = greatest_[tile];
    offered_.clear();
    Key lowest = greatest, highest = least;
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      if (i == grid_.faces() && lowest <= least && highest >= greatest && divide_among_offered(tile)) return true;
      const auto other = static_cast<std::uint32_t>(tile + neighbours_[i]);
      if (!owners_.has(other) || !overlap(tile, other)) continue;
      Key from = std::max(least, least_[other]);
      for_roots(other, from, std::min(greatest, greatest_[other]), [&](std::uint32_t root, Key to) {
        if (root != tile) {
          offered_.push_back({root, 0, from, to});
          lowest = std::min(lowest, from);
          highest = std::max(highest, to);
        }
        from = to;
      });
    }
    return lowest <= least && highest >= greatest && divide_among_offered(tile);
  }
  /// Sets `parts_` to a division of the range of a tile among the offers, each part as long as possible. False: a gap.
  bool divide_among_offered(std::uint32_t tile) {
    const Key greatest = greatest_[tile];
    parts_.clear();
    for (Key level = least_[tile]; level < greatest;) {
      Key farthest = level;
      std::uint32_t by = tile;
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
  /// Gives the tile up if processed neighbours cover it: across faces, or all of them.
  bool is_given_up(std::uint32_t tile) {
    const Key least = least_[tile];
    const Key greatest = greatest_[tile];
    return offer_neighbours(tile, 0, grid_.faces()) || owners_.give_up_to_offers(tile, least, greatest) ||
           offer_neighbours(tile, grid_.faces(), neighbours_.size()) || owners_.give_up(tile, least, greatest);
  }
  /// Offers neighbours of the tile, or gives it up to one of them.
  bool offer_neighbours(std::uint32_t tile, std::size_t from, std::size_t to) {
    const Key least = least_[tile];
    const Key greatest = greatest_[tile];
    // without branches, which would be hard to predict
    std::size_t count = 0;
    for (std::size_t i = from; i < to; ++i) {
      const auto other = static_cast<std::uint32_t>(tile + neighbours_[i]);
      near_[count] = other;
      count += static_cast<std::size_t>(owners_.has(other)) & static_cast<std::size_t>(overlap(tile, other));
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t other = near_[i];
      // A tile that contains the range with room at both ends is as good as any. In noise most tiles lie in one.
      if (least_[other] < least && greatest < greatest_[other] && owners_.give_up_to_one(tile, other, least, greatest))
        return true;
      owners_.offer(other, least_[other], greatest_[other]);
    }
    return false;
  }

  /// As find_wanted_links, for one tile and neighbour: the levels of the link, empty if it is superfluous.
  [[nodiscard]] std::pair<Key, Key> wanted_levels(std::uint32_t tile, const BlockGrid::Ahead& ahead) const {
    const auto other = static_cast<std::uint32_t>(tile + ahead.distance);
    Key low = std::max(least_[tile], least_[other]), high = std::min(greatest_[tile], greatest_[other]);
    for (const auto& [by, and_by] : ahead.detours) {
      if (low >= high) break;
      const Key first = std::max(least_[tile + by], least_[tile + and_by]);
      const Key end = std::min(greatest_[tile + by], greatest_[tile + and_by]);
      if (first >= end) continue;
      if (first <= low && low < end) low = end;
      if (high <= end && first < high) high = first;
    }
    return {low, high};
  }
  /// Takes the roots of all components of the block as trees, sets the owners of border tiles, and collects the links
  /// among the trees. False if this takes too long.
  bool take_components(Regions<Key>& trees, LinkCollector<Key>& collector) {
    if (!components_ || !components_->find(least_.data(), greatest_.data(), tiles_, rows_)) return false;
    for (const std::uint32_t tile : components_->roots()) {
      trees.roots.push_back(place_of_tile(tile));
      number_[tile] = static_cast<std::uint32_t>(trees.roots.size());
    }
    for (const auto* border : {&low_border_, &high_border_})
      for (const std::uint32_t tile : *border) {
        if (owners_.has(tile)) continue;
        find_parts(tile);
        owners_.set(tile, parts_);
      }
    for (const std::uint32_t tile : components_->roots()) {
      find_parts(tile);
      Key from = least_[tile];
      for (const auto& [root, to] : parts_) {
        const std::uint32_t a = std::min(number_[root], number_[tile]) - 1;
        const std::uint32_t b = std::max(number_[root], number_[tile]) - 1;
        if (a != b) collector.add({a, b, from, to});
        from = to;
      }
    }
    return true;
  }
  /// Sets `parts_` to the roots of the components of a tile.
  void find_parts(std::uint32_t tile) {
    parts_.clear();
    Key from = least_[tile];
    components_->for_roots(tile, [&](std::uint32_t root, const TileEvents::Event& event) {
      const Key to = event.leaves ? greatest_[event.tile] : least_[event.tile];
      if (to == from) return;
      if (!parts_.empty() && parts_.back().first == root)
        parts_.back().second = to;
      else
        parts_.emplace_back(root, to);
      from = to;
    });
  }
  /// Collects the links among the tiles of the block, if `in_block`, and to earlier blocks, and numbers the trees of
  /// the latter.
  void link(Regions<Key>& trees, bool in_block, LinkCollector<Key>& collector) {
    const auto number = [&](std::uint32_t root) {
      if (number_[root] == kNoNumber) {
        trees.roots.push_back(place_of(root));
        number_[root] = static_cast<std::uint32_t>(trees.roots.size());
      }
      return number_[root] - 1;
    };
    for (const std::uint32_t tile : high_border_)
      owners_.for_owners(tile, least_[tile], greatest_[tile], [&](std::uint32_t root, Key) { number(root); });
    if (!in_block) rows_.clear();
    for (const auto& [tile, count] : rows_) {
      find_wanted_links(RowOfLinks<Key>{&least_[tile], &greatest_[tile], low_.data(), high_.data()}, count,
                        grid_.ahead(), wanted_.data());
      for (std::size_t a = 0; a < wanted_.size(); ++a)
        for (std::uint64_t bits = wanted_[a]; bits != 0; bits &= bits - 1) {
          const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
          const auto other = static_cast<std::uint32_t>(tile + i + grid_.ahead()[a].distance);
          const std::size_t levels = a * kMostOfRow + i;
          if (owners_.has(other)) owners_.add_links(tile + i, other, low_[levels], high_[levels], number, collector);
        }
    }
    for (const std::uint32_t tile : low_border_)
      for (const BlockGrid::Ahead& ahead : grid_.ahead()) {
        const auto other = static_cast<std::uint32_t>(tile - ahead.distance);
        if (!is_earlier_[other] || !owners_.has(other)) continue;
        const auto [low, high] = wanted_levels(other, ahead);
        if (low < high) owners_.add_links(other, tile, low, high, number, collector);
      }
    trees.links = collector.take();
  }

  /// Keeps the owners of the tiles beside later blocks after all rounds of coarsening; these blocks read no others.
  void keep_border(const std::vector<Coarsening<Key>>& rounds, const std::vector<Place>& roots,
                   FinishedBlock<Key>& result) {
    std::vector<std::pair<std::uint32_t, Key>> parts, finer;
    for (const std::uint32_t tile : high_border_) {
      const Key least = least_[tile];
      const auto add = [&](std::uint32_t owner, Key end) {
        if (!parts.empty() && parts.back().first == owner)
          parts.back().second = end;
        else
          parts.emplace_back(owner, end);
      };
      parts.clear();
      owners_.for_owners(tile, least, greatest_[tile],
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
      first_owner_[place_of_tile(tile)] = static_cast<std::uint32_t>(result.owners.size());
      for (const auto& [tree, end] : parts) result.owners.emplace_back(roots[tree], end);
    }
  }

  const RangeMap<Key>& map_;
  const Widths<Key>& widths_;
  const BlockGrid& grid_;
  const std::vector<FinishedBlock<Key>>& finished_;
  std::vector<std::uint32_t>& first_owner_;
  std::vector<std::ptrdiff_t> neighbours_;
  std::vector<std::uint32_t> near_;    ///< those that matter to a tile
  std::vector<Key> least_, greatest_;  ///< by tile of the box, and kReadBeyond more
  Place origin_ = 0;                   ///< see BlockGrid::places
  std::vector<bool> is_earlier_;       ///< by tile of the box: whether it belongs to an earlier block
  /// Of the tiles of the box: tiles of the block, and roots outside.
  Ownership<Key, std::uint32_t> owners_;
  OutsideRoots outside_;
  std::vector<std::uint32_t> tiles_;                           ///< of the block, those that are not constant
  std::vector<std::pair<std::uint32_t, std::uint32_t>> rows_;  ///< of the block: first tile, number of tiles
  std::vector<std::uint32_t> low_border_, high_border_;        ///< the tiles beside earlier and beside later blocks
  std::vector<std::uint32_t> number_;                          ///< by root: number of its tree in the block
  std::vector<std::uint8_t> classes_;
  std::vector<KeyLink<Key>> offered_;  ///< a: the offering root
  std::vector<std::pair<std::uint32_t, Key>> parts_;
  std::optional<BlockComponents> components_;
  std::vector<std::uint64_t> wanted_;  ///< by neighbour ahead (see find_wanted_links)
  std::vector<Key> low_, high_;        ///< see RowOfLinks
};

/// The regions of all tiles. Blocks of a group are built at the same time; the result is as if they were built one
/// after the other.
template <class Key>
Regions<Key> make_first_regions(const RangeMap<Key>& map, const Widths<Key>& widths, Neighbourhood neighbourhood,
                                unsigned threads, const Progress& progress) {
  Regions<Key> regions;
  if (map.tiles.rows() == 0) return regions;
  // In noise, detours leave many short links, which take longer than those that they save.
  const BlockGrid grid(map.tiles, neighbourhood, !widths.are_of_noise());
  std::vector<FinishedBlock<Key>> finished(grid.count());
  std::vector<std::uint32_t> of_place(map.tiles.room());  // first owners, then numbers of roots
  Workers<BlockTrees<Key>> workers(threads, [&] { return BlockTrees<Key>(map, widths, grid, finished, of_place); });
  std::size_t done = 0;
  for (const std::vector<std::size_t>& group : grid.groups()) {
    report_progress(progress, static_cast<double>(done) / static_cast<double>(grid.count()));
    workers.for_range(group.size(), 1, [&](std::size_t from, std::size_t to, BlockTrees<Key>& trees) {
      for (std::size_t i = from; i < to; ++i) finished[group[i]] = trees.make(group[i]);
    });
    done += group.size();
  }
  std::size_t links = 0;
  for (const FinishedBlock<Key>& block : finished) {
    links += block.links.size();
    for (const Place root : block.roots) {
      of_place[root] = static_cast<std::uint32_t>(regions.roots.size());
      regions.roots.push_back(root);
    }
  }
  regions.links.reserve(links);
  for (FinishedBlock<Key>& block : finished) {
    for (const KeyLink<Key>& link : block.links) {
      const std::uint32_t a = of_place[link.a];
      const std::uint32_t b = of_place[link.b];
      regions.links.push_back({std::min(a, b), std::max(a, b), link.least, link.greatest});
    }
    block = {};
  }
  return regions;
}

}  // namespace

template <class Key>
Regions<Key> make_regions(const RangeMap<Key>& map, Neighbourhood neighbourhood, unsigned threads,
                          const Progress& progress) {
  const Widths<Key> widths(map);
  report_progress(progress, 0.1);
  const Progress of_tiles = part_of(progress, 0.1, 0.7);
  Regions<Key> regions = make_first_regions(map, widths, neighbourhood, threads, of_tiles);
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

template Regions<std::uint8_t> make_regions(const RangeMap<std::uint8_t>&, Neighbourhood, unsigned, const Progress&);
template Regions<std::uint16_t> make_regions(const RangeMap<std::uint16_t>&, Neighbourhood, unsigned, const Progress&);
template Regions<std::uint32_t> make_regions(const RangeMap<std::uint32_t>&, Neighbourhood, unsigned, const Progress&);
template Regions<std::uint64_t> make_regions(const RangeMap<std::uint64_t>&, Neighbourhood, unsigned, const Progress&);

}  // namespace tegl::detail
