// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images with periodic axes: topology on tori of two to four dimensions, the seam, measures, tracks and
// cuts of wrapped contours.
#include "tegl/periodic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "errors.hpp"
#include "tegl/check.hpp"
#include "tegl/components.hpp"
#include "tegl/curved.hpp"
#include "tegl/measure.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"
#include "tegl/track.hpp"
#include "torus.hpp"

namespace tegl::test {
namespace {

template <int N>
double sum_of_cosines(const std::array<double, N>& x) {
  double sum = 0.0;
  for (const double each : x) sum += std::cos(kTurn * each);
  return sum;
}

template <int N>
void expect_closed(const Contour<N, float>& contour) {
  const MeshReport report = check(contour);
  EXPECT_TRUE(is_closed(report));
  EXPECT_GT(contour.simplices.size(), 0u);
  for (const auto& vertex : contour.vertices)
    for (const float x : vertex) {
      EXPECT_GE(x, -1e-6f);
      EXPECT_LE(x, 1.0f);  // 1 if a sample equals the isovalue
    }
}

TEST(Periodic, TheGyroidsCellHasEulerCharacteristicMinusEight) {
  const auto image = torus_image<3>({21, 20, 23}, gyroid);
  const auto contour = wrapped(image, all_periodic<3>(), 0.0);
  expect_closed(contour);
  EXPECT_EQ(check(contour).euler, -8);
  EXPECT_EQ(check(contour).components, 1u);
  // Schwarz's primitive surface
  const auto primitive = torus_image<3>({21, 20, 23}, sum_of_cosines<3>);
  EXPECT_EQ(check(wrapped(primitive, all_periodic<3>(), 0.01)).euler, -4);
}

TEST(Periodic, ContoursOnToriAreClosedWhateverTheTriangulationAndAmbiguity) {
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high, Ambiguity::mean, Ambiguity::saddle}) {
      ExtractOptions options;
      options.triangulation = triangulation;
      options.ambiguity = ambiguity;
      expect_closed(wrapped(torus_image<2>({9, 7}, noise_of<2>(1)), all_periodic<2>(), 0.0, options));
      expect_closed(wrapped(torus_image<3>({7, 5, 6}, noise_of<3>(2)), all_periodic<3>(), 0.0, options));
      expect_closed(wrapped(torus_image<4>({4, 5, 3, 4}, noise_of<4>(3)), all_periodic<4>(), 0.0, options));
    }
}

template <int N>
void expect_shift_changes_nothing(const std::array<std::size_t, N>& sizes) {
  const auto contour = wrapped(torus_image<N>(sizes, noise_of<N>(7)), all_periodic<N>(), 0.0);
  const auto shifted = wrapped(torus_image<N>(sizes, noise_of<N>(7), 1), all_periodic<N>(), 0.0);
  EXPECT_EQ(contour.vertices.size(), shifted.vertices.size());
  EXPECT_EQ(contour.simplices.size(), shifted.simplices.size());
  EXPECT_EQ(check(contour).components, check(shifted).components);
  EXPECT_EQ(check(contour).euler, check(shifted).euler);
  EXPECT_NEAR(measure(contour).size, measure(shifted).size, 1e-5 * measure(contour).size);
}

TEST(Periodic, ShiftedSamplesGiveTheSameContour) {
  expect_shift_changes_nothing<2>({70, 11});
  expect_shift_changes_nothing<3>({5, 7, 6});
  expect_shift_changes_nothing<4>({4, 5, 3, 5});
}

TEST(Periodic, AnySetOfAxesMayBePeriodic) {
  const auto image = torus_image<3>({6, 5, 7}, noise_of<3>(11));
  for (unsigned axes = 1; axes < 8; ++axes) {
    AxisPeriods<3> periods{};
    for (int a = 0; a < 3; ++a) periods[a] = (axes >> a & 1u) != 0 ? 1.0 : 0.0;
    const auto contour = wrapped<double>(image, periods, 0.0);
    EXPECT_EQ(contour.periods.size(), std::size_t(std::popcount(axes)));
    EXPECT_TRUE(is_manifold(check(contour)));
    EXPECT_EQ(is_closed(check(contour)), axes == 7u);
    // the simplices are those of the longer image, and so are their sizes
    const auto unrolled = unroll(contour);
    EXPECT_EQ(unrolled.contour.simplices.size(), contour.simplices.size());
    EXPECT_TRUE(unrolled.contour.periods.empty());
    EXPECT_EQ(unrolled.originals.size(), unrolled.contour.vertices.size());
    EXPECT_NEAR(measure(unrolled.contour).size, measure(contour).size, 1e-9);
    double longest = 0.0;
    for (const auto& simplex : unrolled.contour.simplices)
      for (int a = 0; a < 3; ++a)
        longest = std::max(
            longest, std::abs(unrolled.contour.vertices[simplex[0]][a] - unrolled.contour.vertices[simplex[1]][a]));
    EXPECT_LT(longest, 0.21);
    for (std::size_t s = 0; s < contour.simplices.size(); ++s)
      for (int j = 0; j < 3; ++j)
        EXPECT_EQ(unrolled.originals[unrolled.contour.simplices[s][j]], contour.simplices[s][j]);
  }
}

