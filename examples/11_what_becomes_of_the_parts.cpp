// SPDX-License-Identifier: BSD-3-Clause
//
// Example 11: tracking the components of a moving surface. Two balls pass so closely that they merge for some time.
// They merge and split between the time steps, and one track continues through both events.
#include <tegl/extract.hpp>
#include <tegl/track.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

constexpr std::size_t kSize = 32, kSteps = 20;

/// Positive inside: balls of radius 6 and 5 on paths 10.5 apart, one moving to the right, one to the left.
float inside(double x, double y, double z, double t) {
  const double first = 6.0 - std::hypot(x - 7.0 - 0.9 * t, y - 10.5, z - 15.5);
  const double second = 5.0 - std::hypot(x - 24.0 + 0.9 * t, y - 21.0, z - 15.5);
  return static_cast<float>(std::max(first, second));
}

}  // namespace

int main() {
  std::vector<float> values;
  for (std::size_t i = 0; i < kSize * kSize * kSize * kSteps; ++i)
    values.push_back(inside(static_cast<double>(i % kSize), static_cast<double>(i / kSize % kSize),
                            static_cast<double>(i / (kSize * kSize) % kSize),
                            static_cast<double>(i / (kSize * kSize * kSize))));
  const tegl::Image<float, 4> image(values.data(), tegl::Grid<4>::unit({kSize, kSize, kSize, kSteps}));
  const auto contour = tegl::extract(image, 0.0);

  tegl::TrackOptions options;
  options.times = tegl::even_times(0, kSteps - 1, 10);  // times at which the components are measured
  const tegl::TrackGraph graph = tegl::track(contour, options);
  for (const tegl::TrackEvent& event : graph.events)
    std::printf("t = %5.2f: %s, %zu -> %zu parts\n", event.time, tegl::name_of(event.kind).data(), event.in.size(),
                event.out.size());
  for (const tegl::TrackSegment& segment : graph.segments)
    for (const tegl::TrackSample& sample : segment.samples)
      std::printf("track %u at t = %5.2f: area %.0f, volume %.0f\n", graph.tracks[segment.track].number, sample.time,
                  sample.measure, sample.content);

  // The centres are 10.5 apart in y and 17 - 1.8 t in x; the balls touch when their distance is 11. The grid resolves a
  // gap of at least about one step, so events are up to half a step early or late.
  const double half = std::sqrt(11.0 * 11.0 - 10.5 * 10.5) / 1.8;
  const bool right = graph.events.size() == 6 && graph.events[2].kind == tegl::TrackEventKind::merge &&
                     graph.events[3].kind == tegl::TrackEventKind::split &&
                     std::abs(graph.events[2].time - (17.0 / 1.8 - half)) < 1.0 &&
                     std::abs(graph.events[3].time - (17.0 / 1.8 + half)) < 1.0 && graph.tracks.size() == 3;
  return right ? 0 : 1;
}
