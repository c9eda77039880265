// SPDX-License-Identifier: BSD-3-Clause
//
// 4D polytopes that are given by their facets: single cells against the general engine, and meshes with invariants.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "compare.hpp"
#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "complex/engine_cells.hpp"
#include "complex/polyhedral_cases.hpp"
#include "complex/solid_cases.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "known_polytopes.hpp"
#include "polytopal_meshes.hpp"
#include "tegl/cell_index.hpp"
#include "tegl/complex.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl {
namespace {

using namespace test;

const detail::Polytopes& polytopes_of(const Complex<4>& complex) {
  return detail::ComplexAccess::cells(complex).polytopes;
}

// ---------------------------------------------------------------------------------------------------- single cells

/// The engine for a cell in the library's numbers of its corners.
tile::FacetBuilder engine_of(const FacetedMesh& mesh, const Complex<4>& complex) {
  std::map<Index, unsigned> corner;
  const std::span<const Index> points = polytopes_of(complex).points_of(0);
  for (unsigned v = 0; v < points.size(); ++v) corner[points[v]] = v;
  std::vector<tile::Signature> facets;
  for (const CellFaces3& facet : mesh.cells[0]) {
    tile::Signature& bits = facets.emplace_back(0);
    for (const Index p : corners_of(facet)) bits |= tile::Signature{1} << corner.at(p);
  }
  return tile::FacetBuilder(tile::FaceLattice(4, facets));
}

/// Of a mesh that is no single cell without a table.
constexpr std::size_t kNoCell = ~std::size_t{0};

std::size_t compare_hull(const std::vector<Point4>& points, std::uint64_t step) {
  const FacetedMesh mesh = hull(points);
  const Complex<4> complex = mesh.complex();
  if (polytopes_of(complex).size() != 1) return kNoCell;
  tile::FacetBuilder engine = engine_of(mesh, complex);
  return compare_with_engine(polytopes_of(complex), engine, step);
}

std::vector<Point4> duoprism_points(int first, int second) {
  return products(regular_polygon(first), regular_polygon(second)).points;
}

std::vector<std::array<double, 3>> octahedron_points() {
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

TEST(Polytopes, AllContoursOfSmallPolytopesAreThoseOfTheEngine) {
  const std::vector<std::array<double, 3>> tetrahedron = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_EQ(0u, compare_hull(pyramid_points(tetrahedron, true), 1));
  EXPECT_EQ(0u, compare_hull(pyramid_points(prism_points(3), false), 1));
  EXPECT_EQ(0u, compare_hull(pyramid_points(octahedron_points(), false), 1));
  for (const int sides : {3, 4, 5})
    for (const bool is_double : {false, true})
      EXPECT_NE(kNoCell, compare_hull(pyramid_points(prism_points(sides), is_double), 1)) << sides;
  EXPECT_NE(kNoCell, compare_hull(cyclic_points(7), 1));
  EXPECT_NE(kNoCell, compare_hull(cyclic_points(9), 1));
  EXPECT_NE(kNoCell, compare_hull(rectified_simplex_points(), 1));
  EXPECT_GT(compare_hull(duoprism_points(3, 3), 1), 0u);
}

TEST(Polytopes, ContoursOfLargerPolytopesAreThoseOfTheEngine) {
  EXPECT_GT(compare_hull(duoprism_points(3, 5), 101), 0u);
  EXPECT_GT(compare_hull(duoprism_points(5, 6), 3000017), 0u);
  EXPECT_GT(compare_hull(cell24_points(), 50021), 0u);
  EXPECT_NE(kNoCell, compare_hull(truncated_simplex_points(), 4001));
  EXPECT_NE(kNoCell, compare_hull(rhombic_cells(0).points, 4000037));
  EXPECT_NE(kNoCell, compare_hull(cyclic_points(16), 601));
}

TEST(Polytopes, ContoursByRulesOfTheDataHaveTheTopologyOfTheEngine) {
  std::size_t joined = 0;
  for (const auto& points : {cell24_points(), duoprism_points(3, 5), rectified_simplex_points(),
                             truncated_simplex_points(), rhombic_cells(0).points}) {
    const FacetedMesh mesh = hull(points);
    const Complex<4> complex = mesh.complex();
    const detail::Polytopes& polytopes = polytopes_of(complex);
    tile::FacetBuilder engine = engine_of(mesh, complex);
    const std::vector<tile::Face>& faces = engine.lattice().faces();
    for (const Ambiguity rule : {Ambiguity::mean, Ambiguity::squares})
      for (std::uint64_t seed = 0; seed < 300; ++seed) {
        std::vector<double> values = random_values(points.size(), seed);
        // few corners on one side, so that octahedra with two of them occur
        for (double& value : values) value -= seed % 3 == 0 ? 0.5 : seed % 3 == 1 ? 0.2 : 0.8;
        const tile::Signature signature = signature_of(values);
        if (signature == 0 || signature + 1 == tile::Signature{1} << values.size()) continue;
        const auto choices = choices_by_means(faces, values, [&](const tile::Face& face) {
          return face.dim == 2 || (face.dim == 3 && rule == Ambiguity::mean && is_cube_or_cross(face, faces));
        });
        const CellContourOf expected = contour_by_engine(engine, signature, {choices, tile::Alternative::low});
        compare_topology(expected, polytopes, rule, values, [&](const CellContourOf& contour) {
          // the contour in the boundary of the cell is closed
          std::map<std::array<std::size_t, 2>, int> sides;
          for (const auto& [t, sign] : contour.open_triangles())
            for (std::size_t i = 0; i < 3; ++i) sides[{t[i == 0 ? 1 : 0], t[i == 2 ? 1 : 2]}] += i == 1 ? -sign : sign;
          for (const auto& [side, sum] : sides) EXPECT_EQ(0, sum) << signature;
          joined += expected.has_sides ? 1 : 0;
        });
      }
  }
  EXPECT_GT(joined, 100u);
}

// ---------------------------------------------------------------------------------------------------------- meshes

/// Meshes that fill a part of space, alone and within prisms that have tables or not.
std::vector<std::pair<std::string, FacetedMesh>> polytope_meshes() {
  const PolygonMesh mixed = mixed_polygons(5);
  std::vector<std::pair<std::string, FacetedMesh>> meshes;
  meshes.emplace_back("24-cells", cells24(4, 0.02));
  meshes.emplace_back("rhombic", rhombic_cells(1, 0.02));
  meshes.emplace_back("products", products(mixed, mixed, 0.02));
  meshes.emplace_back("24-cells in prisms", with_prisms(cells24(2)));
  meshes.emplace_back("rhombic in prisms", with_prisms(rhombic_cells(0)));
  meshes.emplace_back("rectified in prisms", with_prisms(hull(rectified_simplex_points())));
  meshes.emplace_back("truncated in prisms", with_prisms(hull(truncated_simplex_points())));
  meshes.emplace_back("duoprism in prisms", with_prisms(products(regular_polygon(5), regular_polygon(6))));
  meshes.emplace_back("pyramid in prisms", with_prisms(hull(pyramid_points(prism_points(4), true))));
  meshes.emplace_back("cyclic in prisms", with_prisms(hull(cyclic_points(12))));
  return meshes;
}

TEST(Polytopes, MeshesHaveCellsWithAndWithoutTables) {
  for (const auto& [name, mesh] : polytope_meshes()) {
    const Complex<4> complex = mesh.complex();
    EXPECT_EQ(mesh.cells.size(), complex.cell_count()) << name;
    EXPECT_GT(polytopes_of(complex).size(), 0u) << name;
    if (name == "24-cells") {
      EXPECT_EQ(128u, polytopes_of(complex).size());
      EXPECT_EQ(1u, polytopes_of(complex).shape_count());
    }
    if (name == "products" || name.find("24-cells in") != std::string::npos) {
      EXPECT_GT(complex.cell_count(), polytopes_of(complex).size()) << name;
    }
  }
}

TEST(Polytopes, NoiseHasAClosedOrientedManifoldWithEveryRule) {
  for (const auto& [name, mesh] : polytope_meshes()) {
    Complex<4> complex = mesh.complex();
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules)
        for (const std::uint64_t seed :
             mesh.cells.size() > 60 ? std::vector<std::uint64_t>{1} : std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6}) {
          SCOPED_TRACE(name + (t == Triangulation::compact ? " compact " : " barycentric ") +
                       std::to_string(static_cast<int>(a)) + " " + std::to_string(seed));
          complex.set_values(closed_noise(mesh, seed));
          const double level = 0.3 + 0.1 * static_cast<double>(seed % 3);
          const auto contour = extract<double>(complex, level, polyhedra_options(t, a));
          EXPECT_GT(contour.simplices.size(), 4u);
          expect_closed_manifold(contour);
          EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}),
                    count(complex, level, polyhedra_options(t, a)));
        }
  }
}

