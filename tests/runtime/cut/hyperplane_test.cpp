// SPDX-License-Identifier: BSD-3-Clause
//
// Slices by arbitrary hyperplanes: frames, slices across any axis against slices across the last and contours of
// layers, oblique slices against analytic ones, closedness in all degenerate positions, attributes, and stacks.
#include "tegl/hyperplane.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "simplicial_contour.hpp"
#include "tegl/eigen.hpp"
#include "tegl/error.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using test::expect_closed_manifold;
using test::layer_across;
using test::Point;
using test::same_surface;

/// A vector for arithmetic.
template <int N>
using Column = Eigen::Matrix<double, N, 1>;

template <class Normal>
auto hyperplane_of(const Eigen::MatrixBase<Normal>& normal, double offset) {
  return Hyperplane<Normal::SizeAtCompileTime>{to_vector(normal), offset};
}

template <int N>
Column<N> random_normal(std::mt19937_64& bits) {
  Column<N> normal;
  do {
    for (double& x : normal) x = 2.0 * test::unit_random(bits) - 1.0;
  } while (normal.norm() > 1.0 || normal.norm() < 0.1);
  return normal;
}

/// Values 0 … levels - 1 with a low border. The contour at the middle level is closed, and many of its vertices
/// coincide.
template <int N>
OwnedImage<std::uint8_t, N> bordered_noise(std::size_t samples, std::uint64_t levels, std::uint64_t seed) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  auto image = test::coarse_noise<std::uint8_t, N>(Grid<N>::unit(sizes), seed, levels);
  test::for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    for (const std::size_t x : index)
      if (x == 0 || x + 1 == samples) image.values[i] = 0;
  });
  return image;
}

template <int N, class Real>
bool same_bytes(const Contour<N, Real>& a, const Contour<N, Real>& b) {
  const auto same_attributes = [](const std::vector<Attribute>& one, const std::vector<Attribute>& other) {
    return std::equal(one.begin(), one.end(), other.begin(), other.end(), [](const Attribute& x, const Attribute& y) {
      return x.name == y.name && x.unit == y.unit && x.width == y.width && x.values == y.values;
    });
  };
  return a.vertices == b.vertices && a.simplices == b.simplices && a.normals == b.normals &&
         a.axis_names == b.axis_names && a.axis_units == b.axis_units && a.direction == b.direction &&
         same_attributes(a.vertex_attributes, b.vertex_attributes) &&
         same_attributes(a.simplex_attributes, b.simplex_attributes);
}

template <int N>
void expect_frame(const Hyperplane<N>& hyperplane) {
  const HyperplaneFrame<N> frame = frame_of(hyperplane);
  const Column<N> normal = as_eigen(hyperplane.normal);
  Eigen::Matrix<double, N, N> all;
  all << as_eigen(frame.axes).transpose(), as_eigen(frame.up);
  EXPECT_LT((all.transpose() * all - Eigen::Matrix<double, N, N>::Identity()).norm(), 1e-14) << normal;
  EXPECT_NEAR(all.determinant(), frame.is_right_handed ? 1.0 : -1.0, 1e-14) << normal;
  EXPECT_NEAR(normal.normalized().dot(as_eigen(frame.up)), 1.0, 1e-14);
  EXPECT_NEAR(normal.dot(as_eigen(frame.origin)), hyperplane.offset, 1e-13);
  const Column<N - 1> y = Column<N - 1>::LinSpaced(-1.0, 2.0);
  const Vector<N> x = frame.to_space(to_vector(y));
  const Vector<N - 1> again = frame.to_plane(x);
  EXPECT_LT((as_eigen(again) - y).norm(), 1e-13);
  EXPECT_NEAR(normal.dot(as_eigen(x)), hyperplane.offset, 1e-13);
}

