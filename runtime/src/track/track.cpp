// SPDX-License-Identifier: BSD-3-Clause
//
// Tracks of components through time: simplifies the graph of the sweep, and assigns events, segments and tracks.
#include "tegl/track.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include <fmt/format.h>

#include "base/function_ref.hpp"
#include "base/progress.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/simplex_geometry.hpp"
#include "mesh/validate.hpp"
#include "track/track_graph.hpp"
#include "track/track_sweep.hpp"

namespace tegl {
namespace {

using detail::kNone;
using detail::SweepResult;
using detail::SweptGraph;

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); }

void require_sound(const TrackOptions& options) {
  if (!(options.min_lifetime >= 0) || !std::isfinite(options.min_lifetime))
    refuse(fmt::format("min_lifetime is {}; expected 0 or more", options.min_lifetime));
  for (const std::optional<double>& end : {options.first, options.last})
    if (end && !std::isfinite(*end)) refuse(fmt::format("the data begin or end at {}; expected a finite time", *end));
  if (options.first && options.last && *options.first > *options.last)
    refuse(fmt::format("the data begin at {} and end at {}; expected the reverse", *options.first, *options.last));
  for (std::size_t i = 0; i < options.times.size(); ++i) {
    if (!std::isfinite(options.times[i]))
      refuse(fmt::format("times[{}] is {}; expected a number", i, options.times[i]));
    if (i > 0 && options.times[i] <= options.times[i - 1])
      refuse(fmt::format("times[{}] is {}, after {}; expected ascending times", i, options.times[i],
                         options.times[i - 1]));
  }
}

template <int N, class Real>
void require_sound(const Contour<N, Real>& contour) {
  for (const Period<N>& period : contour.periods)
    if (period.vector[N - 1] != 0.0 || period.dual[N - 1] != 0.0)
      refuse("the last axis, the time, is periodic or not separate from a periodic axis; expected other periodic axes");
  detail::require_vertices(contour);
  detail::require_finite(contour);
}

/// The contour of a sweep, for any dimension.
struct SweptContour {
  std::span<const std::string> axis_names;  ///< one per axis
  std::span<const std::string> axis_units;
  detail::FunctionRef<double(Index vertex, int axis)> coordinate;

  [[nodiscard]] int last_axis() const noexcept { return static_cast<int>(axis_names.size()) - 1; }
};

/// Builds the result and converts the sweep's numbers to the numbers of the result.
class Builder {
 public:
  Builder(const SweptContour& contour, const TrackOptions& options, SweepResult&& swept)
      : contour_(contour),
        options_(options),
        first_(swept.first),
        last_(swept.last),
        tolerance_(swept.tolerance),
        samples_(std::move(swept.samples)),
        simplex_arcs_(std::move(swept.simplex_arcs)),
        graph_(std::move(swept.nodes), std::move(swept.arcs), std::move(swept.handles)) {}

  TrackGraph build() {
    describe();
    tell(0.1);
    graph_.contract(tolerance_);
    tell(0.3);
    graph_.prune(std::max(options_.min_lifetime, tolerance_));
    tell(0.5);
    add_events();
    add_segments();
    for (TrackEvent& event : result_.events) finish(event);
    tell(0.6);
    follow();
    if (options_.handles) add_handles();
    tell(0.8);
    add_samples();
    label();
    tell(1.0);
    return std::move(result_);
  }

 private:
  /// Reports this fraction of the progress that remains after the sweep.
  void tell(double share) const {
    detail::tell(options_.work.progress, share < 1.0 ? detail::kSwept + (1.0 - detail::kSwept) * share : 1.0,
                 "tracking was cancelled");
  }

  void describe() {
    result_.space_dim = static_cast<int>(contour_.axis_names.size());
    std::copy(contour_.axis_names.begin(), contour_.axis_names.end(), result_.axis_names.begin());
    std::copy(contour_.axis_units.begin(), contour_.axis_units.end(), result_.axis_units.begin());
    result_.first = options_.first.value_or(first_);
    result_.last = options_.last.value_or(last_);
  }

  void add_events() {
    event_of_node_.assign(graph_.nodes().size(), kNone);
    for (Index i = 0; i < graph_.nodes().size(); ++i) {
      const SweptGraph::Node& node = graph_.nodes()[i];
      if (node.in.empty() && node.out.empty()) continue;
      event_of_node_[i] = static_cast<Index>(result_.events.size());
      node_of_event_.push_back(i);
      TrackEvent& event = result_.events.emplace_back();
      event.time = node.event.reported;
      event.vertex = node.event.vertex;
      event.place = place(event.vertex);
      event.at_border = node.event.at_border;
      event.euler_change = node.event.euler_change;
    }
  }

