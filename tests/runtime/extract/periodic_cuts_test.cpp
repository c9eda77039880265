// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of wrapped contours across a period, at places modulo the period (tegl/slice.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cut/each_cut.hpp"
#include "errors.hpp"
#include "tegl/check.hpp"
#include "tegl/curved.hpp"
#include "tegl/measure.hpp"
#include "tegl/periodic.hpp"
#include "tegl/slice.hpp"
#include "torus.hpp"

namespace tegl::test {
namespace {

template <int N>
double waves_from(std::array<double, N> x, int axis, double start) {
  x[axis] += start;
  double sum = 0.4 * std::cos(kTurn * (x[0] - x[N - 1]));
  for (int a = 0; a < N; ++a) sum += (0.5 + 0.1 * a) * std::sin(kTurn * x[a] + a);
  return sum;
}

TEST(PeriodicCuts, CutsAcrossAPeriodAreThoseOfDataFromAnotherStart) {
  const auto test = []<int N>(const std::array<std::size_t, N>& sizes) {
    for (int axis = 0; axis < N; ++axis) {
      const auto from = [&](double start) {
        const auto image =
            torus_image<N>(sizes, [&](const std::array<double, N>& x) { return waves_from<N>(x, axis, start); });
        return wrapped<double>(image, all_periodic<N>(), 0.05);
      };
      const auto contour = from(0.0), other = from(0.5);
      for (const double at : {0.0, 0.01, 0.1, 0.25, 0.93, 0.99}) {
        const auto cut = slice(contour, Hyperplane<N>::across(axis, at));
        const auto expected = slice(other, Hyperplane<N>::across(axis, at - 0.5));
        EXPECT_TRUE(is_closed(check(cut))) << at;
        EXPECT_EQ(cut.periods.size(), static_cast<std::size_t>(N - 1));
        EXPECT_EQ(check(cut).euler, check(expected).euler);
        EXPECT_EQ(check(cut).components, check(expected).components);
        EXPECT_NEAR(measure(cut).size, measure(expected).size, 1e-9) << at;
        // at a place a period further, and with the opposite normal
        const auto further = slice(contour, Hyperplane<N>::across(axis, at + 3.0));
        EXPECT_NEAR(measure(further).size, measure(cut).size, 1e-9);
        Hyperplane<N> opposite = Hyperplane<N>::across(axis, 1.0 - at);
        opposite.normal[axis] = -1.0;
        const auto below = slice(contour, opposite);
        EXPECT_TRUE(is_closed(check(below)));
        EXPECT_NEAR(measure(below).size, measure(cut).size, 1e-9);
      }
      // the same bits at the start and the end, in a stack, and as measured
      const std::vector<double> places = {0.0, 1.0, 0.05, -0.3};
      std::vector<Hyperplane<N>> hyperplanes;
      for (const double at : places) hyperplanes.push_back(Hyperplane<N>::across(axis, at));
      const auto stack = slice_stack(contour, hyperplanes);
      EXPECT_EQ(stack[0].vertices, stack[1].vertices);
      EXPECT_EQ(stack[0].simplices, stack[1].simplices);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const auto cut = slice(contour, hyperplanes[i]);
        EXPECT_EQ(cut.vertices, stack[i].vertices);
        EXPECT_EQ(cut.simplices, stack[i].simplices);
        if (axis + 1 == N) {
          EXPECT_EQ(measure_cuts(contour, places)[i].size, measure(cut).size);
        }
      }
    }
  };
  test.template operator()<3>({12, 16, 10});
  test.template operator()<4>({8, 6, 10, 8});
}

std::vector<Period<3>> periods_of(const std::vector<Vector<3>>& vectors) {
  std::vector<Period<3>> periods;
  for (const Vector<3>& vector : vectors) periods.push_back({vector, {}, 0.0});
  return periods;
}

TEST(PeriodicCuts, PlacesAreModuloAPeriodAlongTheAxis) {
  // the part along the axis of the vector from a cut to the next one; 0 for none, negative if it is not along the axis
  const auto along = [](const std::vector<Vector<3>>& vectors, int axis) {
    const auto period = cut_period<3>(periods_of(vectors), unit_vector<3>(axis));
    if (!period) return 0.0;
    EXPECT_DOUBLE_EQ(period->vector[axis], period->length);
    return period->is_straight ? period->length : -period->length;
  };
  EXPECT_EQ(along({{2, 0, 0}}, 0), 2.0);
  EXPECT_EQ(along({{-2, 0, 0}}, 0), 2.0);
  EXPECT_EQ(along({{2, 0, 0}}, 1), 0.0);
  EXPECT_EQ(along({}, 1), 0.0);
  for (const double rounding : {6e-17, -1e-8}) {
    EXPECT_EQ(along({{2, rounding, 0}}, 0), 2.0);
    EXPECT_EQ(along({{2, rounding, 0}}, 1), 0.0);
    EXPECT_TRUE(cuts_wrapped<3>(periods_of({{2, rounding, 0}}), Hyperplane<3>::across(1, 0.5)));
    EXPECT_EQ(along({{1, 0, rounding}, {0, 1, 0}, {0, 0, 1}}, 2), 1.0);
    EXPECT_EQ(along({{1, 0, rounding}, {0, 1, 0}, {0, 0, 1}}, 0), 1.0);
  }
  // oblique: places drift along an axis that is not periodic
  EXPECT_EQ(along({{2, 0.003, 0}}, 0), 0.0);
  EXPECT_EQ(along({{2, 0.003, 0}}, 1), 0.0);
  EXPECT_EQ(along({{1, 0, 0}, {0.5, 0.8, 0.1}}, 1), 0.0);
  EXPECT_FALSE(cuts_wrapped<3>(periods_of({{1, 0, 0}, {0.5, 0.8, 0.1}}), Hyperplane<3>::across(1, 0.5)));
  // oblique by a multiple of another period: the cut moves within its hyperplane
  EXPECT_EQ(along({{1, 0, 0}, {0.5, 0.8, 0}}, 1), -0.8);
  EXPECT_EQ(along({{0.5, 0.8, 0}, {1, 0, 0}}, 1), -0.8);
  // several periods cross the axis
  EXPECT_EQ(along({{1, 0, 0}, {0.5, 0.8, 0}}, 0), -0.5);
  EXPECT_EQ(along({{1, 0, 1}, {0, 1, 1}, {0.5, 0.5, 3}}, 2), -1.0);
  EXPECT_NEAR(along({{1, 0, 0.3}, {0, 1, 0}, {0, 0, 1}}, 2), -0.1, 1e-9);
  EXPECT_EQ(along({{1, 0, std::numbers::phi}, {0, 1, 0}, {0, 0, 1}}, 2), 0.0);
  EXPECT_EQ(along({{1, 0, 0.001}, {0, 1, 0}, {0, 0, 1}}, 2), 0.0);
}

TEST(PeriodicCuts, CutsDoNotDependOnTheUnitsOfAxes) {
  const std::vector<std::vector<Vector<3>>> cells = {{{1, 0, 0.3}, {0, 1, 0}, {0, 0, 1}},
                                                     {{1, 0, std::numbers::phi}, {0, 1, 0}, {0, 0, 1}},
                                                     {{1, 0, 1e-8}, {0, 1, 0}, {0, 0, 1}},
                                                     {{0.3, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                                                     {{1, 0, 0.3}, {0, 1, 0}},
                                                     {{1, 0, 0.3}}};
  for (const std::vector<Vector<3>>& cell : cells)
    for (const double factor : {1e-5, 1.0, 1e5}) {
      Contour<3, double> contour;
      contour.periods = periods_of(cell);
      const Contour<3, double> scaled = scale_axes(contour, {factor, 1.0, 1.0});
      for (int axis = 0; axis < 3; ++axis) {
        const Vector<3> normal = unit_vector<3>(axis);
        const auto expected = cut_period<3>(contour.periods, normal), period = cut_period<3>(scaled.periods, normal);
        ASSERT_EQ(period.has_value(), expected.has_value()) << axis << " " << factor;
        EXPECT_EQ(cuts_wrapped<3>(scaled.periods, {normal, 0.0}), cuts_wrapped<3>(contour.periods, {normal, 0.0}));
        if (!period) continue;
        EXPECT_EQ(period->is_straight, expected->is_straight) << axis << " " << factor;
        EXPECT_NEAR(period->length, expected->length * (axis == 0 ? factor : 1.0), 1e-9 * period->length);
      }
    }
}

double waves_of_cell(const std::array<double, 3>& shares) { return waves_from<3>(shares, 0, 0.0); }

TEST(PeriodicCuts, RoundingOfNormalsIsNoDirection) {
  const auto cuts = [](const std::vector<Vector<3>>& vectors, const Vector<3>& normal) {
    return cuts_wrapped<3>(periods_of(vectors), Hyperplane<3>{normal, 0.3});
  };
  const std::vector<Vector<3>> cube = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, along_z = {{0, 0, 1}};
  for (const double rounding : {std::cos(std::numbers::pi / 2), -1e-17, 0.0}) {
    EXPECT_TRUE(cuts(cube, {rounding, 0, 1}));
    EXPECT_TRUE(cuts(along_z, {rounding, 0, 1}));
    EXPECT_TRUE(cuts(along_z, {1, 0, rounding}));  // along the period
    EXPECT_FALSE(cut_period<3>(periods_of(along_z), {1, 0, rounding}));
  }
  EXPECT_TRUE(cuts(cube, {std::cos(std::numbers::pi_v<float> / 2), 0, 1}));
  EXPECT_FALSE(cuts(along_z, {1e-6, 0, 1}));
  EXPECT_FALSE(cuts(along_z, {1, 0, 1e-6}));
  // a short period is no rounding of a long one
  const std::vector<Vector<3>> units = {{360, 0, 0}, {0, 1, 0}, {0, 0, 1e-4}};
  EXPECT_FALSE(cuts(units, {1, 0, 1}));
  EXPECT_FALSE(cuts(units, {1, 1, 0}));
  EXPECT_TRUE(cuts(units, {1, 0, 3.6e6}));
  EXPECT_TRUE(cuts(units, {0, 1, 2e4}));
  EXPECT_TRUE(cuts(units, {0, 0, 1}));
  // such a cut is the same as without it
  const auto contour = wrapped<double>(torus_image<3, double>({12, 10, 12}, waves_of_cell), {0.0, 0.0, 1.0}, 0.4);
  for (const double at : {0.3, 5.3})
    EXPECT_NEAR(measure(slice(contour, Hyperplane<3>{{std::cos(std::numbers::pi / 2), 0, 1}, at})).size,
                measure(slice(contour, Hyperplane<3>::across(2, 0.3))).size, 1e-9);
}

/// An image of a unit cell with these vectors, of a field by shares of the cell.
template <int N, class F>
OwnedImage<double, N> cell_image(const std::array<std::size_t, N>& sizes, const std::array<Vector<N>, N>& vectors,
                                 const F& field) {
  auto image = torus_image<N, double>(sizes, field);
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) image.grid.linear[a][b] = vectors[b][a];
  return image;
}

/// The largest difference of the field from the isovalue at the vertices of a cut.
template <int N, class F>
double most_apart(const Contour<N, double>& contour, const Contour<N - 1, double>& cut, const Hyperplane<N>& hyperplane,
                  const F& field, double isovalue) {
  const HyperplaneFrame<N> frame = frame_of(hyperplane);
  double most = 0.0;
  for (const auto& vertex : cut.vertices) {
    const Vector<N> x = frame.to_space(vertex);
    std::array<double, N> shares{};
    for (int a = 0; a < N; ++a)
      for (int b = 0; b < N; ++b) shares[a] += contour.periods[a].dual[b] * x[b];
    most = std::max(most, std::abs(field(shares) - isovalue));
  }
  return most;
}

TEST(PeriodicCuts, PlacesOnAShearedAxisAreThoseOfTheRepeatedField) {
  const auto image = cell_image<3>({24, 24, 24}, {{{1, 0, 0}, {0, 1, 0}, {0.3, 0, 1}}}, waves_of_cell);
  const auto contour = wrapped<double>(image, all_periodic<3>(), 0.4);
  const auto first = slice(contour, Hyperplane<3>::across(2, 0.2));
  EXPECT_NEAR(first.periods[0].start, 0.06, 1e-12);
  std::vector<Hyperplane<3>> hyperplanes;
  for (const double at : {0.2, -0.8, 1.2, 5.2, -13.8})
    for (const double sign : {1.0, -2.0}) hyperplanes.push_back({{0.0, 0.0, sign}, sign * at});
  const auto stack = slice_stack(contour, hyperplanes);
  for (std::size_t i = 0; i < hyperplanes.size(); ++i) {
    const auto cut = slice(contour, hyperplanes[i]);
    EXPECT_LT(most_apart(contour, cut, hyperplanes[i], waves_of_cell, 0.4), 0.02) << i;
    EXPECT_TRUE(is_closed(check(cut))) << i;
    EXPECT_NEAR(measure(cut).size, measure(first).size, 1e-9) << i;
    for (const auto& x : cut.vertices)  // within the periods of the cut
      for (const Period<2>& period : cut.periods) {
        const double share = period.dual[0] * x[0] + period.dual[1] * x[1] - period.start;
        EXPECT_TRUE(share >= -1e-9 && share <= 1.0 + 1e-9) << share;
      }
    EXPECT_EQ(stack[i].vertices, cut.vertices) << i;
    EXPECT_EQ(stack[i].simplices, cut.simplices) << i;
  }
}

TEST(PeriodicCuts, AxesMayBeShearedByHalfAPeriodAndMore) {
  // a step along y, which is not periodic, moves x by this share of the period
  for (const double shear : {0.0, 0.3, 0.6, -0.6, 1.1, 7.5}) {
    const auto image_of = [&](std::size_t columns) {
      OwnedImage<double, 3> image;
      image.grid = Grid<3>::unit({columns, 5, 40});
      image.grid.linear = {{{0.1, shear, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.1}}};
      for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 5; ++j)
          for (std::size_t i = 0; i < columns; ++i)
            image.values.push_back(0.1 * k - 2.0 - 0.3 * std::sin(kTurn * (0.1 * static_cast<double>(i) + shear * j)) -
                                   0.1 * j);
      return image;
    };
    const auto contour = wrapped<double>(image_of(10), {10.0, 0.0, 0.0}, 0.013);
    const auto repeated = image_of(1200);
    const auto cut = slice(contour, Hyperplane<3>::across(0, 0.31));
    const auto expected = slice(extract<double>(repeated.view(), 0.013), Hyperplane<3>::across(0, 60.31));
    EXPECT_EQ(check(cut).components, 1u) << shear;
    EXPECT_EQ(check(expected).components, 1u) << shear;
    EXPECT_NEAR(measure(cut).size, measure(expected).size, 1e-9) << shear;
  }
}

TEST(PeriodicCuts, LatticePlanesOfObliqueCellsHaveClosedCuts) {
  const std::array<Vector<3>, 3> primitive = {{{0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};
  const auto contour = wrapped<double>(cell_image<3>({24, 24, 24}, primitive, waves_of_cell), all_periodic<3>(), 0.4);
  // the same field on the cube of the face-centred lattice, which has four cells
  const auto of_cube = [](const std::array<double, 3>& x) {
    return waves_of_cell({x[1] + x[2] - x[0], x[0] + x[2] - x[1], x[0] + x[1] - x[2]});
  };
  const auto cube = wrapped<double>(torus_image<3, double>({48, 48, 48}, of_cube), all_periodic<3>(), 0.4);
  for (int axis = 0; axis < 3; ++axis)
    for (const double at : {0.1, 0.37, 0.6, -3.21, 7.37}) {
      const auto hyperplane = Hyperplane<3>::across(axis, at);
      ASSERT_TRUE(cuts_wrapped<3>(contour.periods, hyperplane));
      const auto cut = slice(contour, hyperplane);
      EXPECT_TRUE(is_closed(check(cut))) << axis << " " << at;
      EXPECT_EQ(cut.periods.size(), 2u);
      EXPECT_LT(most_apart(contour, cut, hyperplane, waves_of_cell, 0.4), 0.03) << axis << " " << at;
      const double expected = measure(slice(cube, hyperplane)).size / 2.0;
      EXPECT_NEAR(measure(cut).size, expected, 0.01 * expected) << axis << " " << at;
    }
  // planes of any direction, also by multiples of their normals: the same lattice by another cell, with two sides in
  // the plane
  const auto test = [](const Vector<3>& normal, const std::array<Vector<3>, 3>& vectors) {
    const auto plain = wrapped<double>(torus_image<3, double>({24, 24, 24}, waves_of_cell), all_periodic<3>(), 0.4);
    const auto of_other = [&](const std::array<double, 3>& shares) {
      std::array<double, 3> x{};
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) x[a] += shares[b] * vectors[b][a];
      return waves_of_cell(x);
    };
    const auto other = wrapped<double>(cell_image<3>({48, 48, 48}, vectors, of_other), all_periodic<3>(), 0.4);
    for (const double offset : {0.3, -4.7, 1.8}) {
      const Hyperplane<3> plane{normal, offset};
      const auto cut = slice(plain, plane), expected = slice(other, plane);
      EXPECT_TRUE(is_closed(check(cut))) << offset;
      EXPECT_LT(most_apart(plain, cut, plane, waves_of_cell, 0.4), 0.03) << offset;
      EXPECT_NEAR(measure(cut).size, measure(expected).size, 0.01 * measure(expected).size) << offset;
      EXPECT_EQ(check(cut).components, check(expected).components) << offset;
      EXPECT_EQ(slice_stack(plain, {plane, plane})[1].vertices, cut.vertices);
    }
  };
  test({1, 1, 1}, {{{-1, 1, 0}, {-1, 0, 1}, {1, 0, 0}}});
  test({0.5, -0.5, 0}, {{{1, 1, 0}, {0, 0, 1}, {1, 0, 0}}});
  test({2, 3, 0}, {{{3, -2, 0}, {0, 0, 1}, {-1, 1, 0}}});
}

TEST(PeriodicCuts, HyperplanesOf4dLatticesHaveClosedCuts) {
  const auto field = [](const std::array<double, 4>& x) { return waves_from<4>(x, 0, 0.0); };
  const auto contour = wrapped<double>(torus_image<4, double>({12, 10, 12, 10}, field), all_periodic<4>(), 0.05);
  for (const Vector<4>& normal : {Vector<4>{1, 0, 0, 2}, Vector<4>{1, -1, 0, 1}, Vector<4>{0, 0, 3, 2}}) {
    const Hyperplane<4> hyperplane{normal, 2.3};
    const auto cut = slice(contour, hyperplane);
    EXPECT_TRUE(is_closed(check(cut)));
    EXPECT_EQ(cut.periods.size(), 3u);
    EXPECT_GT(cut.simplices.size(), 1000u);
    EXPECT_LT(most_apart(contour, cut, hyperplane, field, 0.05), 0.3);
  }
}

TEST(PeriodicCuts, AxesOfTwoObliquePeriodsHaveClosedCuts) {
  // hexagonal cells that end along z
  auto image = cell_image<3>({24, 24, 12}, {{{1, 0, 0}, {-0.5, std::sqrt(0.75), 0}, {0, 0, 1}}}, waves_of_cell);
  const auto contour = wrapped<double>(image, {1.0, 1.0, 0.0}, 0.4);
  for (const double at : {0.2, 3.7}) {
    const auto cut = slice(contour, Hyperplane<3>::across(0, at));
    ASSERT_EQ(cut.periods.size(), 1u);
    EXPECT_NEAR(std::abs(cut.periods[0].vector[0]), std::sqrt(3.0), 1e-12);
    // open only at the ends of z
    for (std::size_t v = 0; v < cut.vertices.size(); ++v) EXPECT_TRUE(std::isfinite(cut.vertices[v][1]));
    const auto report = check(cut);
    EXPECT_TRUE(is_manifold(report));
    EXPECT_EQ(report.boundary_simplices, check(slice(contour, Hyperplane<3>::across(0, at + 0.5))).boundary_simplices);
    EXPECT_NEAR(measure(cut).size, measure(slice(contour, Hyperplane<3>::across(0, at + 0.5))).size, 1e-9);
  }
  EXPECT_FALSE(cuts_wrapped<3>(contour.periods, {{1.0, 0.0, 0.5}, 0.0}));
}

TEST(PeriodicCuts, AllLatticePlanesOfSmallMultiplesHaveCuts) {
  const auto test = [](const std::array<Vector<3>, 3>& vectors, std::size_t samples, double most) {
    const std::array<std::size_t, 3> sizes = {samples, samples, samples};
    const auto contour = wrapped<double>(cell_image<3>(sizes, vectors, waves_of_cell), all_periodic<3>(), 0.4);
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y)
        for (int z = 0; z <= 3; ++z) {
          const Hyperplane<3> plane{{1.0 * x, 1.0 * y, 1.0 * z}, 0.37};
          if ((x == 0 && y == 0 && z == 0) || !cuts_wrapped<3>(contour.periods, plane)) continue;
          SCOPED_TRACE(testing::Message() << x << " " << y << " " << z);
          const auto cut = slice(contour, plane);
          EXPECT_TRUE(is_closed(check(cut)));
          EXPECT_GT(cut.simplices.size(), 10u);
          EXPECT_LT(most_apart(contour, cut, plane, waves_of_cell, 0.4), most);
        }
  };
  test({{{1, 0, 0}, {0, 1, 0}, {0.3, 0, 1}}}, 24, 0.03);
  test({{{0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}}, 12, 0.2);
  // periods along the planes are short, and axes may have any units
  const auto contour = wrapped<double>(torus_image<3, double>({24, 24, 24}, waves_of_cell), all_periodic<3>(), 0.4);
  const auto scaled = scale_axes(contour, {360.0, 1.0, 1e-4});
  const auto expected = slice(contour, Hyperplane<3>{{3, 3, 1}, 0.37});
  const auto cut = slice(scaled, Hyperplane<3>{{3.0 / 360, 3, 1e4}, 0.37});
  EXPECT_TRUE(is_closed(check(cut)));
  EXPECT_EQ(cut.simplices.size(), expected.simplices.size());
  for (const Period<2>& period : expected.periods) EXPECT_LT(std::hypot(period.vector[0], period.vector[1]), 3.5);
}

TEST(PeriodicCuts, SimplicesOfHalfASumOfPeriodsAreRefused) {
  // by three samples, the parts of a long cell reach over half of a short period in the plane
  const auto image = cell_image<3>({3, 3, 3}, {{{1, 0, 0}, {8, 1, 0}, {0, 8, 1}}}, noise_of<3>(5));
  const auto contour = wrapped<double>(image, all_periodic<3>(), 0.0);
  const Hyperplane<3> plane{{1.0, 1.0, 0.0}, 0.5};
  EXPECT_TRUE(cuts_wrapped<3>(contour.periods, plane));
  expect_error(ErrorCode::InvalidArgument, "simplices of half of it", [&] { (void)slice(contour, plane); });
  const auto cube = wrapped<double>(torus_image<3, double>({3, 3, 3}, noise_of<3>(5)), all_periodic<3>(), 0.0);
  for (const Vector<3>& normal : {Vector<3>{1, 2, 0}, Vector<3>{2, 3, 0}})
    EXPECT_TRUE(is_closed(check(slice(cube, Hyperplane<3>{normal, 0.5}))));
}

TEST(PeriodicCuts, PlacesFarFromAPeriodAreErrorsUnlessTheyAreModuloIt) {
  const auto image = cell_image<3>({12, 12, 12}, {{{1, 0, 0}, {0, 1, 0}, {0.3, 0, 1}}}, waves_of_cell);
  const auto contour = wrapped<double>(image, all_periodic<3>(), 0.4);
  expect_error(
      ErrorCode::InvalidArgument,
      "a slice across a period has the coordinate 1000000000000 along axis 2, with the period 1 from 0; expected "
      "at most 536870912 periods",
      [&] { (void)slice(contour, Hyperplane<3>::across(2, 1e12)); });
  expect_error(ErrorCode::InvalidArgument, "a slice across a period has the coordinate -1000000000000 along axis 2",
               [&] {
                 (void)slice_stack(contour, {Hyperplane<3>::across(2, 0.5), Hyperplane<3>::across(2, -1e12)});
               });
  expect_error(ErrorCode::InvalidArgument, "the coordinate 1e+300 along the normal, with the period 0.3", [&] {
    (void)slice(contour, {{3.0, 3.0, 0.0}, 1e300});
  });
  EXPECT_TRUE(is_closed(check(slice(contour, Hyperplane<3>::across(1, 1e12 + 0.25)))));
  auto hostile = contour;
  hostile.vertices[3] = {0.0, 0.0, 1e12};
  expect_error(ErrorCode::InvalidArgument, "vertex 3 has the coordinate 3000000000000 along the normal", [&] {
    (void)slice(hostile, {{0.0, 3.0, 3.0}, 0.5});
  });
  // dual vectors that are wrong do not lead to more work
  auto wrong = contour;
  for (auto& period : wrong.periods) period.dual = {1e-9, 1e-9, 1e-9};
  wrong.vertices[contour.simplices[0][1]][2] += 1e6;
  expect_error(ErrorCode::InvalidArgument,
               "with simplex 0 over more than 128 periods of the slices; expected shorter ones", [&] {
                 (void)slice(wrong, {{0.0, 1.0, 1.0}, 0.5});
               });
}

TEST(PeriodicCuts, PlacesFarFromAnObliquePeriodHaveTheCutsOfNearOnes) {
  const auto test = []<class Real>(Real, double most_far, double rounding) {
    const std::array<Vector<3>, 3> primitive = {{{0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};
    const std::array<Vector<3>, 3> sheared = {{{1, 0, 0}, {0, 1, 0}, {0.3, 0, 1}}};
    for (const auto& vectors : {primitive, sheared}) {
      const auto contour = wrapped<Real>(cell_image<3>({12, 12, 12}, vectors, waves_of_cell), all_periodic<3>(), 0.4);
      for (const Vector<3>& normal : {Vector<3>{0, 0, 1}, Vector<3>{0, 0, -1}, Vector<3>{1, 2, 1}}) {
        const std::optional<CutPeriod<3>> period = cut_period<3>(contour.periods, normal);
        ASSERT_TRUE(period);
        const Hyperplane<3> near{normal, 0.2 * period->length};
        const auto expected = slice(contour, near);
        for (const double times : {-1.0, 1e3, 1e5 + 1.0, -most_far}) {
          const Hyperplane<3> far{normal, near.offset + times * period->length};
          const auto cut = slice(contour, far);
          EXPECT_TRUE(is_closed(check(cut)));
          EXPECT_EQ(cut.simplices.size(), expected.simplices.size()) << times;
          EXPECT_NEAR(measure(cut).size, measure(expected).size, rounding) << times;
          // the field is 0.4 at its places in space
          const HyperplaneFrame<3> frame = frame_of(far);
          double most = 0.0;
          for (const auto& vertex : cut.vertices) {
            const Vector<3> x = frame.to_space({static_cast<double>(vertex[0]), static_cast<double>(vertex[1])});
            std::array<double, 3> shares{};
            for (int a = 0; a < 3; ++a)
              for (int b = 0; b < 3; ++b) shares[a] += contour.periods[a].dual[b] * x[b];
            most = std::max(most, std::abs(waves_of_cell(shares) - 0.4));
          }
          EXPECT_LT(most, 0.1) << times;
        }
      }
    }
  };
  test.operator()(float{}, 3e6, 1e-4);
  test.operator()(double{}, 3e6, 1e-7);
}

TEST(PeriodicCuts, StacksOfDistantPlacesDoNotTakeLonger) {
  const auto image = cell_image<3>({12, 12, 12}, {{{1, 0, 0}, {0, 1, 0}, {0.3, 0, 1}}}, waves_of_cell);
  const auto contour = wrapped<double>(image, all_periodic<3>(), 0.4);
  // by multiples of the period between these places, this would take hours
  const std::vector<Hyperplane<3>> planes = {Hyperplane<3>::across(2, -4e8 + 0.2), Hyperplane<3>::across(2, 0.2),
                                             Hyperplane<3>::across(2, 4e8 + 0.7)};
  const auto stack = slice_stack(contour, planes);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_TRUE(is_closed(check(stack[i])));
    EXPECT_EQ(stack[i].vertices, slice(contour, planes[i]).vertices);
  }
}

TEST(PeriodicCuts, StacksAreCancelledWhileSimplicesAreMoved) {
  const auto contour = wrapped<double>(torus_image<3, double>({72, 72, 72}, waves_of_cell), all_periodic<3>(), 0.05);
  std::vector<Hyperplane<3>> hyperplanes;
  for (const double at : {0.1, 0.2, 0.3}) hyperplanes.push_back(Hyperplane<3>::across(0, at));
  std::vector<double> told;  // by a stack of one pass and three cuts: the pass is a quarter
  (void)slice_stack(contour, hyperplanes, {1, [&](double fraction) {
                                             told.push_back(fraction);
                                             return true;
                                           }});
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  const auto is_within = [](double fraction) { return fraction > 0.0 && fraction < 0.25; };
  EXPECT_GE(std::count_if(told.begin(), told.end(), is_within), 2);
  expect_error(ErrorCode::Cancelled, "", [&] {
    (void)slice_stack(contour, hyperplanes, {2, [&](double fraction) { return !is_within(fraction); }});
  });
}

TEST(PeriodicCuts, CutsBesideAnAxisWithRoundingOfTheFrameAreNotModulo) {
  auto image = torus_image<3>({12, 16, 10}, [](const auto& x) { return waves_from<3>(x, 0, 0.0); });
  const AxisPeriods<3> periods = {1.0, 0.0, 0.0};
  const auto straight = slice(wrapped<double>(image, periods, 0.05), Hyperplane<3>::across(1, 0.31));
  image.grid.linear[1][0] = 6e-17;
  const auto contour = wrapped<double>(image, periods, 0.05);
  const auto cut = slice(contour, Hyperplane<3>::across(1, 0.31));
  EXPECT_GT(straight.simplices.size(), 10u);
  EXPECT_EQ(cut.simplices.size(), straight.simplices.size());
  EXPECT_NEAR(measure(cut).size, measure(straight).size, 1e-9);
  EXPECT_TRUE(slice(contour, Hyperplane<3>::across(1, 7.31)).simplices.empty());
  EXPECT_NEAR(measure(slice(contour, Hyperplane<3>::across(0, 1.25))).size,
              measure(slice(contour, Hyperplane<3>::across(0, 0.25))).size, 1e-9);
  image.grid.linear[1][0] = 0.002;
  const auto oblique = wrapped<double>(image, periods, 0.05);
  for (const int axis : {0, 1}) {
    EXPECT_FALSE(cuts_wrapped<3>(oblique.periods, Hyperplane<3>::across(axis, 0.31)));
    EXPECT_THROW((void)slice(oblique, Hyperplane<3>::across(axis, 0.31)), Error);
  }
}

TEST(PeriodicCuts, ManyMeasuredCutsAreThoseOfSlices) {
  const auto image = torus_image<4>({8, 6, 10, 8}, [](const auto& x) { return waves_from<4>(x, 0, 0.0); });
  for (const unsigned axes : {15u, 8u, 7u}) {
    SCOPED_TRACE(axes);
    const auto contour = wrapped<float>(image, periodic_along<4>(axes), 0.05);
    std::vector<double> places;  // in no order, and some of them equal modulo the period
    for (int i = 0; i < 700; ++i) places.push_back(std::fmod(i * 0.618033988749, 1.0));
    places.insert(places.end(), {0.0, 0.25, 1.25, 0.25, -3.0, 7.0});
    const std::vector<CutMeasures> found = measure_cuts(contour, places, {1, {}});
    ASSERT_EQ(found.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_EQ(found[i].at, places[i]);
      if (i % 13 != 0 && i < 700) continue;
      const auto expected = measure(slice(contour, Hyperplane<4>::across(3, places[i])));
      EXPECT_EQ(found[i].size, expected.size) << places[i];
      EXPECT_EQ(found[i].content, expected.content) << places[i];
    }
    for (const std::size_t count : {places.size(), std::size_t{2}}) {  // with more threads than cuts, too
      const auto others = measure_cuts(contour, std::span(places).first(count), {3, {}});
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(others[i].size, found[i].size);
        EXPECT_EQ(others[i].content, found[i].content);
      }
    }
    EXPECT_TRUE(measure_cuts(contour, {}).empty());
    double last = 0.0;
    std::size_t reports = 0;
    (void)measure_cuts(contour, places, {1, [&](double done) {
                                           EXPECT_GE(done, last);
                                           EXPECT_LT(done - last, 0.2);
                                           last = done;
                                           return ++reports > 0;
                                         }});
    EXPECT_EQ(last, 1.0);
    EXPECT_GT(reports, 100u);
    expect_error(ErrorCode::Cancelled, "cancelled", [&] {
      (void)measure_cuts(contour, places, {2, [](double done) { return done < 0.5; }});
    });
  }
}

TEST(PeriodicCuts, MeasuredCutsAcrossAnObliquePeriodAreMadeOnceForAllPlacesModuloIt) {
  const auto image = cell_image<3>({12, 12, 12}, {{{1, 0, 0}, {0, 1, 0}, {0.3, 0, 1}}}, waves_of_cell);
  const auto contour = wrapped<double>(image, all_periodic<3>(), 0.4);
  ASSERT_FALSE(cut_period<3>(contour.periods, unit_vector<3>(2))->is_straight);
  std::vector<double> places;  // over so many periods that the moved simplices would not fit into memory
  for (int i = 0; i < 1000; ++i)
    for (const double first : {0.25, 0.625}) places.push_back(first + 100'000.0 * (i - 500));
  std::vector<std::size_t> uses;
  detail::for_each_cut<3, double>(contour, places, {1, {}},
                                  [&](std::span<const std::size_t> of_cut, const Contour<2, double>& cut, unsigned) {
                                    uses.push_back(of_cut.size());
                                    EXPECT_TRUE(is_closed(check(cut)));
                                  });
  EXPECT_EQ(uses, (std::vector<std::size_t>{1000, 1000}));
  const std::vector<CutMeasures> found = measure_cuts(contour, places);
  const std::array<Measures<2>, 2> slices = {measure(slice(contour, Hyperplane<3>::across(2, 0.25))),
                                             measure(slice(contour, Hyperplane<3>::across(2, 0.625)))};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Measures<2>& expected = slices[i % 2];
    EXPECT_EQ(found[i].at, places[i]);
    EXPECT_EQ(found[i].size, found[i % 2].size);
    EXPECT_EQ(found[i].content, found[i % 2].content);
    EXPECT_EQ(found[i].size, expected.size);
    EXPECT_EQ(found[i].content, expected.content);
  }
  EXPECT_NE(found[0].size, found[1].size);
  // also where a slice would be an error
  EXPECT_EQ(measure_cuts(contour, {0.25 + 0x1p40})[0].size, found[0].size);
  // some periods further, the slice is the same one, moved
  EXPECT_NEAR(measure(slice(contour, Hyperplane<3>::across(2, 7.25))).size, found[0].size, 1e-9);
}

TEST(PeriodicCuts, CoordinatesFarFromTheirPeriodAreErrors) {
  const auto contour = wrapped<double>(
      torus_image<3>({12, 16, 10}, [](const auto& x) { return waves_from<3>(x, 0, 0.0); }), all_periodic<3>(), 0.05);
  for (const double far : {1e12, -1e12, 1e300}) {
    auto hostile = contour;
    hostile.vertices[contour.simplices[7][1]][2] = far;
    const std::string message =
        "vertex " + std::to_string(contour.simplices[7][1]) + " has the coordinate " + fmt::format("{}", far) +
        " along axis 2, with the period 1 from 0; expected at most 536870912 periods from there";
    expect_error(ErrorCode::InvalidArgument, message, [&] { (void)slice(hostile, Hyperplane<3>::across(2, 0.3)); });
    expect_error(ErrorCode::InvalidArgument, message, [&] { (void)measure_cuts(hostile, {0.3, 0.4}); });
    EXPECT_GT(slice(hostile, Hyperplane<3>::across(0, 0.3)).simplices.size(), 10u);  // across another axis
  }
  // with a wrong dual vector, neighbours would be apart
  auto other = contour;
  other.periods[2].dual = {1e9, 1e9, 1.0};
  EXPECT_THROW((void)slice(other, Hyperplane<3>::across(2, 0.3)), Error);
  // a start far from 0 is sound
  auto far = contour;
  constexpr double kStart = 1LL << 33;
  for (auto& vertex : far.vertices) vertex[2] += kStart;
  far.periods[2].start += kStart;
  const auto cut = slice(far, Hyperplane<3>::across(2, kStart + 5.25));
  EXPECT_TRUE(is_closed(check(cut)));
  EXPECT_NEAR(measure(cut).size, measure(slice(contour, Hyperplane<3>::across(2, 0.25))).size, 1e-3);
}

TEST(PeriodicCuts, CutsAcrossAPeriodKeepAttributesAndNormals) {
  ExtractOptions options;
  options.normals = Normals::differences;
  auto contour = wrapped<double>(torus_image<3>({12, 16, 10}, [](const auto& x) { return waves_from<3>(x, 0, 0.0); }),
                                 all_periodic<3>(), 0.0, options);
  Attribute& of_vertices = contour.vertex_attributes.emplace_back(Attribute{"y", "", 1, {}});
  for (const auto& x : contour.vertices) of_vertices.values.push_back(std::cos(kTurn * x[1]));
  Attribute& of_simplices = contour.simplex_attributes.emplace_back(Attribute{"number", "", 1, {}});
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) of_simplices.values.push_back(static_cast<double>(s));
  const auto cut = slice(contour, Hyperplane<3>::across(0, 0.99));  // in the last layer, beside the seam
  ASSERT_GT(cut.simplices.size(), 10u);
  ASSERT_EQ(cut.normals.size(), cut.vertices.size());
  ASSERT_EQ(cut.vertex_attributes[0].values.size(), cut.vertices.size());
  for (std::size_t v = 0; v < cut.vertices.size(); ++v)
    EXPECT_NEAR(cut.vertex_attributes[0].values[v], std::cos(kTurn * cut.vertices[v][0]), 0.05);
  ASSERT_EQ(cut.simplex_attributes[0].values.size(), cut.simplices.size());
  for (const double s : cut.simplex_attributes[0].values) {
    double least = 1.0;
    for (const Index v : contour.simplices[static_cast<std::size_t>(s)])
      least = std::min(least, std::abs(0.99 - contour.vertices[v][0]));
    EXPECT_LT(least, 0.1);
  }
}

template <int N>
std::array<double, N> gradient_of_waves(const std::array<double, N>& x) {
  std::array<double, N> gradient{};
  for (int a = 0; a < N; ++a) gradient[a] = (0.5 + 0.1 * a) * kTurn * std::cos(kTurn * x[a] + a);
  const double oblique = 0.4 * kTurn * std::sin(kTurn * (x[0] - x[N - 1]));
  gradient[0] -= oblique;
  gradient[N - 1] += oblique;
  return gradient;
}

TEST(PeriodicCuts, NormalsOfCutsAcrossAPeriodHaveTheDirectionOfTheGradientWithinTheHyperplane) {
  const auto test = []<int N>(const std::array<std::size_t, N>& sizes, double least) {
    const auto image = torus_image<N>(sizes, [](const std::array<double, N>& x) { return waves_from<N>(x, 0, 0.0); });
    for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
      ExtractOptions options;
      options.normals = Normals::differences;
      options.direction = direction;
      const auto contour = wrapped<double>(image, all_periodic<N>(), 0.05, options);
      const double sign = direction == GradientDirection::descent ? -1.0 : 1.0;
      for (int axis = 0; axis < N; ++axis)
        for (const double at : {0.0, 0.31, 0.99, 1.995, -7.003}) {
          SCOPED_TRACE(testing::Message() << "axis " << axis << ", " << at);
          const auto cut = slice(contour, Hyperplane<N>::across(axis, at));
          ASSERT_EQ(cut.normals.size(), cut.vertices.size());
          std::size_t compared = 0;
          for (std::size_t v = 0; v < cut.vertices.size(); ++v) {
            std::array<double, N> x;
            for (int a = 0, in_cut = 0; a < N; ++a) x[a] = a == axis ? at : cut.vertices[v][in_cut++];
            const auto gradient = gradient_of_waves<N>(x);
            double inner = 0.0, length = 0.0, unit = 0.0;
            for (int a = 0, in_cut = 0; a < N; ++a) {
              if (a == axis) continue;
              const double normal = cut.normals[v][in_cut++];
              inner += sign * normal * gradient[a];
              length += gradient[a] * gradient[a];
              unit += normal * normal;
            }
            EXPECT_NEAR(unit, 1.0, 1e-6);
            if (length < 1.0) continue;  // beside points at which the contour touches the hyperplane
            EXPECT_GT(inner / std::sqrt(length), least);
            ++compared;
          }
          EXPECT_GT(compared, cut.vertices.size() / 2);
        }
    }
  };
  test.template operator()<3>({40, 48, 36}, 0.998);
  test.template operator()<4>({20, 18, 22, 16}, 0.985);
}

