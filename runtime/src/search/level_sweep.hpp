// SPDX-License-Identifier: BSD-3-Clause
//
// Goes through the levels of a seed graph, one after the other, with the components of each at hand, and picks trees
// whenever a component has none that is picked: a cover of all components of all levels, or a packing.
//
// Links come and go: which of them a level has is known from the start, so components are those of a union-find that
// forgets. Levels are the leaves of a binary tree; a link is joined at the few nodes that its levels are made up of,
// on the way down, and undone on the way up. Based on: Tarjan 1979 and the offline connectivity that is folklore since;
// applied to Reeb graphs by Doraiswamy and Natarajan 2009. O((trees + links) log levels log trees) time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "search/seed_graph.hpp"

namespace tegl::detail {

enum class SweepDirection { up, down };

inline SweepDirection opposite(SweepDirection direction) noexcept {
  return direction == SweepDirection::up ? SweepDirection::down : SweepDirection::up;
}

enum class SweepPick {
  farthest,  ///< of a component without picks, the tree that is active for longest from there on
  all,       ///< all of its trees: then each time is a component that shares no tree with the others, a packing
};

/// Levels first ... end - 1 at which a tree's component has a pick that the graph does not show.
struct PickedElsewhere {
  std::uint32_t tree, first, end;
};

struct LevelSweepOptions {
  SweepDirection direction = SweepDirection::up;
  SweepPick pick = SweepPick::farthest;
  /// Of each tree, whether it may be picked; null: all may. Components without any get none.
  const std::vector<bool>* allowed = nullptr;
  std::span<const PickedElsewhere> elsewhere;  ///< these components need no pick
  Progress progress;
};

struct LevelSweepResult {
  std::vector<std::uint32_t> picked;  ///< ascending; `farthest` alone
  std::uint64_t times = 0;            ///< how often a component had no pick
};

LevelSweepResult sweep_levels(const SeedGraph& graph, const LevelSweepOptions& options);

}  // namespace tegl::detail
