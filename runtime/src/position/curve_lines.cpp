// SPDX-License-Identifier: BSD-3-Clause
//
// Fits lines to a curve (see curve_lines.hpp). Most segments are short, and come from a table.
#include "position/curve_lines.hpp"

#include <algorithm>

#include "position/short_segments.hpp"

namespace tegl::detail {

namespace {

bool is_positive(GridStep step) noexcept { return step == GridStep::right || step == GridStep::up; }

}  // namespace

void CurveLines::fit(bool closed, float weight) {
  const std::size_t count = steps_.size();
  prepare(closed ? 2 * count : count);
  for (std::size_t first = 0; first < count;) {
    const Segment segment = segment_from(first, closed ? count : count - first);
    if (!closed && segment.size == count) {
      add_straight_curve(weight);
      break;
    }
    add(first, segment, weight);
    if (!closed && first + segment.size == count) break;
    first += std::max<std::size_t>(1, segment.size / 3);
  }
  // steps after the last one are those from the first one on
  for (std::size_t i = count; i < fits_.size(); ++i) {
    fits_[i - count].sum += fits_[i].sum;
    fits_[i - count].weight += fits_[i].weight;
  }
}

void CurveLines::prepare(std::size_t count) {
  const std::size_t listed = steps_.size();
  steps_.resize(count);
  for (std::size_t i = listed; i < count; ++i) steps_[i] = steps_[i - listed];
  vertical_.assign(count / kWordBits + 2, 0);
  for (std::size_t i = 0; i < count; ++i)
    vertical_[i / kWordBits] |= Word{static_cast<unsigned>(steps_[i]) & 1u} << (i % kWordBits);
  ends_.resize(count);
  auto end = static_cast<std::uint32_t>(count);
  std::array<std::uint32_t, 4> next;  // by direction
  next.fill(end);
  for (std::size_t i = count; i-- > 0;) {
    const auto direction = static_cast<unsigned>(steps_[i]);
    end = std::min(end, next[direction ^ 2u]);
    next[direction] = static_cast<std::uint32_t>(i);
    ends_[i] = end;
  }
  fits_.assign(count, LineFit{});
}

CurveLines::Segment CurveLines::segment_from(std::size_t first, std::size_t most) const noexcept {
  most = std::min<std::size_t>(most, ends_[first] - first);
  const Word bits = turns(first);
  const std::size_t size = std::min(kShortSegments.size(bits), most);
  if (size < ShortSegments::kSteps || most == size) return {size, kShortSegments.line(bits, size)};
  StraightSegment segment = kShortSegments.whole(bits, steps_.data() + first);
  while (segment.size() < most && segment.add(steps_[first + segment.size()])) {
  }
  return {segment.size(), segment.line()};
}

void CurveLines::add_straight_curve(float weight) noexcept {
  StraightSegment segment;
  for (const GridStep step : steps_) segment.add(step);
  const StraightSegment::Line line = segment.line();
  const SeparatingLines lines = segment.separating_lines();
  const auto is_turned = [&](GridStep step) {
    return ((static_cast<unsigned>(step) ^ static_cast<unsigned>(steps_.front())) & 1u) != 0;
  };
  // From the middle of a step to the mean line across the step, per rest: along the positive axis. p changes, too.
  const auto turn = std::find_if(steps_.begin(), steps_.end(), is_turned);
  const float flat = turn == steps_.end() || is_positive(*turn) ? 1 : -1, steep = is_positive(steps_.front()) ? 1 : -1;
  const std::array<float, 2> factors = {flat / (static_cast<float>(line.b) + lines.slope()),
                                        steep / (lines.slope() - static_cast<float>(line.a))};
  std::int32_t rest = 0;  // at the start of a step
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const std::size_t turned = is_turned(steps_[i]) ? 1 : 0;
    const std::int32_t move = turned != 0 ? -line.b : line.a;
    const float middle = static_cast<float>(i) + 0.5f;
    const float precision = weight * segment.squared_length() / (12 * lines.variance(middle));
    const float place = 0.5f + (0.5f * static_cast<float>(2 * rest + move) - lines.mean(middle)) * factors[turned];
    fits_[i] = {place * precision, precision};
    rest += move;
  }
}

void CurveLines::add(std::size_t first, const Segment& segment, float weight) noexcept {
  const StraightSegment::Line& line = segment.line;
  Word bits = turns(first);
  weight *= line.precision;
  // The line's distance from the middle of a step, across the step: along the positive axis, times the weight.
  std::array<std::int32_t, 2> moves = {line.a, -line.b};
  std::array<float, 2> factors = {0.5f * weight / static_cast<float>(line.b), 0.0f};
  if (line.a != 0) {
    std::size_t turn = first + 1;
    while ((static_cast<unsigned>(steps_[turn]) & 1u) == (static_cast<unsigned>(steps_[first]) & 1u)) ++turn;
    if (!is_positive(steps_[turn])) factors[0] = -factors[0];
    factors[1] = (is_positive(steps_[first]) ? -0.5f : 0.5f) * weight / static_cast<float>(line.a);
  }
  std::int32_t rest = 0;  // a x - b y at the start of a step
  for (std::size_t i = 0; i < segment.size; ++i, bits >>= 1) {
    if (i != 0 && i % kWordBits == 0) {
      bits = turns(first + i);
      if (((static_cast<unsigned>(steps_[first + i]) ^ static_cast<unsigned>(steps_[first])) & 1u) != 0) bits = ~bits;
    }
    const std::size_t turned = bits & 1u;
    const std::int32_t move = moves[turned];
    LineFit& fit = fits_[first + i];
    fit.sum += 0.5f * weight + (static_cast<float>(2 * rest + move) - line.doubled_mean) * factors[turned];
    fit.weight += weight;
    rest += move;
  }
}

}  // namespace tegl::detail