TEST(Polytopes, BallsAreSpheresWithSlicesAndTheirVolumesConverge) {
  const auto ball = [](const Point4& x) { return 0.55 - std::hypot(std::hypot(x[0], x[1]), std::hypot(x[2], x[3])); };
  const double content = 0.5 * std::numbers::pi * std::numbers::pi * std::pow(0.55, 4);
  const auto error_of = [&](const FacetedMesh& mesh, Triangulation triangulation) {
    Complex<4> complex = mesh.complex();
    complex.set_values(values_of(mesh, ball));
    const auto contour = extract<double>(complex, 0.0, polyhedra_options(triangulation));
    const MeshReport report = expect_closed_manifold(contour);
    EXPECT_EQ(0, report.euler);
    EXPECT_EQ(1u, report.components);
    const auto cut = slice(contour, Hyperplane<4>::across(3, 0.113));
    EXPECT_EQ(2, expect_closed_manifold(cut).euler);
    return content - measure(contour).content.value();
  };
  for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
    const double coarse = error_of(cells24(6), t), fine = error_of(cells24(13), t);  // edges half as long
    EXPECT_GT(fine, 0.0);
    EXPECT_LT(3.0 * fine, coarse);
    EXPECT_LT(fine, 0.1 * content);
    const auto product = [](Index along) { return products(mixed_polygons(along), mixed_polygons(along)); };
    const double rough = error_of(product(8), t), better = error_of(product(16), t);
    EXPECT_GT(better, 0.0);
    EXPECT_LT(3.0 * better, rough);
  }
}

