// SPDX-License-Identifier: BSD-3-Clause
//
// Example 8: the components of a contour and their sizes. The field has two balls in space and time: one exists from
// the beginning to the end and grows, the other appears and vanishes. The example identifies and measures them.
#include <tegl/components.hpp>
#include <tegl/extract.hpp>
#include <tegl/measure.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace {

constexpr std::size_t kSize = 32, kSteps = 20;

/// Positive inside: a ball of radius 4 + 0.2 t, and one that exists around t = 9.5.
float inside(double x, double y, double z, double t) {
  const double growing = 4.0 + 0.2 * t - std::hypot(x - 9.0, y - 15.5, z - 15.5);
  const double passing = 5.0 - std::hypot(std::hypot(x - 24.0, y - 15.5, z - 15.5), t - 9.5);
  return static_cast<float>(std::max(growing, passing));
}

double inside_of_ball(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

}  // namespace

int main() {
  std::vector<float> values;
  for (std::size_t i = 0; i < kSize * kSize * kSize * kSteps; ++i)
    values.push_back(inside(static_cast<double>(i % kSize), static_cast<double>(i / kSize % kSize),
                            static_cast<double>(i / (kSize * kSize) % kSize),
                            static_cast<double>(i / (kSize * kSize * kSize))));
  const tegl::Image<float, 4> image(values.data(), tegl::Grid<4>::unit({kSize, kSize, kSize, kSteps}));
  const auto contour = tegl::extract(image, 0.0);

  // [components]
  const tegl::ComponentLabels labels = tegl::label_components(contour);
  for (const tegl::Component<4>& component : tegl::components(contour, labels))
    std::printf("component %u: %llu tetrahedra, there from t = %.2f to %.2f\n", component.label,
                static_cast<unsigned long long>(component.simplices), component.lowest[3], component.highest[3]);
  // [/components]

  const std::vector<tegl::Component<4>> found = tegl::components(contour, labels);
  // [select]
  std::vector<bool> stays(labels.count);
  for (const tegl::Component<4>& component : found) stays[component.label] = component.time_span() > 15;
  const tegl::Contour<4> growing = tegl::select_components(contour, labels, stays);
  // [/select]

  // [measures]
  const std::vector<double> times = {0.0, 7.3, 19.0};
  for (const tegl::CutMeasures& cut : tegl::measure_cuts(growing, times))
    std::printf("t = %4.1f: area %.1f, volume %.1f\n", cut.at, cut.size, cut.content.value());
  // [/measures]

  // The passing ball is closed, so it has a 4-volume; the growing one is open at the first and the last time.
  const bool one_closed =
      std::count_if(found.begin(), found.end(), [](const auto& c) { return c.content.has_value(); }) == 1;
  const tegl::CutMeasures middle = tegl::measure_cuts(growing, times)[1];
  const double expected = inside_of_ball(4.0 + 0.2 * 7.3);
  return labels.count == 2 && one_closed && std::abs(middle.content.value() / expected - 1) < 0.03 ? 0 : 1;
}
