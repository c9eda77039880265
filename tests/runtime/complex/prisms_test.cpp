// SPDX-License-Identifier: BSD-3-Clause
//
// Polyhedra over time: single prisms against the general engine, and meshes with invariants and cuts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compare.hpp"
#include "complex/cell_groups.hpp"
#include "complex/complex_cases.hpp"
#include "complex/polyhedral_cases.hpp"
#include "complex/solid_cases.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "polytope/polygon_prisms.hpp"
#include "polytope/polytopes.hpp"
#include "polytope/solid_facets.hpp"
#include "tegl/cell_index.hpp"
#include "tegl/check.hpp"
#include "tegl/complex.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl {
namespace {

using namespace test;

// ---------------------------------------------------------------------------------------------------- single cells

/// The prism over a polyhedron, which may be one with a table: as a cell, and for the engine.
struct EnginePrism {
  EnginePrism(const CellFaces3& faces, std::size_t corners)
      : prisms(prisms_over(faces, corners)), builder(tile::FaceLattice(4, facets_over(faces, corners))) {}

  detail::Polytopes prisms;
  tile::FacetBuilder builder;

 private:
  static detail::Polytopes prisms_over(const CellFaces3& faces, std::size_t corners) {
    detail::Polytopes polyhedra;
    std::vector<std::uint8_t> rings;
    std::vector<std::uint16_t> ends;
    std::vector<Index> points(corners);
    std::iota(points.begin(), points.end(), Index{0});
    for (const FaceRing& ring : faces) {
      for (const Index v : ring) rings.push_back(static_cast<std::uint8_t>(v));
      ends.push_back(static_cast<std::uint16_t>(rings.size()));
    }
    polyhedra.add_polyhedron(points, rings, ends);
    return polyhedra.in_time(corners, 1);
  }
  static std::vector<tile::Signature> facets_over(const CellFaces3& faces, std::size_t corners) {
    const tile::Signature all = (tile::Signature{1} << corners) - 1;
    std::vector<tile::Signature> facets = {all, all << corners};
    for (const FaceRing& ring : faces) {
      tile::Signature bits = 0;
      for (const Index v : ring) bits |= tile::Signature{1} << v;
      facets.push_back(bits | bits << corners);
    }
    return facets;
  }
};

std::size_t compare_prism_with_engine(const CellFaces3& faces, std::size_t corners, std::uint64_t step) {
  EnginePrism prism(faces, corners);
  return compare_with_engine(prism.prisms, prism.builder, step);
}

CellFaces3 oriented_faces(CellType type) {
  std::vector<Index> corners(corner_count(type));
  for (Index v = 0; v < corners.size(); ++v) corners[v] = v;
  CellFaces3 faces = faces_of(type, corners.data());
  // faces_of does not orient: as the library does, by neighbours
  std::vector<Index> all;
  std::vector<std::uint64_t> ends;
  for (const FaceRing& ring : faces) {
    all.insert(all.end(), ring.begin(), ring.end());
    ends.push_back(all.size());
  }
  std::set<std::pair<Index, Index>> along;
  std::vector<bool> done(faces.size());
  for (std::size_t left = faces.size(); left > 0;)
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (done[f]) continue;
      bool same = false, opposite = left == faces.size();
      for (std::size_t i = 0; i < faces[f].size(); ++i) {
        const Index a = faces[f][i], b = faces[f][(i + 1) % faces[f].size()];
        same = same || along.count({a, b}) != 0;
        opposite = opposite || along.count({b, a}) != 0;
      }
      if (!same && !opposite) continue;
      if (same) std::reverse(faces[f].begin(), faces[f].end());
      for (std::size_t i = 0; i < faces[f].size(); ++i)
        along.insert({faces[f][i], faces[f][(i + 1) % faces[f].size()]});
      done[f] = true;
      --left;
    }
  return faces;
}

TEST(Prisms, AllContoursOverTetrahedraPyramidsAndWedgesAreThoseOfTheEngine) {
  EXPECT_EQ(0u, compare_prism_with_engine(oriented_faces(CellType::tetrahedron), 4, 1));
  EXPECT_EQ(24u, compare_prism_with_engine(oriented_faces(CellType::pyramid), 5, 1));
  EXPECT_EQ(96u, compare_prism_with_engine(oriented_faces(CellType::wedge), 6, 1));
}

