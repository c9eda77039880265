// SPDX-License-Identifier: BSD-3-Clause
//
// What is left of the tiles when those go whose range lies in a neighbour's: trees of tiles, and the links between
// them.
//
// Based on: Hung Chiang-Han, A new approach of seed-set finding for iso-surface extraction, Taiwan Tech 2005, 3.3
// (grouping) and 3.4.1 (Whole1). Nothing is lost for later: a tile's component at any isovalue is that of the neighbour
// that its range lies in, so some smallest seed set has roots of trees alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "search/padded_ranges.hpp"
#include "search/seed_trees.hpp"

namespace tegl::detail {

struct SeedGraphOptions {
  Neighbourhood neighbourhood = Neighbourhood::all;
  std::vector<int> order;  ///< all axes
  /// Links of root groups alone, in both directions where both are: a is the tree whose root's group has the tile.
  bool of_root_groups = false;
  bool with_links = true;
  /// Of trees times the digits of the number of levels: beyond that neither links nor levels are found.
  std::uint64_t most_work = ~std::uint64_t{0};
  Progress progress;
};

/// How much of the progress is told when roots are known, and a graph with too much work is given up.
inline constexpr double kProgressWithRoots = 0.5;

template <class Key>
SeedGraph make_seed_graph(const RangeMap<Key>& map, const SeedGraphOptions& options);

/// Trees of which one link covers all levels hang on its other end, and so on until hardly any do: as above, no
/// smallest seed set gets larger.
void contract(SeedGraph& graph);

}  // namespace tegl::detail
