// SPDX-License-Identifier: BSD-3-Clause
//
// Polyhedra in complexes: all signatures of single cells against the general engine, and meshes of polyhedra alone and
// with other cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compare.hpp"
#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "complex/complex_edges.hpp"
#include "complex/polyhedral_cases.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "tegl/cell_index.hpp"
#include "tegl/complex.hpp"
#include "tegl/measure.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl {
namespace {

using namespace test;

/// A vertex as the crossed edges around it: its own, or those of the loop of which it is the barycentre.
using Around = std::set<std::array<unsigned, 2>>;
/// A triangle from its smallest vertex on.
using Triangle = std::array<Around, 3>;

Triangle rotated(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// The contour of one cell by the general engine.
std::set<Triangle> by_engine(tile::FacetBuilder& builder, tile::Signature signature,
                             const tile::Resolution& resolution) {
  const tile::TileFacets& facets = builder.build(signature, resolution);
  const auto around = [&](std::size_t v) {
    const tile::Vertex& vertex = facets.vertices[v];
    Around edges;
    const auto add = [&](std::uint32_t face) {
      const tile::Signature corners = builder.lattice().faces()[face].corners;
      edges.insert(
          {static_cast<unsigned>(std::countr_zero(corners)), 63u - static_cast<unsigned>(std::countl_zero(corners))});
    };
    if (vertex.kind == tile::VertexKind::edge) add(vertex.face);
    for (const auto& simplex : vertex.of)
      for (std::size_t i = 0; i < 2; ++i) add(facets.vertices[simplex[i]].face);
    return edges;
  };
  std::set<Triangle> triangles;
  for (const tile::Facet& facet : facets.facets)
    for (const auto& s : facet.simplices) triangles.insert(rotated({around(s[0]), around(s[1]), around(s[2])}));
  return triangles;
}

/// The same by the library, from a cell whose values are 1 and -1: vertices on edges are in the middle.
std::set<Triangle> by_library(const Complex<3>& complex, const Contour<3, double>& contour) {
  const auto& points = complex.points();
  std::vector<Around> around(contour.vertices.size());
  for (std::size_t v = 0; v < around.size(); ++v)
    for (const auto& [a, b] : detail::ComplexAccess::edges(complex)->ends) {
      double distance = 0;
      for (std::size_t i = 0; i < 3; ++i)
        distance += std::abs((points[a][i] + points[b][i]) / 2 - contour.vertices[v][i]);
      if (distance < 1e-9) around[v] = {{a, b}};
    }
  std::vector<bool> is_centre;
  for (const Around& edges : around) is_centre.push_back(edges.empty());
  for (const auto& t : contour.simplices)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (is_centre[t[i]] && j != i) around[t[i]].insert(*around[t[j]].begin());
  std::set<Triangle> triangles;
  for (const auto& t : contour.simplices) triangles.insert(rotated({around[t[0]], around[t[1]], around[t[2]]}));
  return triangles;
}

/// Compares signatures of a cell, of both fixed rules. Every `step`-th signature from a random one on.
void expect_contours_of_engine(const std::vector<std::array<double, 3>>& points, std::uint64_t step) {
  const FacedMesh mesh = hull(points);
  Complex<3> complex = mesh.complex();
  complex.find_edges();
  std::vector<tile::Signature> faces;
  for (const FaceRing& ring : mesh.cells[0]) {
    tile::Signature& bits = faces.emplace_back(0);
    for (const Index p : ring) bits |= tile::Signature{1} << p;
  }
  tile::FacetBuilder builder(tile::FaceLattice(3, faces));
  std::mt19937_64 random(points.size());
  const std::uint64_t count = std::uint64_t{1} << points.size();
  std::size_t reversed = 0, compared = 0;
  for (std::uint64_t s = step == 1 ? 1 : random() % step; s + 1 < count; s += step) {
    if (s == 0) continue;
    std::vector<double> values;
    for (std::size_t v = 0; v < points.size(); ++v) values.push_back((s >> v & 1u) != 0 ? 1.0 : -1.0);
    complex.set_values(values);
    for (const Ambiguity rule : {Ambiguity::low, Ambiguity::high}) {
      const auto alternative = rule == Ambiguity::low ? tile::Alternative::low : tile::Alternative::high;
      const auto expected = by_engine(builder, s, {{}, alternative});
      ExtractOptions options = polyhedra_options(Triangulation::barycentric, rule);
      options.direction = GradientDirection::ascent;
      const auto ascending = extract<double>(complex, 0.0, options);
      options.direction = GradientDirection::descent;
      const auto descending = extract<double>(complex, 0.0, options);
      ++compared;
      if (by_library(complex, descending) == expected)
        ++reversed;
      else
        ASSERT_TRUE(by_library(complex, ascending) == expected) << s;
      // compact: the same discs
      const auto compact = extract<double>(complex, 0.0, polyhedra_options(Triangulation::compact, rule));
      const MeshReport one = expect_oriented_manifold(compact), other = expect_oriented_manifold(ascending);
      EXPECT_EQ(other.components, one.components);
      EXPECT_EQ(other.euler, one.euler);
      EXPECT_EQ(boundary_faces(ascending).size(), boundary_faces(compact).size());
    }
  }
  EXPECT_GT(compared, 500u);
  EXPECT_TRUE(reversed == 0 || reversed == compared);  // the lattice has one orientation
}

TEST(Polyhedra, AllContoursOfPentagonalAndHexagonalPrismsAreThoseOfTheEngine) {
  expect_contours_of_engine(prism_points(5), 1);
  expect_contours_of_engine(prism_points(6), 1);
}

TEST(Polyhedra, ContoursOfDodecahedraAndTruncatedOctahedraAreThoseOfTheEngine) {
  expect_contours_of_engine(dodecahedron_points(), 997);
  expect_contours_of_engine(truncated_octahedron_points(), 16381);
}

std::vector<std::pair<std::string, FacedMesh>> meshes() { return space_fillings(7, 1500, 13); }

TEST(Polyhedra, MeshesHavePolyhedraOfManyShapes) {
  for (const auto& [name, mesh] : meshes()) {
    const Complex<3> complex = mesh.complex();
    const auto& cells = detail::ComplexAccess::cells(complex);
    EXPECT_GT(cells.polytopes.size(), 300u) << name;
    EXPECT_EQ(mesh.cells.size(), complex.cell_count()) << name;
    if (name == "truncated octahedra") {
      EXPECT_EQ(1u, cells.polytopes.shape_count());
    } else if (name == "merged mixed") {
      EXPECT_EQ(4u, cells.groups.size());
    }
  }
}

TEST(Polyhedra, NoiseHasAClosedOrientedManifoldWithEveryRule) {
  for (const auto& [name, mesh] : meshes()) {
    Complex<3> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 11));
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules) {
        SCOPED_TRACE(name);
        const auto contour = extract(complex, 0.5, polyhedra_options(t, a));
        EXPECT_GT(contour.simplices.size(), 1000u);
        EXPECT_EQ(0u, expect_closed_manifold(contour).degenerate_simplices);
        EXPECT_GT(measure(contour).content.value(), 0.0);
        EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}),
                  count(complex, 0.5, polyhedra_options(t, a)));
      }
  }
}

