// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles other than cubes: face lattices, symmetries, classes; every contour passes its certificate and is equivariant.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "filling/certificate.hpp"
#include "filling/facets.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "tables/emit.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {
namespace {

struct Shape {
  TileKind kind;
  int dim;
  std::size_t corners, edges, faces, order, orbits, with_inversion;
};
constexpr Shape kShapes[] = {{TileKind::simplex, 2, 3, 3, 3, 6, 4, 2},
                             {TileKind::simplex, 3, 4, 6, 4, 24, 5, 3},
                             {TileKind::simplex, 4, 5, 10, 5, 120, 6, 3},
                             {TileKind::octahedron, 3, 6, 12, 8, 48, 10, 6}};

TEST(Tiles, HaveTheirCornersEdgesAndFaces) {
  for (const Shape& shape : kShapes) {
    const Lattice lattice(shape.kind, shape.dim);
    const Tile& tile = lattice.tile(shape.dim);
    EXPECT_EQ(shape.corners, tile.corner_count());
    EXPECT_EQ(shape.edges, tile.edge_count());
    EXPECT_EQ(shape.faces, tile.faces.size());
    for (const SubTile& face : tile.faces) {
      ASSERT_EQ(face.tile->edge_count(), face.edge.size());
      for (std::size_t e = 0; e < face.edge.size(); ++e)
        for (std::size_t end : {0, 1}) EXPECT_EQ(tile.edges[face.edge[e]][end], face.corner[face.tile->edges[e][end]]);
    }
  }
}

TEST(Tiles, FacesCloseUpToABoundary) {  // the signs make the boundary of the boundary vanish
  for (const Shape& shape : kShapes) {
    const Lattice lattice(shape.kind, shape.dim);
    std::map<std::set<int>, int> sum;
    for (const SubTile& face : lattice.tile(shape.dim).faces)
      for (const SubTile& ridge : face.tile->faces) {
        std::set<int> corners;
        for (const std::uint8_t v : ridge.corner) corners.insert(face.corner[v]);
        sum[corners] += face.sign * ridge.sign;
      }
    for (const auto& [corners, value] : sum) EXPECT_EQ(0, value);
  }
}

TEST(TileSymmetries, HaveTheKnownOrdersAndClasses) {
  for (const Shape& shape : kShapes) {
    const Lattice lattice(shape.kind, shape.dim);
    const Tile& tile = lattice.tile(shape.dim);
    const auto all = symmetries(tile, GroupKind::Full, false), inverting = symmetries(tile, GroupKind::Full, true);
    EXPECT_EQ(shape.order, all.size());
    EXPECT_EQ(shape.order / 2, symmetries(tile, GroupKind::Rotations, false).size());
    EXPECT_EQ(shape.orbits, transversal(tile, all).representatives.size());
    EXPECT_EQ(shape.with_inversion, transversal(tile, inverting).representatives.size());
    EXPECT_NO_THROW(require_burnside_count(transversal(tile, all), all));
    EXPECT_NO_THROW(require_burnside_count(transversal(tile, inverting), inverting));
    EXPECT_THROW(require_burnside_count(transversal(tile, inverting), all), Error);
  }
}

TEST(TileSymmetries, OfCubesAreTheGroupKnownByItsStructure) {
  for (const int n : {1, 2, 3, 4})
    for (const GroupKind kind : {GroupKind::Full, GroupKind::Rotations}) {
      const CubeLattice lattice(n);
      std::set<std::pair<std::vector<std::uint32_t>, int>> searched, composed;
      for (const TileSymmetry& g : symmetries(lattice.tile(n), kind, false)) searched.emplace(g.corner, g.det);
      for (const Element& g : group(n, kind, false)) composed.emplace(corner_permutation(g, n), g.det);
      EXPECT_EQ(composed, searched) << n;
    }
}

TEST(TileContours, PassTheirCertificateForEverySignature) {
  for (const Shape& shape : kShapes) {
    const Lattice lattice(shape.kind, shape.dim);
    for (const Alternative a : {Alternative::low, Alternative::high})
      for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
        const ContourBuilder builder(lattice, shape.dim, a, t);
        TableCertifier certifier(builder);
        for (Signature s = 0; s <= builder.tile().full(); ++s)
          EXPECT_EQ(certifier.certify(s, builder.build(s)), tile::Fault::none) << "signature " << s;
      }
  }
}

