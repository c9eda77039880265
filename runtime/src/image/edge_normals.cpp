// SPDX-License-Identifier: BSD-3-Clause
//
// Normals on critical edges (see edge_normals.hpp and row_gradients.hpp). Highway's foreach_target compiles this file
// once per instruction set. Multiplications and additions are not fused, and roots and quotients are correctly rounded,
// so that all instruction sets give identical bytes.
#include "image/edge_normals.hpp"

#include <algorithm>
#include <bit>

#include "base/request_memory.hpp"
#include "image/row_gradients.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/edge_normals.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "image/vectors.hpp"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class Real, class D>
HWY_INLINE auto to_real(D /*d*/, hn::Vec<D> value) {
  if constexpr (std::is_same_v<Real, hn::TFromD<D>>)
    return value;
  else
    return hn::DemoteTo(hn::Rebind<Real, D>(), value);
}

/// Positions on as many edges as D has lanes.
template <class D>
HWY_INLINE hn::Vec<D> load_alphas(D d, const double* from) {
  if constexpr (std::is_same_v<hn::TFromD<D>, double>) {
    return hn::LoadU(d, from);
#if HWY_TARGET == HWY_SCALAR
  } else {
    return hn::Set(d, static_cast<float>(*from));
#else
  } else {
    const hn::Half<D> half;
    const hn::Rebind<double, decltype(half)> wide;
    const auto some = [&](std::size_t i) HWY_ATTR { return hn::DemoteTo(half, hn::LoadU(wide, from + i)); };
    return hn::Combine(d, some(hn::MaxLanes(half)), some(0));
#endif
  }
}

/// Gradients in axis coordinates of as many edges as D has lanes, starting at edge `i`.
template <class D, int N, class Real>
HWY_INLINE std::array<hn::Vec<D>, N> gradients(D d, const NormalRow<N, Real, hn::TFromD<D>>& row, std::size_t i) {
  const auto value = [&](unsigned place) { return hn::LoadU(d, row.values + place * kEdgesAtOnce + i); };
  const auto axis = static_cast<unsigned>(row.axis);
  const auto first = value(4 * axis + 2);
  const auto second = value(4 * axis + 1);
  const auto alpha = load_alphas(d, row.alphas + i);
  std::array<hn::Vec<D>, N> result;
  for (unsigned a = 0; a < N; ++a) {
    const auto weight = [&](unsigned j) {
      return a == 0 && row.row_weights != nullptr ? hn::LoadU(d, row.row_weights + j * kEdgesAtOnce + i)
                                                  : hn::Set(d, row.weights[a][j]);
    };
    const auto derivative = [&](hn::Vec<D> backward, hn::Vec<D> here, hn::Vec<D> forward, unsigned j) {
      return hn::Add(hn::Mul(hn::Sub(forward, here), weight(j + 1)), hn::Mul(hn::Sub(here, backward), weight(j)));
    };
    const auto at_first = derivative(value(4 * a), first, value(4 * a + 1), 0);
    const auto at_second = derivative(value(4 * a + 2), second, value(4 * a + 3), 2);
    result[a] = hn::Add(at_first, hn::Mul(alpha, hn::Sub(at_second, at_first)));
  }
  return result;
}

/// Writes normals of length 1 in the direction of gradients, or against it if `sign` is -1. Returns the lanes whose
/// normals are undefined.
template <class Real, class D, std::size_t N>
HWY_INLINE Word write_unit(D d, const std::array<hn::Vec<D>, N>& gradient, hn::Vec<D> sign, Real* out) {
  using Calc = hn::TFromD<D>;
  constexpr bool kFloat = std::is_same_v<Calc, float>;
  // Within these bounds, squares and the reciprocals of their roots are accurate to the last bits.
  const auto least = hn::Set(d, static_cast<Calc>(kFloat ? 1e-30 : 1e-280));
  const auto most = hn::Set(d, static_cast<Calc>(kFloat ? 1e30 : 1e280));
  auto square = hn::Zero(d);
  for (unsigned a = 0; a < N; ++a) square = hn::Add(square, hn::Mul(gradient[a], gradient[a]));
  const auto inverse = hn::Div(sign, hn::Sqrt(square));
  const hn::Rebind<Real, D> real;
  std::array<hn::Vec<decltype(real)>, N> result;
  for (unsigned a = 0; a < N; ++a) result[a] = to_real<Real>(d, hn::Mul(gradient[a], inverse));
  store_points(real, result, out);
  // lanes out of bounds
  const auto good = hn::And(hn::Gt(square, least), hn::Lt(square, most));
  if (HWY_LIKELY(hn::AllTrue(d, good))) return 0;
  alignas(8) std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, good, bits);
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  Word lanes = 0;
  for (std::size_t byte = 0; byte < (kLanes + 7) / 8; ++byte) lanes |= Word{bits[byte]} << (8 * byte);
  return ~lanes & ((Word{1} << kLanes) - 1);
}

