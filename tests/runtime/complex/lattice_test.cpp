// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images on staggered lattices: the cells tile space, contours are manifolds, and they converge.
#include "tegl/lattice.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "compare.hpp"
#include "complex/complex_cases.hpp"
#include "complex/lattice_image.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "lattice/lattice_cells.hpp"
#include "tegl/cell_index.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using namespace test;

/// Noise, low near the border of the array.
template <int N>
auto noise(unsigned seed) {
  return [random = std::mt19937(seed)](const auto&, const auto& index, const auto& sizes) mutable {
    const double value = std::uniform_real_distribution<double>()(random);
    for (int a = 0; a < N; ++a)
      if (index[a] < 2 || index[a] + 2 >= sizes[a]) return 0.0;
    return value;
  };
}

template <int N>
void expect_closed_noise(Lattice lattice, std::size_t samples) {
  SCOPED_TRACE(std::string(name_of(lattice)));
  auto image = lattice_image<N>(lattice, samples, noise<N>(3));
  const Complex<N> complex = lattice_complex(image.view(), lattice);
  for (const ExtractOptions& options : fixed_rules()) {
    const auto contour = extract<double>(complex, 0.5, options);
    EXPECT_GT(contour.simplices.size(), 100u);
    expect_closed_manifold(contour);
    EXPECT_GT(measure(contour).content.value(), 0.0);
  }
}

TEST(Lattice, NoiseHasAClosedOrientedManifold) {
  expect_closed_noise<2>(Lattice::triangular, 40);
  expect_closed_noise<3>(Lattice::fcc, 16);
  expect_closed_noise<3>(Lattice::bcc, 14);
  expect_closed_noise<4>(Lattice::d4, 9);
  expect_closed_noise<4>(Lattice::fcc_in_time, 9);
}

template <int N>
void expect_same_by_rows(Lattice lattice, std::size_t samples) {
  SCOPED_TRACE(testing::Message() << name_of(lattice) << " " << samples);
  auto image = lattice_image<N>(lattice, samples, noise_everywhere<N>(7));
  if (samples % 2 == 0) image.grid.linear[0][1] = 0.3;  // a map into the world
  if (samples % 3 == 0) image.grid.linear[0][0] = -1.0;
  const Complex<N> complex = lattice_complex(image.view(), lattice);
  for (ExtractOptions options : fixed_rules()) {
    options.epsilon = options.triangulation == Triangulation::compact ? 0.05 : 0.0;
    const auto expected = extract<double>(complex, 0.5, options);
    const auto extraction = extract_lattice_with_stats<double>(image.view(), lattice, 0.5, options);
    const auto& contour = extraction.contour;
    EXPECT_TRUE(is_oriented_manifold(check(contour)));
    EXPECT_EQ(contour.simplices.size(), expected.simplices.size());
    EXPECT_EQ(extraction.stats.tiles, complex.cell_count());
    auto points = contour.vertices, others = expected.vertices;
    ASSERT_EQ(points.size(), others.size());
    std::sort(points.begin(), points.end());
    std::sort(others.begin(), others.end());
    for (std::size_t v = 0; v < points.size(); ++v)
      for (int axis = 0; axis < N; ++axis) ASSERT_NEAR(points[v][axis], others[v][axis], 1e-12);
    EXPECT_NEAR(measure(contour).size, measure(expected).size, 1e-9);
    EXPECT_EQ(check(contour).euler, check(expected).euler);
    ExtractOptions many = options;
    many.work.threads = 3;
    EXPECT_EQ(extract_lattice<double>(image.view(), lattice, 0.5, many).simplices, contour.simplices);
  }
}

TEST(Lattice, RowsOfBitsGiveTheContourOfTheComplex) {
  for (const std::size_t samples : {2, 3, 9, 64, 67}) expect_same_by_rows<2>(Lattice::triangular, samples);
  for (const std::size_t samples : {2, 3, 8, 9}) {
    expect_same_by_rows<3>(Lattice::fcc, samples);
    expect_same_by_rows<3>(Lattice::bcc, samples);
  }
  // rows of several words
  auto image = lattice_image<3>(Lattice::fcc, 3, noise_everywhere<3>(1));
  image.grid.axes[0] = Axis::uniform(131, 0.0, image.grid.axes[1].step());
  image.values.clear();
  std::mt19937 random(3);
  for (std::size_t i = 0; i < 131 * 3 * image.grid.axes[2].size(); ++i)
    image.values.push_back(std::uniform_real_distribution<double>()(random));
  for (const Lattice lattice : {Lattice::fcc, Lattice::bcc}) {
    const auto contour = extract_lattice<double>(image.view(), lattice, 0.5);
    const auto expected = extract<double>(lattice_complex(image.view(), lattice), 0.5);
    EXPECT_EQ(contour.vertices.size(), expected.vertices.size());
    EXPECT_EQ(contour.simplices.size(), expected.simplices.size());
    EXPECT_TRUE(is_oriented_manifold(check(contour)));
  }
}

