// SPDX-License-Identifier: BSD-3-Clause
//
// The graph of components over time for fields with known events, and its options.
#include "tegl/track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using test::Point;
using testing::DoubleNear;
using testing::ElementsAre;
using Kind = TrackEventKind;

/// `samples` samples along each spatial axis from -half to half, and `steps` from t = first to last.
template <int N>
Grid<N> space_time(std::size_t samples, double half, std::size_t steps, double first, double last) {
  Grid<N> grid = test::centred_grid<N>(samples, half);
  grid.axes[N - 1] = Axis::uniform(steps, first, (last - first) / static_cast<double>(steps - 1));
  return grid;
}

template <int N, class Field>
Contour<N, double> contour_of(const Grid<N>& grid, const Field& field, bool close = false) {
  ExtractOptions options;
  options.close = close;
  return extract<double>(view_of(test::sample_field<double, N>(grid, field)), 0.0, options);
}

std::vector<Kind> kinds(const TrackGraph& graph) {
  std::vector<Kind> result;
  for (const TrackEvent& event : graph.events) result.push_back(event.kind);
  return result;
}

/// Two balls of radius 1 on the x axis with centres sqrt(0.55 + t^2 / 2) from the origin: merged between t = -sqrt(0.9)
/// and sqrt(0.9).
struct PassingBalls {
  double operator()(const Point<4>& p) const {
    const double d = std::sqrt(0.55 + 0.5 * p[3] * p[3]);
    return 1.0 - std::hypot(std::abs(p[0]) - d, p[1], p[2]);
  }
};

/// A tube of radius 0.3 around an arc of radius 1 in the x-y plane, open by an angle of 0.9 - t on either side of the x
/// axis. Its ends, half balls, touch when the sine of that angle is 0.3.
struct ClosingRing {
  double operator()(const Point<4>& p) const {
    const double gap = std::max(0.0, 0.9 - p[3]);
    const double angle = std::abs(std::atan2(p[1], p[0]));
    const double out =
        angle >= gap ? std::hypot(p[0], p[1]) - 1.0 : std::hypot(p[0] - std::cos(gap), std::abs(p[1]) - std::sin(gap));
    return 0.3 - std::hypot(out, p[2]);
  }
  [[nodiscard]] static double event() { return 0.9 - std::asin(0.3); }
};

/// The region around two points at distance a = 1 from the origin in which the product of the distances is less than
/// b^2 (Cassini): the components meet when b = 0.8 + 0.4 t is 1.
struct Cassini {
  double operator()(const Point<4>& p) const {
    const double rest = p[1] * p[1] + p[2] * p[2];
    return std::pow(0.8 + 0.4 * p[3], 4) - ((p[0] - 1) * (p[0] - 1) + rest) * ((p[0] + 1) * (p[0] + 1) + rest);
  }
  [[nodiscard]] static double event() { return 0.5; }
};

/// A ring that thickens, thinnest at maximum x: (r - 1)^2 + z^2 + 0.2 x < 0.1 + 0.2 t. It closes when the right side
/// equals the minimum of the left side over r at z = 0, y = 0, which is 0.2 - 0.01.
struct ThickeningRing {
  double operator()(const Point<4>& p) const {
    const double out = std::hypot(p[0], p[1]) - 1.0;
    return 0.1 + 0.2 * p[3] - (out * out + p[2] * p[2] + 0.2 * p[0]);
  }
  [[nodiscard]] static double event() { return 0.45; }
};

/// A tube around a circle in the x-t plane.
struct UprightRing {
  double operator()(const Point<4>& p) const { return 0.4 - std::hypot(std::hypot(p[0], p[3]) - 1.0, p[1], p[2]); }
};

