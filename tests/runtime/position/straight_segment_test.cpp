// SPDX-License-Identifier: BSD-3-Clause
//
// Digital straight segments, their lines, and the lines fitted to curves of them.
#include "position/straight_segment.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "position/curve_lines.hpp"
#include "position/short_segments.hpp"

namespace tegl::test {
namespace {

/// Whether a line separates the pixels on both sides of a path, by trying many.
bool has_line(const std::vector<detail::GridStep>& steps) {
  std::vector<std::array<double, 2>> above, below;
  double x = 0, y = 0;
  for (const detail::GridStep step : steps) {
    if (step == detail::GridStep::right) {
      above.push_back({x + 0.5, y + 0.5});
      below.push_back({x + 0.5, y - 0.5});
      x += 1;
    } else {
      above.push_back({x - 0.5, y + 0.5});
      below.push_back({x + 0.5, y + 0.5});
      y += 1;
    }
  }
  for (int i = 0; i <= 4000; ++i) {
    const double angle = i / 4000.0 * std::numbers::pi / 2;
    double most = -1e9, least = 1e9;
    const auto height = [&](const auto& p) { return std::cos(angle) * p[1] - std::sin(angle) * p[0]; };
    for (const auto& p : below) most = std::max(most, height(p));
    for (const auto& p : above) least = std::min(least, height(p));
    if (most < least - 1e-9) return true;
  }
  return false;
}

TEST(StraightSegment, AllPathsOfTenStepsAreRecognised) {
  for (unsigned path = 0; path < 1024; ++path) {
    detail::StraightSegment segment;
    std::vector<detail::GridStep> steps;
    bool straight = true;
    for (int i = 0; i < 10 && straight; ++i) {
      steps.push_back((path >> i & 1u) != 0 ? detail::GridStep::up : detail::GridStep::right);
      straight = segment.add(steps.back());
      EXPECT_EQ(straight, has_line(steps)) << path << " after " << i + 1 << " steps";
    }
  }
}

/// Twice the middle of a step, in a direction of the path.
double dot(const std::array<int, 2>& start, const std::array<int, 2>& move, const std::array<int, 2>& direction) {
  double sum = 0;
  for (std::size_t a = 0; a < 2; ++a) sum += (2 * start[a] + move[a]) * direction[a];
  return sum;
}

/// The fits of lines to a curve by their definition: each segment found step by step, each distance from coordinates.
std::vector<detail::LineFit> direct_fits(const std::vector<detail::GridStep>& steps, bool closed) {
  const std::size_t count = steps.size();
  std::vector<detail::LineFit> fits(count);
  constexpr std::array<std::array<int, 2>, 4> kMoves = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (std::size_t first = 0; first < count;) {
    detail::StraightSegment segment;
    while (segment.size() < count && (closed || first + segment.size() < count) &&
           segment.add(steps[(first + segment.size()) % count])) {
    }
    // the mean of the middles of the steps, and the direction: (b, a) in the frame of the first two directions
    std::array<int, 2> sum{}, at{}, along{}, across{};
    along = kMoves[static_cast<std::size_t>(steps[first])];
    for (std::size_t i = 0; i < segment.size(); ++i) {
      const auto& move = kMoves[static_cast<std::size_t>(steps[(first + i) % count])];
      if (move != along) across = move;
      for (std::size_t a = 0; a < 2; ++a) {
        sum[a] += 2 * at[a] + move[a];
        at[a] += move[a];
      }
    }
    const auto line = segment.line();
    const bool whole = !closed && segment.size() == count;
    const auto lines = segment.separating_lines();
    std::array<double, 2> direction{};
    const double tilt = whole ? lines.slope() : 0;
    for (std::size_t a = 0; a < 2; ++a) direction[a] = (line.b + tilt) * along[a] + (line.a - tilt) * across[a];
    at = {};
    for (std::size_t i = 0; i < segment.size(); ++i) {
      const auto& move = kMoves[static_cast<std::size_t>(steps[(first + i) % count])];
      const std::size_t free = move[0] != 0 ? 1 : 0, other = 1 - free;
      const double size = static_cast<double>(segment.size());
      const double ahead = 0.5 * (2 * at[other] + move[other] - sum[other] / size);
      double offset = 0.5 * sum[free] / size + ahead * direction[free] / direction[other] - at[free];
      double precision = line.precision;
      if (whole) {
        // the mean line from its place at the middle of the step: rest = mean(p), along the direction in which p stays
        const float middle = static_cast<float>(i) + 0.5f;
        const bool is_along = move == along;
        const double rest = line.a * 0.5 * dot(at, move, along) - line.b * 0.5 * dot(at, move, across);
        const double per_step = is_along ? line.b + tilt : tilt - line.a;
        const auto& axis = is_along ? across : along;
        const double sign = axis[free] < 0 ? -1 : 1;
        offset = sign * (rest - lines.mean(middle)) / per_step;
        precision = segment.squared_length() / (12 * lines.variance(middle));
      }
      fits[(first + i) % count].sum += static_cast<float>((0.5 + offset) * precision);
      fits[(first + i) % count].weight += static_cast<float>(precision);
      for (std::size_t a = 0; a < 2; ++a) at[a] += move[a];
    }
    if (!closed && first + segment.size() == count) break;
    first += std::max<std::size_t>(1, segment.size() / 3);
  }
  return fits;
}

TEST(StraightSegment, SeparatingLinesHaveTheMeanAndVarianceOfSampledOnes) {
  std::mt19937_64 random(4);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (const char* path : {"rrrrurr", "rru", "ruuuuuu", "rurrurru", "rrrurrrrurrr", "rrrrrrrrurrr"}) {
    detail::StraightSegment segment;
    for (const char* step = path; *step != 0; ++step)
      ASSERT_TRUE(segment.add(*step == 'u' ? detail::GridStep::up : detail::GridStep::right));
    const auto line = segment.line();
    const auto lines = segment.separating_lines();
    std::vector<std::array<double, 2>> above, below;  // pixels: p and rest
    double x = 0, y = 0;
    for (const char* step = path; *step != 0; ++step) {
      const bool up = *step == 'u';
      const auto add = [&](auto& pixels, double px, double py) {
        pixels.push_back({px + py, line.a * px - line.b * py});
      };
      add(above, x + (up ? -0.5 : 0.5), y + 0.5);
      add(below, x + 0.5, y + (up ? 0.5 : -0.5));
      (up ? y : x) += 1;
    }
    const double end = x + y;
    std::array<double, 3> sums{}, squares{};
    double count = 0;
    for (int i = 0; i < 1000000; ++i) {
      const double slope = uniform(-line.b, line.a + 1), start = uniform(-line.a - line.b, line.a + line.b);
      bool separates = true;
      for (const auto& [p, rest] : above) separates = separates && start + slope * p >= rest;
      for (const auto& [p, rest] : below) separates = separates && start + slope * p <= rest;
      if (!separates) continue;
      ++count;
      for (std::size_t k = 0; k < 3; ++k) {
        const double value = start + slope * end * 0.5 * static_cast<double>(k);
        sums[k] += value;
        squares[k] += value * value;
      }
    }
    ASSERT_GT(count, 300) << path;
    for (std::size_t k = 0; k < 3; ++k) {
      const double mean = sums[k] / count, variance = squares[k] / count - mean * mean;
      const auto p = static_cast<float>(end * 0.5 * static_cast<double>(k));
      EXPECT_NEAR(lines.mean(p), mean, 0.1) << path << ' ' << k;
      EXPECT_NEAR(lines.variance(p), variance, 0.2 * variance) << path << ' ' << k;
    }
  }
}

TEST(StraightSegment, LinesOfCurvesAreThoseOfTheirSegments) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    // noise, or long digital lines in all quadrants
    const unsigned quadrant = random() % 4, other = random() % 2 == 0 ? 1 : 3, noise = i % 2 == 0 ? 4 : 0;
    const double slope = static_cast<double>(random() % 1000) / 1000;
    detail::CurveLines lines;
    std::vector<detail::GridStep> steps;
    for (std::size_t j = 0; j < 3 + random() % 300; ++j) {
      const double k = static_cast<double>(j);
      unsigned turn = std::floor((k + 1) * slope) != std::floor(k * slope) ? other : 0;
      if (noise != 0 && random() % 5 == 0) turn = static_cast<unsigned>(random() % noise);
      steps.push_back(static_cast<detail::GridStep>((quadrant + turn) % 4));
      lines.push_back(steps.back());
    }
    const bool closed = random() % 2 == 0;
    lines.fit(closed, 1.0f);
    const auto expected = direct_fits(steps, closed);
    for (std::size_t j = 0; j < steps.size(); ++j) {
      EXPECT_NEAR(lines[j].weight, expected[j].weight, 1e-5 * expected[j].weight);
      EXPECT_NEAR(lines[j].sum, expected[j].sum, 1e-4 * expected[j].weight) << i << " at " << j;
    }
  }
}

