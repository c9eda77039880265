// SPDX-License-Identifier: BSD-3-Clause
//
// Recognition of digital straight segments, step by step: whether a path along the sides of pixels separates the
// pixels at its two sides by a straight line, and which line.
//
// Based on: I. Debled-Rennesson and J.-P. Reveilles, "A linear algorithm for segmentation of digital curves",
// International Journal of Pattern Recognition and Artificial Intelligence 9(4), 1995 (here for standard lines, whose
// thickness is |a| + |b|).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tegl::detail {

/// The direction of a step between neighbouring points of the square grid: +x, +y, -x, -y.
enum class GridStep : std::uint8_t { right, up, left, down };

/// The square root of a positive normal number, rounded to nearest in constant expressions, too.
constexpr float square_root(float x) noexcept {
  if (!std::is_constant_evaluated()) return std::sqrt(x);
  // Heron's rule from above: the roots of `float` are far enough from the middle between two `float` that a last error
  // of a few units of `double` does not matter
  double root = x < 1.0f ? 1.0 : static_cast<double>(x);
  for (double next = root; (next = 0.5 * (root + static_cast<double>(x) / root)) < root;) root = next;
  return static_cast<float>(root);
}

/// All lines that separate the pixels on both sides of a segment, as if each were equally likely. In the frame of the
/// segment's first two directions, with p = x + y (steps from the start) and rest = a x - b y, each line is a function
/// rest(p) = c + s p. Their c and s fill two triangles with a common side: the lines with s = 0, whose c are an
/// interval of length 1. The third corner of each is a line that touches pixels on both sides: one rises from the lower
/// end of the interval to its upper end, the other one falls from the upper end to the lower one.
class SeparatingLines {
 public:
  /// Places p.
  struct Places {
    float from, to;
  };
  /// `least`: the least c of lines with s = 0.
  constexpr SeparatingLines(float least, Places rise, Places fall)
      : least_(least), rise_(rise.from), fall_(fall.from), rising_(1 / (rise.to - rise.from)) {
    const float rises_in = rise.to - rise.from, falls_in = fall.to - fall.from;
    falling_ = 1 / falls_in;
    share_ = falls_in / (rises_in + falls_in);
  }

  /// The mean line: s, and rest at p.
  [[nodiscard]] constexpr float slope() const noexcept { return (share_ * rising_ - (1 - share_) * falling_) / 3; }
  [[nodiscard]] constexpr float mean(float p) const noexcept { return least_ + (1 + mean_corner(p)) / 3; }
  /// The variance of rest at p.
  [[nodiscard]] constexpr float variance(float p) const noexcept {
    const float up = rise(p), down = fall(p);
    return variance_of(mean_corner(p), share_ * up * up + (1 - share_) * down * down, mean_corner(p) * mean_corner(p));
  }
  /// The mean of the variance from p = 0 to `end`.
  [[nodiscard]] constexpr float mean_variance(float end) const noexcept {
    // of the square of a linear function
    const auto square = [](float at_start, float at_end) {
      return (at_start * at_start + at_start * at_end + at_end * at_end) / 3;
    };
    const float first = mean_corner(0), last = mean_corner(end);
    return variance_of((first + last) / 2,
                       share_ * square(rise(0), rise(end)) + (1 - share_) * square(fall(0), fall(end)),
                       square(first, last));
  }

 private:
  /// The values of the third corners at p, above `least`.
  [[nodiscard]] constexpr float rise(float p) const noexcept { return rising_ * (p - rise_); }
  [[nodiscard]] constexpr float fall(float p) const noexcept { return 1 - falling_ * (p - fall_); }
  [[nodiscard]] constexpr float mean_corner(float p) const noexcept {
    return share_ * rise(p) + (1 - share_) * fall(p);
  }
  /// The variance over both triangles. A triangle whose corners have the values 0, 1 and v has the mean (1 + v) / 3 and
  /// the mean of squares (1 + v + v^2) / 6. `corner`, `squares`: the means of v and v^2; `square`: of v, squared.
  static constexpr float variance_of(float corner, float squares, float square) noexcept {
    return (1 + corner + squares) / 6 - (1 + 2 * corner + square) / 9;
  }

  float least_, rise_, fall_, rising_;
  float falling_ = 0;
  float share_ = 0;  ///< of the triangle with the rising line in the area
};

/// A path of steps that is a digital straight segment: its points satisfy mu <= a x - b y < mu + a + b, in the frame of
/// its first two directions.
class StraightSegment {
 public:
  /// Maximum number of steps: products of coordinates fit in 32 bits.
  static constexpr std::size_t kMost = 4096;

  struct Point {
    std::int32_t x = 0, y = 0;
    friend bool operator==(const Point&, const Point&) = default;
  };

  friend bool operator==(const StraightSegment&, const StraightSegment&) = default;