template <int N>
void expect_manifold_with_missing_values(const std::array<std::size_t, N>& sizes, unsigned seed,
                                         double missing = 0.125) {
  auto image = torus_image<N>(sizes, noise_of<N>(seed));
  std::mt19937 random(seed);
  for (float& value : image.values)
    if (std::uniform_real_distribution<double>()(random) < missing) value = std::numeric_limits<float>::quiet_NaN();
  const auto contour = wrapped(image, all_periodic<N>(), 0.0);
  EXPECT_TRUE(is_manifold(check(contour))) << "seed " << seed;
  EXPECT_GT(contour.simplices.size(), 0u);
  const auto [unrolled, originals] = unroll(contour);
  EXPECT_TRUE(is_manifold(check(unrolled))) << "seed " << seed;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s)
    for (int j = 0; j < N; ++j) EXPECT_EQ(originals[unrolled.simplices[s][j]], contour.simplices[s][j]);
}

TEST(Periodic, AtMissingValuesOnTheSeamTheContourIsAManifold) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    expect_manifold_with_missing_values<2>({7, 6}, seed);
    expect_manifold_with_missing_values<3>({5, 4, 6}, seed);
    expect_manifold_with_missing_values<4>({4, 3, 5, 4}, seed);
  }
  // few missing samples, so that vertices on three or four seams have tiles on some of their sides
  for (unsigned seed = 1; seed <= 60; ++seed)
    for (const double missing : {0.01, 0.03}) {
      expect_manifold_with_missing_values<4>({4, 3, 5, 4}, seed, missing);
      expect_manifold_with_missing_values<4>({4, 4, 4, 4}, seed, missing);
    }
}

TEST(Periodic, SamplesThatEqualTheIsovalueAreMergedByTheirCells) {
  const auto sign = [](const auto& x) { return std::round(sum_of_cosines<3>(x)); };
  const auto image = torus_image<3, std::int8_t>({8, 8, 8}, sign);
  const auto contour = wrapped(image, all_periodic<3>(), 0.0);
  EXPECT_TRUE(is_closed(check(contour)));
  EXPECT_EQ(check(unroll(contour).contour).unused_vertices, 0u);
  const auto shifted = wrapped(torus_image<3, std::int8_t>({8, 8, 8}, sign, 3), all_periodic<3>(), 0.0);
  EXPECT_EQ(check(contour).euler, check(shifted).euler);
}

template <int N>
void expect_closed_at_borders(const std::array<std::size_t, N>& sizes, double missing) {
  auto image = torus_image<N>(sizes, noise_of<N>(13));
  std::mt19937 random(5);
  for (float& value : image.values)
    if (std::uniform_real_distribution<double>()(random) < missing) value = std::numeric_limits<float>::quiet_NaN();
  for (unsigned axes = 1; axes < 1u << N; ++axes)
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high, Ambiguity::mean, Ambiguity::saddle}) {
      SCOPED_TRACE(testing::Message() << N << "D, axes " << axes << ", " << static_cast<int>(ambiguity));
      ExtractOptions options;
      options.close = true;
      options.ambiguity = ambiguity;
      options.normals = Normals::differences;
      const auto contour = wrapped(image, periodic_along<N>(axes), 0.0, options);
      const MeshReport report = check(contour);
      EXPECT_TRUE(missing == 0.0 ? is_closed(report) : is_manifold(report));
      EXPECT_EQ(report.unused_vertices, 0u);
      EXPECT_EQ(contour.normals.size(), contour.vertices.size());
      const ContourSize size = count_periodic(image.view(), periodic_along<N>(axes), 0.0, options);
      EXPECT_EQ(size.vertices, contour.vertices.size());
      EXPECT_EQ(size.simplices, contour.simplices.size());
    }
}

TEST(Periodic, CloseClosesAtTheBordersOfTheOtherAxes) {
  for (const double missing : {0.0, 0.1}) {
    expect_closed_at_borders<2>({7, 66}, missing);
    expect_closed_at_borders<3>({65, 4, 5}, missing);
    expect_closed_at_borders<4>({4, 3, 5, 4}, missing);
  }
  // a tube along x whose ends meet: closed without caps
  const auto tube =
      torus_image<3>({12, 20, 20}, [](const auto& x) { return 0.3 - std::hypot(x[1] - 0.5, x[2] - 0.5); });
  ExtractOptions options;
  options.close = true;
  EXPECT_EQ(wrapped(tube, {1.0, 0.0, 0.0}, 0.0, options).simplices, wrapped(tube, {1.0, 0.0, 0.0}, 0.0).simplices);
}