/// The faces of a cell as the library orients and numbers them.
CellFaces3 faces_by_library(const FacedMesh& mesh, std::size_t& corners) {
  const Complex<3> complex = mesh.complex();
  const detail::PolytopeShape& shape = detail::ComplexAccess::cells(complex).polytopes.shape(0);
  corners = shape.corner_count();
  CellFaces3 faces;
  for (std::size_t f = 0; f < shape.face_count(); ++f) faces.emplace_back(shape.ring(f).begin(), shape.ring(f).end());
  return faces;
}

TEST(Prisms, ContoursOverLargerPolyhedraAreThoseOfTheEngine) {
  for (const auto& [points, step] :
       {std::pair{prism_points(5), std::uint64_t{2003}}, std::pair{prism_points(6), std::uint64_t{50021}},
        std::pair{dodecahedron_points(), std::uint64_t{8000000011}},
        std::pair{truncated_octahedron_points(), std::uint64_t{4000000000039}}}) {
    std::size_t corners = 0;
    const CellFaces3 faces = faces_by_library(hull(points), corners);
    (void)compare_prism_with_engine(faces, corners, step);
  }
}

/// Spheres beside the same region as a component of another kind are rare.
TEST(Prisms, ComponentsBesideOneRegionStaySeparate) {
  for (const auto& [points, count] : {std::pair{prism_points(6), 1000u}, std::pair{dodecahedron_points(), 100u}}) {
    std::size_t corners = 0;
    const CellFaces3 faces = faces_by_library(hull(points), corners);
    EnginePrism prism(faces, corners);
    EXPECT_GT(compare_separate_components(prism.prisms, prism.builder, count), 0u);
  }
}

/// The table of the compiler against the shape that is made from the same rings step by step, and the rings against
/// the definition: regular prisms around a point, with all faces counterclockwise from outside.
TEST(Prisms, TableOfPrismsOverPolygonsHasTheirFaces) {
  for (std::size_t n = 3; n <= detail::kPolytopeCorners; ++n) {
    SCOPED_TRACE(n);
    const detail::PolytopeFaces prism = detail::kPolygonPrisms.over(n);
    const detail::PolytopeShape made({prism.rings().begin(), prism.rings().end()},
                                     {prism.ends().begin(), prism.ends().end()});
    ASSERT_EQ(n + 2, prism.face_count());
    EXPECT_EQ(3, prism.dim());
    EXPECT_EQ(2 * n, prism.corner_count());
    EXPECT_EQ(made.base_edges(), prism.base_edges());
    EXPECT_EQ(std::vector(made.edges().begin(), made.edges().end()),
              std::vector(prism.edges().begin(), prism.edges().end()));
    for (std::size_t e = 0; e < 3 * n; ++e) EXPECT_EQ(made.faces_at(e), prism.faces_at(e)) << e;
    const auto corner = [&](std::size_t v) -> std::array<double, 3> {
      const double angle = 2 * std::numbers::pi * static_cast<double>(v % n) / static_cast<double>(n);
      return {std::cos(angle), std::sin(angle), v < n ? -1.0 : 1.0};
    };
    for (std::size_t f = 0; f < n + 2; ++f) {
      EXPECT_TRUE(std::ranges::equal(made.ring_edges(f), prism.ring_edges(f))) << f;
      const std::span<const std::uint8_t> ring = prism.ring(f);
      ASSERT_EQ(f < 2 ? n : 4, ring.size());
      EXPECT_EQ(ring.size(), std::set<int>(ring.begin(), ring.end()).size());
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto a = corner(ring[i]), b = corner(ring[(i + 1) % ring.size()]),
                   c = corner(ring[(i + 2) % ring.size()]);
        const double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                              a[2] * (b[0] * c[1] - b[1] * c[0]);
        EXPECT_GT(volume, 1e-6) << f << ' ' << i;
      }
    }
    // the corners at the base come first, around it, and those above them follow in this order
    for (std::size_t v = 0; v < n; ++v) EXPECT_EQ(v + 2, prism.faces_at(prism.ring_edges(v + 2)[0])[1]) << v;
  }
}

