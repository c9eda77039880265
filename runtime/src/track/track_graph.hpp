// SPDX-License-Identifier: BSD-3-Clause
//
// The graph that a sweep finds, made simpler: without what lasts no time, and without what lasts less than asked for.
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
    std::vector<Index> out;  ///< likewise
    Index passing = kNone;   ///< the arc that was made of the two that it connected
  };

  SweptGraph(std::vector<SweepNode> nodes, std::vector<SweepArc> arcs, std::vector<SweepHandle> handles);

  /// Joins the ends of all arcs that last no time, where times that are apart by the tolerance may be one.
  void contract(double tolerance);
  /// Takes out the shortest branch until none that may be taken out is shorter than `lifetime`.
  void prune(double lifetime);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] const SweepArc& arc(Index a) const { return arcs_[a]; }
  [[nodiscard]] std::size_t arc_count() const { return arcs_.size(); }
  /// The arc that is left of an arc, or goes on from it; kNone if it was taken out.
  [[nodiscard]] Index represent(Index a) const;
  /// Handles on arcs that are left, by time, then vertex; those of one arc at one time are one.
  [[nodiscard]] std::vector<SweepHandle> handles() const;
  [[nodiscard]] bool is_left(Index a) const { return states_[a].kind == Kind::left; }

 private:
  enum class Kind : std::uint8_t { left, part_of, in_node, gone };
  struct State {
    Kind kind = Kind::left;
    Index of = kNone;  ///< part_of: the arc; in_node: the node
  };

  [[nodiscard]] double length(Index a) const;
  /// What happens at the time of an event on one of its arcs is a part of it. `first`: per node, the first of its time.
  void absorb_handles(const std::vector<Index>& first, double tolerance);
  void remove(Index a);
  /// Makes one arc of two that a node merely connects; the arc that grew, or kNone.
  Index splice(Index node);
  void list_arcs();
  [[nodiscard]] bool is_prunable(Index a) const;

  std::vector<Node> nodes_;
  std::vector<SweepArc> arcs_;
  std::vector<State> states_;
  std::vector<SweepHandle> handles_;
};

}  // namespace tegl::detail