TEST(Track, ABallIsBornAndDies) {
  const test::Ball<4> ball{{0.03, -0.02, 0.01, 0.04}, 1.0};
  TrackOptions options;
  options.times = even_times(-0.96, 1.04, 9);
  const Contour<4, double> contour = contour_of(space_time<4>(24, 1.3, 25, -1.3, 1.3), ball);
  const TrackGraph graph = track(contour, options);
  ASSERT_THAT(kinds(graph), ElementsAre(Kind::birth, Kind::death));
  EXPECT_NEAR(graph.events[0].time, -0.96, 0.01);
  EXPECT_NEAR(graph.events[1].time, 1.04, 0.01);
  EXPECT_EQ(graph.events[0].euler_change, 2);
  ASSERT_EQ(graph.segments.size(), 1u);
  EXPECT_EQ(graph.segments[0].euler_at_start, 2);
  ASSERT_EQ(graph.segments[0].samples.size(), 9u);
  for (const TrackSample& sample : graph.segments[0].samples) {
    const double square = 1.0 - (sample.time - 0.04) * (sample.time - 0.04);
    const double pi = std::numbers::pi;
    EXPECT_NEAR(sample.measure, 4 * pi * square, 0.04 * 4 * pi);
    EXPECT_NEAR(sample.content, 4.0 / 3.0 * pi * std::pow(square, 1.5), 0.04 * pi);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(sample.centroid[a], ball.centre[a], 0.002);
      EXPECT_NEAR(sample.upper[a], ball.centre[a] + std::sqrt(square), 0.01);
      EXPECT_NEAR(sample.lower[a], ball.centre[a] - std::sqrt(square), 0.01);
    }
  }
  ASSERT_EQ(graph.tracks.size(), 1u);
  EXPECT_THAT(graph.tracks[0].segments, ElementsAre(0));
}

/// Two balls in 4D whose centres approach each other along the first axis: they touch when each is a radius from the
/// origin, at the parameter 0.5.
TEST(Track, EventsAtALayerHaveItsTime) {
  // A diamond that appears at the sample in the middle, at t = 0, and another one that vanishes there at t = 1.
  for (const bool dies : {false, true}) {
    const auto field = [&](const Point<4>& p) {
      return (dies ? 1.0 - p[3] : p[3]) - 4.0 * std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    };
    const auto values = test::sample_field<double, 4>(space_time<4>(5, 1.0, 5, -0.5, 1.5), field);
    const auto check = [&](const TrackGraph& graph) {
      ASSERT_EQ(graph.events.size(), 2U);
      const TrackEvent& event = graph.events[dies ? 1 : 0];
      EXPECT_EQ(event.kind, dies ? Kind::death : Kind::birth);
      EXPECT_EQ(event.time, dies ? 1.0 : 0.0) << "not a rounding error beside it";
      EXPECT_EQ(dies ? graph.tracks[0].end : graph.tracks[0].start, event.time);
      EXPECT_EQ(dies ? graph.segments[0].end : graph.segments[0].start, event.time);
    };
    check(track(extract<double>(view_of(values), 0.0)));
    check(track(extract<float>(view_of(values), 0.0)));
  }
}

TEST(Track, BlobsOf4dMergeOverTheFifthAxis) {
  Grid<5> grid;
  grid.axes[0] = Axis::uniform(15, -1.75, 0.25);
  for (int a = 1; a < 4; ++a) grid.axes[a] = Axis::uniform(5, -1.0, 0.5);
  grid.axes[4] = Axis::uniform(8, 0.0, 1.0 / 7);
  const auto centre = [](double parameter) { return 1.0 - 0.8 * parameter; };
  const auto image = test::sample_field<double, 5>(grid, [&](const Point<5>& p) {
    const double across = std::hypot(p[1], p[2], p[3]);
    return 0.6 - std::min(std::hypot(p[0] - centre(p[4]), across), std::hypot(p[0] + centre(p[4]), across));
  });
  TrackOptions options;
  options.times = {0.3};
  const TrackGraph graph = track(extract<double>(view_of(image), 0.0), options);
  EXPECT_EQ(graph.space_dim, 5);
  ASSERT_THAT(kinds(graph), ElementsAre(Kind::begin, Kind::begin, Kind::merge, Kind::end));
  EXPECT_NEAR(graph.events[2].time, 0.5, 1e-9);
  ASSERT_EQ(graph.segments.size(), 3u);
  for (int s = 0; s < 2; ++s) {
    ASSERT_EQ(graph.segments[s].samples.size(), 1u);
    const TrackSample& sample = graph.segments[s].samples[0];
    EXPECT_EQ(graph.segments[s].euler_at_start, 0);  // spheres of three dimensions
    EXPECT_NEAR(std::abs(sample.centroid[0]), centre(0.3), 0.05);
    EXPECT_NEAR(sample.upper[3], 0.6, 0.1);
    EXPECT_NEAR(sample.measure, graph.segments[1 - s].samples[0].measure, 0.05);
    EXPECT_GT(sample.content, 0);
  }
  EXPECT_LT(graph.segments[0].samples[0].centroid[0] * graph.segments[1].samples[0].centroid[0], 0);
}

