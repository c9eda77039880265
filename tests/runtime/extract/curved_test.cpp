// SPDX-License-Identifier: BSD-3-Clause
//
// Contours on curved grids: compared with meshes of the grid's cells; measures, normals, orientation, folds.
#include "tegl/curved.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "invariants.hpp"
#include "tegl/complex.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr double kPi = std::numbers::pi;

/// An image with a place in space for each sample, all of whose coordinates are curved.
template <int N>
struct CurvedImage {
  OwnedImage<double, N> image;
  std::vector<CurvedAxis> curved;

  [[nodiscard]] std::size_t count() const { return image.values.size(); }
  [[nodiscard]] std::array<double, N> place(std::size_t sample) const {
    std::array<double, N> x;
    for (int a = 0; a < N; ++a) x[a] = curved[static_cast<std::size_t>(a)].values[sample];
    return x;
  }
};

/// `place`: from indices divided by the number of steps, each from 0 to 1. `value`: of a place.
template <int N, class Place, class F>
CurvedImage<N> curved_image(const std::array<std::size_t, N>& sizes, Place place, F value) {
  CurvedImage<N> result;
  result.image.grid = Grid<N>::unit(sizes);
  for (int a = 0; a < N; ++a) result.curved.push_back({a, (1u << N) - 1, {}});
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, N> u;
    for (std::size_t a = 0, rest = i; a < N; rest /= sizes[a], ++a)
      u[a] = static_cast<double>(rest % sizes[a]) / static_cast<double>(sizes[a] - 1);
    const std::array<double, N> x = place(u);
    for (std::size_t a = 0; a < N; ++a) result.curved[a].values.push_back(x[a]);
    result.image.values.push_back(value(x));
  }
  return result;
}

/// A ball's distance function.
template <int N>
double ball(const std::array<double, N>& x) {
  double square = 0.0;
  for (const double each : x) square += each * each;
  return 0.6 - std::sqrt(square);
}

/// A cube from -1 to 1, twisted and bent inside.
template <int N>
std::array<double, N> bent(const std::array<double, N>& u) {
  std::array<double, N> x;
  for (int a = 0; a < N; ++a) {
    x[a] = 2.0 * u[a] - 1.0;
    double wave = 0.08;
    for (int b = 0; b < N; ++b) wave *= std::sin(kPi * u[b] * (b == a ? 1.0 : 2.0));
    x[a] += wave;
  }
  return x;
}

/// The vertices of all simplices, sorted: the contour without its numbers.
template <int N>
std::vector<std::array<std::array<double, N>, N>> sorted_places(const Contour<N, double>& contour) {
  std::vector<std::array<std::array<double, N>, N>> result;
  for (const auto& simplex : contour.simplices) {
    auto& places = result.emplace_back();
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < N; ++a) places[i][a] = std::round(contour.vertices[simplex[i]][a] * 1e9) * 1e-9 + 0.0;
    std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// The cells of a grid as a mesh.
template <int N>
Complex<N> mesh_of(const CurvedImage<N>& curved) {
  const auto sizes = curved.image.grid.sizes();
  std::vector<std::array<double, N>> points;
  for (std::size_t i = 0; i < curved.count(); ++i) points.push_back(curved.place(i));
  const auto row = static_cast<Index>(sizes[0]), layer = static_cast<Index>(sizes[0] * sizes[1]);
  std::vector<Index> corners;
  for (std::size_t z = 0; z < (N == 2 ? 1 : sizes[N - 1] - 1); ++z)
    for (std::size_t y = 0; y + 1 < sizes[1]; ++y)
      for (std::size_t x = 0; x + 1 < sizes[0]; ++x)
        for (Index side = 0; side < (N == 2 ? 1u : 2u); ++side) {
          const auto at = static_cast<Index>((z + side) * layer + y * row + x);
          corners.insert(corners.end(), {at, at + 1, at + row + 1, at + row});
        }
  const std::vector<CellType> types(corners.size() / (1u << N),
                                    N == 2 ? CellType::quadrilateral : CellType::hexahedron);
  Complex<N> complex(std::move(points), types, corners);
  complex.set_values(std::vector<double>(curved.image.values.begin(), curved.image.values.end()));
  return complex;
}

template <int N>
void expect_the_mesh_of_its_cells(const std::array<std::size_t, N>& sizes) {
  std::mt19937 random(7);
  const CurvedImage<N> noise = curved_image<N>(sizes, &bent<N>, [&](const std::array<double, N>& x) {
    return ball<N>(x) + std::uniform_real_distribution<double>(-0.3, 0.3)(random);
  });
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
    const ExtractOptions options{.ambiguity = ambiguity};
    const auto contour = extract_curved<double>(noise.image.view(), noise.curved, 0.0, options);
    EXPECT_TRUE(is_oriented_manifold(check(contour)));
    const auto of_mesh = extract<double>(mesh_of(noise), 0.0, options);
    EXPECT_EQ(contour.vertices.size(), of_mesh.vertices.size());
    EXPECT_EQ(sorted_places(contour), sorted_places(of_mesh));
  }
}

