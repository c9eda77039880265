// SPDX-License-Identifier: BSD-3-Clause
//
// Normals on the critical edges of a row (see edge_normals.hpp). Highway's foreach_target compiles this file once per
// instruction set. Multiplications and additions are not fused, and roots and quotients are correctly rounded, so that
// all instruction sets give identical bytes.
#include "kernel/edge_normals.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/edge_normals.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
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

/// Writes as many normals as D has lanes. Returns the lanes whose normals are undefined.
template <class D, int N, class Real>
HWY_INLINE Word write_some(D d, const NormalRow<N, Real, hn::TFromD<D>>& row, std::size_t i, Real* out) {
  using Calc = hn::TFromD<D>;
  constexpr bool kFloat = std::is_same_v<Calc, float>;
  // Within these bounds, squares and the reciprocals of their roots are accurate to the last bits.
  const auto least = hn::Set(d, static_cast<Calc>(kFloat ? 1e-30 : 1e-280));
  const auto most = hn::Set(d, static_cast<Calc>(kFloat ? 1e30 : 1e280));
  const auto gradient = gradients(d, row, i);
  std::array<hn::Vec<D>, N> normal;
  auto square = hn::Zero(d);
  for (unsigned a = 0; a < N; ++a) {
    // gradient in the world and its squared length
    if (row.to_world == nullptr) {
      normal[a] = hn::Mul(hn::Set(d, row.sign), gradient[a]);
    } else {
      normal[a] = hn::Zero(d);
      for (unsigned b = 0; b < N; ++b)
        normal[a] = hn::Add(normal[a], hn::Mul(hn::Set(d, row.to_world[a * N + b]), gradient[b]));
    }
    square = hn::Add(square, hn::Mul(normal[a], normal[a]));
  }
  // normals
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

// Highway's dispatch tables cannot hold templates.
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

}  // namespace tegl::detail

#endif  // HWY_ONCE
