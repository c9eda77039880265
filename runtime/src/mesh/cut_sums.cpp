// SPDX-License-Identifier: BSD-3-Clause
//
// Sums over the cuts of simplices, for several values at a time. Highway's foreach_target compiles this file once per
// instruction set. Multiplications and additions are not fused, and each value gets its terms in the order of the
// simplices, so that all instruction sets give identical bytes.
//
// Based on: H. B. Curry and I. J. Schoenberg, On Pólya frequency functions IV: the fundamental spline functions and
// their limits, 1966. The volume of the cuts of a simplex is a B-spline whose knots are the positions of the vertices.
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/sort_few.hpp"
#include "mesh/cut_sums.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/cut_sums.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The B-spline of degree N - 2 with the knots k_0 ≤ … ≤ k_{N-1} and integral 1. Recursion by convex combinations of
/// two splines with one knot less, so there is no cancellation.
template <int N>
struct Spline {
  std::array<double, N> knots;
  std::array<std::array<double, N>, N> per_length;  ///< by number of intervals, then by first knot

  explicit HWY_INLINE Spline(const std::array<double, N>& of) : knots(of) {
    for (int width = 1; width < N; ++width)
      for (int i = 0; i + width < N; ++i) {
        const double length = knots[i + width] - knots[i];
        per_length[width][i] = length > 0.0 ? 1.0 / length : 0.0;
      }
  }

  /// At the places t; places[J] has those from knot J to knot J + 1.
  template <class D, class V, class Masks>
  HWY_INLINE V at(D d, V t, const Masks& places) const {
    V spline[N - 1];  // with one knot more in each round
    for (int i = 0; i + 1 < N; ++i) spline[i] = hn::IfThenElseZero(places[i], hn::Set(d, per_length[1][i]));
    for (int width = 2; width < N; ++width)
      for (int i = 0; i + width < N; ++i) {
        const V up = hn::Mul(hn::Sub(t, hn::Set(d, knots[i])), spline[i]);
        const V down = hn::Mul(hn::Sub(hn::Set(d, knots[i + width]), t), spline[i + 1]);
        spline[i] = hn::Mul(hn::Add(up, down), hn::Set(d, per_length[width][i]));
      }
    return hn::Mul(spline[0], hn::Set(d, static_cast<double>(N - 1)));
  }
};

/// As add_exactly.
template <class D, class V>
HWY_INLINE void add_terms(D d, V terms, double* sums, double* rests) {
  const V before = hn::LoadU(d, sums);
  const V sum = hn::Add(before, terms);
  const V added = hn::Sub(sum, before);
  const V error = hn::Add(hn::Sub(before, hn::Sub(sum, added)), hn::Sub(terms, added));
  hn::StoreU(sum, d, sums);
  hn::StoreU(hn::Add(hn::LoadU(d, rests), error), d, rests);
}

/// Adds the cuts of one simplex. Its cut at t lies in the plane with the normal w (the spatial part of the simplex's
/// normal vector W), in which x . w = x_0 . w + (t_0 - t) W_t for any of its vertices (x_0, t_0). `values` is padded.
template <int N>
HWY_INLINE void add_simplex(const CutInput<N>& input, std::size_t s, const double* values,
                            const std::array<double*, 4>& sums) {
  const auto& simplex = input.contour.simplices()[s];
  std::array<Index, N> cut;
  for (int j = 0; j < N; ++j) cut[j] = input.counts[simplex[j]];
  sort_few(cut);
  if (cut.front() == cut.back()) return;
  const std::array<PointOf<N>, N> corners = input.contour.corners(s);
  std::array<double, N> knots;
  for (int j = 0; j < N; ++j) knots[j] = corners[j][N - 1];
  sort_few(knots);
  const Spline<N> spline(knots);
  const PointOf<N> normal = normal_vector_of<N>(corners);
  PointOf<N - 1> spatial;
  std::copy_n(normal.begin(), N - 1, spatial.begin());
  const double area = length_of<N - 1>(spatial);
  double along = 0.0;
  for (int a = 0; a + 1 < N; ++a) along += spatial[a] * (corners[0][a] - input.origin[a]);

  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  const V first = hn::Iota(d, 0.0);
  for (std::size_t i = cut.front(); i < cut.back(); i += hn::Lanes(d)) {
    const V t = hn::LoadU(d, values + i);
    // the places between two knots, by comparing their numbers, which are exact
    const V number = hn::Add(first, hn::Set(d, static_cast<double>(i)));
    hn::Mask<decltype(d)> places[N - 1];
    for (int j = 0; j + 1 < N; ++j)
      places[j] = hn::And(hn::Ge(number, hn::Set(d, static_cast<double>(cut[j]))),
                          hn::Lt(number, hn::Set(d, static_cast<double>(cut[j + 1]))));
    const auto is_cut = hn::Lt(number, hn::Set(d, static_cast<double>(cut.back())));
    const V share = spline.at(d, t, places);
    const V height =
        hn::Add(hn::Set(d, along), hn::Mul(hn::Sub(hn::Set(d, corners[0][N - 1]), t), hn::Set(d, normal[N - 1])));
    add_terms(d, hn::IfThenElseZero(is_cut, hn::Mul(hn::Set(d, area), share)), sums[0] + i, sums[1] + i);
    add_terms(d, hn::IfThenElseZero(is_cut, hn::Mul(height, share)), sums[2] + i, sums[3] + i);
  }
}

template <int N>
HWY_INLINE void add_all(const CutInput<N>& input, std::size_t from, std::size_t to, const double* values,
                        const std::array<double*, 4>& sums) {
  static_assert(hn::MaxLanes(hn::ScalableTag<double>()) <= CutSums::kPadding);
  for (std::size_t s = from; s < to; ++s) add_simplex(input, s, values, sums);
}

#define TEGL_CUTS(N)                                                                                  \
  void add_cuts_##N(const CutInput<N>& input, std::size_t from, std::size_t to, const double* values, \
                    const std::array<double*, 4>& sums) {                                             \
    add_all(input, from, to, values, sums);                                                           \
  }
TEGL_CUTS(3)
TEGL_CUTS(4)
TEGL_CUTS(5)
#undef TEGL_CUTS

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

#define TEGL_DISPATCH(N)                                                                        \
  HWY_EXPORT(add_cuts_##N);                                                                     \
  template <>                                                                                   \
  void add_cuts<N>(const CutInput<N>& input, std::size_t from, std::size_t to, CutSums& sums) { \
    std::vector<double> padded(input.values.begin(), input.values.end());                       \
    padded.resize(padded.size() + CutSums::kPadding, 0.0);                                      \
    HWY_DYNAMIC_DISPATCH(add_cuts_##N)(input, from, to, padded.data(), sums.arrays());          \
  }
TEGL_DISPATCH(3)
TEGL_DISPATCH(4)
TEGL_DISPATCH(5)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