TEST(Curved, HasTheContourOfTheMeshOfItsCells) {
  expect_the_mesh_of_its_cells<2>({23, 17});
  expect_the_mesh_of_its_cells<3>({11, 9, 10});
}

/// Errors of size and content of a contour in a bent cube.
template <int N, class F>
std::array<double, 2> errors_of(std::size_t samples, F field, double size, double content, std::ptrdiff_t euler) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  const CurvedImage<N> image = curved_image<N>(sizes, &bent<N>, field);
  EXPECT_EQ(find_folds<N>(image.image.grid, image.curved).cells, 0U);
  const auto contour = extract_curved<double>(image.image.view(), image.curved, 0.0);
  const MeshReport report = check(contour);
  EXPECT_TRUE(is_closed_oriented_manifold(report));
  EXPECT_EQ(report.euler, euler);
  const Measures<N> measures = measure(contour);
  return {std::abs(measures.size - size), std::abs(measures.content.value() - content)};
}

template <int N, class F>
void expect_order_two(std::size_t samples, F field, double size, double content, std::ptrdiff_t euler) {
  const auto coarse = errors_of<N>(samples, field, size, content, euler);
  const auto fine = errors_of<N>(2 * samples - 1, field, size, content, euler);
  for (int i : {0, 1}) {
    EXPECT_LT(fine[i], 0.35 * coarse[i]) << N << "D, " << (i == 0 ? "size" : "content");
    EXPECT_GT(coarse[i], 0.0);
  }
}

TEST(Curved, MeasuresOfBallsAndOfATorusAreOfOrderTwo) {
  const double r = 0.6;
  expect_order_two<2>(25, &ball<2>, 2.0 * kPi * r, kPi * r * r, 0);
  expect_order_two<3>(17, &ball<3>, 4.0 * kPi * r * r, 4.0 / 3.0 * kPi * r * r * r, 2);
  expect_order_two<4>(11, &ball<4>, 2.0 * kPi * kPi * r * r * r, 0.5 * kPi * kPi * r * r * r * r, 0);
  const double ring = 0.45, tube = 0.2;
  const auto torus = [=](const std::array<double, 3>& x) {
    return tube - std::hypot(std::hypot(x[0], x[1]) - ring, x[2]);
  };
  expect_order_two<3>(33, torus, 4.0 * kPi * kPi * ring * tube, 2.0 * kPi * kPi * ring * tube * tube, 0);
}

TEST(Curved, FacesTheSameSideOnMirroredGrids) {
  for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent})
    for (const bool is_mirrored : {false, true}) {
      const auto place = [&](std::array<double, 3> u) {
        if (is_mirrored) u[1] = 1.0 - u[1];
        return bent<3>(u);
      };
      const CurvedImage<3> image = curved_image<3>({13, 14, 15}, place, &ball<3>);
      const auto contour = extract_curved(image.image.view(), image.curved, 0.0,
                                          {.direction = direction, .close = true, .normals = Normals::differences});
      EXPECT_TRUE(is_closed_oriented_manifold(check(contour)));
      const double outside = direction == GradientDirection::descent ? 1.0 : -1.0;
      EXPECT_GT(measure(contour).content.value(), 0.0);  // high samples are inside
      double least = 1.0;
      for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
        double dot = 0.0, length = 0.0;
        for (int a = 0; a < 3; ++a) {
          dot += contour.vertices[v][a] * contour.normals[v][a];
          length += contour.vertices[v][a] * contour.vertices[v][a];
        }
        least = std::min(least, outside * dot / std::sqrt(length));
      }
      EXPECT_GT(least, 0.98) << "normals of a ball are radial";
    }
}

