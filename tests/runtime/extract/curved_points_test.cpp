// SPDX-License-Identifier: BSD-3-Clause
//
// Curved grids whose coordinates are stored sample by sample: their contours are those on arrays of coordinates.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "curved/curved_block.hpp"
#include "curved/curved_seams.hpp"
#include "errors.hpp"
#include "tegl/curved.hpp"

namespace tegl {
namespace {

using namespace test;

/// Numbers from 0 to 1.
template <int N>
OwnedImage<double, N> noise(const std::array<std::size_t, N>& sizes) {
  std::mt19937 random(23);
  OwnedImage<double, N> image;
  image.grid = Grid<N>::unit(sizes);
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  for (std::size_t i = 0; i < count; ++i) image.values.push_back(std::uniform_real_distribution<>()(random));
  return image;
}

/// The distance from the middle of a cube of 9 samples along each axis.
OwnedImage<double, 3> distances() {
  OwnedImage<double, 3> image;
  image.grid = Grid<3>::unit({9, 9, 9});
  for (int k = -4; k <= 4; ++k)
    for (int j = -4; j <= 4; ++j)
      for (int i = -4; i <= 4; ++i) image.values.push_back(std::hypot(i, j, k));
  return image;
}

/// Numbers, some unlike any float if `rounded` is false.
double drawn(std::mt19937& random, bool rounded) {
  const double x = std::uniform_real_distribution<>(-100.0, 100.0)(random) + 5e6;
  return rounded ? static_cast<double>(static_cast<float>(x)) : x;
}

/// The coordinate of an array between the samples around a point, multilinear; `index`: of the point, by axis.
double between_samples(const CurvedAxis& of, const std::array<std::size_t, 3>& sizes,
                       const std::array<double, 3>& index) {
  double sum = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::size_t at = 0, stride = 1;
    for (unsigned a = 0; a < 3; ++a) {
      const auto up = static_cast<std::size_t>(corner >> a & 1u);
      const double base = std::min(std::floor(index[a]), static_cast<double>(sizes[a] - 2)), share = index[a] - base;
      weight *= up != 0 ? share : 1.0 - share;
      if ((of.along >> a & 1u) == 0) continue;
      at += (static_cast<std::size_t>(base) + up) * stride;
      stride *= sizes[a];
    }
    sum += weight * of.values[at];
  }
  return sum;
}

TEST(Curved, PointsAreInterpolatedBetweenTheSamplesAroundThem) {
  // At samples, on edges and inside cells, in blocks of all sizes; arrays with the same and with other axes.
  const std::array<std::size_t, 3> sizes = {7, 6, 5};
  Grid<3> grid = Grid<3>::unit(sizes);
  grid.axes[2] = Axis::rectilinear({0.0, 1.0, 3.0, 7.0, 8.0});
  std::mt19937 random(11);
  const auto uniform = [&] { return std::uniform_real_distribution<>(0.0, 1.0)(random); };
  for (const std::array<unsigned, 3>& along : {std::array{7u, 7u, 7u}, {7u, 3u, 7u}, {3u, 3u, 0u}, {7u, 7u, 0u}}) {
    std::vector<CurvedAxis> curved;
    for (int a = 0; a < 3; ++a) {
      if (along[a] == 0) continue;
      CurvedAxis& one = curved.emplace_back(CurvedAxis{a, along[a], {}});
      for (std::size_t k = 0; k < ((along[a] & 4u) != 0 ? sizes[2] : 1); ++k)
        for (std::size_t j = 0; j < sizes[1]; ++j)
          for (std::size_t i = 0; i < sizes[0]; ++i)
            one.values.push_back(static_cast<double>(std::array{i, j, k}[a]) + 0.3 * uniform());
    }
    for (const std::size_t count : {0, 1, 2, 63, 64, 65, 130}) {
      Contour<3, double> contour;
      std::vector<std::array<double, 3>> expected;
      for (std::size_t v = 0; v < count; ++v) {
        std::array<double, 3> index;
        for (int a = 0; a < 3; ++a) {
          index[a] = std::floor(uniform() * static_cast<double>(sizes[a]));
          const bool moves = v % 5 == 4 ? uniform() < 0.5 : a == static_cast<int>(v % 5);
          if (moves && index[a] + 1.0 < static_cast<double>(sizes[a])) index[a] += uniform();
        }
        const auto layer = static_cast<std::size_t>(std::min(index[2], 3.0));
        const double first = grid.axes[2][layer];
        const double depth = first + (index[2] - static_cast<double>(layer)) * (grid.axes[2][layer + 1] - first);
        expected.push_back({0.0, 0.0, depth});
        for (const CurvedAxis& one : curved) expected.back()[one.axis] = between_samples(one, sizes, index);
        contour.vertices.push_back({index[0], index[1], along[2] == 0 ? depth : index[2]});
      }
      const Contour<3, double> moved = on_curved_grid<double>(std::move(contour), grid, curved);
      ASSERT_EQ(moved.vertices.size(), count);
      for (std::size_t v = 0; v < count; ++v)
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(moved.vertices[v][a], expected[v][a], 1e-12) << v << " of " << count;
    }
  }
}

TEST(CurvedPoints, HaveTheCoordinatesOfTheArrays) {
  std::mt19937 random(5);
  for (const bool rounded : {true, false})
    for (std::size_t columns = 1; columns <= 4; ++columns)
      for (const std::size_t samples : {0, 1, 5, 3000}) {
        // side by side in one array, as in files of points, and in arrays of their own
        std::vector<double> together;
        for (std::size_t i = 0; i < samples * columns; ++i) together.push_back(drawn(random, rounded));
        if (samples > 1) together[columns] = std::numeric_limits<double>::quiet_NaN();
        if (samples > 1) together[2 * columns - 1] = -std::numeric_limits<double>::infinity();
        std::vector<std::vector<double>> apart(columns);
        std::vector<std::vector<float>> narrow(columns);
        for (std::size_t i = 0; i < together.size(); ++i) {
          apart[i % columns].push_back(together[i]);
          narrow[i % columns].push_back(static_cast<float>(together[i]));
        }
        std::vector<CoordinateArray> of_points, of_arrays, of_floats;
        for (std::size_t c = 0; c < columns; ++c) {
          of_points.push_back({together.data() + c, static_cast<std::ptrdiff_t>(columns)});
          of_arrays.push_back({apart[c].data()});
          of_floats.push_back({narrow[c].data()});
        }
        for (const auto* each : {&of_points, &of_arrays, &of_floats}) {
          if (each == &of_floats && !rounded) continue;
          const std::vector<CoordinateArray>& arrays = *each;
          const CurvedPoints points(samples, arrays, 3);
          ASSERT_EQ(points.size(), samples);
          EXPECT_EQ(points.columns(), columns);
          if (samples > 1) {
            EXPECT_EQ(points.floats() != nullptr, rounded);
            EXPECT_EQ(points.doubles() != nullptr, !rounded);
          }
          for (std::size_t i = 0; i < together.size(); ++i) {
            const double is = points(i / columns, i % columns), was = together[i];
            EXPECT_TRUE(is == was || (std::isnan(is) && std::isnan(was))) << is << " " << was;
          }
        }
      }
  const std::vector<double> x(7);
  expect_error(ErrorCode::InvalidArgument, "0 arrays of coordinates; expected 1 to 4",
               [] { CurvedPoints(7, std::span<const CoordinateArray>()); });
  const std::vector<CoordinateArray> five(5, CoordinateArray{x.data()});
  expect_error(ErrorCode::InvalidArgument, "5 arrays of coordinates", [&] { CurvedPoints(7, five); });
}

TEST(CurvedPoints, SamplesAreNotInTwoCacheLines) {
  for (const bool rounded : {true, false}) {
    std::mt19937 random(5);
    std::vector<std::vector<double>> arrays(3, std::vector<double>(100));
    for (auto& array : arrays)
      for (double& x : array) x = drawn(random, rounded);
    const std::vector<CoordinateArray> three = {{arrays[0].data()}, {arrays[1].data()}, {arrays[2].data()}};
    const CurvedPoints points(100, three);
    EXPECT_EQ(points.pitch(), 4U);
    const auto address = rounded ? reinterpret_cast<std::uintptr_t>(points.floats())
                                 : reinterpret_cast<std::uintptr_t>(points.doubles());
    EXPECT_EQ(address % (rounded ? 16 : 32), 0U);
  }
}

/// Curved coordinates of axes along these axes: indices, times 1e4 with a remainder that float may not represent.
template <int N>
std::vector<CurvedAxis> random_axes(const Grid<N>& grid, const std::array<unsigned, N>& along, bool rounded) {
  std::mt19937 random(17);
  std::vector<CurvedAxis> curved;
  for (int axis = 0; axis < N; ++axis) {
    if (along[axis] == 0) continue;
    std::array<std::size_t, N> sizes;
    std::size_t count = 1;
    for (int a = 0; a < N; ++a) count *= sizes[a] = (along[axis] >> a & 1u) != 0 ? grid.axes[a].size() : 1;
    CurvedAxis& one = curved.emplace_back(CurvedAxis{axis, along[axis], {}, "coordinate", "m"});
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t index = i;
      for (int a = 0; a < axis; ++a) index /= sizes[a];
      const double x = 1e4 * (static_cast<double>(index % sizes[axis]) + 0.3 * drawn(random, false) / 5e6);
      one.values.push_back(rounded ? std::round(x) : x);
    }
  }
  return curved;
}