/// The lattices of the compiler against the facets of the tables, and their edges against those found step by step.
TEST(Prisms, KnownPolyhedraAreThoseOfTheTables) {
  using detail::PolyhedronShape;
  const std::pair<PolyhedronShape, tables::CellShape> shapes[] = {
      {PolyhedronShape::tetrahedron, tables::CellShape::tetrahedron},
      {PolyhedronShape::pyramid, tables::CellShape::pyramid},
      {PolyhedronShape::octahedron, tables::CellShape::octahedron}};
  for (const auto& [shape, in_tables] : shapes) {
    const tables::ShapeTable& table = tables::shape_table(in_tables);
    SCOPED_TRACE(static_cast<int>(shape));
    std::vector<std::uint8_t> rings;
    std::vector<std::uint16_t> ends;
    std::set<std::array<std::uint8_t, 2>> pairs;
    for (const tables::CellFacet& face : std::span(table.facets, table.facet_count)) {
      std::array<std::uint8_t, 4> ring = {face.corners[0], face.corners[1], face.corners[2], face.corners[3]};
      if (face.corner_count == 4) std::swap(ring[2], ring[3]);  // around it
      if (!face.is_inverted) std::reverse(ring.begin(), ring.begin() + face.corner_count);
      rings.insert(rings.end(), ring.begin(), ring.begin() + face.corner_count);
      ends.push_back(static_cast<std::uint16_t>(rings.size()));
    }
    const detail::PolytopeFaces known = detail::faces_of_known(shape);
    EXPECT_EQ(rings, std::vector(known.rings().begin(), known.rings().end()));
    EXPECT_EQ(ends, std::vector(known.ends().begin(), known.ends().end()));
    EXPECT_EQ(3, known.dim());
    EXPECT_EQ(2u, known.corner_count() + known.face_count() - known.base_edges());
    EXPECT_EQ(rings.size() / 2, known.edges().size());
    for (std::size_t f = 0; f < known.face_count(); ++f) {
      const auto ring = known.ring(f), edges = known.ring_edges(f);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto [a, b] = std::minmax(ring[i], ring[(i + 1) % ring.size()]);
        EXPECT_EQ((std::array{a, b}), known.edges()[edges[i]]);
        const auto& faces = known.faces_at(edges[i]);
        EXPECT_TRUE(faces[0] < faces[1] && (faces[0] == f || faces[1] == f));
        pairs.insert({a, b});
      }
    }
    EXPECT_EQ(known.edges().size(), pairs.size());
  }
}

// ---------------------------------------------------------------------------------------------------------- meshes

const std::vector<double> kPrismTimes = {0.0, 0.7, 1.0, 2.5};

std::vector<std::pair<std::string, FacedMesh>> prism_meshes() { return space_fillings(4, 500, 7); }

/// Noise at the inner times, -1 at the first and the last one and on the border.
std::vector<double> noise_in_time(const FacedMesh& mesh, std::uint64_t seed) {
  std::vector<double> values;
  for (std::size_t k = 0; k < kPrismTimes.size(); ++k) {
    const auto layer = k == 0 || k + 1 == kPrismTimes.size() ? std::vector<double>(mesh.points.size(), -1.0)
                                                             : closed_noise(mesh, seed + k);
    values.insert(values.end(), layer.begin(), layer.end());
  }
  return values;
}

std::vector<double> layer_of(const std::vector<double>& values, std::size_t points, std::size_t k) {
  return {values.begin() + static_cast<std::ptrdiff_t>(k * points),
          values.begin() + static_cast<std::ptrdiff_t>((k + 1) * points)};
}

