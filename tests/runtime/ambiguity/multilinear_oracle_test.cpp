// SPDX-License-Identifier: BSD-3-Clause
//
// The oracle of the interpolant's topology (support/multilinear.hpp) against known results: shapes, cells of the
// literature, sweeps along the other axes, and stratified Morse theory.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "multilinear.hpp"
#include "random_fields.hpp"

namespace tegl::test {
namespace {

SampledField<3> cell_of(const std::array<std::int64_t, 8>& corners) {
  return {{2, 2, 2}, {corners.begin(), corners.end()}};
}

template <int N, class Field>
SampledField<N> sampled(std::size_t samples, double half_width, const Field& field) {
  const auto image = sample_field<double, N>(centred_grid<N>(samples, half_width), field);
  SampledField<N> result;
  result.sizes.fill(samples);
  for (const double value : image.values) result.values.push_back(std::llround(value * 0x1p20));
  return result;
}

TEST(MultilinearOracle, KnowsShapesInTheField) {
  const auto ball = interpolant_topology(sampled<3>(14, 1.3, Ball<3>{{0.031, -0.012, 0.047}}));
  EXPECT_TRUE(ball.regular);
  EXPECT_EQ(ball.contour, (Topology{1, 2}));
  EXPECT_EQ(ball.high, (Topology{1, 1}));
  EXPECT_EQ(ball.low, (Topology{1, 2}));  // a shell
  const auto torus = interpolant_topology(sampled<3>(18, 1.6, RingTube<3>{}));
  EXPECT_TRUE(torus.regular);
  EXPECT_EQ(torus.contour, (Topology{1, 0}));
  EXPECT_EQ(torus.high, (Topology{1, 0}));
  const auto circle = interpolant_topology(sampled<2>(14, 1.3, Ball<2>{{0.031, -0.012}}));
  EXPECT_EQ(circle.contour, (Topology{1, 0}));
  const auto two = interpolant_topology(sampled<3>(20, 2.0, [](const Point<3>& x) {
    return std::max(Ball<3>{{-0.9, 0.03, 0.01}, 0.7}(x), Ball<3>{{0.9, 0.03, 0.01}, 0.7}(x));
  }));
  EXPECT_EQ(two.contour, (Topology{2, 4}));
  EXPECT_EQ(two.low, (Topology{1, 3}));
}

TEST(MultilinearOracle, KnowsPlanesAndCorners) {
  const auto plane =
      interpolant_topology(sampled<3>(5, 1.0, [](const Point<3>& x) { return 0.11 + x[0] + 0.7 * x[1] - 0.3 * x[2]; }));
  EXPECT_TRUE(plane.regular);
  EXPECT_EQ(plane.contour, (Topology{1, 1}));
  EXPECT_EQ(interpolant_topology(cell_of({1, -1, -1, -1, -1, -1, -1, -1})).contour, (Topology{1, 1}));
  EXPECT_EQ(interpolant_topology(cell_of({1, 1, 1, 1, 1, 1, 1, 1})).contour, (Topology{0, 0}));
  EXPECT_EQ(interpolant_topology(cell_of({-1, -1, -1, -1, -1, -1, -1, -1})).contour, (Topology{0, 0}));
}

TEST(MultilinearOracle, KnowsTheTwoSidesOfTheSquaresSaddle) {
  // The saddle of 3, -1, -1, 1 is (3 - 1) / 6 > 0: one high component, two low ones.
  const auto joined = interpolant_topology(SampledField<2>{{2, 2}, {3, -1, -1, 1}});
  EXPECT_EQ(joined.high.components, 1);
  EXPECT_EQ(joined.low.components, 2);
  EXPECT_EQ(joined.contour, (Topology{2, 2}));
  const auto parted = interpolant_topology(SampledField<2>{{2, 2}, {1, -3, -1, 1}});
  EXPECT_EQ(parted.high.components, 2);
  EXPECT_EQ(parted.low.components, 1);
  EXPECT_FALSE(interpolant_topology(SampledField<2>{{2, 2}, {1, -1, -1, 1}}).regular);
}

TEST(MultilinearOracle, KnowsTheTunnelBetweenTwoCornersAcrossTheCube) {
  // Equal samples except two at opposite corners of the cube: if the others are small, the two are connected through
  // the body.
  EXPECT_EQ(interpolant_topology(cell_of({100, -1, -1, -1, -1, -1, -1, 100})).contour, (Topology{1, 0}));
  EXPECT_EQ(interpolant_topology(cell_of({100, -90, -90, -90, -90, -90, -90, 100})).contour, (Topology{2, 2}));
  // Two high and two low corners in every square: discs around the high corners, or around the low ones.
  const auto apart = interpolant_topology(cell_of({1, -9, -9, 1, -9, 1, 1, -9}));
  EXPECT_EQ(apart.contour, (Topology{4, 4}));
  const auto together = interpolant_topology(cell_of({9, -1, -1, 9, -1, 9, 9, -1}));
  EXPECT_EQ(together.contour, (Topology{4, 4}));
  EXPECT_EQ(together.high.components, 1);
}

/// The result must not depend on the sweep's axis, whether the cube is regular or not.
TEST(MultilinearOracle, IsTheSameAlongEveryAxis) {
  std::mt19937_64 bits(1);
  for (const std::int64_t bound : {1, 2, 3, 9, 100, 1 << 29}) {
    SCOPED_TRACE(bound);
    std::size_t tunnels = 0;
    for (int i = 0; i < 6000; ++i) {
      const auto field = random_field<3>(bits, 2, bound);
      const auto z = interpolant_topology(field, 2);
      for (const int axis : {0, 1}) {
        const auto other = interpolant_topology(field, axis);
        ASSERT_EQ(z.high, other.high) << ::testing::PrintToString(field.values);
        ASSERT_EQ(z.low, other.low) << ::testing::PrintToString(field.values);
      }
      tunnels += z.regular && z.contour.euler < z.contour.components;
    }
    EXPECT_GE(tunnels, bound > 9 ? 10u : 0u);
  }
}

TEST(MultilinearOracle, SeesWhatIsNotRegular) {
  std::mt19937_64 bits(3);
  EXPECT_TRUE(interpolant_topology(random_field<3>(bits, 5, 1 << 28)).regular);
  EXPECT_FALSE(interpolant_topology(cell_of({0, 1, 2, 3, -4, 5, 6, 7})).regular);
  // A square's saddle has the value 0.
  EXPECT_FALSE(interpolant_topology(cell_of({1, -1, -1, 1, 5, -7, -8, 9})).regular);
  // 27 x y z - 3 (x + y + z) + 2 in [-1, 1]^3 has a critical point of value 0 at (1/3, 1/3, 1/3).
  const auto body = [](std::int64_t level) {
    return interpolant_topology(cell_of({-16 - level, 32 - level, 32 - level, -28 - level,  //
                                         32 - level, -28 - level, -28 - level, 20 - level}));
  };
  EXPECT_FALSE(body(0).regular);
  EXPECT_TRUE(body(-1).regular);
  EXPECT_TRUE(body(1).regular);
  EXPECT_EQ(std::abs(body(-1).contour.euler - body(1).contour.euler), 2);
}

// ---- stratified Morse theory ----

/// Euler characteristic of {f >= c} by Morse theory: the sum, over the samples and the critical points of f and of its
/// restrictions to squares, of the change when c falls below their values: 1 minus the Euler characteristic of the
/// upper link. Uses floating point, so only for generic fields.
class MorseSum {
 public:
  explicit MorseSum(const SampledField<3>& field) : field_(field) {}

