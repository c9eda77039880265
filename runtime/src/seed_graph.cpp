// SPDX-License-Identifier: BSD-3-Clause
//
// Groups, trees and links. Each step goes through all tiles once and looks at their neighbours.
#include "seed_graph.hpp"

#include "progress.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace tegl::detail {

namespace {

/// A link whose bounds are keys.
template <class Key>
struct KeyLink {
  std::uint32_t a, b;
  Key least, greatest;
};

/// Links come in runs along borders between trees: those that overlap are made one before they are kept.
template <class Key>
class LinkCollector {
 public:
  LinkCollector() : recent_(kRecent, Link{0, 0, 0, 0}) {}

  void add(const KeyLink<Key>& link) {
    Link& recent = recent_[(link.a * 0x9e3779b1u ^ link.b * 0x85ebca6bu) >> kShift];
    const bool one = recent.a == link.a && recent.b == link.b && recent.least <= link.greatest &&
                     link.least <= recent.greatest && recent.least != recent.greatest;
    if (one) {
      recent.least = std::min(recent.least, link.least);
      recent.greatest = std::max(recent.greatest, link.greatest);
    } else {
      keep(recent);
      recent = link;
    }
  }
  std::vector<KeyLink<Key>> take() {
    for (const Link& link : recent_) keep(link);
    return std::move(links_);
  }

 private:
  using Link = KeyLink<Key>;
  static constexpr std::size_t kRecent = 1u << 16;
  static constexpr unsigned kShift = 16;

  void keep(const Link& link) {
    if (link.least == link.greatest) return;
    if (links_.size() == links_.capacity() && links_.size() >= wanted_) compress();
    links_.push_back(link);
  }
  /// Far more than there are different ones are not kept.
  void compress() {
    std::sort(links_.begin(), links_.end(), [](const Link& p, const Link& q) {
      return std::tie(p.a, p.b, p.least, p.greatest) < std::tie(q.a, q.b, q.least, q.greatest);
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (kept > 0 && links_[kept - 1].a == links_[i].a && links_[kept - 1].b == links_[i].b &&
          links_[i].least <= links_[kept - 1].greatest)
        links_[kept - 1].greatest = std::max(links_[kept - 1].greatest, links_[i].greatest);
      else
        links_[kept++] = links_[i];
    }
    links_.resize(kept);
    wanted_ = std::max<std::size_t>(kMostUnsorted, 2 * kept);
  }

  static constexpr std::size_t kMostUnsorted = std::size_t{1} << 22;
  std::vector<Link> recent_;
  std::vector<Link> links_;
  std::size_t wanted_ = kMostUnsorted;
};

/// Keys as levels: their ranks among those that occur.
template <class Key>
class Levels {
 public:
  Levels(std::vector<Key> keys) : keys_(std::move(keys)) {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  }
  [[nodiscard]] std::uint32_t operator[](Key key) const noexcept {
    return static_cast<std::uint32_t>(std::lower_bound(keys_.begin(), keys_.end(), key) - keys_.begin());
  }
  [[nodiscard]] std::uint32_t count() const noexcept {
    return keys_.empty() ? 0 : static_cast<std::uint32_t>(keys_.size() - 1);
  }

 private:
  std::vector<Key> keys_;
};

template <class Key>
class GraphMaker {
 public:
  GraphMaker(const RangeMap<Key>& map, const SeedGraphOptions& options)
      : map_(map),
        options_(options),
        neighbours_(map.tiles.neighbours(options.neighbourhood, options.order)),
        trees_(map.tiles.room()) {}

  SeedGraph make() {
    group();
    report_progress(options_.progress, 0.2);
    hang();
    report_progress(options_.progress, 0.5);
    number_roots();
    std::vector<KeyLink<Key>> links;
    if (options_.with_links) links = collect_links();
    report_progress(options_.progress, 0.8);
    rank(links);
    return std::move(graph_);
  }

