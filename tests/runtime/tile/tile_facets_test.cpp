// SPDX-License-Identifier: BSD-3-Clause
//
// Single tiles with signs of faces: the tunnel, face numbers, certificates, arguments.
#include "tegl/tile_facets.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tegl/error.hpp"
#include "tegl/tile/certificate.hpp"

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
