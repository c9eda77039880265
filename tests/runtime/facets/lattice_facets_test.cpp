// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of images on lattices and of divided images, also with periodic axes: subdivided by the contours of
// `extract_lattice` and `extract_divided`, closed across the seam.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "complex/complex_cases.hpp"
#include "complex/lattice_image.hpp"
#include "errors.hpp"
#include "tegl/check.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/polygons.hpp"
#include "torus.hpp"

namespace tegl::test {
namespace {

/// A grid from 0 whose periods are 1 along all axes.
template <int N>
Grid<N> torus_grid(const std::array<std::size_t, N>& sizes) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(sizes[a], 0.0, 1.0 / static_cast<double>(sizes[a]));
  return grid;
}

/// Calls test(lattice, image of noise) for all lattices, with the fewest samples along periodic axes and with more.
template <class Test>
void for_each_noise(const Test& test) {
  const auto run = [&]<int N>(Lattice lattice, const std::array<std::size_t, N>& sizes) {
    SCOPED_TRACE(std::string(name_of(lattice)) + " " + std::to_string(sizes[0]));
    test(lattice, sampled_on_lattice<N>(lattice, torus_grid<N>(sizes), noise_everywhere<N>(5)));
  };
  run.template operator()<2>(Lattice::triangular, {3, 6});
  run.template operator()<2>(Lattice::triangular, {70, 8});
  run.template operator()<3>(Lattice::fcc, {3, 3, 6});
  run.template operator()<3>(Lattice::fcc, {6, 5, 8});
  run.template operator()<3>(Lattice::bcc, {3, 3, 6});
  run.template operator()<3>(Lattice::bcc, {6, 5, 8});
  run.template operator()<4>(Lattice::d4, {3, 4, 3, 6});
  run.template operator()<4>(Lattice::fcc_in_time, {3, 4, 6, 3});
}

template <int N>
std::size_t faults_of(const FacetHierarchy<N, double>& facets) {
  const FacetReport report = check(facets);
  return report.branching + report.conflicts + report.open_boundaries;
}

TEST(LatticeFacets, HaveTheTopologyOfTheContourForAllPeriods) {
  for_each_noise([]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    for (const Ambiguity rule : kAllRules)
      for (unsigned axes = 0; axes < 1u << N; ++axes)
        for (const bool close : {false, true}) {
          if (N == 4 && (axes % 5 != 0 || (rule != Ambiguity::low && rule != Ambiguity::mean))) continue;
          SCOPED_TRACE(testing::Message() << "rule " << static_cast<int>(rule) << ", axes " << axes << " " << close);
          ExtractOptions options;
          options.ambiguity = rule;
          options.close = close;
          options.normals = Normals::differences;
          options.direction = close ? GradientDirection::ascent : GradientDirection::descent;
          const AxisPeriods<N> periods = periodic_along<N>(axes);
          const auto facets = extract_facets<double>(image.view(), lattice, 0.5, options, periods);
          const auto contour = extract_lattice<double>(image.view(), lattice, 0.5, options, periods);
          const FacetReport report = check(facets);
          const MeshReport expected = check(contour);
          EXPECT_EQ(0u, faults_of(facets));
          EXPECT_EQ(expected.euler, report.euler);
          EXPECT_EQ(expected.components, report.components);
          EXPECT_EQ(expected.boundary_simplices == 0, report.border == 0);
          EXPECT_EQ(report.border == 0, close || axes == (1u << N) - 1);
          EXPECT_EQ(contour.periods, facets.periods);
          // the points are vertices of the contour, with their normals
          ASSERT_EQ(facets.vertices.size(), facets.normals.size());
          std::set<std::pair<std::array<double, N>, std::array<double, N>>> vertices;
          for (std::size_t v = 0; v < contour.vertices.size(); ++v)
            vertices.emplace(contour.vertices[v], contour.normals[v]);
          for (std::size_t p = 0; p < facets.vertices.size(); ++p)
            EXPECT_TRUE(vertices.contains({facets.vertices[p], facets.normals[p]})) << p;
          for (const FacetPlace& place : facets.levels[N - 1].places) EXPECT_LT(place.base, facets.cells);
        }
  });
}