TEST(Prisms, NoiseHasAClosedOrientedManifoldWithEveryRule) {
  for (const auto& [name, mesh] : prism_meshes()) {
    const Complex<4> swept = in_time<3>(mesh.complex(), kPrismTimes, noise_in_time(mesh, 11));
    EXPECT_GT(detail::ComplexAccess::cells(swept).polytopes.size(), 90u);
    EXPECT_EQ(3 * mesh.cells.size(), swept.cell_count());
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules) {
        SCOPED_TRACE(name + (t == Triangulation::compact ? " compact " : " barycentric ") +
                     std::to_string(static_cast<int>(a)));
        const auto contour = extract(swept, 0.5, polyhedra_options(t, a));
        EXPECT_GT(contour.simplices.size(), 1000u);
        EXPECT_EQ(0u, expect_closed_manifold(contour).degenerate_simplices);
        EXPECT_GT(measure(contour).content.value(), 0.0);
        EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}),
                  count(swept, 0.5, polyhedra_options(t, a)));
      }
  }
}

TEST(Prisms, CutsAtStepsAreTheContoursOfTheSteps) {
  for (const auto& [name, mesh] : prism_meshes()) {
    Complex<3> complex = mesh.complex();
    const std::vector<double> values = noise_in_time(mesh, 21);
    const Complex<4> swept = in_time<3>(complex, kPrismTimes, values);
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules) {
        SCOPED_TRACE(name);
        const auto contour = extract<double>(swept, 0.5, polyhedra_options(t, a));
        for (const std::size_t k : {1u, 2u}) {
          complex.set_values(layer_of(values, mesh.points.size(), k));
          const auto step = extract<double>(complex, 0.5, polyhedra_options(t, a));
          EXPECT_GT(step.simplices.size(), 100u);
          EXPECT_TRUE(same_surface(step, slice(contour, Hyperplane<4>::across(3, kPrismTimes[k]))));
        }
        for (const double at : {0.64, 0.93, 1.2}) {
          const auto cut = slice(contour, Hyperplane<4>::across(3, at));
          EXPECT_GT(cut.simplices.size(), 100u);
          expect_closed_manifold(cut);
        }
      }
  }
}

TEST(Prisms, ResultsAreTheSameBytesWithAnyThreadsKnownEdgesAndAnIndex) {
  for (const auto& [name, mesh] : prism_meshes()) {
    SCOPED_TRACE(name);
    const Complex<4> swept = in_time<3>(mesh.complex(), kPrismTimes, noise_in_time(mesh, 4));
    Complex<4> known = swept;
    known.find_edges({3, {}});
    const CellIndex index(swept);
    const auto one = extract(swept, 0.5, polyhedra_options(Triangulation::compact, Ambiguity::saddle, 1));
    for (const unsigned threads : {1u, 3u}) {
      const auto options = polyhedra_options(Triangulation::compact, Ambiguity::saddle, threads);
      for (const auto& other : {extract(swept, 0.5, options), extract(known, 0.5, options),
                                extract(swept, index, 0.5, options), extract(known, index, 0.5, options)}) {
        EXPECT_TRUE(one.vertices == other.vertices);
        EXPECT_TRUE(one.simplices == other.simplices);
      }
    }
  }
}

TEST(Prisms, CapsCloseContoursAtTheBorder) {
  for (const auto& [name, mesh] : prism_meshes()) {
    if (name == "Voronoi") continue;  // its border touches itself
    std::mt19937_64 random(5);
    std::vector<double> values;
    for (std::size_t p = 0; p < kPrismTimes.size() * mesh.points.size(); ++p)
      values.push_back(static_cast<double>(random() >> 11) * 0x1p-53);
    Complex<4> swept = in_time<3>(mesh.complex(), kPrismTimes, values);
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules) {
        SCOPED_TRACE(name);
        ExtractOptions options = polyhedra_options(t, a);
        options.close = true;
        const auto contour = extract(swept, 0.5, options);
        expect_closed_manifold(contour);
        EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(swept, 0.5, options));
        const auto in_doubles = extract<double>(swept, 0.5, options);
        for (std::size_t k = 0; k < kPrismTimes.size(); ++k) {
          Complex<3> step = mesh.complex();
          step.set_values(layer_of(values, mesh.points.size(), k));
          const auto closed = extract<double>(step, 0.5, options);
          const auto cut = slice(in_doubles, Hyperplane<4>::across(3, kPrismTimes[k]));
          if (a != Ambiguity::mean && a != Ambiguity::saddle) {
            EXPECT_TRUE(same_surface(closed, cut));
            continue;
          }
          // in hexahedra with a tunnel, caps may add the mean of a quadrilateral to the other triangles
          EXPECT_NEAR(measure(closed).content.value(), measure(cut).content.value(), 1e-5);
          EXPECT_EQ(check(closed).euler, check(cut).euler);
        }
      }
    // all high: the caps are the border, with the volume of the mesh
    swept.set_values(std::vector<double>(values.size(), 1.0));
    ExtractOptions options;
    options.close = true;
    Complex<3> at_once = mesh.complex();
    at_once.set_values(std::vector<double>(mesh.points.size(), 1.0));
    // the hexagons of moved truncated octahedra are not plane: their triangles are others in the prisms
    EXPECT_NEAR(2.5 * measure(extract<double>(at_once, 0.5, options)).content.value(),
                measure(extract<double>(swept, 0.5, options)).content.value(),
                name == "truncated octahedra" ? 1e-2 : 1e-9)
        << name;
  }
}

