// SPDX-License-Identifier: BSD-3-Clause
//
// Tests of a pair of simplices, each for the pairs that the ones before leave open. A and B are the vertices of only
// one of the simplices, C the common ones. The simplices meet only in conv(C) if and only if a hyperplane through C has
// A strictly on one side and B strictly on the other (see meeting_tableau.hpp).
// 1. Boxes. If the boxes touch in a plane across an axis, both simplices are replaced by their faces in that plane.
// 2. The hyperplanes of the simplices. If B is strictly on one side of the hyperplane of A and C, then a slightly
// turned
//    hyperplane separates strictly, as A and C are affinely independent. If A and B have two vertices each and N - 2
//    are common, the four sides are the coefficients of the only affine dependency modulo C, and different signs
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

template <int N>
Range range_of(const CornersN<N>& corners, unsigned face, int axis) noexcept {
  Range range;
  visit_corners(face, [&](int i) { range.add(corners[i][axis]); });
  return range;
}

/// The corners of a face that have this coordinate.
template <int N>
unsigned corners_at(const CornersN<N>& corners, unsigned face, int axis, double x) noexcept {
  unsigned result = 0;
  visit_corners(face, [&](int i) { result |= (corners[i][axis] == x ? 1u : 0u) << i; });
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
typename PairTest<N>::Pair PairTest<N>::make_pair(Index s, Index t) const noexcept {
  constexpr unsigned kAll = (1u << N) - 1;
  Pair pair{s, t, simplices_.corners(s), simplices_.corners(t), 0, 0, kAll, kAll, {}};
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j)
      if (simplices_.simplex(s)[i] == simplices_.simplex(t)[j]) {
        pair.a_common |= 1u << i;
        pair.b_common |= 1u << j;
        pair.partner[i] = j;
      }
  return pair;
}

/// Replaces the simplices by faces that contain all their common points. False if there are no common points outside of
/// the common vertices' hull.
template <int N>
bool PairTest<N>::reduce_to_faces(Pair& pair) noexcept {
  for (bool changed = true; changed;) {
    changed = false;
    for (int axis = 0; axis < N; ++axis) {
      const Range a = range_of<N>(pair.a, pair.a_face, axis), b = range_of<N>(pair.b, pair.b_face, axis);
      if (a.high < b.low || b.high < a.low) return false;
      if (a.high != b.low && b.high != a.low) continue;
      const double at = a.high == b.low ? b.low : a.low;
      const unsigned a_face = corners_at<N>(pair.a, pair.a_face, axis, at);
      const unsigned b_face = corners_at<N>(pair.b, pair.b_face, axis, at);
      changed = changed || a_face != pair.a_face || b_face != pair.b_face;
      pair.a_face = a_face;
      pair.b_face = b_face;
      if (pair.a_own() == 0 || pair.b_own() == 0) return false;
    }
  }
  return pair.a_own() != 0 && pair.b_own() != 0;
}

template <int N>
bool PairTest<N>::planes_separate(const Pair& pair) const noexcept {
  const SimplexPlane<N>&of_s = simplices_.plane(pair.s), &of_t = simplices_.plane(pair.t);
  std::array<int, N> a_side{}, b_side{};
  unsigned a_seen = 0, b_seen = 0;  // bits of side + 1
  visit_corners(pair.b_own(), [&](int j) {
    b_side[j] = of_s.side(pair.a[0], pair.b[j]);
    b_seen |= 1u << (b_side[j] + 1);
  });
  if (b_seen == 1u || b_seen == 4u) return true;
  visit_corners(pair.a_own(), [&](int i) {
    a_side[i] = of_t.side(pair.b[0], pair.a[i]);
    a_seen |= 1u << (a_side[i] + 1);
  });
  if (a_seen == 1u || a_seen == 4u) return true;
  constexpr unsigned kAll = (1u << N) - 1;
  if (pair.a_face != kAll || pair.b_face != kAll || pair.common() != N - 2) return false;
  // The dependency of a1, a2, -b1, -b2, with both simplices in the order C, own corners.
  std::array<int, N> a_order, b_order;
  std::size_t next = 0;
  visit_corners(pair.a_common, [&](int i) {
    a_order[next] = i;
    b_order[next++] = pair.partner[i];
  });
  std::size_t a_next = next, b_next = next;
  visit_corners(pair.a_own(), [&](int i) { a_order[a_next++] = i; });
  visit_corners(pair.b_own(), [&](int j) { b_order[b_next++] = j; });
  const int of_a = is_odd(a_order) ? -1 : 1, of_b = is_odd(b_order) ? -1 : 1;
  const std::array<int, 4> signs = {of_b * a_side[a_order[N - 1]], -of_b * a_side[a_order[N - 2]],
                                    -of_a * b_side[b_order[N - 1]], of_a * b_side[b_order[N - 2]]};
  unsigned seen = 0;
  for (const int sign : signs) seen |= 1u << (sign + 1);
  return (seen & 5u) == 5u;
}

