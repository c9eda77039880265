// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of simplices of a 5D contour that intersect outside of their common face, exactly for the stored coordinates,
// by all pairs: for contours of a few cells. The library's own check has 2 to 4 dimensions.
//
// A and B are the vertices of only one of the simplices, C the common ones. The simplices meet only in conv(C) if and
// only if a hyperplane through C has A strictly on one side and B strictly on the other. Tests of a pair:
// 1. Bounding boxes.
// 2. The hyperplane of each simplex: if the other's own vertices are strictly on one side of it, a slightly turned
//    hyperplane separates strictly.
// 3. A direction found by linear programming in floating-point numbers. It is nearly perpendicular to the edges of C;
//    the test bounds the change to a direction that is perpendicular, and all rounding errors.
// 4. Linear programming in integers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <boost/multiprecision/cpp_int.hpp>

#include "intersect/meeting_tableau.hpp"
#include "tegl/contour.hpp"
#include "tegl/error.hpp"

namespace tegl::bench {

/// Intersecting pairs of simplices that are not flat, by number, the smaller one first.
struct FiveIntersections {
  std::vector<std::pair<Index, Index>> pairs;
  std::uint64_t flat = 0;   ///< flat simplices
  std::uint64_t exact = 0;  ///< pairs that were decided by integers
};

/// Tests one contour with coordinates from 0 to 1.
class FivePairs {
 public:
  explicit FivePairs(const Contour<5, double>& contour) {
    for (const auto& simplex : contour.simplices) {
      Body body;
      body.simplex = simplex;
      for (std::size_t i = 0; i < 5; ++i) body.corners[i] = contour.vertices[simplex[i]];
      body.set_plane();
      body.is_flat = body.height_of_longest_axis() <= 0.0 && are_dependent(body.corners);
      bodies_.push_back(body);
    }
  }

  [[nodiscard]] FiveIntersections intersections() const {
    FiveIntersections result;
    for (std::size_t s = 0; s < bodies_.size(); ++s) {
      if (bodies_[s].is_flat) {
        ++result.flat;
        continue;
      }
      for (std::size_t t = 0; t < s; ++t)
        if (!bodies_[t].is_flat && meet(bodies_[s], bodies_[t], result))
          result.pairs.emplace_back(static_cast<Index>(t), static_cast<Index>(s));
    }
    return result;
  }

 private:
  static constexpr double kRounding = 0x1p-53;
  using Point = std::array<double, 5>;
  using Integer =
      boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

  static Point minus(const Point& p, const Point& q) {
    Point d;
    for (std::size_t a = 0; a < 5; ++a) d[a] = p[a] - q[a];
    return d;
  }
  static double dot(const Point& p, const Point& q) {
    double sum = 0.0;
    for (std::size_t a = 0; a < 5; ++a) sum += p[a] * q[a];
    return sum;
  }
  static double largest(const Point& p) {
    double result = 0.0;
    for (const double x : p) result = std::max(result, std::abs(x));
    return result;
  }

  struct Body {
    std::array<Index, 5> simplex{};
    std::array<Point, 5> corners{};
    Point normal{};
    double bound = 0.0;  ///< normal . d has an error of at most bound * max |d_a|, with a margin
    bool is_flat = false;

    /// A component of the normal is a sum of 24 products of four components of edges. Let u = 2^-53 and E the product
    /// of the largest components. Each product has a relative error below 8 u, and each sum of up to 24 adds less than
    /// 24 u: below 24 * 32 u E. The scalar product adds 24 * 6 u E, for each of 5 components: below 8192 u E.
    void set_plane() {
      std::array<Point, 4> edges;
      double product = 1.0;
      for (std::size_t i = 0; i < 4; ++i) {
        edges[i] = minus(corners[i + 1], corners[0]);
        product *= largest(edges[i]);
      }
      for (std::size_t a = 0; a < 5; ++a) {
        std::array<std::size_t, 4> axes{};
        for (std::size_t k = 0, axis = 0; axis < 5; ++axis)
          if (axis != a) axes[k++] = axis;
        const auto two = [&](std::size_t r, std::size_t i, std::size_t j) {
          return edges[r][axes[i]] * edges[r + 1][axes[j]] - edges[r][axes[j]] * edges[r + 1][axes[i]];
        };
        const double determinant = two(0, 0, 1) * two(2, 2, 3) - two(0, 0, 2) * two(2, 1, 3) +
                                   two(0, 0, 3) * two(2, 1, 2) + two(0, 1, 2) * two(2, 0, 3) -
                                   two(0, 1, 3) * two(2, 0, 2) + two(0, 2, 3) * two(2, 0, 1);
        normal[a] = a % 2 == 0 ? determinant : -determinant;
      }
      bound = 8192.0 * kRounding * product + 0x1p-800;
    }
    /// Positive if a component of the normal is not 0 for sure.
    [[nodiscard]] double height_of_longest_axis() const { return largest(normal) - bound; }
    /// 1, -1, or 0 for unknown.
    [[nodiscard]] int side(const Point& p) const {
      const Point d = minus(p, corners[0]);
      const double height = dot(normal, d), error = bound * largest(d);
      return static_cast<int>(height > error) - static_cast<int>(height < -error);
    }
  };

