// SPDX-License-Identifier: BSD-3-Clause
//
// Operations on embedded contours whose results are embedded, too: the table "Operations on a contour" of
// docs/embedding.md, by the exact test of tegl/intersections.hpp. Contours with missing values may touch themselves.
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "tegl/components.hpp"
#include "tegl/extract.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/intersections.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

struct Way {
  std::string name;
  ExtractOptions options;
};

/// Ways to extract a contour, in both triangulations.
std::vector<Way> ways_of(std::initializer_list<Ambiguity> ambiguities) {
  std::vector<Way> result;
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : ambiguities) {
      Way way;
      way.options.ambiguity = ambiguity;
      way.options.triangulation = triangulation;
      way.name = "ambiguity " + std::to_string(static_cast<int>(ambiguity)) +
                 (triangulation == Triangulation::compact ? ", compact" : ", barycentric");
      result.push_back(way);
    }
  return result;
}

template <int N, class Real>
void expect_embedded(const Contour<N, Real>& contour, const std::string& name) {
  EXPECT_GT(contour.simplices.size(), 20u) << name << ": tests nothing";
  const auto found = find_intersections(contour);
  EXPECT_TRUE(found.is_embedded()) << name << ": " << found.pair_count << " pairs, depth " << found.depth << ", "
                                   << found.flat << " flat simplices";
}

/// Balls that are near each other and move: a smooth field.
OwnedImage<double, 4> moving_balls() {
  Grid<4> grid = centred_grid<4>(7, 1.0);
  return sample_field<double, 4>(grid, [](const Point<4>& x) {
    const double first = std::hypot(x[0] - 0.4 - 0.15 * x[3], x[1] + 0.13, x[2] - 0.07);
    const double second = std::hypot(x[0] + 0.37 + 0.11 * x[3], x[1] - 0.17 * x[3], x[2] + 0.23);
    return std::max(0.43 - first, 0.51 - second) + 0.03 * x[3];
  });
}

/// The slice and two slices of it.
void expect_embedded_slices(const Contour<4, double>& contour, const Hyperplane<4>& hyperplane,
                            const std::string& name) {
  const Contour<3, double> surface = slice(contour, hyperplane);
  expect_embedded(surface, name);
  Point<3> low = surface.vertices.at(0), high = low;
  for (const auto& vertex : surface.vertices)
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], vertex[a]);
      high[a] = std::max(high[a], vertex[a]);
    }
  const Point<3> middle{0.53 * low[0] + 0.47 * high[0], 0.48 * low[1] + 0.52 * high[1], 0.5 * (low[2] + high[2])};
  expect_embedded(slice(surface, Hyperplane<3>::across(0, middle[0])), name + ", sliced across x");
  const Vector<3> normal{0.41, -0.37, 0.83};
  const double offset = std::inner_product(normal.begin(), normal.end(), middle.begin(), 0.0);
  expect_embedded(slice(surface, Hyperplane<3>{normal, offset}), name + ", oblique slice");
}

void expect_embedded_slices(const OwnedImage<double, 4>& image, double isovalue, const std::vector<double>& times,
                            const Hyperplane<4>& oblique, const std::string& name) {
  for (const Way& way : ways_of({Ambiguity::low, Ambiguity::saddle})) {
    const auto contour = extract<double>(image.view(), isovalue, way.options);
    for (const double time : times)
      expect_embedded_slices(contour, Hyperplane<4>::across(3, time),
                             name + ", " + way.name + ", t " + std::to_string(time));
    expect_embedded_slices(contour, oblique, name + ", " + way.name + ", oblique");
  }
}

TEST(OperationsEmbedded, SlicesOfNoise) {
  expect_embedded_slices(noise<double, 4>(6, 41), 0.5, {0.27, 1.5, 3.83}, {{0.31, -0.42, 0.23, 0.77}, 2.21}, "noise");
}

TEST(OperationsEmbedded, SlicesOfMovingBalls) {
  expect_embedded_slices(moving_balls(), 0.0, {-0.71, -0.05, 0.62}, {{0.31, -0.12, 0.23, 0.77}, 0.05}, "balls");
}

// Whole numbers as samples: an eighth of them equal the isovalue.
template <int N>
void expect_embedded_with_epsilon(std::size_t samples) {
  auto image = noise<double, N>(samples, 42);
  for (double& value : image.values) value = std::floor(8.0 * value);
  for (Way way : ways_of({Ambiguity::low, Ambiguity::saddle})) {
    const std::string name = std::to_string(N) + "D, " + way.name;
    EXPECT_FALSE(find_intersections(extract<double>(image.view(), 4.0, way.options)).is_embedded()) << name;
    way.options.epsilon = 0.01;
    expect_embedded(extract<double>(image.view(), 4.0, way.options), name);
  }
}

TEST(OperationsEmbedded, SamplesAtTheIsovalueWithEpsilon) {
  expect_embedded_with_epsilon<2>(24);
  expect_embedded_with_epsilon<3>(9);
  expect_embedded_with_epsilon<4>(5);
}

/// `spread` > 0: the distances from the isovalue 0.5 are distributed log-uniformly over that many powers of ten.
template <int N>
void expect_embedded_with_caps(std::size_t samples, unsigned seed = 43, double spread = 0.0) {
  auto image = noise<double, N>(samples, seed);
  for (double& value : image.values)
    if (spread > 0.0) value = 0.5 + std::copysign(std::pow(10.0, -spread * std::abs(2.0 * value - 1.0)), value - 0.5);
  for (Way way : ways_of({Ambiguity::low, Ambiguity::high, Ambiguity::mean, Ambiguity::saddle})) {
    const std::string name = std::to_string(N) + "D, " + way.name;
    const std::size_t open = extract<double>(image.view(), 0.5, way.options).simplices.size();
    way.options.close = true;
    const auto closed = extract<double>(image.view(), 0.5, way.options);
    EXPECT_GT(closed.simplices.size(), open) << name << ": tests nothing";
    expect_embedded(closed, name);
  }
}