constexpr std::size_t kShort = detail::ShortSegments::kSteps;

/// The path of some first steps with these turns.
std::vector<detail::GridStep> path_of(unsigned turns, std::size_t size) {
  std::vector<detail::GridStep> steps;
  for (std::size_t i = 0; i < size; ++i)
    steps.push_back((turns >> i & 1u) != 0 ? detail::GridStep::up : detail::GridStep::right);
  return steps;
}

TEST(ShortSegments, AreTheSegmentsThatAreFoundStepByStep) {
  for (unsigned turns = 0; turns < 1u << kShort; turns += 2) {
    detail::StraightSegment segment;
    for (const detail::GridStep step : path_of(turns, kShort)) {
      if (!segment.add(step)) break;
      EXPECT_EQ(detail::kShortSegments.line(turns, segment.size()), segment.line()) << turns << ' ' << segment.size();
    }
    ASSERT_EQ(detail::kShortSegments.size(turns), segment.size()) << turns;
    if (segment.size() < kShort) continue;
    const std::vector<detail::GridStep> steps = path_of(turns, kShort);
    EXPECT_EQ(detail::kShortSegments.whole(turns, steps.data()), segment) << turns;
  }
}

/// a and b of the digital line with the shortest period, a + b, that has all points of a path, by trying all of them;
/// none if there is none or several are shortest.
std::optional<std::array<int, 2>> shortest_line(const std::vector<std::array<int, 2>>& points) {
  for (int period = 1; period <= static_cast<int>(points.size()); ++period) {
    std::vector<std::array<int, 2>> found;
    for (int a = 0; a <= period; ++a) {
      const int b = period - a;
      int least = 0, most = 0;
      for (const auto& [x, y] : points) {
        least = std::min(least, a * x - b * y);
        most = std::max(most, a * x - b * y);
      }
      if (most - least < period) found.push_back({a, b});
    }
    if (!found.empty()) return found.size() == 1 ? std::optional(found[0]) : std::nullopt;
  }
  return std::nullopt;
}

