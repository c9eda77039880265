// SPDX-License-Identifier: BSD-3-Clause
//
// Single tiles with signs of faces: the tunnel, face numbers, certificates, arguments.
#include "tegl/tile_facets.hpp"

#include <bit>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "builder5.hpp"
#include "tegl/error.hpp"
#include "tegl/tile/certificate.hpp"
#include "tegl/tile/corners.hpp"
#include "tegl/tile/cube_faces.hpp"
#include "tile/five_cube_numbers.hpp"

namespace tegl {
namespace {

using tile::Choice;

template <int N>
tile::Fault certified(std::uint64_t signature, std::span<const Choice> signs = {}) {
  return tile::certify(tile::FaceLattice::cube(N), tile_facets<N>(signature, {.choices = signs}));
}

std::size_t simplex_count(const tile::TileFacets& tile) {
  std::size_t count = 0;
  for (const tile::Facet& facet : tile.facets) count += facet.simplices.size();
  return count;
}

TEST(TileFacets, FacesAreNumberedByTheirBaseAndAxes) {
  const auto faces = tile::FaceLattice::cube(3).faces();
  EXPECT_EQ(face_number<3>(5, 0), 5u);
  EXPECT_EQ(face_number<3>(0, 7), kFaceCount<3> - 1);
  EXPECT_EQ(faces[face_number<3>(4, 1)].corners, (1u << 4) | (1u << 5));
  EXPECT_EQ(faces[face_number<3>(2, 5)].corners, (1u << 2) | (1u << 3) | (1u << 6) | (1u << 7));
  EXPECT_THROW(face_number<3>(1, 1), Error);
  EXPECT_THROW(face_number<3>(8, 0), Error);
}

/// The lattices of cubes, whose faces are numbered by the compiler, against lattices of intersections of facets.
TEST(CubeFaces, AreTheIntersectionsOfFacets) {
  for (int n = 1; n <= 6; ++n) {
    SCOPED_TRACE(n);
    std::vector<tile::Signature> facets;
    for (unsigned f = 0; f < 2u * static_cast<unsigned>(n); ++f)
      facets.push_back(detail::face_corners(static_cast<unsigned>(n), f));
    const tile::FaceLattice expected(n, facets), cube = tile::FaceLattice::cube(n);
    const detail::CubeFaces numbers(n);
    ASSERT_EQ(expected.faces().size(), cube.faces().size());
    ASSERT_EQ(expected.faces().size(), numbers.cells().size());
    EXPECT_EQ(expected.tile(), numbers.tile());
    std::size_t flat = 0;  // corners and edges
    for (std::size_t f = 0; f < cube.faces().size(); ++f) {
      const tile::Face &a = expected.faces()[f], &b = cube.faces()[f];
      EXPECT_EQ(a.dim, b.dim) << f;
      EXPECT_EQ(a.corners, b.corners) << f;
      EXPECT_EQ(a.faces, b.faces) << f;
      EXPECT_EQ(a.signs, b.signs) << f;
      const detail::CubeFace& face = numbers.cells()[f];
      EXPECT_EQ(a.dim, face.dim) << f;
      EXPECT_EQ(unsigned{face.base}, static_cast<unsigned>(std::countr_zero(a.corners))) << f;
      EXPECT_EQ(unsigned{face.base} | face.axes, 63u - static_cast<unsigned>(std::countl_zero(a.corners))) << f;
      EXPECT_EQ(f, numbers.number(face.base, face.axes));
      flat += a.dim < 2 ? 1 : 0;
    }
    EXPECT_EQ(flat, numbers.first_choice());
  }
}

TEST(CubeFaces, OfThe5CubeAreNumberedAsInItsBuilder) {
  using builders::FiveCube;
  const detail::CubeFaces cube(5);
  const detail::FiveCubeNumbers& numbers = detail::kFiveCubeNumbers;
  for (std::size_t e = 0; e < 80; ++e) {
    const auto& ends = FiveCube::kEdges[e];
    EXPECT_EQ(cube.number(ends[0], unsigned{ends[0]} ^ ends[1]), numbers.edges[e]);
    EXPECT_EQ(32u + e, numbers.edges[numbers.edge_order[e]]);
    EXPECT_EQ(cube.number(FiveCube::kSquares[e].base, FiveCube::kSquares[e].axes), numbers.squares[e]);
    EXPECT_EQ(32u + e, numbers.frames[10].number_of_edge(static_cast<unsigned>(e)));
  }
  for (std::size_t c = 0; c < 40; ++c)
    EXPECT_EQ(cube.number(FiveCube::kCubes[c].face.base, FiveCube::kCubes[c].face.axes), numbers.cubes[c]);
  for (std::size_t f = 0; f < 10; ++f) {
    const FiveCube::Tesseract& tesseract = FiveCube::kTesseracts[f];
    const unsigned lowest = tesseract.corners[0];
    EXPECT_EQ(cube.number(lowest, lowest ^ tesseract.corners[15]), numbers.tesseracts[f]);
    const detail::FiveCubeNumbers::Frame& frame = numbers.frames[f];
    EXPECT_EQ(16, std::popcount(frame.corners));
    EXPECT_EQ(32, std::popcount(frame.edges[0]) + std::popcount(frame.edges[1]));
    for (unsigned v = 0; v < 16; ++v) EXPECT_EQ(v, frame.number_of_corner(tesseract.corners[v]));
    for (unsigned e = 0; e < 32; ++e) EXPECT_EQ(16 + e, frame.number_of_edge(tesseract.edges[e]));
  }
}

TEST(TileFacets, ASquareIsCutOrJoinedByTheSignOfItsCentre) {
  std::vector<Choice> signs(kFaceCount<2>);
  signs.back() = Choice::high;
  const auto joined = tile_facets<2>(0b0110, {.choices = signs}), cut = tile_facets<2>(0b0110);
  EXPECT_EQ(joined.facets.size(), 2u);
  EXPECT_EQ(cut.facets.size(), 2u);
  // The edges have numbers 4 to 7: along x below, along y left, along y right, along x above. Corner 1 is cut off
  // between the edges below and right; if corners 1 and 2 are joined, corner 0 is cut off.
  const auto faces_of = [](const tile::TileFacets& tile) {
    std::vector<std::vector<std::uint32_t>> result;
    for (const tile::Facet& facet : tile.facets) {
      std::vector<std::uint32_t> faces;
      for (int i = 0; i < 2; ++i) faces.push_back(tile.vertices[facet.simplices[0][i]].face);
      std::sort(faces.begin(), faces.end());
      result.push_back(faces);
    }
    std::sort(result.begin(), result.end());
    return result;
  };
  const auto below = static_cast<std::uint32_t>(face_number<2>(0, 1)),
             above = static_cast<std::uint32_t>(face_number<2>(2, 1));
  const auto left = static_cast<std::uint32_t>(face_number<2>(0, 2)),
             right = static_cast<std::uint32_t>(face_number<2>(1, 2));
  EXPECT_EQ(faces_of(cut), (std::vector<std::vector<std::uint32_t>>{{below, right}, {left, above}}));
  EXPECT_EQ(faces_of(joined), (std::vector<std::vector<std::uint32_t>>{{below, left}, {right, above}}));
}

TEST(TileFacets, AHighCentreOfACubeJoinsOppositeCornersByATunnel) {
  std::vector<Choice> signs(kFaceCount<3>);
  EXPECT_EQ(tile_facets<3>(0b10000001, {.choices = signs}).facets.size(), 2u);
  signs[face_number<3>(0, 7)] = Choice::high;
  const auto tunnel = tile_facets<3>(0b10000001, {.choices = signs});
  ASSERT_EQ(tunnel.facets.size(), 1u);
  EXPECT_EQ(tile::euler_characteristic([&] {
              tile::Simplices simplices = tunnel.facets[0].simplices;
              for (tile::Simplex& s : simplices) tile::sort_vertices(s);
              return simplices;
            }()),
            0);
  EXPECT_EQ(certified<3>(0b10000001, signs), tile::Fault::none);
}

TEST(TileFacets, SeededTilesWithRandomSignsAreCertifiedUpTo5d) {
  std::mt19937_64 random(1);
  const auto signs = [&](std::size_t count) {
    std::vector<Choice> result(count);
    for (Choice& sign : result) sign = static_cast<Choice>(random() % 3);
    return result;
  };
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(certified<3>(random() & 0xff, signs(kFaceCount<3>)), tile::Fault::none);
    EXPECT_EQ(certified<4>(random() & 0xffff, signs(kFaceCount<4>)), tile::Fault::none);
  }
  EXPECT_EQ(certified<5>(random() & 0xffffffff, signs(kFaceCount<5>)), tile::Fault::none);
}

TEST(TileFacets, ACornerOfA6dTileIsCutOffByASimplex) {
  const auto tile = tile_facets<6>(std::uint64_t{1} << 63);
  ASSERT_EQ(simplex_count(tile), 1u);
  EXPECT_EQ(tile::size(tile.facets[0].simplices[0]), 6);
}

TEST(TileFacets, WrongArgumentsAreErrors) {
  EXPECT_THROW(tile_facets<3>(256), Error);
  const std::vector<Choice> few(26);
  EXPECT_THROW(tile_facets<3>(1, {.choices = few}), Error);
  try {
    tile_facets<3>(1, {.choices = few});
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find("26 choices"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("27"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tegl