TEST(Polyhedra, RulesDifferWherePolygonsAreAmbiguous) {
  const FacedMesh mesh = truncated_octahedra(5, 0.1);
  Complex<3> complex = mesh.complex();
  complex.set_values(closed_noise(mesh, 1));
  std::set<double> volumes;
  for (const Ambiguity a : kAllRules)
    volumes.insert(
        measure(extract<double>(complex, 0.5, polyhedra_options(Triangulation::compact, a))).content.value());
  EXPECT_EQ(4u, volumes.size());  // squares as mean, decider as saddle: polygons are discs
}

TEST(Polyhedra, CompactContoursHaveFewBarycentres) {
  const FacedMesh mesh = truncated_octahedra(7, 0.1);
  Complex<3> complex = mesh.complex();
  complex.find_edges();
  complex.set_values(values_of(mesh, test::ball<3>));
  const auto compact = extract(complex, 0.0, polyhedra_options(Triangulation::compact));
  const auto barycentric = extract(complex, 0.0, polyhedra_options(Triangulation::barycentric));
  EXPECT_LT(2 * compact.simplices.size(), barycentric.simplices.size() + compact.simplices.size());
  EXPECT_LT(compact.vertices.size(), barycentric.vertices.size());
}

TEST(Polyhedra, ResultsAreTheSameBytesWithAnyThreadsKnownEdgesAndAnIndex) {
  for (const auto& [name, mesh] : meshes()) {
    SCOPED_TRACE(name);
    Complex<3> complex = mesh.complex();
    complex.set_values(closed_noise(mesh, 4));
    const auto one = extract(complex, 0.5, polyhedra_options(Triangulation::compact, Ambiguity::saddle, 1));
    Complex<3> known = complex;
    known.find_edges({3, {}});
    const CellIndex index(complex);
    for (const unsigned threads : {1u, 2u, 3u}) {
      const auto options = polyhedra_options(Triangulation::compact, Ambiguity::saddle, threads);
      for (const auto& other : {extract(complex, 0.5, options), extract(known, 0.5, options),
                                extract(complex, index, 0.5, options), extract(known, index, 0.5, options)}) {
        EXPECT_TRUE(one.vertices == other.vertices);
        EXPECT_TRUE(one.simplices == other.simplices);
      }
    }
  }
}