/// Writes as many normals as D has lanes. Returns the lanes whose normals are undefined.
template <class D, int N, class Real>
HWY_INLINE Word write_some(D d, const NormalRow<N, Real, hn::TFromD<D>>& row, std::size_t i, Real* out) {
  const auto gradient = gradients(d, row, i);
  const auto sign = hn::Set(d, row.sign);
  if (row.to_world == nullptr) return write_unit<Real>(d, gradient, sign, out);
  std::array<hn::Vec<D>, N> in_world;
  for (unsigned a = 0; a < N; ++a) {
    in_world[a] = hn::Zero(d);
    for (unsigned b = 0; b < N; ++b)
      in_world[a] = hn::Add(in_world[a], hn::Mul(hn::Set(d, row.to_world[a * N + b]), gradient[b]));
  }
  return write_unit<Real>(d, in_world, hn::Set(d, hn::TFromD<D>{1}), out);
}

template <int N, class Real, class Calc>
HWY_INLINE Word normals(const NormalRow<N, Real, Calc>& row) {
  const hn::ScalableTag<Calc> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  Word left = 0;
  std::size_t i = 0;
  for (; i + kLanes <= row.count; i += kLanes) left |= write_some(d, row, i, row.out[i].data()) << i;
  if (i == row.count) return left;
  std::array<std::array<Real, N>, kLanes> last;
  left |= write_some(d, row, i, last[0].data()) << i;
  std::copy_n(last.begin(), row.count - i, row.out + i);
  return left & ((Word{1} << row.count) - 1);
}

/// Reads an entry of a struct by itself. The struct may just have been written entry by entry; a vector load of several
/// would wait for these stores.
template <class T>
HWY_INLINE T read_alone(const T& entry) {
  const volatile T& alone = entry;
  return alone;
}

template <int N>
HWY_INLINE void row_gradients(const RowDifferences<N>& row) {
  const hn::ScalableTag<float> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  static_assert(kLanes + 2 <= kLeastRow);
  // local, because stores of vectors may change any memory
  std::array<std::array<const float*, 2>, N> beside;
  std::array<std::array<hn::Vec<decltype(d)>, 2>, N> weights;
  const float* const centre = read_alone(row.here);
  for (unsigned a = 0; a < N; ++a) {
    beside[a] = {a == 0 ? centre - 1 : read_alone(row.backward[a]), a == 0 ? centre + 1 : read_alone(row.forward[a])};
    weights[a] = {hn::Set(d, static_cast<float>(read_alone(row.weights[a].backward))),
                  hn::Set(d, static_cast<float>(read_alone(row.weights[a].forward)))};
  }
  float* const out = row.out;
  const std::size_t pitch = row.pitch, last = row.samples - 1 - kLanes;
  const std::ptrdiff_t next = row.next;
  const auto some = [&](std::size_t x) HWY_ATTR {
    const auto here = hn::LoadU(d, centre + x);
    for (unsigned a = 0; a < N; ++a) {
      const float* const forward = beside[a][1] + x;
      const auto ahead = hn::Mul(hn::Sub(hn::LoadU(d, forward), here), weights[a][1]);
      const float* const backward = beside[a][0] + x;
      const auto back = hn::Mul(hn::Sub(here, hn::LoadU(d, backward)), weights[a][0]);
      hn::StoreU(hn::Add(ahead, back), d, out + a * pitch + x);
      if (a != 0) hwy::Prefetch(forward + next);
      if (a == N - 1) hwy::Prefetch(backward + next);
    }
  };
  // The first sample has no neighbour before it. From the second register on, stores are aligned.
  some(1);
  for (std::size_t x = kLanes; x < last; x += kLanes) some(x);
  some(last);
  for (unsigned end = 0; end < 2; ++end) {
    const std::size_t x = end == 0 ? 0 : row.samples - 1;
    for (unsigned a = 0; a < N; ++a) {
      const StepWeights& steps = a == 0 ? row.ends[end] : row.weights[a];
      const float* const back = a == 0 && end == 0 ? centre : beside[a][0];
      const float* const ahead = a == 0 && end == 1 ? centre : beside[a][1];
      out[a * pitch + x] = (ahead[x] - centre[x]) * static_cast<float>(steps.forward) +
                           (centre[x] - back[x]) * static_cast<float>(steps.backward);
    }
  }
}