TEST(PeriodicCuts, CutsOfCurvedGridsAcrossAPeriodDoNotDependOnTheFirstColumn) {
  // the columns are oblique and bent: cells of the last one reach far over the longitudes of the first one
  constexpr int kColumns = 36, kRows = 12, kLayers = 6;
  const auto stored_from = [](int first) {
    OwnedImage<double, 3> image;
    image.grid = Grid<3>::unit({kColumns, kRows, kLayers});
    std::vector<CurvedAxis> curved = {{0, 3, {}, "lon", "degrees_east"}, {1, 3, {}, "lat", "degrees_north"}};
    for (int k = 0; k < kLayers; ++k)
      for (int j = 0; j < kRows; ++j)
        for (int i = first; i < first + kColumns; ++i) {
          const double lon = 10.0 * i + 4.0 * j + 3.0 * std::sin(0.9 * j);
          const double lat = -60.0 + 10.0 * j + 2.0 * std::sin(kTurn * i / kColumns);
          const double turn = lon * kTurn / 360.0;
          image.values.push_back(std::sin(turn + 0.3) + 0.5 * std::cos(3.0 * turn) + 0.02 * lat - 0.3 * k + 0.6);
          if (k > 0) continue;
          curved[0].values.push_back(lon);
          curved[1].values.push_back(lat);
        }
    const std::vector<int> axes = {0};
    const auto seams = find_seams<3>(image.grid, curved, axes);
    return extract_curved<double>(image.view(), curved, 0.0, {}, seams);
  };
  const auto contour = stored_from(0), other = stored_from(13);
  for (double at = 1.0; at < 360.0; at += 19.0) {
    const auto cut = slice(contour, Hyperplane<3>::across(0, at));
    const auto expected = slice(other, Hyperplane<3>::across(0, at));
    EXPECT_EQ(check(cut).bad_links, 0u);
    EXPECT_TRUE(cut.periods.empty());
    EXPECT_EQ(check(cut).boundary_simplices, check(expected).boundary_simplices) << at;
    EXPECT_EQ(check(cut).components, check(expected).components) << at;
    EXPECT_NEAR(measure(cut).size, measure(expected).size, 1e-9) << at;
    EXPECT_GT(measure(cut).size, 1.0);
    EXPECT_NEAR(measure(slice(contour, Hyperplane<3>::across(0, at - 720.0))).size, measure(cut).size, 1e-9);
  }
}

}  // namespace
}  // namespace tegl::test