TEST(Polytopes, LinearFunctionsHaveTheirHyperplaneAndNormals) {
  const auto plane = [](const Point4& x) { return 0.3 * x[0] - 0.5 * x[1] + 0.8 * x[2] + 0.4 * x[3] + 0.013; };
  const double length = std::sqrt(0.09 + 0.25 + 0.64 + 0.16);
  for (const auto& [name, mesh] : polytope_meshes()) {
    SCOPED_TRACE(name);
    Complex<4> complex = mesh.complex();
    complex.set_values(values_of(mesh, plane));
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const GradientDirection direction : {GradientDirection::ascent, GradientDirection::descent}) {
        ExtractOptions options = polyhedra_options(t);
        options.normals = Normals::differences;
        options.direction = direction;
        const auto contour = extract<double>(complex, 0.0, options);
        expect_oriented_manifold(contour);
        const double sign = direction == GradientDirection::ascent ? 1.0 : -1.0;
        for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
          EXPECT_NEAR(0.0, plane(contour.vertices[v]), 1e-12);
          EXPECT_NEAR(sign * 0.8 / length, contour.normals[v][2], 1e-9);
        }
        // simplices face along the direction, except a few in cells that are not convex
        double sum = 0.0, size = 0.0;
        for (const auto& s : contour.simplices) {
          Eigen::Matrix4d rows;
          for (int i = 0; i < 4; ++i)
            for (int k = 0; k < 3; ++k) rows(k, i) = contour.vertices[s[k + 1]][i] - contour.vertices[s[0]][i];
          rows.row(3) << 0.3, -0.5, 0.8, 0.4;
          sum += sign * rows.determinant();
          size += std::abs(rows.determinant());
        }
        EXPECT_GT(sum, 0.98 * size);
      }
  }
}