  void add_segments() {
    std::vector<Index> arcs;
    for (Index a = 0; a < graph_.arc_count(); ++a)
      if (graph_.is_left(a)) arcs.push_back(a);
    std::sort(arcs.begin(), arcs.end(),
              [&](Index a, Index b) { return std::pair(graph_.arc(a).from, a) < std::pair(graph_.arc(b).from, b); });
    segment_of_arc_.assign(graph_.arc_count(), kNone);
    for (const Index a : arcs) {
      const detail::SweepArc& arc = graph_.arc(a);
      segment_of_arc_[a] = static_cast<Index>(result_.segments.size());
      TrackSegment& segment = result_.segments.emplace_back();
      segment.from = event_of_node_[arc.from];
      segment.to = event_of_node_[arc.to];
      segment.start = result_.events[segment.from].time;
      segment.end = result_.events[segment.to].time;
      segment.size_at_start = arc.size_at_start;
      segment.size_at_end = arc.size_at_end;
      segment.euler_at_start = arc.euler_at_start;
      segment.euler_at_end = arc.euler_at_end;
    }
    for (Index s = 0; s < result_.segments.size(); ++s) {
      result_.events[result_.segments[s].from].out.push_back(s);
      result_.events[result_.segments[s].to].in.push_back(s);
    }
  }

  void finish(TrackEvent& event) const {
    const auto number = static_cast<std::size_t>(&event - result_.events.data());
    const detail::Flatness flatness = graph_.nodes()[node_of_event_[number]].event.flatness;
    const auto one_sided = [&](double limit, bool given, TrackEventKind at_limit, TrackEventKind at_border,
                               TrackEventKind inside) {
      const bool flat = flatness == detail::Flatness::border || (given && flatness == detail::Flatness::simplex);
      if (flat && std::abs(event.time - limit) <= tolerance_) return at_limit;
      return event.at_border ? at_border : inside;
    };
    if (event.in.empty())
      event.kind = one_sided(result_.first, options_.first.has_value(), TrackEventKind::begin, TrackEventKind::enter,
                             TrackEventKind::birth);
    else if (event.out.empty())
      event.kind = one_sided(result_.last, options_.last.has_value(), TrackEventKind::end, TrackEventKind::leave,
                             TrackEventKind::death);
    else if (event.out.size() == 1)
      event.kind = TrackEventKind::merge;
    else
      event.kind = event.in.size() == 1 ? TrackEventKind::split : TrackEventKind::exchange;
  }

  /// Assigns a track to each segment. Events are sorted by time, so incoming segments already have one.
  void follow() {
    const auto largest = [&](const std::vector<Index>& segments, auto size) {
      return *std::max_element(segments.begin(), segments.end(), [&](Index a, Index b) {
        return std::pair(result_.segments[a].*size, b) < std::pair(result_.segments[b].*size, a);
      });
    };
    for (const TrackEvent& event : result_.events) {
      Index heir = kNone;
      if (!event.in.empty() && !event.out.empty()) {
        heir = largest(event.out, &TrackSegment::size_at_start);
        extend(result_.segments[largest(event.in, &TrackSegment::size_at_end)].track, heir);
      }
      for (const Index s : event.out) {
        if (s == heir) continue;
        const auto number = static_cast<Index>(result_.tracks.size());
        result_.tracks.push_back({number, {}, event.time, event.time});
        extend(number, s);
      }
    }
  }

  void extend(Index track, Index segment) {
    result_.segments[segment].track = track;
    result_.tracks[track].segments.push_back(segment);
    result_.tracks[track].end = result_.segments[segment].end;
  }

  void add_handles() {
    for (const detail::SweepHandle& handle : graph_.handles())
      result_.handles.push_back({handle.reported, place(handle.vertex), handle.vertex, handle.at_border,
                                 segment_of_arc_[handle.arc], handle.euler_change});
  }

  void add_samples() {
    for (const detail::SweepSample& sample : samples_) {
      const Index arc = graph_.represent(sample.arc);
      if (arc != kNone) result_.segments[segment_of_arc_[arc]].samples.push_back(sample.sample);
    }
  }

  void label() {
    result_.simplex_segments = std::move(simplex_arcs_);
    for (Index& label : result_.simplex_segments) {
      const Index arc = label == kNone ? kNone : graph_.represent(label);
      label = arc == kNone ? TrackGraph::kNoSegment : segment_of_arc_[arc];
    }
  }

  [[nodiscard]] std::array<double, 4> place(Index v) const {
    std::array<double, 4> result{};
    for (int a = 0; a < contour_.last_axis(); ++a) result[a] = contour_.coordinate(v, a);
    return result;
  }

  const SweptContour& contour_;
  const TrackOptions& options_;
  double first_, last_;  ///< times of the contour
  double tolerance_;     ///< times that differ by at most this may be equal up to rounding
  std::vector<detail::SweepSample> samples_;
  std::vector<Index> simplex_arcs_;
  SweptGraph graph_;
  std::vector<Index> event_of_node_;
  std::vector<Index> node_of_event_;
  std::vector<Index> segment_of_arc_;
  TrackGraph result_;
};