TEST(Curved, FacesTheRightSideOnAMirroredGridAtItsFirstSamples) {
  // All vertices have the index 0 along the mirrored axis.
  const auto mirrored = [](const std::array<double, 3>& u) { return std::array{1.0 - u[0], u[1], u[2]}; };
  const CurvedImage<3> image =
      curved_image<3>({5, 4, 3}, mirrored, [](const std::array<double, 3>& x) { return x[0] - 1.0; });
  const auto contour = extract_curved(image.image.view(), image.curved, 0.0, {.normals = Normals::differences});
  ASSERT_EQ(contour.vertices.size(), 12u);
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    EXPECT_EQ(contour.vertices[v][0], 1.0);
    EXPECT_NEAR(contour.normals[v][0], -1.0, 1e-12) << "towards lower samples";
  }
}

TEST(Curved, SmallDeviationsFromTheFirstIndexDoNotTurnAContour) {
  const auto mirrored = [](const std::array<double, 3>& u) { return std::array{1.0 - u[0], u[1], u[2]}; };
  const CurvedImage<3> image =
      curved_image<3>({9, 4, 3}, mirrored, [](const std::array<double, 3>& x) { return 0.6 - x[0] - 0.3 * x[1]; });
  const OwnedImage<double, 3> flat{index_grid<3>(image.image.grid, image.curved), image.image.values};
  auto indices = extract<double>(flat.view(), 0.0);
  const auto expected = on_curved_grid<double, 3>(indices, image.image.grid, image.curved);
  indices.vertices.insert(indices.vertices.begin(), {1e-8, 1.0, 1.0});
  const auto moved = on_curved_grid<double, 3>(indices, image.image.grid, image.curved);
  for (std::size_t v = 0; v < expected.vertices.size(); ++v)
    EXPECT_EQ(moved.vertices[v + 1], expected.vertices[v]) << v;
}

TEST(Curved, OfPolarCoordinatesIsACircle) {
  // All of the plane around a hole but for the seam, at which the samples are doubled.
  const auto polar = [](const std::array<double, 2>& u) {
    const double r = 0.5 + u[0], phi = 2.0 * kPi * u[1];
    return std::array<double, 2>{r * std::cos(phi), r * std::sin(phi)};
  };
  double before = 1.0;
  for (const std::size_t samples : {std::size_t{33}, std::size_t{65}}) {
    const CurvedImage<2> image = curved_image<2>(
        {samples, 2 * samples}, polar, [](const std::array<double, 2>& x) { return 1.0 - std::hypot(x[0], x[1]); });
    const auto contour = extract_curved<double>(image.image.view(), image.curved, 0.0);
    const double error = std::abs(measure(contour).size - 2.0 * kPi);
    EXPECT_LT(error, 0.3 * before);
    before = error;
  }
}

TEST(Curved, TorusInToroidalCoordinates) {
  // The angle around the ring, the angle around the tube and the distance from its middle; closed by caps at the seams.
  const auto toroidal = [](const std::array<double, 3>& u) {
    const double ring = 1.7 * kPi * u[0], tube = 1.9 * kPi * u[1], r = 0.1 + 0.3 * u[2];
    const double from_axis = 1.0 + r * std::cos(tube);
    return std::array<double, 3>{from_axis * std::cos(ring), from_axis * std::sin(ring), r * std::sin(tube)};
  };
  const CurvedImage<3> image = curved_image<3>({40, 40, 8}, toroidal, [](const std::array<double, 3>& x) {
    return 0.25 - std::hypot(std::hypot(x[0], x[1]) - 1.0, x[2]);
  });
  EXPECT_EQ(find_folds<3>(image.image.grid, image.curved).cells, 0U);
  const auto contour = extract_curved<double>(image.image.view(), image.curved, 0.0);
  const MeshReport report = check(contour);
  EXPECT_TRUE(is_oriented_manifold(report));
  EXPECT_EQ(report.euler, 1) << "a rectangle";
  // the area of the part of the torus: the integral of r (1 + r cos(tube)) over both angles
  const double area = 1.7 * kPi * 0.25 * (1.9 * kPi + 0.25 * std::sin(1.9 * kPi));
  EXPECT_NEAR(measure(contour).size, area, 0.005 * area);
}

/// An O-grid around a body: radius and angle, or with `height` also z; the angle's last sample is one step before its
/// first one.
template <int N, class F>
CurvedImage<N> around_body(const std::array<std::size_t, N>& sizes, F value) {
  const double part = static_cast<double>(sizes[1] - 1) / static_cast<double>(sizes[1]);
  return curved_image<N>(
      sizes,
      [&](const std::array<double, N>& u) {
        const double r = 0.5 + u[0], phi = 2.0 * kPi * u[1] * part;
        std::array<double, N> x{r * std::cos(phi), r * std::sin(phi)};
        if constexpr (N == 3) x[2] = u[2];
        return x;
      },
      value);
}