  /// The Euler characteristic of {f >= 0}.
  std::int64_t euler() {
    std::int64_t sum = 0;
    std::array<std::size_t, 3> at{};
    for (at[2] = 0; at[2] < field_.sizes[2]; ++at[2])
      for (at[1] = 0; at[1] < field_.sizes[1]; ++at[1])
        for (at[0] = 0; at[0] < field_.sizes[0]; ++at[0]) {
          if (value(at) >= 0) sum += sample(at);
          for (int normal = 0; normal < 3; ++normal) sum += square(at, normal);
          if (at[0] + 1 < field_.sizes[0] && at[1] + 1 < field_.sizes[1] && at[2] + 1 < field_.sizes[2])
            sum += body(at);
        }
    return sum;
  }

 private:
  using Place = std::array<std::size_t, 3>;

  [[nodiscard]] long double value(const Place& at) const {
    return static_cast<long double>(field_.values[at[0] + field_.sizes[0] * (at[1] + field_.sizes[1] * at[2])]);
  }
  [[nodiscard]] Place moved(Place at, int axis, int by) const {
    at[axis] = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at[axis]) + by);
    return at;
  }
  /// The link of a sample is the join of the pairs of its neighbours along each axis.
  [[nodiscard]] std::int64_t sample(const Place& at) const {
    std::int64_t product = 1;
    for (int a = 0; a < 3; ++a) {
      std::int64_t above = 0;
      if (at[a] > 0) above += value(moved(at, a, -1)) > value(at);
      if (at[a] + 1 < field_.sizes[a]) above += value(moved(at, a, 1)) > value(at);
      product *= 1 - above;
    }
    return product;
  }
  /// A saddle in the square; f rises or falls on either side of it.
  [[nodiscard]] std::int64_t square(const Place& at, int normal) const {
    const int a = (normal + 1) % 3, b = (normal + 2) % 3;
    if (at[a] + 1 == field_.sizes[a] || at[b] + 1 == field_.sizes[b]) return 0;
    const auto bilinear = [&](const Place& base) {
      const long double v00 = value(base), v10 = value(moved(base, a, 1)), v01 = value(moved(base, b, 1)),
                        v11 = value(moved(moved(base, a, 1), b, 1));
      return std::array<long double, 4>{v00, v10 - v00, v01 - v00, v11 - v10 - v01 + v00};
    };
    const auto f = bilinear(at);
    const long double x = -f[2] / f[3], y = -f[1] / f[3];
    if (!(0 < x && x < 1 && 0 < y && y < 1)) return 0;
    const auto at_saddle = [&](const std::array<long double, 4>& g) {
      return g[0] + g[1] * x + g[2] * y + g[3] * x * y;
    };
    if (at_saddle(f) < 0) return 0;
    std::int64_t above = 0;
    if (at[normal] > 0) above += at_saddle(bilinear(moved(at, normal, -1))) > at_saddle(f);
    if (at[normal] + 1 < field_.sizes[normal]) above += at_saddle(bilinear(moved(at, normal, 1))) > at_saddle(f);
    return -(1 - above);
  }
  /// After a translation to the centre of symmetry, f is k x y z + a x + b y + c z + d.
  [[nodiscard]] std::int64_t body(const Place& at) const {
    std::array<long double, 8> m{};  // coefficients by monomial: bit a for x_a
    for (unsigned v = 0; v < 8; ++v) {
      Place corner = at;
      for (int a = 0; a < 3; ++a) corner[a] += v >> a & 1u;
      m[v] = value(corner);
    }
    for (unsigned a = 0; a < 3; ++a)
      for (unsigned v = 0; v < 8; ++v)
        if ((v >> a & 1u) != 0) m[v] -= m[v & ~(1u << a)];
    const long double k = m[7];
    const std::array<long double, 3> centre{-m[6] / k, -m[5] / k, -m[3] / k};
    const long double a = m[1] - m[3] * m[5] / k, b = m[2] - m[3] * m[6] / k, c = m[4] - m[5] * m[6] / k;
    const long double square = -b * c / (a * k);
    if (!(square > 0)) return 0;
    std::int64_t sum = 0;
    for (const long double x : {std::sqrt(square), -std::sqrt(square)}) {
      const std::array<long double, 3> local{x, -c / (k * x), -b / (k * x)};
      std::array<long double, 3> place{};
      bool inside = true;
      for (int i = 0; i < 3; ++i) {
        place[i] = local[i] + centre[i];
        inside = inside && 0 < place[i] && place[i] < 1;
      }
      if (!inside) continue;
      long double f = 0;
      for (unsigned v = 0; v < 8; ++v) {
        long double monomial = m[v];
        for (int i = 0; i < 3; ++i)
          if ((v >> i & 1u) != 0) monomial *= place[i];
        f += monomial;
      }
      // The Hessian has trace 0 and determinant 2 k^3 x y z: one or two positive eigenvalues.
      if (f >= 0) sum -= k * local[0] * local[1] * local[2] > 0 ? 1 : -1;
    }
    return sum;
  }

  const SampledField<3>& field_;
};

TEST(MultilinearOracle, AgreesWithStratifiedMorseTheory) {
  std::mt19937_64 bits(4);
  for (int i = 0; i < 20000; ++i) {
    const auto field = random_field<3>(bits, 2, 1 << 28);
    ASSERT_EQ(interpolant_topology(field).high.euler, MorseSum(field).euler())
        << ::testing::PrintToString(field.values);
  }
  for (int i = 0; i < 400; ++i) {
    const auto field = random_field<3>(bits, 5, 1 << 28);
    const auto topology = interpolant_topology(field);
    ASSERT_EQ(topology.high.euler, MorseSum(field).euler()) << ::testing::PrintToString(field.values);
    auto inverted = field;
    for (auto& value : inverted.values) value = -value;
    ASSERT_EQ(topology.low.euler, MorseSum(inverted).euler()) << ::testing::PrintToString(field.values);
  }
}

}  // namespace
}  // namespace tegl::test
