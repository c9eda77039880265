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
  /// Squared length of the segment's direction (b, a): lines that separate as the segment does differ by at most the
  /// inverse of the length.
  [[nodiscard]] double precision() const noexcept { return static_cast<double>(a_ * a_ + b_ * b_); }

  /// Follows the steps of the segment again, and finds for each the distance of the line from the middle of the step,
  /// across the step. The line has the direction of the segment and the middle of the middles of all steps.
  class Offsets {
   public:
    explicit Offsets(const StraightSegment& segment) noexcept
        : segment_(segment),
          mean_((static_cast<double>(segment.a_) * static_cast<double>(segment.sum_.x) -
                 static_cast<double>(segment.b_) * static_cast<double>(segment.sum_.y)) /
                static_cast<double>(segment.count_)) {}

    /// The offset along the positive axis across `step`, which is the next step of the segment.
    [[nodiscard]] double next(GridStep step) noexcept {
      const unsigned turn = (static_cast<unsigned>(step) - segment_.first_) & 3u;
      Point next = at_;
      (turn == 0 ? next.x : next.y) += 1;
      const auto doubled = static_cast<double>(segment_.rest(at_) + segment_.rest(next));
      at_ = next;
      if (turn != 0) {
        const double along = 0.5 * (mean_ - doubled) / static_cast<double>(segment_.a_);
        return segment_.first_ < 2 ? along : -along;
      }
      const double across = 0.5 * (doubled - mean_) / static_cast<double>(segment_.b_);
      const unsigned up = (segment_.first_ + (segment_.turn_ == 0 ? 1u : segment_.turn_)) & 3u;
      return up < 2 ? across : -across;
    }

   private:
    const StraightSegment& segment_;
    double mean_;  ///< doubled
    Point at_{};
  };

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