TEST(Polyhedra, EdgesAreThoseOfAllFaces) {
  for (const auto& [name, mesh] : meshes()) {
    std::set<std::array<Index, 2>> edges;
    for (const CellFaces3& cell : mesh.cells)
      for (const FaceRing& ring : cell)
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const auto [p, q] = std::minmax(ring[i], ring[(i + 1) % ring.size()]);
          edges.insert({p, q});
        }
    Complex<3> complex = mesh.complex();
    complex.find_edges();
    EXPECT_EQ(edges.size(), complex.edge_count()) << name;
  }
}

TEST(Polyhedra, CapsCloseContoursAtTheBorder) {
  for (const auto& [name, mesh] : meshes()) {
    std::mt19937_64 random(5);
    std::vector<double> values;
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
      values.push_back(static_cast<double>(random() >> 11) * 0x1p-53);
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules) {
        if (name == "Voronoi" && a != Ambiguity::low) continue;  // its border touches itself
        SCOPED_TRACE(name);
        Complex<3> complex = mesh.complex();
        complex.set_values(values);
        ExtractOptions options = polyhedra_options(t, a);
        options.close = true;
        const auto contour = extract(complex, 0.5, options);
        const MeshReport report = check(contour);
        EXPECT_EQ(0u, report.boundary_simplices);
        if (name == "Voronoi") continue;
        EXPECT_TRUE(is_closed_oriented_manifold(report));
        complex.find_border();
        const auto known = extract(complex, 0.5, options);
        EXPECT_TRUE(contour.vertices == known.vertices && contour.simplices == known.simplices);
        EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, options));
      }
    // all high: the caps are the border, with the volume of the mesh
    Complex<3> complex = mesh.complex();
    complex.set_values(std::vector<double>(values.size(), 1.0));
    ExtractOptions options;
    options.close = true;
    const double volume = measure(extract<double>(complex, 0.5, options)).content.value();
    if (name.substr(0, 6) == "merged")
      EXPECT_NEAR(8.0, volume, 1e-12) << name;
    else
      EXPECT_GT(volume, 2.0) << name;
  }
}

TEST(Polyhedra, MissingValuesLeaveAManifoldWithBoundary) {
  for (const auto& [name, mesh] : meshes()) {
    SCOPED_TRACE(name);
    Complex<3> complex = mesh.complex();
    complex.set_values(with_missing(closed_noise(mesh, 31)));
    expect_boundary_beside_missing(complex);
  }
}

