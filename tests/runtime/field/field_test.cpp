// SPDX-License-Identifier: BSD-3-Clause
//
// Fields: their contours' topology and measures, lattices, expressions, errors.
#include "tegl/field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bench/fields.hpp"
#include "errors.hpp"
#include "support/fields.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/measure.hpp"
#include "tegl/normals.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

template <int N>
MeshReport report_of(const std::string& name, std::size_t samples,
                     const std::vector<std::pair<std::string, double>>& parameters = {}) {
  const auto image = sample_field(make_field(name, N, parameters), centred_grid<N>(samples, 1.0));
  return check(extract(image.view(), 1e-4));
}

TEST(Field, EachInEachDimensionIsSampledWithTheSameBytesForAnyNumberOfThreads) {
  for (const FieldInfo& info : fields()) {
    const auto sample = [&]<int N>(std::integral_constant<int, N>) {
      if (N < info.least_dim || N > info.most_dim) return;
      const Field field = make_field(info.name, N);
      const auto grid = centred_grid<N>(N == 5 ? 5 : 8, 1.0);
      const auto image = sample_field(field, grid, {}, {1, {}});
      EXPECT_EQ(image.values, sample_field(field, grid, {}, {3, {}}).values) << info.name;
      for_each_sample<N>(grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
        std::array<double, N> point;
        for (int a = 0; a < N; ++a) point[a] = grid.axes[a][index[a]];
        EXPECT_TRUE(std::isfinite(image.values[i])) << info.name;
        if (info.name == "noise") return;
        EXPECT_NEAR(image.values[i], field(point.data()), 1e-5) << info.name << " in " << N;
      });
    };
    sample(std::integral_constant<int, 2>());
    sample(std::integral_constant<int, 3>());
    sample(std::integral_constant<int, 4>());
    sample(std::integral_constant<int, 5>());
  }
}

TEST(Field, ContoursHaveTheTopologyOfTheirNames) {
  EXPECT_EQ(report_of<3>("ball", 24).euler, 2);
  EXPECT_EQ(report_of<4>("ball", 14).components, 1u);
  EXPECT_EQ(report_of<3>("torus", 32).euler, 0);
  EXPECT_EQ(report_of<3>("knot", 48).euler, 0);
  EXPECT_EQ(report_of<3>("knot", 48, {{"p", 2}, {"q", 4}}).components, 1u);
  EXPECT_EQ(report_of<3>("csg", 40).euler, -8);  // a surface of genus 5: three bores that meet
  EXPECT_EQ(report_of<3>("moving", 24).components, 1u);
  EXPECT_EQ(report_of<3>("merging", 40).components, 1u);  // through the time
  for (const char* const name : {"gyroid", "primitive", "diamond", "neovius", "metaballs", "noise"})
    EXPECT_EQ(report_of<3>(name, 20).bad_links, 0u) << name;
}

TEST(Field, MergingBallsAreTwoAndThenOne) {
  const auto image = sample_field(make_field("merging", 4), centred_grid<4>(28, 1.0));
  const auto contour = extract(image.view(), 1e-4);
  EXPECT_EQ(check(slice(contour, Hyperplane<4>::across(3, -0.95))).components, 2u);
  EXPECT_EQ(check(slice(contour, Hyperplane<4>::across(3, 0.95))).components, 1u);
}

TEST(Field, MetaballsAreThoseOfTheMeasurements) {
  const auto expected = bench::make_field<3>("metaballs", 32);
  const auto found = sample_field(make_field("metaballs", 3), centred_grid<3>(32, 1.0));
  for (std::size_t i = 0; i < expected.values.size(); ++i) ASSERT_NEAR(found.values[i], expected.values[i], 1e-5F) << i;
  const auto other = sample_field(make_field("metaballs", 3, {}, 1), centred_grid<3>(8, 1.0));
  EXPECT_NE(other.values, sample_field(make_field("metaballs", 3), centred_grid<3>(8, 1.0)).values);
}

TEST(Field, OrbitalsHaveTheNorm1AndAreOrthogonal) {
  const auto grid = centred_grid<3>(60, 1.0);
  constexpr double kExtent = 22;
  const auto orbital = [&](double n, double l, double m) {
    return sample_field(make_field("orbital", 3, {{"n", n}, {"l", l}, {"m", m}, {"extent", kExtent}}), grid);
  };
  const double cell = std::pow(2 * kExtent / 59, 3);
  const auto product = [&](const auto& a, const auto& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
      sum += static_cast<double>(a.values[i]) * static_cast<double>(b.values[i]) * cell;
    return sum;
  };
  const auto d = orbital(3, 2, 1), p = orbital(2, 1, 0), other = orbital(3, 2, -1);
  EXPECT_NEAR(product(d, d), 1, 0.01);
  EXPECT_NEAR(product(p, p), 1, 0.01);
  EXPECT_NEAR(product(other, other), 1, 0.01);
  EXPECT_NEAR(product(d, p), 0, 1e-3);
  EXPECT_NEAR(product(d, other), 0, 1e-3);
  // the ground state: exp(-r) / sqrt(pi)
  const std::array<double, 3> at = {0.1, 0.2, -0.2};
  EXPECT_NEAR(make_field("orbital", 3, {{"extent", 1}})(at.data()), std::exp(-0.3) / std::sqrt(std::numbers::pi),
              1e-12);
  // 4D: the density of two states, one beat later the same
  const Field beat = make_field("orbital", 4);
  const std::array<double, 4> start = {0.1, 0, 0.2, -1}, end = {0.1, 0, 0.2, 1};
  EXPECT_NEAR(beat(start.data()), beat(end.data()), 1e-12);
  // 5D: from the density of the first state to that of the second
  const Field mixed = make_field("orbital", 5);
  const Field one = make_field("orbital", 3, {{"extent", 12}}), two = make_field("orbital", 3, {{"n", 2}, {"l", 1}});
  const std::array<double, 5> first = {0.1, 0, 0.2, 0.3, -1}, both = {0.1, 0, 0.2, 0.3, 0},
                              second = {0.1, 0, 0.2, 0.3, 1};
  EXPECT_NEAR(mixed(first.data()), std::pow(one(first.data()), 2), 1e-12);
  EXPECT_NEAR(mixed(both.data()), beat(both.data()), 1e-12);
  EXPECT_NEAR(mixed(second.data()), std::pow(two(second.data()), 2), 1e-12);
}

