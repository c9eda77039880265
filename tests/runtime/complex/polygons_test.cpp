// SPDX-License-Identifier: BSD-3-Clause
//
// Polygons in complexes, alone, with triangles and quadrilaterals, and over time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "compare.hpp"
#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "tegl/cell_index.hpp"
#include "tegl/complex.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using namespace test;

struct PlaneMesh {
  std::vector<std::array<double, 2>> points;
  std::vector<std::vector<Index>> cells;
  std::vector<bool> border;

  [[nodiscard]] Complex<2> complex() const {
    CellLists lists;
    for (const auto& cell : cells) {
      lists.types.push_back(cell.size() == 3 ? CellType::triangle : CellType::polygon);
      lists.corners.insert(lists.corners.end(), cell.begin(), cell.end());
      lists.ends.push_back(lists.corners.size());
    }
    return Complex<2>(points, lists);
  }
};

/// Hexagons that fill a square of about [-1, 1]^2; some are halved into two quadrilaterals, some into four triangles.
/// Points are moved; every third polygon is given in the other direction.
PlaneMesh honeycomb(int count, double jitter, std::uint64_t seed = 1) {
  PlaneMesh mesh;
  std::mt19937_64 random(seed);
  std::map<std::array<int, 2>, Index> numbers;  // in half edges along x, halves of the height along y
  const auto number = [&](int x, int y) {
    return numbers.try_emplace({x, y}, static_cast<Index>(numbers.size())).first->second;
  };
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const int x = 3 * i, y = 2 * j + i % 2;
      std::vector<Index> hexagon = {number(x + 2, y), number(x + 1, y + 1), number(x - 1, y + 1),
                                    number(x - 2, y), number(x - 1, y - 1), number(x + 1, y - 1)};
      if (random() % 3 == 0) std::reverse(hexagon.begin(), hexagon.end());
      const auto kind = random() % 4;
      const auto at = [&](std::initializer_list<std::size_t> of) {
        std::vector<Index> cell;
        for (const std::size_t v : of) cell.push_back(hexagon[v]);
        return cell;
      };
      if (kind == 0) {
        mesh.cells.push_back(at({0, 1, 2, 3}));
        mesh.cells.push_back(at({3, 4, 5, 0}));
      } else if (kind == 1) {
        for (std::size_t v = 1; v < 5; ++v) mesh.cells.push_back(at({0, v, v + 1}));
      } else {
        mesh.cells.push_back(hexagon);
      }
    }
  mesh.points.resize(numbers.size());
  const double scale = 2.0 / (3 * count), height = std::sqrt(3.0) / 2 * 2;
  for (const auto& [at, p] : numbers) {
    const auto shift = [&] { return jitter * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0); };
    mesh.points[p] = {scale * (at[0] + shift()) - 1.0, scale * (at[1] * height + shift()) - 1.0};
  }
  std::map<std::array<Index, 2>, int> uses;
  for (const auto& cell : mesh.cells)
    for (std::size_t v = 0; v < cell.size(); ++v) {
      const auto [p, q] = std::minmax(cell[v], cell[(v + 1) % cell.size()]);
      ++uses[{p, q}];
    }
  mesh.border.resize(mesh.points.size());
  for (const auto& [edge, used] : uses)
    if (used == 1) mesh.border[edge[0]] = mesh.border[edge[1]] = true;
  return mesh;
}

std::vector<double> noise(const PlaneMesh& mesh, std::uint64_t seed, bool is_closed) {
  std::mt19937_64 random(seed);
  std::vector<double> values;
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const double value = static_cast<double>(random() >> 11) * 0x1p-53;
    values.push_back(is_closed && mesh.border[p] ? -1.0 : value);
  }
  return values;
}

ExtractOptions with_rule(Ambiguity ambiguity, unsigned threads = 0) {
  ExtractOptions options;
  options.ambiguity = ambiguity;
  options.work.threads = threads;
  return options;
}

TEST(Polygons, NoiseOnAHoneycombHasClosedCurvesWithEveryRule) {
  const PlaneMesh mesh = honeycomb(40, 0.1);
  Complex<2> complex = mesh.complex();
  EXPECT_GT(detail::ComplexAccess::cells(complex).polytopes.size(), 500u);
  EXPECT_EQ(2u, detail::ComplexAccess::cells(complex).groups.size());
  complex.set_values(noise(mesh, 3, true));
  Complex<2> known = complex;
  known.find_edges();
  const CellIndex index(complex);
  for (const Ambiguity a : kAllRules) {
    const auto contour = extract(complex, 0.5, with_rule(a, 1));
    EXPECT_GT(contour.simplices.size(), 1000u);
    expect_closed_manifold(contour);
    EXPECT_GT(measure(contour).content.value(), 0.0);
    EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, with_rule(a)));
    for (const auto& other : {extract(complex, 0.5, with_rule(a, 3)), extract(known, 0.5, with_rule(a)),
                              extract(known, index, 0.5, with_rule(a))})
      EXPECT_TRUE(contour.vertices == other.vertices && contour.simplices == other.simplices);
  }
}

TEST(Polygons, CapsCloseCurvesAtTheBorder) {
  const PlaneMesh mesh = honeycomb(20, 0.1);
  Complex<2> complex = mesh.complex();
  complex.set_values(noise(mesh, 3, false));
  for (const Ambiguity a : kAllRules)
    for (const GradientDirection d : {GradientDirection::descent, GradientDirection::ascent}) {
      ExtractOptions options = with_rule(a);
      options.close = true;
      options.direction = d;
      expect_closed_manifold(extract(complex, 0.5, options));
    }
}