/// Vertices, moved along all axes by `shift` modulo 1 and rounded, with their normals.
template <int N>
std::map<std::array<std::int64_t, N>, std::array<double, N>> normals_by_place(const Contour<N, double>& contour,
                                                                              const std::array<double, N>& shift) {
  std::map<std::array<std::int64_t, N>, std::array<double, N>> result;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    std::array<std::int64_t, N> place;
    for (int a = 0; a < N; ++a) {
      const double x = contour.vertices[v][a] + shift[a];
      place[a] = std::llround(1e7 * (x - std::floor(x + 1e-9)));
    }
    result[place] = contour.normals[v];
  }
  return result;
}

template <int N>
void expect_shifted_normals(const std::array<std::size_t, N>& sizes, Normals normals) {
  ExtractOptions options;
  options.normals = normals;
  const auto contour = wrapped<double>(torus_image<N>(sizes, noise_of<N>(9)), all_periodic<N>(), 0.0, options);
  const auto shifted = wrapped<double>(torus_image<N>(sizes, noise_of<N>(9), 2), all_periodic<N>(), 0.0, options);
  std::array<double, N> shift;
  for (int a = 0; a < N; ++a) shift[a] = 2.0 / static_cast<double>(sizes[a]);
  const auto expected = normals_by_place<N>(contour, {});
  std::size_t found = 0;
  for (const auto& [place, normal] : normals_by_place<N>(shifted, shift)) {
    const auto at = expected.find(place);
    if (at == expected.end()) continue;  // rounded to another place
    ++found;
    for (int a = 0; a < N; ++a) EXPECT_NEAR(at->second[a], normal[a], 1e-6);
  }
  EXPECT_GT(found, expected.size() * 9 / 10);
}

TEST(Periodic, NormalsUseTheNeighboursAcrossTheSeam) {
  for (const Normals normals : {Normals::differences, Normals::sobel}) {
    expect_shifted_normals<2>({70, 11}, normals);
    expect_shifted_normals<3>({9, 7, 6}, normals);
    expect_shifted_normals<3>({70, 5, 6}, normals);
    expect_shifted_normals<4>({4, 5, 3, 5}, normals);
  }
  // only the last axis: samples are not copied
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto waves = torus_image<3>({40, 40, 40}, gyroid);
  for (const AxisPeriods<3>& periods : {AxisPeriods<3>{0.0, 0.0, 1.0}, AxisPeriods<3>{1.0, 0.0, 1.0}}) {
    const auto contour = wrapped<double>(waves, periods, 0.01, options);
    for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
      const auto& x = contour.vertices[v];
      if (x[0] > 0.02 && x[0] < 0.95 && x[1] > 0.02 && x[1] < 0.95) continue;  // of interest: the seam along z only
      if (periods[0] == 0.0 && (x[0] < 0.03 || x[0] > 0.94)) continue;
      if (x[1] < 0.03 || x[1] > 0.94) continue;
      std::array<double, 3> gradient;
      const auto s = [&](int a) { return std::sin(kTurn * x[a]); };
      const auto c = [&](int a) { return std::cos(kTurn * x[a]); };
      gradient = {c(0) * c(1) - s(2) * s(0), c(1) * c(2) - s(0) * s(1), c(2) * c(0) - s(1) * s(2)};
      const double length =
          std::sqrt(gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2]);
      for (int a = 0; a < 3; ++a) EXPECT_NEAR(contour.normals[v][a], -gradient[a] / length, 0.02);
    }
  }
}

/// In float, rows with many edges get their normals from the gradients of all their samples, in double they do not.
template <int N>
void expect_float_normals(const std::array<std::size_t, N>& sizes) {
  const auto image = torus_image<N>(sizes, noise_of<N>(9));
  ExtractOptions options;
  options.normals = Normals::differences;
  for (unsigned axes = 1; axes < 1u << N; ++axes) {
    SCOPED_TRACE(testing::Message() << N << "D, axes " << axes);
    const auto got = wrapped<float>(image, periodic_along<N>(axes), 0.0, options);
    const auto expected = wrapped<double>(image, periodic_along<N>(axes), 0.0, options);
    ASSERT_EQ(got.normals.size(), expected.normals.size());
    std::array<std::size_t, N> in_last_cells{};
    for (std::size_t v = 0; v < got.normals.size(); ++v)
      for (int a = 0; a < N; ++a) {
        ASSERT_NEAR(got.normals[v][a], expected.normals[v][a], 1e-3) << "vertex " << v;
        if (expected.vertices[v][a] > 1.0 - 0.9 / static_cast<double>(sizes[a])) ++in_last_cells[a];
      }
    for (unsigned a = 0; a < N; ++a) EXPECT_EQ(in_last_cells[a] != 0, (axes >> a & 1u) != 0);
  }
}

