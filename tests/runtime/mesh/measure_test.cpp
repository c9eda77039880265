// SPDX-License-Identifier: BSD-3-Clause
//
// Measures against analytic fields, with the order of convergence, and against measures of slices.
#include "tegl/measure.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "mesh/piece_terms.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

template <int N, class Field>
Contour<N, double> contour_of(const Field& field, std::size_t samples, double half_width, bool close = false) {
  ExtractOptions options;
  options.close = close;
  return extract<double>(view_of(sample_field<double>(centred_grid<N>(samples, half_width), field)), 0.0, options);
}

/// Errors of size and content at a step and half of it: small, and of second order.
template <int N, class Field>
void expect_second_order(const Field& field, double half_width, std::size_t tiles, double most_error,
                         double exact_content) {
  std::array<double, 2> size_error{};
  std::array<double, 2> content_error{};
  for (const std::size_t fine : {0, 1}) {
    const Measures<N> found = tegl::measure(contour_of<N>(field, (tiles << fine) + 1, half_width));
    ASSERT_TRUE(found.content.has_value());
    EXPECT_EQ(found.boundary_simplices, 0u);
    size_error[fine] = found.size / field.surface() - 1;
    content_error[fine] = *found.content / exact_content - 1;
  }
  EXPECT_LT(std::abs(size_error[1]), most_error) << N << "D";
  EXPECT_LT(std::abs(content_error[1]), most_error) << N << "D";
  EXPECT_NEAR(convergence_order(size_error[0], size_error[1]), 2.0, 0.35) << N << "D";
  EXPECT_NEAR(convergence_order(content_error[0], content_error[1]), 2.0, 0.35) << N << "D";
}

TEST(Measure, OfSpheresConvergesWithTheSquareOfTheStep) {
  expect_second_order<2>(Ball<2>{{0.013, 0.007}, 0.75}, 1.0, 60, 1e-3, Ball<2>{{}, 0.75}.content());
  expect_second_order<3>(Ball<3>{{0.013, 0.007, 0.02}, 0.75}, 1.0, 30, 3e-3, Ball<3>{{}, 0.75}.content());
  expect_second_order<4>(Ball<4>{{0.013, 0.007, 0.02, 0.03}, 0.75}, 1.0, 16, 1e-2, Ball<4>{{}, 0.75}.content());
  expect_second_order<5>(Ball<5>{{0.013, 0.007, 0.02, 0.03, 0.01}, 0.75}, 1.0, 5, 0.15, Ball<5>{{}, 0.75}.content());
}

TEST(Measure, OfToriConvergesWithTheSquareOfTheStep) {
  expect_second_order<3>(RingTube<3>{}, 1.6, 40, 1e-2, RingTube<3>{}.content());
  expect_second_order<4>(RingTube<4>{}, 1.6, 20, 3e-2, RingTube<4>{}.content());
  const TorusTube torus;
  expect_second_order<4>(torus, 1.7, 20, 3e-2, torus.surface() * torus.tube / 2);
}

TEST(Measure, OfNoiseIsThatOfPlainSums) {
  const auto each = [](const auto& contour) {
    constexpr int N = static_cast<int>(std::tuple_size_v<typename std::decay_t<decltype(contour)>::Simplex>);
    const Measures<N> found = tegl::measure(contour);
    EXPECT_NEAR(found.size, test::measure(contour), 1e-9 * found.size);
    EXPECT_NEAR(found.content.value(), enclosed_content(contour), 1e-9 * found.size);
  };
  ExtractOptions closed;
  closed.close = true;
  each(extract<double>(view_of(noise<float, 2>(40, 1)), 0.5, closed));
  each(extract<double>(view_of(noise<float, 3>(12, 2)), 0.5, closed));
  each(extract<double>(view_of(noise<float, 4>(7, 3)), 0.5, closed));
  each(extract<double>(view_of(noise<float, 5>(3, 4)), 0.5, closed));
}

TEST(Measure, DoesNotLoseDigitsFarFromTheOrigin) {
  auto grid = centred_grid<3>(30, 1.0);
  const auto near = sample_field<double>(grid, Ball<3>{{}, 0.75});
  auto far = near;
  for (Axis& axis : far.grid.axes) axis = Axis::uniform(axis.size(), axis.origin() + 1e6, axis.step());
  const Measures<3> expected = tegl::measure(extract<double>(near.view(), 0.0));
  const Measures<3> found = tegl::measure(extract<double>(far.view(), 0.0));
  EXPECT_NEAR(found.size, expected.size, 1e-8);
  EXPECT_NEAR(found.content.value(), expected.content.value(), 1e-8);
  EXPECT_NEAR(found.centroid[0], 1e6 + expected.centroid[0], 1e-8);
}

