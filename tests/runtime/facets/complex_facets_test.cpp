// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of complexes: equal to the facets of images, and subdivided by the contours of `extract`.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "complex/complex_cases.hpp"
#include "complex/polyhedral_cases.hpp"
#include "invariants.hpp"
#include "known_polytopes.hpp"
#include "meshes.hpp"
#include "polytopal_meshes.hpp"
#include "tegl/check.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/lattice.hpp"

namespace tegl {
namespace {

using namespace test;

/// Values in [0, 1) at the points.
template <int N>
std::vector<double> values_at_random(const MeshData<N>& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> values(mesh.points.size());
  for (double& value : values) value = static_cast<double>(random() >> 11) * 0x1p-53;
  return values;
}

/// The (N-1)-facets as rings of places in units of 1e-6, each from its smallest place, in an order of their own. Of
/// polyhedra, the sorted places.
template <int N>
std::vector<std::vector<std::array<std::int64_t, N>>> rings_of(const FacetHierarchy<N, double>& facets) {
  std::vector<std::vector<std::array<std::int64_t, N>>> rings;
  for (std::size_t f = 0; f < facets.count(N - 1); ++f) {
    auto& ring = rings.emplace_back();
    for (const Index p : facets.points_of(N - 1, f)) {
      auto& place = ring.emplace_back();
      for (int a = 0; a < N; ++a) place[a] = std::llround(1e6 * facets.vertices[p][a]);
    }
    if (N == 3) std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    if (N == 4) std::sort(ring.begin(), ring.end());
  }
  std::sort(rings.begin(), rings.end());
  return rings;
}

template <int N>
void expect_facets_of_image(const MeshData<N>& mesh, const std::vector<double>& values) {
  Complex<N> complex = mesh.complex();
  complex.set_values(values);
  const OwnedImage<double, N> image = image_of(mesh, values);
  for (const Ambiguity rule : kAllRules)
    for (const bool close : {false, true}) {
      SCOPED_TRACE(testing::Message() << N << "D, rule " << static_cast<int>(rule) << (close ? ", closed" : ""));
      ExtractOptions options;
      options.ambiguity = rule;
      options.close = close;
      const auto of_image = extract_facets<double>(image.view(), 0.5, options);
      const auto of_mesh = extract_facets<double>(complex, 0.5, options);
      for (int k = 0; k < N; ++k) {
        EXPECT_EQ(of_image.count(k), of_mesh.count(k)) << k;
        const auto caps = [k](const auto& facets) {
          const auto& places = facets.levels[k].places;
          return std::count_if(places.begin(), places.end(), [](const FacetPlace& place) { return place.is_cap; });
        };
        EXPECT_EQ(caps(of_image), caps(of_mesh)) << k;
        EXPECT_EQ(close, caps(of_mesh) > 0) << k;
      }
      EXPECT_GT(of_mesh.count(N - 1), 100u);
      EXPECT_TRUE(rings_of<N>(of_image) == rings_of<N>(of_mesh));
      EXPECT_EQ(check(of_image), check(of_mesh));
    }
}

TEST(ComplexFacets, AGridsOwnCellsHaveTheImagesFacets) {
  const MeshData<2> squares = cube_mesh(grid_points<2>({17, 13}), true);
  expect_facets_of_image(squares, values_at_random(squares, 3));
  const MeshData<3> cubes = cube_mesh(grid_points<3>({9, 8, 7}), true);
  expect_facets_of_image(cubes, values_at_random(cubes, 4));
  const MeshData<4> tesseracts = cube_mesh(grid_points<4>({5, 4, 5, 4}), true);
  expect_facets_of_image(tesseracts, values_at_random(tesseracts, 5));
}

/// Consistent facets with the topology of the contour, on its vertices, whatever the number of threads.
template <int N>
void expect_facets_of_contour(const Complex<N>& complex, double isovalue, ExtractOptions options) {
  options.normals = Normals::differences;
  const auto facets = extract_facets<double>(complex, isovalue, options);
  const auto contour = extract<double>(complex, isovalue, options);
  const MeshReport expected = check(contour);
  const FacetReport report = check(facets);
  EXPECT_EQ(0u, report.branching + report.conflicts + report.open_boundaries);
  EXPECT_EQ(expected.components, report.components);
  EXPECT_EQ(expected.euler, report.euler);
  if (N < 4)
    EXPECT_EQ(expected.boundary_simplices, report.border);
  else
    EXPECT_EQ(expected.boundary_simplices > 0, report.border > 0);
  EXPECT_LE(facets.count(N - 1), contour.simplices.size());
  EXPECT_GT(facets.count(N - 1), 30u);
  ASSERT_EQ(facets.vertices.size(), facets.normals.size());
  std::size_t v = 0;  // the points are vertices of the contour in their order
  for (std::size_t p = 0; p < facets.vertices.size(); ++p, ++v) {
    while (v < contour.vertices.size() &&
           (contour.vertices[v] != facets.vertices[p] || contour.normals[v] != facets.normals[p]))
      ++v;
    ASSERT_LT(v, contour.vertices.size()) << p;
  }
  std::uint64_t cell = 0;  // ascending; facets of a cell are counted
  unsigned number = 0;
  for (std::size_t f = 0; f < facets.count(N - 1); ++f) {
    const FacetPlace& place = facets.levels[N - 1].places[f];
    if (place.is_cap) break;
    if (f > 0 && place.base == cell) {
      EXPECT_EQ(++number, place.number);
    } else {
      EXPECT_TRUE(f == 0 || place.base > cell);
      number = place.number;
      EXPECT_EQ(0u, number);
    }
    cell = place.base;
    ASSERT_LT(cell, facets.cells);
  }
  options.work.threads = 3;
  const auto again = extract_facets<double>(complex, isovalue, options);
  EXPECT_TRUE(again.vertices == facets.vertices && again.levels[N - 1].down == facets.levels[N - 1].down);
}

TEST(ComplexFacets, HaveTheTopologyOfTheContourOnAllMeshes) {
  const auto points = grid_points<3>({6, 6, 6}, 0.15);
  for (const MeshData<3>& mesh :
       {kuhn_mesh(points), wedge_mesh(points), pyramid_mesh(points), cube_mesh(points), mixed_mesh(points, 5)})
    for (const bool has_missing : {false, true}) {
      Complex<3> complex = mesh.complex();
      const std::vector<double> values = values_at_random(mesh, 8);
      complex.set_values(has_missing ? with_missing(values) : values);
      for (const Ambiguity rule : kAllRules)
        for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
          SCOPED_TRACE(testing::Message() << "rule " << static_cast<int>(rule) << (has_missing ? " missing" : ""));
          ExtractOptions options;
          options.ambiguity = rule;
          options.direction = direction;
          options.close = direction == GradientDirection::ascent;
          expect_facets_of_contour(complex, 0.5, options);
        }
    }
  const MeshData<2> triangles = kuhn_mesh(grid_points<2>({30, 20}, 0.1));
  Complex<2> plane = triangles.complex();
  plane.set_values(values_at_random(triangles, 3));
  expect_facets_of_contour(plane, 0.5, {});
  ExtractOptions closed;
  closed.close = true;
  expect_facets_of_contour(plane, 0.5, closed);
}

/// Distance of a point from the segment between two others.
double distance_from(const std::array<double, 3>& p, const std::array<double, 3>& a, const std::array<double, 3>& b) {
  double along = 0.0, square = 0.0, result = 0.0;
  for (int k = 0; k < 3; ++k) along += (p[k] - a[k]) * (b[k] - a[k]), square += (b[k] - a[k]) * (b[k] - a[k]);
  const double t = std::clamp(along / square, 0.0, 1.0);
  for (int k = 0; k < 3; ++k) result = std::hypot(result, p[k] - a[k] - t * (b[k] - a[k]));
  return result;
}

TEST(ComplexFacets, CapsOfMixedMeshesBelongToTheCellsThatTheyAreIn) {
  const MeshData<3> mesh = mixed_mesh(grid_points<3>({6, 6, 6}, 0.15), 5);
  Complex<3> complex = mesh.complex();
  complex.set_values(values_at_random(mesh, 8));
  // the corners of the cells in the order of their numbers: by type
  std::vector<std::pair<CellType, std::span<const Index>>> cells;
  for (const CellType wanted : {CellType::tetrahedron, CellType::wedge, CellType::pyramid, CellType::hexahedron}) {
    std::size_t first = 0;
    for (const CellType type : mesh.types) {
      if (type == wanted) cells.emplace_back(type, std::span(mesh.corners).subspan(first, corner_count(type)));
      first += corner_count(type);
    }
  }
  ASSERT_EQ(cells.size(), mesh.types.size());
  for (const Ambiguity rule : kAllRules) {
    ExtractOptions options;
    options.ambiguity = rule;
    options.close = true;
    const auto facets = extract_facets<double>(complex, 0.5, options);
    std::set<CellType> types;
    for (std::size_t f = 0; f < facets.count(2); ++f) {
      const FacetPlace& place = facets.levels[2].places[f];
      if (!place.is_cap) continue;
      ASSERT_LT(place.base, cells.size());
      const auto& [type, corners] = cells[place.base];
      types.insert(type);
      for (const Index p : facets.points_of(2, f)) {  // on an edge of the cell
        double distance = HUGE_VAL;
        for (const Index a : corners)
          for (const Index b : corners)
            if (a != b)
              distance = std::min(distance, distance_from(facets.vertices[p], mesh.points[a], mesh.points[b]));
        EXPECT_LT(distance, 1e-12) << "cell " << place.base << ", rule " << static_cast<int>(rule);
      }
    }
    EXPECT_GT(types.size(), 2u);
  }
}

/// Noise at three times, also at the border.
template <class Mesh>
Complex<4> noise_in_time(const Mesh& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> values(3 * mesh.points.size());
  for (double& value : values) value = static_cast<double>(random() >> 11) * 0x1p-53;
  return in_time(mesh.complex(), std::vector<double>{0.0, 0.7, 1.0}, values);
}

TEST(ComplexFacets, In4dHaveTheTopologyOfTheContourOnAllMeshes) {
  const auto points = grid_points<3>({5, 5, 5}, 0.15);
  for (const MeshData<3>& mesh : {kuhn_mesh(points), wedge_mesh(points), pyramid_mesh(points), mixed_mesh(points, 5)}) {
    const Complex<4> complex = noise_in_time(mesh, 20);
    for (const Ambiguity rule : kAllRules) {
      SCOPED_TRACE(testing::Message() << "rule " << static_cast<int>(rule));
      ExtractOptions options;
      options.ambiguity = rule;
      options.direction = rule == Ambiguity::mean ? GradientDirection::ascent : GradientDirection::descent;
      for (const bool close : {false, true}) {
        options.close = close;
        expect_facets_of_contour(complex, 0.5, options);
      }
    }
  }
  const MeshData<4> simplices = kuhn_mesh(grid_points<4>({5, 5, 5, 4}, 0.1));
  Complex<4> complex = simplices.complex();
  complex.set_values(values_at_random(simplices, 3));
  expect_facets_of_contour(complex, 0.5, {});
}

TEST(ComplexFacets, OfLatticesIn4dAreThoseOfTheirCells) {
  const OwnedImage<double, 4> image = OwnedImage<double, 4>(
      Grid<4>::unit({6, 6, 6, 6}), Values<double>(values_at_random(cube_mesh(grid_points<4>({6, 6, 6, 6})), 6)));
  for (const Lattice lattice : {Lattice::d4, Lattice::fcc_in_time}) {
    const Complex<4> complex = lattice_complex(image.view(), lattice);
    for (const Ambiguity rule : {Ambiguity::low, Ambiguity::mean}) {
      SCOPED_TRACE(testing::Message() << name_of(lattice) << ", rule " << static_cast<int>(rule));
      ExtractOptions options;
      options.ambiguity = rule;
      for (const bool close : {false, true}) {
        options.close = close;
        expect_facets_of_contour(complex, 0.5, options);
      }
    }
  }
}

TEST(ComplexFacets, OfPolyhedraOverTimeHaveTheTopologyOfTheContour) {
  for (const auto& [name, mesh] : space_fillings(3, 150, 6)) {
    SCOPED_TRACE(name);
    const Complex<4> complex = noise_in_time(mesh, 4);
    for (const Ambiguity rule : {Ambiguity::low, Ambiguity::mean}) {
      ExtractOptions options;
      options.ambiguity = rule;
      for (const bool close : {false, true}) {
        options.close = close;
        expect_facets_of_contour(complex, 0.5, options);
      }
    }
  }
}

TEST(ComplexFacets, OfPolytopesHaveTheTopologyOfTheContour) {
  std::vector<std::pair<std::string, FacetedMesh>> meshes;
  meshes.emplace_back("products", products(mixed_polygons(3), mixed_polygons(2), 0.02));
  meshes.emplace_back("products in prisms", with_prisms(products(mixed_polygons(2), mixed_polygons(2))));
  meshes.emplace_back("24-cells in prisms", with_prisms(cells24(2)));
  for (const auto& [name, mesh] : meshes)
    for (const Ambiguity rule : kAllRules)
      for (const bool close : {false, true}) {
        SCOPED_TRACE(testing::Message() << name << ", rule " << static_cast<int>(rule) << (close ? ", closed" : ""));
        Complex<4> complex = mesh.complex();
        complex.set_values(random_values(mesh.points.size(), 11));
        ExtractOptions options;
        options.ambiguity = rule;
        options.close = close;
        expect_facets_of_contour(complex, 0.5, options);
      }
}

TEST(ComplexFacets, In4dBesideMissingValuesTheyAreAManifold) {
  const MeshData<4> mesh = cube_mesh(grid_points<4>({5, 5, 4, 4}));
  Complex<4> complex = mesh.complex();
  complex.set_values(with_missing(values_at_random(mesh, 9)));
  for (const Ambiguity rule : {Ambiguity::low, Ambiguity::mean}) {
    ExtractOptions options;
    options.ambiguity = rule;
    options.close = rule == Ambiguity::mean;
    const auto facets = extract_facets<double>(complex, 0.5, options);
    const FacetReport report = check(facets);
    EXPECT_EQ(0u, report.branching + report.conflicts + report.open_boundaries);
    EXPECT_GT(report.border, 0u);
    EXPECT_EQ(check(extract<double>(complex, 0.5, options)).components, report.components);
  }
}

/// A polyhedron for each active 4-simplex, a tetrahedron or a prism.
TEST(ComplexFacets, OfSimplicesIn4dHaveFourOrSixPoints) {
  const MeshData<4> mesh = kuhn_mesh(grid_points<4>({4, 4, 4, 4}));
  Complex<4> complex = mesh.complex();
  complex.set_values(values_at_random(mesh, 2));
  const auto facets = extract_facets<double>(complex, 0.5);
  for (std::size_t f = 0; f < facets.count(3); ++f) {
    const auto high = static_cast<std::size_t>(std::popcount(facets.levels[3].places[f].signature));
    EXPECT_EQ(high * (5 - high), facets.points_of(3, f).size());
    EXPECT_EQ(high == 1 || high == 4 ? 4u : 5u, facets.down(3, f).size());
  }
  EXPECT_EQ(extract_with_stats<double>(complex, 0.5).stats.active_tiles, facets.count(3));
}

TEST(ComplexFacets, OfPolyhedraAreOnePolygonForEachLoop) {
  for (const auto& [name, mesh] : space_fillings(4, 400, 6)) {
    SCOPED_TRACE(name);
    Complex<3> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 4));
    for (const Ambiguity rule : {Ambiguity::low, Ambiguity::mean}) {
      ExtractOptions options;
      options.ambiguity = rule;
      expect_facets_of_contour(complex, 0.5, options);
    }
  }
}

