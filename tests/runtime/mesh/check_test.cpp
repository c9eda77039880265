// SPDX-License-Identifier: BSD-3-Clause
//
// `check` on hand-made complexes: single defects, and manifolds with known numbers.
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "invariants.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace {

using Rows = std::vector<Index>;

/// Coordinates in general position for `count` vertices: points on the moment curve (i, i^2, i^3, i^4), of which no
/// distinct ones span a degenerate simplex.
std::vector<double> moment_curve(std::size_t count, int space_dim) {
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(count);
    double power = 1.0;
    for (int a = 0; a < space_dim; ++a) coordinates.push_back(power *= x);
  }
  return coordinates;
}

MeshReport check_rows(int d, const Rows& rows) {
  const Index count = rows.empty() ? 0 : *std::max_element(rows.begin(), rows.end()) + 1;
  return check(d, rows, d + 1, moment_curve(count, d + 1));
}

/// The oriented boundary of a simplex: the sphere S^d with d + 2 vertices.
Rows simplex_boundary(int d) {
  Rows rows;
  for (int omitted = 0; omitted < d + 2; ++omitted) {
    Rows facet;
    for (int i = 0; i < d + 2; ++i)
      if (i != omitted) facet.push_back(static_cast<Index>(i));
    if (omitted % 2) std::swap(facet[0], facet[1]);
    rows.insert(rows.end(), facet.begin(), facet.end());
  }
  return rows;
}

Rows shifted(Rows rows, Index by) {
  for (Index& v : rows) v += by;
  return rows;
}

