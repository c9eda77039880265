// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of images with periodic axes: the complexes are closed across the seam and have the topology of the wrapped
// contour, whose simplices subdivide them.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "errors.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/polygons.hpp"
#include "torus.hpp"

namespace tegl::test {
namespace {

template <int N>
FacetHierarchy<N, double> facets_of(const OwnedImage<float, N>& image, const AxisPeriods<N>& periods, double isovalue,
                                    const ExtractOptions& options) {
  return extract_facets<double>(image.view(), isovalue, options, periods);
}

/// The places of the vertices, which differ from each other.
template <class Vertices>
auto places_of(const Vertices& vertices) {
  return std::set<typename Vertices::value_type>(vertices.begin(), vertices.end());
}

template <int N>
void expect_those_of_the_contour(const OwnedImage<float, N>& image, const AxisPeriods<N>& periods,
                                 const ExtractOptions& options) {
  const auto facets = facets_of<N>(image, periods, 0.1, options);
  const auto contour = extract_periodic<double>(image.view(), periods, 0.1, options);
  const FacetReport report = check(facets);
  const MeshReport of_contour = check(contour);
  EXPECT_EQ(report.branching + report.conflicts + report.open_boundaries, 0u);
  EXPECT_EQ(report.components, of_contour.components);
  EXPECT_EQ(report.euler, of_contour.euler);
  EXPECT_EQ(report.border == 0, of_contour.boundary_simplices == 0);
  EXPECT_EQ(facets.periods, contour.periods);
  EXPECT_EQ(facets.sizes, image.grid.sizes());
  EXPECT_EQ(facets.normals.size(), options.normals == Normals::none ? 0 : facets.vertices.size());
  // every point is a vertex of the contour
  const auto vertices = places_of(contour.vertices);
  for (const auto& point : facets.vertices) EXPECT_TRUE(vertices.contains(point));
  if (N == 2) {
    EXPECT_EQ(facets.count(0), contour.vertices.size());
    EXPECT_EQ(facets.count(1), contour.simplices.size());
  }
  // the places are those of the image
  for (int k = 0; k < N; ++k)
    for (const FacetPlace& place : facets.levels[k].places) EXPECT_LT(place.base, image.values.size());
}

template <int N>
void expect_closed(const std::array<std::size_t, N>& sizes) {
  unsigned seed = 1;
  for (unsigned axes = 1; axes < 1u << N; ++axes)
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high, Ambiguity::mean, Ambiguity::saddle})
      for (const bool close : {false, true}) {
        SCOPED_TRACE(testing::Message() << N << "D, axes " << axes << ", seed " << seed << ", close " << close);
        ExtractOptions options;
        options.ambiguity = ambiguity;
        options.close = close;
        options.normals = seed % 2 == 0 ? Normals::differences : Normals::none;
        options.work.threads = 1 + seed % 3;
        expect_those_of_the_contour<N>(torus_image<N>(sizes, noise_of<N>(seed++)), periodic_along<N>(axes), options);
      }
}

TEST(PeriodicFacets, HaveTheTopologyOfTheWrappedContour) {
  expect_closed<2>({7, 66});
  expect_closed<3>({6, 4, 5});
  expect_closed<4>({4, 3, 5, 4});
}

TEST(PeriodicFacets, HaveTheEulerCharacteristicsOfTori) {
  const auto cell = facets_of<3>(torus_image<3>({21, 20, 23}, gyroid), all_periodic<3>(), 0.0, {});
  EXPECT_EQ(check(cell).euler, -8);
  EXPECT_EQ(check(cell).border, 0u);
  const auto tube =
      torus_image<3>({12, 20, 20}, [](const auto& x) { return 0.3 - std::hypot(x[1] - 0.5, x[2] - 0.5); });
  const auto torus = facets_of<3>(tube, {1.0, 0.0, 0.0}, 0.0, {});
  EXPECT_EQ(check(torus).euler, 0);
  EXPECT_EQ(check(torus).border, 0u);
  EXPECT_EQ(check(torus).components, 1u);
}

template <int N>
void expect_manifold_beside_missing(const std::array<std::size_t, N>& sizes) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    auto image = torus_image<N>(sizes, noise_of<N>(seed));
    std::mt19937 random(seed);
    for (float& value : image.values)
      if (random() % 10 == 0) value = std::numeric_limits<float>::quiet_NaN();
    const AxisPeriods<N> periods = periodic_along<N>(1 + seed % ((1u << N) - 1));
    const auto facets = facets_of<N>(image, periods, 0.0, {});
    const FacetReport report = check(facets);
    EXPECT_EQ(report.branching + report.conflicts + report.open_boundaries, 0u) << "seed " << seed;
    // in 4D extract separates more than facets do
    if (N == 4) continue;
    const auto contour = extract_periodic<double>(image.view(), periods, 0.0);
    EXPECT_EQ(report.euler, check(contour).euler) << "seed " << seed;
    EXPECT_EQ(report.components, check(contour).components) << "seed " << seed;
    EXPECT_EQ(facets.count(0), contour.vertices.size()) << "seed " << seed;
  }
}

TEST(PeriodicFacets, AreSeparatedBesideMissingValues) {
  expect_manifold_beside_missing<2>({7, 6});
  expect_manifold_beside_missing<3>({5, 4, 6});
  expect_manifold_beside_missing<4>({4, 4, 5, 4});
}

TEST(PeriodicFacets, TheResultDoesNotDependOnThreads) {
  const auto image = torus_image<3>({20, 18, 17}, noise_of<3>(4));
  ExtractOptions one, many;
  one.work.threads = 1;
  many.work.threads = 4;
  const auto first = facets_of<3>(image, all_periodic<3>(), 0.0, one);
  const auto second = facets_of<3>(image, all_periodic<3>(), 0.0, many);
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.levels[2].down, second.levels[2].down);
  EXPECT_EQ(first.levels[1].down, second.levels[1].down);
}

TEST(PeriodicFacets, BadPeriodsAndTriangulationsAreRefused) {
  const auto image = torus_image<3>({6, 4, 5}, noise_of<3>(1));
  for (const double period : {-1.0, 0.5}) {
    EXPECT_THROW((void)facets_of<3>(image, {period, 0.0, 0.0}, 0.0, {}), Error);
  }
  expect_error(ErrorCode::InvalidArgument, "the period of axis 0 (x) is 1.7, and the step across the seam", [&] {
    (void)facets_of<3>(image, {1.7, 0.0, 0.0}, 0.0, {});
  });
  ExtractOptions custom;
  custom.ambiguity = Ambiguity::custom;
  EXPECT_THROW((void)facets_of<3>(image, all_periodic<3>(), 0.0, custom), Error);
  const auto facets = facets_of<3>(image, all_periodic<3>(), 0.0, {});
  EXPECT_THROW((void)triangulate(facets, PolygonTriangulation::fan), Error);
}

}  // namespace
}  // namespace tegl::test