/// By number: the new number if it is kept, else kNone.
std::vector<Index> renumber(const std::vector<bool>& keep) {
  std::vector<Index> numbers(keep.size(), kNone);
  Index next = 0;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) numbers[i] = next++;
  return numbers;
}

void renumber_all(std::vector<Index>& list, const std::vector<Index>& numbers) {
  for (Index& i : list) i = numbers[i];
  std::erase(list, kNone);
}

/// The number of tracks of an event that are not kept.
Index count_left_out(const TrackGraph& graph, const TrackEvent& event, const std::vector<bool>& keep) {
  std::vector<Index> tracks;
  for (const auto* list : {&event.in, &event.out})
    for (const Index s : *list)
      if (const Index track = graph.segments[s].track; !keep[track]) tracks.push_back(track);
  std::sort(tracks.begin(), tracks.end());
  return static_cast<Index>(std::unique(tracks.begin(), tracks.end()) - tracks.begin());
}

template <class T>
void keep_only(std::vector<T>& list, const std::vector<Index>& numbers) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (numbers[i] != kNone && numbers[i] != i) list[numbers[i]] = std::move(list[i]);
  list.resize(
      static_cast<std::size_t>(std::count_if(numbers.begin(), numbers.end(), [](Index i) { return i != kNone; })));
}

}  // namespace

std::string_view name_of(TrackEventKind kind) noexcept {
  constexpr std::array kNames{"begin", "birth", "enter", "end", "death", "leave", "merge", "split", "exchange"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<double> even_times(double first, double last, std::size_t count) {
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i)
    times[i] = first + (last - first) * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  return times;
}

namespace {

/// `incidence`: null if it is not known.
template <int N, class Real>
TrackGraph track_with(const Contour<N, Real>& contour, const detail::IncidenceData<N>* incidence,
                      const TrackOptions& options) {
  require_sound(options);
  require_sound(contour);
  const detail::SimplexView<N> view(contour);
  if (incidence != nullptr) detail::require_incidence<N>(*incidence, view.rows(), view.vertex_count());
  const auto coordinate = [&](Index vertex, int axis) { return view.coordinate(vertex, axis); };
  const SweptContour swept{contour.axis_names, contour.axis_units, coordinate};
  return Builder(swept, options, detail::sweep(contour, incidence, options)).build();
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> TrackGraph track(const Contour<N, Real>& contour, const TrackOptions& options) {
  return track_with<N, Real>(contour, nullptr, options);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> TrackGraph track(const Contour<N, Real>& contour, const Incidence<N>& incidence,
                                                    const TrackOptions& options) {
  return track_with<N, Real>(contour, &incidence.data(), options);
}

TrackGraph select_tracks(const TrackGraph& graph, const std::vector<bool>& keep) {
  if (keep.size() != graph.tracks.size())
    refuse(fmt::format("{} choices of tracks; expected {}, one for each track", keep.size(), graph.tracks.size()));
  TrackGraph result = graph;
  std::vector<bool> keep_segment(graph.segments.size());
  std::vector<bool> keep_event(graph.events.size(), false);
  for (std::size_t s = 0; s < graph.segments.size(); ++s) {
    const TrackSegment& segment = graph.segments[s];
    keep_segment[s] = keep[segment.track];
    if (keep_segment[s]) keep_event[segment.from] = keep_event[segment.to] = true;
  }
  // new numbers
  const std::vector<Index> tracks = renumber(keep);
  const std::vector<Index> segments = renumber(keep_segment);
  const std::vector<Index> events = renumber(keep_event);
  keep_only(result.tracks, tracks);
  keep_only(result.segments, segments);
  keep_only(result.events, events);
  // renumber the references
  for (Track& track : result.tracks) renumber_all(track.segments, segments);
  for (TrackSegment& segment : result.segments) {
    segment.from = events[segment.from];
    segment.to = events[segment.to];
    segment.track = tracks[segment.track];
  }
  for (TrackEvent& event : result.events) {
    event.left_out += count_left_out(graph, event, keep);
    renumber_all(event.in, segments);
    renumber_all(event.out, segments);
  }
  std::erase_if(result.handles, [&](const TrackHandle& handle) { return segments[handle.segment] == kNone; });
  for (TrackHandle& handle : result.handles) handle.segment = segments[handle.segment];
  for (Index& label : result.simplex_segments) label = label == TrackGraph::kNoSegment ? label : segments[label];
  return result;
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real)                            \
  template TrackGraph track(const Contour<N, Real>&, const TrackOptions&); \
  template TrackGraph track(const Contour<N, Real>&, const Incidence<N>&, const TrackOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
