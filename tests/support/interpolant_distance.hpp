// SPDX-License-Identifier: BSD-3-Clause
//
// The distance of the contour in one cell from the surface where the cell's multilinear interpolant is zero.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

#include "tegl/contour.hpp"

namespace tegl::test {

/// The multilinear function of the values at the corners of the unit N-cube.
template <int N>
class CellFunction {
 public:
  using Point = std::array<double, N>;
  using Values = std::array<double, std::size_t{1} << N>;

  explicit CellFunction(const Values& values) : values_(values) {}

  double operator()(const Point& x, Point& gradient) const {
    double sum = 0;
    gradient.fill(0);
    for (std::size_t v = 0; v < values_.size(); ++v) {
      // the products of all factors, and of all except one
      std::array<double, N + 1> before;
      before[0] = values_[v];
      for (std::size_t a = 0; a < N; ++a) before[a + 1] = before[a] * factor(v, a, x);
      sum += before[N];
      double after = 1;
      for (std::size_t a = N; a-- > 0; after *= factor(v, a, x))
        gradient[a] += before[a] * after * ((v >> a & 1u) != 0 ? 1.0 : -1.0);
    }
    return sum;
  }

  /// Distance to the zero that Newton's method reaches along gradients, in steps of at most a tenth of the cell, so
  /// that it does not pass zeros nearby. None if it reaches none within the length of the cell.
  [[nodiscard]] std::optional<double> distance_to_zero(const Point& from) const {
    Point x = from, gradient;
    for (int step = 0; step < 100; ++step) {
      const double height = (*this)(x, gradient);
      double squares = 0;
      for (const double g : gradient) squares += g * g;
      if (!(squares > 0)) return std::nullopt;
      const double length = std::abs(height) / std::sqrt(squares), share = std::min(1.0, 0.1 / length);
      for (std::size_t a = 0; a < N && length > 0; ++a) x[a] -= share * height * gradient[a] / squares;
      if (length > 1e-10) continue;
      double distance = 0;
      for (std::size_t a = 0; a < N; ++a) distance += (x[a] - from[a]) * (x[a] - from[a]);
      if (distance > 1.0) return std::nullopt;
      return std::sqrt(distance);
    }
    return std::nullopt;
  }

 private:
  static double factor(std::size_t v, std::size_t a, const Point& x) { return (v >> a & 1u) != 0 ? x[a] : 1.0 - x[a]; }

  Values values_;
};

/// Distances of points that are uniformly distributed on contours.
struct InterpolantDistance {
  double squares = 0, size = 0, maximum = 0;
  std::uint64_t points = 0, unknown = 0;  ///< unknown: no zero was reached

  [[nodiscard]] double root_mean_square() const { return size > 0 ? std::sqrt(squares / size) : 0.0; }
  void add(double distance, double weight) {
    squares += weight * distance * distance, size += weight;
    maximum = std::max(maximum, distance);
    ++points;
  }
};

/// Factor times the measure of a simplex of N points in N dimensions: the root of the Gram determinant of its edges.
template <int N, class Real>
double gram_measure(const std::array<std::array<Real, N>, N>& points) {
  std::array<std::array<double, N - 1>, N - 1> gram{};
  for (std::size_t i = 0; i + 1 < N; ++i)
    for (std::size_t j = 0; j + 1 < N; ++j)
      for (std::size_t a = 0; a < N; ++a)
        gram[i][j] +=
            (double(points[i + 1][a]) - double(points[0][a])) * (double(points[j + 1][a]) - double(points[0][a]));
  double determinant = 1;
  for (std::size_t i = 0; i + 1 < N; ++i) {  // positive semidefinite: no pivots
    if (!(gram[i][i] > 0)) return 0;
    determinant *= gram[i][i];
    for (std::size_t j = i + 1; j + 1 < N; ++j)
      for (std::size_t k = N - 1; k-- > i;) gram[j][k] -= gram[j][i] / gram[i][i] * gram[i][k];
  }
  return std::sqrt(std::max(0.0, determinant));
}

/// Adds the distances of `count` random points of each simplex, weighted by its measure.
template <int N, class Real>
void add_distances(const CellFunction<N>& function, const Contour<N, Real>& contour, int count, std::mt19937_64& bits,
                   InterpolantDistance& to) {
  for (const auto& simplex : contour.simplices) {
    std::array<std::array<Real, N>, N> points;
    for (std::size_t i = 0; i < N; ++i) points[i] = contour.vertices[simplex[i]];
    const double measure = gram_measure<N>(points) / count;
    for (int k = 0; k < count; ++k) {
      // uniform in the simplex: normalised exponential weights
      std::array<double, N> weights, point{};
      double sum = 0;
      for (double& w : weights) sum += w = -std::log((static_cast<double>(bits() >> 11) + 1.0) * 0x1p-53);
      for (std::size_t i = 0; i < N; ++i)
        for (std::size_t a = 0; a < N; ++a) point[a] += weights[i] / sum * double(points[i][a]);
      if (const auto distance = function.distance_to_zero(point))
        to.add(*distance, measure);
      else
        ++to.unknown;
    }
  }
}

/// Whether a vertex inside the unit cell is a copy of a corner: on the ray from the centre to it.
template <int N, class Real>
bool is_copy_of_corner(const std::array<Real, N>& vertex) {
  const double first = std::abs(double(vertex[0]) - 0.5);
  if (!(first > 0 && first < 0.5)) return false;
  return std::all_of(vertex.begin(), vertex.end(),
                     [&](Real x) { return std::abs(std::abs(double(x) - 0.5) - first) < 1e-6; });
}

/// Moves the copies of corners to the middle of their rays. Returns their number.
template <int N, class Real>
std::size_t move_copies_half_way(Contour<N, Real>& contour) {
  std::size_t moved = 0;
  for (auto& vertex : contour.vertices) {
    if (!is_copy_of_corner<N>(vertex)) continue;
    ++moved;
    for (Real& x : vertex) x = x < Real(0.5) ? Real(0.25) : Real(0.75);
  }
  return moved;
}

}  // namespace tegl::test
