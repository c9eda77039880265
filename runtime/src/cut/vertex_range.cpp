// SPDX-License-Identifier: BSD-3-Clause
//
// Ranges of vertex numbers. Highway's foreach_target compiles this file once per instruction set.
#include "cut/vertex_range.hpp"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cut/vertex_range.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

VertexRange range_of_numbers(std::span<const Index> numbers) {
  const hn::ScalableTag<Index> d;
  const std::size_t lanes = hn::Lanes(d);
  VertexRange range;
  std::size_t i = 0;
  if (numbers.size() >= 2 * lanes) {
    auto least = hn::LoadU(d, numbers.data()), most = least;
    auto other_least = least, other_most = least;
    for (; i + 2 * lanes <= numbers.size(); i += 2 * lanes) {
      const auto first = hn::LoadU(d, numbers.data() + i), second = hn::LoadU(d, numbers.data() + i + lanes);
      least = hn::Min(least, first);
      most = hn::Max(most, first);
      other_least = hn::Min(other_least, second);
      other_most = hn::Max(other_most, second);
    }
    range.least = hn::GetLane(hn::MinOfLanes(d, hn::Min(least, other_least)));
    range.most = hn::GetLane(hn::MaxOfLanes(d, hn::Max(most, other_most)));
  }
  for (; i < numbers.size(); ++i) {
    range.least = std::min(range.least, numbers[i]);
    range.most = std::max(range.most, numbers[i]);
  }
  return range;
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(range_of_numbers);
VertexRange vertex_range(std::span<const Index> numbers) { return HWY_DYNAMIC_DISPATCH(range_of_numbers)(numbers); }

}  // namespace tegl::detail

#endif  // HWY_ONCE
