// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of hand-made simplices and of contours from the slow simplicial contour, so that `slice` is tested
// independently of the extraction.
#include "tegl/slice.hpp"

#include <cmath>
#include <limits>

#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "simplicial_contour.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace {

using test::expect_closed_manifold;
using test::last_axis_layer;
using test::Point;
using test::same_surface;
using test::simplicial_contour;

/// Noise with a low border, so that its contour is closed.
template <Value T, int N>
OwnedImage<T, N> bordered_noise(std::size_t samples, std::uint64_t seed) {
  OwnedImage<T, N> image = test::noise<T, N>(samples, seed);
  test::for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    for (int a = 0; a < N; ++a)
      if (index[a] == 0 || index[a] + 1 == samples) image.values[i] = std::numeric_limits<T>::lowest();
  });
  return image;
}

Contour<4, double> one_tetrahedron(const std::array<double, 4>& t) {
  Contour<4, double> contour;
  contour.vertices = {{0, 0, 0, t[0]}, {1, 0, 0, t[1]}, {0, 1, 0, t[2]}, {0, 0, 1, t[3]}};
  contour.simplices = {{0, 1, 2, 3}};
  return contour;
}

/// A vector in 4-space on the positive side of a tetrahedron.
Eigen::Vector4d positive_normal(const Contour<4, double>& contour) {
  const auto edges = test::edge_vectors(contour, 0);
  Eigen::Vector4d normal;
  for (int a = 0; a < 4; ++a) {
    Eigen::Matrix4d frame;
    frame.leftCols<3>() = edges;
    frame.col(3) = Eigen::Vector4d::Unit(a);
    normal[a] = frame.determinant();
  }
  return normal;
}

TEST(Slice, OfATetrahedronIsATriangleOrAQuadrilateral) {
  EXPECT_EQ(slice(one_tetrahedron({0, 0, 0, 1}), Hyperplane<4>::across(3, 0.5)).simplices.size(), 1u);
  EXPECT_EQ(slice(one_tetrahedron({0, 0, 1, 1}), Hyperplane<4>::across(3, 0.5)).simplices.size(), 2u);
  EXPECT_EQ(slice(one_tetrahedron({0, 0, 1, 1}), Hyperplane<4>::across(3, 0.5)).vertices.size(), 4u);
  EXPECT_EQ(slice(one_tetrahedron({0, 1, 1, 1}), Hyperplane<4>::across(3, 0.5)).simplices.size(), 1u);
  EXPECT_EQ(slice(one_tetrahedron({0, 0, 1, 1}), Hyperplane<4>::across(3, 1.5)).simplices.size(), 0u);
  EXPECT_EQ(slice(one_tetrahedron({0, 0, 1, 1}), Hyperplane<4>::across(3, -0.5)).simplices.size(), 0u);
}