TEST(Polygons, ACircleHasItsLengthAndArea) {
  const PlaneMesh mesh = honeycomb(60, 0.1);
  Complex<2> complex = mesh.complex();
  std::vector<double> values;
  for (const auto& x : mesh.points) values.push_back(0.5 - std::hypot(x[0], x[1]));
  complex.set_values(values);
  const Measures<2> measures = measure(extract<double>(complex, 0.0));
  EXPECT_NEAR(std::numbers::pi, measures.size, 0.005);
  EXPECT_NEAR(std::numbers::pi * 0.25, measures.content.value(), 0.005);
}

/// A regular hexagon with three high corners: three segments around the high ones or around the low ones.
TEST(Polygons, AHexagonWithThreeHighCornersIsResolvedByTheMean) {
  CellLists lists{{CellType::polygon}, {0, 1, 2, 3, 4, 5}, {6}};
  std::vector<std::array<double, 2>> points;
  for (int i = 0; i < 6; ++i)
    points.push_back({std::cos(i * std::numbers::pi / 3), std::sin(i * std::numbers::pi / 3)});
  Complex<2> complex(points, lists);
  const auto cuts_corner_zero = [&](double high, Ambiguity a) {
    complex.set_values(std::vector<double>{high, -1, high, -1, high, -1});
    const auto contour = extract<double>(complex, 0.0, with_rule(a));
    EXPECT_EQ(3u, contour.simplices.size());
    // the segment from the edge 0-1 goes to 0-5 around corner 0, or to 1-2 around corner 1
    const auto& ends = contour.simplices;
    return std::any_of(ends.begin(), ends.end(), [&](const auto& s) {
      return contour.vertices[s[0]][1] * contour.vertices[s[1]][1] < 0 && contour.vertices[s[0]][0] > 0.4 &&
             contour.vertices[s[1]][0] > 0.4;
    });
  };
  for (const double high : {0.9, 1.1}) {
    EXPECT_TRUE(cuts_corner_zero(high, Ambiguity::low));
    EXPECT_FALSE(cuts_corner_zero(high, Ambiguity::high));
    for (const Ambiguity a : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider})
      EXPECT_EQ(high < 1, cuts_corner_zero(high, a));
  }
}

TEST(Polygons, MissingValuesLeaveCurvesWithEnds) {
  const PlaneMesh mesh = honeycomb(30, 0.1);
  Complex<2> complex = mesh.complex();
  std::vector<double> values = noise(mesh, 3, true);
  for (std::size_t p = 0; p < values.size(); p += 17) values[p] = std::numeric_limits<double>::quiet_NaN();
  complex.set_values(values);
  const auto contour = extract(complex, 0.5);
  EXPECT_GT(expect_oriented_manifold(contour).boundary_simplices, 20u);
}

/// Prisms over hexagons are polyhedra: hexagonal prisms beside wedges and hexahedra.
TEST(Polygons, OverTimeTheirContoursAreClosedAndSlicesAreThoseOfEachTime) {
  const PlaneMesh mesh = honeycomb(16, 0.1);
  const Complex<2> complex = mesh.complex();
  const std::vector<double> times = {0.0, 0.4, 1.0, 1.5};
  std::vector<double> values;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto layer =
        k == 0 || k + 1 == times.size() ? std::vector<double>(mesh.points.size(), -1.0) : noise(mesh, 10 + k, true);
    values.insert(values.end(), layer.begin(), layer.end());
  }
  const Complex<3> swept = in_time<2>(complex, times, values);
  EXPECT_GT(detail::ComplexAccess::cells(swept).polytopes.size(), 300u);
  for (const Ambiguity a : kAllRules) {
    const auto contour = extract<double>(swept, 0.5, with_rule(a));
    EXPECT_GT(contour.simplices.size(), 1000u);
    expect_closed_manifold(contour);
    Complex<2> at_time = complex;
    at_time.set_values(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(mesh.points.size()),
                                           values.begin() + static_cast<std::ptrdiff_t>(2 * mesh.points.size())));
    EXPECT_TRUE(
        same_surface(extract<double>(at_time, 0.5, with_rule(a)), slice(contour, Hyperplane<3>::across(2, times[1]))));
  }
}

TEST(Polygons, ErrorsNameTheCellAndWhatWasExpected) {
  const auto expect_refusal = [](const std::string& message, const std::vector<Index>& corners) {
    CellLists lists{{CellType::polygon}, corners, {corners.size()}};
    expect_error(ErrorCode::InvalidArgument, message,
                 [&] { Complex<2>(std::vector<std::array<double, 2>>(100), lists); });
  };
  expect_refusal("cell 0: a polygon of 2 corners; expected 3 to 64", {0, 1});
  expect_refusal("cell 0: corners 1 and 4 are both point 1; expected different points", {0, 1, 2, 3, 1});
  expect_refusal("cell 0: corner 3 is point 100; expected a number below 100", {0, 1, 2, 100, 4});
  std::vector<Index> many;
  for (Index i = 0; i < 65; ++i) many.push_back(i);
  expect_refusal("cell 0: a polygon of 65 corners; expected 3 to 64", many);
  many.resize(33);
  const Complex<2> complex(std::vector<std::array<double, 2>>(33), CellLists{{CellType::polygon}, many, {33}});
  expect_error(ErrorCode::InvalidArgument,
               "a polygon of 33 corners over time, with the points 0, 1, 2 and further ones; expected at most 32", [&] {
                 (void)in_time<2>(complex, std::vector<double>{0, 1}, std::vector<double>(66));
               });
}

}  // namespace
}  // namespace tegl
