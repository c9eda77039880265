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
#include <cstddef>
#include <cstdint>

namespace tegl::detail {

/// The direction of a step between neighbouring points of the square grid: +x, +y, -x, -y.
enum class GridStep : std::uint8_t { right, up, left, down };

/// A path of steps that is a digital straight segment: its points satisfy mu <= a x - b y < mu + a + b, in the frame of
/// its first two directions.
class StraightSegment {
 public:
  /// Maximum number of steps: products of coordinates fit in 32 bits.
  static constexpr std::size_t kMost = 4096;

  struct Point {
    std::int32_t x = 0, y = 0;
  };

  /// Appends a step if the path stays a digital straight segment. Returns whether it does.
  bool add(GridStep step) noexcept {
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

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  /// The direction and the place of a segment. In the frame of its first two directions, the direction is (b, a). With
  /// rest(x, y) = a x - b y, the line consists of the points with 2 rest = doubled_mean: it passes through the mean of
  /// the middles of all steps.
  struct Line {
    std::int32_t a = 0, b = 1;
    float doubled_mean = 0;
    /// Squared length of the direction: lines that separate as the segment does differ by at most the inverse of the
    /// length.
    [[nodiscard]] float precision() const noexcept { return static_cast<float>(a * a + b * b); }
  };
  [[nodiscard]] Line line() const noexcept {
    const double sum =
        static_cast<double>(a_) * static_cast<double>(sum_.x) - static_cast<double>(b_) * static_cast<double>(sum_.y);
    return {a_, b_, static_cast<float>(sum / static_cast<double>(count_))};
  }

 private:
  [[nodiscard]] std::int32_t rest(const Point& p) const noexcept { return a_ * p.x - b_ * p.y; }
  void set_direction(const Point& from, const Point& to) noexcept {
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