/// The terms that the vectors of the processor give, against the formula, bit by bit.
template <class Real>
void expect_terms_of_formula(double scale) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-scale, scale);
  Contour<4, Real> contour;
  contour.vertices.resize(40);
  for (auto& vertex : contour.vertices)
    for (Real& x : vertex) x = static_cast<Real>(coordinate(random));
  contour.simplices.resize(101);
  for (auto& simplex : contour.simplices)
    for (Index& v : simplex) v = static_cast<Index>(random() % 40);  // some repeat a vertex: of size 0
  const detail::SimplexView<4> view(contour);
  const std::vector<detail::PointOf<4>> references{view.point(3), view.point(17)};
  std::vector<Index> labels(contour.simplices.size());
  for (Index& label : labels) label = static_cast<Index>(random() % 3);  // 2 has no reference point
  constexpr std::size_t kFrom = 5;
  std::vector<detail::PieceTerms<4>> terms(labels.size() - kFrom);
  detail::find_piece_terms(view, references, labels, kFrom, terms);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (labels[kFrom + i] >= references.size()) continue;
    const auto corners = view.corners(kFrom + i);
    const auto expected =
        detail::piece_terms_of<4>(corners, references[labels[kFrom + i]], detail::normal_vector_of<4>(corners));
    EXPECT_EQ(terms[i].size, expected.size);
    EXPECT_EQ(terms[i].flux, expected.flux);
    EXPECT_EQ(terms[i].moment, expected.moment);
  }
}

TEST(Measure, TermsOfTetrahedraAreThoseOfTheFormula) {
  expect_terms_of_formula<double>(1.0);
  expect_terms_of_formula<float>(100.0);
  expect_terms_of_formula<double>(1e-60);  // squares of volumes underflow
  expect_terms_of_formula<double>(1e60);
}

TEST(Measure, OfAnOpenContourHasNoContent) {
  const Measures<3> found = tegl::measure(contour_of<3>(Ball<3>{{}, 1.2}, 20, 1.0));
  EXPECT_FALSE(found.content.has_value());
  EXPECT_GT(found.boundary_simplices, 0u);
  EXPECT_EQ(found.open_simplices, found.boundary_simplices);
  EXPECT_GT(found.size, 0);
  EXPECT_TRUE(tegl::measure(contour_of<3>(Ball<3>{{}, 1.2}, 20, 1.0, true)).content.has_value());
}

TEST(Measure, FacesThatDoNotCancelLeaveNoContent) {
  auto contour = contour_of<3>(Ball<3>{{}, 0.6}, 10, 1.0);
  std::swap(contour.simplices[0][0], contour.simplices[0][1]);  // reverses one triangle
  const Measures<3> found = tegl::measure(contour);
  EXPECT_FALSE(found.content.has_value());
  EXPECT_EQ(found.boundary_simplices, 0u);
  EXPECT_EQ(found.open_simplices, 3u);
}

TEST(Measure, IsTheSameForAnyNumberOfThreads) {
  const auto contour = extract<float>(view_of(noise<float, 4>(9, 8)), 0.5);
  const std::vector<double> at = {0, 0.5, 1.25, 7.9, 8, 3, 3};
  const Measures<4> one = tegl::measure(contour, {1, {}});
  const std::vector<CutMeasures> cuts = measure_cuts(contour, at, {1, {}});
  for (const unsigned threads : {2u, 3u, 4u}) {
    const Measures<4> many = tegl::measure(contour, {threads, {}});
    EXPECT_EQ(std::memcmp(&one.size, &many.size, sizeof(double)), 0);
    EXPECT_EQ(one.centroid, many.centroid);
    EXPECT_EQ(one.open_simplices, many.open_simplices);
    const std::vector<CutMeasures> others = measure_cuts(contour, at, {threads, {}});
    for (std::size_t i = 0; i < at.size(); ++i) {
      EXPECT_EQ(cuts[i].size, others[i].size);
      EXPECT_EQ(cuts[i].content, others[i].content);
    }
  }
}