/// Without periods they are the facets of the lattice's cells.
TEST(LatticeFacets, WithoutPeriodsAreThoseOfTheirCells) {
  for_each_noise([]<int N>(Lattice lattice, OwnedImage<double, N> image) {
    image.grid.axes[0].name = "along";
    image.grid.axes[0].unit = "m";
    const auto facets = extract_facets<double>(image.view(), lattice, 0.5);
    const auto of_cells = extract_facets<double>(lattice_complex(image.view(), lattice), 0.5);
    EXPECT_EQ(facets.cells, of_cells.cells);
    EXPECT_EQ(facets.vertices, of_cells.vertices);
    for (int k = 1; k < N; ++k) EXPECT_EQ(facets.levels[k].down, of_cells.levels[k].down);
    EXPECT_EQ(facets.axis_names[0], "along");
    EXPECT_EQ(facets.axis_units[0], "m");
    EXPECT_TRUE(facets.periods.empty());
  });
}

template <int N>
void expect_equal(const FacetHierarchy<N, double>& one, const FacetHierarchy<N, double>& other) {
  EXPECT_EQ(one.vertices, other.vertices);
  EXPECT_EQ(one.normals, other.normals);
  EXPECT_EQ(one.cells, other.cells);
  EXPECT_EQ(one.axis_names, other.axis_names);
  for (int k = 1; k < N; ++k) EXPECT_EQ(one.levels[k].down, other.levels[k].down);
}

TEST(LatticeFacets, OfSeveralIsovaluesAreThoseOfEach) {
  const std::vector<double> isovalues = {0.5, 2.0, 0.8};
  ExtractOptions options;
  options.normals = Normals::differences;
  for_each_noise([&]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    std::size_t next = 0;
    extract_facets_several<double>(
        image.view(), lattice, isovalues,
        [&](std::size_t i, FacetHierarchy<N, double> facets) {
          ASSERT_EQ(i, next++);
          expect_equal<N>(facets, extract_facets<double>(image.view(), lattice, isovalues[i], options));
          EXPECT_EQ(i == 1, facets.vertices.empty());
        },
        options);
    EXPECT_EQ(next, isovalues.size());
    if constexpr (N < 4)
      for (const Division division : {Division::kuhn, Division::hybrid}) {
        next = 0;
        extract_facets_several<double>(
            image.view(), division, isovalues,
            [&](std::size_t i, FacetHierarchy<N, double> facets) {
              ASSERT_EQ(i, next++);
              expect_equal<N>(facets, extract_facets<double>(image.view(), division, isovalues[i], options));
            },
            options);
        EXPECT_EQ(next, isovalues.size());
      }
    expect_error(ErrorCode::InvalidIsovalue, "isovalue", [&] {
      extract_facets_several<double>(image.view(), lattice, std::array{0.5, std::nan("")},
                                     [](std::size_t, const FacetHierarchy<N, double>&) { FAIL(); });
    });
  });
}