  /// The vertices of a pair by group.
  struct Groups {
    std::vector<const Point*> common, first, second;
  };

  static bool boxes_are_apart(const Body& a, const Body& b) {
    for (std::size_t axis = 0; axis < 5; ++axis) {
      const auto less = [axis](const Point& p, const Point& q) { return p[axis] < q[axis]; };
      const auto [a_low, a_high] = std::minmax_element(a.corners.begin(), a.corners.end(), less);
      const auto [b_low, b_high] = std::minmax_element(b.corners.begin(), b.corners.end(), less);
      if ((*a_high)[axis] < (*b_low)[axis] || (*b_high)[axis] < (*a_low)[axis]) return true;
    }
    return false;
  }

  static bool plane_separates(const Body& plane, const std::vector<const Point*>& others) {
    int seen = 0;
    for (const Point* p : others) {
      const int side = plane.side(*p);
      if (side == 0 || side == -seen) return false;
      seen = side;
    }
    return true;
  }

  /// Columns are C, A, B, by convert(point).
  template <class Number, bool kWithDual, class Convert>
  static detail::MeetingTableau<Number, kWithDual, 5> tableau_of(const Groups& groups, const Convert& convert) {
    const std::size_t common = groups.common.size();
    detail::MeetingTableau<Number, kWithDual, 5> tableau(5, common,
                                                         common + groups.first.size() + groups.second.size());
    std::size_t column = 0;
    for (const auto* group : {&groups.common, &groups.first, &groups.second})
      for (const Point* p : *group) tableau.set_column(column++, convert(*p), group == &groups.second);
    return tableau;
  }

  static bool found_separator(const Groups& groups) {
    const Point& origin = groups.common.empty() ? *groups.second.front() : *groups.common.front();
    auto tableau = tableau_of<double, true>(groups, [&](const Point& p) { return minus(p, origin); });
    constexpr std::size_t kMostPivots = 40;
    if (tableau.solve(1e-13, kMostPivots) != std::optional(false)) return false;
    const Point direction = tableau.separator();
    double a_high = -std::numeric_limits<double>::infinity(), b_low = -a_high;
    const auto height_of = [&](const Point& p) { return dot(direction, minus(p, origin)); };
    for (const Point* p : groups.first) a_high = std::max(a_high, height_of(*p));
    for (const Point* p : groups.second) b_low = std::min(b_low, height_of(*p));
    // each product has a relative error of 3 u, and sums of five add 4 u; components of vectors are at most 1
    const double error = 64.0 * kRounding * largest(direction) + 0x1p-800;
    if (groups.common.empty()) return a_high + error < b_low - error;
    const std::optional<double> change = change_to_perpendicular(groups, direction, error);
    if (!change) return false;
    const double all = error + *change * std::sqrt(5.0) * 1.0001;
    return a_high < -all && b_low > all;
  }