TEST(ComplexFacets, OfLatticesAreThoseOfTheirCells) {
  const OwnedImage<double, 3> image = OwnedImage<double, 3>(
      Grid<3>::unit({9, 9, 9}), Values<double>(values_at_random(cube_mesh(grid_points<3>({9, 9, 9})), 6)));
  for (const Lattice lattice : {Lattice::fcc, Lattice::bcc}) {
    const Complex<3> complex = lattice_complex(image.view(), lattice);
    for (const Ambiguity rule : {Ambiguity::low, Ambiguity::mean}) {
      ExtractOptions options;
      options.ambiguity = rule;
      expect_facets_of_contour(complex, 0.5, options);
    }
  }
}

/// A plane cuts each cell in one polygon.
TEST(ComplexFacets, OfAPlaneAreOnePolygonForEachCell) {
  const MeshData<3> mesh = cube_mesh(grid_points<3>({6, 6, 6}));
  Complex<3> complex = mesh.complex();
  std::vector<double> values;
  for (const auto& x : mesh.points) values.push_back(x[0] + 0.3 * x[1] + 0.1 * x[2]);
  complex.set_values(values);
  const auto facets = extract_facets<double>(complex, 0.07);
  std::vector<std::uint64_t> cells;
  for (const FacetPlace& place : facets.levels[2].places) cells.push_back(place.base);
  std::size_t active = 0;
  for (std::size_t c = 0; c < mesh.corners.size() / 8; ++c) {
    bool low = false, high = false;
    for (std::size_t v = 0; v < 8; ++v) (values[mesh.corners[8 * c + v]] >= 0.07 ? high : low) = true;
    if (!low || !high) continue;
    ASSERT_LT(active, cells.size());
    EXPECT_EQ(c, cells[active++]);
  }
  EXPECT_EQ(active, cells.size());
}

}  // namespace
}  // namespace tegl