Rows joined(Rows a, const Rows& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A torus of m x n vertices, two triangles per square.
Rows torus(Index m, Index n) {
  Rows rows;
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < n; ++j) {
      const auto at = [&](Index a, Index b) { return (i + a) % m * n + (j + b) % n; };
      rows = joined(rows, {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
    }
  return rows;
}

/// The 3-torus of n^3 vertices, six tetrahedra per cube (Kuhn's triangulation).
Rows three_torus(Index n) {
  Rows rows;
  std::array<int, 3> axes{0, 1, 2};
  do {
    const bool even = (axes[1] + 3 - axes[0]) % 3 == 1;
    for (Index i = 0; i < n * n * n; ++i) {
      std::array<Index, 3> at{i % n, i / n % n, i / n / n};
      Rows tet{i};
      for (const int a : axes) {
        at[a] = (at[a] + 1) % n;
        tet.push_back(at[0] + n * (at[1] + n * at[2]));
      }
      if (!even) std::swap(tet[2], tet[3]);
      rows = joined(std::move(rows), tet);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return rows;
}

/// Joins every simplex of `rows` (dimension d) to a new first vertex `apex`.
Rows cone(int d, const Rows& rows, Index apex) {
  Rows result;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i % static_cast<std::size_t>(d + 1) == 0) result.push_back(apex);
    result.push_back(rows[i]);
  }
  return result;
}

TEST(Check, OfAnEmptyComplexIsAllZeros) {
  for (int d = 1; d <= 3; ++d) {
    const MeshReport report = check(d, {}, d + 1, {});
    EXPECT_EQ(report.dim, d);
    EXPECT_EQ(report.vertices, 0u);
    EXPECT_EQ(report.components, 0u);
    EXPECT_EQ(report.euler, 0);
    EXPECT_TRUE(test::is_closed_oriented_manifold(report));
  }
}

TEST(Check, VerticesWithoutSimplicesAreUnused) {
  const MeshReport report = check(2, {}, 3, moment_curve(5, 3));
  EXPECT_EQ(report.vertices, 0u);
  EXPECT_EQ(report.unused_vertices, 5u);
  EXPECT_EQ(report.components, 0u);
}

TEST(Check, BoundaryOfASimplexIsASphere) {
  for (int d = 1; d <= 3; ++d) {
    const MeshReport report = check_rows(d, simplex_boundary(d));
    EXPECT_TRUE(test::is_closed_oriented_manifold(report)) << d;
    EXPECT_EQ(report.vertices, static_cast<std::uint64_t>(d + 2));
    EXPECT_EQ(report.simplices, static_cast<std::uint64_t>(d + 2));
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.euler, d == 2 ? 2 : 0) << d;
    EXPECT_EQ(report.degenerate_simplices, 0u);
  }
}

TEST(Check, OneSimplexIsABallWithItsFacetsAsBoundary) {
  for (int d = 1; d <= 3; ++d) {
    Rows rows(static_cast<std::size_t>(d + 1));
    std::iota(rows.begin(), rows.end(), Index{0});
    const MeshReport report = check_rows(d, rows);
    EXPECT_TRUE(test::is_oriented_manifold(report)) << d;
    EXPECT_EQ(report.boundary_simplices, static_cast<std::uint64_t>(d + 1));
    EXPECT_EQ(report.euler, 1);
  }
}

TEST(Check, ToriAreClosedWithEulerCharacteristicZero) {
  const MeshReport two = check_rows(2, torus(5, 7));
  EXPECT_TRUE(test::is_closed_oriented_manifold(two));
  EXPECT_EQ(two.euler, 0);
  EXPECT_EQ(two.components, 1u);
  const MeshReport three = check_rows(3, three_torus(4));
  EXPECT_TRUE(test::is_closed_oriented_manifold(three));
  EXPECT_EQ(three.vertices, 64u);
  EXPECT_EQ(three.simplices, 6u * 64u);
  EXPECT_EQ(three.euler, 0);
}

TEST(Check, CountsComponents) {
  for (int d = 1; d <= 3; ++d) {
    const Rows one = simplex_boundary(d);
    const MeshReport report = check_rows(d, joined(one, joined(shifted(one, 10), shifted(one, 20))));
    EXPECT_EQ(report.components, 3u);
    EXPECT_EQ(report.euler, d == 2 ? 6 : 0);
    EXPECT_EQ(report.unused_vertices, 20u - 2u * static_cast<unsigned>(d + 2));
  }
}

TEST(Check, ThreeEdgesInAVertexAreABadLink) {
  const MeshReport report = check_rows(1, {0, 1, 1, 2, 3, 1});
  EXPECT_EQ(report.bad_links, 1u);
  EXPECT_EQ(report.nonmanifold_simplices, 1u);
  EXPECT_EQ(report.boundary_simplices, 3u);
  EXPECT_EQ(report.orientation_conflicts, 0u);
}

TEST(Check, TwoEdgesThatMeetHeadToHeadConflict) {
  const MeshReport report = check_rows(1, {0, 1, 2, 1});
  EXPECT_EQ(report.orientation_conflicts, 1u);
  EXPECT_EQ(report.bad_links, 0u);
}

TEST(Check, ThreeTrianglesOnAnEdgeAreNotAManifold) {
  const MeshReport report = check_rows(2, {0, 1, 2, 1, 0, 3, 0, 1, 4});
  EXPECT_EQ(report.nonmanifold_simplices, 1u);
  EXPECT_EQ(report.bad_links, 2u);  // both ends of the edge
  EXPECT_EQ(report.boundary_simplices, 6u);
  EXPECT_EQ(report.orientation_conflicts, 0u);
}

TEST(Check, TwoSpheresInOneVertexHaveABadLink) {
  for (int d = 2; d <= 3; ++d) {
    const Rows sphere = simplex_boundary(d);
    Rows other = shifted(sphere, 10);
    for (Index& v : other)
      if (v == 10) v = 0;
    const MeshReport report = check_rows(d, joined(sphere, other));
    EXPECT_EQ(report.bad_links, 1u) << d;
    EXPECT_EQ(report.boundary_simplices + report.nonmanifold_simplices + report.orientation_conflicts, 0u);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.euler, d == 2 ? 3 : -1);
  }
}

TEST(Check, TwoTetrahedraThatShareAnEdgeAloneHaveBadLinksAtItsEnds) {
  const MeshReport report = check_rows(3, {0, 1, 2, 3, 0, 1, 4, 5});
  EXPECT_EQ(report.bad_links, 2u);
  EXPECT_EQ(report.nonmanifold_simplices, 0u);
  EXPECT_EQ(report.boundary_simplices, 8u);
}

TEST(Check, ConeOverATorusHasABadLinkAtItsApex) {
  const Rows rows = cone(2, torus(5, 7), 35);
  const MeshReport report = check_rows(3, rows);
  EXPECT_EQ(report.bad_links, 1u);
  EXPECT_EQ(report.nonmanifold_simplices, 0u);
  EXPECT_EQ(report.orientation_conflicts, 0u);
  EXPECT_EQ(report.boundary_simplices, 70u);
  EXPECT_EQ(report.euler, 1);
}