TEST(Periodic, NormalsInFloatAreThoseInDouble) {
  // rows with more than 48 edges, which are processed by themselves
  expect_float_normals<2>({130, 11});
  expect_float_normals<3>({130, 5, 6});
  expect_float_normals<4>({130, 4, 3, 5});
  // with the repeated sample, the shortest row whose gradients are computed at once
  expect_float_normals<3>({17, 9, 4});
}

TEST(Periodic, UnevenAxesHaveTheirOwnStepAcrossTheSeam) {
  // a linear field, apart from the seam, has the same gradient everywhere
  OwnedImage<float, 2> image;
  image.grid.axes = {Axis::rectilinear({0.0, 0.1, 0.3, 0.6, 0.7}), Axis::uniform(4, 0.0, 1.0)};
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i) image.values.push_back(static_cast<float>(std::cos(kTurn * image.grid.axes[0][i]) + j));
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto contour = wrapped<double>(image, {1.0, 0.0}, 1.2, options);
  const auto& axis = image.grid.axes[0];
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    if (contour.vertices[v][0] != 0.0) continue;
    // at x = 0 the neighbours are those at 0.1 and at 0.7 - 1
    const double ahead = (std::cos(kTurn * axis[1]) - 1.0) / 0.1, behind = (1.0 - std::cos(kTurn * axis[4])) / 0.3;
    const double slope = 0.5 * (ahead + behind), length = std::hypot(slope, 1.0);
    EXPECT_NEAR(contour.normals[v][0], -slope / length, 1e-5);
    EXPECT_NEAR(contour.normals[v][1], -1.0 / length, 1e-5);
  }
}

/// A tube along x whose samples lie at these places along it.
OwnedImage<float, 3> tube_along(const Axis& along) {
  OwnedImage<float, 3> image;
  image.grid.axes = {along, Axis::uniform(24, 0.0, 1.0), Axis::uniform(24, 0.0, 1.0)};
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (std::size_t i = 0; i < along.size(); ++i)
        image.values.push_back(static_cast<float>(8.0 - std::hypot(j - 11.5, k - 11.5)));
  return image;
}

template <class Real>
void expect_contour_of_one_sample_more(std::vector<double> places, double period) {
  SCOPED_TRACE(testing::PrintToString(places));
  const double first = places.front(), end = first + (places.back() < first ? -period : period);
  const auto contour = wrapped<Real>(tube_along(Axis::rectilinear(places)), {period, 0.0, 0.0}, 0.0);
  places.push_back(end);
  const auto image = tube_along(Axis::rectilinear(places));
  const auto expected = extract<Real>(image.view(), 0.0);
  EXPECT_NEAR(measure(contour).size, measure(expected).size, 1e-5 * measure(expected).size);
  const auto unrolled = unroll(contour).contour;
  EXPECT_NEAR(measure(unrolled).size, measure(expected).size, 1e-5 * measure(expected).size);
  for (const double share : {0.06, 0.34, 0.5, 0.77, 0.97}) {
    const auto at = Hyperplane<3>::across(0, first + share * (end - first));
    const double size = measure(slice(expected, at)).size;
    EXPECT_GT(size, 40.0);
    EXPECT_NEAR(measure(slice(contour, at)).size, size, 1e-5 * size) << share;
    EXPECT_NEAR(measure(slice(unrolled, at)).size, size, 1e-5 * size) << share;
  }
}

TEST(Periodic, StepsOfAlmostHalfAPeriodHaveTheirOwnLength) {
  const std::vector<std::vector<double>> axes = {
      {0.0, 0.4999, 0.7}, {0.0, 0.2, 0.5001}, {3.0, 2.6, 2.4999}, {0.0, 0.1, 0.59, 0.6}, {0.0, 1.0 / 3, 2.0 / 3}};
  for (const auto& places : axes) {
    expect_contour_of_one_sample_more<float>(places, 1.0);
    expect_contour_of_one_sample_more<double>(places, 1.0);
  }
}

