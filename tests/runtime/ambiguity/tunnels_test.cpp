// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of random cubes do not intersect themselves, whatever resolves the ambiguities, and the vertices of tunnels
// are on the trilinear interpolant. Crossings are found with exact numbers: positions are rounded to multiples of 2^-20,
// and determinants are computed in integers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "estimators.hpp"
#include "invariants.hpp"
#include "random_fields.hpp"
#include "share.hpp"
#include "tegl/extract.hpp"
#include "variants.hpp"

namespace tegl::test {
namespace {

__extension__ using Wide = __int128;
using Point = std::array<std::int64_t, 3>;

enum class Magnitudes { equal, uniform, log_uniform };

/// Eight values of random signs. Their magnitudes determine the positions on edges.
class RandomCubes {
 public:
  RandomCubes(Magnitudes magnitudes, std::uint32_t seed) : magnitudes_(magnitudes), random_(seed) {}
  const Image<double, 3>& next() {
    for (double& value : values_) {
      const double size = magnitudes_ == Magnitudes::equal     ? 1.0
                          : magnitudes_ == Magnitudes::uniform ? 1.0 - share_(random_)
                                                               : std::exp(8.0 * share_(random_) - 4.0);
      value = share_(random_) < 0.5 ? size : -size;
    }
    return image_;
  }
  [[nodiscard]] const std::array<double, 8>& values() const { return values_; }

 private:
  Magnitudes magnitudes_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> share_{0.0, 1.0};
  std::array<double, 8> values_{};
  Image<double, 3> image_{values_.data(), Grid<3>::unit({2, 2, 2})};
};

int orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<Point, 3> r;
  for (std::size_t i = 0; i < 3; ++i) r[0][i] = b[i] - a[i], r[1][i] = c[i] - a[i], r[2][i] = d[i] - a[i];
  const auto minor = [&](std::size_t i, std::size_t j) { return Wide{r[1][i]} * r[2][j] - Wide{r[1][j]} * r[2][i]; };
  const Wide determinant = r[0][0] * minor(1, 2) - r[0][1] * minor(0, 2) + r[0][2] * minor(0, 1);
  return (determinant > 0) - (determinant < 0);
}

/// Whether a segment crosses the inside of a triangle.
bool crosses(const Point& from, const Point& to, const std::array<Point, 3>& t) {
  if (orientation(t[0], t[1], t[2], from) * orientation(t[0], t[1], t[2], to) != -1) return false;
  const int first = orientation(from, to, t[0], t[1]);
  return first != 0 && first == orientation(from, to, t[1], t[2]) && first == orientation(from, to, t[2], t[0]);
}

/// Number of pairs of an edge and a triangle that cross.
std::size_t crossings(const Contour<3, double>& contour) {
  std::vector<Point> points;
  for (const auto& vertex : contour.vertices) {
    Point& point = points.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) point[i] = std::llround(vertex[i] * 0x1p20);
  }
  std::size_t count = 0;
  for (const auto& t : contour.simplices)
    for (const auto& u : contour.simplices)
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = t[i], b = t[(i + 1) % 3];
        if (std::find(u.begin(), u.end(), a) != u.end() || std::find(u.begin(), u.end(), b) != u.end()) continue;
        count += crosses(points[a], points[b], {points[u[0]], points[u[1]], points[u[2]]}) ? 1 : 0;
      }
  return count;
}

double interpolant(const std::array<double, 8>& values, const std::array<double, 3>& at) {
  double sum = 0;
  for (std::size_t v = 0; v < 8; ++v) {
    double weight = values[v];
    for (std::size_t a = 0; a < 3; ++a) weight *= (v >> a & 1u) != 0 ? at[a] : 1.0 - at[a];
    sum += weight;
  }
  return sum;
}

