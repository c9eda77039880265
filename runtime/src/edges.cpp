// SPDX-License-Identifier: BSD-3-Clause
//
// Where contours cross edges; compiled once per instruction set (Highway's foreach_target). Additions and
// multiplications stay apart, so that all sets give the same bytes.
#include <algorithm>
#include <cmath>

#include "extract_source.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "edges.cpp"
#include "dispatch.hpp"
// Highway's own headers come after this one.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One edge, whatever its values.
HWY_INLINE double alpha_of(double a, double b, double isovalue, double epsilon) {
  const double difference = b - a;
  double alpha = 0;
  if (std::isfinite(difference))
    alpha = (isovalue - a) / difference;
  else if (std::isinf(a))
    alpha = std::isinf(b) ? 0.5 : 1.0;
  else if (!std::isinf(b))
    alpha = (0.5 * isovalue - 0.5 * a) / (0.5 * b - 0.5 * a);
  return std::clamp(alpha, epsilon, 1.0 - epsilon) + 0.0;  // never -0, of which instruction sets make this or that
}

template <class T>
HWY_INLINE void alphas(const T* a, const T* b, std::ptrdiff_t stride, const std::uint32_t* at, std::size_t count,
                       double isovalue, double epsilon, double* out) {
  const hn::ScalableTag<double> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  alignas(64) double from[kLanes];
  alignas(64) double to[kLanes];
  const auto threshold = hn::Set(d, isovalue);
  const auto least = hn::Set(d, epsilon);
  const auto most = hn::Set(d, 1.0 - epsilon);
  const auto finite = hn::Set(d, std::numeric_limits<double>::max());
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) {
      const std::ptrdiff_t place = stride * static_cast<std::ptrdiff_t>(at[i + j]);
      from[j] = static_cast<double>(a[place]);
      to[j] = static_cast<double>(b[place]);
    }
    const auto start = hn::Load(d, from);
    const auto difference = hn::Sub(hn::Load(d, to), start);
    if (!hn::AllTrue(d, hn::Le(hn::Abs(difference), finite))) {
      for (std::size_t j = 0; j < kLanes; ++j) out[i + j] = alpha_of(from[j], to[j], isovalue, epsilon);
      continue;
    }
    const auto alpha = hn::Div(hn::Sub(threshold, start), difference);
    hn::StoreU(hn::Add(hn::Min(hn::Max(alpha, least), most), hn::Zero(d)), d, out + i);
  }
  for (; i < count; ++i) {
    const std::ptrdiff_t place = stride * static_cast<std::ptrdiff_t>(at[i]);
    out[i] = alpha_of(static_cast<double>(a[place]), static_cast<double>(b[place]), isovalue, epsilon);
  }
}

#define TEGL_EDGES(T, name)                                                                            \
  void name(const T* a, const T* b, std::ptrdiff_t stride, const std::uint32_t* at, std::size_t count, \
            double isovalue, double epsilon, double* out) {                                            \
    alphas(a, b, stride, at, count, isovalue, epsilon, out);                                           \
  }
TEGL_EDGES(std::uint8_t, alphas_u8)
TEGL_EDGES(std::int8_t, alphas_i8)
TEGL_EDGES(std::uint16_t, alphas_u16)
TEGL_EDGES(std::int16_t, alphas_i16)
TEGL_EDGES(std::int32_t, alphas_i32)
TEGL_EDGES(float, alphas_f32)
TEGL_EDGES(double, alphas_f64)
#undef TEGL_EDGES

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

#define TEGL_DISPATCH(T, name)                                                                                   \
  HWY_EXPORT(name);                                                                                              \
  template <>                                                                                                    \
  void edge_alphas<T>(const T* a, const T* b, std::ptrdiff_t stride, const std::uint32_t* at, std::size_t count, \
                      double isovalue, double epsilon, double* out) noexcept {                                   \
    HWY_DYNAMIC_DISPATCH(name)(a, b, stride, at, count, isovalue, epsilon, out);                                 \
  }
TEGL_DISPATCH(std::uint8_t, alphas_u8)
TEGL_DISPATCH(std::int8_t, alphas_i8)
TEGL_DISPATCH(std::uint16_t, alphas_u16)
TEGL_DISPATCH(std::int16_t, alphas_i16)
TEGL_DISPATCH(std::int32_t, alphas_i32)
TEGL_DISPATCH(float, alphas_f32)
TEGL_DISPATCH(double, alphas_f64)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
