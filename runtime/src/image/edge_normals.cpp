// SPDX-License-Identifier: BSD-3-Clause
//
// Normals on critical edges (see edge_normals.hpp and row_gradients.hpp). Highway's foreach_target compiles this file
// once per instruction set. Multiplications and additions are not fused, and roots and quotients are correctly rounded,
// so that all instruction sets give identical bytes.
#include "image/edge_normals.hpp"

#include <algorithm>

#include "image/row_gradients.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/edge_normals.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/cache_control.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V>
HWY_INLINE void store_normals(D d, const std::array<V, 2>& x, hn::TFromD<D>* out) {
  hn::StoreInterleaved2(x[0], x[1], d, out);
}
template <class D, class V>
HWY_INLINE void store_normals(D d, const std::array<V, 3>& x, hn::TFromD<D>* out) {
  hn::StoreInterleaved3(x[0], x[1], x[2], d, out);
}
template <class D, class V>
HWY_INLINE void store_normals(D d, const std::array<V, 4>& x, hn::TFromD<D>* out) {
  hn::StoreInterleaved4(x[0], x[1], x[2], x[3], d, out);
}

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

/// Writes normals of length 1 in the direction of vectors. Returns the lanes whose normals are undefined.
template <class Real, class D, std::size_t N>
HWY_INLINE Word write_unit(D d, const std::array<hn::Vec<D>, N>& normal, Real* out) {
  using Calc = hn::TFromD<D>;
  constexpr bool kFloat = std::is_same_v<Calc, float>;
  // Within these bounds, squares and the reciprocals of their roots are accurate to the last bits.
  const auto least = hn::Set(d, static_cast<Calc>(kFloat ? 1e-30 : 1e-280));
  const auto most = hn::Set(d, static_cast<Calc>(kFloat ? 1e30 : 1e280));
  auto square = hn::Zero(d);
  for (unsigned a = 0; a < N; ++a) square = hn::Add(square, hn::Mul(normal[a], normal[a]));
  const auto inverse = hn::Div(hn::Set(d, Calc{1}), hn::Sqrt(square));
  const hn::Rebind<Real, D> real;
  std::array<hn::Vec<decltype(real)>, N> result;
  for (unsigned a = 0; a < N; ++a) result[a] = to_real<Real>(d, hn::Mul(normal[a], inverse));
  store_normals(real, result, out);
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
  std::array<hn::Vec<D>, N> normal;  // in the world
  for (unsigned a = 0; a < N; ++a) {
    if (row.to_world == nullptr) {
      normal[a] = hn::Mul(hn::Set(d, row.sign), gradient[a]);
    } else {
      normal[a] = hn::Zero(d);
      for (unsigned b = 0; b < N; ++b)
        normal[a] = hn::Add(normal[a], hn::Mul(hn::Set(d, row.to_world[a * N + b]), gradient[b]));
    }
  }
  return write_unit<Real>(d, normal, out);
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

template <int N>
HWY_INLINE void row_gradients(const RowDifferences<N>& row) {
  const hn::ScalableTag<float> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  static_assert(kLanes + 2 <= kLeastRow);
  const RowDifferences<N> from = row;  // local, because stores of vectors may change any memory
  std::array<std::array<hn::Vec<decltype(d)>, 2>, N> weights;
  for (unsigned a = 0; a < N; ++a)
    weights[a] = {hn::Set(d, static_cast<float>(from.weights[a].backward)),
                  hn::Set(d, static_cast<float>(from.weights[a].forward))};
  const auto some = [&](std::size_t x) HWY_ATTR {
    const auto here = hn::LoadU(d, from.here + x);
    for (unsigned a = 0; a < N; ++a) {
      const float* const backward = a == 0 ? from.here + x - 1 : from.backward[a] + x;
      const float* const forward = a == 0 ? from.here + x + 1 : from.forward[a] + x;
      const auto ahead = hn::Mul(hn::Sub(hn::LoadU(d, forward), here), weights[a][1]);
      const auto back = hn::Mul(hn::Sub(here, hn::LoadU(d, backward)), weights[a][0]);
      hn::StoreU(hn::Add(ahead, back), d, from.out + a * from.pitch + x);
      if (a != 0) hwy::Prefetch(forward + from.next);
    }
  };
  const std::size_t last = from.samples - 1 - kLanes;
  for (std::size_t x = 1; x < last; x += kLanes) some(x);
  some(last);
}

/// Interpolates the gradients at the ends of edges. Whole registers are computed, and the lanes with edges stored.
template <int N>
HWY_INLINE void interpolate(const EdgesOfRow<N>& edges) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> integers;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  float* const by_sample = edges.alphas_by_sample;
  for (std::size_t i = 0; i < edges.count; ++i) by_sample[edges.at[i]] = static_cast<float>(edges.alphas[i]);
  const auto none = hn::Set(d, kNoEdge);
  const std::size_t samples = edges.samples, pitch = edges.pitch;
  const float* const first = edges.ends[0];
  const float* const second = edges.ends[1];
  float* out = edges.gradients;
  for (std::size_t x = 0; x < samples; x += kLanes) {
    const auto alpha = hn::LoadU(d, by_sample + x);
    const auto chosen = hn::RebindMask(d, hn::Ne(hn::BitCast(integers, alpha), hn::BitCast(integers, none)));
    hn::StoreU(none, d, by_sample + x);
    for (unsigned a = 0; a < N; ++a) {
      const auto here = hn::LoadU(d, first + a * pitch + x);
      const auto there = hn::LoadU(d, second + a * pitch + x);
      hn::StoreU(hn::Compress(hn::Add(here, hn::Mul(alpha, hn::Sub(there, here))), chosen), d, out + a * pitch);
    }
    out += hn::CountTrue(d, chosen);
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
    std::array<hn::Vec<decltype(d)>, N> normal;
    for (unsigned a = 0; a < N; ++a) normal[a] = hn::Mul(sign, hn::LoadU(d, from + a * pitch + i));
    left[i / kWordBits] |= write_unit<float>(d, normal, to) << (i % kWordBits);
  };
  std::fill_n(left, (count + kWordBits - 1) / kWordBits, Word{0});
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) some(i, out[i].data());
  if (i == count) return;
  std::array<std::array<float, N>, kLanes> last;
  some(i, last[0].data());
  std::copy_n(last.begin(), count - i, out + i);
  if (count % kWordBits != 0) left[count / kWordBits] &= (Word{1} << (count % kWordBits)) - 1;
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