TEST(Check, ConeOverTwoSpheresHasABadLink) {
  const Rows sphere = simplex_boundary(2);
  const MeshReport report = check_rows(3, cone(2, joined(sphere, shifted(sphere, 4)), 8));
  EXPECT_EQ(report.bad_links, 1u);
}

TEST(Check, ConeOverTwoSurfacesInOnePointHasBadLinks) {
  // The link of vertex 0 is two discs that meet in a single point: connected, no edge in three triangles, and Euler
  // characteristic 1 as for a disc. Only the two fans around that point reveal it.
  Rows second = shifted(torus(4, 4), 16);
  for (Index& v : second)
    if (v == 16) v = 0;
  EXPECT_EQ(check_rows(3, cone(2, joined(torus(4, 4), second), 40)).bad_links, 2u);  // vertex 0 and the apex
}

TEST(Check, AFlippedTriangleConflictsOnItsThreeEdges) {
  Rows rows = simplex_boundary(2);
  std::swap(rows[0], rows[1]);
  const MeshReport report = check_rows(2, rows);
  EXPECT_EQ(report.orientation_conflicts, 3u);
  EXPECT_EQ(report.bad_links, 0u);
  EXPECT_EQ(report.boundary_simplices, 0u);
}

TEST(Check, AFlippedTetrahedronConflictsOnItsFourTriangles) {
  Rows rows = three_torus(4);
  std::swap(rows[5], rows[6]);
  EXPECT_EQ(check_rows(3, rows).orientation_conflicts, 4u);
}

TEST(Check, AMoebiusBandCannotBeOriented) {
  // The Möbius strip with five vertices: triangles i, i+1, i+2 modulo 5, oriented one after the other.
  const Rows rows{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 0, 4, 0, 1};
  const MeshReport report = check_rows(2, rows);
  EXPECT_EQ(report.euler, 0);
  EXPECT_EQ(report.boundary_simplices, 5u);
  EXPECT_EQ(report.bad_links, 0u);
  EXPECT_EQ(report.orientation_conflicts, 1u);
}

TEST(Check, ProjectivePlaneIsClosedAndNotOriented) {
  // Six vertices, ten triangles: the hemi-icosahedron.
  const Rows rows{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 1, 1, 2, 4, 2, 3, 5, 3, 4, 1, 4, 5, 2, 5, 1, 3};
  const MeshReport report = check_rows(2, rows);
  EXPECT_EQ(report.euler, 1);
  EXPECT_EQ(report.boundary_simplices, 0u);
  EXPECT_EQ(report.bad_links, 0u);
  EXPECT_GT(report.orientation_conflicts, 0u);
  // As a link it has the Euler characteristic of a disc, but is not one.
  EXPECT_EQ(check_rows(3, cone(2, rows, 6)).bad_links, 1u);
}