/// Two prisms over pentagons, one in the notch of the other: they have two faces in common. `order`: numbers of points.
FacedMesh notched_pair(const std::vector<Index>& order) {
  const std::vector<std::array<double, 2>> outline = {{0, 0}, {-1, -1}, {1, -1}, {-1, -2}, {1, -2}, {-2, 1}, {2, 1}};
  FacedMesh mesh;
  mesh.points.resize(2 * outline.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    mesh.points[order[i]] = {outline[i / 2][0], static_cast<double>(i % 2), outline[i / 2][1]};
  for (const std::array<std::size_t, 5>& base : {std::array<std::size_t, 5>{1, 0, 2, 4, 3}, {1, 0, 2, 6, 5}}) {
    CellFaces3 faces(2);
    for (std::size_t i = 0; i < 5; ++i) {
      faces[0].push_back(order[2 * base[4 - i]]);
      faces[1].push_back(order[2 * base[i] + 1]);
      const std::size_t a = base[i], b = base[(i + 1) % 5];
      faces.push_back({order[2 * a], order[2 * b], order[2 * b + 1], order[2 * a + 1]});
    }
    mesh.add(std::move(faces));
  }
  return mesh;
}

TEST(Prisms, EndsOfCellsWithTwoCommonFacesAreTheirOwn) {
  // The four smallest points of both prisms are the same in some of these orders.
  std::mt19937_64 random(1);
  std::vector<Index> order(14);
  std::iota(order.begin(), order.end(), Index{0});
  for (int i = 0; i < 40; ++i) {
    const FacedMesh mesh = notched_pair(order);
    Complex<3> complex = mesh.complex();
    std::vector<double> values(kPrismTimes.size() * 14);
    for (std::size_t v = 0; v < values.size(); ++v) {  // high at the lower points: a sheet through both prisms
      const double size = 0.1 + static_cast<double>(random() >> 11) * 0x1p-53;
      values[v / 14 * 14 + order[v % 14]] = v % 2 == 0 ? size : -size;
    }
    const Complex<4> swept = in_time<3>(complex, kPrismTimes, values);
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : kAllRules) {
        SCOPED_TRACE(i);
        const auto contour = extract<double>(swept, 0.0, polyhedra_options(t, a));
        expect_oriented_manifold(contour);
        for (const std::size_t k : {1u, 2u}) {
          complex.set_values(layer_of(values, 14, k));
          const auto step = extract<double>(complex, 0.0, polyhedra_options(t, a));
          EXPECT_TRUE(same_surface(step, slice(contour, Hyperplane<4>::across(3, kPrismTimes[k]))));
        }
      }
    std::shuffle(order.begin(), order.end(), random);
  }
}

TEST(Prisms, MissingValuesLeaveAManifoldWithBoundary) {
  for (const auto& [name, mesh] : prism_meshes()) {
    SCOPED_TRACE(name);
    expect_boundary_beside_missing(in_time<3>(mesh.complex(), kPrismTimes, with_missing(noise_in_time(mesh, 31))));
  }
}