  /// Appends a step if the path stays a digital straight segment. Returns whether it does.
  constexpr bool add(GridStep step) noexcept {
    if (count_ == kMost) return false;
    const unsigned turn = count_ == 0 ? 0 : (static_cast<unsigned>(step) - first_) & 3u;
    if (turn == 2 || (turn != 0 && turn_ != 0 && turn != turn_)) return false;
    Point next = end_;
    (turn == 0 ? next.x : next.y) += 1;
    const std::int32_t r = rest(next);
    if (r < mu_ - 1 || r > mu_ + a_ + b_) return false;
    if (count_ == 0) first_ = static_cast<unsigned>(step);
    if (turn != 0) turn_ = turn;
    if (r == mu_ - 1) {
      // steeper: the line through the first upper leaning point and the new one
      set_direction(upper_first_, next);
      upper_last_ = next;
      lower_first_ = lower_last_;
      mu_ = rest(upper_first_);
    } else if (r == mu_ + a_ + b_) {
      // flatter: the line through the first lower leaning point and the new one
      set_direction(lower_first_, next);
      lower_last_ = next;
      upper_first_ = upper_last_;
      mu_ = rest(lower_first_) - a_ - b_ + 1;
    } else {
      if (r == mu_) upper_last_ = next;
      if (r == mu_ + a_ + b_ - 1) lower_last_ = next;
    }
    sum_.x += end_.x + next.x;
    sum_.y += end_.y + next.y;
    end_ = next;
    ++count_;
    return true;
  }

  /// Takes the segment into another frame: its first two directions become these. `second` is `first` if the segment
  /// has only one.
  constexpr void set_directions(GridStep first, GridStep second) noexcept {
    first_ = static_cast<unsigned>(first);
    turn_ = (static_cast<unsigned>(second) - first_) & 3u;
  }

  [[nodiscard]] constexpr std::size_t size() const noexcept { return count_; }
  /// The direction and the place of a segment. In the frame of its first two directions, the direction is (b, a). With
  /// rest(x, y) = a x - b y, the line consists of the points with 2 rest = doubled_mean: it passes through the mean of
  /// the middles of all steps.
  struct Line {
    std::int16_t a = 0, b = 1;  // small, for tables
    float doubled_mean = 0;
    /// Weight of the line in a curve of several segments: the squared length of the direction, for lines with this
    /// direction differ by at most the inverse of the length. If the segment has fewer than two periods, over the
    /// standard deviation of all separating lines, relative to that of those with this direction. (The variance would
    /// be right for straight curves. In curved ones, long segments would then count too little, and balls get too
    /// large.)
    float precision = 1;
    friend bool operator==(const Line&, const Line&) = default;
  };
  [[nodiscard]] constexpr Line line() const noexcept {
    const double sum =
        static_cast<double>(a_) * static_cast<double>(sum_.x) - static_cast<double>(b_) * static_cast<double>(sum_.y);
    Line line{static_cast<std::int16_t>(a_), static_cast<std::int16_t>(b_),
              static_cast<float>(sum / static_cast<double>(count_)), squared_length()};
    // with two periods or more, the variance is nearly that of the lines with this direction
    if (count_ < 2 * static_cast<std::size_t>(a_ + b_))
      line.precision /= square_root(12 * separating_lines().mean_variance(static_cast<float>(count_)));
    return line;
  }
  /// a^2 + b^2, for the direction (b, a).
  [[nodiscard]] constexpr float squared_length() const noexcept { return static_cast<float>(a_ * a_ + b_ * b_); }
  /// At least one step.
  [[nodiscard]] constexpr SeparatingLines separating_lines() const noexcept {
    const auto place = [](const Point& p) { return static_cast<float>(p.x + p.y); };
    // leaning points have pixels beside them: the upper ones below the path, the lower ones above it
    return {static_cast<float>(mu_) + 0.5f * static_cast<float>(a_ + b_) - 1,
            {place(lower_first_), place(upper_last_)},
            {place(upper_first_), place(lower_last_)}};
  }

 private:
  [[nodiscard]] constexpr std::int32_t rest(const Point& p) const noexcept { return a_ * p.x - b_ * p.y; }
  constexpr void set_direction(const Point& from, const Point& to) noexcept {
    a_ = to.y - from.y;
    b_ = to.x - from.x;
  }

  std::int32_t a_ = 0, b_ = 1, mu_ = 0;
  Point end_{}, upper_first_{}, upper_last_{}, lower_first_{}, lower_last_{};
  Point sum_{};  ///< of both ends of all steps
  std::size_t count_ = 0;
  unsigned first_ = 0;  ///< direction of the first step
  unsigned turn_ = 0;   ///< from it to the other direction, in quarter turns; 0: none yet
};

}  // namespace tegl::detail
