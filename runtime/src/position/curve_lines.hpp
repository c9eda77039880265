// SPDX-License-Identifier: BSD-3-Clause
//
// Lines fitted to one curve of a contour's net: the curve is divided into overlapping digital straight segments.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/bitplanes.hpp"
#include "position/straight_segment.hpp"

namespace tegl::detail {

/// A sum of weighted positions on an edge (0 to 1), and its weight.
struct LineFit {
  float sum = 0, weight = 0;
};

/// A curve as the steps across its edges, and the lines fitted to it.
class CurveLines {
 public:
  void clear() noexcept { steps_.clear(); }
  void push_back(GridStep step) { steps_.push_back(step); }

  /// Fits lines; `weight` multiplies their precision. `closed`: the first step follows the last one.
  void fit(bool closed, float weight);
  /// The fit at a step.
  [[nodiscard]] LineFit operator[](std::size_t i) const noexcept { return fits_[i]; }

 private:
  /// The segment from a step on: its number of steps and its line.
  struct Segment {
    std::size_t size;
    StraightSegment::Line line;
  };
  [[nodiscard]] Segment segment_from(std::size_t first, std::size_t most) const noexcept;
  void add(std::size_t first, const Segment& segment, float weight) noexcept;
  /// Fits an open curve that is a single segment: by the mean of all lines that separate its pixels, each point
  /// weighted by their variance there.
  void add_straight_curve(float weight) noexcept;
  void prepare(std::size_t count);
  /// For the 64 steps from `first` on: whether their axis differs from the axis of step `first`.
  [[nodiscard]] Word turns(std::size_t first) const noexcept {
    const std::size_t w = first / kWordBits, shift = first % kWordBits;
    Word bits = vertical_[w] >> shift;
    if (shift != 0) bits |= vertical_[w + 1] << (kWordBits - shift);
    return (bits & 1u) != 0 ? ~bits : bits;
  }

  std::vector<GridStep> steps_;      ///< of a closed curve, twice
  std::vector<Word> vertical_;       ///< bits of the steps along the second axis, and a word more
  std::vector<std::uint32_t> ends_;  ///< by step: the first later step that is opposite to one from this one on
  std::vector<LineFit> fits_;
};

}  // namespace tegl::detail
