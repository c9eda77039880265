// SPDX-License-Identifier: BSD-3-Clause
//
// The graph of components over time against slices: at a time between any two events the slice's components are
// compared one by one. The parts of the contour between two such times must connect the components as the event between
// them states.
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"
#include "tegl/track.hpp"

namespace tegl {
namespace {

class Sets {
 public:
  explicit Sets(std::size_t n) : parents_(n) { std::iota(parents_.begin(), parents_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parents_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parents_;
};

/// Sets of simplices connected within from <= t <= to: by a vertex or an edge that lies at least partly in the
/// interval. Simplices outside the interval are singletons.
template <int N>
Sets connected_between(const Contour<N, double>& contour, double from, double to) {
  Sets sets(contour.simplices.size());
  std::map<std::pair<Index, Index>, std::size_t> owners;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (const Index a : contour.simplices[s])
      for (const Index b : contour.simplices[s]) {
        const auto [low, high] = std::minmax(contour.vertices[a][N - 1], contour.vertices[b][N - 1]);
        if (a > b || low > to || high < from) continue;
        sets.join(s, owners.emplace(std::pair(a, b), s).first->second);
      }
  return sets;
}

/// A component of the slice at a time: the contour's simplices that it meets, and the slice's simplices.
template <int N>
struct Part {
  std::vector<std::size_t> simplices;
  Contour<N - 1, double> cut;
};

template <int N>
std::vector<Part<N>> parts_at(const Contour<N, double>& contour, double time) {
  Sets sets = connected_between(contour, time, time);
  std::map<std::size_t, Part<N>> parts;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
    bool below = false;
    bool above = false;
    for (const Index v : contour.simplices[s]) (contour.vertices[v][N - 1] < time ? below : above) = true;
    if (below && above) parts[sets.find(s)].simplices.push_back(s);
  }
  std::vector<Part<N>> result;
  for (auto& [set, part] : parts) {
    Contour<N, double> alone = contour;
    alone.simplices.clear();
    for (const std::size_t s : part.simplices) alone.simplices.push_back(contour.simplices[s]);
    part.cut = slice(alone, Hyperplane<N>::across(N - 1, time));
    result.push_back(std::move(part));
  }
  return result;
}

template <int D>
TrackSample measured(const Contour<D, double>& cut) {
  TrackSample sample;
  sample.measure = test::measure(cut);
  for (int a = 0; a < D; ++a) {
    const auto less = [a](const auto& u, const auto& v) { return u[a] < v[a]; };
    sample.lower[a] = (*std::min_element(cut.vertices.begin(), cut.vertices.end(), less))[a];
    sample.upper[a] = (*std::max_element(cut.vertices.begin(), cut.vertices.end(), less))[a];
    for (std::size_t s = 0; s < cut.simplices.size(); ++s)
      for (const Index v : cut.simplices[s])
        sample.centroid[a] += test::simplex_measure(cut, s) * cut.vertices[v][a] / D / sample.measure;
  }
  if (check(cut).boundary_simplices == 0) sample.content = test::enclosed_content(cut);
  return sample;
}

/// The graph's segments at one time, matched by their measures; components and segments correspond one to one.
template <int N>
std::vector<Index> segments_of(const std::vector<Part<N>>& parts, const TrackGraph& graph, double time) {
  std::vector<Index> found;
  std::map<Index, const TrackSample*> alive;
  for (Index s = 0; s < graph.segments.size(); ++s)
    for (const TrackSample& sample : graph.segments[s].samples)
      if (sample.time == time) alive[s] = &sample;
  EXPECT_EQ(alive.size(), parts.size()) << "at " << time;
  for (const Part<N>& part : parts) {
    const TrackSample expected = measured(part.cut);
    const auto distance = [&](const TrackSample& sample) {
      double sum = std::abs(sample.measure - expected.measure);
      for (int a = 0; a < N - 1; ++a) {
        sum += std::abs(sample.lower[a] - expected.lower[a]) + std::abs(sample.upper[a] - expected.upper[a]);
        // If samples equal the isovalue, components may have zero size and then no centroid.
        if (expected.measure > 1e-12) sum += std::abs(sample.centroid[a] - expected.centroid[a]);
      }
      return sum;
    };
    Index best = TrackGraph::kNoSegment;
    for (const auto& [s, sample] : alive)
      if (best == TrackGraph::kNoSegment || distance(*sample) < distance(*alive[best])) best = s;
    if (best == TrackGraph::kNoSegment) break;
    EXPECT_LT(distance(*alive[best]), 5e-8) << "at " << time;  // limited by the square roots of `measure`
    if (expected.measure > 1e-12) {
      EXPECT_EQ(std::isnan(alive[best]->content), std::isnan(expected.content)) << "at " << time;
    }
    if (!std::isnan(expected.content)) {
      EXPECT_NEAR(alive[best]->content, expected.content, 1e-9) << "at " << time;
    }
    found.push_back(best);
    alive.erase(best);
  }
  return found;
}

/// One time between any two consecutive events.
std::vector<double> times_between(const TrackGraph& graph) {
  std::set<double> happenings;
  for (const TrackEvent& event : graph.events) happenings.insert(event.time);
  for (const TrackHandle& handle : graph.handles) happenings.insert(handle.time);
  std::vector<double> times;
  for (auto at = happenings.begin(); at != happenings.end(); ++at)
    if (const auto next = std::next(at); next != happenings.end() && *next - *at > 1e-9)
      times.push_back(0.5 * (*at + *next));
  return times;
}

std::int64_t euler_at(const TrackGraph& graph, double time) {
  std::int64_t euler = 0;
  for (const TrackSegment& segment : graph.segments)
    if (segment.start < time && time < segment.end) euler += segment.euler_at_start;
  for (const TrackHandle& handle : graph.handles) {
    const TrackSegment& segment = graph.segments[handle.segment];
    if (handle.time < time && segment.start < time && time < segment.end) euler += handle.euler_change;
  }
  return euler;
}

/// Connections between the components at one time and the next: sets of segments, by the contour and by the graph.
using Joined = std::set<std::pair<std::set<Index>, std::set<Index>>>;

template <int N>
Joined joined_by_contour(const Contour<N, double>& contour, const std::array<double, 2>& times,
                         const std::array<std::vector<Part<N>>, 2>& parts,
                         const std::array<std::vector<Index>, 2>& segments) {
  Sets sets = connected_between(contour, times[0], times[1]);
  std::map<std::size_t, std::pair<std::set<Index>, std::set<Index>>> groups;
  for (std::size_t i = 0; i < parts[0].size(); ++i)
    groups[sets.find(parts[0][i].simplices[0])].first.insert(segments[0][i]);
  for (std::size_t i = 0; i < parts[1].size(); ++i)
    groups[sets.find(parts[1][i].simplices[0])].second.insert(segments[1][i]);
  Joined joined;
  for (const auto& [set, group] : groups) joined.insert(group);
  return joined;
}

Joined joined_by_graph(const TrackGraph& graph, const std::array<double, 2>& times,
                       const std::array<std::vector<Index>, 2>& segments) {
  Joined joined;
  for (const Index s : segments[0])
    if (graph.segments[s].end > times[1]) joined.insert({{s}, {s}});
  for (const TrackEvent& event : graph.events)
    if (event.time > times[0] && event.time < times[1])
      joined.insert({{event.in.begin(), event.in.end()}, {event.out.begin(), event.out.end()}});
  return joined;
}

/// Compares the whole graph with slices.
template <int N>
TrackGraph expect_right(const Contour<N, double>& contour) {
  TrackOptions options;
  options.times = times_between(track(contour));
  const TrackGraph graph = track(contour, options);
  std::array<std::vector<Part<N>>, 2> parts;
  std::array<std::vector<Index>, 2> segments;
  for (std::size_t i = 0; i < options.times.size(); ++i) {
    const double time = options.times[i];
    parts[0] = std::exchange(parts[1], parts_at(contour, time));
    segments[0] = std::exchange(segments[1], segments_of(parts[1], graph, time));
    const MeshReport report = check(slice(contour, Hyperplane<N>::across(N - 1, time)));
    EXPECT_EQ(report.components, parts[1].size()) << "at " << time;
    EXPECT_EQ(report.euler, euler_at(graph, time)) << "at " << time;
    if (segments[1].size() != parts[1].size()) return graph;
    if (i == 0) continue;
    const std::array<double, 2> times{options.times[i - 1], time};
    EXPECT_EQ(joined_by_contour(contour, times, parts, segments), joined_by_graph(graph, times, segments))
        << "between " << times[0] << " and " << times[1];
  }
  return graph;
}

/// Invariants of every graph.
template <int N, class Real>
void expect_consistent(const Contour<N, Real>& contour, const TrackGraph& graph) {
  std::vector<std::int64_t> handles(graph.segments.size());
  for (const TrackHandle& handle : graph.handles) handles[handle.segment] += handle.euler_change;
  for (std::size_t s = 0; s < graph.segments.size(); ++s) {
    const TrackSegment& segment = graph.segments[s];
    EXPECT_LT(segment.start, segment.end);
    EXPECT_GT(segment.size_at_start, 0u);
    EXPECT_GT(segment.size_at_end, 0u);
    EXPECT_EQ(segment.euler_at_end - segment.euler_at_start, handles[s]) << "segment " << s;
  }
  Sets components(graph.events.size());
  for (const TrackSegment& segment : graph.segments) components.join(segment.from, segment.to);
  std::uint64_t count = 0;
  for (std::size_t e = 0; e < graph.events.size(); ++e) {
    count += components.find(e) == e ? 1 : 0;
    const TrackEvent& event = graph.events[e];
    std::int64_t change = 0;
    for (const Index s : event.out) change += graph.segments[s].euler_at_start;
    for (const Index s : event.in) change -= graph.segments[s].euler_at_end;
    EXPECT_EQ(event.euler_change, change) << "event " << e;
    EXPECT_FALSE(event.in.size() == 1 && event.out.size() == 1);
    EXPECT_LE(graph.events[e > 0 ? e - 1 : 0].time, event.time);
  }
  const MeshReport report = check(contour);
  EXPECT_EQ(count, report.components);
  // The Reeb graph of a closed oriented surface has as many loops as the surface has handles, except handles within one
  // time.
  const auto loops = static_cast<std::int64_t>(graph.segments.size() + count - graph.events.size());
  EXPECT_GE(loops, 0);
  if (N == 3 && report.boundary_simplices == 0) {
    EXPECT_LE(2 * loops, 2 * static_cast<std::int64_t>(count) - report.euler);
  }
}

template <int N>
Contour<N, double> noise_contour(std::array<std::size_t, N> sizes, std::uint64_t seed, bool close) {
  ExtractOptions options;
  options.close = close;
  options.triangulation = seed % 2 == 0 ? Triangulation::compact : Triangulation::barycentric;
  return extract<double>(view_of(test::noise<float, N>(sizes, seed)), 0.5, options);
}

TEST(TrackNoise, In3dAgreesWithEveryCut) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const auto contour = noise_contour<3>({9, 8, 7}, seed, seed <= 3);
    test::expect_oriented_manifold(contour);
    expect_consistent(contour, expect_right(contour));
  }
}

TEST(TrackNoise, In5dAgreesWithEveryCut) {
  for (const bool close : {false, true}) {
    const auto image = test::noise<float, 5>({3, 3, 3, 3, 4}, close ? 3 : 2);
    const auto contour = extract<double>(view_of(image), 0.75, {.close = close});
    expect_consistent(contour, expect_right(contour));
  }
}

TEST(TrackNoise, In4dAgreesWithEveryCut) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const auto contour = noise_contour<4>({5, 4, 4, 4}, seed, seed <= 3);
    test::expect_oriented_manifold(contour);
    expect_consistent(contour, expect_right(contour));
  }
}