TEST(HyperplaneFrame, IsOrthonormalAndKnowsItsHandedness) {
  std::mt19937_64 bits(1);
  for (int i = 0; i < 500; ++i) {
    expect_frame(hyperplane_of(random_normal<2>(bits), 0.3));
    expect_frame(hyperplane_of(random_normal<3>(bits), -0.7));
    expect_frame(hyperplane_of(random_normal<4>(bits), 1.7));
  }
  for (int axis = 0; axis < 4; ++axis)
    for (const double length : {1.0, -1.0, 3.0, -0.1}) expect_frame(hyperplane_of(length * Column<4>::Unit(axis), 0.4));
  expect_frame(hyperplane_of(Column<4>::Ones(), 1.0));
  expect_frame(hyperplane_of(-Column<4>::Ones(), 1.0));
}

TEST(HyperplaneFrame, AcrossAnAxisIsTheOtherAxes) {
  for (int axis = 0; axis < 4; ++axis) {
    const auto frame = frame_of(Hyperplane<4>::across(axis, 2.5));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(frame.axes[i], unit_vector<4>(i < axis ? i : i + 1));
    EXPECT_EQ(frame.origin, to_vector(2.5 * Column<4>::Unit(axis)));
    EXPECT_EQ(frame.dropped, axis);
  }
}

TEST(HyperplaneFrame, ChangesLittleWithTheNormal) {
  const auto before = frame_of(Hyperplane<4>{{0.1, -0.2, 0.3, 0.9}, 0.0});
  const auto after = frame_of(Hyperplane<4>{{0.1001, -0.2, 0.3, 0.9}, 0.0});
  EXPECT_LT((as_eigen(before.axes) - as_eigen(after.axes)).norm(), 3e-4);
}

TEST(HyperplaneFrame, NormalsOfAnyLengthWillDo) {
  for (const double length : {1e-300, 1e-160, 1e160, 1e300}) {
    const auto frame = frame_of(Hyperplane<3>{{length, 2 * length, 2 * length}, 3 * length});
    EXPECT_NEAR(frame.up[0], 1.0 / 3.0, 1e-15);
    EXPECT_NEAR(as_eigen(frame.origin).norm(), 1.0, 1e-14);
  }
}

TEST(HyperplaneFrame, RefusesNormalsAndOffsetsThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const Hyperplane<3>& hyperplane, const std::string& part) {
    try {
      (void)frame_of(hyperplane);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused({{0, 0, 0}, 1}, "normal of a hyperplane that is 0 or not finite");
  refused({{0, nan, 1}, 1}, "normal of a hyperplane that is 0 or not finite");
  refused({{0, 1, 1}, nan}, "expected a finite coordinate");
}

TEST(SliceByHyperplane, AcrossTheLastAxisIsTheSameBitByBit) {
  const auto image = test::noise<float, 4>(6, 2);
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto whole = extract(image.view(), 0.5, options);
  std::mt19937_64 bits(3);
  for (int i = 0; i < 40; ++i) {
    const double t = i < 6 ? i : 5.0 * test::unit_random(bits);
    EXPECT_TRUE(same_bytes(slice(whole, Hyperplane<4>::across(3, t)), slice(whole, Hyperplane<4>{{0, 0, 0, 4}, 4 * t})))
        << t;
  }
}

/// The contour with coordinates permuted by `axes` and its orientation preserved.
Contour<4, double> permuted(const Contour<4, double>& contour, const std::array<int, 4>& axes, bool is_odd) {
  Contour<4, double> result = contour;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v)
    for (int a = 0; a < 4; ++a) result.vertices[v][a] = contour.vertices[v][axes[a]];
  for (int a = 0; a < 4; ++a) result.axis_names[a] = contour.axis_names[axes[a]];
  if (is_odd)
    for (auto& simplex : result.simplices) std::swap(simplex[0], simplex[1]);
  return result;
}

