// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the groups, trees and links of a seed graph. Each step visits all tiles once, with their neighbours.
#include "search/seed_graph.hpp"

#include "base/disjoint_sets.hpp"
#include "search/seed_links.hpp"

#include <algorithm>
#include <bit>

namespace tegl::detail {

namespace {

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
    report_progress(options_.progress, kProgressWithRoots);
    number_roots();
    if (options_.most_work != ~std::uint64_t{0} && work() > options_.most_work) {
      graph_.too_much_work = true;
      return std::move(graph_);
    }
    std::vector<KeyLink<Key>> links;
    if (options_.with_links) links = collect_links();
    report_progress(options_.progress, 0.8);
    put_in_levels(map_, links, {}, graph_);
    return std::move(graph_);
  }

 private:
  /// Neighbours with equal ranges form a group. Its root is its first tile in scan order.
  void group() {
    // neighbours that the scan visits before a tile
    std::vector<std::ptrdiff_t> before;
    const auto scans_before = [&](std::ptrdiff_t distance) {
      const std::size_t at =
          static_cast<std::size_t>(std::find(neighbours_.begin(), neighbours_.end(), distance) - neighbours_.begin());
      return at < neighbours_.size() / 2;
    };
    for (const std::ptrdiff_t distance : neighbours_)
      if (scans_before(distance)) before.push_back(distance);
    std::vector<std::uint32_t> met;  // position of a tile in the scan, if the scan is not in the order of places
    const bool by_place = std::is_sorted(options_.order.begin(), options_.order.end());
    if (!by_place) met.resize(map_.tiles.room());
    std::uint32_t now = 0;
    // merge each tile with earlier neighbours of equal range
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
          trees_.join_under(b, a);
        else
          trees_.join_under(a, b);
      }
    });
  }

  /// Attaches each group to a neighbour whose range contains the range of the group: the widest one of the first tile,
  /// in scan order, that has any.
  void hang() {
    map_.tiles.scan(options_.order, [&](Place tile) {
      if (map_.constant(tile)) return;
      const Place root = trees_.find(tile);
      if (!map_.same(root, tile)) return;  // its group is attached already
      Place widest = tile;
      for (const std::ptrdiff_t distance : neighbours_) {
        const auto other = static_cast<Place>(tile + distance);
        if (map_.inside(tile, other) && map_.width(other) > map_.width(widest)) widest = other;
      }
      if (widest != tile) trees_.join_under(root, trees_.find(widest));
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

  [[nodiscard]] std::uint64_t work() const {
    std::vector<Key> keys;
    for (const Place root : graph_.roots) {
      keys.push_back(map_.least[root]);
      keys.push_back(map_.greatest[root]);
    }
    return graph_.roots.size() * static_cast<std::uint64_t>(std::bit_width(Levels<Key>(std::move(keys)).count()));
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

  const RangeMap<Key>& map_;
  const SeedGraphOptions& options_;
  std::vector<std::ptrdiff_t> neighbours_;
  DisjointSets trees_;
  std::vector<std::uint32_t> number_;  ///< by root: number of its tree
  SeedGraph graph_;
};

}  // namespace

template <class Key>
SeedGraph make_seed_graph(const RangeMap<Key>& map, const SeedGraphOptions& options) {
  return GraphMaker<Key>(map, options).make();
}

void contract(SeedGraph& graph) {
  // Stop if a round merges at most 1/64 of the trees.
  for (std::size_t hung = graph.roots.size(); hung * 64 > graph.roots.size();) {
    hung = 0;
    DisjointSets sets(graph.roots.size());
    const auto covers = [&](const SeedLink& link, std::uint32_t tree) {
      return link.first <= graph.first[tree] && graph.end[tree] <= link.end;
    };
    for (const SeedLink& link : graph.links) {
      // The wider of two roots stays: a tree that is attached already is at least as wide as the link.
      for (const auto& [tree, on] : {std::pair(link.a, link.b), std::pair(link.b, link.a)}) {
        if (!covers(link, tree) || sets.find(tree) != tree) continue;
        const std::uint32_t root = sets.find(on);
        if (root == tree) continue;
        sets.join_under(tree, root);
        ++hung;
        break;
      }
    }
    if (hung == 0) return;
    // renumber the remaining trees and their links
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
