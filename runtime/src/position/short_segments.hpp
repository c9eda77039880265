// SPDX-License-Identifier: BSD-3-Clause
//
// Table of all short digital straight segments and their lines, computed by the compiler.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "position/straight_segment.hpp"

namespace tegl::detail {

/// The segments of up to kSteps steps, by the bits of their turns: bit i is set if step i has another axis than the
/// first step.
class ShortSegments {
 public:
  static constexpr std::size_t kSteps = 10;

  constexpr ShortSegments() { add_longer({}, 0); }

  /// The number of steps of the longest segment with these turns; kSteps: as many or more.
  [[nodiscard]] constexpr std::size_t size(std::uint64_t turns) const noexcept {
    return sizes_[turns & (sizes_.size() - 1)];
  }
  /// The line of the segment of `size` steps.
  [[nodiscard]] constexpr const StraightSegment::Line& line(std::uint64_t turns, std::size_t size) const noexcept {
    return lines_[place(turns, size)];
  }
  /// The segment of kSteps steps, to be continued. `steps`: the steps of the curve.
  [[nodiscard]] constexpr StraightSegment whole(std::uint64_t turns, const GridStep* steps) const noexcept {
    turns &= sizes_.size() - 1;
    StraightSegment segment = whole_[turns / 2];
    segment.set_directions(steps[0], steps[turns == 0 ? 0 : std::countr_zero(turns)]);
    return segment;
  }

 private:
  static constexpr std::size_t place(std::uint64_t turns, std::size_t size) noexcept {
    const std::size_t end = std::size_t{1} << size;
    return end | (turns & (end - 1));
  }

  /// Enters all segments that continue this one. Each is made once: there are only 229.
  constexpr void add_longer(const StraightSegment& segment, std::uint32_t turns) {
    const std::size_t size = segment.size();
    for (std::uint32_t turn = 0; turn < (size == 0 ? 1u : 2u); ++turn) {
      const std::uint32_t longer = turns | turn << size;
      StraightSegment next = segment;
      if (!next.add(turn != 0 ? GridStep::up : GridStep::right)) {
        const std::uint32_t first_different = 2u << size;
        for (std::uint32_t bits = longer; bits < sizes_.size(); bits += first_different)
          sizes_[bits] = static_cast<std::uint8_t>(size);
        continue;
      }
      lines_[place(longer, next.size())] = next.line();
      if (next.size() < kSteps) {
        add_longer(next, longer);
        continue;
      }
      sizes_[longer] = kSteps;
      whole_[longer / 2] = next;
    }
  }

  std::array<std::uint8_t, std::size_t{1} << kSteps> sizes_{};
  std::array<StraightSegment::Line, std::size_t{1} << (kSteps + 1)> lines_{};
  std::array<StraightSegment, std::size_t{1} << (kSteps - 1)> whole_{};  // without the first bit, which is 0
};

inline constexpr ShortSegments kShortSegments;

}  // namespace tegl::detail