/// Expects the vertices on edges of a grid of indices between both samples, by their share of the edge, in double. In
/// 4D, other vertices are inside cells.
template <class Real, int N>
void expect_between_samples(const Contour<N, Real>& indexed, const Contour<N, Real>& moved,
                            const std::array<std::size_t, N>& sizes, const std::vector<CurvedAxis>& curved) {
  ASSERT_EQ(moved.vertices.size(), indexed.vertices.size());
  std::size_t on_edges = 0;
  for (std::size_t v = 0; v < indexed.vertices.size(); ++v) {
    std::size_t first = 0, second = 0, axes = 0;
    double share = 0.0;
    for (std::size_t a = N; a-- > 0;) {
      const auto index = static_cast<double>(indexed.vertices[v][a]), floor = std::floor(index);
      first = first * sizes[a] + static_cast<std::size_t>(floor);
      second = second * sizes[a] + static_cast<std::size_t>(std::ceil(index));
      share += index - floor;
      axes += index != floor ? 1 : 0;
    }
    if (axes > 1) continue;
    ++on_edges;
    for (std::size_t a = 0; a < N; ++a) {
      const double place = (1.0 - share) * curved[a].values[first] + share * curved[a].values[second];
      ASSERT_EQ(moved.vertices[v][a], static_cast<Real>(place)) << v;
    }
  }
  EXPECT_GT(on_edges, N == 4 ? 1000 : indexed.vertices.size() - 1);
}