/// Each simplex that the contour passes has one facet.
template <int N>
void expect_facets_of_division(Division division, const OwnedImage<double, N>& image, const ExtractOptions& options,
                               const AxisPeriods<N>& periods) {
  const auto facets = extract_facets<double>(image.view(), division, 0.5, options, periods);
  const auto [contour, stats] = extract_divided_with_stats<double>(image.view(), division, 0.5, options, periods);
  const FacetReport report = check(facets);
  const MeshReport expected = check(contour);
  EXPECT_EQ(0u, faults_of(facets));
  EXPECT_EQ(expected.euler, report.euler);
  EXPECT_EQ(expected.components, report.components);
  EXPECT_EQ(expected.boundary_simplices == 0, report.border == 0);
  EXPECT_EQ(contour.periods, facets.periods);
  EXPECT_EQ(stats.tiles, facets.cells);
  std::set<std::pair<std::array<double, N>, std::array<double, N>>> vertices;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) vertices.emplace(contour.vertices[v], contour.normals[v]);
  for (std::size_t p = 0; p < facets.vertices.size(); ++p)
    EXPECT_TRUE(vertices.contains({facets.vertices[p], facets.normals[p]})) << p;
  std::size_t inside = 0, corners = 0;
  for (std::size_t f = 0; f < facets.count(N - 1); ++f) {
    if (facets.levels[N - 1].places[f].is_cap) continue;
    ++inside;
    EXPECT_EQ(facets.levels[N - 1].places[f].number, 0u);
    const std::size_t points = facets.points_of(N - 1, f).size();
    corners += points;
    if (division == Division::hybrid) continue;
    // a triangle or a quadrilateral; a tetrahedron or the prism over a triangle
    EXPECT_TRUE(points == N || points == 2 * (N - 1)) << points;
  }
  EXPECT_GT(corners, 20u);
  EXPECT_EQ(inside, stats.active_tiles);
}

/// Noise at the places of a lattice, which divisions do not know.
template <int N>
auto noise_to_divide(const std::array<std::size_t, N>& sizes) {
  const Lattice lattice = N == 2 ? Lattice::triangular : N == 3 ? Lattice::fcc : Lattice::d4;
  return sampled_on_lattice<N>(lattice, torus_grid<N>(sizes), noise_everywhere<N>(7));
}

template <int N>
std::vector<Division> divisions_in() {
  if (N == 4) return {Division::kuhn, Division::symmetric};
  return {Division::kuhn, Division::alternating, Division::symmetric, Division::hybrid};
}

TEST(LatticeFacets, OfDivisionsAreOneForEachSimplex) {
  const auto run = [&]<int N>(const std::array<std::size_t, N>& sizes) {
    const auto image = noise_to_divide<N>(sizes);
    for (const Division division : divisions_in<N>()) {
      for (const bool close : {false, true})
        for (const unsigned axes : {0u, 1u, (1u << N) - 1}) {
          SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << " " << close << " " << axes);
          ExtractOptions options;
          options.close = close;
          options.normals = Normals::differences;
          expect_facets_of_division<N>(division, image, options, periodic_along<N>(axes));
        }
    }
  };
  run.template operator()<2>({8, 6});
  run.template operator()<3>({6, 4, 8});
  run.template operator()<4>({4, 4, 4, 4});
}

/// With missing values the facets are sound and have the topology of the contour, also closed, periodic, and where no
/// edge is crossed, as all samples are high.
TEST(LatticeFacets, OfDivisionsWithMissingValuesAreSound) {
  const auto run = [&]<int N>(const std::array<std::size_t, N>& sizes) {
    const auto image = noise_to_divide<N>(sizes);
    for (const Division division : divisions_in<N>()) {
      for (const std::size_t stride : {5u, 13u})
        for (const bool all_high : {false, true})
          for (const unsigned axes : {0u, 1u, (1u << N) - 1}) {
            auto with_gaps = image;
            for (std::size_t i = 0; i < image.values.size(); ++i) {
              if (all_high) with_gaps.values[i] = 1.0;
              if (i % stride == 0) with_gaps.values[i] = std::numeric_limits<double>::quiet_NaN();
            }
            for (const bool close : {false, true}) {
              SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << " gaps " << stride << " high "
                                              << all_high << " axes " << axes << " close " << close);
              ExtractOptions options;
              options.close = close;
              const auto facets =
                  extract_facets<double>(with_gaps.view(), division, 0.5, options, periodic_along<N>(axes));
              const auto contour =
                  extract_divided<double>(with_gaps.view(), division, 0.5, options, periodic_along<N>(axes));
              const MeshReport expected = check(contour);
              EXPECT_EQ(0u, faults_of(facets));
              EXPECT_EQ(expected.euler, check(facets).euler);
              EXPECT_EQ(expected.components, check(facets).components);
              EXPECT_EQ(expected.boundary_simplices == 0, check(facets).border == 0);
              // the border alone has caps; with the denser gaps, all cells in 4D may have one
              const bool is_empty = all_high && (!close || axes == (1u << N) - 1);
              EXPECT_TRUE(stride != 13u || is_empty == facets.vertices.empty());
            }
          }
    }
  };
  run.template operator()<2>({8, 6});
  run.template operator()<3>({6, 4, 8});
  run.template operator()<4>({4, 4, 4, 4});
}