/// A mesh over the intervals between times, as 4D polytopes by their facets. Points are numbered as by in_time.
FacetedMesh swept_by_facets(const FacedMesh& mesh, const std::vector<double>& times) {
  FacetedMesh result;
  const auto count = static_cast<Index>(mesh.points.size());
  for (const double time : times)
    for (const auto& p : mesh.points) result.points.push_back({p[0], p[1], p[2], time});
  for (Index k = 0; k + 1 < times.size(); ++k)
    for (const CellFaces3& cell : mesh.cells) {
      CellFacets4 facets(2);
      for (const FaceRing& ring : cell)
        for (const Index end : {0u, 1u}) {
          FaceRing& at_end = facets[end].emplace_back(ring);
          for (Index& p : at_end) p += (k + end) * count;
        }
      const CellFaces3 base = facets[0];
      for (const FaceRing& ring : base) {
        CellFaces3& side = facets.emplace_back(2);
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Index a = ring[i], b = ring[(i + 1) % ring.size()];
          side[0].push_back(a);
          side[1].push_back(a + count);
          side.push_back({a, b, b + count, a + count});
        }
      }
      result.add(std::move(facets));
    }
  return result;
}

/// A contour with coordinates rounded to multiples of 2^-30, to compare sums in another order.
Contour<4, double> rounded(Contour<4, double> contour) {
  for (auto& vertex : contour.vertices)
    for (double& x : vertex) x = std::round(x * 0x1p30) * 0x1p-30;
  return contour;
}

TEST(Polytopes, PrismsOverPolyhedraHaveTheContourOverTime) {
  const std::vector<double> times = {0.0, 0.7, 1.0, 2.5};
  for (const auto& [name, mesh] : space_fillings(3, 300, 6)) {
    if (name == "Voronoi") continue;  // prisms of more than 64 corners
    std::vector<double> values;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const auto layer =
          k == 0 || k + 1 == times.size() ? std::vector<double>(mesh.points.size(), -1.0) : closed_noise(mesh, 5 + k);
      values.insert(values.end(), layer.begin(), layer.end());
    }
    const Complex<4> swept = in_time<3>(mesh.complex(), times, values);
    Complex<4> complex = swept_by_facets(mesh, times).complex();
    complex.set_values(values);
    EXPECT_EQ(swept.cell_count(), complex.cell_count());
    EXPECT_EQ(polytopes_of(swept).size(), polytopes_of(complex).size());
    for (const Ambiguity a : kAllRules) {
      SCOPED_TRACE(name + " " + std::to_string(static_cast<int>(a)));
      const auto expected = extract<double>(swept, 0.5, polyhedra_options(Triangulation::barycentric, a));
      const auto contour = extract<double>(complex, 0.5, polyhedra_options(Triangulation::barycentric, a));
      EXPECT_TRUE(same_surface(rounded(expected), rounded(contour)));
      // compact: other diagonals at the times
      const auto compact = extract<double>(complex, 0.5, polyhedra_options(Triangulation::compact, a));
      const MeshReport report = expect_closed_manifold(compact);
      EXPECT_EQ(check(expected).euler, report.euler);
      EXPECT_EQ(check(expected).components, report.components);
      EXPECT_LT(compact.simplices.size(), contour.simplices.size());
    }
  }
}

TEST(Polytopes, KnownShapesAreTheirTypes) {
  const auto shape_of = [](const FacetedMesh& mesh) {
    const Complex<4> complex = mesh.complex();
    EXPECT_EQ(1u, detail::ComplexAccess::cells(complex).groups.size());
    return detail::ComplexAccess::cells(complex).groups.at(0).shape;
  };
  using tables::CellShape;
  const std::vector<std::array<double, 3>> tetrahedron = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_EQ(CellShape::simplex4, shape_of(hull(pyramid_points(tetrahedron, false))));
  EXPECT_EQ(CellShape::cell16, shape_of(hull(pyramid_points(octahedron_points(), true))));
  EXPECT_EQ(CellShape::wedge_prism, shape_of(hull(duoprism_points(3, 4))));
  EXPECT_EQ(CellShape::hexahedron_prism, shape_of(hull(duoprism_points(4, 4))));
  const auto prism_over = [](std::vector<std::array<double, 3>> base) {
    std::vector<Point4> points;
    for (const double w : {-1.0, 1.0})
      for (const auto& p : base) points.push_back({p[0], p[1], p[2], w});
    return hull(points);
  };
  EXPECT_EQ(CellShape::tetrahedron_prism, shape_of(prism_over(tetrahedron)));
  EXPECT_EQ(CellShape::octahedron_prism, shape_of(prism_over(octahedron_points())));
  EXPECT_EQ(CellShape::pyramid_prism,
            shape_of(prism_over({{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, 1}})));
}