template <class Real, int N>
void expect_places_on_edges(const std::array<std::size_t, N>& sizes) {
  const OwnedImage<double, N> image = noise<N>(sizes);
  std::array<unsigned, N> along;
  along.fill((1u << N) - 1);
  const Contour<N, Real> indexed = extract<Real>(image.view(), 0.5);
  for (const bool rounded : {true, false}) {
    const std::vector<CurvedAxis> curved = random_axes<N>(image.grid, along, rounded);
    const std::vector<CurvedAxis> points = by_points(curved);
    EXPECT_EQ(points[0].points.floats() != nullptr, rounded);
    expect_between_samples<Real, N>(indexed, on_curved_grid<Real>(indexed, image.grid, curved), sizes, curved);
    expect_between_samples<Real, N>(indexed, on_curved_grid<Real>(indexed, image.grid, points), sizes, curved);
  }
}

TEST(CurvedPoints, VerticesOnEdgesAreBetweenBothSamplesInDouble) {
  expect_places_on_edges<float, 2>({37, 41});
  expect_places_on_edges<double, 2>({37, 41});
  expect_places_on_edges<float, 3>({33, 21, 35});
  expect_places_on_edges<double, 3>({33, 21, 35});
  expect_places_on_edges<float, 4>({9, 8, 7, 8});
  expect_places_on_edges<double, 4>({9, 8, 7, 8});
}

TEST(CurvedPoints, OfTheCallersArrays) {
  const auto separate = random_axes<3>(Grid<3>::unit({9, 8, 7}), {7, 7, 7}, false);
  const std::size_t count = separate[0].values.size();
  std::vector<double> together;
  for (std::size_t i = 0; i < count; ++i)
    for (const CurvedAxis& one : separate) together.push_back(one.values[i]);
  std::vector<CurvedAxis> curved;
  std::vector<CoordinateArray> arrays;
  for (int a = 0; a < 3; ++a) {
    curved.push_back({a, 7, {}, "coordinate", "m"});
    arrays.push_back({together.data() + a, 3});
  }
  const std::vector<std::size_t> sizes(3, count);
  EXPECT_EQ(by_points(curved, arrays, sizes), separate);
  EXPECT_EQ(by_points(by_points(separate)), separate);
  EXPECT_NE(by_points(curved, arrays, std::vector<std::size_t>(3, count - 1)), separate);
  arrays.pop_back();
  expect_error(ErrorCode::InvalidArgument, "2 arrays of coordinates and 3 sizes; expected 3, one for each curved axis",
               [&] { (void)by_points(curved, arrays, sizes); });
}