template <int N>
void expect_linear_normals(Lattice lattice, std::size_t samples, double missing) {
  SCOPED_TRACE(testing::Message() << name_of(lattice) << ", missing " << missing);
  const double slopes[] = {0.3, -1.1, 0.7, 0.5};
  auto image = lattice_image<N>(lattice, samples, [&](const auto& x, const auto&, const auto&) {
    double sum = 0.05;
    for (int a = 0; a < N; ++a) sum += slopes[a] * x[a];
    return sum;
  });
  std::mt19937 random(4);
  for (double& value : image.values)
    if (std::uniform_real_distribution<double>()(random) < missing) value = std::numeric_limits<double>::quiet_NaN();
  double length = 0.0;
  for (int a = 0; a < N; ++a) length = std::hypot(length, slopes[a]);
  ExtractOptions options;
  options.normals = Normals::differences;
  options.direction = GradientDirection::ascent;
  const auto contour = extract_lattice<double>(image.view(), lattice, 0.0, options);
  EXPECT_GT(contour.vertices.size(), 10u);
  ASSERT_EQ(contour.normals.size(), contour.vertices.size());
  EXPECT_TRUE(is_oriented_manifold(check(contour)));
  for (const auto& normal : contour.normals)
    for (int a = 0; a < N; ++a) EXPECT_NEAR(normal[a], slopes[a] / length, 1e-9);
}

TEST(Lattice, NormalsOfLinearFunctionsAreExact) {
  for (const double missing : {0.0, 0.02}) {
    expect_linear_normals<2>(Lattice::triangular, 14, missing);
    expect_linear_normals<3>(Lattice::fcc, 9, missing);
    expect_linear_normals<3>(Lattice::bcc, 8, missing);
    expect_linear_normals<4>(Lattice::d4, 7, missing);
    expect_linear_normals<4>(Lattice::fcc_in_time, 7, missing);
  }
}

TEST(Lattice, GradientsInTheInsideOfFccAreTheSumOverTwelveNeighbours) {
  auto image = lattice_image<3>(Lattice::fcc, 7, noise_everywhere<3>(2));
  ExtractOptions options;
  options.normals = Normals::differences;
  options.triangulation = Triangulation::compact;
  const double w = image.grid.axes[0].step();
  const auto at = [&](const std::array<std::size_t, 3>& i) { return image.view()(i); };
  const auto x = [&](const std::array<std::size_t, 3>& i) {
    std::array<double, 3> place;
    for (int a = 0; a < 3; ++a) place[a] = image.grid.axes[a][i[a]] + (a < 2 && i[2] % 2 == 1 ? w / 2 : 0.0);
    return place;
  };
  // the isovalue is just below the sample (3, 3, 4): vertices beside it have its gradient
  const std::array<std::size_t, 3> middle{3, 3, 4};
  std::array<double, 3> gradient{};
  std::size_t neighbours = 0;
  for (std::size_t k = 3; k <= 5; ++k)
    for (std::size_t j = 2; j <= 4; ++j)
      for (std::size_t i = 2; i <= 4; ++i) {
        std::array<double, 3> d = x({i, j, k});
        double square = 0.0;
        for (int a = 0; a < 3; ++a) square += std::pow(d[a] -= x(middle)[a], 2);
        if (square < 0.5 * w * w || square > 1.1 * w * w) continue;
        ++neighbours;
        for (int a = 0; a < 3; ++a) gradient[a] += (at({i, j, k}) - at(middle)) * d[a] / (4 * w * w);
      }
  EXPECT_EQ(neighbours, 12u);
  const auto contour = extract_lattice<double>(image.view(), Lattice::fcc, at(middle), options);
  const double length = std::hypot(gradient[0], gradient[1], gradient[2]);
  std::size_t found = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v)
    if (contour.vertices[v] == x(middle)) {
      ++found;
      for (int a = 0; a < 3; ++a) EXPECT_NEAR(contour.normals[v][a], -gradient[a] / length, 1e-9);
    }
  EXPECT_GT(found, 0u);
}