TEST(OperationsEmbedded, Caps) {
  expect_embedded_with_caps<2>(24);
  expect_embedded_with_caps<3>(10);
}

TEST(OperationsEmbedded, CapsIn4D) {
  for (const unsigned seed : {43u, 46u, 47u})
    for (const double spread : {0.0, 3.0}) expect_embedded_with_caps<4>(5, seed, spread);
}

// Zeros and ones, with equal values everywhere: the contour's vertices are in the middle of edges, or near samples.
TEST(OperationsEmbedded, CapsOfMasksIn4D) {
  auto image = noise<double, 4>(5, 48);
  for (double& value : image.values) value = value < 0.5 ? 0.0 : 1.0;
  for (Way way : ways_of({Ambiguity::low, Ambiguity::high, Ambiguity::mean, Ambiguity::saddle}))
    for (const double isovalue : {0.5, 1.0}) {
      way.options.close = true;
      way.options.epsilon = 0.02;
      expect_embedded(extract<double>(image.view(), isovalue, way.options), "mask, " + way.name);
    }
}

TEST(OperationsEmbedded, SelectedComponents) {
  for (const Way& way : ways_of({Ambiguity::low, Ambiguity::saddle})) {
    const auto contour = extract<double>(view_of(noise<double, 4>(6, 44)), 0.75, way.options);
    const ComponentLabels labels = label_components(contour);
    ASSERT_GT(labels.count, 3u);
    std::vector<bool> keep(labels.count);
    for (std::size_t i = 0; i < keep.size(); i += 2) keep[i] = true;
    expect_embedded(select_components(contour, labels, keep), way.name);
  }
}

template <int N>
void expect_embedded_with_scaled_axes(std::size_t samples) {
  auto image = noise<double, N>(samples, 45);
  for (int a = 0; a < N; ++a)
    image.grid.axes[a] = Axis::uniform(samples, 17.3 * a - 5.1, std::pow(0.07, a - 1) * (a == 1 ? -1.1 : 1.3));
  for (const Way& way : ways_of({Ambiguity::low, Ambiguity::saddle})) {
    const std::string name = std::to_string(N) + "D, " + way.name;
    auto contour = extract<double>(image.view(), 0.5, way.options);
    expect_embedded(contour, name + ", axes of different steps");
    Vector<N> factors;
    for (int a = 0; a < N; ++a) factors[a] = 0.3 + 1.7 * a;
    expect_embedded(scale_axes(std::move(contour), factors), name + ", scaled");
  }
}

TEST(OperationsEmbedded, ScaledAxes) {
  expect_embedded_with_scaled_axes<2>(24);
  expect_embedded_with_scaled_axes<3>(9);
  expect_embedded_with_scaled_axes<4>(5);
}

TEST(OperationsEmbedded, ConversionToFloat) {
  for (const Way& way : ways_of({Ambiguity::low, Ambiguity::saddle})) {
    const auto image = noise<float, 4>(5, 46);
    expect_embedded(extract<float>(image.view(), 0.5, way.options), way.name + ", extracted");
    const auto exact = extract<double>(image.view(), 0.5, way.options);
    Contour<4, float> rounded;
    rounded.simplices = exact.simplices;
    for (const auto& vertex : exact.vertices) {
      std::array<float, 4> point;
      for (int a = 0; a < 4; ++a) point[a] = static_cast<float>(vertex[a]);
      rounded.vertices.push_back(point);
    }
    expect_embedded(rounded, way.name + ", converted");
  }
}

/// The cell of unit size that contains the centroid of a simplex.
template <int N>
std::array<double, N> cell_of(const Contour<N, double>& contour, Index simplex) {
  std::array<double, N> cell{};
  for (const Index v : contour.simplices[simplex])
    for (int a = 0; a < N; ++a) cell[a] += contour.vertices[v][a] / N;
  for (double& c : cell) c = std::floor(c);
  return cell;
}

/// The number of pairs, which all touch, and belong to different cells. Contours of cells that do not exist are missing
/// between them; a vertex or an edge that would have several sheets there is doubled.
template <int N>
std::uint64_t expect_touching_between_cells(std::size_t samples, double missing, const Way& way) {
  auto image = noise<double, N>(samples, 47);
  std::mt19937_64 bits(48);
  for (double& value : image.values)
    if (static_cast<double>(bits() >> 11) * 0x1p-53 < missing) value = std::numeric_limits<double>::quiet_NaN();
  const auto contour = extract<double>(image.view(), 0.5, way.options);
  const auto found = find_intersections(contour);
  for (const auto& pair : found.pairs) {
    EXPECT_NE(cell_of(contour, pair.first), cell_of(contour, pair.second))
        << N << "D, " << way.name << ": " << pair.first << " and " << pair.second;
  }
  EXPECT_EQ(found.depth, 0.0) << N << "D, " << way.name;
  return found.pair_count;
}

TEST(OperationsEmbedded, WithMissingValuesSheetsOfDifferentCellsMayTouch) {
  std::uint64_t surfaces = 0, solids = 0;
  for (const Way& way : ways_of({Ambiguity::low, Ambiguity::saddle})) {
    EXPECT_EQ(expect_touching_between_cells<2>(24, 0.1, way), 0u);
    surfaces += expect_touching_between_cells<3>(12, 0.15, way);
    solids += expect_touching_between_cells<4>(6, 0.08, way);
  }
  EXPECT_GT(surfaces, 0u);
  EXPECT_GT(solids, 0u);
}

}  // namespace
}  // namespace tegl::test