TEST(SliceByHyperplane, AcrossAnAxisIsTheCutOfTheContourWithThatAxisLast) {
  auto image = test::noise<float, 4>(5, 4);
  const std::array<const char*, 4> names = {"x", "y", "z", "t"};
  for (int a = 0; a < 4; ++a) image.grid.axes[a].name = names[a];
  const auto whole = extract<double>(image.view(), 0.5);
  const std::array<std::array<int, 4>, 4> orders = {{{1, 2, 3, 0}, {0, 2, 3, 1}, {0, 1, 3, 2}, {0, 1, 2, 3}}};
  for (int axis = 0; axis < 4; ++axis) {
    const auto turned = permuted(whole, orders[axis], (3 - axis) % 2 == 1);
    for (const double at : {0.0, 0.3, 1.0, 2.71, 4.0}) {
      const auto cut = slice(whole, Hyperplane<4>::across(axis, at));
      EXPECT_TRUE(same_surface(cut, slice(turned, Hyperplane<4>::across(3, at)))) << axis << " " << at;
      EXPECT_EQ(cut.axis_names, slice(turned, Hyperplane<4>::across(3, at)).axis_names);
      EXPECT_FALSE(cut.simplices.empty());
    }
  }
}

TEST(SliceByHyperplane, AtASampleOfAnyAxisIsTheContourOfThatLayer) {
  const auto image = test::noise<float, 4>(5, 5);
  for (const bool barycentric : {false, true}) {
    ExtractOptions options;
    if (barycentric) options.triangulation = Triangulation::barycentric;
    const auto whole = extract(image.view(), 0.5, options);
    for (int axis = 0; axis < 4; ++axis)
      for (std::size_t i = 0; i < 5; ++i)
        EXPECT_TRUE(same_surface(slice(whole, Hyperplane<4>::across(axis, static_cast<double>(i))),
                                 extract(layer_across(image.view(), axis, i), 0.5, options)))
            << axis << " " << i;
  }
}

TEST(SliceByHyperplane, TheOtherSideAboveGivesTheSameSurface) {
  const auto image = test::noise<double, 4>(5, 6);
  const auto whole = extract<double>(image.view(), 0.5);
  const auto cut = slice(whole, Hyperplane<4>{{1, 2, -3, 4}, 5.1});
  const auto other = slice(whole, Hyperplane<4>{{-1, -2, 3, -4}, -5.1});
  EXPECT_NEAR(test::measure(cut), test::measure(other), 1e-9);
  EXPECT_NEAR(test::enclosed_content(cut), test::enclosed_content(other), 1e-9);
  EXPECT_EQ(cut.simplices.size(), other.simplices.size());
}

TEST(SliceByHyperplane, NormalsOfAnyLengthGiveTheSameCut) {
  const auto image = test::noise<double, 4>(5, 6);
  const auto whole = extract<double>(image.view(), 0.5);
  for (const auto& [normal, offset] :
       {Hyperplane<4>{{1, 2, -3, 4}, 2.25}, Hyperplane<4>{{0, 0, -2, 0}, -2.75}, Hyperplane<4>{{1, 1, 0, 0}, 2.25}}) {
    const auto cut = slice(whole, Hyperplane<4>{normal, offset});
    ASSERT_FALSE(cut.simplices.empty());
    for (const int exponent : {-1030, -1000, -1, 1000, 1021}) {  // at the last exponent sums would overflow
      const Hyperplane<4> hyperplane =
          hyperplane_of(as_eigen(normal) * std::ldexp(1.0, exponent), std::ldexp(offset, exponent));
      EXPECT_TRUE(same_bytes(slice(whole, hyperplane), cut)) << exponent;
      const Scrubber<4, double> scrubber(whole, hyperplane);
      EXPECT_TRUE(same_bytes(scrubber.cut(hyperplane.offset), cut)) << exponent;
    }
    for (const double length : {1e-300, 1e300}) {
      const auto other = slice(whole, hyperplane_of(as_eigen(normal) * length, offset * length));
      EXPECT_EQ(other.simplices.size(), cut.simplices.size()) << length;
      EXPECT_NEAR(test::measure(other), test::measure(cut), 1e-9) << length;
    }
  }
}