/// Positions on the edges of a row, which are found by the bits of the edges.
class PositionsOnRow {
 public:
  using D = hn::ScalableTag<float>;

  /// `working`: as many floats as the row has samples, and kRowMargin.
  HWY_INLINE PositionsOnRow(const std::uint32_t* at, const double* alphas, std::size_t count, float* working)
      : next_(working) {
#if HWY_TARGET <= HWY_AVX3
    static_cast<void>(at);
    const D d;
    for (std::size_t i = 0; i < count; i += hn::MaxLanes(d)) hn::StoreU(load_alphas(d, alphas + i), d, working + i);
#else
    for (std::size_t i = 0; i < count; ++i) working[at[i]] = static_cast<float>(alphas[i]);
#endif
  }
  /// Positions on the edges from the samples x, x + 1 ...; undefined where `edges`, `count` of them, has none.
  HWY_INLINE hn::Vec<D> at(std::size_t x, hn::Mask<D> edges, std::size_t count) {
#if HWY_TARGET <= HWY_AVX3
    static_cast<void>(x);
    const auto positions = hn::LoadU(D(), next_);
    next_ += count;
    return hn::Vec<D>{_mm512_maskz_expand_ps(edges.raw, positions.raw)};
#else
    static_cast<void>(edges);
    static_cast<void>(count);
    return hn::LoadU(D(), next_ + x);
#endif
  }

 private:
  const float* next_;
};

/// Interpolates the gradients at the ends of edges. Whole registers are computed, and the lanes with edges stored.
template <int N>
HWY_INLINE void interpolate(const EdgesOfRow<N>& edges) {
  const hn::ScalableTag<float> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  // local, because stores of vectors may change any memory
  const std::size_t samples = edges.samples, pitch = edges.pitch;
  const Word* const critical = edges.critical;
  const float* const first = edges.ends[0];
  const float* const second = edges.ends[1];
  float* out = edges.gradients;
  PositionsOnRow positions(edges.at, edges.alphas, edges.count, edges.positions);
  for (std::size_t x = 0; x < samples; x += kLanes) {
    const Word bits = critical[x / kWordBits] >> (x % kWordBits) & ((Word{1} << kLanes) - 1);
    const auto count = static_cast<std::size_t>(std::popcount(bits));
    const auto alpha = positions.at(x, mask_of(d, bits), count);
    for (unsigned a = 0; a < N; ++a) {
      const auto here = hn::LoadU(d, first + a * pitch + x);
      const auto there = hn::LoadU(d, second + a * pitch + x);
      const auto between = hn::Add(here, hn::Mul(alpha, hn::Sub(there, here)));
      hn::StoreU(chosen_lanes(d, between, bits), d, out + a * pitch);
    }
    out += count;
  }
}

