// SPDX-License-Identifier: BSD-3-Clause
//
// Intersections of contours with edges. Highway's foreach_target compiles this file once per instruction set.
// Multiplications and additions are not fused, so that all instruction sets give identical bytes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "image/edge_alphas.hpp"
#include "image/cube_heights.hpp"
#include "tegl/table_contract.hpp"
#include "tegl/tile/corners.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/edge_alphas.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"
#include "image/vectors.hpp"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Interpolation parameter of one edge, for any values.
HWY_INLINE double alpha_of(double a, double b, double isovalue, double epsilon) {
  const double difference = b - a;
  double alpha = 0;
  if (std::isfinite(difference))
    alpha = (isovalue - a) / difference;
  else if (std::isinf(a))
    alpha = std::isinf(b) ? 0.5 : 1.0;
  else if (!std::isinf(b))
    alpha = (0.5 * isovalue - 0.5 * a) / (0.5 * b - 0.5 * a);
  return std::clamp(alpha, epsilon, 1.0 - epsilon) + 0.0;  // never -0, for which instruction sets differ
}

/// Interpolation parameters of some edges from the samples at their ends, of type double or float.
template <class T>
HWY_INLINE void alphas_of(const T* from, const T* to, std::size_t count, double isovalue, double epsilon, double* out) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<T, decltype(d)> samples;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const auto threshold = hn::Set(d, isovalue);
  const auto least = hn::Set(d, epsilon);
  const auto most = hn::Set(d, 1.0 - epsilon);
  const auto finite = hn::Set(d, std::numeric_limits<double>::max());
  const auto value = [&](const T* at) HWY_ATTR {
    if constexpr (std::is_same_v<T, double>)
      return hn::LoadU(d, at);
    else
      return hn::PromoteTo(d, hn::LoadU(samples, at));
  };
  const auto each = [&](std::size_t first, std::size_t end) HWY_ATTR {
    for (std::size_t i = first; i < end; ++i)
      out[i] = alpha_of(static_cast<double>(from[i]), static_cast<double>(to[i]), isovalue, epsilon);
  };
  const auto some = [&](std::size_t i) HWY_ATTR {
    const auto start = value(from + i);
    const auto difference = hn::Sub(value(to + i), start);
    if (!hn::AllTrue(d, hn::Le(hn::Abs(difference), finite))) return each(i, i + kLanes);
    const auto alpha = hn::Div(hn::Sub(threshold, start), difference);
    hn::StoreU(hn::Add(hn::Min(hn::Max(alpha, least), most), hn::Zero(d)), d, out + i);
  };
  if (count < kLanes) return each(0, count);
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) some(i);
  if (i < count) some(count - kLanes);  // some are computed twice
}

template <class T>
HWY_INLINE void alphas(const EdgeSamples<T>& edges, double isovalue, double epsilon, double* out) {
  // Gathered in blocks: a vector load right after scalar stores to the same memory would stall.
  constexpr std::size_t kBlock = 128;
  double from[kBlock];
  double to[kBlock];
  for (std::size_t first = 0; first < edges.count; first += kBlock) {
    const std::size_t count = std::min(kBlock, edges.count - first);
    for (std::size_t i = 0; i < count; ++i) {
      const std::ptrdiff_t at = edges.rows[first + i] + static_cast<std::ptrdiff_t>(edges.at[first + i]) * edges.stride;
      from[i] = static_cast<double>(edges.starts[at]);
      to[i] = static_cast<double>(edges.ends[at]);
    }
    alphas_of(from, to, count, isovalue, epsilon, out + first);
  }
}

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128

/// Samples are read by registers, in which the ends of edges are chosen.
void alphas_of_row(const FloatRowEdges& row, double isovalue, double epsilon, double* out) {
  const hn::ScalableTag<float> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  static_assert(kLanes <= kLeastEdges);
  constexpr std::size_t kBlock = 256;
  float from[kBlock + kLanes];
  float to[kBlock + kLanes];
  // local, because stores of vectors may change any memory
  const FloatRowEdges edges = row;
  for (std::size_t first = 0; first < edges.edges; first += kBlock) {
    std::size_t count = 0;
    const auto some = [&](std::size_t x, std::size_t skipped) HWY_ATTR {
      const std::size_t shift = x % kWordBits;
      Word bits = edges.critical[x / kWordBits] >> shift;
      if (shift > kWordBits - kLanes) bits |= edges.critical[x / kWordBits + 1] << (kWordBits - shift);
      bits &= (Word{1} << kLanes) - (Word{1} << skipped);
      hn::StoreU(chosen_lanes(d, hn::LoadU(d, edges.starts + x), bits), d, from + count);
      hn::StoreU(chosen_lanes(d, hn::LoadU(d, edges.ends + x), bits), d, to + count);
      count += static_cast<std::size_t>(std::popcount(bits));
    };
    const std::size_t end = std::min(first + kBlock, edges.edges);
    std::size_t x = first;
    for (; x + kLanes <= end; x += kLanes) some(x, 0);
    if (x < end) some(end - kLanes, x - (end - kLanes));
    alphas_of(from, to, count, isovalue, epsilon, out);
    out += count;
  }
}