TEST(Periodic, StepsOfHalfAPeriodAndMoreAreRefused) {
  const auto refuses = [](const std::string& part, const Axis& axis, double period) {
    const auto image = tube_along(axis);
    const AxisPeriods<3> periods = {period, 0.0, 0.0};
    expect_error(ErrorCode::InvalidArgument, part, [&] { (void)wrapped(image, periods, 0.0); });
    expect_error(ErrorCode::InvalidArgument, part, [&] { (void)count_periodic(image.view(), periods, 0.0); });
  };
  const auto along = [](std::vector<double> places) { return Axis::rectilinear(std::move(places)); };
  refuses(
      "the period of axis 0 (x) is 1.5, and the step from 0.5 to 1.25 is 0.75; expected steps of less than half the",
      along({0.0, 0.125, 0.25, 0.5, 1.25}), 1.5);
  refuses("the step from 9 to 1 is 8; expected", along({10.0, 9.0, 1.0}), 12.0);
  // the last step, across the seam: often a period in another unit
  const Axis radians = Axis::uniform(36, 0.0, kTurn / 36);
  refuses("the period of axis 0 (x) is 360, and the step across the seam, from 6.1", radians, 360.0);
  refuses("or a period in the unit of the axis, such as 6.28319", radians, 360.0);
  refuses("the step across the seam, from 3 to 6, is 3; expected", Axis::uniform(4, 0.0, 1.0), 6.0);
  refuses("the step across the seam, from -3 to -10, is 7; expected", Axis::uniform(4, 0.0, -1.0), 10.0);
  refuses("is 15 (length plus mean step), and the step from 1 to 10 is 9; expected steps of less than half the period",
          Axis::rectilinear({0.0, 1.0, 10.0}), 15.0);
  refuses("is 16, and the step from 1 to 10 is 9", Axis::rectilinear({0.0, 1.0, 10.0}), 16.0);
  const auto last = torus_image<4>({3, 3, 3, 3}, noise_of<4>(1));
  expect_error(ErrorCode::InvalidArgument, "the period of axis 3 (t) is 100, and the step across the seam", [&] {
    (void)wrapped(last, {0.0, 0.0, 0.0, 100.0}, 0.0);
  });
}

/// With all axes periodic there is nothing to close; but vertices at the seam are then found by bits in all layers.
template <int N>
void expect_the_same_closed(const OwnedImage<float, N>& image) {
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high, Ambiguity::mean})
    for (const unsigned threads : {1u, 3u}) {
      ExtractOptions options{.ambiguity = ambiguity};
      options.work.threads = threads;
      const auto open = wrapped(image, all_periodic<N>(), 0.1, options);
      options.close = true;
      const auto closed = wrapped(image, all_periodic<N>(), 0.1, options);
      ASSERT_GT(open.vertices.size(), 20u);
      EXPECT_EQ(open.vertices, closed.vertices);
      EXPECT_EQ(open.simplices, closed.simplices);
    }
}

TEST(Periodic, VerticesAtTheSeamAreTheSameWithAndWithoutBits) {
  const auto expect = [](auto image, std::size_t missing_from) {
    expect_the_same_closed(image);
    for (std::size_t i = missing_from; i < image.values.size(); i += 97)
      image.values[i] = std::numeric_limits<float>::quiet_NaN();
    expect_the_same_closed(image);
  };
  expect(torus_image<2>({66, 31}, noise_of<2>(1)), 1800);
  expect(torus_image<3>({65, 9, 40}, noise_of<3>(2)), 20000);
  expect(torus_image<3>({21, 40, 30}, sum_of_cosines<3>), 20000);
  expect(torus_image<4>({7, 5, 6, 12}, noise_of<4>(3)), 2000);
}

TEST(Periodic, TheBytesDoNotDependOnThreads) {
  const auto image = torus_image<4>({9, 8, 10, 9}, noise_of<4>(5));
  for (const bool with_normals : {false, true}) {
    ExtractOptions one, many;
    one.work.threads = 1;
    many.work.threads = 4;
    if (with_normals) one.normals = many.normals = Normals::differences;
    const auto first = wrapped(image, all_periodic<4>(), 0.1, one);
    const auto second = wrapped(image, all_periodic<4>(), 0.1, many);
    EXPECT_EQ(first.vertices, second.vertices);
    EXPECT_EQ(first.simplices, second.simplices);
    EXPECT_EQ(first.normals, second.normals);
  }
}

/// A ball of radius 0.3 whose centre moves along x over time, so that it crosses the seam; 4 samples of time.
double moving_ball(double x, double y, double z, double t) {
  const double d = std::abs(x - t) - std::round(std::abs(x - t));
  return 0.3 - std::sqrt(d * d + (y - 0.5) * (y - 0.5) + (z - 0.5) * (z - 0.5));
}

TEST(Periodic, ABallAcrossTheSeamHasTheMeasuresOfABall) {
  const auto at = [](double t) {
    return torus_image<3>({40, 40, 40}, [t](const auto& x) { return moving_ball(x[0], x[1], x[2], t); });
  };
  const auto across = wrapped<double>(at(0.0), {1.0, 0.0, 0.0}, 0.0);
  const auto inside = wrapped<double>(at(0.5), {1.0, 0.0, 0.0}, 0.0);
  EXPECT_EQ(check(across).components, 1u);
  EXPECT_EQ(check(across).euler, 2);
  EXPECT_NEAR(measure(across).size, measure(inside).size, 1e-9);
  ASSERT_TRUE(measure(across).content);
  EXPECT_NEAR(*measure(across).content, *measure(inside).content, 1e-9);
  EXPECT_NEAR(*measure(across).content, 4.0 / 3.0 * std::numbers::pi * 0.027, 1e-3);
  const auto parts = components(across, label_components(across));
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(*parts[0].content, *measure(inside).content, 1e-9);
  EXPECT_NEAR(std::remainder(parts[0].centroid[0], 1.0), 0.0, 1e-6);
  EXPECT_NEAR(parts[0].highest[0] - parts[0].lowest[0], 0.6, 1e-2);
}

