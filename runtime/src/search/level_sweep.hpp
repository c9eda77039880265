// SPDX-License-Identifier: BSD-3-Clause
//
// Sweep over the levels of a seed graph with the connected components of each level. Whenever a component has no picked
// tree, the sweep picks one (a cover of all components of all levels) or all (a packing).
//
// Offline dynamic connectivity: the levels of every link are known in advance. The levels are the leaves of a binary
// tree. A link is joined at the few nodes that its levels decompose into, on the way down, and undone on the way up.
// Based on: Tarjan 1979 and offline dynamic connectivity (folklore); applied to Reeb graphs by Doraiswamy and Natarajan
// 2009. O((trees + links) log levels log trees) time.
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
  farthest,  ///< pick the tree of the component that stays active longest
  all,       ///< pick all trees of the component: such components share no tree (a packing)
};

/// Levels first ... end - 1 at which the component of a tree has a pick outside the graph.
struct PickedElsewhere {
  std::uint32_t tree, first, end;
};

struct LevelSweepOptions {
  SweepDirection direction = SweepDirection::up;
  SweepPick pick = SweepPick::farthest;
  /// By tree, whether it may be picked; null: all may. A component without such a tree gets no pick.
  const std::vector<bool>* allowed = nullptr;
  std::span<const PickedElsewhere> elsewhere;  ///< components that need no pick
  Progress progress;
};

struct LevelSweepResult {
  std::vector<std::uint32_t> picked;  ///< ascending; only for `farthest`
  std::uint64_t times = 0;            ///< number of components found without a pick
};

LevelSweepResult sweep_levels(const SeedGraph& graph, const LevelSweepOptions& options);

}  // namespace tegl::detail
