// SPDX-License-Identifier: BSD-3-Clause
//
// Slices by Scrubber against `slice`, bit by bit, and its index against a scan of all simplices.
#include "tegl/scrubber.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <type_traits>

#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/error.hpp"
#include "tegl/slice.hpp"
#include "tegl/work.hpp"

namespace tegl {
namespace {

template <int N, class Real>
void expect_same_cut(const Scrubber<N, Real>& scrubber, const Contour<N, Real>& contour,
                     const std::type_identity_t<Vector<N>>& normal, double offset) {
  const auto cut = scrubber.cut(offset);
  const auto expected = slice(contour, Hyperplane<N>{normal, offset});
  ASSERT_TRUE(cut.vertices == expected.vertices && cut.simplices == expected.simplices &&
              cut.normals == expected.normals)
      << offset << ": " << cut.simplices.size() << " simplices; expected " << expected.simplices.size();
}

TEST(Scrubber, CutsAsSliceDoesAtAThousandTimes) {
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto image = test::noise<float, 4>(6, 1);
  const auto contour = extract(image.view(), 0.5, options);
  const Scrubber<4, float> scrubber(contour);
  std::mt19937_64 bits(2);
  for (int i = 0; i < 1000; ++i)
    expect_same_cut(scrubber, contour, unit_vector<4>(3), 5.2 * test::unit_random(bits) - 0.1);
}

TEST(Scrubber, CutsAsSliceDoesAtTheTimesOfAllVertices) {
  const auto image = test::noise<float, 4>(4, 3);
  const auto contour = extract<double>(image.view(), 0.5);
  const Scrubber<4, double> scrubber(contour);
  std::set<double> times;
  for (const auto& vertex : contour.vertices) times.insert(vertex[3]);
  EXPECT_GT(times.size(), 100u);
  for (const double t : times) {
    expect_same_cut(scrubber, contour, unit_vector<4>(3), t);
    expect_same_cut(scrubber, contour, unit_vector<4>(3), std::nextafter(t, 10.0));
    expect_same_cut(scrubber, contour, unit_vector<4>(3), std::nextafter(t, -10.0));
  }
}

TEST(Scrubber, CutsWhereSamplesEqualTheIsovalue) {
  const auto image = test::coarse_noise<std::uint8_t, 4>(Grid<4>::unit({6, 6, 6, 6}), 4, 3);
  const auto contour = extract(image.view(), 1.0);
  const Scrubber<4, float> scrubber(contour);
  for (double t = -0.25; t <= 5.25; t += 0.125) expect_same_cut(scrubber, contour, unit_vector<4>(3), t);
}

TEST(Scrubber, CutsAlongAnyDirectionAndOfSurfaces) {
  const auto image = test::noise<double, 4>(5, 5);
  const auto contour = extract<double>(image.view(), 0.5);
  const auto volume = test::noise<float, 3>(9, 6);
  const auto surface = extract(volume.view(), 0.5);
  std::mt19937_64 bits(7);
  for (const Vector<4>& normal :
       {Vector<4>{1, 0, 0, 0}, Vector<4>{0, 0, -2, 0}, Vector<4>{1, 2, -3, 0.5}, Vector<4>{-1e-9, 0, 1e-9, 0}}) {
    const Scrubber<4, double> scrubber(contour, {normal, 3.0});  // the offset has no effect
    const auto [first, last] = scrubber.range();
    for (int i = 0; i < 40; ++i)
      expect_same_cut(scrubber, contour, normal, first + (last - first) * (1.2 * test::unit_random(bits) - 0.1));
    expect_same_cut(scrubber, contour, normal, first);
    expect_same_cut(scrubber, contour, normal, last);
  }
  const Vector<3> up{0, 1, 1};
  const Scrubber<3, float> scrubber(surface, {up});
  for (double offset = -1.0; offset < 17.0; offset += 0.25) expect_same_cut(scrubber, surface, up, offset);
}

/// Times that floats resolve poorly: steps of an hour in milliseconds since 1970.
TEST(Scrubber, TimesMayBeFarFromZero) {
  Grid<4> grid = Grid<4>::unit({5, 5, 5, 5});
  grid.axes[3] = Axis::uniform(5, 1.7e12, 3.6e6);
  const auto image = test::noise<float, 4>(grid, 8);
  const auto contour = extract<double>(image.view(), 0.5);
  const Scrubber<4, double> scrubber(contour);
  for (double t = -0.5; t < 4.5; t += 0.0625) expect_same_cut(scrubber, contour, unit_vector<4>(3), 1.7e12 + 3.6e6 * t);
}

TEST(Scrubber, FindsTheSimplicesThatTouch) {
  const auto image = test::noise<double, 4>(5, 9);
  const auto contour = extract<double>(image.view(), 0.5);
  const Scrubber<4, double> scrubber(contour);
  for (const double t : {-1.0, 0.0, 0.1, 1.0, 2.7, 3.999999, 4.0, 4.1}) {
    std::vector<Index> expected;
    for (Index s = 0; s < contour.simplices.size(); ++s) {
      const auto below = [&](Index v) { return contour.vertices[v][3] < t; };
      const auto above = [&](Index v) { return contour.vertices[v][3] > t; };
      const auto& simplex = contour.simplices[s];
      if (!std::all_of(simplex.begin(), simplex.end(), below) && !std::all_of(simplex.begin(), simplex.end(), above))
        expected.push_back(s);
    }
    EXPECT_EQ(scrubber.touching(t), expected) << t;
  }
}

TEST(Scrubber, IsTheSameForAnyNumberOfThreads) {
  const auto image = test::noise<float, 4>(8, 10);
  const auto contour = extract(image.view(), 0.5);
  WorkOptions one;
  one.threads = 1;
  WorkOptions four;
  four.threads = 4;
  const Scrubber<4, float> first(contour, {}, one);
  const Scrubber<4, float> second(contour, {}, four);
  EXPECT_EQ(first.memory(), second.memory());
  for (double t = 0.0; t < 7.0; t += 0.3) EXPECT_EQ(first.touching(t), second.touching(t));
  EXPECT_GE(first.memory(), 16 * contour.simplices.size());
  EXPECT_LE(first.memory(), 28 * contour.simplices.size());
}

TEST(Scrubber, OfAnEmptyContourMakesEmptyCuts) {
  const Contour<4, float> contour;
  const Scrubber<4, float> scrubber(contour);
  EXPECT_TRUE(scrubber.cut(0.0).simplices.empty());
  EXPECT_EQ(scrubber.range(), (std::pair<double, double>{0.0, 0.0}));
}

template <class Work>
void expect_error(ErrorCode code, const std::string& part, const Work& work) {
  try {
    work();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Scrubber, RefusesWhatIsNotFiniteAndStopsWhenAsked) {
  Contour<3, double> contour;
  contour.vertices = {{0, 0, 0}, {1, 0, 1}, {0, 1, 1}};
  contour.simplices = {{0, 1, 2}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Scrubber<3, double> scrubber(contour);
  expect_error(ErrorCode::InvalidArgument, "expected a finite coordinate", [&] { (void)scrubber.cut(nan); });
  expect_error(ErrorCode::InvalidArgument, "normal of a hyperplane", [&] {
    const Scrubber<3, double> none(contour, {{0, 0, 0}});
  });
  expect_error(ErrorCode::InvalidArgument, "expected a finite coordinate",
               [&] { const Scrubber<3, double> none(contour, Hyperplane<3>::across(2, nan)); });
  WorkOptions options;
  options.progress = [](double) { return false; };
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { const Scrubber<3, double> none(contour, {}, options); });
  contour.vertices[1][2] = nan;
  expect_error(ErrorCode::InvalidArgument, "a coordinate of vertex 1 is nan",
               [&] { const Scrubber<3, double> none(contour); });
}

}  // namespace
}  // namespace tegl