TEST(Track, ContentIsThatOfTheHighSideWhicheverWayTheContourFaces) {
  const auto image = test::sample_field<double, 4>(space_time<4>(12, 1.3, 12, -1.3, 1.3), [](const Point<4>& p) {
    return 0.2 - std::abs(0.6 - std::hypot(p[0], std::hypot(p[1], p[2], p[3])));
  });
  for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
    ExtractOptions extraction;
    extraction.direction = direction;
    TrackOptions options;
    options.times = {0.05};
    const TrackGraph graph = track(extract<double>(image.view(), 0.0, extraction), options);
    double outside = 0;
    double cavity = 0;
    for (const TrackSegment& segment : graph.segments)
      for (const TrackSample& sample : segment.samples) (sample.content > 0 ? outside : cavity) += sample.content;
    EXPECT_NEAR(outside, 4.0 / 3.0 * std::numbers::pi * std::pow(0.8, 3), 0.25);
    EXPECT_LT(cavity, 0);
    EXPECT_GT(outside, -cavity);
  }
}

TEST(Track, BallsThatMeetAndPartAreALoop) {
  const TrackGraph graph = track(contour_of(space_time<4>(33, 2.6, 25, -1.5, 1.5), PassingBalls{}));
  ASSERT_THAT(kinds(graph), ElementsAre(Kind::begin, Kind::begin, Kind::merge, Kind::split, Kind::end, Kind::end));
  EXPECT_NEAR(graph.events[2].time, -std::sqrt(0.9), 0.02);
  EXPECT_NEAR(graph.events[3].time, std::sqrt(0.9), 0.02);
  for (const int e : {2, 3})
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(graph.events[e].place[a], 0.0, 0.1);
  EXPECT_EQ(graph.events[2].euler_change, -2);
  EXPECT_EQ(graph.events[3].euler_change, 2);
  EXPECT_EQ(graph.segments.size(), 5u);
  // One track continues through both events; one ends in the merge, and one starts at the split.
  ASSERT_EQ(graph.tracks.size(), 3u);
  std::vector<std::size_t> lengths;
  for (const Track& t : graph.tracks) lengths.push_back(t.segments.size());
  std::sort(lengths.begin(), lengths.end());
  EXPECT_THAT(lengths, ElementsAre(1, 1, 3));
}

TEST(Track, ARingThatClosesOpensAHandle) {
  const TrackGraph graph = track(contour_of(space_time<4>(37, 1.5, 13, 0.0, 0.9), ClosingRing{}));
  ASSERT_THAT(kinds(graph), ElementsAre(Kind::begin, Kind::end));
  ASSERT_EQ(graph.handles.size(), 1u);
  EXPECT_EQ(graph.handles[0].euler_change, -2);
  EXPECT_NEAR(graph.handles[0].time, ClosingRing::event(), 0.03);
  EXPECT_NEAR(graph.handles[0].place[0], 0.95, 0.1);
  EXPECT_EQ(graph.segments[0].euler_at_start, 2);
  EXPECT_EQ(graph.segments[0].euler_at_end, 0);
  TrackOptions options;
  options.handles = false;
  EXPECT_TRUE(track(contour_of(space_time<4>(37, 1.5, 13, 0.0, 0.9), ClosingRing{}), options).handles.empty());
}

TEST(Track, AnUprightRingSplitsAndMerges) {
  const Contour<4, double> contour = contour_of(space_time<4>(24, 1.6, 31, -1.6, 1.6), UprightRing{});
  test::expect_closed_manifold(contour);
  const TrackGraph graph = track(contour);
  ASSERT_THAT(kinds(graph), ElementsAre(Kind::birth, Kind::split, Kind::merge, Kind::death));
  const std::array expected{-1.4, -0.6, 0.6, 1.4};
  for (std::size_t e = 0; e < 4; ++e) EXPECT_NEAR(graph.events[e].time, expected[e], 0.03);
  // The contour is S^1 x S^2 with first Betti number 1: one loop.
  EXPECT_EQ(graph.segments.size(), 4u);
}