TEST(Field, LatticesShiftTheirLayers) {
  const Field x(3, [](const double* start, double step, std::size_t count, double* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = start[0] + static_cast<double>(i) * step + 10 * start[1];
  });
  const auto image = sample_field(x, Grid<3>::unit({4, 4, 3}), Lattice::bcc);
  EXPECT_EQ(image.values[0], 0);
  EXPECT_EQ(image.values[16], 5.5F);
  EXPECT_EQ(image.values[32], 0);
  // The volume of a ball on each lattice.
  Grid<3> grid = centred_grid<3>(31, 1.0);
  for (const Lattice lattice : {Lattice::fcc, Lattice::bcc}) {
    const double step = grid.axes[0].step() * layer_step(lattice);
    grid.axes[2] = Axis::uniform(static_cast<std::size_t>(2 / step) + 1, -1, step);
    const auto ball = sample_field(make_field("ball", 3, {{"radius", 0.6}}), grid, lattice);
    const auto contour = extract(lattice_complex(ball.view(), lattice), 0.0);
    EXPECT_NEAR(measure(contour).content.value(), 4 * std::numbers::pi / 3 * 0.216, 0.01) << name_of(lattice);
  }
}

TEST(Field, ExpressionsHaveCoordinatesAndShapes) {
  if (!has_expressions()) GTEST_SKIP() << "built without muParser";
  const std::array<double, 5> at = {0.1, -0.2, 0.3, 0.4, 0.5};
  EXPECT_NEAR(make_expression("x + 10*y^2 + z*_pi", 3)(at.data()), 0.1 + 0.4 + 0.3 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(make_expression("r", 5)(at.data()), std::sqrt(0.55), 1e-12);
  EXPECT_NEAR(make_expression("ball(x, y, z, t, u, 2)", 5)(at.data()), 2 - std::sqrt(0.55), 1e-12);
  EXPECT_NEAR(make_expression("min(box(x, 0.5, y, 0.25), -ball(x - 0.1, y + 0.2, 0.1))", 2)(at.data()), -0.1, 1e-12);
  EXPECT_NEAR(make_expression("torus(x, y, z, 0.6, 0.2)", 3)(at.data()),
              make_field("torus", 3, {{"ring", 0.6}, {"tube", 0.2}})(at.data()), 1e-12);
  const auto image = sample_field(make_expression("0.8 - r", 3), centred_grid<3>(20, 1.0), {}, {4, {}});
  EXPECT_EQ(image.values, sample_field(make_field("ball", 3), centred_grid<3>(20, 1.0)).values);
  expect_error(ErrorCode::InvalidArgument, "the expression 'x +'",
               [] { static_cast<void>(make_expression("x +", 3)); });
  expect_error(ErrorCode::InvalidArgument, "expected an expression of x, y and r",
               [] { static_cast<void>(make_expression("z", 2)); });
  expect_error(ErrorCode::InvalidArgument, "box needs", [] { static_cast<void>(make_expression("box(x)", 2)); });
}

TEST(Field, RefusesWhatItDoesNotKnow) {
  const auto refuse = [](const std::string& part, const std::string& name, int dim,
                         const std::vector<std::pair<std::string, double>>& parameters = {}) {
    expect_error(ErrorCode::InvalidArgument, part, [&] { static_cast<void>(make_field(name, dim, parameters)); });
  };
  refuse("no field 'cube'; expected ball, metaballs", "cube", 3);
  refuse("the field 'knot' in 2 dimensions; expected 3 to 5", "knot", 2);
  refuse("has no parameter 'size'; expected radius", "ball", 3, {{"size", 1}});
  refuse("radius is nan; expected a finite number", "ball", 3, {{"radius", std::nan("")}});
  refuse("count is 0; expected a whole number from 1", "metaballs", 3, {{"count", 0}});
  refuse("n = 2, l = 2, m = 0; expected", "orbital", 3, {{"n", 2}, {"l", 2}});
  expect_error(ErrorCode::InvalidArgument, "the field 'gyroid' with the seed 7; expected 0",
               [] { static_cast<void>(make_field("gyroid", 3, {}, 7)); });
  const Field ball = make_field("ball", 3);
  expect_error(ErrorCode::InvalidArgument, "a field in 3 dimensions on a grid in 2", [&] {
    static_cast<void>(sample_field(ball, Grid<2>::unit({3, 3})));
  });
  expect_error(ErrorCode::InvalidArgument, "the lattice d4 in 3 dimensions; expected 4", [&] {
    static_cast<void>(sample_field(ball, Grid<3>::unit({3, 3, 3}), Lattice::d4));
  });
}

}  // namespace
}  // namespace tegl::test
