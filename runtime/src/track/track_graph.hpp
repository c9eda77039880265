// SPDX-License-Identifier: BSD-3-Clause
//
// Simplification of the graph from a sweep: removes arcs of zero duration and branches shorter than a lifetime.
#pragma once

#include <cstdint>
#include <vector>

#include "track/track_sweep.hpp"

namespace tegl::detail {

class SweptGraph {
 public:
  struct Node {
    SweepNode event;
    std::vector<Index> in;   ///< arcs, ascending
    std::vector<Index> out;  ///< arcs, ascending
    Index passing = kNone;   ///< the arc that replaced the two arcs at this node
  };

  SweptGraph(std::vector<SweepNode> nodes, std::vector<SweepArc> arcs, std::vector<SweepHandle> handles);

  /// Contracts all arcs of zero duration. Times that differ by at most the tolerance count as equal.
  void contract(double tolerance);
  /// Removes the shortest removable branch until all are at least `lifetime` long.
  void prune(double lifetime);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] const SweepArc& arc(Index a) const { return arcs_[a]; }
  [[nodiscard]] std::size_t arc_count() const { return arcs_.size(); }
  /// The remaining arc that contains or continues an arc; kNone if it was removed.
  [[nodiscard]] Index represent(Index a) const;
  /// Handles on remaining arcs, by time, then vertex. Handles of one arc at one time are merged.
  [[nodiscard]] std::vector<SweepHandle> handles() const;
  [[nodiscard]] bool is_left(Index a) const { return states_[a].kind == Kind::left; }

 private:
  enum class Kind : std::uint8_t { left, part_of, in_node, gone };
  struct State {
    Kind kind = Kind::left;
    Index of = kNone;  ///< part_of: the arc; in_node: the node
  };

  [[nodiscard]] double length(Index a) const;
  /// Merges each handle at the time of an end of its arc into the event there. `first`: by node, the first node of its
  /// time.
  void absorb_handles(const std::vector<Index>& first, double tolerance);
  void remove(Index a);
  /// Merges the two arcs at a node with one arc in and one out. Returns the remaining arc, or kNone.
  Index splice(Index node);
  void list_arcs();
  [[nodiscard]] bool is_prunable(Index a) const;

  std::vector<Node> nodes_;
  std::vector<SweepArc> arcs_;
  std::vector<State> states_;
  std::vector<SweepHandle> handles_;
};

}  // namespace tegl::detail