TEST(Track, EventTimesConvergeWithTheSquareOfTheStep) {
  // The touching points lie at several positions within a tile; the maximum error counts.
  const auto error = [](std::size_t samples, const auto& field, auto time_of, double exact) {
    double worst = 0;
    const double step = 3.4 / static_cast<double>(samples - 1);
    for (const double share : {0.1, 0.25, 0.4}) {
      Grid<4> grid = space_time<4>(samples, 1.7, samples, -0.2, 0.9);
      for (int a = 0; a < 3; ++a) grid.axes[a] = Axis::uniform(samples, -1.7 + share * step, step);
      worst = std::max(worst, std::abs(time_of(track(contour_of(grid, field))) - exact));
    }
    return worst;
  };
  const auto handle_time = [](const TrackGraph& graph) {
    for (const TrackHandle& handle : graph.handles)
      if (handle.euler_change == -2) return handle.time;
    ADD_FAILURE() << "no handle opens";
    return 0.0;
  };
  const auto merge_time = [](const TrackGraph& graph) {
    for (const TrackEvent& event : graph.events)
      if (event.kind == Kind::merge) return event.time;
    ADD_FAILURE() << "nothing merges";
    return 0.0;
  };
  const auto birth_time = [](const TrackGraph& graph) { return graph.events.front().time; };
  const auto ball = [](const Point<4>& p) { return test::Ball<4>{{0, 0, 0, 1.2}, 0.9}(p); };
  const auto order = [&](const auto& field, auto time_of, double exact) {
    const double coarse = error(17, field, time_of, exact);
    const double fine = error(33, field, time_of, exact);
    EXPECT_LT(fine, 0.015);
    return test::convergence_order(coarse, fine);
  };
  EXPECT_GT(order(ball, birth_time, 0.3), 1.7);
  EXPECT_GT(order(Cassini{}, merge_time, Cassini::event()), 1.7);
  EXPECT_GT(order(ThickeningRing{}, handle_time, ThickeningRing::event()), 1.7);
}

TEST(Track, WhatCrossesTheBorderEntersAndLeaves) {
  // A ball in the plane that enters at one side and leaves at the other, and another that always exists.
  const auto field = [](const Point<3>& p) {
    return std::max(0.4 - std::hypot(p[0] - 1.5 * p[2], p[1] - 0.5), 0.3 - std::hypot(p[0], p[1] + 0.5));
  };
  const Grid<3> grid = space_time<3>(21, 1.0, 21, -1.2, 1.2);
  const TrackGraph graph = track(contour_of(grid, field));
  EXPECT_THAT(kinds(graph), ElementsAre(Kind::begin, Kind::enter, Kind::leave, Kind::end));
  EXPECT_TRUE(graph.events[1].at_border);
  TrackOptions options;
  options.times = {0.0, 0.9};
  const TrackGraph measured = track(contour_of(grid, field), options);
  ASSERT_EQ(measured.segments.size(), 2u);
  EXPECT_FALSE(std::isnan(measured.segments[1].samples[0].content));
  EXPECT_TRUE(std::isnan(measured.segments[1].samples[1].content)) << "half of it is outside: open";
  // Closed at the border, it is born and dies there; so does the other one, unless it is known to exist at the first
  // time.
  EXPECT_THAT(kinds(track(contour_of(grid, field, true))),
              ElementsAre(Kind::birth, Kind::birth, Kind::death, Kind::death));
  options.first = -1.2;
  options.last = 1.2;
  EXPECT_THAT(kinds(track(contour_of(grid, field, true), options)),
              ElementsAre(Kind::begin, Kind::birth, Kind::death, Kind::end));
}

TEST(Track, OfASingleContourMeasuresTimesThatDoublesMiss) {
  // 0.7 exceeds the nearest single-precision number, at which this contour ends.
  Grid<4> grid = space_time<4>(12, 1.0, 7, 0.0, 1.0);
  grid.axes[3] = Axis::uniform(7, 0.1, 0.1);
  const auto image =
      test::sample_field<float, 4>(grid, [](const Point<4>& p) { return 0.6 - std::hypot(p[0], p[1], p[2]); });
  const Contour<4, float> contour = extract<float>(image.view(), 0.0);
  TrackOptions options;
  options.times = {0.2, 0.3, 0.7};
  const TrackGraph graph = track(contour, options);
  ASSERT_EQ(graph.segments.size(), 1u);
  ASSERT_EQ(graph.segments[0].samples.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(graph.segments[0].samples[i].time, options.times[i]);
    const double area = test::measure(slice(contour, Hyperplane<4>::across(3, options.times[i])));
    EXPECT_NEAR(graph.segments[0].samples[i].measure, area, 1e-5 * area);
  }
}