TEST(TileContours, HaveHighOnTheirPositiveSide) {
  for (const Shape& shape : kShapes) {
    if (shape.dim != 3) continue;
    const Lattice lattice(shape.kind, 3);
    const Tile& tile = lattice.tile(3);
    const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
    for (std::uint32_t v = 0; v < tile.corner_count(); ++v) {
      const TileContour contour = builder.build(Signature{1} << v);
      for (const LocalSimplex& s : contour.facets.at(0).simplices) {
        std::array<std::array<double, 3>, 3> p{};
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t k = 0; k < 3; ++k)
            p[i][k] = 0.5 * (tile.corners[tile.edges[s[i]][0]][k] + tile.corners[tile.edges[s[i]][1]][k]);
        double volume = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
          volume += ((p[1][i] - p[0][i]) * (p[2][j] - p[0][j]) - (p[1][j] - p[0][j]) * (p[2][i] - p[0][i])) *
                    (tile.corners[v][k] - p[0][k]);
        }
        EXPECT_GT(volume, 0) << "corner " << v;
      }
    }
  }
}

/// The boundaries of a contour's facets as sets of edges, independent of the triangulation.
std::set<std::set<std::uint8_t>> outlines(const TileContour& contour) {
  std::set<std::set<std::uint8_t>> result;
  for (const LocalFacet& facet : contour.facets) result.emplace(facet.points.begin(), facet.points.end());
  return result;
}

TEST(TileContours, MoveWithTheSymmetries) {
  for (const Shape& shape : kShapes) {
    const Lattice lattice(shape.kind, shape.dim);
    const Tile& tile = lattice.tile(shape.dim);
    const ContourBuilder builder(lattice, shape.dim, Alternative::low, Triangulation::barycentric);
    for (const TileSymmetry& g : symmetries(tile, GroupKind::Full, false)) {
      const auto moved = edge_permutation(tile, g.corner);
      for (Signature s = 0; s <= tile.full(); ++s) {
        Signature image = 0;
        for (std::uint32_t v = 0; v < tile.corner_count(); ++v) image |= ((s >> v) & 1u) << g.corner[v];
        std::set<std::set<std::uint8_t>> expected;
        for (const auto& outline : outlines(builder.build(s))) {
          std::set<std::uint8_t> points;
          for (const std::uint8_t e : outline) points.insert(moved[e]);
          expected.insert(points);
        }
        ASSERT_EQ(expected, outlines(builder.build(image))) << s;
      }
    }
  }
}

TEST(TileTables, OfOtherTilesAreNamedAfterThemAndRefusedForShaders) {
  TableRequest request;
  request.tile = TileKind::octahedron;
  request.dim = 3;
  request.command = "gen --dim 3 --tile octahedron";
  const TableSet set = make_table_set(request);
  EXPECT_TRUE(set.regions.empty());
  EXPECT_EQ(48u, set.group_order);
  EXPECT_EQ(10u, set.orbits);
  ASSERT_EQ(2u, emit_cpp(set).size());
  EXPECT_EQ("octahedron3_compact.cpp", emit_cpp(set).at(1).name);
  EXPECT_NE(std::string::npos, emit_cpp(set).at(1).text.find("const TileTable kOctahedron3Compact"));
  EXPECT_EQ("octahedron3_barycentric.json", emit_json(set).at(0).name);
  EXPECT_THROW((void)emit(set, Language::glsl), Error);
}

}  // namespace
}  // namespace tegl::gen