TEST(SliceByHyperplane, BeyondAllNumbersIsEmpty) {
  const auto whole = extract<float>(view_of(test::noise<float, 4>(4, 6)), 0.5);
  EXPECT_TRUE(slice(whole, Hyperplane<4>{{1e-300, 0, 1e-300, 0}, 1e300}).simplices.empty());
  EXPECT_TRUE(slice(whole, Hyperplane<4>::across(1, -1e300)).simplices.empty());
  EXPECT_TRUE(slice(whole, Hyperplane<4>{{0, 1e-300, 0, 0}, 1e300}).simplices.empty());
}

template <int N, class Real>
void expect_closed_cuts(std::uint64_t levels, std::uint64_t seed) {
  const auto image = bordered_noise<N>(N == 4 ? 6 : 9, levels, seed);
  const auto whole = extract<Real>(image.view(), levels == 200 ? 99.5 : std::floor(static_cast<double>(levels) / 2));
  std::mt19937_64 bits(seed);
  std::size_t not_empty = 0;
  for (int i = 0; i < 60; ++i) {
    Hyperplane<N> hyperplane = hyperplane_of(random_normal<N>(bits), 0.0);
    // Normals of small integers, so that many vertices lie on the hyperplanes.
    if (i % 2 == 0)
      for (double& x : hyperplane.normal) x = std::round(2.4 * x);
    if (hyperplane.normal == Vector<N>{}) continue;
    const auto& through = whole.vertices[test::random_below(bits, whole.vertices.size())];
    double sum = 0.0;
    for (int a = 0; a < N; ++a) sum += hyperplane.normal[a] * static_cast<double>(through[a]);
    hyperplane.offset = sum;
    const auto cut = slice(whole, hyperplane);
    expect_closed_manifold(cut);
    not_empty += !cut.simplices.empty();
  }
  EXPECT_GT(not_empty, 40u);
}

TEST(SliceByHyperplane, ThroughVerticesIsAClosedManifoldWhereTheContourIs) {
  for (const std::uint64_t levels : {2u, 3u, 200u}) {
    expect_closed_cuts<4, float>(levels, levels);
    expect_closed_cuts<4, double>(levels, levels + 1);
    expect_closed_cuts<3, float>(levels, levels);
    expect_closed_cuts<3, double>(levels, levels + 1);
  }
}

TEST(SliceByHyperplane, OfABallIsABallThatFacesOutwards) {
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto image = test::sample_field<double>(test::centred_grid<4>(25, 1.0), test::Ball<4>{{}, 0.8});
  auto whole = extract<double>(image.view(), 0.0, options);
  std::mt19937_64 bits(7);
  for (int i = 0; i < 12; ++i) {
    const Column<4> normal = random_normal<4>(bits);
    const double distance = 0.6 * test::unit_random(bits);
    const auto cut = slice(whole, hyperplane_of(normal, distance * normal.norm()));
    const auto report = expect_closed_manifold(cut);
    EXPECT_EQ(report.euler, 2);
    EXPECT_EQ(report.components, 1u);
    // The sphere's centre is the origin of the frame.
    EXPECT_GT(test::share_facing(cut, [](const Point<3>& y) { return y; }), 0.999);
    const test::Ball<3> expected{{}, std::sqrt(0.64 - distance * distance)};
    EXPECT_NEAR(test::enclosed_content(cut), expected.content(), 0.03);
    EXPECT_NEAR(test::measure(cut), expected.surface(), 0.05);
    for (std::size_t v = 0; v < cut.vertices.size(); ++v) {
      const Eigen::Map<const Eigen::Vector3d> y(cut.vertices[v].data());
      const Eigen::Map<const Eigen::Vector3d> n(cut.normals[v].data());
      ASSERT_GT(n.dot(y.normalized()), 0.98);
    }
  }
}