template <int N>
void expect_first_sample_is_the_cut(const Contour<N, double>& contour) {
  double first = std::numeric_limits<double>::infinity();
  for (const auto& vertex : contour.vertices) first = std::min(first, vertex[N - 1]);
  TrackOptions options;
  options.times = {first, first + 0.7};
  const TrackGraph graph = track(contour, options);
  std::array<double, 2> sums{};
  for (const TrackSegment& segment : graph.segments)
    for (const TrackSample& sample : segment.samples) sums[sample.time == first ? 0 : 1] += sample.measure;
  const double at_first = test::measure(slice(contour, Hyperplane<N>::across(N - 1, first)));
  EXPECT_GT(at_first, 1.0);
  EXPECT_NEAR(sums[0], at_first, 1e-9 * at_first);
  EXPECT_NEAR(sums[1], test::measure(slice(contour, Hyperplane<N>::across(N - 1, first + 0.7))), 1e-9 * at_first);
}

TEST(Track, AtTheFirstTimeSamplesAreTheCutFromAbove) {
  ExtractOptions options;
  for (const bool close : {false, true}) {
    options.close = close;
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      expect_first_sample_is_the_cut(extract<double>(view_of(test::noise<float, 4>(5, seed)), 0.3, options));
      expect_first_sample_is_the_cut(extract<double>(view_of(test::noise<float, 3>(7, seed)), 0.3, options));
    }
  }
}

TEST(Track, BeginsAndEndsWhereTheDataSaySo) {
  const Contour<3, double> contour =
      contour_of(space_time<3>(11, 1.0, 5, 0.0, 1.0), [](const Point<3>& p) { return 0.6 - std::hypot(p[0], p[1]); });
  EXPECT_THAT(kinds(track(contour)), ElementsAre(Kind::begin, Kind::end));
  TrackOptions options;
  options.first = -1;
  options.last = 2;
  const TrackGraph graph = track(contour, options);
  EXPECT_THAT(kinds(graph), ElementsAre(Kind::enter, Kind::leave));
  EXPECT_EQ(graph.first, -1);
  EXPECT_EQ(graph.last, 2);
}

TEST(Track, LeavesOutWhatLivesTooShort) {
  // A long life with a branch of length 0.25 that merges, one of 0.5 that splits off, and a separate component of
  // 0.125.
  Contour<2, double> contour;
  contour.vertices = {{0, 0}, {0, 1}, {1, 0.75}, {0, 2}, {1, 2.5}, {0, 4}, {5, 1}, {5, 1.125}};
  contour.simplices = {{0, 1}, {2, 1}, {1, 3}, {3, 4}, {3, 5}, {6, 7}};
  const auto found = [&](double lifetime) {
    TrackOptions options;
    options.min_lifetime = lifetime;
    const TrackGraph graph = track(contour, options);
    std::vector<std::pair<double, double>> spans;
    for (const TrackSegment& segment : graph.segments) spans.emplace_back(segment.start, segment.end);
    std::sort(spans.begin(), spans.end());
    return spans;
  };
  using Spans = std::vector<std::pair<double, double>>;
  EXPECT_EQ(found(0), (Spans{{0, 1}, {0.75, 1}, {1, 1.125}, {1, 2}, {2, 2.5}, {2, 4}}));
  EXPECT_EQ(found(0.125), found(0)) << "shorter, not as short";
  EXPECT_EQ(found(0.2), (Spans{{0, 1}, {0.75, 1}, {1, 2}, {2, 2.5}, {2, 4}}));
  EXPECT_EQ(found(0.3), (Spans{{0, 2}, {2, 2.5}, {2, 4}}));
  EXPECT_EQ(found(0.6), (Spans{{0, 4}}));
  EXPECT_EQ(found(5), Spans{});
}

TEST(Track, LeavesOutShortLoops) {
  Contour<2, double> contour;  // 0 to 1, two paths to 1.5, then to 3
  contour.vertices = {{0, 0}, {0, 1}, {-1, 1.2}, {1, 1.3}, {0, 1.5}, {0, 3}};
  contour.simplices = {{0, 1}, {1, 2}, {2, 4}, {1, 3}, {3, 4}, {4, 5}};
  EXPECT_EQ(track(contour).segments.size(), 4u);
  TrackOptions options;
  options.min_lifetime = 0.6;
  const TrackGraph graph = track(contour, options);
  ASSERT_EQ(graph.segments.size(), 1u);
  EXPECT_EQ(graph.segments[0].end, 3);
}