TEST(Slice, KeepsTheSideThatTheContourFaces) {
  // For every pattern of heights in every vertex order, the triangle's normal agrees with the tetrahedron's.
  for (unsigned pattern = 1; pattern < 15; ++pattern) {
    std::array<Index, 4> order{0, 1, 2, 3};
    do {
      std::array<double, 4> t;
      for (int j = 0; j < 4; ++j) t[j] = ((pattern >> j) & 1u ? 1.0 : 0.0) + 0.1 * j;
      Contour<4, double> contour = one_tetrahedron(t);
      contour.simplices[0] = order;
      const Eigen::Vector4d normal = positive_normal(contour);
      const Contour<3, double> cut = slice(contour, Hyperplane<4>::across(3, 0.7));
      ASSERT_GT(cut.simplices.size(), 0u);
      EXPECT_EQ(test::share_facing(cut,
                                   [&](const Point<3>&) {
                                     return Point<3>{normal[0], normal[1], normal[2]};
                                   }),
                1.0)
          << pattern;
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Slice, AVertexOnTheHyperplaneIsItsOwnPoint) {
  // Two vertices on each side, one of the upper ones on the hyperplane: the quadrilateral becomes a triangle with that
  // vertex.
  const Contour<3, double> cut = slice(one_tetrahedron({0, 0, 0.5, 1}), Hyperplane<4>::across(3, 0.5));
  ASSERT_EQ(cut.simplices.size(), 1u);
  EXPECT_EQ(cut.vertices.size(), 3u);
  EXPECT_EQ(std::count(cut.vertices.begin(), cut.vertices.end(), (std::array<double, 3>{0, 1, 0})), 1);
  // One vertex on the hyperplane, the others below: the triangle collapses.
  EXPECT_EQ(slice(one_tetrahedron({0, 0, 0, 0.5}), Hyperplane<4>::across(3, 0.5)).simplices.size(), 0u);
  EXPECT_EQ(slice(one_tetrahedron({0, 0, 0, 0.5}), Hyperplane<4>::across(3, 0.5)).vertices.size(), 0u);
  // Two vertices on the hyperplane: a segment, dropped.
  EXPECT_EQ(slice(one_tetrahedron({0, 0, 0.5, 0.5}), Hyperplane<4>::across(3, 0.5)).simplices.size(), 0u);
  // A face on the hyperplane: kept if its simplex is below, and, for a face on the contour's boundary, also if it is
  // above.
  EXPECT_EQ(slice(one_tetrahedron({0, 0.5, 0.5, 0.5}), Hyperplane<4>::across(3, 0.5)).simplices.size(), 1u);
  EXPECT_EQ(slice(one_tetrahedron({1, 0.5, 0.5, 0.5}), Hyperplane<4>::across(3, 0.5)).simplices.size(), 1u);
  // All vertices on the hyperplane: no simplex is below or above.
  EXPECT_EQ(slice(one_tetrahedron({0.5, 0.5, 0.5, 0.5}), Hyperplane<4>::across(3, 0.5)).simplices.size(), 0u);
}

TEST(Slice, AFaceBetweenTwoTetrahedraIsCutOnce) {
  Contour<4, double> contour = one_tetrahedron({0, 0.5, 0.5, 0.5});
  contour.vertices.push_back({1, 1, 1, 1});
  contour.simplices.push_back({4, 1, 3, 2});
  const Contour<3, double> cut = slice(contour, Hyperplane<4>::across(3, 0.5));
  EXPECT_EQ(cut.simplices.size(), 1u);
  EXPECT_EQ(cut.vertices.size(), 3u);
}

TEST(Slice, OfTheSimplicialContourAtATimeStepEqualsTheContourOfThatStep) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto owned = test::noise<float, 4>(6, seed);
    const auto image = owned.view();
    const auto whole = simplicial_contour(image, 0.5);
    for (std::size_t k = 0; k < 6; ++k) {
      const auto cut = slice(whole, Hyperplane<4>::across(3, static_cast<double>(k)));
      EXPECT_TRUE(same_surface(cut, simplicial_contour(last_axis_layer(image, k), 0.5)))
          << "seed " << seed << " k " << k;
    }
  }
}

TEST(Slice, OfASurfaceAtALayerEqualsTheContourOfThatLayer) {
  const auto owned = test::noise<double, 3>(12, 4);
  const auto image = owned.view();
  const auto whole = simplicial_contour<double>(image, 0.5);
  for (std::size_t k = 0; k < 12; ++k)
    EXPECT_TRUE(same_surface(slice(whole, Hyperplane<3>::across(2, static_cast<double>(k))),
                             simplicial_contour<double>(last_axis_layer(image, k), 0.5)))
        << k;
}

TEST(Slice, OfAClosedContourIsAClosedManifoldAtAnyTime) {
  const auto owned = bordered_noise<std::uint8_t, 4>(7, 5);
  const auto whole = simplicial_contour(owned.view(), 127.5);
  EXPECT_EQ(check(whole).boundary_simplices, 0u);
  std::mt19937_64 bits(6);
  std::size_t not_empty = 0;
  for (int i = 0; i < 200; ++i) {
    const auto cut = slice(whole, Hyperplane<4>::across(3, 6.0 * test::unit_random(bits)));
    expect_closed_manifold(cut);
    not_empty += !cut.simplices.empty();
  }
  EXPECT_GT(not_empty, 150u);  // the others are outside the contour's range, at the low ends of the axis
}

TEST(Slice, StaysAManifoldWhereSamplesEqualTheIsovalue) {
  // Many vertices lie on the hyperplane between layers, and many coincide.
  for (const std::uint64_t levels : {2u, 3u, 5u, 50u}) {
    auto owned = test::coarse_noise<std::uint8_t, 4>(Grid<4>::unit({7, 7, 7, 7}), levels, levels);
    test::for_each_sample<4>(owned.grid, [&](std::size_t i, const std::array<std::size_t, 4>& index) {
      for (const std::size_t x : index)
        if (x == 0 || x == 6) owned.values[i] = 0;
    });
    const auto whole = simplicial_contour(owned.view(), std::floor(static_cast<double>(levels) / 2));
    for (double t = 0.0; t <= 6.0; t += 0.125) expect_closed_manifold(slice(whole, Hyperplane<4>::across(3, t)));
  }
}