TEST(SliceByHyperplane, OfASphereIsACircleThatFacesOutwards) {
  const auto image = test::sample_field<double>(test::centred_grid<3>(31, 1.0), test::Ball<3>{{}, 0.8});
  const auto whole = extract<double>(image.view(), 0.0);
  std::mt19937_64 bits(8);
  for (int i = 0; i < 12; ++i) {
    const Column<3> normal = random_normal<3>(bits);
    const auto cut = slice(whole, hyperplane_of(normal, 0.33 * normal.norm()));
    EXPECT_EQ(expect_closed_manifold(cut).components, 1u);
    EXPECT_EQ(test::share_facing(cut, [](const Point<2>& y) { return y; }), 1.0);
    EXPECT_NEAR(test::measure(cut), (test::Ball<2>{{}, std::sqrt(0.64 - 0.33 * 0.33)}.surface()), 0.02);
  }
}

/// Adds an affine function of the position, and the simplex number, as attributes.
void add_attributes(Contour<4, double>& contour) {
  Attribute& affine = contour.vertex_attributes.emplace_back(Attribute{"affine", "K", 2, {}});
  for (const auto& x : contour.vertices) {
    affine.values.push_back(x[0] + 2 * x[1] - x[2] + 0.5 * x[3] + 3);
    affine.values.push_back(x[3]);
  }
  Attribute& number = contour.simplex_attributes.emplace_back(Attribute{"number", "", 1, {}});
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) number.values.push_back(static_cast<double>(s));
}

TEST(SliceByHyperplane, InterpolatesAttributesOfVerticesAndInheritsThoseOfSimplices) {
  const auto image = test::noise<double, 4>(5, 9);
  auto whole = extract<double>(image.view(), 0.5);
  add_attributes(whole);
  std::mt19937_64 bits(10);
  for (int i = 0; i < 10; ++i) {
    Hyperplane<4> hyperplane{i < 4 ? unit_vector<4>(i) : to_vector(random_normal<4>(bits)), 2.0};
    if (i == 4) hyperplane = {{1, 1, 0, 0}, 4.0};
    if (i > 4) hyperplane.offset = 2.0 * as_eigen(hyperplane.normal).sum() + 0.1;
    const auto frame = frame_of(hyperplane);
    const auto cut = slice(whole, hyperplane);
    ASSERT_FALSE(cut.simplices.empty());
    ASSERT_EQ(cut.vertex_attributes.size(), 1u);
    ASSERT_EQ(cut.simplex_attributes.size(), 1u);
    EXPECT_EQ(cut.vertex_attributes[0].unit, "K");
    const auto space = [&](std::size_t v) { return frame.to_space(cut.vertices[v]); };
    for (std::size_t v = 0; v < cut.vertices.size(); ++v) {
      const Vector<4> x = space(v);
      ASSERT_NEAR(cut.vertex_attributes[0].values[2 * v], as_eigen(x).dot(Column<4>(1, 2, -1, 0.5)) + 3, 1e-12);
      ASSERT_NEAR(cut.vertex_attributes[0].values[2 * v + 1], x[3], 1e-12);
    }
    for (std::size_t s = 0; s < cut.simplices.size(); ++s) {
      const auto& simplex = whole.simplices[static_cast<std::size_t>(cut.simplex_attributes[0].values[s])];
      for (const Index v : cut.simplices[s])
        for (int a = 0; a < 4; ++a) {
          const auto [low, high] = std::minmax({whole.vertices[simplex[0]][a], whole.vertices[simplex[1]][a],
                                                whole.vertices[simplex[2]][a], whole.vertices[simplex[3]][a]});
          ASSERT_GE(space(v)[a], low - 1e-12);
          ASSERT_LE(space(v)[a], high + 1e-12);
        }
    }
  }
}