template <int N>
HWY_INLINE void row_normals(const EdgesOfRow<N>& edges) {
  const hn::ScalableTag<float> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  interpolate(edges);
  const auto sign = hn::Set(d, edges.sign);
  const std::size_t count = edges.count, pitch = edges.pitch;
  const float* const from = edges.gradients;
  Word* const left = edges.left;
  std::array<float, N>* const out = edges.out;
  const auto some = [&](std::size_t i, float* to) HWY_ATTR {
    std::array<hn::Vec<decltype(d)>, N> gradient;
    for (unsigned a = 0; a < N; ++a) gradient[a] = hn::LoadU(d, from + a * pitch + i);
    if constexpr (N == 3) request_ahead(to, kLanes * sizeof(out[0]));
    const Word lanes = write_unit<float>(d, gradient, sign, to);
    if (HWY_LIKELY(lanes == 0)) return;
    left[i / kWordBits] |= lanes << (i % kWordBits);
    if (i % kWordBits > kWordBits - kLanes) left[i / kWordBits + 1] |= lanes >> (kWordBits - i % kWordBits);
  };
  std::fill_n(left, count / kWordBits + 1, Word{0});
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) some(i, out[i].data());
  if (i == count) return;
  if (count >= kLanes) return some(count - kLanes, out[count - kLanes].data());  // some are written twice
  std::array<std::array<float, N>, kLanes> last;
  some(0, last[0].data());
  std::copy_n(last.begin(), count, out);
  left[0] &= (Word{1} << count) - 1;
}

// Highway's dispatch tables cannot hold templates.
void gradients_2(const RowDifferences<2>& row) { row_gradients(row); }
void gradients_3(const RowDifferences<3>& row) { row_gradients(row); }
void gradients_4(const RowDifferences<4>& row) { row_gradients(row); }
void row_normals_2(const EdgesOfRow<2>& edges) { row_normals(edges); }
void row_normals_3(const EdgesOfRow<3>& edges) { row_normals(edges); }
void row_normals_4(const EdgesOfRow<4>& edges) { row_normals(edges); }
Word normals2f(const NormalRow<2, float, float>& row) { return normals(row); }
Word normals3f(const NormalRow<3, float, float>& row) { return normals(row); }
Word normals4f(const NormalRow<4, float, float>& row) { return normals(row); }
Word normals2m(const NormalRow<2, float, double>& row) { return normals(row); }
Word normals3m(const NormalRow<3, float, double>& row) { return normals(row); }
Word normals4m(const NormalRow<4, float, double>& row) { return normals(row); }
Word normals2d(const NormalRow<2, double, double>& row) { return normals(row); }
Word normals3d(const NormalRow<3, double, double>& row) { return normals(row); }
Word normals4d(const NormalRow<4, double, double>& row) { return normals(row); }

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

#define TEGL_DISPATCH(N, Real, Calc, name)                                          \
  HWY_EXPORT(name);                                                                 \
  template <>                                                                       \
  Word write_normals<N, Real, Calc>(const NormalRow<N, Real, Calc>& row) noexcept { \
    return HWY_DYNAMIC_DISPATCH(name)(row);                                         \
  }
TEGL_DISPATCH(2, float, float, normals2f)
TEGL_DISPATCH(3, float, float, normals3f)
TEGL_DISPATCH(4, float, float, normals4f)
TEGL_DISPATCH(2, float, double, normals2m)
TEGL_DISPATCH(3, float, double, normals3m)
TEGL_DISPATCH(4, float, double, normals4m)
TEGL_DISPATCH(2, double, double, normals2d)
TEGL_DISPATCH(3, double, double, normals3d)
TEGL_DISPATCH(4, double, double, normals4d)
#undef TEGL_DISPATCH

#define TEGL_DISPATCH(N)                                               \
  HWY_EXPORT(gradients_##N);                                           \
  template <>                                                          \
  void write_row_gradients<N>(const RowDifferences<N>& row) noexcept { \
    HWY_DYNAMIC_DISPATCH(gradients_##N)(row);                          \
  }                                                                    \
  HWY_EXPORT(row_normals_##N);                                         \
  template <>                                                          \
  void write_row_normals<N>(const EdgesOfRow<N>& edges) noexcept {     \
    HWY_DYNAMIC_DISPATCH(row_normals_##N)(edges);                      \
  }
TEGL_DISPATCH(2)
TEGL_DISPATCH(3)
TEGL_DISPATCH(4)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