TEST(Prisms, LinearFunctionsHaveTheirHyperplaneAndNormals) {
  const auto plane = [](const std::array<double, 4>& x) {
    return 0.3 * x[0] - 0.5 * x[1] + 0.8 * x[2] + 0.4 * (x[3] - 1.3) + 0.013;
  };
  const double length = std::sqrt(0.09 + 0.25 + 0.64 + 0.16);
  for (const auto& [name, mesh] : prism_meshes()) {
    SCOPED_TRACE(name);
    std::vector<double> values;
    for (const double t : kPrismTimes)
      for (const auto& p : mesh.points) values.push_back(plane({p[0], p[1], p[2], t}));
    const Complex<4> swept = in_time<3>(mesh.complex(), kPrismTimes, values);
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
      ExtractOptions options = polyhedra_options(t);
      options.normals = Normals::differences;
      const auto contour = extract<double>(swept, 0.0, options);
      EXPECT_GT(contour.vertices.size(), 100u);
      for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
        EXPECT_NEAR(0.0, plane(contour.vertices[v]), 1e-12);
        EXPECT_NEAR(-0.8 / length, contour.normals[v][2], 1e-9);
      }
    }
  }
}

// Minutes: only with `ctest -C long`.
TEST(Prisms, DISABLED_MeshesOf100000PrismsHaveClosedOrientedManifolds) {
  const MeshData<3> points = grid_points<3>({31, 31, 31}, 0.1);
  std::vector<std::pair<std::string, FacedMesh>> large;
  large.emplace_back("truncated octahedra", truncated_octahedra(26, 0.1));
  large.emplace_back("Voronoi", voronoi_cells(40000, 5));
  large.emplace_back("merged mixed", merged(faced(mixed_mesh(points, 5)), 0.5, 3));
  for (const auto& [name, mesh] : large) {
    const std::vector<double> values = noise_in_time(mesh, 3);
    const Complex<4> swept = in_time<3>(mesh.complex(), kPrismTimes, values);
    EXPECT_GT(swept.cell_count(), 95000u) << name;
    for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact})
      for (const Ambiguity a : {Ambiguity::low, Ambiguity::saddle}) {
        SCOPED_TRACE(name);
        const auto contour = extract<double>(swept, 0.5, polyhedra_options(t, a));
        EXPECT_GT(contour.simplices.size(), 1000000u);
        expect_closed_manifold(contour);
        Complex<3> step = mesh.complex();
        step.set_values(layer_of(values, mesh.points.size(), 1));
        EXPECT_TRUE(same_surface(extract<double>(step, 0.5, polyhedra_options(t, a)),
                                 slice(contour, Hyperplane<4>::across(3, kPrismTimes[1]))));
      }
  }
}

/// A ball whose mesh moves with it has the same cut at all times, moved.
TEST(Prisms, PointsMayMove) {
  for (const FacedMesh& mesh : {truncated_octahedra(10, 0.1), voronoi_cells(6000, 8)}) {
    const Complex<3> complex = mesh.complex();
    std::vector<double> values;
    std::vector<std::array<double, 3>> points;
    for (const double t : kPrismTimes)
      for (const auto& point : mesh.points) {
        values.push_back(0.5 - std::hypot(point[0], point[1], point[2]));
        points.push_back({point[0] + 2 * t, point[1] - t, point[2]});
      }
    const auto contour = extract<double>(in_time<3>(complex, kPrismTimes, values, points), 0.0);
    Complex<3> still = complex;
    still.set_values(layer_of(values, mesh.points.size(), 0));
    const double volume = measure(extract<double>(still, 0.0)).content.value();
    for (const double t : {0.2, 0.7, 2.0}) {
      const auto cut = slice(contour, Hyperplane<4>::across(3, t));
      EXPECT_EQ(2, expect_closed_manifold(cut).euler);
      const Measures<3> measures = measure(cut);
      EXPECT_NEAR(volume, measures.content.value(), 3e-3);
      EXPECT_NEAR(2 * t, measures.centroid[0], 2e-2);
      EXPECT_NEAR(-t, measures.centroid[1], 2e-2);
    }
  }
}

}  // namespace
}  // namespace tegl