#else

void alphas_of_row(const FloatRowEdges& row, double isovalue, double epsilon, double* out) {
  for (std::size_t w = 0; w * kWordBits < row.edges; ++w)
    for (Word rest = row.critical[w]; rest != 0; rest &= rest - 1) {
      const std::size_t x = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
      *out++ = alpha_of(static_cast<double>(row.starts[x]), static_cast<double>(row.ends[x]), isovalue, epsilon);
    }
}

#endif

void alphas_of_ends(const double* from, const double* to, std::size_t count, double isovalue, double epsilon,
                    double* out) {
  alphas_of(from, to, count, isovalue, epsilon, out);
}

void alphas_of_float_ends(const float* from, const float* to, std::size_t count, double isovalue, double epsilon,
                          double* out) {
  alphas_of(from, to, count, isovalue, epsilon, out);
}

/// Interpolation parameters of all edges of a 4D tile, critical or not.
void alphas_4d(const double* corners, double isovalue, double epsilon, double* out) {
  constexpr unsigned kEdges = tables::edge_count(4);
  double from[kEdges];
  double to[kEdges];
  for (unsigned a = 0; a < 4; ++a)
    for (unsigned i = 0; i < kEdges / 4; ++i) {
      const unsigned base = edge_base(4, a * (kEdges / 4) + i);
      from[a * (kEdges / 4) + i] = corners[base];
      to[a * (kEdges / 4) + i] = corners[base | 1u << a];
    }
  alphas_of(from, to, kEdges, isovalue, epsilon, out);
}

/// Interpolation parameters of all edges of cells.
void alphas_by_edges(unsigned dim, const double* corners, std::size_t count, std::size_t pitch, double isovalue,
                     double epsilon, double* out) {
  const auto of_edges = [&](auto number) HWY_ATTR {
    for (unsigned e = 0; e < dim << (dim - 1); ++e) {
      const unsigned base = edge_base(dim, e);
      alphas_of(corners + base * pitch, corners + (base | 1u << (e >> (dim - 1))) * pitch, number, isovalue, epsilon,
                out + e * pitch);
    }
  };
  // mostly as many cells as there can be: a constant, so that the compiler unrolls the loop over them
  constexpr std::integral_constant<std::size_t, CubeRays::kMost> kMost;
  if (count == kMost)
    of_edges(kMost);
  else
    of_edges(count);
}

#define TEGL_EDGES(T, name)                                                              \
  void name(const EdgeSamples<T>& edges, double isovalue, double epsilon, double* out) { \
    alphas(edges, isovalue, epsilon, out);                                               \
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

#define TEGL_DISPATCH(T, name)                                                                              \
  HWY_EXPORT(name);                                                                                         \
  template <>                                                                                               \
  void edge_alphas<T>(const EdgeSamples<T>& edges, double isovalue, double epsilon, double* out) noexcept { \
    HWY_DYNAMIC_DISPATCH(name)(edges, isovalue, epsilon, out);                                              \
  }
HWY_EXPORT(alphas_of_ends);
void alphas_between(const double* from, const double* to, std::size_t count, double isovalue, double epsilon,
                    double* out) noexcept {
  HWY_DYNAMIC_DISPATCH(alphas_of_ends)(from, to, count, isovalue, epsilon, out);
}

HWY_EXPORT(alphas_of_float_ends);
void alphas_between(const float* from, const float* to, std::size_t count, double isovalue, double epsilon,
                    double* out) noexcept {
  HWY_DYNAMIC_DISPATCH(alphas_of_float_ends)(from, to, count, isovalue, epsilon, out);
}

HWY_EXPORT(alphas_of_row);
void row_alphas(const FloatRowEdges& row, double isovalue, double epsilon, double* out) noexcept {
  HWY_DYNAMIC_DISPATCH(alphas_of_row)(row, isovalue, epsilon, out);
}

HWY_EXPORT(alphas_4d);
void tile_alphas(const double* corners, double isovalue, double epsilon, double* out) noexcept {
  HWY_DYNAMIC_DISPATCH(alphas_4d)(corners, isovalue, epsilon, out);
}

HWY_EXPORT(alphas_by_edges);
void alphas_of_cells(unsigned dim, const double* corners, std::size_t count, std::size_t pitch, double isovalue,
                     double epsilon, double* out) noexcept {
  HWY_DYNAMIC_DISPATCH(alphas_by_edges)(dim, corners, count, pitch, isovalue, epsilon, out);
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
