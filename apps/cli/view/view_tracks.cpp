// SPDX-License-Identifier: BSD-3-Clause
//
// Computes the tracks of a page, and the part of the cut that contains each simplex at any time, for colours. The graph
// gives the segment in which a simplex first appears. After a merge the next segment is unique. After a split, the
// simplices that extend beyond it are assigned to parts by their connectivity just after it.
#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "tegl/tile/disjoint_sets.hpp"
#include "view/view_page.hpp"

namespace tegl::cli {

namespace {

constexpr Index kNone = TrackGraph::kNoSegment;

/// The segment that continues a part after this segment: the only one, or the one of the same track.
Index next_segment(const TrackGraph& graph, const TrackSegment& segment) {
  const std::vector<Index>& out = graph.events[segment.to].out;
  if (out.size() == 1) return out.front();
  for (const Index s : out)
    if (graph.segments[s].track == segment.track) return s;
  return kNone;
}

class Splits {
 public:
  Splits(const Contour<4, double>& contour, const TrackGraph& graph)
      : contour_(contour), graph_(graph), first_at_(contour.vertices.size(), kNone) {}

  /// #S: the segment of each simplex after the first split that it passes; kNone if it passes none.
  std::vector<Index> after() {
    std::vector<std::vector<Index>> passing(graph_.events.size());
    for (std::size_t s = 0; s < contour_.simplices.size(); ++s) {
      if (graph_.simplex_segments[s] == kNone) continue;
      const auto& simplex = contour_.simplices[s];
      const auto [lowest, highest] = std::minmax_element(simplex.begin(), simplex.end(), [&](Index a, Index b) {
        return std::pair(time(a), a) < std::pair(time(b), b);
      });
      first_at_[*lowest] = static_cast<Index>(s);
      if (const Index event = first_split(graph_.simplex_segments[s], time(*highest)); event != kNone)
        passing[event].push_back(static_cast<Index>(s));
    }
    std::vector<Index> result(contour_.simplices.size(), kNone);
    for (std::size_t e = 0; e < passing.size(); ++e)
      if (!passing[e].empty()) tell_apart(static_cast<Index>(e), passing[e], result);
    return result;
  }

 private:
  [[nodiscard]] double time(Index v) const { return contour_.vertices[v][3]; }

  /// The first split of a part from this segment on, before time `until`; kNone if there is none.
  [[nodiscard]] Index first_split(Index segment, double until) const {
    while (graph_.segments[segment].end < until) {
      const Index event = graph_.segments[segment].to;
      const std::vector<Index>& out = graph_.events[event].out;
      if (out.empty()) return kNone;
      if (out.size() > 1) return event;
      segment = out.front();
    }
    return kNone;
  }

  /// Assigns simplices that pass a split to the parts after it: two are in one part if the cut just after it crosses an
  /// edge that they share.
  void tell_apart(Index event, const std::vector<Index>& simplices, std::vector<Index>& result) {
    const double at = graph_.events[event].time;
    struct Crossed {
      Index low, high;
      std::size_t simplex;  // its index in `simplices`
    };
    std::vector<Crossed> crossed;
    for (std::size_t i = 0; i < simplices.size(); ++i)
      for (const Index low : contour_.simplices[simplices[i]])
        for (const Index high : contour_.simplices[simplices[i]])
          if (time(low) <= at && time(high) > at) crossed.push_back({low, high, i});
    std::sort(crossed.begin(), crossed.end(), [&](const Crossed& a, const Crossed& b) {
      return std::tuple(time(a.high), a.high, a.low, a.simplex) < std::tuple(time(b.high), b.high, b.low, b.simplex);
    });
    sets_.reset(simplices.size());
    for (std::size_t i = 1; i < crossed.size(); ++i)
      if (crossed[i].low == crossed[i - 1].low && crossed[i].high == crossed[i - 1].high)
        sets_.join(crossed[i].simplex, crossed[i - 1].simplex);
    // The next simplex that appears at an edge's upper vertex is in the same part as that vertex; the earliest one with
    // a known segment decides.
    std::vector<Index> parts(simplices.size(), kNone);
    for (const Crossed& edge : crossed) {
      Index& part = parts[sets_.find(edge.simplex)];
      if (part == kNone && first_at_[edge.high] != kNone)
        part = out_of(event, graph_.simplex_segments[first_at_[edge.high]]);
    }
    for (std::size_t i = 0; i < simplices.size(); ++i) result[simplices[i]] = parts[sets_.find(i)];
  }

  /// The segment starting at the event that leads to this segment without merges; kNone if it is not unique.
  [[nodiscard]] Index out_of(Index event, Index segment) const {
    while (segment != kNone && graph_.segments[segment].from != event) {
      const std::vector<Index>& in = graph_.events[graph_.segments[segment].from].in;
      if (in.size() != 1) return kNone;
      segment = in.front();
    }
    return segment;
  }

  const Contour<4, double>& contour_;
  const TrackGraph& graph_;
  std::vector<Index> first_at_;  ///< #V: a simplex whose lowest vertex this is
  detail::BasicDisjointSets<std::size_t> sets_;
};

}  // namespace

PageTracks page_tracks(const Contour<4, double>& contour, std::optional<double> first, std::optional<double> last,
                       std::size_t most, const WorkOptions& options) {
  // track
  TrackOptions wanted;
  wanted.first = first;
  wanted.last = last;
  wanted.handles = false;
  wanted.label_simplices = true;
  wanted.work = options;
  const TrackGraph graph = track(contour, wanted);
  // order tracks by lifetime
  PageTracks result;
  result.found = graph.tracks.size();
  std::vector<std::size_t> order(graph.tracks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto life = [&](std::size_t t) { return graph.tracks[t].end - graph.tracks[t].start; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return life(a) > life(b); });
  std::vector<std::uint32_t> place(order.size());
  std::vector<bool> keep(order.size(), false);
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<std::uint32_t>(i);
    keep[order[i]] = i < most;
  }
  // data for colours
  result.simplex_segments = graph.simplex_segments;
  result.simplex_after = Splits(contour, graph).after();
  for (const TrackSegment& segment : graph.segments) {
    result.ends.push_back(segment.end);
    result.splits.push_back(graph.events[segment.to].out.size() > 1 ? 1 : 0);
    result.next.push_back(next_segment(graph, segment));
    result.tracks.push_back(place[segment.track]);
  }
  // events of the shown tracks
  result.events_found = graph.events.size();
  const auto is_shown = [&](Index s) { return static_cast<bool>(keep[graph.segments[s].track]); };
  for (const TrackEvent& event : graph.events)  // the events that select_tracks keeps, in its order
    if (std::any_of(event.in.begin(), event.in.end(), is_shown) ||
        std::any_of(event.out.begin(), event.out.end(), is_shown))
      result.event_parts.push_back({event.in.size(), event.out.size()});
  result.graph = select_tracks(graph, keep);
  result.graph.simplex_segments.clear();
  return result;
}

}  // namespace tegl::cli