TEST(Track, OfWhatLastsNoTimeThereIsNoEvent) {
  // A path with a level section, with a spur at that level; and an entirely level component.
  Contour<2, double> contour;
  contour.vertices = {{0, 0}, {1, 1}, {2, 1}, {3, 1}, {2, 2}, {8, 1}, {9, 1}};
  contour.simplices = {{0, 1}, {1, 2}, {2, 3}, {2, 4}, {5, 6}};
  const TrackGraph graph = track(contour);
  ASSERT_EQ(graph.segments.size(), 1u);
  EXPECT_EQ(graph.segments[0].start, 0);
  EXPECT_EQ(graph.segments[0].end, 2);
}

TEST(Track, LabelsSimplicesByTheSegmentInWhichTheyAppear) {
  TrackOptions options;
  options.label_simplices = true;
  const Contour<4, double> contour = contour_of(space_time<4>(17, 2.6, 13, -1.5, 1.5), PassingBalls{});
  const TrackGraph graph = track(contour, options);
  ASSERT_EQ(graph.simplex_segments.size(), contour.simplices.size());
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Index v : contour.simplices[s]) {
      low = std::min(low, contour.vertices[v][3]);
      high = std::max(high, contour.vertices[v][3]);
    }
    if (low == high) continue;
    ASSERT_NE(graph.simplex_segments[s], TrackGraph::kNoSegment);
    const TrackSegment& segment = graph.segments[graph.simplex_segments[s]];
    EXPECT_LE(segment.start, low);
    EXPECT_LE(low, segment.end);
  }
}

TEST(Track, DoesNotDependOnThreadsOrOnTheOrderOfSimplices) {
  const auto image = test::noise<float, 4>(6, 3);
  Contour<4, float> contour = extract<float>(image.view(), 0.5);
  TrackOptions options;
  options.times = even_times(0, 5, 7);
  const auto summary = [&](unsigned threads) {
    options.work.threads = threads;
    const TrackGraph graph = track(contour, options);
    std::vector<double> numbers;
    for (const TrackEvent& event : graph.events) {
      numbers.insert(numbers.end(), {event.time, double(event.vertex), double(int(event.kind))});
      numbers.insert(numbers.end(), event.in.begin(), event.in.end());
    }
    for (const TrackSegment& segment : graph.segments) {
      numbers.push_back(segment.track);
      for (const TrackSample& sample : segment.samples) numbers.push_back(sample.measure);
    }
    return numbers;
  };
  const std::vector<double> alone = summary(1);
  EXPECT_GT(alone.size(), 500u);
  EXPECT_EQ(summary(4), alone);
  EXPECT_EQ(summary(3), alone);
}

TEST(Track, EventsOfOneTimeAreInTheOrderOfTheirVertices) {
  // Pairs of parts that begin at one time, merge at one time and end at one time.
  constexpr std::size_t kPairs = 7;
  std::mt19937_64 random(5);
  std::vector<Index> numbers(4 * kPairs);
  std::iota(numbers.begin(), numbers.end(), Index{0});
  std::shuffle(numbers.begin(), numbers.end(), random);
  Contour<2, double> contour;
  contour.vertices.resize(numbers.size());
  for (std::size_t i = 0; i < kPairs; ++i) {
    const Index* const v = numbers.data() + 4 * i;
    const double x = 3.0 * static_cast<double>(i);
    contour.vertices[v[0]] = {x - 1, 0};
    contour.vertices[v[1]] = {x + 1, 0};
    contour.vertices[v[2]] = {x, 1};
    contour.vertices[v[3]] = {x, 2};
    for (const auto& [a, b] : {std::pair{0, 2}, std::pair{1, 2}, std::pair{2, 3}})
      contour.simplices.push_back({v[a], v[b]});
  }
  const auto summary = [&](unsigned threads) {
    TrackOptions options;
    options.work.threads = threads;
    const TrackGraph graph = track(contour, options);
    EXPECT_EQ(graph.events.size(), numbers.size());
    EXPECT_TRUE(std::is_sorted(graph.events.begin(), graph.events.end(), [](const auto& a, const auto& b) {
      return std::tuple(a.time, a.vertex) < std::tuple(b.time, b.vertex);
    }));
    std::vector<std::vector<double>> all;
    for (const TrackEvent& event : graph.events) {
      auto& of = all.emplace_back(std::vector{event.time, double(event.vertex), double(int(event.kind))});
      of.insert(of.end(), event.in.begin(), event.in.end());
      of.insert(of.end(), event.out.begin(), event.out.end());
    }
    for (const TrackSegment& segment : graph.segments)
      all.push_back({double(segment.from), double(segment.to), double(segment.track)});
    for (const Track& each : graph.tracks) all.emplace_back(each.segments.begin(), each.segments.end());
    return all;
  };
  const auto expected = summary(1);
  for (unsigned round = 0; round < 5; ++round) {
    std::shuffle(contour.simplices.begin(), contour.simplices.end(), random);
    EXPECT_EQ(expected, summary(1)) << round;
    EXPECT_EQ(expected, summary(3)) << round;
  }
}