template <class Real, int N>
void expect_the_contour_of_arrays(const OwnedImage<double, N>& image, const std::vector<CurvedAxis>& curved,
                                  std::vector<CurvedSeam<N>> seams = {}) {
  const std::vector<CurvedAxis> points = by_points(curved);
  ASSERT_EQ(points, curved);
  for (const CurvedAxis& one : points) EXPECT_TRUE(one.values.empty());
  EXPECT_EQ(find_folds<N>(image.grid, points, {}, seams), find_folds<N>(image.grid, curved, {}, seams));
  EXPECT_EQ(longitude_axes<N>(image.grid, points), longitude_axes<N>(image.grid, curved));
  for (const bool close : {false, true})
    for (const Ambiguity ambiguity : {Ambiguity::low, N == 4 ? Ambiguity::mean : Ambiguity::saddle}) {
      ExtractOptions options{.ambiguity = ambiguity, .close = close, .normals = Normals::differences};
      const auto expected = extract_curved<Real>(image.view(), curved, 0.5, options, seams);
      ASSERT_GT(expected.vertices.size(), 100U);
      for (const unsigned threads : {1u, 3u}) {
        options.work.threads = threads;
        const auto contour = extract_curved<Real>(image.view(), points, 0.5, options, seams);
        EXPECT_EQ(contour.vertices, expected.vertices);
        EXPECT_EQ(contour.normals, expected.normals);
        EXPECT_EQ(contour.simplices, expected.simplices);
        EXPECT_EQ(contour.axis_units, expected.axis_units);
      }
    }
}

template <int N>
void expect_contours_by_points(const std::array<std::size_t, N>& sizes,
                               const std::vector<std::array<unsigned, N>>& all_along) {
  OwnedImage<double, N> image = noise<N>(sizes);
  image.grid.axes[N - 1] = Axis::uniform(sizes[N - 1], 2.0, 0.5);
  for (std::size_t i = 0; i < image.values.size(); i += 97) image.values[i] = std::numeric_limits<double>::quiet_NaN();
  for (const auto& along : all_along)
    for (const bool rounded : {true, false}) {
      const std::vector<CurvedAxis> curved = random_axes<N>(image.grid, along, rounded);
      expect_the_contour_of_arrays<float>(image, curved);
      expect_the_contour_of_arrays<double>(image, curved);
    }
}

TEST(CurvedPoints, ContoursHaveTheBytesOfThoseOnArrays) {
  expect_contours_by_points<2>({40, 31}, {{3, 3}, {3, 0}, {0, 3}});
  expect_contours_by_points<3>({13, 9, 10}, {{7, 7, 7}, {3, 3, 0}, {3, 3, 7}, {7, 0, 7}, {0, 6, 6}});
  expect_contours_by_points<4>({5, 5, 4, 4}, {{15, 15, 15, 15}, {7, 7, 7, 0}, {15, 15, 15, 0}, {3, 3, 12, 12}});
}

TEST(CurvedPoints, ContinueAcrossSeams) {
  // closed by the places of the first samples, and by a vector that float adds exactly, or not
  for (const double period : {0.0, 131072.0, 0.1})
    for (const bool rounded : {true, false}) {
      const OwnedImage<double, 3> image = noise<3>({9, 8, 7});
      const std::vector<CurvedAxis> curved = random_axes<3>(image.grid, {7, 7, 7}, rounded);
      for (const int axis : {0, 1, 2}) {
        CurvedSeam<3> seam{axis, {}};
        seam.vector[axis] = period;
        expect_the_contour_of_arrays<double, 3>(image, curved, {seam});
      }
      expect_the_contour_of_arrays<float, 3>(image, curved, {{0, {}}, {2, {}}});
    }
}

TEST(CurvedPoints, SomeColumnsOnlyOrInAnotherOrder) {
  const OwnedImage<double, 3> image = noise<3>({9, 8, 7});
  const std::vector<CurvedAxis> separate = random_axes<3>(image.grid, {7, 7, 7}, false), points = by_points(separate);
  const auto swapped = [](std::vector<CurvedAxis> curved) {
    std::swap(curved[0].axis, curved[2].axis);
    return curved;
  };
  const auto without = [](std::vector<CurvedAxis> curved) {
    curved.erase(curved.begin() + 1);
    return curved;
  };
  EXPECT_EQ(extract_curved<double>(image.view(), swapped(points), 0.5).vertices,
            extract_curved<double>(image.view(), swapped(separate), 0.5).vertices);
  EXPECT_EQ(extract_curved<double>(image.view(), without(points), 0.5).vertices,
            extract_curved<double>(image.view(), without(separate), 0.5).vertices);
  auto wrong = points;
  wrong[1].column = 3;
  expect_error(ErrorCode::InvalidGrid, "column 3 of the points for axis 1; expected a number below 3",
               [&] { (void)extract_curved(image.view(), wrong, 0.5); });
}