TEST(SliceByHyperplane, NamesAxesThatItKeeps) {
  Contour<4, float> contour;
  contour.axis_names = {"x", "y", "z", "t"};
  contour.axis_units = {"mm", "mm", "mm", "s"};
  const auto names = [&](const Vector<4>& normal) { return slice(contour, Hyperplane<4>{normal, 1.0}).axis_names; };
  EXPECT_EQ(names({1, 0, 0, 0}), (std::array<std::string, 3>{"y", "z", "t"}));
  EXPECT_EQ(names({1, 3, 0, 0}), (std::array<std::string, 3>{"", "z", "t"}));
  EXPECT_EQ(names({1, 1, 1, 1}), (std::array<std::string, 3>{"", "", ""}));
  EXPECT_EQ(slice(contour, Hyperplane<4>::across(1, 0.0)).axis_units, (std::array<std::string, 3>{"mm", "mm", "s"}));
}

TEST(SliceStack, IsEachSingleCutBitByBit) {
  const auto image = test::noise<double, 4>(6, 11);
  auto whole = extract<double>(image.view(), 0.5);
  add_attributes(whole);
  std::mt19937_64 bits(12);
  std::vector<Hyperplane<4>> all;
  const auto expect_each = [&](const std::vector<Hyperplane<4>>& hyperplanes, unsigned threads) {
    const auto cuts = slice_stack(whole, hyperplanes, {threads, {}});
    ASSERT_EQ(cuts.size(), hyperplanes.size());
    for (std::size_t i = 0; i < cuts.size(); ++i)
      ASSERT_TRUE(same_bytes(cuts[i], slice(whole, hyperplanes[i]))) << hyperplanes[i].offset;
  };
  for (const Vector<4>& normal : {Vector<4>{0, 0, 0, 1}, Vector<4>{0, 2, 0, 0}, Vector<4>{1, 2, -1, 3}}) {
    std::vector<Hyperplane<4>> hyperplanes;
    for (const double offset : {3.0, 0.0, 2.5, 3.0, -100.0, 5.0, 100.0}) hyperplanes.push_back({normal, offset});
    for (int i = 0; i < 60; ++i) hyperplanes.push_back({normal, 20.0 * test::unit_random(bits) - 3.0});
    for (const unsigned threads : {1u, 3u, 0u}) expect_each(hyperplanes, threads);
    all.insert(all.end(), hyperplanes.begin(), hyperplanes.end());
  }
  std::shuffle(all.begin(), all.end(), bits);  // normals in turn
  expect_each(all, 2);
  EXPECT_TRUE(slice_stack(whole, {}).empty());
}

