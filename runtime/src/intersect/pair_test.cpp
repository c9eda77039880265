// SPDX-License-Identifier: BSD-3-Clause
//
// Tests of a pair of simplices, each for the pairs that the ones before leave open. A and B are the vertices of only
// one of the simplices, C the common ones. The simplices meet only in conv(C) if and only if a hyperplane through C has
// A strictly on one side and B strictly on the other (see meeting_tableau.hpp).
// 1. Boxes. If the boxes touch in a plane across an axis, both simplices are replaced by their faces in that plane.
// 2. The hyperplanes of the simplices. If B is strictly on one side of the hyperplane of A and C, then a slightly
//    turned hyperplane separates strictly, as A and C are affinely independent. If A and B have two vertices each and
//    N - 2 are common, the four sides are the coefficients of the only affine dependency modulo C, and different signs
//    exclude positive weights.
// 3. A separating direction, found by linear programming in floating-point numbers and tested with a bound of the
//    rounding errors.
// 4. Linear programming in integers.
#include "intersect/pair_test.hpp"

#include <cmath>
#include <limits>

#include "intersect/meeting_tableau.hpp"

namespace tegl::detail {

namespace {

/// Calls visit(corner) for the corners of a face.
template <class Visit>
void visit_corners(unsigned face, const Visit& visit) {
  for (; face != 0; face &= face - 1) visit(std::countr_zero(face));
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double x) noexcept {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// The corners that have this coordinate.
template <int N>
unsigned corners_at(const CornersN<N>& corners, int axis, double x) noexcept {
  unsigned result = 0;
  for (int i = 0; i < N; ++i) result |= (corners[i][axis] == x ? 1u : 0u) << i;
  return result;
}

/// Whether a permutation of 0 ... N - 1 is odd.
template <std::size_t N>
bool is_odd(const std::array<int, N>& order) noexcept {
  int inversions = 0;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = i + 1; j < N; ++j) inversions += order[i] > order[j] ? 1 : 0;
  return inversions % 2 != 0;
}

}  // namespace

template <int N>
typename PairTest<N>::Bounds PairTest<N>::bounds_of(const CornersN<N>& corners) noexcept {
  Bounds bounds{corners[0], corners[0]};
  for (int i = 1; i < N; ++i)
    for (int axis = 0; axis < N; ++axis) {
      bounds.low[axis] = std::min(bounds.low[axis], corners[i][axis]);
      bounds.high[axis] = std::max(bounds.high[axis], corners[i][axis]);
    }
  return bounds;
}

template <int N>
void PairTest<N>::load_side(Side& side, Index s) const noexcept {
  side.simplex = s;
  for (int i = 0; i < N; ++i) side.corners[i] = simplices_.point(simplices_.simplex(s)[i]);
}

template <int N>
void PairTest<N>::load(Index s) noexcept {
  load_side(a_, s);
  a_bounds_ = bounds_of(a_.corners);
}

template <int N>
void PairTest<N>::find_common() noexcept {
  const auto &first = simplices_.simplex(a_.simplex), &second = simplices_.simplex(b_.simplex);
  a_.common = b_.common = 0;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j)
      if (first[i] == second[j]) {
        a_.common |= 1u << i;
        b_.common |= 1u << j;
        partner_[i] = j;
      }
}

template <int N>
bool PairTest<N>::are_apart() const noexcept {
  bool result = false;
  for (int axis = 0; axis < N; ++axis)
    result |= (a_.bounds.high[axis] < b_.bounds.low[axis]) | (b_.bounds.high[axis] < a_.bounds.low[axis]);
  return result;
}

/// Computes the bounds of the corners in the face.
template <int N>
void PairTest<N>::restrict_bounds(Side& side) noexcept {
  const int first = std::countr_zero(side.face);
  side.bounds = {side.corners[first], side.corners[first]};
  visit_corners(side.face & (side.face - 1), [&](int i) {
    for (int axis = 0; axis < N; ++axis) {
      side.bounds.low[axis] = std::min(side.bounds.low[axis], side.corners[i][axis]);
      side.bounds.high[axis] = std::max(side.bounds.high[axis], side.corners[i][axis]);
    }
  });
}

/// Replaces the simplices by faces that contain all their common points. False if there are no common points outside of
/// the common vertices' hull. Common vertices are known afterwards.
template <int N>
bool PairTest<N>::reduce_to_faces() noexcept {
  bool has_common = false;
  while (true) {
    if (are_apart()) return false;
    const unsigned a_face = a_.face, b_face = b_.face;
    for (int axis = 0; axis < N; ++axis) {
      const bool above = b_.bounds.low[axis] == a_.bounds.high[axis];
      if (!above && b_.bounds.high[axis] != a_.bounds.low[axis]) continue;
      const double at = above ? b_.bounds.low[axis] : a_.bounds.low[axis];
      a_.face &= corners_at<N>(a_.corners, axis, at);
      b_.face &= corners_at<N>(b_.corners, axis, at);
    }
    if (a_.face == 0 || b_.face == 0) return false;
    const bool changed = a_.face != a_face || b_.face != b_face;
    if (changed) {
      restrict_bounds(a_);
      restrict_bounds(b_);
      if (are_apart()) return false;
    }
    if (!has_common) find_common();
    has_common = true;
    if (a_.own() == 0 || b_.own() == 0) return false;
    if (!changed) return true;
  }
}