 private:
  /// Neighbours with one range are one group; its root is the one that the scan meets first.
  void group() {
    std::vector<std::ptrdiff_t> before;
    const auto scans_before = [&](std::ptrdiff_t distance) {
      const std::size_t at =
          static_cast<std::size_t>(std::find(neighbours_.begin(), neighbours_.end(), distance) - neighbours_.begin());
      return at < neighbours_.size() / 2;
    };
    for (const std::ptrdiff_t distance : neighbours_)
      if (scans_before(distance)) before.push_back(distance);
    std::vector<std::uint32_t> met;  // when the scan met a tile, where that is not the order of places
    const bool by_place = std::is_sorted(options_.order.begin(), options_.order.end());
    if (!by_place) met.resize(map_.tiles.room());
    std::uint32_t now = 0;
    map_.tiles.scan(options_.order, [&](Place tile) {
      if (!by_place) met[tile] = now++;
      if (map_.constant(tile)) {
        ++graph_.constant_tiles;
        return;
      }
      ++graph_.groups;
      for (const std::ptrdiff_t distance : before) {
        const auto other = static_cast<Place>(tile + distance);
        if (!map_.same(tile, other)) continue;
        const Place a = trees_.find(tile);
        const Place b = trees_.find(other);
        if (a == b) continue;
        --graph_.groups;
        const bool a_first = by_place ? a < b : met[a] < met[b];
        if (a_first)
          trees_.hang(b, a);
        else
          trees_.hang(a, b);
      }
    });
  }

  /// Groups hang on the widest neighbour, of the tile met first that has any, whose range has theirs inside.
  void hang() {
    map_.tiles.scan(options_.order, [&](Place tile) {
      if (map_.constant(tile)) return;
      const Place root = trees_.find(tile);
      if (!map_.same(root, tile)) return;  // its group hangs already
      Place widest = tile;
      for (const std::ptrdiff_t distance : neighbours_) {
        const auto other = static_cast<Place>(tile + distance);
        if (map_.inside(tile, other) && map_.width(other) > map_.width(widest)) widest = other;
      }
      if (widest != tile) trees_.hang(root, trees_.find(widest));
    });
  }

  void number_roots() {
    number_.assign(map_.tiles.room(), 0);
    map_.tiles.scan(options_.order, [&](Place tile) {
      if (map_.constant(tile) || trees_.find(tile) != tile) return;
      number_[tile] = static_cast<std::uint32_t>(graph_.roots.size());
      graph_.roots.push_back(tile);
    });
  }

  std::vector<KeyLink<Key>> collect_links() {
    LinkCollector<Key> collector;
    std::vector<std::ptrdiff_t> ahead;
    for (const std::ptrdiff_t distance : neighbours_)
      if (distance > 0) ahead.push_back(distance);
    const auto order = default_order(map_.tiles.dim());
    map_.tiles.scan(order, [&](Place tile) {
      if (map_.constant(tile)) return;
      const Place own = trees_.find(tile);
      for (const std::ptrdiff_t distance : ahead) {
        const auto other = static_cast<Place>(tile + distance);
        if (!map_.overlap(tile, other)) continue;
        const Place of_other = trees_.find(other);
        if (own == of_other) continue;
        const Key least = std::max(map_.least[tile], map_.least[other]);
        const Key greatest = std::min(map_.greatest[tile], map_.greatest[other]);
        const std::uint32_t a = number_[own];
        const std::uint32_t b = number_[of_other];
        if (!options_.of_root_groups) {
          collector.add({std::min(a, b), std::max(a, b), least, greatest});
        } else {
          if (map_.same(own, tile)) collector.add({a, b, least, greatest});
          if (map_.same(of_other, other)) collector.add({b, a, least, greatest});
        }
      }
    });
    return collector.take();
  }