/// Whether a point is inside of a simplex or, for corners in opposite pairs, a cross-polytope.
template <int N>
bool is_inside(const std::vector<std::array<double, N>>& corners, CellType type, const std::array<double, N>& x) {
  using Column = Eigen::Matrix<double, N, 1>;
  const auto column = [](const std::array<double, N>& p) { return Column(p.data()); };
  Eigen::Matrix<double, N, N> m;
  if (type == CellType::octahedron || type == CellType::cell16) {
    Column centre = Column::Zero();
    for (const auto& corner : corners) centre += column(corner) / static_cast<double>(corners.size());
    for (int a = 0; a < N; ++a) {
      EXPECT_LT((column(corners[2 * a]) + column(corners[2 * a + 1]) - 2 * centre).norm(), 1e-9) << "no opposite pair";
      m.col(a) = column(corners[2 * a + 1]) - centre;
    }
    return (m.inverse() * (column(x) - centre)).cwiseAbs().sum() < 1.0;
  }
  for (int a = 0; a < N; ++a) m.col(a) = column(corners[a + 1]) - column(corners[0]);
  const Column shares = m.inverse() * (column(x) - column(corners[0]));
  return shares.minCoeff() > 0.0 && shares.sum() < 1.0;
}

template <int N>
void expect_tiling(Lattice lattice, std::size_t samples, double cells_per_sample) {
  SCOPED_TRACE(std::string(name_of(lattice)));
  auto image = lattice_image<N>(lattice, samples, [](const auto&, const auto&, const auto&) { return 0.0; });
  const Complex<N> complex = lattice_complex(image.view(), lattice);
  std::array<std::size_t, 4> sizes{1, 1, 1, 1};
  double interior = 1.0;
  for (int a = 0; a < N; ++a) {
    sizes[a] = image.grid.axes[a].size();
    interior *= static_cast<double>(sizes[a]);
  }
  const detail::LatticeCells cells = detail::cells_of_lattice(lattice, sizes);
  EXPECT_EQ(cells.types.size(), complex.cell_count());
  EXPECT_LT(static_cast<double>(cells.types.size()), cells_per_sample * interior);
  EXPECT_GT(static_cast<double>(cells.types.size()), 0.5 * cells_per_sample * interior);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-0.4, 0.4);
  for (int trial = 0; trial < 100; ++trial) {
    std::array<double, N> x;
    for (double& coordinate : x) coordinate = anywhere(random);
    int found = 0;
    std::size_t at = 0;
    for (const CellType type : cells.types) {
      std::vector<std::array<double, N>> corners;
      bool is_near = true;
      for (std::size_t i = 0; i < corner_count(type); ++i) {
        corners.push_back(complex.points()[cells.corners[at++]]);
        for (int a = 0; a < N; ++a) is_near = is_near && std::abs(corners.back()[a] - x[a]) < 1.0;
      }
      if (is_near && type != CellType::pyramid && is_inside<N>(corners, type, x)) ++found;
    }
    EXPECT_EQ(found, 1);
  }
}

TEST(Lattice, EveryPointIsInOneCell) {
  expect_tiling<2>(Lattice::triangular, 9, 2);
  expect_tiling<3>(Lattice::fcc, 8, 3);
  expect_tiling<3>(Lattice::bcc, 8, 6);
  expect_tiling<4>(Lattice::d4, 8, 3);
}

TEST(Lattice, TheCellsOfFccHaveThePapersCounts) {
  // Samples with all twelve neighbours: one octahedron and two tetrahedra each. 128 x 128 x 181 and x 244 samples have
  // 2 841 804 and 3 841 992 of them; here the same formula on a small array.
  const std::array<std::size_t, 4> sizes = {7, 8, 9, 1};
  const detail::LatticeCells cells = detail::cells_of_lattice(Lattice::fcc, sizes);
  std::map<CellType, std::size_t> count;
  for (const CellType type : cells.types) ++count[type];
  EXPECT_EQ(count[CellType::octahedron], 6u * 7u * 7u);
  EXPECT_EQ(count[CellType::pyramid], 2u * 6u * 7u);
  EXPECT_EQ(126u * 126u * 179u, 2841804u);
  EXPECT_EQ(126u * 126u * 242u, 3841992u);
}