TEST(Polyhedra, LinearFunctionsHaveTheirPlaneNormalsAndAttributes) {
  const auto plane = [](const std::array<double, 3>& x) { return 0.3 * x[0] - 0.5 * x[1] + 0.8 * x[2] + 0.013; };
  for (const auto& [name, mesh] : meshes()) {
    SCOPED_TRACE(name);
    Complex<3> complex = mesh.complex();
    complex.set_values(values_of(mesh, plane));
    ExtractOptions options = polyhedra_options(Triangulation::barycentric);
    options.normals = Normals::differences;
    const auto contour = extract<double>(complex, 0.0, options);
    const double length = std::sqrt(0.3 * 0.3 + 0.5 * 0.5 + 0.8 * 0.8);
    EXPECT_GT(contour.vertices.size(), 100u);
    for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
      EXPECT_NEAR(0.0, plane(contour.vertices[v]), 1e-12);
      EXPECT_NEAR(-0.8 / length, contour.normals[v][2], 1e-9);
    }
    const auto numbers = values_of(mesh, [](const auto& x) { return 2 * x[0] - x[2]; });
    const Attribute attribute = interpolate_points<3>(complex, 0.0, numbers, "a", "", options);
    for (std::size_t v = 0; v < contour.vertices.size(); ++v)
      EXPECT_NEAR(2 * contour.vertices[v][0] - contour.vertices[v][2], attribute.values[v], 1e-12);
  }
}

TEST(Polyhedra, SpheresAndToriHaveTheirEulerCharacteristic) {
  const auto ring = [](const std::array<double, 3>& x) {
    return 0.22 - std::hypot(std::hypot(x[0] + 0.011, x[1] - 0.013) - 0.5, x[2] + 0.017);
  };
  const MeshData<3> points = grid_points<3>({24, 24, 24}, 0.1);
  const std::vector<FacedMesh> fine = {truncated_octahedra(14, 0.1), voronoi_cells(30000, 8),
                                       merged(faced(mixed_mesh(points, 5)), 0.5, 3)};
  for (const FacedMesh& mesh : fine) {
    Complex<3> complex = mesh.complex();
    complex.set_values(values_of(mesh, test::ball<3>));
    const MeshReport sphere = expect_closed_manifold(extract(complex, 0.0));
    EXPECT_EQ(1u, sphere.components);
    EXPECT_EQ(2, sphere.euler);
    complex.set_values(values_of(mesh, ring));
    const MeshReport torus = expect_closed_manifold(extract(complex, 0.0));
    EXPECT_EQ(1u, torus.components);
    EXPECT_EQ(0, torus.euler);
  }
}

// Minutes: only with `ctest -C long`.
TEST(Polyhedra, DISABLED_MeshesOf100000CellsHaveClosedOrientedManifolds) {
  const MeshData<3> points = grid_points<3>({45, 45, 45}, 0.1);
  std::vector<std::pair<std::string, FacedMesh>> large;
  large.emplace_back("truncated octahedra", truncated_octahedra(37, 0.1));
  large.emplace_back("Voronoi", voronoi_cells(110000, 5));
  large.emplace_back("merged mixed", merged(faced(mixed_mesh(points, 5)), 0.5, 3));
  for (const auto& [name, mesh] : large) {
    Complex<3> complex = mesh.complex();
    EXPECT_GT(complex.cell_count(), 95000u) << name;
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules) {
        SCOPED_TRACE(name);
        complex.set_values(closed_noise(mesh, 7));
        const auto noise = extract(complex, 0.5, polyhedra_options(t, a));
        EXPECT_GT(noise.simplices.size(), 300000u);
        expect_closed_manifold(noise);
        EXPECT_EQ((ContourSize{noise.vertices.size(), noise.simplices.size()}),
                  count(complex, 0.5, polyhedra_options(t, a)));
        complex.set_values(values_of(mesh, test::ball<3>));
        const MeshReport sphere = expect_closed_manifold(extract(complex, 0.0, polyhedra_options(t, a)));
        EXPECT_EQ(1u, sphere.components);
        EXPECT_EQ(2, sphere.euler);
      }
    const auto one = extract(complex, 0.0, polyhedra_options(Triangulation::compact, Ambiguity::low, 1));
    complex.find_edges();
    const auto other = extract(complex, 0.0, polyhedra_options(Triangulation::compact, Ambiguity::low, 3));
    EXPECT_TRUE(one.vertices == other.vertices && one.simplices == other.simplices) << name;
  }
}

TEST(Polyhedra, AreaAndVolumeConvergeWithOrderTwo) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * 0.343, area = 4.0 * std::numbers::pi * 0.49;
  const auto errors = [&](int count) {
    const FacedMesh mesh = truncated_octahedra(count, 0.0);
    Complex<3> complex = mesh.complex();
    complex.set_values(values_of(mesh, test::ball<3>));
    const Measures<3> measures = measure(extract<double>(complex, 0.0));
    return std::array{std::abs(measures.content.value() - volume), std::abs(measures.size - area)};
  };
  const auto coarse = errors(8), fine = errors(25);  // cells of 4 / 17 and 4 / 51
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(2.0, std::log(coarse[i] / fine[i]) / std::log(3.0), 0.35) << i;
}

