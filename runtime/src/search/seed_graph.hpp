// SPDX-License-Identifier: BSD-3-Clause
//
// Seed graph: the trees of tiles that remain when every tile is removed whose range lies in the range of a neighbour,
// and the links between these trees.
//
// Based on: Hung Chiang-Han, A new approach of seed-set finding for iso-surface extraction, Taiwan Tech 2005, 3.3
// (grouping) and 3.4.1 (Whole1). The optimum is preserved: at every isovalue a removed tile is in the component of the
// neighbour whose range contains its range, so some minimum seed set consists of roots only.
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
  /// Only links of root groups, in both directions if both exist: a is the tree whose root group has the tile.
  bool of_root_groups = false;
  bool with_links = true;
  /// Limit of the number of trees times the binary digits of the number of levels. Beyond it neither links nor levels
  /// are computed.
  std::uint64_t most_work = ~std::uint64_t{0};
  Progress progress;
};

/// Progress reported when the roots are known; a graph that exceeds `most_work` is abandoned there.
inline constexpr double kProgressWithRoots = 0.5;

template <class Key>
SeedGraph make_seed_graph(const RangeMap<Key>& map, const SeedGraphOptions& options);

/// Merges each tree into a linked tree if one link covers all its levels, and repeats this until hardly any is left.
/// The minimum seed set does not grow.
void contract(SeedGraph& graph);

}  // namespace tegl::detail