template <int N>
bool PairTest<N>::planes_separate() const noexcept {
  const SimplexPlane<N>&of_a = simplices_.plane(a_.simplex), &of_b = simplices_.plane(b_.simplex);
  std::array<int, N> a_side{}, b_side{};
  unsigned a_seen = 0, b_seen = 0;  // bits of side + 1
  visit_corners(b_.own(), [&](int j) {
    b_side[j] = of_a.side(a_.corners[0], b_.corners[j]);
    b_seen |= 1u << (b_side[j] + 1);
  });
  if (b_seen == 1u || b_seen == 4u) return true;
  visit_corners(a_.own(), [&](int i) {
    a_side[i] = of_b.side(b_.corners[0], a_.corners[i]);
    a_seen |= 1u << (a_side[i] + 1);
  });
  if (a_seen == 1u || a_seen == 4u) return true;
  if (a_.face != kAll || b_.face != kAll || std::popcount(a_.common) != N - 2) return false;
  // The dependency of a1, a2, -b1, -b2, with both simplices in the order C, own corners.
  std::array<int, N> a_order, b_order;
  std::size_t next = 0;
  visit_corners(a_.common, [&](int i) {
    a_order[next] = i;
    b_order[next++] = partner_[i];
  });
  std::size_t a_next = next, b_next = next;
  visit_corners(a_.own(), [&](int i) { a_order[a_next++] = i; });
  visit_corners(b_.own(), [&](int j) { b_order[b_next++] = j; });
  const int a_parity = is_odd(a_order) ? -1 : 1, b_parity = is_odd(b_order) ? -1 : 1;
  const std::array<int, 4> signs = {b_parity * a_side[a_order[N - 1]], -b_parity * a_side[a_order[N - 2]],
                                    -a_parity * b_side[b_order[N - 1]], a_parity * b_side[b_order[N - 2]]};
  unsigned seen = 0;
  for (const int sign : signs) seen |= 1u << (sign + 1);
  return (seen & 5u) == 5u;
}

/// A common vertex, if there is one.
template <int N>
const PointN<N>& PairTest<N>::reference() const noexcept {
  return a_.common != 0 ? a_.corners[std::countr_zero(a_.common)] : b_.corners[std::countr_zero(b_.face)];
}

/// Whether a direction, which any hyperplane through a common vertex is perpendicular to, separates strictly. Each
/// product has a relative error of 3 u, and sums of N add N - 1: below 8 u N |direction| |p|.
template <int N>
bool PairTest<N>::separates(const PointN<N>& direction) const noexcept {
  double size = 0.0;
  const auto height_of = [&](const PointN<N>& p) {
    const PointN<N> d = minus(p, reference());
    size = std::max(size, largest_of<N>(d));
    return dot(direction, d);
  };
  Range a, b;
  visit_corners(a_.own(), [&](int i) { a.add(height_of(a_.corners[i])); });
  visit_corners(b_.own(), [&](int j) { b.add(height_of(b_.corners[j])); });
  const double error = 8.0 * N * kRounding * size * largest_of<N>(direction) + kUnderflow;
  return a_.common != 0 ? a.high < -error && b.low > error : a.high + error < b.low - error;
}

template <int N>
bool PairTest<N>::found_separator() const noexcept {
  const auto common = static_cast<std::size_t>(std::popcount(a_.common));
  if (common > 1 || !simplices_.is_filtered()) return false;
  // coordinates relative to a vertex, of size 1
  double size = 0.0;
  for (const Side* const side : {&a_, &b_})
    visit_corners(side->face,
                  [&](int i) { size = std::max(size, largest_of<N>(minus(side->corners[i], reference()))); });
  if (!(size > 0x1p-300)) return false;
  const auto own = static_cast<std::size_t>(std::popcount(a_.own()) + std::popcount(b_.own()));
  MeetingTableau<double, true> tableau(N, common, common + own);
  std::size_t column = 0;
  if (common != 0) tableau.set_column(column++, {}, false);
  for (const Side* const side : {&a_, &b_})
    visit_corners(side->own(), [&](int i) {
      std::array<double, 4> scaled{};
      for (int axis = 0; axis < N; ++axis) scaled[axis] = (side->corners[i][axis] - reference()[axis]) / size;
      tableau.set_column(column++, scaled, side == &b_);
    });
  constexpr double kTiny = 1e-13;
  constexpr std::size_t kMostPivots = 24;
  if (tableau.solve(kTiny, kMostPivots) != std::optional(false)) return false;
  const std::array<double, 4> separator = tableau.separator();
  PointN<N> direction;
  for (int axis = 0; axis < N; ++axis) direction[axis] = separator[axis];
  return separates(direction);
}

template <int N>
bool PairTest<N>::meet_by_integers(PointN<N>& place) const {
  std::array<PointRef, N> common, first, second;
  std::size_t commons = 0, firsts = 0, seconds = 0;
  visit_corners(a_.common, [&](int i) { common[commons++] = a_.corners[i].data(); });
  visit_corners(a_.own(), [&](int i) { first[firsts++] = a_.corners[i].data(); });
  visit_corners(b_.own(), [&](int j) { second[seconds++] = b_.corners[j].data(); });
  return meet_exactly(N, std::span(common).first(commons), std::span(first).first(firsts),
                      std::span(second).first(seconds), place.data());
}

template <int N>
bool PairTest<N>::meets(Index t, PointN<N>& place) {
  load_side(b_, t);
  a_.face = b_.face = kAll;
  a_.bounds = a_bounds_;
  b_.bounds = bounds_of(b_.corners);
  if (!reduce_to_faces()) {
    // the same vertices
    if (a_.face != kAll || b_.face != kAll || a_.own() != 0 || are_apart()) return false;
    place = PointN<N>{};
    for (const PointN<N>& corner : a_.corners)
      for (int axis = 0; axis < N; ++axis) place[axis] += corner[axis] / N;
    return true;
  }
  if (planes_separate() || found_separator()) return false;
  return meet_by_integers(place);
}

template class PairTest<2>;
template class PairTest<3>;
template class PairTest<4>;

}  // namespace tegl::detail