/// Prisms given by their facets are those with their types. Another order of facets and faces gives a contour with the
/// same topology, in which other simplices fill components that are no spheres.
TEST(Polytopes, CellsWithTablesGivenAsPolytopesHaveTheSameContour) {
  for (auto& [name, mesh] : polytope_meshes()) {
    if (name.find("prisms") == std::string::npos) continue;
    SCOPED_TRACE(name);
    Complex<4> one = mesh.complex();
    FacetedMesh by_facets = mesh;
    for (auto& known : by_facets.known) known = {CellType::polytope, {}};
    Complex<4> same = by_facets.complex();
    std::mt19937_64 random(2);
    for (CellFacets4& cell : by_facets.cells) {
      std::shuffle(cell.begin(), cell.end(), random);
      for (CellFaces3& facet : cell) {
        std::shuffle(facet.begin(), facet.end(), random);
        for (FaceRing& ring : facet)
          if (random() % 2 == 0) std::reverse(ring.begin(), ring.end());
      }
    }
    Complex<4> other = by_facets.complex();
    EXPECT_EQ(polytopes_of(one).size(), polytopes_of(same).size());
    EXPECT_EQ(polytopes_of(one).size(), polytopes_of(other).size());
    const auto values = closed_noise(mesh, 4);
    for (Complex<4>* const complex : {&one, &same, &other}) complex->set_values(values);
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules) {
        const auto options = polyhedra_options(t, a);
        const auto expected = extract<double>(one, 0.4, options), contour = extract<double>(other, 0.4, options);
        EXPECT_TRUE(same_surface(expected, extract<double>(same, 0.4, options)));
        const MeshReport report = check(expected), found = expect_closed_manifold(contour);
        EXPECT_EQ(report.euler, found.euler);
        EXPECT_EQ(report.components, found.components);
        const double content = measure(expected).content.value();
        EXPECT_NEAR(content, measure(contour).content.value(), 0.05 * content);
      }
  }
}

TEST(Polytopes, ResultsAreTheSameBytesWithAnyThreadsKnownEdgesAndAnIndex) {
  for (const auto& [name, mesh] : polytope_meshes()) {
    SCOPED_TRACE(name);
    Complex<4> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 9));
    Complex<4> known = complex;
    known.find_edges({3, {}});
    const CellIndex index(complex);
    for (const Ambiguity a : {Ambiguity::low, Ambiguity::saddle}) {
      const auto one = extract(complex, 0.4, polyhedra_options(Triangulation::compact, a, 1));
      for (const unsigned threads : {1u, 3u}) {
        const auto options = polyhedra_options(Triangulation::compact, a, threads);
        for (const auto& other : {extract(complex, 0.4, options), extract(known, 0.4, options),
                                  extract(complex, index, 0.4, options), extract(known, index, 0.4, options)}) {
          EXPECT_TRUE(one.vertices == other.vertices);
          EXPECT_TRUE(one.simplices == other.simplices);
        }
      }
    }
  }
}

TEST(Polytopes, CapsCloseContoursAtTheBorder) {
  for (const auto& [name, mesh] : polytope_meshes()) {
    if (name == "24-cells" || name == "rhombic") continue;  // their borders touch themselves
    Complex<4> complex = mesh.complex();
    for (const std::uint64_t seed : {3u, 4u}) {
      const std::vector<double> values = random_values(mesh.points.size(), seed);
      for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
        for (const Ambiguity a : kAllRules) {
          SCOPED_TRACE(name + (t == Triangulation::compact ? " compact " : " barycentric ") +
                       std::to_string(static_cast<int>(a)));
          ExtractOptions options = polyhedra_options(t, a);
          options.close = true;
          complex.set_values(values);
          const auto contour = extract<double>(complex, 0.5, options);
          expect_closed_manifold(contour);
          EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, options));
        }
    }
  }
}

