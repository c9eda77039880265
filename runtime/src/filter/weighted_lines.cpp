// SPDX-License-Identifier: BSD-3-Clause
//
// Sums lines by registers (see weighted_lines.hpp). Highway's foreach_target compiles this file once per instruction
// set.
#include "filter/weighted_lines.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filter/weighted_lines.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Registers summed at a time: enough to hide the latency of an addition.
constexpr std::size_t kRegisters = 4;

template <class D, class Real>
HWY_INLINE void sum_registers(D d, const Real* const* lines, const Real* weights, std::size_t count, std::size_t at,
                              Real* out) {
  const std::size_t lanes = hn::Lanes(d);
  auto weight = hn::Set(d, weights[0]);
  auto a = hn::Mul(weight, hn::LoadU(d, lines[0] + at));
  auto b = hn::Mul(weight, hn::LoadU(d, lines[0] + at + lanes));
  auto c = hn::Mul(weight, hn::LoadU(d, lines[0] + at + 2 * lanes));
  auto e = hn::Mul(weight, hn::LoadU(d, lines[0] + at + 3 * lanes));
  for (std::size_t t = 1; t < count; ++t) {
    const Real* const line = lines[t] + at;
    weight = hn::Set(d, weights[t]);
    a = hn::Add(a, hn::Mul(weight, hn::LoadU(d, line)));
    b = hn::Add(b, hn::Mul(weight, hn::LoadU(d, line + lanes)));
    c = hn::Add(c, hn::Mul(weight, hn::LoadU(d, line + 2 * lanes)));
    e = hn::Add(e, hn::Mul(weight, hn::LoadU(d, line + 3 * lanes)));
  }
  hn::StoreU(a, d, out + at);
  hn::StoreU(b, d, out + at + lanes);
  hn::StoreU(c, d, out + at + 2 * lanes);
  hn::StoreU(e, d, out + at + 3 * lanes);
}

template <class Real>
HWY_INLINE void sum_lines(const Real* const* lines, const Real* weights, std::size_t count, std::size_t width,
                          Real* out) {
  const hn::ScalableTag<Real> d;
  const std::size_t lanes = hn::Lanes(d);
  const std::size_t step = kRegisters * lanes;
  std::size_t i = 0;
  for (; i + step <= width; i += step) sum_registers(d, lines, weights, count, i, out);
  for (; i + lanes <= width; i += lanes) {
    auto sum = hn::Mul(hn::Set(d, weights[0]), hn::LoadU(d, lines[0] + i));
    for (std::size_t t = 1; t < count; ++t)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[t]), hn::LoadU(d, lines[t] + i)));
    hn::StoreU(sum, d, out + i);
  }
  for (; i < width; ++i) {
    Real sum = weights[0] * lines[0][i];
    for (std::size_t t = 1; t < count; ++t) sum += weights[t] * lines[t][i];
    out[i] = sum;
  }
}

void sum_floats(const float* const* lines, const float* weights, std::size_t count, std::size_t width, float* out) {
  sum_lines(lines, weights, count, width, out);
}
void sum_doubles(const double* const* lines, const double* weights, std::size_t count, std::size_t width, double* out) {
  sum_lines(lines, weights, count, width, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(sum_floats);
HWY_EXPORT(sum_doubles);

template <>
void weighted_lines<float>(const float* const* lines, const float* weights, std::size_t count, std::size_t width,
                           float* out) noexcept {
  HWY_DYNAMIC_DISPATCH(sum_floats)(lines, weights, count, width, out);
}
template <>
void weighted_lines<double>(const double* const* lines, const double* weights, std::size_t count, std::size_t width,
                            double* out) noexcept {
  HWY_DYNAMIC_DISPATCH(sum_doubles)(lines, weights, count, width, out);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