/// The cells of a grid as a mesh whose axis 1 is periodic: the last points are connected to the first ones.
template <int N>
Complex<N> ring_mesh_of(const CurvedImage<N>& image) {
  const auto sizes = image.image.grid.sizes();
  std::vector<std::array<double, N>> points;
  for (std::size_t i = 0; i < image.count(); ++i) points.push_back(image.place(i));
  std::vector<Index> corners;
  const auto number = [&](std::size_t x, std::size_t y, std::size_t z) {
    return static_cast<Index>((z * sizes[1] + y % sizes[1]) * sizes[0] + x);
  };
  for (std::size_t z = 0; z < (N == 2 ? 1 : sizes[N - 1] - 1); ++z)
    for (std::size_t y = 0; y < sizes[1]; ++y)
      for (std::size_t x = 0; x + 1 < sizes[0]; ++x)
        for (std::size_t side = 0; side < (N == 2 ? 1u : 2u); ++side)
          corners.insert(corners.end(), {number(x, y, z + side), number(x + 1, y, z + side),
                                         number(x + 1, y + 1, z + side), number(x, y + 1, z + side)});
  Complex<N> complex(std::move(points), N == 2 ? CellType::quadrilateral : CellType::hexahedron, corners);
  complex.set_values(std::vector<double>(image.image.values.begin(), image.image.values.end()));
  return complex;
}

template <int N>
void expect_the_ring_of_cells(const std::array<std::size_t, N>& sizes) {
  std::mt19937 random(7);
  const CurvedImage<N> noise = around_body<N>(
      sizes, [&](const std::array<double, N>&) { return std::uniform_real_distribution<double>()(random); });
  const std::vector<CurvedSeam<N>> seams = {{1, {}}};
  for (const bool close : {false, true}) {
    ExtractOptions options;
    options.close = close;
    const auto contour = extract_curved<double>(noise.image.view(), noise.curved, 0.5, options, seams);
    EXPECT_TRUE(contour.periods.empty());
    const auto of_mesh = extract<double>(ring_mesh_of(noise), 0.5, options);
    EXPECT_TRUE(is_oriented_manifold(check(contour)));
    EXPECT_EQ(check(contour).euler, check(of_mesh).euler);
    EXPECT_EQ(check(contour).components, check(of_mesh).components);
    EXPECT_EQ(check(contour).boundary_simplices, check(of_mesh).boundary_simplices);
    EXPECT_EQ(contour.vertices.size(), of_mesh.vertices.size());
    EXPECT_NEAR(measure(contour).size, measure(of_mesh).size, 1e-9 * measure(of_mesh).size);
    if (close) continue;  // caps of images and of meshes have other diagonals
    EXPECT_EQ(sorted_places(contour), sorted_places(of_mesh));
  }
}

TEST(CurvedSeams, AnOGridHasTheContourOfItsCellsWithMergedPoints) {
  expect_the_ring_of_cells<2>({9, 14});
  expect_the_ring_of_cells<3>({5, 9, 6});
}

TEST(CurvedSeams, ARingAroundABodyIsClosedAndOneComponent) {
  const auto image =
      around_body<2>({33, 64}, [](const std::array<double, 2>& x) { return 1.0 - std::hypot(x[0] - 0.1, x[1]); });
  const std::vector<int> axes = {1};
  const auto seams = find_seams<2>(image.image.grid, image.curved, axes);
  ASSERT_EQ(seams.size(), 1u);
  EXPECT_EQ(seams[0].vector, (Vector<2>{}));
  ExtractOptions options;
  options.normals = Normals::differences;
  const auto contour = extract_curved<double>(image.image.view(), image.curved, 0.0, options, seams);
  const MeshReport report = check(contour);
  EXPECT_TRUE(is_closed_oriented_manifold(report));
  EXPECT_EQ(report.components, 1u);
  EXPECT_NEAR(measure(contour).content.value(), kPi, 0.01);
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    EXPECT_NEAR(contour.normals[v][0], contour.vertices[v][0] - 0.1, 0.02);
    EXPECT_NEAR(contour.normals[v][1], contour.vertices[v][1], 0.02);
  }
  EXPECT_EQ(find_folds<2>(image.image.grid, image.curved, {}, seams), GridFolds<2>{});
  ExtractOptions threads;
  threads.work.threads = 3;
  EXPECT_EQ(extract_curved<double>(image.image.view(), image.curved, 0.0, threads, seams).simplices, contour.simplices);
}