TEST(SliceStack, TellsItsProgressAndStops) {
  const auto image = test::noise<float, 3>(6, 13);
  const auto whole = extract(image.view(), 0.5);
  const std::vector<Hyperplane<3>> hyperplanes = {Hyperplane<3>::across(2, 0.5), Hyperplane<3>::across(2, 1.5),
                                                  Hyperplane<3>::across(0, 2.5)};
  double last = -1.0;
  (void)slice_stack(whole, hyperplanes, {1, [&](double fraction) {
                                           EXPECT_GE(fraction, last);
                                           last = fraction;
                                           return true;
                                         }});
  EXPECT_EQ(last, 1.0);
  try {
    (void)slice_stack(whole, hyperplanes, {1, [](double fraction) { return fraction < 0.5; }});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

TEST(ScaleAxes, StretchesPointsAndTurnsNormals) {
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto image = test::sample_field<double>(test::centred_grid<3>(25, 1.0), test::Ball<3>{{}, 0.8});
  auto contour = extract<double>(image.view(), 0.0, options);
  const auto before = contour;
  contour = scale_axes(std::move(contour), {1, 2, 10});
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    EXPECT_EQ(contour.vertices[v][2], 10 * before.vertices[v][2]);
    // The normal of the ellipsoid x² + (y/2)² + (z/10)² = r².
    const auto& x = contour.vertices[v];
    const Eigen::Vector3d expected = Eigen::Vector3d(x[0], x[1] / 4, x[2] / 100).normalized();
    ASSERT_LT((Eigen::Map<const Eigen::Vector3d>(contour.normals[v].data()) - expected).norm(), 0.02);
  }
  EXPECT_THROW((void)scale_axes(contour, {1, 0, 1}), Error);
  EXPECT_THROW((void)scale_axes(contour, {1, -1, 1}), Error);
}

/// The maximum difference between components of normals of vertices at equal positions.
template <int N, class Real>
double furthest_normal(const Contour<N, Real>& a, const Contour<N, Real>& b) {
  const auto rows = [](const Contour<N, Real>& contour) {
    std::vector<std::pair<std::array<Real, N>, std::array<Real, N>>> result;
    for (std::size_t v = 0; v < contour.normals.size(); ++v)
      result.emplace_back(contour.vertices[v], contour.normals[v]);
    std::sort(result.begin(), result.end());
    return result;
  };
  const auto first = rows(a);
  const auto second = rows(b);
  if (first.size() != second.size()) return std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (std::size_t v = 0; v < first.size(); ++v)
    for (int i = 0; i < N; ++i)
      most = std::max(most, static_cast<double>(std::abs(first[v].second[i] - second[v].second[i])));
  return most;
}

template <class Real, Value T, int N>
void expect_direct_is_whole(const Image<T, N>& image, double isovalue, const ExtractOptions& options) {
  const auto whole = extract<Real>(image, isovalue, options);
  std::mt19937_64 bits(14);
  for (int axis = 0; axis < N; ++axis)
    for (int i = 0; i < 8; ++i) {
      const auto last = static_cast<double>(image.size(axis) - 1);
      const double at = i < 4 ? std::floor(last * i / 3) : last * test::unit_random(bits);
      const auto direct = slice_image<Real>(image, isovalue, Hyperplane<N>::across(axis, at), options);
      const auto cut = slice(whole, Hyperplane<N>::across(axis, at));
      EXPECT_TRUE(same_surface(direct, cut)) << axis << " " << at;
      EXPECT_EQ(direct.axis_names, cut.axis_names);
      EXPECT_LT(furthest_normal(direct, cut), 1e-5) << axis << " " << at;
    }
}

TEST(SliceImageAcross, IsTheCutOfTheWholeContour) {
  const auto image = test::noise<float, 4>({6, 5, 7, 4}, 15);
  const auto volume = test::noise<std::int16_t, 3>({9, 12, 7}, 16);
  ExtractOptions options;
  expect_direct_is_whole<float>(image.view(), 0.5, options);
  expect_direct_is_whole<double>(volume.view(), -0.5, options);
  options.normals = Normals::differences;
  expect_direct_is_whole<float>(image.view(), 0.5, options);
  expect_direct_is_whole<double>(volume.view(), -0.5, options);
}

TEST(SliceImageAcross, IsClosedAtTheOtherBorders) {
  const auto image = test::noise<float, 4>(6, 17);
  ExtractOptions options;
  options.close = true;
  const auto whole = extract(image.view(), 0.5, options);
  for (int axis = 0; axis < 4; ++axis)
    for (const double at : {0.4, 2.0, 4.9}) {
      const auto direct = slice_image(image.view(), 0.5, Hyperplane<4>::across(axis, at), options);
      expect_closed_manifold(direct);
      EXPECT_TRUE(same_surface(direct, slice(whole, Hyperplane<4>::across(axis, at)))) << axis << " " << at;
    }
}

TEST(HyperplaneAcross, RefusesAxesThatAreNotThere) {
  for (const int axis : {-1, 3}) {
    try {
      (void)Hyperplane<3>::across(axis, 1.0);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("expected 0 to 2"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace tegl
