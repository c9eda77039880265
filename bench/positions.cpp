// SPDX-License-Identifier: BSD-3-Clause
//
// Positions by rules: distance of planes and volume of balls from binary samples, self-intersections, time and memory.
// Makes the tables of docs/positions.md.
#include "tegl/positions.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "memory.hpp"
#include "run_program.hpp"
#include "support/fields.hpp"
#include "tegl/filter.hpp"
#include "tegl/intersections.hpp"
#include "tegl/measure.hpp"
#include "timing.hpp"
#include "usage.hpp"

namespace tegl {
namespace {

using test::Point;

constexpr std::array<std::pair<Positions, const char*>, 3> kOfMasks = {
    {{Positions::linear, "linear"}, {Positions::gravitation, "gravitation"}, {Positions::relaxed, "relaxed"}}};

PositionOptions by(Positions rule, std::span<const float> values = {}) {
  PositionOptions options;
  options.rule = rule;
  options.filtered = values;
  return options;
}

template <int N>
Grid<N> cubic_grid(std::size_t size) {
  std::array<std::size_t, N> sizes;
  sizes.fill(size);
  return Grid<N>::unit(sizes);
}

template <int N, class F>
OwnedImage<std::uint8_t, N> mask(std::size_t size, const F& is_high) {
  return test::sample_field<std::uint8_t, N>(cubic_grid<N>(size),
                                             [&](const Point<N>& x) { return is_high(x) ? 1.0 : 0.0; });
}

/// Sums of squared distances of vertices from a plane, and from the parallel plane in the middle of all that give the
/// same samples.
struct Distances {
  double sum = 0, from_middle = 0, count = 0;
  [[nodiscard]] double root_mean_square() const { return std::sqrt(sum / count); }
  [[nodiscard]] double root_mean_square_from_middle() const { return std::sqrt(from_middle / count); }
};

template <int N>
void add_plane(const Point<N>& normal, double offset, std::size_t size, Positions rule, Distances& distances) {
  const double middle = static_cast<double>(size) / 2;
  const auto height = [&](const auto& x) {
    double sum = -offset;
    for (int a = 0; a < N; ++a) sum += normal[a] * (static_cast<double>(x[a]) - middle);
    return sum;
  };
  const auto image = mask<N>(size, [&](const Point<N>& x) { return height(x) >= 0; });
  const auto contour = extract_placed<double>(image.view(), 0.5, by(rule));
  double lowest_high = std::numeric_limits<double>::infinity(), highest_low = -lowest_high;
  test::for_each_sample<N>(image.grid, [&](std::size_t, const std::array<std::size_t, N>& x) {
    const double h = height(x);
    if (h >= 0)
      lowest_high = std::min(lowest_high, h);
    else
      highest_low = std::max(highest_low, h);
  });
  const double in_the_middle = 0.5 * (lowest_high + highest_low);
  for (const auto& vertex : contour.vertices) {
    bool inner = true;
    for (const double x : vertex) inner = inner && std::abs(x - middle) < 0.8 * middle;
    if (!inner) continue;
    const double h = height(vertex);
    distances.sum += h * h;
    distances.from_middle += (h - in_the_middle) * (h - in_the_middle);
    ++distances.count;
  }
}

void measure_planes(bool quick) {
  std::printf("root mean square distance from tilted lines and planes of binary samples, in voxels\n");
  std::printf("rule,15 degrees,worst of 1 to 89 degrees except 45,at degrees,45 degrees,planes: mean,planes: worst,");
  std::printf("from the middle of the lines with these samples: worst,45 degrees,planes: worst\n");
  const std::size_t lines = quick ? 100 : 400, planes = quick ? 24 : 96;
  const std::array offsets = {0.0, 0.13, 0.29, 0.41, 0.57, 0.73, 0.88};
  for (const auto& [rule, name] : kOfMasks) {
    double at_15 = 0, at_45 = 0, worst = 0, middle_at_45 = 0, worst_from_middle = 0;
    int worst_degrees = 0;
    for (int degrees = 1; degrees < 90; degrees += quick ? 7 : 1) {
      const double angle = degrees * std::numbers::pi / 180;
      // exactly equal at 45 degrees, so that samples on the line are all high
      const Point<2> normal = {degrees == 45 ? std::sqrt(0.5) : std::sin(angle),
                               degrees == 45 ? std::sqrt(0.5) : std::cos(angle)};
      Distances distances;
      for (const double offset : offsets) add_plane<2>(normal, offset, lines, rule, distances);
      const double error = distances.root_mean_square();
      if (degrees == 15) at_15 = error;
      if (degrees == 45) at_45 = error;
      if (degrees == 45) middle_at_45 = distances.root_mean_square_from_middle();
      worst_from_middle = std::max(worst_from_middle, distances.root_mean_square_from_middle());
      if (degrees != 45 && error > worst) {
        worst = error;
        worst_degrees = degrees;
      }
    }
    std::mt19937_64 random(1994);
    double sum = 0, worst_plane = 0, worst_plane_from_middle = 0;
    const int count = quick ? 3 : 100;
    for (int i = 0; i < count; ++i) {
      Point<3> normal;
      double square = 2;
      while (square > 1 || square < 0.1) {
        square = 0;
        for (double& x : normal) {
          x = std::ldexp(static_cast<double>(random() >> 11), -52) - 1.0;
          square += x * x;
        }
      }
      for (double& x : normal) x /= std::sqrt(square);
      Distances distances;
      add_plane<3>(normal, offsets[static_cast<std::size_t>(i) % offsets.size()], planes, rule, distances);
      sum += distances.root_mean_square();
      worst_plane = std::max(worst_plane, distances.root_mean_square());
      worst_plane_from_middle = std::max(worst_plane_from_middle, distances.root_mean_square_from_middle());
    }
    std::printf("%s,%.3f,%.3f,%d,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f\n", name, at_15, worst, worst_degrees, at_45,
                sum / count, worst_plane, worst_from_middle, middle_at_45, worst_plane_from_middle);
  }
}

void measure_balls(bool quick) {
  std::printf("balls of binary samples at random places: volume, in percent of the ball's\n");
  std::printf("radius,samples,rule,mean error,root mean square error,mean difference from the number of samples\n");
  for (const double radius : {5.0, 10.0, 20.0, 40.0}) {
    if (quick && radius > 5) break;
    const int count = radius > 30 ? 16 : 64;
    for (const auto& [rule, name] : kOfMasks) {
      std::mt19937_64 random(7);
      const auto size = static_cast<std::size_t>(2 * radius + 8);
      double sum = 0, squares = 0, apart = 0, samples = 0;
      for (int i = 0; i < count; ++i) {
        test::Ball<3> ball{{}, radius};
        for (double& x : ball.centre)
          x = static_cast<double>(size) / 2 + std::ldexp(static_cast<double>(random() >> 11), -53);
        const auto image = mask<3>(size, [&](const Point<3>& x) { return ball(x) >= 0; });
        double high = 0;
        for (const auto value : image.values) high += value;
        const double volume = *measure(extract_placed<double>(image.view(), 0.5, by(rule))).content;
        const double error = 100 * (volume / ball.content() - 1);
        samples += high / count;
        sum += error / count;
        squares += error * error / count;
        apart += 100 * (volume / high - 1) / count;
      }
      std::printf("%g,%.0f,%s,%.3f,%.3f,%.3f\n", radius, samples, name, sum, std::sqrt(squares), apart);
    }
  }
}

/// `filtered` is by a Gaussian of one sample, with vertices kept off the samples; `custom` is 0.3 of the way from the
/// first sample.
template <int N>
void count_intersections(const char* field, const OwnedImage<std::uint8_t, N>& image) {
  const SeparableConvolution gaussian{std::vector<AxisWeights>(N, gaussian_weights(1.0))};
  const auto smooth = filter_image(image.view(), gaussian);
  PositionOptions custom = by(Positions::custom);
  custom.custom = [](double, double, double) { return 0.3; };
  const std::vector<std::pair<PositionOptions, const char*>> rules = {
      {by(Positions::linear), "linear"},
      {by(Positions::relaxed), "relaxed"},
      {by(Positions::filtered, {smooth.values.data(), smooth.values.size()}), "filtered"},
      {custom, "custom"},
      {by(Positions::gravitation), "gravitation"}};
  for (const auto& [positions, name] : rules) {
    const double epsilon = positions.rule == Positions::filtered ? 0.01 : 0.0;
    const auto contour = extract_placed<double>(image.view(), 0.5, positions, {.close = true, .epsilon = epsilon});
    const Intersections<N> found = find_intersections(contour);
    std::printf("%d,%s,%s,%zu,%llu,%llu,%llu\n", N, field, name, contour.simplices.size(),
                static_cast<unsigned long long>(found.flat), static_cast<unsigned long long>(found.pair_count),
                static_cast<unsigned long long>(found.intersecting));
  }
}

template <int N>
void count_intersections(std::size_t size) {
  std::mt19937_64 random(1994);
  count_intersections<N>("noise", mask<N>(size, [&](const Point<N>&) { return random() % 2 == 0; }));
  const test::Gyroid<N> gyroid{2 * std::numbers::pi / 14};
  count_intersections<N>("gyroid", mask<N>(size, [&](const Point<N>& x) { return gyroid(x) >= 0; }));
  const test::Ball<N> ball{[&] {
                             Point<N> centre;
                             centre.fill(0.47 * static_cast<double>(size));
                             return centre;
                           }(),
                           0.4 * static_cast<double>(size)};
  count_intersections<N>("ball", mask<N>(size, [&](const Point<N>& x) { return ball(x) >= 0; }));
}

/// Time and memory of all rules, for one image on one thread.
void measure_cost(const char* field, const OwnedImage<std::uint8_t, 3>& image) {
  std::vector<float> values(image.values.begin(), image.values.end());
  PositionOptions custom = by(Positions::custom);
  custom.custom = [](double first, double second, double isovalue) { return (isovalue - first) / (second - first); };
  const std::vector<std::pair<PositionOptions, const char*>> rules = {{by(Positions::linear), "linear"},
                                                                      {by(Positions::filtered, values), "filtered"},
                                                                      {custom, "custom"},
                                                                      {by(Positions::gravitation), "gravitation"},
                                                                      {by(Positions::relaxed), "relaxed"}};
  ExtractOptions options;
  options.work.threads = 1;
  std::vector<double> seconds(rules.size(), std::numeric_limits<double>::infinity()), bytes(rules.size());
  double size = 0;
  for (int run = 0; run < 7; ++run)
    for (std::size_t i = 0; i < rules.size(); ++i) {
      bench::give_back_memory();
      const auto before = bench::memory_bytes("VmRSS");
      bench::reset_peak_memory();
      const double start = bench::worked_seconds();
      const auto contour = extract_placed(image.view(), 0.5, rules[i].first, options);
      seconds[i] = std::min(seconds[i], bench::worked_seconds() - start);
      bytes[i] = static_cast<double>(bench::memory_bytes("VmHWM")) - static_cast<double>(before);
      size = static_cast<double>(contour.vertices.size() * 12 + contour.simplices.size() * 12);
    }
  for (std::size_t i = 0; i < rules.size(); ++i)
    std::printf("%s,%s,%.1f,%.2f,%.1f,%.2f\n", field, rules[i].second, 1e3 * seconds[i], seconds[i] / seconds[0],
                bytes[i] / 1e6, bytes[i] / size);
}

int run(int argc, char** argv) {
  if (bench::tells_usage(argc, argv,
                         "positions [--quick]: planes, balls, self-intersections, time and memory by rule, as CSV\n"
                         "  --quick   small images, to test the program"))
    return 0;
  const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
  if (argc > (quick ? 2 : 1))
    throw Error(ErrorCode::InvalidArgument, std::string("'") + argv[quick ? 2 : 1] + "'; expected --quick or nothing");
  measure_planes(quick);
  measure_balls(quick);
  std::printf("self-intersections of closed contours of masks\n");
  std::printf("dimension,mask,rule,simplices,flat,intersecting pairs,simplices in pairs\n");
  count_intersections<2>(quick ? 20 : 256);
  count_intersections<3>(quick ? 10 : 48);
  count_intersections<4>(quick ? 5 : 14);
  std::printf("masks of %s samples on one thread\n", quick ? "32^3" : "256^3");
  std::printf("mask,rule,milliseconds,times linear,peak megabytes,times the contour\n");
  const std::size_t size = quick ? 32 : 256;
  const auto scale = static_cast<double>(size) / 256;
  const test::Ball<3> ball{{128 * scale, 127 * scale, 129 * scale}, 100 * scale};
  measure_cost("ball", mask<3>(size, [&](const Point<3>& x) { return ball(x) >= 0; }));
  const test::Gyroid<3> gyroid{2 * std::numbers::pi / 64};
  measure_cost("gyroid", mask<3>(size, [&](const Point<3>& x) { return gyroid(x) >= 0.2; }));
  return 0;
}

}  // namespace
}  // namespace tegl

int main(int argc, char** argv) { return tegl::bench::run_program("positions", argc, argv, tegl::run); }