/// A global ocean grid: longitudes and latitudes in arrays, tilted against each other; `from`: first longitude.
OwnedImage<double, 2> globe(double from, std::vector<CurvedAxis>& curved) {
  OwnedImage<double, 2> image;
  image.grid = Grid<2>::unit({36, 17});
  curved = {{0, 3, {}, "lon", "degrees_east"}, {1, 3, {}, "lat", "degrees_north"}};
  for (int j = 0; j < 17; ++j)
    for (int i = 0; i < 36; ++i) {
      const double lat = -80.0 + 10.0 * j + 2.0 * std::sin(2.0 * kPi * i / 36.0), lon = from + 10.0 * i + 0.1 * j;
      curved[0].values.push_back(lon);
      curved[1].values.push_back(lat);
      // a cap around 180 degrees east, at the equator
      const double away = lon - 180.0 - 360.0 * std::round((lon - 180.0) / 360.0);
      image.values.push_back(40.0 - std::hypot(away, lat));
    }
  return image;
}

TEST(CurvedSeams, AThingThatCrossesTheDateLineIsOneClosedComponent) {
  std::vector<CurvedAxis> curved;
  for (const double from : {-175.0, 3.0, -359.0}) {
    const auto image = globe(from, curved);
    const std::vector<int> axes = {0};
    const auto seams = find_seams<2>(image.grid, curved, axes);
    EXPECT_EQ(seams[0].vector, (Vector<2>{360.0, 0.0}));
    const auto contour = extract_curved<double>(image.view(), curved, 0.0, {}, seams);
    ASSERT_EQ(contour.periods.size(), 1u);
    EXPECT_EQ(contour.periods[0].vector, (Vector<2>{360.0, 0.0}));
    EXPECT_EQ(contour.axis_names[0], "lon");
    const MeshReport report = check(contour);
    EXPECT_TRUE(is_closed_oriented_manifold(report));
    EXPECT_EQ(report.components, 1u);
    EXPECT_NEAR(measure(contour).content.value(), kPi * 1600.0, 80.0);  // cells of 10 degrees
    for (const auto& vertex : contour.vertices) EXPECT_TRUE(vertex[0] > from - 1.0 && vertex[0] < from + 361.0);
    const auto unrolled = unroll(contour).contour;
    double longest = 0;
    for (const auto& simplex : unrolled.simplices)
      longest = std::max(longest, std::abs(unrolled.vertices[simplex[0]][0] - unrolled.vertices[simplex[1]][0]));
    EXPECT_LT(longest, 20.0);
  }
}

TEST(CurvedSeams, LongitudesAroundTheGlobeAreFound) {
  std::vector<CurvedAxis> curved;
  auto image = globe(-175.0, curved);
  EXPECT_EQ(longitude_axes<2>(image.grid, curved), std::vector<int>{0});
  // one row ends early
  const double last = std::exchange(curved[0].values[35], 160.0);
  EXPECT_EQ(longitude_axes<2>(image.grid, curved), std::vector<int>{});
  // a row with an unknown end says nothing, nor do none but such rows
  curved[0].values[35] = std::nan("");
  EXPECT_EQ(longitude_axes<2>(image.grid, curved), std::vector<int>{0});
  for (std::size_t j = 0; j < 17; ++j) curved[0].values[36 * j + 35] = std::nan("");
  EXPECT_EQ(longitude_axes<2>(image.grid, curved), std::vector<int>{});
  // descending longitudes, another unit, the first sample repeated
  image = globe(-175.0, curved);
  EXPECT_EQ(curved[0].values[35], last);
  for (double& lon : curved[0].values) lon = -lon;
  EXPECT_EQ(longitude_axes<2>(image.grid, curved), std::vector<int>{0});
  curved[0].unit = "degrees";
  EXPECT_EQ(longitude_axes<2>(image.grid, curved), std::vector<int>{});
  curved[0].unit = "degrees_east";
  for (double& lon : curved[0].values) lon *= 36.0 / 35.0;
  EXPECT_EQ(longitude_axes<2>(image.grid, curved), std::vector<int>{});
  // straight axes
  image.grid.axes[0] = Axis::uniform(36, 0.0, 10.0);
  image.grid.axes[0].unit = "degree_east";
  EXPECT_EQ(longitude_axes<2>(image.grid), std::vector<int>{0});
  image.grid.axes[0].unit = "m";
  EXPECT_EQ(longitude_axes<2>(image.grid), std::vector<int>{});
}