TEST(TrackNoise, OfFewValuesAgreesWithEveryCut) {
  // Many samples equal the isovalue: vertices coincide, and many have equal times.
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const auto image = test::coarse_noise<std::uint8_t, 4>(Grid<4>::unit({5, 4, 4, 5}), seed, 3);
    const auto contour = extract<double>(image.view(), 1.0);
    expect_consistent(contour, expect_right(contour));
  }
}

TEST(TrackNoise, WithMissingValuesAgreesWithEveryCut) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const auto image = test::noise_with_missing<float, 4>(Grid<4>::unit({4, 4, 4, 4}), seed, 0.02);
    const auto contour = extract<double>(image.view(), 0.5);
    expect_consistent(contour, expect_right(contour));
  }
}

TEST(TrackNoise, InThePlaneAgreesWithEveryCut) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const auto contour = noise_contour<2>({9, 9}, seed, seed % 2 == 0);
    expect_consistent(contour, track(contour));
  }
}

TEST(TrackNoise, LoopsOfAClosedSurfaceAreItsHandles) {
  // Cole-McLaughlin et al., Loops in Reeb graphs of 2-manifolds, 2003: the number of loops is the genus, if no two
  // critical vertices have equal times.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    Contour<3, double> contour = noise_contour<3>({12, 12, 12}, seed, true);
    std::mt19937_64 bits(seed);
    for (auto& vertex : contour.vertices) vertex[2] += 1e-3 * test::unit_random(bits);
    const TrackGraph graph = track(contour);
    const MeshReport report = test::expect_closed_manifold(contour);
    const auto loops = static_cast<std::int64_t>(graph.segments.size() + report.components - graph.events.size());
    EXPECT_EQ(2 * loops, 2 * static_cast<std::int64_t>(report.components) - report.euler);
    EXPECT_GT(loops, 10);
  }
}

}  // namespace
}  // namespace tegl