TEST(LatticeFacets, OfSeveralIsovaluesReportOneProgress) {
  const auto image = sampled_on_lattice<3>(Lattice::fcc, torus_grid<3>({6, 4, 8}), noise_everywhere<3>(7));
  for (const Division division : {Division::kuhn, Division::hybrid}) {
    double last = 0.0;
    std::vector<double> at_results;
    ExtractOptions options;
    options.work.threads = 1;
    options.work.progress = [&](double fraction) {
      EXPECT_GE(fraction, last) << name_of(division);
      last = fraction;
      return true;
    };
    extract_facets_several<double>(
        image.view(), division, std::array{0.4, 0.5, 0.6, 0.7},
        [&](std::size_t, const FacetHierarchy<3, double>&) { at_results.push_back(last); }, options);
    ASSERT_EQ(at_results.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(at_results[i], 0.25 * static_cast<double>(i + 1), 1e-9);
  }
}

/// Facets beyond the seam are those of the samples moved around the periods.
TEST(LatticeFacets, SamplesMovedAroundThePeriodsGiveAsManyFacets) {
  for_each_noise([]<int N>(Lattice lattice, const OwnedImage<double, N>& image) {
    const auto sizes = image.grid.sizes();
    const int layers = lattice == Lattice::fcc_in_time ? 2 : N - 1;
    OwnedImage<double, N> moved = image;
    for (std::size_t i = 0; i < image.values.size(); ++i) {
      std::size_t rest = i, from = 0, stride = 1;
      for (int a = 0; a < N; ++a) {
        from += (rest % sizes[a] + (a == layers ? 2 : 1)) % sizes[a] * stride;
        rest /= sizes[a];
        stride *= sizes[a];
      }
      moved.values[i] = image.values[from];
    }
    for (const Ambiguity rule : {Ambiguity::low, Ambiguity::mean}) {
      ExtractOptions options;
      options.ambiguity = rule;
      const auto a = extract_facets<double>(image.view(), lattice, 0.5, options, all_periodic<N>());
      const auto b = extract_facets<double>(moved.view(), lattice, 0.5, options, all_periodic<N>());
      EXPECT_EQ(check(a), check(b));
    }
  });
}

TEST(LatticeFacets, TheGyroidsCellHasEulerCharacteristicMinusEight) {
  const auto expect_gyroid = [](Lattice lattice, const std::array<std::size_t, 3>& sizes) {
    const auto image = sampled_on_lattice<3>(lattice, torus_grid<3>(sizes),
                                             [](const auto& x, const auto&, const auto&) { return gyroid(x); });
    for (const Ambiguity rule : kAllRules) {
      ExtractOptions options;
      options.ambiguity = rule;
      const auto facets = extract_facets<double>(image.view(), lattice, 0.01, options, all_periodic<3>());
      const FacetReport report = check(facets);
      EXPECT_EQ(report.euler, -8);
      EXPECT_EQ(report.border, 0u);
      EXPECT_EQ(report.components, 1u);
      EXPECT_EQ(faults_of(facets), 0u);
      std::set<std::size_t> corners;
      for (std::size_t f = 0; f < facets.count(2); ++f) corners.insert(facets.down(2, f).size());
      // three high corners in a row have eight crossed edges in an octahedron
      EXPECT_EQ(corners, lattice == Lattice::fcc ? (std::set<std::size_t>{3, 4, 6, 8}) : (std::set<std::size_t>{3, 4}));
    }
  };
  expect_gyroid(Lattice::fcc, {17, 16, 24});
  expect_gyroid(Lattice::bcc, {13, 12, 26});
}

/// The gyroid in all times of a period: its Euler characteristic times that of the circle.
TEST(LatticeFacets, TheGyroidsCellOverAPeriodOfTimeHasEulerCharacteristicZero) {
  const auto at_x = [](const std::array<double, 4>& x, const auto&, const auto&) { return gyroid({x[0], x[1], x[2]}); };
  const auto image = sampled_on_lattice<4>(Lattice::fcc_in_time, torus_grid<4>({9, 9, 14, 3}), at_x);
  const auto facets = extract_facets<double>(image.view(), Lattice::fcc_in_time, 0.01, {}, all_periodic<4>());
  EXPECT_EQ(check(facets).euler, 0);
  EXPECT_EQ(check(facets).components, 1u);
  EXPECT_EQ(check(facets).border, 0u);
  EXPECT_EQ(faults_of(facets), 0u);
  ASSERT_EQ(facets.periods.size(), 4u);
}

TEST(LatticeFacets, BesideMissingValuesTheyAreAManifoldAcrossTheSeam) {
  for_each_noise([]<int N>(Lattice lattice, OwnedImage<double, N> image) {
    std::mt19937 random(3);
    for (double& value : image.values)
      if (random() % 10 == 0) value = std::numeric_limits<double>::quiet_NaN();
    for (const unsigned axes : {1u, (1u << N) - 1}) {
      const AxisPeriods<N> periods = periodic_along<N>(axes);
      const auto facets = extract_facets<double>(image.view(), lattice, 0.5, {}, periods);
      EXPECT_EQ(0u, faults_of(facets)) << axes;
      EXPECT_GT(check(facets).border, 0u);
      const auto contour = extract_lattice<double>(image.view(), lattice, 0.5, {}, periods);
      // in 4D extract separates more than facets do
      EXPECT_TRUE(N == 4 || check(contour).euler == check(facets).euler) << axes;
      EXPECT_EQ(check(contour).components, check(facets).components);
    }
  });
}

TEST(LatticeFacets, DoNotDependOnThreadsAndRefuseBadArguments) {
  const auto image = sampled_on_lattice<3>(Lattice::fcc, torus_grid<3>({9, 8, 12}), noise_everywhere<3>(2));
  ExtractOptions one, many;
  one.work.threads = 1;
  many.work.threads = 4;
  const auto first = extract_facets<float>(image.view(), Lattice::fcc, 0.5, one, all_periodic<3>());
  const auto second = extract_facets<float>(image.view(), Lattice::fcc, 0.5, many, all_periodic<3>());
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.levels[1].down, second.levels[1].down);
  EXPECT_EQ(first.levels[2].down, second.levels[2].down);
  const auto expect_refused = [&](const std::string& message, Lattice lattice, const ExtractOptions& options,
                                  const AxisPeriods<3>& periods) {
    expect_error(ErrorCode::InvalidArgument, message,
                 [&] { (void)extract_facets<double>(image.view(), lattice, 0.5, options, periods); });
  };
  expect_refused("lattice d4 of a 3D image", Lattice::d4, {}, {});
  expect_refused("the period of axis 0 (x) is 0.5; expected 1", Lattice::fcc, {}, {0.5, 0.0, 0.0});
  ExtractOptions normals;
  normals.normals = Normals::sobel;
  expect_refused("sobel normals on a lattice", Lattice::fcc, normals, {});
  // chords of polygons in cells whose common faces are not known
  expect_error(ErrorCode::UnsupportedData, "polygons in the cells of a mesh or lattice", [&] {
    (void)triangulate(extract_facets<double>(image.view(), Lattice::fcc, 0.5), PolygonTriangulation::fan);
  });
}

}  // namespace
}  // namespace tegl::test