/// The coordinates of all axes side by side, those of axis 0 first or last, and `pitch` numbers from a sample to the
/// next one. The memory ends behind the last coordinate.
template <class T>
std::vector<T> side_by_side(const std::vector<CurvedAxis>& curved, std::size_t pitch, bool descends) {
  const std::size_t columns = curved.size(), samples = curved[0].size();
  std::vector<T> numbers(pitch * (samples - 1) + columns, T{7});
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t i = 0; i < samples; ++i)
      numbers[pitch * i + (descends ? columns - 1 - c : c)] = static_cast<T>(curved[c].values[i]);
  numbers.shrink_to_fit();
  return numbers;
}

template <class T, class Real, int N>
void expect_contours_in_place(const std::array<std::size_t, N>& sizes) {
  const OwnedImage<double, N> image = noise<N>(sizes);
  std::array<unsigned, N> along;
  along.fill((1u << N) - 1);
  const std::vector<CurvedAxis> separate = random_axes<N>(image.grid, along, std::is_same_v<T, float>);
  const auto expected = extract_curved<Real>(image.view(), separate, 0.5, {.normals = Normals::differences});
  for (const std::size_t pitch : {std::size_t{N}, std::size_t{4}, std::size_t{7}})
    for (const bool descends : {false, true})
      for (const std::size_t columns : {std::size_t{1}, std::size_t{N}}) {
        const std::vector<T> numbers = side_by_side<T>(separate, pitch, descends);
        std::vector<CurvedAxis> curved = separate;
        for (std::size_t c = 0; c < N; ++c) {
          const std::size_t column = descends ? N - 1 - c : c;
          curved[c].values.clear();
          curved[c].column = columns == 1 ? 0 : static_cast<unsigned>(column);
          const T* const first = numbers.data() + (columns == 1 ? column : 0);
          curved[c].points = CurvedPoints::in_place(first, separate[0].size(), columns, pitch);
        }
        EXPECT_EQ(curved, separate);
        const auto contour = extract_curved<Real>(image.view(), curved, 0.5, {.normals = Normals::differences});
        EXPECT_EQ(contour.vertices, expected.vertices) << pitch << " " << descends << " " << columns;
        EXPECT_EQ(contour.normals, expected.normals);
        EXPECT_EQ(contour.simplices, expected.simplices);
        EXPECT_EQ(find_folds<N>(image.grid, curved), find_folds<N>(image.grid, separate));
        const CurvedSeam<N> seam{N - 1, {}};
        const auto closed = extract_curved<Real>(image.view(), curved, 0.5, {}, std::span(&seam, 1));
        EXPECT_EQ(closed.vertices, extract_curved<Real>(image.view(), separate, 0.5, {}, std::span(&seam, 1)).vertices);
      }
}

TEST(CurvedPoints, InPlaceHaveTheBytesOfArrays) {
  expect_contours_in_place<float, float, 2>({20, 31});
  expect_contours_in_place<double, double, 2>({20, 31});
  expect_contours_in_place<float, float, 3>({13, 9, 10});
  expect_contours_in_place<float, double, 3>({13, 9, 10});
  expect_contours_in_place<double, float, 3>({13, 9, 10});
  expect_contours_in_place<double, double, 3>({13, 9, 10});
  expect_contours_in_place<float, float, 4>({5, 5, 4, 4});
  expect_contours_in_place<double, double, 4>({5, 5, 4, 4});
}

TEST(CurvedPoints, InPlaceKeepTheOwnerAndRefuseBadNumbers) {
  const auto owned = std::make_shared<std::vector<float>>(12, 1.0f);
  {
    const CurvedPoints points = CurvedPoints::in_place(owned->data(), 4, 3, 3, owned);
    EXPECT_EQ(owned.use_count(), 2);
    EXPECT_EQ(points.floats(), owned->data());
    EXPECT_EQ(points.pitch(), 3U);
  }
  EXPECT_EQ(owned.use_count(), 1);
  for (const auto& [columns, pitch] : {std::pair(0, 1), std::pair(5, 5), std::pair(3, 2)})
    expect_error(ErrorCode::InvalidArgument,
                 std::to_string(columns) + " coordinates, " + std::to_string(pitch) + " numbers apart",
                 [&, columns = columns, pitch = pitch] {
                   (void)CurvedPoints::in_place(owned->data(), 2, static_cast<std::size_t>(columns),
                                                static_cast<std::size_t>(pitch));
                 });
}