  /// A bound of |x| for a vector x such that direction + x is perpendicular to all edges of C from its first vertex:
  /// the heights of the edges, divided by the smallest singular value of the edges. For m edges with Gram matrix G its
  /// square is at least det G ((m - 1) / trace G)^(m - 1).
  static std::optional<double> change_to_perpendicular(const Groups& groups, const Point& direction, double error) {
    const std::size_t edges = groups.common.size() - 1;
    if (edges == 0) return 0.0;
    std::array<Point, 4> edge;
    double squares = 0.0, trace = 0.0, determinant = 1.0;
    std::array<Point, 4> rest;  // edges without their parts along those before
    for (std::size_t i = 0; i < edges; ++i) {
      rest[i] = edge[i] = minus(*groups.common[i + 1], *groups.common[0]);
      const double height = std::abs(dot(direction, edge[i])) + error;
      squares += height * height;
      const double length = dot(edge[i], edge[i]);
      trace += length;
      for (int repeat = 0; repeat < 2; ++repeat)
        for (std::size_t k = 0; k < i; ++k) {
          const double along = dot(rest[i], rest[k]) / dot(rest[k], rest[k]);
          for (std::size_t a = 0; a < 5; ++a) rest[i][a] -= along * rest[k][a];
        }
      const double left = dot(rest[i], rest[i]);
      if (!(left > 1e-8 * length)) return std::nullopt;  // rounding errors would count
      determinant *= left;
    }
    const auto others = static_cast<double>(edges - 1);
    const double least = 0.99 * determinant * (edges == 1 ? 1.0 : std::pow(others / trace, others));
    return std::sqrt(squares / least) * 1.01;
  }

  /// x * 2^120. Throws UnsupportedData if |x| is below 2^-68 and not 0.
  static Integer integer_of(double x) {
    if (x == 0.0) return Integer(0);
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);
    const int shift = exponent - std::numeric_limits<double>::digits + 120;
    if (shift < 0)
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("5D: a coordinate is {}; expected 0 or a magnitude of at least 2^-68 (with log-uniform "
                              "positions, a smaller --spread)",
                              x));
    return Integer(static_cast<std::int64_t>(std::ldexp(fraction, std::numeric_limits<double>::digits))) << shift;
  }
  static std::array<Integer, 5> integers_of(const Point& p) {
    std::array<Integer, 5> result;
    for (std::size_t a = 0; a < 5; ++a) result[a] = integer_of(p[a]);
    return result;
  }
  static bool meet_by_integers(const Groups& groups) {
    auto tableau = tableau_of<Integer, false>(groups, integers_of);
    return tableau.solve(Integer(0), std::numeric_limits<std::size_t>::max()).value();
  }

  static bool are_dependent(const std::array<Point, 5>& corners) {
    using Rational = boost::multiprecision::cpp_rational;
    std::vector<std::array<Rational, 5>> rows;
    const std::array<Integer, 5> origin = integers_of(corners[0]);
    for (std::size_t i = 1; i < 5; ++i) {
      const std::array<Integer, 5> point = integers_of(corners[i]);
      std::array<Rational, 5> row;
      for (std::size_t a = 0; a < 5; ++a) row[a] = Rational(boost::multiprecision::cpp_int(point[a] - origin[a]));
      for (const auto& other : rows) {
        std::size_t lead = 0;
        while (other[lead] == 0) ++lead;
        const Rational factor = row[lead] / other[lead];
        for (std::size_t a = 0; a < 5; ++a) row[a] -= factor * other[a];
      }
      if (std::all_of(row.begin(), row.end(), [](const Rational& x) { return x == 0; })) return true;
      rows.push_back(row);
    }
    return false;
  }

  static bool meet(const Body& a, const Body& b, FiveIntersections& counts) {
    if (boxes_are_apart(a, b)) return false;
    Groups groups;
    for (std::size_t i = 0; i < 5; ++i) {
      const bool is_common = std::find(b.simplex.begin(), b.simplex.end(), a.simplex[i]) != b.simplex.end();
      (is_common ? groups.common : groups.first).push_back(&a.corners[i]);
    }
    for (std::size_t j = 0; j < 5; ++j)
      if (std::find(a.simplex.begin(), a.simplex.end(), b.simplex[j]) == a.simplex.end())
        groups.second.push_back(&b.corners[j]);
    if (groups.first.empty()) return true;  // the same vertices
    if (plane_separates(a, groups.second) || plane_separates(b, groups.first)) return false;
    if (found_separator(groups)) return false;
    ++counts.exact;
    return meet_by_integers(groups);
  }

  std::vector<Body> bodies_;
};

}  // namespace tegl::bench