/// One polytope with random values and caps: its facets are all capped.
TEST(Polytopes, CapsCloseSingleCells) {
  for (const auto& points : {cell24_points(), duoprism_points(3, 5), rectified_simplex_points(),
                             truncated_simplex_points(), rhombic_cells(0).points, cyclic_points(10),
                             pyramid_points(prism_points(4), true), pyramid_points(prism_points(5), false)}) {
    const FacetedMesh mesh = hull(points);
    Complex<4> complex = mesh.complex();
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules)
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
          SCOPED_TRACE(std::to_string(points.size()) + " corners, " + std::to_string(static_cast<int>(a)) + ", seed " +
                       std::to_string(seed));
          ExtractOptions options = polyhedra_options(t, a);
          options.close = true;
          complex.set_values(random_values(mesh.points.size(), seed));
          expect_closed_manifold(extract<double>(complex, seed % 2 == 0 ? 0.5 : 0.75, options));
        }
    complex.set_values(std::vector<double>(mesh.points.size(), 1.0));
    ExtractOptions options;
    options.close = true;
    const auto border = extract<double>(complex, 0.5, options);
    EXPECT_EQ(0, expect_closed_manifold(border).euler);
    EXPECT_GT(measure(border).content.value(), 0.1);
  }
}

TEST(Polytopes, CapsHaveTheVolumeOfTheMesh) {
  FacetedMesh mesh = hull(cell24_points());  // with edges of length 1 it has the volume 2
  Complex<4> complex = mesh.complex();
  complex.set_values(std::vector<double>(mesh.points.size(), 1.0));
  ExtractOptions options;
  options.close = true;
  EXPECT_NEAR(2.0, measure(extract<double>(complex, 0.5, options)).content.value(), 1e-12);
}

TEST(Polytopes, MissingValuesLeaveAManifoldWithBoundary) {
  for (const auto& [name, mesh] : polytope_meshes()) {
    if (mesh.cells.size() < 60) continue;
    SCOPED_TRACE(name);
    Complex<4> complex = mesh.complex();
    complex.set_values(with_missing(closed_noise(mesh, 31)));
    for (const Ambiguity a : {Ambiguity::low, Ambiguity::mean}) {
      const ExtractOptions options = polyhedra_options(Triangulation::compact, a);
      const auto contour = extract(complex, 0.4, options);
      EXPECT_GT(expect_oriented_manifold(contour).boundary_simplices, 10u);
      EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.4, options));
    }
  }
}

TEST(Polytopes, EpsilonKeepsVerticesFromCorners) {
  const FacetedMesh mesh = cells24(4);
  Complex<4> complex = mesh.complex();
  std::vector<double> values = closed_noise(mesh, 2);
  for (double& value : values) value = std::round(4.0 * value) / 4.0;
  complex.set_values(values);
  ExtractOptions options;
  EXPECT_GT(expect_closed_manifold(extract<double>(complex, 0.5, options)).degenerate_simplices, 0u);
  options.epsilon = 0.01;
  EXPECT_EQ(0u, expect_closed_manifold(extract<double>(complex, 0.5, options)).degenerate_simplices);
}

TEST(Polytopes, SixtyFourCornersHaveAnEdgeBetweenAnyTwo) {
  const FacetedMesh mesh = [] {  // Gale's evenness condition: the facets of a cyclic polytope
    FacetedMesh cyclic;
    constexpr Index kCount = 64;
    cyclic.points = cyclic_points(kCount);
    CellFacets4 facets;
    for (Index i = 0; i < kCount; ++i)
      for (Index j = i + 2; j < kCount; ++j) {
        if ((j + 1) % kCount == i) continue;
        const std::array<Index, 4> c = {i, (i + 1) % kCount, j, (j + 1) % kCount};
        facets.push_back({{c[0], c[1], c[2]}, {c[0], c[1], c[3]}, {c[0], c[2], c[3]}, {c[1], c[2], c[3]}});
      }
    cyclic.add(std::move(facets));
    return cyclic;
  }();
  EXPECT_EQ(1952u, mesh.cells[0].size());
  Complex<4> complex = mesh.complex();
  complex.find_edges();
  EXPECT_EQ(2016u, complex.edge_count());
  for (const Ambiguity a : {Ambiguity::low, Ambiguity::mean})
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
      complex.set_values(random_values(64, 3));
      ExtractOptions options = polyhedra_options(t, a);
      options.close = true;
      expect_closed_manifold(extract<double>(complex, 0.5, options));
    }
}

// ----------------------------------------------------------------------------------------------------------- errors