/// Whether a direction, which any hyperplane through a common vertex is perpendicular to, separates strictly. Each
/// product has a relative error of 3 u, and sums of N add N - 1: below 8 u N |direction| |p|.
template <int N>
bool PairTest<N>::separates(const Pair& pair, const PointN<N>& direction) noexcept {
  const bool has_common = pair.common() != 0;
  const PointN<N>& reference = has_common ? pair.a[std::countr_zero(pair.a_common)] : pair.b[0];
  double size = 0.0;
  const auto height_of = [&](const PointN<N>& p) {
    const PointN<N> d = minus(p, reference);
    size = std::max(size, largest_of<N>(d));
    return dot(direction, d);
  };
  Range a, b;
  visit_corners(pair.a_own(), [&](int i) { a.add(height_of(pair.a[i])); });
  visit_corners(pair.b_own(), [&](int j) { b.add(height_of(pair.b[j])); });
  const double error = 8.0 * N * kRounding * size * largest_of<N>(direction) + kUnderflow;
  return has_common ? a.high < -error && b.low > error : a.high + error < b.low - error;
}

template <int N>
bool PairTest<N>::found_separator(const Pair& pair) const noexcept {
  if (pair.common() > 1 || !simplices_.is_filtered()) return false;
  // coordinates relative to a vertex, of size 1
  const PointN<N>& reference =
      pair.common() != 0 ? pair.a[std::countr_zero(pair.a_common)] : pair.b[std::countr_zero(pair.b_face)];
  double size = 0.0;
  visit_corners(pair.a_face, [&](int i) { size = std::max(size, largest_of<N>(minus(pair.a[i], reference))); });
  visit_corners(pair.b_face, [&](int j) { size = std::max(size, largest_of<N>(minus(pair.b[j], reference))); });
  if (!(size > 0x1p-300)) return false;
  const std::size_t own = static_cast<std::size_t>(std::popcount(pair.a_own()) + std::popcount(pair.b_own()));
  const auto common = static_cast<std::size_t>(pair.common());
  MeetingTableau<double, true> tableau(N, common, common + own);
  const auto scaled = [&](const PointN<N>& p) {
    std::array<double, 4> result{};
    for (int k = 0; k < N; ++k) result[k] = (p[k] - reference[k]) / size;
    return result;
  };
  std::size_t column = 0;
  if (common != 0) tableau.set_column(column++, {}, false);
  visit_corners(pair.a_own(), [&](int i) { tableau.set_column(column++, scaled(pair.a[i]), false); });
  visit_corners(pair.b_own(), [&](int j) { tableau.set_column(column++, scaled(pair.b[j]), true); });
  constexpr double kTiny = 1e-13;
  constexpr std::size_t kMostPivots = 24;
  if (tableau.solve(kTiny, kMostPivots) != std::optional(false)) return false;
  const std::array<double, 4> separator = tableau.separator();
  PointN<N> direction;
  for (int k = 0; k < N; ++k) direction[k] = separator[k];
  return separates(pair, direction);
}

template <int N>
bool PairTest<N>::meet_by_integers(const Pair& pair, PointN<N>& place) {
  std::array<PointRef, N> common, first, second;
  std::size_t commons = 0, firsts = 0, seconds = 0;
  visit_corners(pair.a_common & pair.a_face, [&](int i) { common[commons++] = pair.a[i].data(); });
  visit_corners(pair.a_own(), [&](int i) { first[firsts++] = pair.a[i].data(); });
  visit_corners(pair.b_own(), [&](int j) { second[seconds++] = pair.b[j].data(); });
  return meet_exactly(N, std::span(common).first(commons), std::span(first).first(firsts),
                      std::span(second).first(seconds), place.data());
}

template <int N>
bool PairTest<N>::meet(Index s, Index t, PointN<N>& place) const {
  Pair pair = make_pair(s, t);
  if (std::popcount(pair.a_common) == N) {
    place = PointN<N>{};
    for (const PointN<N>& corner : pair.a)
      for (int k = 0; k < N; ++k) place[k] += corner[k] / N;
    return true;
  }
  if (!reduce_to_faces(pair) || planes_separate(pair) || found_separator(pair)) return false;
  return meet_by_integers(pair, place);
}

template <int N>
double depth_of(const SimplexPlanes<N>& simplices, Index s, Index t) noexcept {
  double depth = std::numeric_limits<double>::infinity();
  for (const auto& [of, through] : {std::pair(s, t), std::pair(t, s)}) {
    const PointN<N>& normal = simplices.plane(through).normal;
    const PointN<N>& corner = simplices.point(simplices.simplex(through)[0]);
    Range heights;
    heights.add(0.0);
    for (const Index v : simplices.simplex(of)) heights.add(dot(normal, minus(simplices.point(v), corner)));
    depth = std::min(depth, std::min(heights.high, -heights.low) / norm(normal));
  }
  return depth;
}

template class PairTest<2>;
template class PairTest<3>;
template class PairTest<4>;
template double depth_of<2>(const SimplexPlanes<2>&, Index, Index) noexcept;
template double depth_of<3>(const SimplexPlanes<3>&, Index, Index) noexcept;
template double depth_of<4>(const SimplexPlanes<4>&, Index, Index) noexcept;

}  // namespace tegl::detail