TEST(CurvedSeams, AStraightAxisBesideACurvedOneIsPeriodic) {
  // straight longitudes, heights that follow the ground: z(x, z)
  OwnedImage<double, 2> image;
  image.grid = Grid<2>::unit({24, 11});
  image.grid.axes[0] = Axis::uniform(24, 0.0, 15.0);
  image.grid.axes[0].unit = "degrees_east";
  std::vector<CurvedAxis> curved = {{1, 3, {}, "z", "m"}};
  for (int j = 0; j < 11; ++j)
    for (int i = 0; i < 24; ++i) {
      const double z = j + 0.5 * std::cos(2.0 * kPi * i / 24.0);
      curved[0].values.push_back(z);
      image.values.push_back(5.0 - z);
    }
  const std::vector<int> axes = {0};
  const auto seams = find_seams<2>(image.grid, curved, axes);
  EXPECT_EQ(seams[0].vector, (Vector<2>{360.0, 0.0}));
  const auto contour = extract_curved<double>(image.view(), curved, 0.0, {}, seams);
  EXPECT_TRUE(is_closed_oriented_manifold(check(contour)));
  for (const auto& vertex : contour.vertices) EXPECT_NEAR(vertex[1], 5.0, 0.02);
  EXPECT_NEAR(measure(contour).size, 360.0, 0.1);
}

TEST(CurvedSeams, GivenPeriodsFollowTheCoordinateThatGrowsOrDescends) {
  for (const bool descends : {false, true}) {
    std::vector<CurvedAxis> curved;
    const auto image = globe(0.0, curved);
    for (CurvedAxis& one : curved) {
      one.unit.clear();  // otherwise the seam is found
      if (one.axis == 0 && descends)
        for (double& x : one.values) x = -x;
    }
    const std::array axes{0};
    const auto seams = find_seams(image.grid, curved, axes, std::array{360.0});
    ASSERT_EQ(seams.size(), 1u);
    EXPECT_EQ(seams[0].vector, (Vector<2>{descends ? -360.0 : 360.0, 0.0}));
    EXPECT_EQ(find_folds<2>(image.grid, curved, {}, seams).cells, 0u);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(find_seams(image.grid, curved, axes, std::array{nan})[0].vector, (Vector<2>{0.0, 0.0}));
    expect_error(ErrorCode::InvalidArgument, "the seam of axis 0 has the period -360; expected a positive number",
                 [&] { (void)find_seams(image.grid, curved, axes, std::array{-360.0}); });
    expect_error(ErrorCode::InvalidArgument, "2 periods of seams; expected one for each of 1 axes", [&] {
      (void)find_seams(image.grid, curved, axes, std::array{360.0, 180.0});
    });
  }
}

TEST(CurvedSeams, PeriodsInAnotherUnitAreErrors) {
  std::vector<CurvedAxis> curved;
  const auto image = globe(0.0, curved);
  const auto seams_of = [&](double period) {
    return find_seams<2>(image.grid, curved, std::array{0}, std::array{period});
  };
  expect_error(ErrorCode::InvalidArgument,
               "the period of axis 0 (x), a curved axis, is 1000, and the step across the seam is 650, in the mean",
               [&] { (void)seams_of(1000.0); });
  expect_error(ErrorCode::InvalidArgument, "is 6.28, and the step across the seam is 343.72",
               [&] { (void)seams_of(6.28); });
  EXPECT_EQ(seams_of(500.0)[0].vector, (Vector<2>{500.0, 0.0}));  // a gap, but a shorter one
}

TEST(CurvedSeams, PeriodsThatAreNotLongerThanTheSamplesAreErrors) {
  for (const bool descends : {false, true}) {
    SCOPED_TRACE(descends);
    std::vector<CurvedAxis> curved;
    const auto image = globe(0.0, curved);
    for (CurvedAxis& one : curved)
      if (one.axis == 0 && descends)
        for (double& x : one.values) x = -x;
    const auto seams_of = [&](double period) {
      return find_seams<2>(image.grid, curved, std::array{0}, std::array{period});
    };
    expect_error(ErrorCode::InvalidArgument,
                 "the period of axis 0 (x), a curved axis, is 350, and the last coordinates are 350 from the first "
                 "ones, in the mean of all rows; expected a longer period",
                 [&] { (void)seams_of(350.0); });
    expect_error(ErrorCode::InvalidArgument, "is 340, and the last coordinates are 350 from the first ones",
                 [&] { (void)seams_of(340.0); });
    EXPECT_EQ(seams_of(351.0)[0].vector, (Vector<2>{descends ? -351.0 : 351.0, 0.0}));
  }
}