TEST(Lattice, SpheresAndToriHaveTheirEulerCharacteristic) {
  for (const Lattice lattice : {Lattice::fcc, Lattice::bcc}) {
    auto sphere = lattice_image<3>(lattice, 16, [](const auto& x, const auto&, const auto&) { return ball<3>(x); });
    EXPECT_EQ(2, expect_closed_manifold(extract(lattice_complex(sphere.view(), lattice), 0.0)).euler);
    auto torus = lattice_image<3>(lattice, 24, [](const auto& x, const auto&, const auto&) {
      return 0.22 - std::hypot(std::hypot(x[0] + 0.011, x[1] - 0.013) - 0.55, x[2] + 0.017);
    });
    EXPECT_EQ(0, expect_closed_manifold(extract(lattice_complex(torus.view(), lattice), 0.0)).euler);
  }
}

template <int N>
void expect_order_two(Lattice lattice, std::size_t coarse, std::size_t fine, double content) {
  SCOPED_TRACE(std::string(name_of(lattice)));
  const auto error = [&](std::size_t samples) {
    auto image = lattice_image<N>(lattice, samples, [](const auto& x, const auto&, const auto&) { return ball<N>(x); });
    return std::abs(measure(extract<double>(lattice_complex(image.view(), lattice), 0.0)).content.value() - content);
  };
  const double ratio = static_cast<double>(fine - 1) / static_cast<double>(coarse - 1);
  EXPECT_NEAR(2.0, std::log(error(coarse) / error(fine)) / std::log(ratio), 0.35);
}

TEST(Lattice, TheContentOfABallConvergesWithOrderTwo) {
  constexpr double kPi = std::numbers::pi;
  expect_order_two<2>(Lattice::triangular, 12, 34, kPi * 0.49);
  expect_order_two<3>(Lattice::fcc, 12, 34, 4.0 / 3.0 * kPi * 0.343);
  expect_order_two<3>(Lattice::bcc, 12, 34, 4.0 / 3.0 * kPi * 0.343);
  expect_order_two<4>(Lattice::d4, 8, 16, 0.5 * kPi * kPi * 0.2401);
}

TEST(Lattice, AnIndexOfTheCellsGivesTheSameContours) {
  auto image = lattice_image<3>(Lattice::fcc, 12, noise_everywhere<3>(8));
  for (double& value : image.values) value = std::round(20 * value) / 20;  // many equal values
  Complex<3> complex = lattice_complex(image.view(), Lattice::fcc);
  const CellIndex index(complex);
  EXPECT_LE(index.size(), complex.cell_count());
  EXPECT_GT(index.size(), complex.cell_count() / 2);
  for (const double isovalue : {-1.0, 0.0, 0.05, 0.3, 0.5, 0.7499999999, 0.95, 1.0, 1.1}) {
    const auto expected = extract_with_stats<double>(complex, isovalue);
    const auto found = extract_with_stats<double>(complex, index, isovalue);
    EXPECT_EQ(found.contour.vertices, expected.contour.vertices);
    EXPECT_EQ(found.contour.simplices, expected.contour.simplices);
    EXPECT_EQ(found.stats.active_tiles, expected.stats.active_tiles);
    EXPECT_GE(index.find(isovalue).size(), expected.stats.active_tiles);
  }
  complex.find_edges();
  EXPECT_EQ(extract<double>(complex, index, 0.5).simplices, extract<double>(complex, 0.5).simplices);
  // a value is missing: all cells are read
  auto values = complex.values();
  values[values.size() / 2] = std::numeric_limits<double>::quiet_NaN();
  complex.set_values(values);
  const CellIndex with_missing(complex);
  EXPECT_TRUE(with_missing.has_missing());
  EXPECT_EQ(extract<double>(complex, with_missing, 0.5).simplices, extract<double>(complex, 0.5).simplices);
  auto other = lattice_image<3>(Lattice::fcc, 5, noise_everywhere<3>(8));
  expect_error(ErrorCode::InvalidArgument, "an index of",
               [&] { (void)extract(lattice_complex(other.view(), Lattice::fcc), index, 0.5); });
}

