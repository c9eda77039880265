// SPDX-License-Identifier: BSD-3-Clause
//
// Contraction and pruning of the graph of a sweep; see track_graph.hpp.
#include "track/track_graph.hpp"

#include <algorithm>
#include <array>
#include <queue>
#include <tuple>
#include <utility>

#include "base/disjoint_sets.hpp"

namespace tegl::detail {

SweptGraph::SweptGraph(std::vector<SweepNode> nodes, std::vector<SweepArc> arcs, std::vector<SweepHandle> handles)
    : nodes_(nodes.size()), arcs_(std::move(arcs)), states_(arcs_.size()), handles_(std::move(handles)) {
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes_[i].event = nodes[i];
  list_arcs();
}

void SweptGraph::list_arcs() {
  for (Node& node : nodes_) {
    node.in.clear();
    node.out.clear();
  }
  for (Index a = 0; a < arcs_.size(); ++a) {
    if (!is_left(a)) continue;
    nodes_[arcs_[a].from].out.push_back(a);
    nodes_[arcs_[a].to].in.push_back(a);
  }
}

double SweptGraph::length(Index a) const { return nodes_[arcs_[a].to].event.time - nodes_[arcs_[a].from].event.time; }

void SweptGraph::contract(double tolerance) {
  // Nodes are sorted by time. Nodes within the tolerance of the first node of a group have the same time.
  std::vector<Index> first(nodes_.size());
  for (Index i = 1; i < nodes_.size(); ++i)
    first[i] = nodes_[i].event.time - nodes_[first[i - 1]].event.time > tolerance ? i : first[i - 1];
  absorb_handles(first, tolerance);
  DisjointSets sets;  // the root of a set is its earliest node
  sets.reset(nodes_.size());
  for (const SweepArc& arc : arcs_)
    if (first[arc.from] == first[arc.to]) sets.join(arc.from, arc.to);
  for (Index i = 0; i < nodes_.size(); ++i) {
    const SweepNode& from = nodes_[i].event;
    SweepNode& to = nodes_[sets.find(i)].event;
    if (sets.find(i) == i) continue;
    to.euler_change += from.euler_change;
    to.at_border = to.at_border || from.at_border;
    to.flatness = std::max(to.flatness, from.flatness);
  }
  for (Index a = 0; a < arcs_.size(); ++a) {
    arcs_[a].from = sets.find(arcs_[a].from);
    arcs_[a].to = sets.find(arcs_[a].to);
    if (arcs_[a].from == arcs_[a].to) states_[a] = {Kind::in_node, arcs_[a].from};
  }
  list_arcs();
  for (Index i = 0; i < nodes_.size(); ++i) splice(i);
}

void SweptGraph::absorb_handles(const std::vector<Index>& first, double tolerance) {
  std::erase_if(handles_, [&](const SweepHandle& handle) {
    SweepArc& arc = arcs_[handle.arc];
    const auto is_at = [&](Index node) {
      const double start = nodes_[first[node]].event.time;
      return handle.time >= start && handle.time - start <= tolerance;
    };
    // The values of an arc at its ends exclude the vertices at exactly the times of its ends.
    if (is_at(arc.from)) {
      nodes_[arc.from].event.euler_change += handle.euler_change;
      if (handle.time > nodes_[arc.from].event.time) arc.euler_at_start += handle.euler_change;
      return true;
    }
    if (!is_at(arc.to)) return false;
    nodes_[arc.to].event.euler_change += handle.euler_change;
    if (handle.time < nodes_[arc.to].event.time) arc.euler_at_end -= handle.euler_change;
    return true;
  });
}

void SweptGraph::remove(Index a) {
  states_[a] = {Kind::gone, kNone};
  Node& from = nodes_[arcs_[a].from];
  Node& to = nodes_[arcs_[a].to];
  std::erase(from.out, a);
  std::erase(to.in, a);
  from.event.euler_change -= arcs_[a].euler_at_start;
  to.event.euler_change += arcs_[a].euler_at_end;
}

Index SweptGraph::splice(Index node) {
  Node& here = nodes_[node];
  if (here.in.size() != 1 || here.out.size() != 1) return kNone;
  const Index kept = here.in[0];
  const Index joined = here.out[0];
  SweepArc& arc = arcs_[kept];
  arc.to = arcs_[joined].to;
  arc.size_at_end = arcs_[joined].size_at_end;
  arc.euler_at_end = arcs_[joined].euler_at_end;
  states_[joined] = {Kind::part_of, kept};
  auto& in = nodes_[arc.to].in;
  in.erase(std::find(in.begin(), in.end(), joined));
  in.insert(std::lower_bound(in.begin(), in.end(), kept), kept);
  handles_.push_back(
      {here.event.vertex, here.event.time, here.event.reported, kept, here.event.at_border, here.event.euler_change});
  here.passing = kept;
  here.in.clear();
  here.out.clear();
  return kept;
}

bool SweptGraph::is_prunable(Index a) const {
  const Node& from = nodes_[arcs_[a].from];
  const Node& to = nodes_[arcs_[a].to];
  const bool starts = from.in.empty() && from.out.size() == 1;
  const bool ends = to.out.empty() && to.in.size() == 1;
  if (starts && ends) return true;               // an isolated arc
  if (starts && to.in.size() >= 2) return true;  // merges into others
  if (ends && from.out.size() >= 2) return true;
  // One branch of a loop: the smaller one, or the later one of two equal ones.
  return std::any_of(from.out.begin(), from.out.end(), [&](Index b) {
    return b != a && arcs_[b].to == arcs_[a].to &&
           std::pair(arcs_[b].size_at_start, a) > std::pair(arcs_[a].size_at_start, b);
  });
}

void SweptGraph::prune(double lifetime) {
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> shortest;
  const auto add = [&](Index a) {
    if (is_left(a) && length(a) < lifetime) shortest.emplace(length(a), a);
  };
  for (Index a = 0; a < arcs_.size(); ++a) add(a);
  while (!shortest.empty()) {
    const auto [time, a] = shortest.top();
    shortest.pop();
    if (!is_left(a) || length(a) != time || !is_prunable(a)) continue;
    const std::array<Index, 2> ends{arcs_[a].from, arcs_[a].to};
    remove(a);
    // Arcs at the ends may have become removable.
    const auto add_all_at = [&](Index node) {
      for (const Index b : nodes_[node].in) add(b);
      for (const Index b : nodes_[node].out) add(b);
    };
    for (const Index end : ends) {
      const Index grown = splice(end);
      add_all_at(grown == kNone ? end : arcs_[grown].from);
      if (grown != kNone) add_all_at(arcs_[grown].to);
    }
  }
}

Index SweptGraph::represent(Index a) const {
  while (true) {
    switch (states_[a].kind) {
      case Kind::left:
        return a;
      case Kind::gone:
        return kNone;
      case Kind::part_of:
        a = states_[a].of;
        break;
      case Kind::in_node: {  // the largest arc that starts there, else an arc that ends there
        const Node& node = nodes_[states_[a].of];
        if (node.passing != kNone) {
          a = node.passing;
          break;
        }
        const auto smaller = [&](Index b, Index c) { return arcs_[b].size_at_start < arcs_[c].size_at_start; };
        if (!node.out.empty()) return *std::max_element(node.out.begin(), node.out.end(), smaller);
        return node.in.empty() ? kNone : node.in.front();
      }
    }
  }
}

std::vector<SweepHandle> SweptGraph::handles() const {
  std::vector<SweepHandle> result;
  for (SweepHandle handle : handles_) {
    handle.arc = represent(handle.arc);
    if (handle.arc != kNone) result.push_back(handle);
  }
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.arc, a.time, a.vertex) < std::tuple(b.arc, b.time, b.vertex);
  });
  std::size_t kept = 0;
  for (const SweepHandle& handle : result) {
    if (kept > 0 && result[kept - 1].arc == handle.arc && result[kept - 1].time == handle.time)
      result[kept - 1].euler_change += handle.euler_change;
    else
      result[kept++] = handle;
  }
  result.resize(kept);
  std::erase_if(result, [](const SweepHandle& handle) { return handle.euler_change == 0; });
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.time, a.vertex, a.arc) < std::tuple(b.time, b.vertex, b.arc);
  });
  return result;
}

}  // namespace tegl::detail