TEST(CurvedSeams, WrongSeamsAreErrors) {
  std::vector<CurvedAxis> curved;
  const auto image = globe(0.0, curved);
  const auto refused = [&](const std::vector<CurvedSeam<2>>& seams, const char* text) {
    expect_error(ErrorCode::InvalidGrid, text, [&] { (void)extract_curved(image.view(), curved, 0.0, {}, seams); });
  };
  refused({{2, {}}}, "a seam of axis 2; expected an axis from 0 to 1");
  refused({{0, {}}, {0, {}}}, "two seams of axis 0");
  refused({{0, {std::nan(""), 0.0}}}, "the vector component nan; expected a finite number");
  refused({{0, {360.0, 0.0}}, {1, {360.0, 0.0}}}, "the vectors of the seams are dependent");
  curved.pop_back();
  refused({{0, {360.0, 1.0}}}, "along coordinate 1, which does not differ along it");
  refused({{1, {}}}, "the seam of axis 1, which is not curved, has the period 0");
  auto contour = extract(image.view(), 0.0);
  const std::vector<CurvedSeam<2>> seams = {{0, {360.0, 0.0}}};
  expect_error(ErrorCode::InvalidArgument, "a contour with 0 periods and 1 seams",
               [&] { (void)on_curved_grid(contour, image.grid, curved, {}, seams); });
}

TEST(Curved, StraightAxesKeepTheirCoordinates) {
  // Longitude and latitude by two indices; uneven depths; times. The same as a mesh over time, cut at a time.
  OwnedImage<float, 4> image;
  image.grid = Grid<4>::unit({12, 11, 5, 4});
  image.grid.axes[2] = Axis::rectilinear({0.0, 5.0, 20.0, 60.0, 100.0});
  image.grid.axes[3] = Axis::uniform(4, 2.0, 0.5);
  image.grid.axes[3].name = "t";
  std::vector<CurvedAxis> curved = {{0, 3, {}}, {1, 3, {}}};
  for (std::size_t j = 0; j < 11; ++j)
    for (std::size_t i = 0; i < 12; ++i) {
      const double r = 10.0 + static_cast<double>(i), phi = 0.1 * static_cast<double>(j);
      curved[0].values.push_back(r * std::cos(phi));
      curved[1].values.push_back(r * std::sin(phi));
    }
  std::mt19937 random(3);
  for (std::size_t i = 0; i < 12 * 11 * 5 * 4; ++i)
    image.values.push_back(std::uniform_real_distribution<float>()(random));
  const auto contour = extract_curved<float>(image.view(), curved, 0.5);
  EXPECT_TRUE(is_oriented_manifold(check(contour)));
  EXPECT_EQ(contour.axis_names[3], "t");
  // at a layer, the contour of the layer, which is a 3D image
  for (const std::size_t layer : {std::size_t{1}, std::size_t{2}}) {
    const auto cut = slice(contour, Hyperplane<4>::across(3, image.grid.axes[3][layer]));
    OwnedImage<float, 3> of_layer;
    for (int a = 0; a < 3; ++a) of_layer.grid.axes[a] = image.grid.axes[a];
    const auto first = image.values.begin() + static_cast<std::ptrdiff_t>(layer * 12 * 11 * 5);
    of_layer.values.assign(first, first + 12 * 11 * 5);
    const auto alone = extract_curved<float>(of_layer.view(), curved, 0.5);
    EXPECT_EQ(cut.simplices.size(), alone.simplices.size());
    EXPECT_NEAR(measure(cut).size, measure(alone).size, 1e-4 * measure(alone).size);
  }
}

TEST(Curved, GridsThatMoveInTime) {
  // A ball whose grid moves with it: the contour in space and time is a straight tube.
  OwnedImage<double, 4> image;
  image.grid = Grid<4>::unit({9, 9, 9, 5});
  image.grid.axes[3] = Axis::rectilinear({0.0, 1.0, 1.5, 3.0, 4.0});
  std::vector<CurvedAxis> curved = {{0, 15, {}}};
  for (std::size_t t = 0; t < 5; ++t)
    for (std::size_t z = 0; z < 9; ++z)
      for (std::size_t y = 0; y < 9; ++y)
        for (std::size_t x = 0; x < 9; ++x) {
          curved[0].values.push_back(static_cast<double>(x) + 2.0 * image.grid.axes[3][t]);
          image.values.push_back(2.7 - std::hypot(static_cast<double>(x) - 4.0, static_cast<double>(y) - 4.0,
                                                  static_cast<double>(z) - 4.0));
        }
  const auto contour = extract_curved<double>(image.view(), curved, 0.0);
  EXPECT_TRUE(is_oriented_manifold(check(contour)));
  OwnedImage<double, 3> at_rest;
  at_rest.grid = Grid<3>::unit({9, 9, 9});
  at_rest.values.assign(image.values.begin(), image.values.begin() + 9 * 9 * 9);
  const double content = measure(extract<double>(at_rest.view(), 0.0)).content.value();
  for (const double t : {0.3, 1.2, 2.0, 3.7}) {
    const auto cut = measure(slice(contour, Hyperplane<4>::across(3, t)));
    EXPECT_NEAR(cut.centroid[0], 4.0 + 2.0 * t, 1e-9);
    EXPECT_NEAR(cut.content.value(), content, 1e-9);
  }
}