/// Errors of the second one of two duoprisms of triangles and pentagons, changed by `change`.
void expect_refused(const std::string& message, const std::function<void(FacetedMesh&)>& change) {
  FacetedMesh mesh = products(regular_polygon(3), regular_polygon(5));
  mesh.add(mesh.cells[0]);
  change(mesh);
  expect_error(ErrorCode::InvalidArgument, message, [&] { (void)mesh.complex(); });
}

TEST(Polytopes, ErrorsNameTheCellAndWhatWasExpected) {
  expect_refused("cell 1: a polytope of 4 facets; expected 5 to 1952", [](FacetedMesh& m) { m.cells[1].resize(4); });
  expect_refused("cell 1: the face of the points", [](FacetedMesh& m) { m.cells[1].pop_back(); });
  expect_refused("only; expected two facets: a closed polytope", [](FacetedMesh& m) { m.cells[1].pop_back(); });
  expect_refused("expected two facets", [](FacetedMesh& m) { m.cells[1].push_back(m.cells[1][0]); });
  expect_refused("cell 1, facet 2: a polyhedron of 3 faces; expected 4 to 124",
                 [](FacetedMesh& m) { m.cells[1][2].resize(3); });
  expect_refused("cell 1, facet 0: face 1 has the point 15; expected a number below 15",
                 [](FacetedMesh& m) { m.cells[1][0][1][0] = 15; });
  expect_refused("cell 1, facet 3: face 0 has the point",
                 [](FacetedMesh& m) { m.cells[1][3][0][0] = m.cells[1][3][0][1]; });
  expect_refused("in another order in the facet", [](FacetedMesh& m) {  // a pentagon with other edges on one side
    FaceRing &face = m.cells[1][0][0], &above = m.cells[1][0][1];
    std::swap(face[1], face[2]);
    std::swap(above[1], above[2]);
    CellFaces3& facet = m.cells[1][0];
    facet.resize(2);
    for (std::size_t i = 0; i < 5; ++i) facet.push_back({face[i], face[(i + 1) % 5], above[(i + 1) % 5], above[i]});
  });
  expect_refused("of 16 facets are connected by faces; expected all", [](FacetedMesh& m) {  // two in one cell
    const auto count = static_cast<Index>(m.points.size());
    for (Index p = 0; p < count; ++p) m.points.push_back(m.points[p]);
    for (CellFaces3 facet : m.cells[0]) {
      for (FaceRing& ring : facet)
        for (Index& p : ring) p += count;
      m.cells[1].push_back(facet);
    }
  });
  expect_refused("point 14 is in a face and not among the corners",
                 [](FacetedMesh& m) { m.known[1].second = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}; });
  expect_refused("a polytope of more than 64 corners; expected at most 64",
                 [](FacetedMesh& m) { m = products(regular_polygon(5), regular_polygon(13)); });
}

/// Pyramids with two apexes over the faces of a closed surface: a sphere if the surface is one.
FacetedMesh double_cone(const CellFaces3& surface, Index points) {
  FacetedMesh mesh;
  for (Index p = 0; p < points + 2; ++p) mesh.points.push_back({double(p), double(p * p), double(p * p * p), 1.0});
  CellFacets4 facets;
  for (const Index apex : {points, points + 1})
    for (const FaceRing& face : surface) {
      CellFaces3& facet = facets.emplace_back();
      facet.push_back(face);
      for (std::size_t i = 0; i < face.size(); ++i) facet.push_back({face[i], face[(i + 1) % face.size()], apex});
    }
  mesh.add(std::move(facets));
  return mesh;
}

/// Squares around a torus or, if it is `twisted`, around a Klein bottle.
CellFaces3 ring_of_squares(Index around, bool twisted) {
  const auto at = [&](Index i, Index j) {
    const Index across = twisted && i == around ? 2 * around - j : j;
    return i % around * around + across % around;
  };
  CellFaces3 faces;
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < around; ++j) faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return faces;
}

