// SPDX-License-Identifier: BSD-3-Clause
//
// scrubber_bench [STEPS SAMPLES CUTS]: cost of slices by `Scrubber` on one thread. Medians over CUTS slices (101) of a
// gyroid of SAMPLES^3 (36) that drifts for STEPS time steps (86), and medians of `slice` for comparison. Further rows
// vary the number of time steps, which changes the contour's size but not the slice's, and the number of samples, which
// changes the slice's: time depends on the size of the slice. One row of a Markdown table each.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <vector>

#include "run.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/slice.hpp"
#include "usage.hpp"

namespace tegl::bench {
namespace {

/// CPU time of this thread, so that other work on the machine does not count.
double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double seconds_of(const auto& work) {
  const double start = now();
  work();
  return now() - start;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// A gyroid with a period of 16 samples that drifts along x by a tenth of a period per step.
Contour<4, float> drifting_gyroid(std::size_t samples, std::size_t steps) {
  OwnedImage<float, 4> image{Grid<4>::unit({samples, samples, samples, steps}), {}};
  constexpr double kPerSample = 2.0 * std::numbers::pi / 16.0;
  std::vector<double> sine(samples), cosine(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    sine[i] = std::sin(kPerSample * static_cast<double>(i));
    cosine[i] = std::cos(kPerSample * static_cast<double>(i));
  }
  for (std::size_t t = 0; t < steps; ++t)
    for (std::size_t z = 0; z < samples; ++z)
      for (std::size_t y = 0; y < samples; ++y)
        for (std::size_t x = 0; x < samples; ++x) {
          const double at = kPerSample * (static_cast<double>(x) + 1.6 * static_cast<double>(t)) + 0.1;
          image.values.push_back(
              static_cast<float>(std::sin(at) * cosine[y] + sine[y] * cosine[z] + sine[z] * std::cos(at)));
        }
  return extract(image.view(), 0.05);
}

/// The median times of a slice between time steps and of a slice at time steps.
template <class Cut>
std::pair<double, double> medians(std::size_t steps, int cuts, const Cut& cut) {
  std::mt19937_64 bits(1);
  std::vector<double> between, at_steps;
  for (int i = 0; i < cuts; ++i) {
    const double t = static_cast<double>(steps - 1) * static_cast<double>(bits() >> 11) * 0x1p-53;
    between.push_back(seconds_of([&] { cut(t); }));
    at_steps.push_back(seconds_of([&] { cut(std::round(t)); }));
  }
  return {median(between), median(at_steps)};
}

void measure(std::size_t samples, std::size_t steps, int cuts) {
  const Contour<4, float> contour = drifting_gyroid(samples, steps);
  std::vector<double> builds;
  WorkOptions options;
  options.threads = 1;
  for (int i = 0; i < 3; ++i)
    builds.push_back(seconds_of([&] { Scrubber<4, float>(contour, Hyperplane<4>{}, options); }));
  const Scrubber<4, float> scrubber(contour, Hyperplane<4>{}, options);
  std::vector<double> triangles;
  const auto scrubbed = medians(
      steps, cuts, [&](double t) { triangles.push_back(static_cast<double>(scrubber.cut(t).simplices.size())); });
  const auto sliced =
      medians(steps, std::min(cuts, 11), [&](double t) { (void)slice(contour, Hyperplane<4>::across(3, t)); });
  std::printf("| %zu³ × %zu | %.2f | %.0f | %.2f | %.2f | %.0f | %.2f | %.1f | %.2f | %.0f |\n", samples, steps,
              1e-6 * static_cast<double>(contour.simplices.size()),
              1e-3 * static_cast<double>(contour_bytes(contour)) / 1e3, median(builds),
              static_cast<double>(scrubber.memory()) / static_cast<double>(contour.simplices.size()), median(triangles),
              1e3 * scrubbed.first, 1.0 / scrubbed.first, 1e3 * scrubbed.second, 1e3 * sliced.first);
  std::fflush(stdout);
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) {
  if (tegl::bench::tells_usage(argc, argv,
                               "scrubber_bench [STEPS [SAMPLES [CUTS]]]: what cuts of a 4D contour by Scrubber cost"))
    return 0;
  const auto number = [&](int i, int otherwise) { return argc > i ? std::max(2, std::atoi(argv[i])) : otherwise; };
  const auto steps = static_cast<std::size_t>(number(1, 86));
  const auto samples = static_cast<std::size_t>(number(2, 36));
  const int cuts = number(3, 101);
  std::printf(
      "| samples | tetrahedra, millions | contour, MB | build, s | index, bytes each | triangles of a cut | cut, ms | "
      "cuts per second | cut at a step, ms | slice, ms |\n|---|---|---|---|---|---|---|---|---|---|\n");
  tegl::bench::measure(samples, steps, cuts);
  tegl::bench::measure(samples, std::max<std::size_t>(2, steps / 4), cuts);
  tegl::bench::measure(samples, 2 * steps, cuts);
  tegl::bench::measure(samples / 2, 4 * steps, cuts);
  tegl::bench::measure(samples / 4, 4 * steps, cuts);
}