TEST(Curved, FoldsAreFound) {
  auto image = curved_image<2>({6, 6}, &bent<2>, &ball<2>);
  EXPECT_EQ(find_folds<2>(image.image.grid, image.curved), GridFolds<2>{});
  std::swap(image.curved[0].values[14], image.curved[0].values[15]);
  const GridFolds<2> folds = find_folds<2>(image.image.grid, image.curved);
  EXPECT_EQ(folds.cells, 2U);  // those at the edge between the two samples
  EXPECT_EQ(folds.first, (std::array<std::size_t, 2>{2, 1}));
  for (const unsigned threads : {1u, 3u})
    EXPECT_EQ(find_folds<2>(image.image.grid, image.curved, {.threads = threads}), folds);
}

TEST(Curved, UnknownCoordinatesAreErrorsOnlyAtTheContour) {
  auto image = curved_image<2>({9, 9}, &bent<2>, &ball<2>);
  image.curved[1].values[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(find_folds<2>(image.image.grid, image.curved).cells, 0U);
  EXPECT_FALSE(extract_curved(image.image.view(), image.curved, 0.0).simplices.empty());
  image.curved[0].values[4 * 9 + 1] = std::numeric_limits<double>::quiet_NaN();
  image.curved[0].values[4 * 9 + 2] = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::UnsupportedData, ", 4), which has unknown coordinates",
               [&] { extract_curved(image.image.view(), image.curved, 0.0); });
}

TEST(Curved, LargeCoordinatesAreNotUnknown) {
  // Infinite as float, so the vertices' rounded coordinates do not show which are known.
  auto image = curved_image<2>({9, 9}, &bent<2>, &ball<2>);
  for (double& value : image.curved[0].values) value *= 1e300;
  const auto contour = extract_curved<float>(image.image.view(), image.curved, 0.0);
  EXPECT_TRUE(std::isinf(contour.vertices.front()[0]));
  EXPECT_TRUE(std::isfinite(contour.vertices.front()[1]));
  EXPECT_EQ(contour.simplices, extract<float>(image.image.view(), 0.0).simplices);
}

TEST(Curved, WrongCoordinatesAreErrors) {
  const auto image = curved_image<2>({5, 4}, &bent<2>, &ball<2>);
  const auto expect = [&](std::vector<CurvedAxis> curved, const std::string& text) {
    expect_error(ErrorCode::InvalidGrid, text, [&] { extract_curved(image.image.view(), curved, 0.0); });
  };
  auto wrong = image.curved;
  wrong[1].axis = 2;
  expect(wrong, "of axis 2; expected an axis from 0 to 1");
  wrong[1].axis = 0;
  expect(wrong, "two curved coordinates of axis 0");
  wrong = image.curved;
  wrong[0].along = 2;
  expect(wrong, "along the axes");
  wrong[0].along = 7;
  expect(wrong, "along the axes");
  wrong = image.curved;
  wrong[0].values.pop_back();
  expect(wrong, "19 curved coordinates of axis 0; expected 20");
}

TEST(Curved, ThreadsDoNotChangeTheContour) {
  const auto image = curved_image<3>({20, 21, 22}, &bent<3>, &ball<3>);
  const auto of = [&](unsigned threads) {
    ExtractOptions options{.normals = Normals::sobel};
    options.work.threads = threads;
    return extract_curved(image.image.view(), image.curved, 0.0, options);
  };
  const auto one = of(1), three = of(3);
  EXPECT_EQ(one.vertices, three.vertices);
  EXPECT_EQ(one.simplices, three.simplices);
  EXPECT_EQ(one.normals, three.normals);
}

}  // namespace
}  // namespace tegl