TEST(Slice, OfASurfaceStaysAManifoldWhereSamplesEqualTheIsovalue) {
  auto owned = test::coarse_noise<std::uint8_t, 3>(Grid<3>::unit({9, 9, 9}), 3, 3);
  test::for_each_sample<3>(owned.grid, [&](std::size_t i, const std::array<std::size_t, 3>& index) {
    for (const std::size_t x : index)
      if (x == 0 || x == 8) owned.values[i] = 0;
  });
  const auto whole = simplicial_contour(owned.view(), 1.0);
  for (double z = 0.0; z <= 8.0; z += 0.125) expect_closed_manifold(slice(whole, Hyperplane<3>::across(2, z)));
}

TEST(Slice, OfAClosedSurfaceIsClosedCurvesAtAnyHeight) {
  const auto owned = bordered_noise<std::int16_t, 3>(10, 7);
  const auto whole = simplicial_contour(owned.view(), -0.5);
  std::mt19937_64 bits(8);
  for (int i = 0; i < 200; ++i)
    expect_closed_manifold(slice(whole, Hyperplane<3>::across(2, 9.0 * test::unit_random(bits))));
}

TEST(Slice, OfABallIsABallThatFacesOutwards) {
  // The slice of the 4-ball at t is the ball of radius sqrt(r^2 - t^2).
  const test::Ball<4> ball{{}, 0.8};
  const auto owned = test::sample_field<double>(test::centred_grid<4>(17, 1.0), ball);
  const auto whole = simplicial_contour<double>(owned.view(), 0.0);
  for (const double t : {-0.53, -0.2, 0.0, 0.31, 0.6}) {
    const auto cut = slice(whole, Hyperplane<4>::across(3, t));
    const auto report = expect_closed_manifold(cut);
    EXPECT_EQ(report.euler, 2);
    EXPECT_EQ(test::share_facing(cut, [](const Point<3>& x) { return x; }), 1.0);
    const test::Ball<3> expected{{}, std::sqrt(0.64 - t * t)};
    EXPECT_NEAR(test::enclosed_content(cut), expected.content(), 0.06);
    EXPECT_NEAR(test::measure(cut), expected.surface(), 0.15);
  }
}

TEST(Slice, OfASphereIsACircleThatFacesOutwards) {
  const auto owned = test::sample_field<double>(test::centred_grid<3>(21, 1.0), test::Ball<3>{{}, 0.8});
  const auto cut = slice(simplicial_contour<double>(owned.view(), 0.0), Hyperplane<3>::across(2, 0.33));
  const test::Ball<2> expected{{}, std::sqrt(0.64 - 0.33 * 0.33)};
  EXPECT_EQ(expect_closed_manifold(cut).components, 1u);
  EXPECT_EQ(test::share_facing(cut, [](const Point<2>& x) { return x; }), 1.0);
  EXPECT_NEAR(test::enclosed_content(cut), expected.content(), 0.02);
}

TEST(Slice, AscentStaysAscent) {
  const auto owned = test::sample_field<double>(test::centred_grid<4>(9, 1.0), test::Ball<4>{{}, 0.8});
  auto whole = simplicial_contour<double>(owned.view(), 0.0);
  for (auto& simplex : whole.simplices) std::swap(simplex[0], simplex[1]);
  whole.direction = GradientDirection::ascent;
  whole.axis_names = {"x", "y", "z", "t"};
  whole.axis_units = {"mm", "mm", "mm", "s"};
  const auto cut = slice(whole, Hyperplane<4>::across(3, 0.1));
  EXPECT_EQ(cut.direction, GradientDirection::ascent);
  EXPECT_GT(test::enclosed_content(cut), 0.0);
  EXPECT_EQ(test::share_facing(cut, [](const Point<3>& x) { return x; }), 0.0);
  EXPECT_EQ(cut.axis_names, (std::array<std::string, 3>{"x", "y", "z"}));
  EXPECT_EQ(cut.axis_units, (std::array<std::string, 3>{"mm", "mm", "mm"}));
}

