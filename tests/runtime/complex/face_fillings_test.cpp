// SPDX-License-Identifier: BSD-3-Clause
//
// Compact contours in the 3D faces of 4D cells: neighbours, which number a face's corners in different ways, agree.
#include "regions/face_fillings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "tegl/generated/cells.hpp"

namespace tegl::detail {
namespace {

using tables::CellShape;

constexpr std::array kShapes = {CellShape::tetrahedron, CellShape::wedge, CellShape::pyramid, CellShape::hexahedron,
                                CellShape::octahedron};

/// A number of the corners: corner v is corner `corners[v]` of another one.
using Numbering = std::array<std::uint8_t, 8>;

std::uint8_t edge_between(const tables::CellTable& table, unsigned p, unsigned q) {
  for (std::uint8_t e = 0; e < table.edge_count; ++e)
    if ((table.edges[2 * e] == p && table.edges[2 * e + 1] == q) ||
        (table.edges[2 * e] == q && table.edges[2 * e + 1] == p))
      return e;
  return 0xff;
}

/// All permutations of the corners that map edges to edges.
std::vector<Numbering> numberings_of(const tables::CellTable& table) {
  std::vector<Numbering> result;
  Numbering corners;
  std::iota(corners.begin(), corners.end(), std::uint8_t{0});
  do {
    bool fits = true;
    for (unsigned e = 0; fits && e < table.edge_count; ++e)
      fits = edge_between(table, corners[table.edges[2 * e]], corners[table.edges[2 * e + 1]]) != 0xff;
    if (fits) result.push_back(corners);
  } while (std::next_permutation(corners.begin(), corners.begin() + table.corner_count));
  return result;
}

/// The triangles as sets of edges of the shape.
std::set<std::set<unsigned>> as_sets(std::span<const FaceFillings::Triangle> triangles) {
  std::set<std::set<unsigned>> result;
  for (const auto& t : triangles) result.insert({t[0], t[1], t[2]});
  return result;
}

TEST(FaceFillings, DependOnTheNumbersOfThePointsAlone) {
  std::mt19937 random(1);
  for (const CellShape shape : kShapes) {
    const tables::CellTable& table = tables::cell_table(shape, Triangulation::compact);
    const std::vector<Numbering> numberings = numberings_of(table);
    EXPECT_GE(numberings.size(), 8U);
    std::size_t several = 0;
    for (const bool high : {false, true}) {
      const FaceFillings fillings(shape, high);
      for (unsigned signature = 0; signature < 1u << table.corner_count; ++signature) {
        std::array<Index, 8> points;
        for (Index& point : points) point = static_cast<Index>(random() % 1000) * 8;
        for (Index v = 0; v < 8; ++v) points[v] += v;  // distinct
        const auto expected = as_sets(fillings.triangles(signature, fillings.choose(signature, points.data())));
        several += fillings.triangles(signature, fillings.own(signature)).size() > 1 ? 1 : 0;
        const Numbering& numbering = numberings[random() % numberings.size()];
        unsigned moved = 0;
        std::array<Index, 8> of_moved{};
        for (unsigned v = 0; v < table.corner_count; ++v) {
          moved |= (signature >> numbering[v] & 1u) << v;
          of_moved[v] = points[numbering[v]];
        }
        std::set<std::set<unsigned>> found;
        for (const auto& t : fillings.triangles(moved, fillings.choose(moved, of_moved.data()))) {
          std::set<unsigned> of_shape;
          for (const std::uint8_t e : t)
            of_shape.insert(edge_between(table, numbering[table.edges[2 * e]], numbering[table.edges[2 * e + 1]]));
          found.insert(of_shape);
        }
        ASSERT_EQ(found, expected) << static_cast<int>(shape) << " " << signature << " " << high;
      }
    }
    EXPECT_GT(several, 10U);
  }
}

/// Points in ascending order, as in an image: the hexahedron's own contour.
TEST(FaceFillings, OfAscendingPointsAreTheOwnContourOfAHexahedron) {
  const std::array<Index, 8> points = {0, 1, 2, 3, 4, 5, 6, 7};
  for (const bool high : {false, true}) {
    const FaceFillings fillings(CellShape::hexahedron, high);
    for (unsigned s = 0; s < 256; ++s) EXPECT_EQ(fillings.choose(s, points.data()), fillings.own(s)) << s;
  }
}

}  // namespace
}  // namespace tegl::detail