TEST(Track, SelectsTracks) {
  const TrackGraph graph = track(contour_of(space_time<4>(17, 2.6, 13, -1.5, 1.5), PassingBalls{}));
  std::vector<bool> keep(graph.tracks.size());
  std::size_t through = 0;
  while (graph.tracks[through].segments.size() != 3) ++through;
  keep[through] = true;
  const TrackGraph part = select_tracks(graph, keep);
  EXPECT_THAT(kinds(part), ElementsAre(Kind::begin, Kind::merge, Kind::split, Kind::end));
  ASSERT_EQ(part.segments.size(), 3u);
  EXPECT_EQ(part.tracks[0].number, through);
  EXPECT_THAT(part.tracks[0].segments, ElementsAre(0, 1, 2));
  EXPECT_THAT(part.events[1].in, ElementsAre(0));
  EXPECT_THAT(part.events[1].out, ElementsAre(1));
  EXPECT_EQ(part.segments[2].from, 2u);
  std::vector<Index> left_out;
  for (const TrackEvent& event : part.events) left_out.push_back(event.left_out);
  EXPECT_THAT(left_out, ElementsAre(0, 1, 1, 0));
  for (const TrackEvent& event : select_tracks(graph, std::vector<bool>(keep.size(), true)).events)
    EXPECT_EQ(event.left_out, 0u);
  EXPECT_EQ(select_tracks(part, {true}).events[1].left_out, 1u) << "of the whole graph";
  EXPECT_THROW(select_tracks(graph, {true}), Error);
}

TEST(Track, OfNothingIsEmpty) {
  TrackOptions options;
  options.times = {1.0};
  const TrackGraph graph = track(Contour<4, float>{}, options);
  EXPECT_TRUE(graph.events.empty());
  EXPECT_TRUE(graph.tracks.empty());
}

TEST(Track, RefusesWhatIsUnsound) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Contour<2, double> contour;
  contour.vertices = {{0, 0}, {1, 1}};
  contour.simplices = {{0, 1}};
  const auto refuses = [&](const TrackOptions& options) {
    try {
      track(contour, options);
    } catch (const Error& error) {
      return error.code() == ErrorCode::InvalidArgument;
    }
    return false;
  };
  EXPECT_FALSE(refuses({}));
  EXPECT_TRUE(refuses({.min_lifetime = -1}));
  EXPECT_TRUE(refuses({.min_lifetime = nan}));
  EXPECT_TRUE(refuses({.times = {1, 1}}));
  EXPECT_TRUE(refuses({.times = {nan}}));
  EXPECT_TRUE(refuses({.first = nan}));
  EXPECT_TRUE(refuses({.first = 2.0, .last = 1.0}));
  contour.vertices[1][0] = nan;
  EXPECT_TRUE(refuses({}));
  contour.vertices[1][0] = 0;
  contour.simplices[0][1] = 2;
  EXPECT_TRUE(refuses({}));
}

TEST(Track, StopsWhenAsked) {
  TrackOptions options;
  options.work.progress = [](double) { return false; };
  try {
    track(contour_of(space_time<3>(5, 1.0, 5, 0.0, 1.0), [](const Point<3>& p) { return 0.5 - std::abs(p[0]); }),
          options);
    FAIL() << "expected Cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

}  // namespace
}  // namespace tegl