TEST(Measure, OfNothingIsZero) {
  const Measures<4> found = tegl::measure(Contour<4, float>{});
  EXPECT_EQ(found.size, 0.0);
  EXPECT_EQ(found.content, 0.0);
  const std::vector<double> at = {1.0};
  EXPECT_EQ(measure_cuts(Contour<4, float>{}, at)[0].size, 0.0);
  EXPECT_EQ(measure_cuts(Contour<4, float>{}, at)[0].content, 0.0);
}

// ---- cuts ----

/// measure_cuts against the slices made by `slice`.
template <int N>
void expect_measures_of_slices(const Contour<N, double>& contour, const std::vector<double>& at) {
  const std::vector<CutMeasures> found = measure_cuts(contour, at);
  ASSERT_EQ(found.size(), at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    SCOPED_TRACE(testing::Message() << N << "D at " << at[i]);
    const Contour<N - 1, double> cut = slice(contour, Hyperplane<N>::across(N - 1, at[i]));
    const double size = test::measure(cut);
    EXPECT_EQ(found[i].at, at[i]);
    EXPECT_NEAR(found[i].size, size, 1e-10 * (1 + size));
    ASSERT_EQ(found[i].content.has_value(), check(cut).boundary_simplices == 0);
    if (found[i].content) {
      EXPECT_NEAR(*found[i].content, enclosed_content(cut), 1e-10 * (1 + size));
    }
  }
}

TEST(MeasureCuts, AreThoseOfSlices) {
  for (const bool close : {false, true}) {
    ExtractOptions options;
    options.close = close;
    // Also at integers: at the first one the limit is from above, at the others from below.
    expect_measures_of_slices<3>(extract<double>(view_of(noise<float, 3>(9, 21)), 0.5, options),
                                 {0.0, 0.1, 1.0, 2.5, 4.999, 7.0, 7.75, 8.0});
    expect_measures_of_slices<4>(extract<double>(view_of(noise<float, 4>(6, 22)), 0.5, options),
                                 {3.2, 0.0, 0.3, 1.0, 2.5, 4.0, 4.75, 5.0});
  }
}

TEST(MeasureCuts, OfASingleContourMeetTheTimesThatDoublesMiss) {
  // 0.1, 0.2 … differ between single and double precision: some floats are larger, some smaller. The contour must not
  // be missed at its own first and last time.
  Grid<4> grid = Grid<4>::unit({6, 6, 6, 8});
  grid.axes[3] = Axis::uniform(8, 0.1, 0.1);
  const auto contour = extract<float>(view_of(noise<float, 4>(grid, 23)), 0.5);
  std::vector<double> at;
  for (std::size_t k = 0; k < 8; ++k) at.push_back(grid.axes[3][k]);
  at.push_back(0.7);
  at.push_back(0.8);
  const std::vector<CutMeasures> found = measure_cuts(contour, at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double size = test::measure(slice(contour, Hyperplane<4>::across(3, at[i])));
    EXPECT_EQ(found[i].at, at[i]);
    EXPECT_GT(size, 1.0);
    EXPECT_NEAR(found[i].size, size, 1e-5 * size) << at[i];
  }
}

TEST(MeasureCuts, AreClosedWhereTheContourIsOpenInTimeAlone) {
  // A ball that exists from the first to the last time: the 4D contour is open at both, its slices are closed.
  const auto contour = contour_of<4>([](const Point<4>& x) { return 0.7 - std::hypot(x[0], x[1], x[2]); }, 12, 1.0);
  EXPECT_FALSE(tegl::measure(contour).content.has_value());
  const std::vector<double> at = {-1.0, -0.3, 0.5, 1.0};
  for (const CutMeasures& cut : measure_cuts(contour, at)) {
    ASSERT_TRUE(cut.content.has_value()) << cut.at;
    EXPECT_NEAR(*cut.content, (Ball<3>{{}, 0.7}).content(), 0.08);
  }
}

TEST(MeasureCuts, AreOpenWhereTheObjectLeavesTheImage) {
  const auto field = [](const Point<4>& x) { return 0.5 - std::hypot(x[0] - x[3], x[1], x[2]); };
  const std::vector<double> at = {0.0, 0.9};
  const std::vector<CutMeasures> found = measure_cuts(contour_of<4>(field, 16, 1.0), at);
  EXPECT_TRUE(found[0].content.has_value());
  EXPECT_FALSE(found[1].content.has_value());
  EXPECT_TRUE(measure_cuts(contour_of<4>(field, 16, 1.0, true), at)[1].content.has_value());
}