TEST(CurvedPoints, TwoAxesWithTheSameColumnAreErrors) {
  const OwnedImage<double, 3> image = noise<3>({9, 8, 7});
  auto curved = by_points(random_axes<3>(image.grid, {7, 7, 7}, false));
  curved[2].column = 0;
  const std::string message =
      "the curved coordinates of axis 0 and of axis 2 are the same numbers in memory; expected coordinates of its own "
      "for each axis";
  expect_error(ErrorCode::InvalidGrid, message, [&] { (void)extract_curved(image.view(), curved, 0.5); });
  expect_error(ErrorCode::InvalidGrid, message, [&] { (void)find_seams(image.grid, curved, std::array{0}); });
  // copies of the numbers are not the same memory, and flat in each cell
  auto separate = random_axes<3>(image.grid, {7, 7, 7}, false);
  separate[2].values = separate[0].values;
  EXPECT_EQ(find_folds<3>(image.grid, separate).cells, 8U * 7U * 6U);
}

TEST(CurvedPoints, OneArrayMayBeTheCoordinatesAlongTwoAxes) {
  const OwnedImage<double, 2> image = noise<2>({31, 31});
  std::vector<double> values(31);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.1 * static_cast<double>(i * i);
  const std::vector<CurvedAxis> separate = {{0, 1, values}, {1, 2, values}};
  std::vector<CurvedAxis> shared = {{0, 1}, {1, 2}};
  for (CurvedAxis& one : shared) one.points = CurvedPoints::in_place(values.data(), values.size(), 1, 1);
  expect_the_contour_of_arrays<double>(image, shared);
  const std::vector<CurvedSeam<2>> seams = {{0, {100.0, 0.0}}, {1, {0.0, 101.0}}};
  const auto contour = extract_curved<double>(image.view(), shared, 0.5, {}, seams);
  EXPECT_EQ(contour.vertices, extract_curved<double>(image.view(), separate, 0.5, {}, seams).vertices);
}

TEST(CurvedPoints, ObjectsThatBeginWithTheSameNumberContinueAcrossSeamsOneByOne) {
  // A column of points of another pitch than the other's begins at the same number, but is another coordinate.
  const OwnedImage<double, 2> image = noise<2>({9, 8});
  std::vector<double> numbers(3 * 72);
  std::mt19937 random(3);
  for (double& x : numbers) x = drawn(random, false);
  std::vector<CurvedAxis> curved = {{0, 3}, {1, 3}};
  curved[0].points = CurvedPoints::in_place(numbers.data(), 72, 1, 1);
  curved[1].points = CurvedPoints::in_place(numbers.data(), 72, 1, 3);
  std::vector<CurvedAxis> separate = {{0, 3}, {1, 3}};
  for (std::size_t i = 0; i < 72; ++i) {
    separate[0].values.push_back(numbers[i]);
    separate[1].values.push_back(numbers[3 * i]);
  }
  for (const std::vector<CurvedSeam<2>>& seams :
       {std::vector<CurvedSeam<2>>{}, std::vector<CurvedSeam<2>>{{0, {1.0, 2.0}}, {1, {4.0, -3.0}}}}) {
    const auto contour = extract_curved<double>(image.view(), curved, 0.5, {}, seams);
    EXPECT_EQ(contour.vertices, extract_curved<double>(image.view(), separate, 0.5, {}, seams).vertices);
  }
}

TEST(CurvedPoints, AreSideBySideBehindSeamsToo) {
  // each coordinate as an object of its own, as Python's arrays are
  const Grid<3> grid = Grid<3>::unit({9, 8, 7});
  const std::vector<CurvedAxis> separate = random_axes<3>(grid, {7, 7, 7}, false);
  for (const bool descends : {false, true}) {
    const std::vector<double> numbers = side_by_side<double>(separate, 3, descends);
    std::vector<CurvedAxis> curved = separate;
    for (std::size_t c = 0; c < 3; ++c) {
      curved[c].values.clear();
      curved[c].points = CurvedPoints::in_place(numbers.data() + (descends ? 2 - c : c), separate[c].size(), 1, 3);
    }
    const std::vector<CurvedSeam<3>> seams = {{1, {1.0, 2.0, 3.0}}, {0, {0.5, 0.0, -1.0}}};
    const auto longer = detail::longer_curved<3>(grid, curved, seams);
    EXPECT_EQ(longer.curved, detail::longer_curved<3>(grid, separate, seams).curved);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_TRUE(longer.curved[c].points.is_same_memory(longer.curved[0].points));
      EXPECT_EQ(longer.curved[c].column, descends ? 2 - c : c);
    }
  }
}