TEST(Slice, MergingBallsChangeEulerCharacteristicFrom4To2) {
  const test::MergingBalls<4> balls{0.5, 1.0, 1.0};  // they touch at t = 0.5
  Grid<4> grid = test::centred_grid<4>(25, 1.75);
  grid.axes[1] = grid.axes[2] = Axis::uniform(13, -0.9, 0.15);
  grid.axes[3] = Axis::uniform(11, 0.0, 0.1);
  const auto owned = test::sample_field<float>(grid, balls);
  const auto whole = simplicial_contour(owned.view(), 0.0);
  const auto at = [&](double t) { return expect_closed_manifold(slice(whole, Hyperplane<4>::across(3, t))); };
  EXPECT_EQ(at(balls.event() - 0.13).euler, 4);
  EXPECT_EQ(at(balls.event() - 0.13).components, 2u);
  EXPECT_EQ(at(balls.event() + 0.13).euler, 2);
  EXPECT_EQ(at(balls.event() + 0.13).components, 1u);
}

TEST(Slice, SimplicesInAnyOrderGiveTheSameSurface) {
  const auto owned = test::noise<float, 4>(5, 9);
  const auto whole = simplicial_contour(owned.view(), 0.5);
  auto shuffled = whole;
  std::mt19937_64 bits(10);
  std::vector<Index> place(whole.vertices.size());
  for (Index v = 0; v < place.size(); ++v) place[v] = v;
  std::shuffle(place.begin(), place.end(), bits);
  for (std::size_t v = 0; v < place.size(); ++v) shuffled.vertices[place[v]] = whole.vertices[v];
  for (auto& simplex : shuffled.simplices) {
    for (Index& v : simplex) v = place[v];
    std::swap(simplex[0], simplex[3]);
    std::swap(simplex[1], simplex[2]);
  }
  std::shuffle(shuffled.simplices.begin(), shuffled.simplices.end(), bits);
  for (const double t : {0.0, 0.4, 1.0, 2.77, 4.0})
    EXPECT_TRUE(same_surface(slice(whole, Hyperplane<4>::across(3, t)), slice(shuffled, Hyperplane<4>::across(3, t))))
        << t;
}

TEST(Slice, IsEmptyOutsideOfTheContour) {
  const auto owned = test::noise<float, 4>(4, 11);
  const auto whole = simplicial_contour(owned.view(), 0.5);
  for (const double t : {-1.0, 3.5, 1e300, -1e300})
    EXPECT_TRUE(slice(whole, Hyperplane<4>::across(3, t)).vertices.empty());
  EXPECT_TRUE(slice(Contour<4, float>{}, Hyperplane<4>::across(3, 1.0)).simplices.empty());
}

TEST(Slice, RefusesAHyperplaneThatIsNotFinite) {
  for (const double t : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    try {
      slice(Contour<4, float>{}, Hyperplane<4>::across(3, t));
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find("expected a finite coordinate"), std::string::npos);
    }
  }
}

TEST(Slice, MeetsVerticesAtCoordinatesThatFloatsRound) {
  Grid<4> grid = Grid<4>::unit({5, 5, 5, 5});
  grid.axes[3] = Axis::uniform(5, 0.1, 0.1);  // 0.1, 0.2, 0.30000000000000004 …: none is a float
  const auto owned = test::noise<float, 4>(grid, 12);
  const auto whole = simplicial_contour(owned.view(), 0.5);
  for (std::size_t k = 0; k < 5; ++k)
    EXPECT_TRUE(same_surface(slice(whole, Hyperplane<4>::across(3, grid.axes[3][k])),
                             simplicial_contour(last_axis_layer(owned.view(), k), 0.5)));
}

TEST(Slice, ShowsALayerWhoseLayerBelowIsMissing) {
  auto owned = test::noise<float, 4>(5, 13);
  for (std::size_t i = 125; i < 250; ++i) owned.values[i] = std::numeric_limits<float>::quiet_NaN();  // t = 1
  const auto whole = simplicial_contour(owned.view(), 0.5);
  const auto third = simplicial_contour(last_axis_layer(owned.view(), 2), 0.5);
  EXPECT_GT(third.simplices.size(), 0u);
  EXPECT_TRUE(same_surface(slice(whole, Hyperplane<4>::across(3, 2.0)), third));
  EXPECT_TRUE(slice(whole, Hyperplane<4>::across(3, 1.5)).simplices.empty());
}

}  // namespace
}  // namespace tegl
