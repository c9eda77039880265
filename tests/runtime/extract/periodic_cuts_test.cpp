// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of wrapped contours across a period, at places modulo the period (tegl/slice.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

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

TEST(PeriodicCuts, PlacesAreModuloAPeriodAlongTheAxis) {
  const auto along = [](const std::vector<Vector<3>>& vectors, int axis) { return period_along<3>(vectors, axis); };
  const std::optional<std::size_t> none, first = 0, second = 1;
  EXPECT_EQ(along({{2, 0, 0}}, 0), first);
  EXPECT_EQ(along({{2, 0, 0}}, 1), none);
  EXPECT_EQ(along({}, 1), none);
  for (const double rounding : {6e-17, -1e-8}) {
    EXPECT_EQ(along({{2, rounding, 0}}, 0), first);
    EXPECT_EQ(along({{2, rounding, 0}}, 1), none);
  }
  // oblique, and oblique by a multiple of another period
  EXPECT_EQ(along({{2, 0.003, 0}}, 0), none);
  EXPECT_EQ(along({{2, 0.003, 0}}, 1), none);
  EXPECT_EQ(along({{1, 0, 0}, {0.5, 0.8, 0}}, 1), second);
  EXPECT_EQ(along({{0.5, 0.8, 0}, {1, 0, 0}}, 1), first);
  EXPECT_EQ(along({{1, 0, 0}, {0.5, 0.8, 0}}, 0), none);
  EXPECT_EQ(along({{1, 0, 0}, {0.5, 0.8, 0.1}}, 1), none);
  EXPECT_EQ(along({{1, 0, 1}, {0, 1, 1}, {0.5, 0.5, 3}}, 2), none);
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
  // the period's dual vector does not matter
  auto other = contour;
  other.periods[2].dual = {1e9, 1e9, 1.0};
  EXPECT_EQ(slice(other, Hyperplane<3>::across(2, 0.3)).vertices,
            slice(contour, Hyperplane<3>::across(2, 0.3)).vertices);
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