/// Vertices inside the cube.
std::vector<std::array<double, 3>> inner_vertices(const Contour<3, double>& contour) {
  std::vector<std::array<double, 3>> result;
  for (const auto& vertex : contour.vertices)
    if (std::all_of(vertex.begin(), vertex.end(), [](double x) { return x > 0.0 && x < 1.0; }))
      result.push_back(vertex);
  return result;
}

TEST(Tunnels, NoContourOfARandomCubeIntersectsItself) {
  const std::size_t cubes = unless_sanitized(cases_to_test(1'000'000, 3000), 300);
  std::uint32_t seed = 1;
  for (const Magnitudes magnitudes : {Magnitudes::equal, Magnitudes::uniform, Magnitudes::log_uniform})
    for (auto [name, options] : all_estimators())
      for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
        options.triangulation = triangulation;
        options.work.threads = 1;
        RandomCubes random(magnitudes, ++seed);
        std::size_t with_crossings = 0;
        for (std::size_t i = 0; i < cubes; ++i)
          with_crossings += crossings(extract<double>(random.next(), 0.0, options)) != 0 ? 1 : 0;
        EXPECT_EQ(with_crossings, 0u) << describe(options) << " " << name << " " << static_cast<int>(magnitudes);
      }
}

TEST(Tunnels, CrossingsAreFoundIfOneTriangleIsMoved) {
  RandomCubes random(Magnitudes::uniform, 3);
  std::size_t found = 0, tested = 0;
  while (tested < 100) {
    auto contour = extract<double>(random.next(), 0.0, by_ambiguity(Ambiguity::mean));
    if (inner_vertices(contour).size() < 3) continue;
    ++tested;
    // the first vertex inside the cube to the other side of the centre, far
    for (auto& vertex : contour.vertices)
      if (vertex == inner_vertices(contour).front()) {
        for (double& x : vertex) x = 0.5 - 1.5 * (x - 0.5);
        break;
      }
    found += crossings(contour) != 0 ? 1 : 0;
  }
  EXPECT_GT(found, 60u);
}

TEST(Tunnels, HaveTheirVerticesOnTheInterpolant) {
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle}) {
    RandomCubes random(Magnitudes::uniform, 4);
    std::size_t on_it = 0, clamped = 0;
    for (int i = 0; i < 20'000; ++i) {
      const auto contour = extract<double>(random.next(), 0.0, by_ambiguity(ambiguity));
      const auto inner = inner_vertices(contour);
      if (inner.size() < 3) continue;  // of a tunnel
      for (const auto& vertex : inner) {
        // on a ray: each coordinate at the centre, or as far from it as the others
        double level = 0;
        for (const double x : vertex) level = std::max(level, std::abs(2.0 * x - 1.0));
        for (const double x : vertex) EXPECT_TRUE(x == 0.5 || std::abs(2.0 * x - 1.0) == level) << x;
        if (level > 1.0 / 32 && level < 31.0 / 32) {
          EXPECT_NEAR(interpolant(random.values(), vertex), 0.0, 1e-8);
          ++on_it;
        } else {
          ++clamped;
        }
      }
    }
    EXPECT_GT(on_it, 150u);
    EXPECT_LT(clamped, on_it / 2);
  }
}

TEST(Tunnels, KeepEpsilonFromTheCentreAndFromTheBoundary) {
  ExtractOptions options = by_ambiguity(Ambiguity::mean);
  options.epsilon = 0.1;
  RandomCubes random(Magnitudes::log_uniform, 5);
  std::size_t vertices = 0;
  for (int i = 0; i < 5000; ++i)
    for (const auto& vertex : inner_vertices(extract<double>(random.next(), 0.0, options))) {
      double level = 0;
      for (const double x : vertex) level = std::max(level, std::abs(2.0 * x - 1.0));
      EXPECT_LE(level, 0.9 + 1e-9);
      ++vertices;
    }
  EXPECT_GT(vertices, 100u);
}

}  // namespace
}  // namespace tegl::test