TEST(Polyhedra, AnOtherOrientationOrOrderOfFacesGivesTheSameSurface) {
  FacedMesh mesh = truncated_octahedra(5, 0.1);
  Complex<3> complex = mesh.complex();
  const auto values = closed_noise(mesh, 4);
  complex.set_values(values);
  const auto one = extract(complex, 0.5, polyhedra_options(Triangulation::barycentric));
  std::mt19937_64 random(1);
  for (CellFaces3& cell : mesh.cells) {
    std::shuffle(cell.begin(), cell.end(), random);
    for (FaceRing& ring : cell) {
      if (random() % 2 == 0) std::reverse(ring.begin(), ring.end());
      std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(random() % ring.size()), ring.end());
    }
  }
  Complex<3> other = mesh.complex();
  EXPECT_GT(detail::ComplexAccess::cells(other).polytopes.shape_count(), 100u);
  other.set_values(values);
  EXPECT_TRUE(same_surface(one, extract(other, 0.5, polyhedra_options(Triangulation::barycentric))));
}

TEST(Polyhedra, CellsWithTablesGivenAsPolyhedraHaveTheSameContour) {
  const MeshData<3> points = grid_points<3>({9, 9, 9}, 0.1);
  for (const MeshData<3>& mesh : {cube_mesh(points, true), five_tetrahedra_mesh(points), wedge_mesh(points),
                                  pyramid_mesh(points), mixed_mesh(points, 5)}) {
    FacedMesh by_faces = faced(mesh);
    std::mt19937_64 random(2);
    for (std::size_t c = 0; c < by_faces.cells.size(); ++c) {
      by_faces.known[c] = {CellType::polyhedron, {}};
      std::shuffle(by_faces.cells[c].begin(), by_faces.cells[c].end(), random);
    }
    Complex<3> one = mesh.complex(), other = by_faces.complex();
    EXPECT_EQ(0u, detail::ComplexAccess::cells(other).polytopes.size());
    const auto values = closed_noise(mesh, 4);
    one.set_values(values);
    other.set_values(values);
    for (const Ambiguity a : kAllRules) {
      const auto options = polyhedra_options(Triangulation::barycentric, a);
      const auto expected = extract(one, 0.5, options), contour = extract(other, 0.5, options);
      expect_closed_manifold(contour);
      EXPECT_EQ(expected.vertices.size(), contour.vertices.size());
      if (a == Ambiguity::low || a == Ambiguity::high) {
        EXPECT_TRUE(same_surface(expected, contour));
      }
    }
  }
  const FacedMesh octahedron = hull({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  EXPECT_EQ(tables::CellShape::octahedron, detail::ComplexAccess::cells(octahedron.complex()).groups.at(0).shape);
}

/// Errors of a cube with two squares in place of one, changed by `change`.
void expect_refused(const std::string& message, const std::function<void(FacedMesh&)>& change) {
  FacedMesh mesh = hull(prism_points(5));
  mesh.add(mesh.cells[0]);
  change(mesh);
  expect_error(ErrorCode::InvalidArgument, message, [&] { (void)mesh.complex(); });
}

TEST(Polyhedra, ErrorsNameTheCellAndWhatWasExpected) {
  const auto longest = [](FacedMesh& mesh) -> FaceRing& {
    return *std::max_element(mesh.cells[1].begin(), mesh.cells[1].end(),
                             [](const FaceRing& a, const FaceRing& b) { return a.size() < b.size(); });
  };
  expect_refused("cell 1: a polyhedron of 3 faces; expected 4 to 124", [](FacedMesh& m) { m.cells[1].resize(3); });
  expect_refused("only; expected two faces: a closed polyhedron", [](FacedMesh& m) { m.cells[1].pop_back(); });
  expect_refused("has 2 corners; expected at least 3", [](FacedMesh& m) { m.cells[1][2].resize(2); });
  expect_refused("cell 1: face 0 has the point 10; expected a number below 10",
                 [](FacedMesh& m) { m.cells[1][0][0] = 10; });
  expect_refused("twice; expected different points", [](FacedMesh& m) { m.cells[1][0][0] = m.cells[1][0][1]; });
  expect_refused("expected two faces", [](FacedMesh& m) { m.cells[1].push_back(m.cells[1][0]); });
  expect_refused("share 3 points", [&](FacedMesh& m) {  // a corner between two faces only
    FaceRing& ring = longest(m);
    const Index p = ring[0], q = ring[1], middle = static_cast<Index>(m.points.size());
    m.points.push_back({0, 0, 5});
    for (FaceRing& face : m.cells[1])
      for (std::size_t i = 0; i < face.size(); ++i) {
        const Index a = face[i], b = face[(i + 1) % face.size()];
        if ((a != p || b != q) && (a != q || b != p)) continue;
        face.insert(face.begin() + static_cast<std::ptrdiff_t>(i) + 1, middle);
        break;
      }
  });
  expect_refused("of 14 faces are connected", [](FacedMesh& m) {  // two prisms in one cell
    const auto count = static_cast<Index>(m.points.size());
    for (std::size_t p = 0; p < count; ++p) m.points.push_back(m.points[p]);
    CellFaces3 other = m.cells[0];
    for (FaceRing& face : other)
      for (Index& p : face) p += count;
    m.cells[1].insert(m.cells[1].end(), other.begin(), other.end());
  });
  expect_refused("point 9 is in a face and not among the corners",
                 [](FacedMesh& m) { m.known[1].second = {0, 1, 2, 3, 4, 5, 6, 7, 8}; });
  expect_refused("a polyhedron of more than 64 corners", [](FacedMesh& m) { m = hull(prism_points(33)); });
}

TEST(Polyhedra, ATorusOfSquaresIsNoCell) {
  FacedMesh mesh;
  constexpr Index kAround = 4;
  for (Index i = 0; i < kAround; ++i)
    for (Index j = 0; j < kAround; ++j) mesh.points.push_back({double(i), double(j), double(i * j)});
  CellFaces3 faces;
  const auto at = [](Index i, Index j) { return i % kAround * kAround + j % kAround; };
  for (Index i = 0; i < kAround; ++i)
    for (Index j = 0; j < kAround; ++j) faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  mesh.add(std::move(faces));
  expect_error(ErrorCode::InvalidArgument,
               "cell 0: 16 corners, 32 edges and 16 faces, with the Euler characteristic 0; expected 2",
               [&] { (void)mesh.complex(); });
}

TEST(Polyhedra, ListsAreChecked) {
  CellLists lists = truncated_octahedra(1, 0.0).lists();
  const auto expect_refusal = [&](const std::string& message, CellLists changed) {
    expect_error(ErrorCode::InvalidArgument, message,
                 [&] { Complex<3>(std::vector<std::array<double, 3>>(100), changed); });
  };
  CellLists changed = lists;
  changed.ends.clear();
  expect_refusal("0 ends of corners; expected one for each of the 2 cells", changed);
  changed = lists;
  std::swap(changed.face_ends[0], changed.face_ends[1]);
  expect_refusal("expected ascending numbers", changed);
  changed = lists;
  changed.face_corners.push_back(0);
  expect_refusal("the last end of faces is", changed);
  changed = lists;
  changed.face_lists_ends = {};
  expect_refusal("the last end of lists of faces is 0", changed);
  changed = lists;
  changed.types[0] = CellType::polygon;
  expect_refusal("cell 0: type 7 (polygon); expected a 3D cell", changed);
  expect_error(ErrorCode::InvalidArgument, "cell 0: type 42 (polyhedron)", [] {
    Complex<3>(std::vector<std::array<double, 3>>(4), CellType::polyhedron, std::vector<Index>{0, 1, 2, 3});
  });
  expect_error(ErrorCode::InvalidArgument, "cell type 42", [] { (void)corner_count(CellType::polyhedron); });
  EXPECT_EQ(3, dimension(CellType::polyhedron));
  EXPECT_EQ(2, dimension(CellType::polygon));
  EXPECT_EQ("polyhedron", name_of(CellType::polyhedron));
}

}  // namespace
}  // namespace tegl