TEST(Periodic, SizesAndContentsAcrossAllSeamsAreOfOrderTwo) {
  constexpr double kPi = std::numbers::pi, kBall = 0.3, kRing = 0.28, kTube = 0.12;
  const auto wrap = [](const std::array<double, 3>& x) {
    return std::array{x[0] - std::round(x[0]), x[1] - std::round(x[1]), x[2] - std::round(x[2])};
  };
  const auto ball = [&](const std::array<double, 3>& x) {
    const auto [a, b, c] = wrap(x);
    return kBall - std::hypot(a, b, c);
  };
  const auto torus = [&](const std::array<double, 3>& x) {
    const auto [a, b, c] = wrap(x);
    return kTube - std::hypot(std::hypot(a, b) - kRing, c);
  };
  const auto expect_order_two = [](const auto& field, double size, double content, std::ptrdiff_t euler) {
    std::array<std::array<double, 2>, 2> errors;
    for (const std::size_t fine : {0u, 1u}) {
      const std::size_t n = fine != 0 ? 64 : 32;
      const auto contour = wrapped<double>(torus_image<3>({n, n + n / 8, n + n / 4}, field), all_periodic<3>(), 0.0);
      EXPECT_TRUE(is_closed(check(contour)));
      EXPECT_EQ(check(contour).euler, euler);
      errors[fine] = {size - measure(contour).size, content - measure(contour).content.value()};
    }
    for (const std::size_t k : {0u, 1u}) EXPECT_NEAR(errors[0][k] / errors[1][k], 4.0, 1.2) << euler << ", " << k;
  };
  expect_order_two(ball, 4 * kPi * kBall * kBall, 4.0 / 3.0 * kPi * kBall * kBall * kBall, 2);
  expect_order_two(torus, 4 * kPi * kPi * kRing * kTube, 2 * kPi * kPi * kRing * kTube * kTube, 0);
}

TEST(Periodic, AThingThatCrossesTheDateLineIsOneTrack) {
  const auto image =
      torus_image<4>({24, 24, 24, 12}, [](const auto& x) { return moving_ball(x[0], x[1], x[2], 2 * x[3]); });
  const auto contour = wrapped<double>(image, {1.0, 0.0, 0.0, 0.0}, 0.0);
  EXPECT_EQ(check(contour).components, 1u);
  TrackOptions options;
  options.times = {0.2, 0.5, 0.6};
  const TrackGraph graph = track(contour, options);
  EXPECT_EQ(graph.tracks.size(), 1u);
  const auto cut = slice(contour, Hyperplane<4>::across(3, 0.5));
  EXPECT_TRUE(is_closed(check(cut)));
  EXPECT_EQ(check(cut).components, 1u);
  EXPECT_EQ(cut.periods.size(), 1u);
  EXPECT_NEAR(*measure(cut).content, 4.0 / 3.0 * std::numbers::pi * 0.027, 6e-3);
  ASSERT_EQ(graph.segments.size(), 1u);
  ASSERT_EQ(graph.segments[0].samples.size(), 3u);
  EXPECT_NEAR(graph.segments[0].samples[1].measure, measure(cut).size, 1e-9);
  EXPECT_NEAR(graph.segments[0].samples[1].content, *measure(cut).content, 1e-9);
  // with a border instead of the seam there are two
  EXPECT_GT(check(extract(image.view(), 0.0)).components, 1u);
}

TEST(Periodic, ASurfaceAroundThePeriodEnclosesWhatIsAcross) {
  // a tube along x, and a plane that has no inside
  const auto tube =
      torus_image<3>({12, 40, 40}, [](const auto& x) { return 0.3 - std::hypot(x[1] - 0.5, x[2] - 0.5); });
  const auto contour = wrapped<double>(tube, {1.0, 0.0, 0.0}, 0.0);
  EXPECT_TRUE(is_closed(check(contour)));
  EXPECT_EQ(check(contour).euler, 0);
  EXPECT_NEAR(*measure(contour).content, std::numbers::pi * 0.09, 2e-3);
  EXPECT_NEAR(measure(contour).size, kTurn * 0.3, 1e-2);
  const auto plane = torus_image<3>({12, 9, 10}, [](const auto& x) { return 0.45 - x[2]; });
  const auto layer = wrapped<double>(plane, {1.0, 1.0, 0.0}, 0.0);
  EXPECT_TRUE(is_closed(check(layer)));
  EXPECT_NEAR(measure(layer).size, 1.0, 1e-9);
  EXPECT_FALSE(measure(layer).content);
}