  void rank(const std::vector<KeyLink<Key>>& links) {
    std::vector<Key> keys;
    keys.reserve(2 * (graph_.roots.size() + links.size()));
    for (const Place root : graph_.roots) {
      keys.push_back(map_.least[root]);
      keys.push_back(map_.greatest[root]);
    }
    for (const auto& link : links) {
      keys.push_back(link.least);
      keys.push_back(link.greatest);
    }
    const Levels<Key> levels(std::move(keys));
    graph_.levels = levels.count();
    for (const Place root : graph_.roots) {
      graph_.first.push_back(levels[map_.least[root]]);
      graph_.end.push_back(levels[map_.greatest[root]]);
    }
    graph_.links.reserve(links.size());
    for (const auto& link : links) graph_.links.push_back({link.a, link.b, levels[link.least], levels[link.greatest]});
    merge_links(graph_.links);
  }

  const RangeMap<Key>& map_;
  const SeedGraphOptions& options_;
  std::vector<std::ptrdiff_t> neighbours_;
  DisjointSets trees_;
  std::vector<std::uint32_t> number_;  ///< of a root's tree
  SeedGraph graph_;
};

}  // namespace

void report_progress(const Progress& progress, double fraction) {
  tell(progress, fraction, "seeds: cancelled by the progress callback");
}

template <class Key>
SeedGraph make_seed_graph(const RangeMap<Key>& map, const SeedGraphOptions& options) {
  return GraphMaker<Key>(map, options).make();
}

void merge_links(std::vector<SeedLink>& links) {
  std::sort(links.begin(), links.end(), [](const SeedLink& p, const SeedLink& q) {
    return std::tie(p.a, p.b, p.first, p.end) < std::tie(q.a, q.b, q.first, q.end);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool one = kept > 0 && links[kept - 1].a == links[i].a && links[kept - 1].b == links[i].b &&
                     links[i].first <= links[kept - 1].end;
    if (one)
      links[kept - 1].end = std::max(links[kept - 1].end, links[i].end);
    else
      links[kept++] = links[i];
  }
  links.resize(kept);
}

void contract(SeedGraph& graph) {
  // The last few are not worth another round.
  for (std::size_t hung = graph.roots.size(); hung * 64 > graph.roots.size();) {
    hung = 0;
    DisjointSets sets(graph.roots.size());
    const auto covers = [&](const SeedLink& link, std::uint32_t tree) {
      return link.first <= graph.first[tree] && graph.end[tree] <= link.end;
    };
    for (const SeedLink& link : graph.links) {
      // The wider of two roots stays: ends that hang already are as wide as the link at least.
      for (const auto& [tree, on] : {std::pair(link.a, link.b), std::pair(link.b, link.a)}) {
        if (!covers(link, tree) || sets.find(tree) != tree) continue;
        const std::uint32_t root = sets.find(on);
        if (root == tree) continue;
        sets.hang(tree, root);
        ++hung;
        break;
      }
    }
    if (hung == 0) return;
    std::vector<std::uint32_t> number(graph.roots.size());
    std::uint32_t kept = 0;
    for (std::uint32_t tree = 0; tree < graph.roots.size(); ++tree) {
      if (sets.find(tree) != tree) continue;
      graph.roots[kept] = graph.roots[tree];
      graph.first[kept] = graph.first[tree];
      graph.end[kept] = graph.end[tree];
      number[tree] = kept++;
    }
    graph.roots.resize(kept);
    graph.first.resize(kept);
    graph.end.resize(kept);
    std::size_t links = 0;
    for (const SeedLink& link : graph.links) {
      const std::uint32_t a = number[sets.find(link.a)];
      const std::uint32_t b = number[sets.find(link.b)];
      if (a != b) graph.links[links++] = {std::min(a, b), std::max(a, b), link.first, link.end};
    }
    graph.links.resize(links);
    merge_links(graph.links);
  }
}

template SeedGraph make_seed_graph(const RangeMap<std::uint8_t>&, const SeedGraphOptions&);
template SeedGraph make_seed_graph(const RangeMap<std::uint16_t>&, const SeedGraphOptions&);
template SeedGraph make_seed_graph(const RangeMap<std::uint32_t>&, const SeedGraphOptions&);
template SeedGraph make_seed_graph(const RangeMap<std::uint64_t>&, const SeedGraphOptions&);

}  // namespace tegl::detail