TEST(MeasureCuts, OfAnExpandingBallConvergeWithTheSquareOfTheStep) {
  const auto radius = [](double t) { return 0.5 + 0.2 * t + 0.1 * t * t; };
  const auto field = [&](const Point<4>& x) { return radius(x[3]) - std::hypot(x[0], x[1], x[2]); };
  const std::vector<double> at = {-0.83, -0.4, 0.07, 0.31, 0.77};
  std::array<double, 2> size_error{};
  std::array<double, 2> content_error{};
  for (const std::size_t fine : {0, 1}) {
    for (const CutMeasures& cut : measure_cuts(contour_of<4>(field, (std::size_t{16} << fine) + 1, 1.0), at)) {
      const Ball<3> exact{{}, radius(cut.at)};
      size_error[fine] = std::max(size_error[fine], std::abs(cut.size / exact.surface() - 1));
      content_error[fine] = std::max(content_error[fine], std::abs(cut.content.value() / exact.content() - 1));
    }
  }
  EXPECT_LT(size_error[1], 0.015);
  EXPECT_NEAR(convergence_order(size_error[0], size_error[1]), 2.0, 0.5);
  EXPECT_NEAR(convergence_order(content_error[0], content_error[1]), 2.0, 0.5);
}

/// The integral of the slices' contents over the last coordinate in [-1, 1], by Simpson's rule.
template <int N>
double integrated_content(const Contour<N, double>& contour) {
  constexpr std::size_t kSteps = 400;
  std::vector<double> at;
  for (std::size_t i = 0; i <= 2 * kSteps; ++i) at.push_back(-1.0 + static_cast<double>(i) / kSteps);
  const std::vector<CutMeasures> curve = measure_cuts(contour, at);
  double sum = 0;
  for (std::size_t i = 0; i <= 2 * kSteps; ++i)
    sum += curve[i].content.value() * (i == 0 || i == 2 * kSteps ? 1 : i % 2 == 1 ? 4 : 2) / (3.0 * kSteps);
  return sum;
}

TEST(MeasureCuts, IntegratedGiveTheContent) {
  const auto each = [](const auto& contour) {
    const double content = tegl::measure(contour).content.value();
    EXPECT_NEAR(integrated_content(contour), content, 1e-5 * content);
  };
  each(contour_of<3>(Ball<3>{{}, 0.8}, 11, 1.0));
  each(contour_of<4>(Ball<4>{{}, 0.8}, 11, 1.0));
  each(contour_of<5>(Ball<5>{{}, 0.8}, 7, 1.0));
}

TEST(MeasureCuts, ComeInTheOrderAskedForWhateverItIs) {
  const auto contour = contour_of<4>(Ball<4>{{}, 0.8}, 9, 1.0);
  const std::vector<double> at = {0.5, -0.5, 0.5, 3.0, 0.0};
  const std::vector<CutMeasures> found = measure_cuts(contour, at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::vector<double> alone = {at[i]};
    EXPECT_EQ(found[i].at, at[i]);
    EXPECT_EQ(found[i].size, measure_cuts(contour, alone)[0].size);
  }
  EXPECT_EQ(found[3].size, 0.0);
  EXPECT_EQ(found[3].content, 0.0);
  EXPECT_TRUE(measure_cuts(contour, {}).empty());
}

TEST(Measure, WrongArgumentsAreNamedAndItCanBeCancelled) {
  auto contour = contour_of<3>(Ball<3>{{}, 0.6}, 8, 1.0);
  const std::vector<double> bad = {std::numeric_limits<double>::quiet_NaN()};
  expect_error(ErrorCode::InvalidArgument, "a slice at nan", [&] { measure_cuts(contour, bad); });
  const Progress stop = [](double) { return false; };
  const std::vector<double> at = {0.0};
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { tegl::measure(contour, {1, stop}); });
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { measure_cuts(contour, at, {1, stop}); });
  contour.simplices[0][0] = 99999;
  expect_error(ErrorCode::InvalidArgument, "99999", [&] { tegl::measure(contour); });
}

}  // namespace
}  // namespace tegl::test