TEST(Check, OrientationIsTheParityOfTheVertexOrder) {
  // All twelve even permutations of one tetrahedron of a sphere keep it oriented; all twelve odd ones cause conflicts.
  const Rows sphere = simplex_boundary(3);
  std::array<int, 4> order{0, 1, 2, 3};
  do {
    Rows rows = sphere;
    int inversions = 0;
    for (int i = 0; i < 4; ++i) {
      rows[static_cast<std::size_t>(i)] = sphere[static_cast<std::size_t>(order[i])];
      for (int j = 0; j < i; ++j) inversions += order[j] > order[i];
    }
    EXPECT_EQ(check_rows(3, rows).orientation_conflicts, inversions % 2 ? 4u : 0u);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Check, RepeatedVerticesAreDegenerateAndLeftOut) {
  const Rows sphere = simplex_boundary(2);
  const MeshReport report = check_rows(2, joined(sphere, {0, 1, 1, 7, 7, 7}));
  EXPECT_EQ(report.degenerate_simplices, 2u);
  EXPECT_EQ(report.simplices, 6u);
  EXPECT_EQ(report.vertices, 4u);
  EXPECT_EQ(report.unused_vertices, 4u);
  EXPECT_EQ(report.euler, 2);
  EXPECT_EQ(report.nonmanifold_simplices + report.boundary_simplices + report.bad_links, 0u);
}

TEST(Check, DuplicateVerticesLeaveSeams) {
  // Two adjacent triangles whose common edge has duplicated vertices: equal positions, different numbers.
  const Rows rows{0, 1, 2, 3, 4, 5};
  const std::vector<double> coordinates{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const MeshReport report = check(2, rows, 3, coordinates);
  EXPECT_EQ(report.components, 2u);
  EXPECT_EQ(report.boundary_simplices, 6u);
  EXPECT_EQ(report.degenerate_simplices, 0u);
}

TEST(Check, ATriangleListedTwiceIsAPillow) {
  const MeshReport opposite = check_rows(2, {0, 1, 2, 0, 2, 1});
  EXPECT_TRUE(test::is_closed_oriented_manifold(opposite));
  EXPECT_EQ(opposite.euler, 2);
  EXPECT_EQ(check_rows(2, {0, 1, 2, 0, 1, 2}).orientation_conflicts, 3u);
}

TEST(Check, ZeroMeasureIsDegenerateAtAnyScale) {
  const Rows triangle{0, 1, 2};
  for (const double scale : {1e-20, 1e-3, 1.0, 1e7, 1e30}) {
    const auto degenerate = [&](std::vector<double> coordinates) {
      for (double& x : coordinates) x *= scale;
      return check(2, triangle, 3, coordinates).degenerate_simplices;
    };
    EXPECT_EQ(degenerate({0.1, 0.2, 0.3, 0.1, 0.2, 0.3, 1, 1, 1}), 1u);        // two vertices in one place
    EXPECT_EQ(degenerate({0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}), 1u);  // collinear up to rounding
    EXPECT_EQ(degenerate({0, 0, 0, 1, 0, 0, 0.5, 1e-9, 0}), 0u);               // thin, but not flat
    EXPECT_EQ(degenerate({0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5}), 1u);  // a point
  }
  const std::vector<double> square{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0};
  EXPECT_EQ(check(3, Rows{0, 1, 2, 3}, 4, square).degenerate_simplices, 1u);  // a tetrahedron in a plane
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check(2, triangle, 3, std::vector<double>{0, 0, 0, 1, 0, 0, 0, nan, 0}).degenerate_simplices, 1u);
}

TEST(Check, CountsVerticesAtNoFinitePlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Rows triangle{0, 1, 2};
  const auto count = [&](const std::vector<double>& coordinates) {
    return check(2, triangle, 3, coordinates).nonfinite_vertices;
  };
  EXPECT_EQ(count({0, 0, 0, 1, 0, 0, 0, 1, 0}), 0u);
  EXPECT_EQ(count({nan, nan, nan, 1, 0, 0, 0, 1, 0}), 1u);
  EXPECT_EQ(count({0, 0, nan, 1, 0, -inf, 0, inf, 0}), 3u);
  EXPECT_EQ(count({0, 0, 0, 1, 0, 0, 0, 1, 0, inf, 0, 0}), 1u) << "in no simplex, but there";
  Contour<4, float> tetrahedron;
  tetrahedron.vertices = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, static_cast<float>(nan)}};
  tetrahedron.simplices = {{0, 1, 2, 3}};
  EXPECT_EQ(check(tetrahedron).nonfinite_vertices, 1u);
}

TEST(Check, NamesTheVertexNumberThatIsOutOfRange) {
  const std::vector<double> coordinates = moment_curve(4, 3);
  try {
    check(2, Rows{0, 1, 2, 0, 4, 1}, 3, coordinates);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_STREQ(error.what(), "simplex 1 has vertex number 4; expected less than 4, the number of vertices");
  }
}