/// A ball of a radius around a point of the torus.
double ball_on_torus(const std::array<double, 3>& x, const std::array<double, 3>& middle, double radius) {
  double square = 0.0;
  for (int a = 0; a < 3; ++a) square += std::pow(std::remainder(x[a] - middle[a], 1.0), 2);
  return radius - std::sqrt(square);
}

TEST(Periodic, WithAllAxesPeriodicWhatDoesNotWindRoundEnclosesAContent) {
  constexpr double kRadius = 0.42;  // more than half a period across
  const auto content = [](double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; };
  for (const std::array<double, 3>& middle : {std::array{0.5, 0.5, 0.5}, std::array{0.0, 0.97, 0.3}}) {
    const auto image = torus_image<3>({48, 48, 48}, [&](const auto& x) { return ball_on_torus(x, middle, kRadius); });
    const auto contour = wrapped<double>(image, all_periodic<3>(), 0.0);
    const Measures<3> found = measure(contour);
    ASSERT_TRUE(found.content);
    EXPECT_NEAR(*found.content, content(kRadius), 3e-3);
    const auto parts = components(contour, label_components(contour));
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_NEAR(*parts[0].content, *found.content, 1e-12);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(parts[0].highest[a] - parts[0].lowest[a], 2 * kRadius, 1e-2);
      EXPECT_NEAR(std::remainder(parts[0].centroid[a] - middle[a], 1.0), 0.0, 1e-6);
    }
  }
}

TEST(Periodic, OnlyTheComponentsThatWindRoundAllPeriodsHaveNoContent) {
  // a ball across the seam and a tube along x
  const auto image = torus_image<3>({40, 40, 40}, [](const auto& x) {
    return std::max(ball_on_torus(x, {0.0, 0.0, 0.0}, 0.2), 0.15 - std::hypot(x[1] - 0.5, x[2] - 0.5));
  });
  const auto contour = wrapped<double>(image, all_periodic<3>(), 0.0);
  EXPECT_FALSE(measure(contour).content);
  const auto parts = components(contour, label_components(contour));
  ASSERT_EQ(parts.size(), 2u);
  for (const Component<3>& part : parts) {
    EXPECT_EQ(part.content.has_value(), part.euler == 2);
    if (part.content) {
      EXPECT_NEAR(*part.content, 4.0 / 3.0 * std::numbers::pi * 0.008, 1e-3);
    }
  }
  // two balls, one of them a cavity of the other
  const auto shell = torus_image<3>({40, 40, 40}, [](const auto& x) {
    return std::min(ball_on_torus(x, {0.0, 0.1, 0.9}, 0.4), -ball_on_torus(x, {0.0, 0.1, 0.9}, 0.2));
  });
  EXPECT_NEAR(measure(wrapped<double>(shell, all_periodic<3>(), 0.0)).content.value(),
              4.0 / 3.0 * std::numbers::pi * (0.064 - 0.008), 3e-3);
}

TEST(Periodic, AffineMapsAndDescendingAxesKeepTheTopology) {
  auto image = torus_image<3>({14, 15, 13}, gyroid);
  image.grid.linear = {{{0.0, 0.5, 0.5}, {0.5, 0.0, 0.5}, {0.5, 0.5, 0.0}}};
  image.grid.offset = {3.0, -2.0, 7.0};
  image.grid.axes[1] = Axis::uniform(15, 5.0, -1.0 / 15);
  const auto contour = wrapped(image, all_periodic<3>(), 0.0);
  EXPECT_TRUE(is_closed(check(contour)));
  EXPECT_EQ(check(contour).euler, -8);
  const auto unrolled = unroll(contour).contour;
  EXPECT_NEAR(measure(unrolled).size, measure(contour).size, 1e-5);
  EXPECT_LT(measure(unrolled).size, 3.0);
}

TEST(Periodic, LongitudesAreFoundByTheirUnitAndSpan) {
  Grid<3> grid = Grid<3>::unit({72, 36, 4});
  grid.axes[0] = Axis::uniform(72, -177.5, 5.0);
  grid.axes[1] = Axis::uniform(36, -87.5, 5.0);
  grid.axes[0].unit = "degrees_east";
  grid.axes[1].unit = "degrees_north";
  EXPECT_EQ(longitude_periods(grid), (AxisPeriods<3>{360.0, 0.0, 0.0}));
  EXPECT_EQ(sample_periods(grid, std::array{0, 2}), (AxisPeriods<3>{360.0, 0.0, 4.0}));
  grid.axes[0] = grid.axes[0].part(0, 71);
  EXPECT_EQ(longitude_periods(grid), (AxisPeriods<3>{}));
}