TEST(Lattice, BadGridsAreRefused) {
  auto image = lattice_image<3>(Lattice::fcc, 6, [](const auto&, const auto&, const auto&) { return 0.0; });
  expect_error(ErrorCode::InvalidArgument, "lattice d4 of a 3D image; expected 4 dimensions",
               [&] { (void)lattice_complex(image.view(), Lattice::d4); });
  const auto moving =
      lattice_image<4>(Lattice::fcc_in_time, 4, [](const auto&, const auto&, const auto&) { return 0.0; });
  expect_error(ErrorCode::InvalidArgument,
               "lattice fcc of a 4D image; expected 3 dimensions, or the lattice fcc_in_time for fcc over time",
               [&] { (void)extract_lattice(moving.view(), Lattice::fcc, 0.0); });
  image.grid.axes[0] = Axis::rectilinear({0.0, 1.0, 2.0, 4.0, 5.0, 6.0});
  expect_error(ErrorCode::InvalidArgument, "axis 0 (x) has a step of",
               [&] { (void)lattice_complex(image.view(), Lattice::fcc); });
  ExtractOptions options;
  options.normals = Normals::sobel;
  expect_error(ErrorCode::InvalidArgument, "sobel normals on a lattice; expected gradient",
               [&] { (void)extract_lattice(image.view(), Lattice::fcc, 0.5, options); });
  EXPECT_EQ(name_of(Lattice::bcc), "bcc");
  for (const int axis : {0, 1}) {  // tetrahedra of one row have edges in common only
    OwnedImage<double, 3> row;
    std::array<std::size_t, 3> sizes = {4, 4, 4};
    sizes[static_cast<std::size_t>(axis)] = 1;
    row.grid = Grid<3>::unit(sizes);
    row.values.resize(16);
    const std::string expected =
        fmt::format("lattice bcc: axis {} ({}) has 1 sample; expected at least 2", axis, axis == 0 ? "x" : "y");
    expect_error(ErrorCode::InvalidArgument, expected, [&] { (void)lattice_complex(row.view(), Lattice::bcc); });
    expect_error(ErrorCode::InvalidArgument, expected, [&] { (void)extract_lattice(row.view(), Lattice::bcc, 0.5); });
  }
}

TEST(Lattice, TimesOfFccMayDescend) {
  auto image = lattice_image<4>(Lattice::fcc_in_time, 6, noise<4>(3));
  const std::size_t steps = image.grid.axes[3].size(), size = image.values.size() / steps;
  image.grid.axes[3] = Axis::uniform(steps, 2.0, -0.5);
  Grid<3> space;
  std::copy_n(image.grid.axes.begin(), 3, space.axes.begin());
  for (const bool by_map : {false, true}) {
    if (by_map) {  // the same times
      image.grid.axes[3] = Axis::uniform(steps, -2.0, 0.5);
      image.grid.linear[3][3] = -1.0;
    }
    for (const Ambiguity ambiguity : kAllRules) {
      ExtractOptions options;
      options.ambiguity = ambiguity;
      const auto contour = extract_lattice<double>(image.view(), Lattice::fcc_in_time, 0.5, options);
      EXPECT_GT(contour.simplices.size(), 100u);
      expect_closed_manifold(contour);
      EXPECT_GT(measure(contour).content.value(), 0.0);
      for (std::size_t k = 1; k + 1 < steps; ++k) {
        const Image<double, 3> step(image.values.data() + k * size, space);
        const double time = 2.0 - 0.5 * static_cast<double>(k);
        EXPECT_TRUE(same_surface(extract<double>(lattice_complex(step, Lattice::fcc), 0.5, options),
                                 slice(contour, Hyperplane<4>::across(3, time))));
      }
    }
  }
}

/// Expects cells in an image of the least layers, and an error with one layer less.
template <int N>
void expect_least_layers(Lattice lattice) {
  SCOPED_TRACE(name_of(lattice));
  for (const std::size_t layers : {least_layers(lattice), least_layers(lattice) - 1}) {
    OwnedImage<double, N> image;
    std::array<std::size_t, N> sizes;
    sizes.fill(3);
    sizes[N - (lattice == Lattice::fcc_in_time ? 2 : 1)] = layers;
    image.grid = Grid<N>::unit(sizes);
    image.values.resize(std::accumulate(sizes.begin(), sizes.end(), std::size_t{1}, std::multiplies<>()));
    if (layers == least_layers(lattice)) {
      EXPECT_GT(lattice_complex(image.view(), lattice).cell_count(), 0U);
      continue;
    }
    const std::string expected = fmt::format("lattice {}: {} layer{}; expected at least {}", name_of(lattice), layers,
                                             layers == 1 ? "" : "s", layers + 1);
    expect_error(ErrorCode::InvalidArgument, expected, [&] { (void)lattice_complex(image.view(), lattice); });
    expect_error(ErrorCode::InvalidArgument, expected, [&] { (void)extract_lattice(image.view(), lattice, 0.5); });
  }
}

TEST(Lattice, TooFewLayersForACellAreRefused) {
  expect_least_layers<2>(Lattice::triangular);
  expect_least_layers<3>(Lattice::fcc);
  expect_least_layers<3>(Lattice::bcc);
  expect_least_layers<4>(Lattice::d4);
  expect_least_layers<4>(Lattice::fcc_in_time);
}

}  // namespace
}  // namespace tegl