TEST(CurvedPoints, NumbersBetweenSamplesAreNotRead) {
  // Points and their values: the contour needs no coordinate that is not known, as NaN is beside each sample.
  const OwnedImage<double, 3> image = noise<3>({13, 9, 10});
  const std::vector<CurvedAxis> separate = random_axes<3>(image.grid, {7, 7, 7}, true);
  const std::size_t samples = separate[0].size();
  const auto expected = extract_curved<double>(image.view(), separate, 0.5);
  for (const bool descends : {false, true}) {
    std::vector<float> numbers(4 * samples + 4, std::numeric_limits<float>::quiet_NaN());
    float* const first = numbers.data() + (16 - reinterpret_cast<std::uintptr_t>(numbers.data()) % 16) % 16 / 4;
    for (std::size_t i = 0; i < samples; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        first[4 * i + (descends ? 2 - c : c)] = static_cast<float>(separate[c].values[i]);
    std::vector<CurvedAxis> curved = separate;
    for (std::size_t c = 0; c < 3; ++c) {
      curved[c].values.clear();
      curved[c].column = static_cast<unsigned>(descends ? 2 - c : c);
      curved[c].points = CurvedPoints::in_place(static_cast<const float*>(first), samples, 3, 4);
    }
    detail::CurvedArrays arrays;
    arrays.are_floats = true;
    arrays.pitch = 4;
    for (std::size_t c = 0; c < 3; ++c) arrays.add(curved[c].points.floats() + curved[c].column, c);
    arrays.find_columns(3);
    ASSERT_FALSE(arrays.may_be_in_two_lines);
    detail::CurvedBlock::Ends ends;
    for (std::size_t i = 0; i < ends.first.size(); ++i)
      ends.first[i] = ends.second[i] = static_cast<std::int64_t>(4 * i);
    detail::CurvedBlock::Points<double> out{};
    EXPECT_TRUE(detail::interpolate(arrays, ends, ends.first.size(), ends, 0, 3, out.data()));
    EXPECT_EQ(extract_curved<double>(image.view(), curved, 0.5).vertices, expected.vertices);
  }
}

TEST(CurvedSeams, StraightLongitudesAreFoundIn5d) {
  Grid<5> grid = Grid<5>::unit({3, 8, 4, 3, 3});
  grid.axes[1] = Axis::uniform(8, -170.0, 45.0);
  for (const char* const unit : {"degrees_east", "degreeE"}) {
    EXPECT_TRUE(is_longitude_unit(unit));
    grid.axes[1].unit = unit;
    EXPECT_EQ(longitude_axes<5>(grid), std::vector<int>{1});
  }
  EXPECT_FALSE(is_longitude_unit("degrees_north"));
  grid.axes[1].unit = "degrees_north";
  EXPECT_EQ(longitude_axes<5>(grid), std::vector<int>{});
  const std::vector<CurvedAxis> curved = {{0, 1, {0.0, 1.0, 2.0}}};
  expect_error(ErrorCode::InvalidGrid, "a curved grid in 5D; expected 2 to 4 dimensions",
               [&] { (void)longitude_axes<5>(grid, curved); });
}

/// The folded cells of a grid, by their corners' orientations, one by one.
template <int N>
GridFolds<N> folds_one_by_one(const Grid<N>& grid, const std::vector<CurvedAxis>& curved) {
  const auto place = [&](const std::array<std::size_t, N>& index) {
    Eigen::Matrix<double, N, 1> x;
    for (int c = 0; c < N; ++c) x(c) = static_cast<double>(index[c]);
    for (const CurvedAxis& one : curved) {
      std::size_t at = 0;
      for (std::size_t a = N; a-- > 0;)
        if ((one.along >> a & 1u) != 0) at = at * grid.axes[a].size() + index[a];
      x(one.axis) = one[at];
    }
    return x;
  };
  GridFolds<N> found;
  std::size_t cells = 1;
  for (const Axis& axis : grid.axes) cells *= axis.size() - 1;
  for (std::size_t number = 0; number < cells; ++number) {
    std::array<std::size_t, N> cell;
    for (std::size_t a = 0, rest = number; a < N; rest /= grid.axes[a++].size() - 1)
      cell[a] = rest % (grid.axes[a].size() - 1);
    bool known = true, folded = false;
    for (unsigned corner = 0; corner < 1u << N; ++corner) {
      Eigen::Matrix<double, N, N> edges;
      for (int a = 0; a < N; ++a) {
        std::array<std::size_t, N> low = cell;
        for (int b = 0; b < N; ++b) low[b] += b != a ? corner >> b & 1u : 0u;
        std::array<std::size_t, N> high = low;
        ++high[a];
        edges.col(a) = place(high) - place(low);
      }
      const double determinant = edges.determinant();
      known = known && !std::isnan(determinant);
      folded = folded || !(determinant > 0.0);
    }
    if (!known || !folded) continue;
    if (found.cells++ == 0) found.first = cell;
  }
  return found;
}

template <int N>
void expect_folds(const std::array<std::size_t, N>& sizes, const std::array<unsigned, N>& along, double disorder) {
  const Grid<N> grid = Grid<N>::unit(sizes);
  std::mt19937 random(29);
  std::vector<CurvedAxis> curved = random_axes<N>(grid, along, true);
  for (CurvedAxis& one : curved)
    for (double& x : one.values) {
      x = std::round(x * 1e-4) + std::uniform_real_distribution<>(-disorder, disorder)(random);
      if (random() % 53 == 0) x = std::numeric_limits<double>::quiet_NaN();
    }
  const GridFolds<N> expected = folds_one_by_one<N>(grid, curved);
  for (const unsigned threads : {1u, 3u}) {
    EXPECT_EQ(find_folds<N>(grid, curved, {threads, {}}).cells, expected.cells);
    EXPECT_EQ(find_folds<N>(grid, curved, {threads, {}}).first, expected.first);
    EXPECT_EQ(find_folds<N>(grid, by_points(curved), {threads, {}}), find_folds<N>(grid, curved));
  }
  if (disorder > 0.4) {
    EXPECT_GT(expected.cells, 0U);
  }
}

TEST(CurvedPoints, FoldsAreThoseOfTheCornersOneByOne) {
  for (const double disorder : {0.0, 0.2, 0.6}) {
    expect_folds<2>({40, 31}, {3, 3}, disorder);
    expect_folds<2>({25, 14}, {3, 0}, disorder);
    expect_folds<3>({21, 9, 10}, {7, 7, 7}, disorder);
    expect_folds<3>({21, 9, 10}, {3, 3, 7}, disorder);
    expect_folds<3>({6, 19, 10}, {5, 6, 7}, disorder);  // the second one does not differ along axis 0
    expect_folds<4>({14, 6, 5, 4}, {15, 15, 15, 15}, disorder);
    expect_folds<4>({6, 13, 5, 4}, {7, 7, 14, 0}, disorder);
  }
}

TEST(CurvedPoints, UnknownCoordinatesAreErrorsOnlyAtTheContour) {
  const OwnedImage<double, 3> image = distances();
  for (const bool rounded : {true, false}) {
    auto curved = random_axes<3>(image.grid, {7, 7, 7}, rounded);
    curved[1].values[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(extract_curved(image.view(), by_points(curved), 3.0).simplices.empty());
    // at the sample (1, 4, 4), beside the contour
    curved[2].values[(4 * 9 + 4) * 9 + 1] = std::numeric_limits<double>::infinity();
    for (const unsigned threads : {1u, 3u}) {
      ExtractOptions options;
      options.work.threads = threads;
      expect_error(ErrorCode::UnsupportedData, ", 4, 4), which has unknown coordinates; expected missing values there",
                   [&] { (void)extract_curved(image.view(), by_points(curved), 2.7, options); });
    }
  }
}

TEST(CurvedPoints, LargeCoordinatesAreNotUnknown) {
  // Infinite as float, so the vertices' rounded coordinates do not show which are known.
  const OwnedImage<double, 3> image = distances();
  auto curved = random_axes<3>(image.grid, {7, 7, 7}, false);
  for (double& x : curved[0].values) x *= 1e300;
  const auto contour = extract_curved<float>(image.view(), by_points(curved), 2.7);
  EXPECT_TRUE(std::isinf(contour.vertices.front()[0]));
  EXPECT_TRUE(std::isfinite(contour.vertices.front()[1]));
}

}  // namespace
}  // namespace tegl