/// The directions and places are integers; weights follow from the variance, which another test compares with sampled
/// lines.
TEST(ShortSegments, HaveTheLinesOfTheDefinition) {
  std::size_t count = 0;
  for (std::size_t size = 1; size <= kShort; ++size)
    for (unsigned turns = 0; turns < 1u << size; turns += 2) {
      const std::vector<detail::GridStep> steps = path_of(turns, size);
      std::vector<std::array<int, 2>> points = {{0, 0}};
      for (const detail::GridStep step : steps) {
        points.push_back(points.back());
        ++points.back()[step == detail::GridStep::right ? 0 : 1];
      }
      const auto direction = shortest_line(points);
      ASSERT_EQ(detail::kShortSegments.size(turns) >= size, direction.has_value()) << turns << ' ' << size;
      if (!direction) continue;
      ++count;
      const auto& line = detail::kShortSegments.line(turns, size);
      const auto [a, b] = *direction;
      EXPECT_EQ(line.a, a) << turns << ' ' << size;
      EXPECT_EQ(line.b, b) << turns << ' ' << size;
      int doubled = 0;  // sum of twice the middles of steps, as a x - b y
      for (std::size_t i = 0; i < size; ++i)
        doubled += a * (points[i][0] + points[i + 1][0]) - b * (points[i][1] + points[i + 1][1]);
      EXPECT_EQ(line.doubled_mean, static_cast<float>(doubled / static_cast<double>(size))) << turns << ' ' << size;
      double precision = a * a + b * b;
      if (size < 2 * static_cast<std::size_t>(a + b)) {
        detail::StraightSegment segment;
        for (const detail::GridStep step : steps) segment.add(step);
        const auto lines = segment.separating_lines();
        const auto end = static_cast<float>(size);
        // the variance is a quadratic function, whose mean Simpson's rule gives
        precision /= std::sqrt(2 * (lines.variance(0) + 4 * lines.variance(end / 2) + lines.variance(end)));
      }
      EXPECT_NEAR(line.precision, precision, 1e-5 * precision) << turns << ' ' << size;
    }
  EXPECT_EQ(count, 229u);
}

TEST(ShortSegments, SquareRootsOfTheCompilerAreRoundedToNearest) {
  static_assert(detail::square_root(4.0f) == 2.0f && detail::square_root(0.25f) == 0.5f);
  static constexpr std::size_t kCount = 200;
  static constexpr auto at = [](std::size_t i) { return 0.25f + 0.037f * static_cast<float>(i * i) / 7.0f; };
  constexpr auto roots = [] {
    std::array<float, kCount> result{};
    for (std::size_t i = 0; i < kCount; ++i) result[i] = detail::square_root(at(i));
    return result;
  }();
  for (std::size_t i = 0; i < kCount; ++i) EXPECT_EQ(roots[i], std::sqrt(at(i))) << i;
}

}  // namespace
}  // namespace tegl::test