TEST(Periodic, LongitudesHaveAPeriodOf360) {
  Grid<3> grid = Grid<3>::unit({35, 4, 5});
  grid.axes[0] = Axis::uniform(35, 0.0, 10.0);
  EXPECT_EQ(default_periods(grid, std::array{0, 2}), (AxisPeriods<3>{350.0, 0.0, 5.0}));
  for (const char* const unit : {"degrees_east", "degree_E"}) {
    grid.axes[0].unit = unit;
    EXPECT_EQ(default_periods(grid, std::array{0, 2}), (AxisPeriods<3>{360.0, 0.0, 5.0}));
  }
  const auto periods_of = [&](Axis axis) {
    axis.name = "lon";
    axis.unit = "degrees_east";
    grid.axes[0] = std::move(axis);
    return default_periods(grid, std::array{0})[0];
  };
  EXPECT_EQ(periods_of(Axis::rectilinear({350.0, 300.0, 280.0, 160.0, 10.0})), 360.0);
  EXPECT_EQ(periods_of(Axis::uniform(3, -120.0, 120.0)), 360.0);
  const auto refuses = [&](const std::string& part, const Axis& axis) {
    expect_error(ErrorCode::InvalidArgument, part, [&] { (void)periods_of(axis); });
  };
  refuses("axis 0 (lon), of longitudes, is 360, and is not more than 360, the span", Axis::uniform(37, 0.0, 10.0));
  refuses("is not more than 359.999", Axis::uniform(37, 0.0, 359.999 / 36));
  refuses("is not more than 400", Axis::uniform(41, 0.0, -10.0));
  refuses("its samples span 30, and the gap behind them is 330; expected less than 180, or a given period, such as 40",
          Axis::uniform(4, 120.0, 10.0));
  refuses("the gap behind them is 180", Axis::uniform(3, 0.0, 90.0));
  refuses("axis 0 (lon) is 360, and the step from 20 to 215 is 195; expected steps of less than half the period",
          Axis::rectilinear({0.0, 20.0, 215.0, 270.0}));
  Grid<5> in_5d;
  in_5d.axes[0] = Axis::rectilinear({0.0, 20.0, 215.0, 270.0});  // long steps are no error in 5D
  in_5d.axes[0].unit = "degrees_east";
  for (std::size_t a = 1; a < 5; ++a) in_5d.axes[a] = Axis::uniform(3);
  EXPECT_EQ(default_periods<5>(in_5d, std::array{0})[0], 360.0);
  in_5d.axes[0] = Axis::uniform(4, 120.0, 10.0);
  in_5d.axes[0].unit = "degrees_east";
  expect_error(ErrorCode::InvalidArgument, "the gap behind them is 330",
               [&] { (void)default_periods<5>(in_5d, std::array{0}); });
  refuses("has 2 samples", Axis::uniform(2, 0.0, 180.0));
}

TEST(Periodic, BadPeriodsAndOptionsAreRefused) {
  const auto image = torus_image<2>({5, 4}, sum_of_cosines<2>);
  const auto refuses = [&](const std::string& part, const AxisPeriods<2>& periods, const ExtractOptions& options = {}) {
    expect_error(ErrorCode::InvalidArgument, part, [&] { (void)wrapped(image, periods, 0.0, options); });
  };
  refuses("no axis is periodic", {0.0, 0.0});
  refuses("more than 0.8", {0.8, 0.0});
  refuses("is -1; expected a positive number", {-1.0, 0.0});
  refuses("is inf", {std::numeric_limits<double>::infinity(), 0.0});
  ExtractOptions options;
  options.ambiguity = Ambiguity::custom;
  options.estimator.choose = [](const AmbiguousFace&) { return tile::Choice::low; };
  refuses("Ambiguity::custom", {1.0, 0.0}, options);
  const auto contour = wrapped(torus_image<3>({5, 4, 5}, gyroid), all_periodic<3>(), 0.0);
  const Hyperplane<3> oblique{{1.0, std::numbers::phi, 0.0}, 0.5};
  EXPECT_FALSE(cuts_wrapped<3>(contour.periods, oblique));
  EXPECT_TRUE(cuts_wrapped<3>(contour.periods, Hyperplane<3>::across(1, 0.5)));
  expect_error(ErrorCode::InvalidArgument, "across one of its periods", [&] { (void)slice(contour, oblique); });
  expect_error(ErrorCode::InvalidArgument, "across one of its periods", [&] { (void)slice_stack(contour, {oblique}); });
  expect_error(ErrorCode::UnsupportedData, "simplify: a wrapped contour, with 3 periods",
               [&] { (void)simplify(contour, {}); });
  expect_error(ErrorCode::InvalidArgument, "is periodic", [&] { (void)track(contour, {}); });
}

}  // namespace
}  // namespace tegl::test
