// SPDX-License-Identifier: BSD-3-Clause
//
// Orthonormal vectors, made one after another by the method of Gram and Schmidt.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tegl::detail {

template <int N>
class OrthonormalVectors {
 public:
  using Point = std::array<double, N>;

  [[nodiscard]] std::size_t size() const noexcept { return vectors_.size(); }

  /// x without its parts along the vectors.
  [[nodiscard]] Point rest_of(Point x) const noexcept {
    for (const Point& unit : vectors_) {
      double along = 0.0;
      for (int a = 0; a < N; ++a) along += unit[a] * x[a];
      for (int a = 0; a < N; ++a) x[a] -= along * unit[a];
    }
    return x;
  }

  /// Adds the direction of the rest of x, unless its length is `least` or less.
  void add(const Point& x, double least = 0.0) {
    Point rest = rest_of(x);
    double square = 0.0;
    for (const double component : rest) square += component * component;
    const double length = std::sqrt(square);
    if (!(length > least)) return;
    for (double& component : rest) component /= length;
    vectors_.push_back(rest);
  }

 private:
  std::vector<Point> vectors_;
};

}  // namespace tegl::detail