TEST(Polytopes, SurfacesAroundThemThatAreNoSpheresAreRefused) {
  const auto expect_refusal = [](const std::string& message, const FacetedMesh& mesh) {
    expect_error(ErrorCode::InvalidArgument, message, [&] { (void)mesh.complex(); });
  };
  expect_refusal(
      "cell 0: at the point 9 are 9 edges, 18 faces and 9 facets, with the Euler characteristic 0; expected 2, that of "
      "a "
      "sphere around the point",
      double_cone(ring_of_squares(3, false), 9));
  expect_refusal("cannot have one orientation; expected a sphere around the polytope",
                 double_cone(ring_of_squares(4, true), 16));
  // a sphere whose poles are the same point 0, with three rings of four points between them
  CellFaces3 pinched;
  for (Index i = 0; i < 4; ++i) {
    const Index next = (i + 1) % 4;
    pinched.push_back({0, 1 + i, 1 + next});
    pinched.push_back({1 + i, 1 + next, 5 + next, 5 + i});
    pinched.push_back({5 + i, 5 + next, 9 + next, 9 + i});
    pinched.push_back({0, 9 + i, 9 + next});
  }
  expect_refusal(
      "cell 0: the facets at the edge between the points 0 and 13 are 2 cycles; expected one around the edge",
      double_cone(pinched, 13));
  // three quadrilaterals between two poles: two of them have both poles and a third point in common
  expect_refusal(
      "cell 0: the facets 0 and 1 share 4 points, among them 0 and 5; expected nothing, a point, an edge or a face",
      double_cone({{0, 2, 1, 3}, {0, 3, 1, 4}, {0, 4, 1, 2}}, 5));
}

/// A torus of 27 cubes has the characteristics of a sphere, but curves that do not bound.
TEST(Polytopes, ATorusOfCubesIsNoCell) {
  FacetedMesh mesh;
  const auto at = [](Index i, Index j, Index k) { return i % 3 + 3 * (j % 3) + 9 * (k % 3); };
  for (Index p = 0; p < 27; ++p) mesh.points.push_back({double(p), double(p * p), double(p * p * p), 1.0});
  CellFacets4 facets;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j)
      for (Index k = 0; k < 3; ++k) {
        const std::array<Index, 8> c = {
            at(i, j, k),     at(i + 1, j, k),     at(i + 1, j + 1, k),     at(i, j + 1, k),
            at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)};
        facets.push_back(faces_of(CellType::hexahedron, c.data()));
      }
  mesh.add(std::move(facets));
  expect_error(ErrorCode::InvalidArgument,
               "cell 0: 52 of 55 independent closed curves of edges bound faces; expected all",
               [&] { (void)mesh.complex(); });
}

TEST(Polytopes, ListsAreChecked) {
  const CellLists lists = products(regular_polygon(3), regular_polygon(5)).lists();
  const auto expect_refusal = [&](const std::string& message, const CellLists& changed) {
    expect_error(ErrorCode::InvalidArgument, message, [&] { Complex<4>(std::vector<Point4>(15), changed); });
  };
  CellLists changed = lists;
  changed.facet_lists_ends.push_back(0);
  expect_refusal("2 ends of lists of facets; expected one for each of the 1 cells, or none", changed);
  changed = lists;
  changed.facet_lists_ends = {7};
  expect_refusal("the last end of lists of facets is 7; expected 8", changed);
  changed = lists;
  std::swap(changed.facet_ends[0], changed.facet_ends[1]);
  expect_refusal("of facets: ", changed);
  changed = lists;
  changed.face_lists_ends = {8};
  expect_refusal("1 ends of lists of faces beside 8 facets; expected none", changed);
  changed = lists;
  changed.types[0] = CellType::polyhedron;
  expect_refusal("cell 0: type 42 (polyhedron); expected a 4D cell", changed);
  changed = lists;
  changed.facet_ends.clear();
  changed.facet_lists_ends.clear();
  expect_refusal("the last end of lists of faces is 0", changed);
  expect_error(ErrorCode::InvalidArgument, "cell 0: type 103 (polytope)", [] {
    Complex<4>(std::vector<Point4>(5), CellType::polytope, std::vector<Index>{0, 1, 2, 3, 4});
  });
  expect_error(ErrorCode::InvalidArgument, "cell type 103", [] { (void)corner_count(CellType::polytope); });
  EXPECT_EQ(4, dimension(CellType::polytope));
  EXPECT_EQ("polytope", name_of(CellType::polytope));
}

}  // namespace
}  // namespace tegl