TEST(Check, RefusesSizesThatMakeNoComplex) {
  const std::vector<double> coordinates = moment_curve(4, 3);
  const auto code = [&](int d, const Rows& rows, int space_dim, std::span<const double> xyz) {
    try {
      check(d, rows, space_dim, xyz);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::Cancelled;
  };
  EXPECT_EQ(code(0, {0}, 3, coordinates), ErrorCode::InvalidArgument);
  EXPECT_EQ(code(4, {0, 1, 2, 3, 0}, 3, coordinates), ErrorCode::InvalidArgument);
  EXPECT_EQ(code(2, {0, 1, 2, 3}, 3, coordinates), ErrorCode::InvalidArgument);
  EXPECT_EQ(code(2, {0, 1, 2}, 5, coordinates), ErrorCode::InvalidArgument);
  EXPECT_EQ(code(3, {0, 1, 2, 3}, 2, coordinates), ErrorCode::InvalidArgument);
  EXPECT_EQ(code(2, {0, 1, 2}, 9, coordinates), ErrorCode::InvalidArgument);
}

TEST(Check, AgreesWithTheFacesCountedApart) {
  Contour<4, float> contour;
  const Rows rows = three_torus(5);
  const auto coordinates = moment_curve(125, 4);
  for (std::size_t v = 0; v < 125; ++v)
    contour.vertices.push_back({static_cast<float>(coordinates[4 * v]), static_cast<float>(coordinates[4 * v + 1]),
                                static_cast<float>(coordinates[4 * v + 2]),
                                static_cast<float>(coordinates[4 * v + 3])});
  std::mt19937_64 bits(1);
  for (std::size_t s = 0; s < rows.size() / 4; ++s)
    if (test::unit_random(bits) < 0.9)
      contour.simplices.push_back({rows[4 * s], rows[4 * s + 1], rows[4 * s + 2], rows[4 * s + 3]});
  EXPECT_EQ(check(contour).boundary_simplices, test::boundary_faces(contour).size());
  EXPECT_GT(check(contour).boundary_simplices, 0u);
}

/// Simplices of any dimension by their vertices.
using Pieces = std::vector<Rows>;

Pieces link_of(const Pieces& pieces, Index v) {
  Pieces link;
  for (Rows piece : pieces)
    if (std::erase(piece, v) > 0) link.push_back(std::move(piece));
  return link;
}

/// By definition, up to two dimensions: a 0-sphere has two points, a 0-ball one; else all links are spheres or balls,
/// the pieces are connected, and surfaces have the Euler characteristic of a sphere or a disc.
bool is_sphere_or_ball(const Pieces& pieces) {
  const std::size_t width = pieces.front().size();
  if (width == 1) return pieces.size() <= 2;
  std::set<Index> vertices, reached{pieces.front().front()};
  std::set<Rows> edges;
  bool is_closed = true;
  for (const Rows& piece : pieces) vertices.insert(piece.begin(), piece.end());
  for (std::size_t round = 0; round < vertices.size(); ++round)
    for (const Rows& piece : pieces)
      if (std::any_of(piece.begin(), piece.end(), [&](Index v) { return reached.contains(v); }))
        reached.insert(piece.begin(), piece.end());
  if (reached != vertices) return false;
  for (const Index v : vertices) {
    const Pieces link = link_of(pieces, v);
    if (!is_sphere_or_ball(link)) return false;
    for (const Rows& piece : link)
      for (const Index w : piece) {
        is_closed = is_closed && link_of(link, w).size() != 1;
        edges.insert({std::min(v, w), std::max(v, w)});
      }
  }
  if (width == 2) return true;
  return vertices.size() + pieces.size() == edges.size() + (is_closed ? 2 : 1);
}

/// Counts of `check` by definition.
MeshReport counted(int d, const Rows& rows) {
  MeshReport report;
  std::map<Rows, std::vector<bool>> faces;  // the orientations that simplices induce
  std::set<Index> vertices;
  Pieces pieces;
  const auto width = static_cast<std::size_t>(d) + 1;
  for (std::size_t i = 0; i < rows.size(); i += width) {
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(i);
    const Rows row(first, first + d + 1);
    vertices.insert(row.begin(), row.end());
    pieces.push_back(row);
    for (std::size_t omitted = 0; omitted < width; ++omitted) {
      Rows face = row;
      face.erase(face.begin() + static_cast<std::ptrdiff_t>(omitted));
      bool is_odd = omitted % 2 != 0;
      for (std::size_t k = 0; k + 1 < face.size(); ++k)
        for (std::size_t j = 0; j + 1 < face.size(); ++j)
          if (face[j] > face[j + 1]) {
            std::swap(face[j], face[j + 1]);
            is_odd = !is_odd;
          }
      faces[face].push_back(is_odd);
    }
  }
  for (const auto& [face, sides] : faces) {
    report.boundary_simplices += sides.size() == 1 ? 1 : 0;
    report.nonmanifold_simplices += sides.size() > 2 ? 1 : 0;
    report.orientation_conflicts += sides.size() == 2 && sides[0] == sides[1] ? 1 : 0;
  }
  std::set<Rows> edges;
  for (const Rows& piece : pieces)
    for (const Index v : piece)
      for (const Index w : piece)
        if (v < w) edges.insert({v, w});
  report.vertices = vertices.size();
  report.euler = static_cast<std::int64_t>(vertices.size()) - static_cast<std::int64_t>(edges.size()) +
                 (d == 3 ? static_cast<std::int64_t>(faces.size()) : 0) +
                 (d == 3 ? -1 : 1) * static_cast<std::int64_t>(pieces.size());
  for (const Index v : vertices) report.bad_links += is_sphere_or_ball(link_of(pieces, v)) ? 0 : 1;
  return report;
}

/// Parts of a torus with some vertices drawn together, and some simplices turned.
Rows damaged(int d, const Rows& rows, std::mt19937_64& bits) {
  const Index count = *std::max_element(rows.begin(), rows.end()) + 1;
  std::vector<Index> drawn(count);
  std::iota(drawn.begin(), drawn.end(), Index{0});
  for (auto together = bits() % 3; together > 0; --together) drawn[bits() % count] = static_cast<Index>(bits() % count);
  const double kept = 0.7 + 0.4 * test::unit_random(bits), turned = bits() % 2 == 0 ? 0.0 : 0.02;
  const auto width = static_cast<std::size_t>(d) + 1;
  Rows result;
  for (std::size_t i = 0; i < rows.size(); i += width) {
    Rows row;
    for (std::size_t j = 0; j < width; ++j) row.push_back(drawn[rows[i + j]]);
    if (std::set<Index>(row.begin(), row.end()).size() < width || test::unit_random(bits) >= kept) continue;
    if (test::unit_random(bits) < turned) std::swap(row[0], row[1]);
    result = joined(std::move(result), row);
  }
  return result;
}

TEST(Check, CountsAsByDefinition) {
  std::mt19937_64 bits(7);
  std::uint64_t good = 0, bad = 0;
  for (int round = 0; round < 200; ++round)
    for (const int d : {2, 3}) {
      const Rows rows = damaged(d, d == 2 ? torus(5, 4) : three_torus(3), bits);
      const MeshReport report = check_rows(d, rows), expected = counted(d, rows);
      EXPECT_EQ(report.vertices, expected.vertices);
      EXPECT_EQ(report.euler, expected.euler) << d << ", round " << round;
      EXPECT_EQ(report.boundary_simplices, expected.boundary_simplices) << d << ", round " << round;
      EXPECT_EQ(report.nonmanifold_simplices, expected.nonmanifold_simplices) << d << ", round " << round;
      EXPECT_EQ(report.orientation_conflicts, expected.orientation_conflicts) << d << ", round " << round;
      EXPECT_EQ(report.bad_links, expected.bad_links) << d << ", round " << round;
      bad += expected.bad_links;
      good += expected.vertices - expected.bad_links;
    }
  EXPECT_GT(bad, 100u);
  EXPECT_GT(good, 1000u);
}

TEST(Check, IsTheSameForAnyNumberOfThreads) {
  std::mt19937_64 bits(8);
  const Rows rows = damaged(3, three_torus(16), bits);
  const auto coordinates = moment_curve(16 * 16 * 16, 4);
  const MeshReport one = check(3, rows, 4, coordinates, {.threads = 1});
  EXPECT_GT(one.bad_links + one.boundary_simplices, 0u);
  for (const unsigned threads : {2u, 5u, 0u}) {
    const MeshReport report = check(3, rows, 4, coordinates, {.threads = threads});
    for (const auto count :
         {&MeshReport::vertices, &MeshReport::unused_vertices, &MeshReport::simplices, &MeshReport::components,
          &MeshReport::boundary_simplices, &MeshReport::nonmanifold_simplices, &MeshReport::bad_links,
          &MeshReport::orientation_conflicts, &MeshReport::degenerate_simplices, &MeshReport::nonfinite_vertices})
      EXPECT_EQ(report.*count, one.*count) << threads << " threads";
    EXPECT_EQ(report.euler, one.euler) << threads << " threads";
  }
}

TEST(Check, AFanRoundOneVertexCostsNoMoreThanItsSize) {
  constexpr Index kCount = 200000;
  Rows rows;
  rows.reserve(3 * kCount);
  for (Index i = 0; i < kCount; ++i) {
    rows.push_back(kCount);
    rows.push_back(i);
    rows.push_back((i + 1) % kCount);
  }
  std::vector<double> coordinates(2 * (kCount + 1), 0.0);
  const MeshReport report = check(2, rows, 2, coordinates);
  EXPECT_TRUE(test::is_oriented_manifold(report));
  EXPECT_EQ(report.boundary_simplices, kCount);
  EXPECT_EQ(report.euler, 1);
  EXPECT_EQ(report.degenerate_simplices, kCount);
}

}  // namespace
}  // namespace tegl
